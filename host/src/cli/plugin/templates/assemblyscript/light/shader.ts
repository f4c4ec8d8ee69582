// {{Name}}: a cone of light that falls off from its axis to its edge. No runtime, no imports.
//
//     L(w) = radiance (1 - h),   h = (1 - w.z) / (1 - cos spread),   for h below 1
//
// and directions are made in proportion: pdf = (1 - h) / (pi (1 - cos spread)).

const PI: f32 = 3.1415926535897932;

// The parameter block, as manifest.json has it.
const RADIANCE: usize = 0;
const SPREAD: usize = 12;

// An answer of light_eval, and where it stands in one of light_emit.
const PDF: usize = 12;
const EMIT_ANSWER: usize = 12;

const REGION: usize = 8192;
const region: usize = memory.data(8192, 16);

export function bidir_abi(): i32 {
  return 1 << 16;
}

export function bidir_scratch(bytes: u32): usize {
  if (<usize>bytes <= REGION) return region;
  const old = memory.grow(bytes / 65536 + u32(bytes % 65536 != 0));
  return old < 0 ? 0 : <usize>old << 16;
}

// 1 - cos spread, in a form that keeps its digits when the cone is narrow.
@inline
function opening(params: usize): f32 {
  const s: f32 = Mathf.sin(load<f32>(params, SPREAD) * (PI / 360));
  return <f32>2 * s * s;
}

export function light_eval(out: usize, params: usize, u: f32, v: f32, x: f32, y: f32, z: f32): void {
  memory.fill(out, 0, 16);
  if (!(z > 0)) return;
  const open = opening(params);
  // (x² + y²) / (1 + z) is 1 - z without cancellation.
  const left: f32 = <f32>1 - (x * x + y * y) / (<f32>1 + z) / open;
  if (!(left > 0)) return;
  for (let band: usize = 0; band < 12; band += 4) store<f32>(out + band, load<f32>(params + band, RADIANCE) * left);
  store<f32>(out, left / (PI * open), PDF);
}

export function light_emit(out: usize, params: usize, u: f32, v: f32, u0: f32, u1: f32): void {
  // 1 - h has density 2 (1 - h): the square root.
  const below: f32 = (<f32>1 - Mathf.sqrt(<f32>1 - u0)) * opening(params);
  const r: f32 = Mathf.sqrt(below * (<f32>2 - below));
  const phi: f32 = <f32>2 * PI * u1;
  const x: f32 = r * Mathf.cos(phi);
  const y: f32 = r * Mathf.sin(phi);
  const z: f32 = <f32>1 - below;
  store<f32>(out, x, 0);
  store<f32>(out, y, 4);
  store<f32>(out, z, 8);
  light_eval(out + EMIT_ANSWER, params, u, v, x, y, z);
}
