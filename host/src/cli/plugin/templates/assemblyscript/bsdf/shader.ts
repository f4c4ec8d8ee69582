// {{Name}}: matt paint that sends part of the light back to where it came from. No runtime, no imports.
//
//     f(wo, wi) = tint ((1 - retro) / pi + retro * 17 / (2 pi) * max(0, wo . wi)^15),   on the front only
//
// 17 / (2 pi) keeps the lobe from sending back more than it gets at any angle.

const PI: f32 = 3.1415926535897932;

const DIFFUSE_REFLECTION: u32 = 1;
const GLOSSY_REFLECTION: u32 = 2;

// The parameter block, as manifest.json has it.
const TINT: usize = 0;
const RETRO: usize = 12;

// An answer of bsdf_eval.
const VALUE: usize = 0;
const PDF: usize = 12;
const PDF_REV: usize = 16;

// An answer of bsdf_sample.
const WEIGHT: usize = 12;
const SAMPLE_PDF: usize = 24;
const SAMPLE_PDF_REV: usize = 28;
const LOBE: usize = 32;
const ETA: usize = 36;

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

// d^15 for d from 0 to 1.
@inline
function power15(d: f32): f32 {
  const d2 = d * d;
  const d4 = d2 * d2;
  return d4 * d4 * d4 * d2 * d;
}

// How densely both lobes together make a direction of cosine `cos` that encloses an angle of cosine `d` with the other one.
@inline
function density(retro: f32, cos: f32, d: f32): f32 {
  return (<f32>1 - retro) * (cos / PI) + retro * (<f32>16 / (<f32>2 * PI) * power15(d));
}

export function bsdf_eval(out: usize, params: usize, carried: i32, ox: f32, oy: f32, oz: f32, ix: f32, iy: f32, iz: f32): void {
  memory.fill(out, 0, 20);
  if (!(oz > 0 && iz > 0)) return;
  const retro = load<f32>(params, RETRO);
  const d: f32 = Mathf.max(0, ox * ix + oy * iy + oz * iz);
  const f: f32 = (<f32>1 - retro) / PI + retro * (<f32>17 / (<f32>2 * PI) * power15(d));
  for (let band: usize = 0; band < 12; band += 4) store<f32>(out + band, load<f32>(params + band, TINT) * (f * iz), VALUE);
  store<f32>(out, density(retro, iz, d), PDF);
  store<f32>(out, density(retro, oz, d), PDF_REV);
}

// Where an answer of bsdf_eval is kept for the length of one call.
const both: usize = memory.data(20, 16);

export function bsdf_sample(out: usize, params: usize, carried: i32, ox: f32, oy: f32, oz: f32, u0: f32, u1: f32, u2: f32): void {
  memory.fill(out, 0, 40);
  if (!(oz > 0)) return;
  const back = u2 < load<f32>(params, RETRO);
  // The cosine has density 16 d^15 about wo: the sixteenth root; about the normal 2 cos: the square root.
  const root: f32 = Mathf.sqrt(u0);
  const cos: f32 = back ? Mathf.sqrt(Mathf.sqrt(Mathf.sqrt(root))) : root;
  const r: f32 = Mathf.sqrt(Mathf.max(0, <f32>1 - cos * cos));
  const phi: f32 = <f32>2 * PI * u1;
  let x: f32 = r * Mathf.cos(phi);
  let y: f32 = r * Mathf.sin(phi);
  let z: f32 = cos;
  if (back) {
    // Turned, so that what was about z is about wo (Duff et al. 2017); wo.z is above 0 here.
    const a: f32 = <f32>-1 / (<f32>1 + oz);
    const b: f32 = ox * oy * a;
    const lx = x;
    const ly = y;
    x = lx * (<f32>1 + ox * ox * a) + ly * b + cos * ox;
    y = lx * b + ly * (<f32>1 + oy * oy * a) + cos * oy;
    z = cos * oz - lx * ox - ly * oy;
  }
  bsdf_eval(both, params, carried, ox, oy, oz, x, y, z);
  const pdf = load<f32>(both, PDF);
  // Below the surface, where bsdf_eval knows nothing, there is no sample.
  if (!(pdf > 0)) return;
  store<f32>(out, x, 0);
  store<f32>(out, y, 4);
  store<f32>(out, z, 8);
  for (let band: usize = 0; band < 12; band += 4) store<f32>(out + band, load<f32>(both + band, VALUE) / pdf, WEIGHT);
  store<f32>(out, pdf, SAMPLE_PDF);
  store<f32>(out, load<f32>(both, PDF_REV), SAMPLE_PDF_REV);
  store<u32>(out, back ? GLOSSY_REFLECTION : DIFFUSE_REFLECTION, LOBE);
  store<f32>(out, 1, ETA);
}
