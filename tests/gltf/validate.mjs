// node validate.mjs FILE...: prints every error and warning of the Khronos glTF validator, one a
// line, and exits 1 when there are any; 2 when the validator is not installed (npm ci).
import { readFile } from 'node:fs/promises';
import { basename, dirname, resolve } from 'node:path';

let validator;
try {
  validator = (await import('gltf-validator')).default;
} catch {
  console.error('gltf-validator is not installed: run npm ci in tests/gltf');
  process.exit(2);
}

let faults = 0;
for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: basename(file),
    maxIssues: 100,
    externalResourceFunction: async (uri) =>
      new Uint8Array(await readFile(resolve(dirname(file), decodeURIComponent(uri)))),
  });
  for (const issue of report.issues.messages) {
    if (issue.severity > 1) continue; // 0 error, 1 warning, 2 information, 3 hint
    faults += 1;
    const kind = issue.severity === 0 ? 'error' : 'warning';
    console.log(`${file}: ${kind} ${issue.code} at ${issue.pointer ?? ''}: ${issue.message}`);
  }
}
process.exit(faults > 0 ? 1 : 0);
