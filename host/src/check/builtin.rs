//! The built-in BSDFs and lights as the modules that they are held against, bit for bit, so that none needs a file.

/// Every built-in that a module can be: its name, and its module.
pub const MODULES: [(&str, &[u8]); 12] = [
    ("area", include_bytes!("../../../plugins/prebuilt/area.wasm")),
    ("conductor", include_bytes!("../../../plugins/prebuilt/conductor.wasm")),
    ("constant", include_bytes!("../../../plugins/prebuilt/constant.wasm")),
    ("dielectric", include_bytes!("../../../plugins/prebuilt/dielectric.wasm")),
    ("diffuse", include_bytes!("../../../plugins/prebuilt/diffuse.wasm")),
    ("null", include_bytes!("../../../plugins/prebuilt/null.wasm")),
    ("plastic", include_bytes!("../../../plugins/prebuilt/plastic.wasm")),
    ("point", include_bytes!("../../../plugins/prebuilt/point.wasm")),
    ("roughconductor", include_bytes!("../../../plugins/prebuilt/roughconductor.wasm")),
    ("roughdielectric", include_bytes!("../../../plugins/prebuilt/roughdielectric.wasm")),
    ("spot", include_bytes!("../../../plugins/prebuilt/spot.wasm")),
    ("thindielectric", include_bytes!("../../../plugins/prebuilt/thindielectric.wasm")),
];

/// Built-ins that are no module, and why there is nothing to check of them alone.
pub const OTHERS: [(&str, &str); 10] = [
    ("twosided", "it turns what is inside it; check that"),
    ("mask", "it is what is inside it; check that"),
    ("blendbsdf", "it is what is inside it; check that"),
    ("normalmap", "it turns what is inside it; check that"),
    ("bumpmap", "it turns what is inside it; check that"),
    ("roughplastic", "it is no module; its tests come with its source"),
    ("principled", "it is no module; its tests come with its source"),
    ("principledthin", "it is no module; its tests come with its source"),
    ("directional", "its one direction has no density; there is nothing to check"),
    ("envmap", "it is its image; check a light of your own, or constant"),
];
