// A lamp with a measured distribution: README.md defines it, ../README.md is the ABI.
// AssemblyScript without a runtime: no objects, no imports; build.sh puts iesspot.json into the module.

const ZONES: i32 = 18;
const RADIANS: f32 = 0.017453292519943295;
const PI: f32 = 3.1415926535897932;

// Offsets in the parameter block, in an answer of `light_eval`, and in one of `light_emit`.
const INTENSITY: usize = 0;
const STEP: usize = 12;
const WEB: usize = 16;
const EVAL_PDF: usize = 12;
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

// The web's value at zone boundary i.
@inline
function web(params: usize, i: i32): f32 {
  return load<f32>(params + WEB + ((<usize>i) << 2));
}

@inline
function mean(params: usize, zone: i32): f32 {
  return <f32>0.5 * (web(params, zone) + web(params, zone + 1));
}

// Walks over the zones from the axis on: `open` is 1 − cos of the step from the near to the far edge of the current one.
let sinStep: f32, cosStep: f32, sinHalf: f32, sine: f32, cosine: f32;

function firstZone(params: usize): void {
  const half: f32 = <f32>0.5 * angle(params);
  const s: f32 = Mathf.sin(half);
  const c: f32 = Mathf.cos(half);
  sinStep = <f32>2 * s * c;
  cosStep = <f32>1 - <f32>2 * s * s;
  sinHalf = s;
  sine = s;
  cosine = c;
}

@inline
function open(): f32 {
  return <f32>2 * sinHalf * sine;
}

@inline
function nextZone(): void {
  const turned: f32 = sine * cosStep + cosine * sinStep;
  cosine = cosine * cosStep - sine * sinStep;
  sine = turned;
}

// The angle of a zone.
@inline
function angle(params: usize): f32 {
  return load<f32>(params, STEP) * RADIANS;
}

// What all zones hold, over 2π.
function power(params: usize): f32 {
  let total: f32 = 0;
  firstZone(params);
  for (let i = 0; i < ZONES; i++) {
    total += mean(params, i) * open();
    nextZone();
  }
  return total;
}

// Writes radiance and pdf along a direction, given the power; says whether there is a pdf.
function answer(out: usize, params: usize, total: f32, x: f32, y: f32, z: f32): bool {
  memory.fill(out, 0, 16);
  const theta: f32 = Mathf.atan2(Mathf.sqrt(x * x + y * y), z);
  const p: f32 = theta / angle(params);
  const floor: f32 = Mathf.floor(p);
  if (!(total > 0) || !(floor < <f32>ZONES)) return false;
  const zone = <i32>floor;
  const m = mean(params, zone);
  if (!(m > 0)) return false;
  const near = web(params, zone);
  const relative: f32 = near + (p - floor) * (web(params, zone + 1) - near);
  for (let band: usize = 0; band < 12; band += 4) {
    store<f32>(out + band, load<f32>(params + INTENSITY + band) * relative);
  }
  store<f32>(out, m / (<f32>2 * PI * total), EVAL_PDF);
  return true;
}

export function light_eval(out: usize, params: usize, u: f32, v: f32, x: f32, y: f32, z: f32): void {
  answer(out, params, power(params), x, y, z);
}

// 1 − cos θ for the first random number.
function opening(params: usize, total: f32, u: f32): f32 {
  let rest: f32 = u * total;
  let before: f32 = 0;
  let last: f32 = 0;
  firstZone(params);
  for (let i = 0; i < ZONES; i++) {
    const d = open();
    const m = mean(params, i);
    const share: f32 = m * d;
    if (rest < share) return before + rest / m;
    rest -= share;
    // Where rounding leaves no zone, the far edge of the last one that shines.
    if (m > 0) last = before + share / m;
    before += d;
    nextZone();
  }
  return last;
}

export function light_emit(out: usize, params: usize, u: f32, v: f32, u0: f32, u1: f32): void {
  memory.fill(out, 0, 28);
  const total = power(params);
  if (!(total > 0)) return;
  const h: f32 = Mathf.min(opening(params, total, u0), 2);
  const r: f32 = Mathf.sqrt(Mathf.max(0, h * (<f32>2 - h)));
  const phi: f32 = <f32>2 * PI * u1;
  const x: f32 = r * Mathf.cos(phi);
  const y: f32 = r * Mathf.sin(phi);
  const z: f32 = <f32>1 - h;
  store<f32>(out, x, 0);
  store<f32>(out, y, 4);
  store<f32>(out, z, 8);
  answer(out + EMIT_ANSWER, params, total, x, y, z);
}
