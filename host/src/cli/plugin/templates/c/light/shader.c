// {{Name}}: a cone of light that falls off from its axis to its edge. Freestanding C, no imports.
//
//     L(w) = radiance (1 - h),   h = (1 - w.z) / (1 - cos spread),   for h below 1
//
// and directions are made in proportion: pdf = (1 - h) / (pi (1 - cos spread)).

#define EXPORT(name) __attribute__((export_name(name)))

static const float PI = 3.14159265f;

// The parameter block; manifest.json tells the host its offsets.
typedef struct { float radiance[3], spread; } Params;

typedef struct { float radiance[3], pdf; } EvalOut;

typedef struct { float x, y, z; EvalOut out; } EmitOut;

_Static_assert(sizeof(EvalOut) == 16 && sizeof(EmitOut) == 28, "records of ABI 1.0");

// The manifest becomes a custom section of the module.
__asm__(".section .custom_section.bidir.manifest,\"\",@\n"
        ".incbin \"manifest.json\"\n");

EXPORT("bidir_abi") int bidir_abi(void) { return 1 << 16; }

EXPORT("bidir_scratch") void *bidir_scratch(unsigned bytes) {
    static _Alignas(16) unsigned char region[8192];
    if (bytes <= sizeof region) return region;
    const unsigned page = 65536, old = __builtin_wasm_memory_grow(0, bytes / page + (bytes % page != 0));
    return old == ~0u ? 0 : (void *)(old * page);
}

// Sine of x from -pi/4 to pi/4, by its Taylor series.
static float small_sin(double x) {
    const double s = x * x;
    return x * (1.0 + s * (-1.0 / 6 + s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800))))));
}

// Cosine and sine of the angle u turns round: Taylor series about the middle of the nearest quarter.
static void circle(float u, float *cosine, float *sine) {
    const int quarter = (int)(4.0f * u + 0.5f);
    const double x = 2.0 * 3.14159265358979324 * (u - 0.25 * quarter), s = x * x;
    const float c = 1.0 + s * (-1.0 / 2 + s * (1.0 / 24 + s * (-1.0 / 720 + s * (1.0 / 40320 + s * (-1.0 / 3628800))))), n = small_sin(x);
    *cosine = quarter & 1 ? (quarter & 2 ? n : -n) : (quarter & 2 ? -c : c);
    *sine = quarter & 1 ? (quarter & 2 ? -c : c) : (quarter & 2 ? -n : n);
}

// 1 - cos spread, in a form that keeps its digits when the cone is narrow.
static float opening(const Params *p) {
    const float s = small_sin(0.5 * 3.14159265358979324 / 180.0 * p->spread);
    return 2.0f * s * s;
}

static EvalOut eval(const Params *p, float x, float y, float z) {
    EvalOut out = { {0.0f, 0.0f, 0.0f}, 0.0f};
    if (!(z > 0.0f)) return out;
    const float open = opening(p);
    // (x² + y²) / (1 + z) is 1 - z without cancellation.
    const float left = 1.0f - (x * x + y * y) / (1.0f + z) / open;
    if (!(left > 0.0f)) return out;
    for (int band = 0; band < 3; band++) out.radiance[band] = p->radiance[band] * left;
    out.pdf = left / (PI * open);
    return out;
}

EXPORT("light_eval") void light_eval(EvalOut *out, const Params *p, float u, float v, float x, float y, float z) {
    *out = eval(p, x, y, z);
}

EXPORT("light_emit") void light_emit(EmitOut *out, const Params *p, float u, float v, float u0, float u1) {
    // 1 - h has density 2 (1 - h): the square root.
    const float below = (1.0f - __builtin_sqrtf(1.0f - u0)) * opening(p);
    const float r = __builtin_sqrtf(below * (2.0f - below));
    float x, y;
    circle(u1, &x, &y);
    *out = (EmitOut){r * x, r * y, 1.0f - below, eval(p, r * x, r * y, 1.0f - below)};
}
