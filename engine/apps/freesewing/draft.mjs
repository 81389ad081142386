// Drafts one FreeSewing design without a browser.
//
// Standard input:  {"design": "teagan", "measurements": {"chest": 925, ...}, "options": {...}}
//                  millimetres, degrees for shoulderSlope; options as the design names them.
// Standard output: {"pieces": [{"name", "outline": [[x, y], ...], "points": {"hem": [x, y], ...}}]}
//                  millimetres, y downwards as FreeSewing has it; outlines closed, without seam
//                  allowance, curves as 24 straight pieces each.
// Exit status 1 and one line on standard error when the design is unknown or cannot be drafted.
import { readFileSync } from 'node:fs'

const PIECES_PER_CURVE = 24

const fail = (text) => {
  process.stderr.write(text + '\n')
  process.exit(1)
}

const load = async (design) => {
  if (!/^[a-z]+$/.test(design)) fail(`'${design}' is no name of a FreeSewing design`)
  let module
  try {
    module = await import('@freesewing/' + design)
  } catch (error) {
    fail(`the FreeSewing design '${design}' is not installed (${error.code ?? error.message})`)
  }
  const Design = module[design[0].toUpperCase() + design.slice(1)]
  if (!Design) fail(`'@freesewing/${design}' holds no design`)
  return Design
}

const round = (x) => Math.round(x * 1e4) / 1e4
const pair = (p) => [round(p.x), round(p.y)]

const flatten = (path) => {
  const line = []
  const add = (p) => {
    const last = line[line.length - 1]
    if (!last || Math.hypot(p.x - last.x, p.y - last.y) > 1e-3) line.push({ x: p.x, y: p.y })
  }
  for (const op of path.ops) {
    if (op.type === 'move' || op.type === 'line') add(op.to)
    if (op.type !== 'curve') continue
    const a = line[line.length - 1]
    for (let i = 1; i <= PIECES_PER_CURVE; i++) {
      const t = i / PIECES_PER_CURVE
      const s = 1 - t
      const mix = (k) =>
        s * s * s * a[k] + 3 * s * s * t * op.cp1[k] + 3 * s * t * t * op.cp2[k] + t * t * t * op.to[k]
      add({ x: mix('x'), y: mix('y') })
    }
  }
  const [first, last] = [line[0], line[line.length - 1]]
  if (line.length > 1 && Math.hypot(first.x - last.x, first.y - last.y) < 1e-2) line.pop()
  return line.map(pair)
}

const input = JSON.parse(readFileSync(0, 'utf8'))
const Design = await load(input.design)
const missing = (Design.patternConfig?.measurements ?? []).filter(
  (name) => !Number.isFinite(input.measurements?.[name])
)
if (missing.length) fail(`the design '${input.design}' needs the measurements ${missing.join(', ')}`)
const unknown = Object.keys(input.options ?? {}).filter(
  (name) => !(name in (Design.patternConfig?.options ?? {}))
)
if (unknown.length) fail(`the design '${input.design}' has no option ${unknown.join(', ')}`)

const pattern = new Design({
  measurements: input.measurements,
  options: input.options ?? {},
  sa: 0,
  complete: false,
})
pattern.draft()
const errors = [...(pattern.store?.logs?.error ?? []), ...(pattern.setStores?.[0]?.logs?.error ?? [])]
if (errors.length) fail(`the design '${input.design}' cannot be drafted: ${errors[0].message ?? errors[0]}`)

const pieces = []
for (const [name, part] of Object.entries(pattern.parts?.[0] ?? {})) {
  const path = part.paths.seam ?? part.paths.saBase
  if (part.hidden || !path?.ops?.length) continue
  const points = {}
  for (const [id, p] of Object.entries(part.points))
    if (/^[A-Za-z]/.test(id) && Number.isFinite(p?.x) && Number.isFinite(p?.y)) points[id] = pair(p)
  pieces.push({ name: name.slice(name.indexOf('.') + 1), outline: flatten(path), points })
}
if (!pieces.length) fail(`the design '${input.design}' drafts no pieces`)
process.stdout.write(JSON.stringify({ pieces }) + '\n')
