// Opens a page in Chromium without a window, waits until its 3D look has loaded, and tells what it
// reads; pictures on the way. node browse.mjs PAGE PROFILE_FOLDER [ANCHOR=PICTURE.png ...]
// Speaks the DevTools protocol over pipes, so that it waits for what happens and not for a time.
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";

const [page, profile, ...shots] = process.argv.slice(2);
const kPatience_ms = 100000;
const chromium = spawn(
    "chromium",
    ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
     "--window-size=1200,900", "--no-first-run", `--user-data-dir=${profile}`, "--remote-debugging-pipe"],
    { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
const fail = (why) => {
    console.error(`browse.mjs: ${why}`);
    chromium.kill("SIGKILL");
    process.exit(1);
};
chromium.on("error", (e) => fail(e.message));
setTimeout(() => fail(`not done within ${kPatience_ms / 1000} s`), kPatience_ms);

const waiting = new Map();
let last = 0, rest = "";
chromium.stdio[4].on("data", (bytes) => {
    const messages = (rest + bytes).split("\0");
    rest = messages.pop();
    for (const text of messages) {
        const message = JSON.parse(text);
        if (!waiting.has(message.id)) continue;
        if (message.error) fail(JSON.stringify(message.error));
        waiting.get(message.id)(message.result);
        waiting.delete(message.id);
    }
});
const call = (method, params = {}, sessionId = undefined) => new Promise((done) => {
    waiting.set(++last, done);
    chromium.stdio[3].write(JSON.stringify({ id: last, method, params, sessionId }) + "\0");
});
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

const { targetId } = await call("Target.createTarget", { url: "about:blank" });
const { sessionId } = await call("Target.attachToTarget", { targetId, flatten: true });
const read = async (expression) =>
    (await call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true }, sessionId)).result.value;
await call("Page.enable", {}, sessionId);
await call("Page.navigate", { url: page }, sessionId);
while (!(await read("document.documentElement.dataset.look"))) await pause(100);
for (const shot of shots) {
    const at = shot.lastIndexOf("=");
    await read(`location.hash = ${JSON.stringify(shot.slice(0, at))}`);
    // Two pictures of the browser's own, and the look has been drawn from there.
    await read("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
    await pause(500);
    const { data } = await call("Page.captureScreenshot", { format: "png" }, sessionId);
    writeFileSync(shot.slice(at + 1), Buffer.from(data, "base64"));
}
console.log(JSON.stringify({
    look: await read("document.documentElement.dataset.look"),
    text: await read("document.body.innerText"),
    requests: await read("performance.getEntriesByType('resource').map((e) => e.name.slice(0, 60))"),
}));
await call("Browser.close");
process.exit(0);
