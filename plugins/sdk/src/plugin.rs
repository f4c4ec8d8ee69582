//! The macros that make a module.

/// Makes the crate a module that holds a BSDF: `bsdf! { Parameters, lobes: […], … }`, where `Parameters` is made by
/// [`parameters!`](crate::parameters) and implements [`Bsdf`](crate::Bsdf).
///
/// Where the shader is another type, a function makes it: `bsdf! { Parameters => |p: &Parameters| …, lobes: […] }`.
///
/// | key | |
/// |---|---|
/// | `lobes` | every lobe it can ever have, one at least: `diffuse_reflection`, `glossy_reflection`, `delta_reflection`, `diffuse_transmission`, `glossy_transmission`, `delta_transmission` |
/// | `reciprocal` | `false` where f differs when ω_o and ω_i are swapped (apart from η²); `true` if absent |
/// | `isotropic` | `true` where only angles to the normal and between directions matter, so that any tangent will do; `false` if absent |
/// | `name` | a label; the crate's name if absent |
///
/// This makes `pub const MANIFEST: &str` and `pub fn bsdf(block: &[u8]) -> impl Bsdf`, for who links the crate natively;
/// for wasm32 also the module's section and exports. A crate holds one plugin.
#[macro_export]
macro_rules! bsdf {
    ($parameters:ty, $($key:ident: $value:tt),+ $(,)?) => {
        $crate::bsdf! { $parameters => |parameters: &$parameters| *parameters, $($key: $value),+ }
    };
    ($parameters:ty => $shader:expr, $($key:ident: $value:tt),+ $(,)?) => {
        $crate::__manifest! {
            {
                let (mut lobes, mut reciprocal, mut isotropic) = (0, true, false);
                let mut name = env!("CARGO_CRATE_NAME");
                $($crate::__bsdf_key!(lobes reciprocal isotropic name, $key $value);)+
                $crate::Manifest::bsdf::<$parameters>(name).with($crate::manifest::Kind::Bsdf { lobes, reciprocal, isotropic }).checked()
            }
        }

        /// The surface with the parameters of a block, as the module would have it.
        pub fn bsdf(block: &[u8]) -> impl $crate::Bsdf + use<> {
            $crate::parameter::made::<$parameters, _>($shader, block)
        }

        $crate::__export_bsdf!($parameters => $shader);
    };
    ($($other:tt)*) => {
        ::core::compile_error!("write `bsdf! { Parameters, lobes: [diffuse_reflection] }` or `bsdf! { Parameters => shader, lobes: […] }`");
    };
}

/// Makes the crate a module that holds an emission profile: `light! { Parameters, emits_from: […] }`, where `Parameters` is made by
/// [`parameters!`](crate::parameters) and implements [`Profile`](crate::Profile).
///
/// Where the profile is another type, a function makes it: `light! { Parameters => |p: &Parameters| …, emits_from: […] }`.
///
/// | key | |
/// |---|---|
/// | `emits_from` | where it can shine from, one place at least: `area`, `point`, `environment` |
/// | `name` | a label; the crate's name if absent |
///
/// This makes `pub const MANIFEST: &str` and `pub fn light(block: &[u8]) -> impl Profile`, for who links the crate natively;
/// for wasm32 also the module's section and exports. A crate holds one plugin.
#[macro_export]
macro_rules! light {
    ($parameters:ty, $($key:ident: $value:tt),+ $(,)?) => {
        $crate::light! { $parameters => |parameters: &$parameters| *parameters, $($key: $value),+ }
    };
    ($parameters:ty => $light:expr, $($key:ident: $value:tt),+ $(,)?) => {
        $crate::__manifest! {
            {
                let (mut area, mut point, mut environment) = (false, false, false);
                let mut name = env!("CARGO_CRATE_NAME");
                $($crate::__light_key!(area point environment name, $key $value);)+
                $crate::Manifest::light::<$parameters>(name).with($crate::manifest::Kind::Light { area, point, environment }).checked()
            }
        }

        /// The light with the parameters of a block, as the module would have it.
        pub fn light(block: &[u8]) -> impl $crate::Profile + use<> {
            $crate::parameter::made::<$parameters, _>($light, block)
        }

        $crate::__export_light!($parameters => $light);
    };
    ($($other:tt)*) => {
        ::core::compile_error!("write `light! { Parameters, emits_from: [point] }` or `light! { Parameters => profile, emits_from: […] }`");
    };
}

/// The constant `MANIFEST`: written twice at compile time, first to count.
#[doc(hidden)]
#[macro_export]
macro_rules! __manifest {
    ($manifest:expr) => {
        /// What this plugin says of itself, in JSON.
        pub const MANIFEST: &str = {
            const PLUGIN: $crate::Manifest = $manifest;
            const TEXT: &[u8] = &PLUGIN.json::<{ PLUGIN.length() }>();
            $crate::json::text(TEXT)
        };
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __bsdf_key {
    ($lobes:ident $reciprocal:ident $isotropic:ident $name:ident, lobes [$($lobe:ident),* $(,)?]) => { $lobes = 0 $(| $crate::__lobe!($lobe))* };
    ($lobes:ident $reciprocal:ident $isotropic:ident $name:ident, reciprocal $value:literal) => { $reciprocal = $value };
    ($lobes:ident $reciprocal:ident $isotropic:ident $name:ident, isotropic $value:literal) => { $isotropic = $value };
    ($lobes:ident $reciprocal:ident $isotropic:ident $name:ident, name $value:literal) => { $name = $value };
    ($lobes:ident $reciprocal:ident $isotropic:ident $name:ident, $($other:tt)*) => {
        ::core::compile_error!(concat!("`", stringify!($($other)*), "`: a BSDF has lobes: [LOBE, …], reciprocal: BOOL, isotropic: BOOL, and name: \"TEXT\""))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __lobe {
    (diffuse_reflection) => {
        $crate::abi::lobe::DIFFUSE_REFLECTION
    };
    (glossy_reflection) => {
        $crate::abi::lobe::GLOSSY_REFLECTION
    };
    (delta_reflection) => {
        $crate::abi::lobe::DELTA_REFLECTION
    };
    (diffuse_transmission) => {
        $crate::abi::lobe::DIFFUSE_TRANSMISSION
    };
    (glossy_transmission) => {
        $crate::abi::lobe::GLOSSY_TRANSMISSION
    };
    (delta_transmission) => {
        $crate::abi::lobe::DELTA_TRANSMISSION
    };
    ($other:ident) => {
        ::core::compile_error!(concat!(
            "`",
            stringify!($other),
            "` is no lobe: there are diffuse_, glossy_ and delta_reflection, and diffuse_, glossy_ and delta_transmission"
        ))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __light_key {
    ($area:ident $point:ident $environment:ident $name:ident, emits_from [$($place:ident),* $(,)?]) => {
        $($crate::__place!($area $point $environment, $place);)*
    };
    ($area:ident $point:ident $environment:ident $name:ident, name $value:literal) => { $name = $value };
    ($area:ident $point:ident $environment:ident $name:ident, $($other:tt)*) => {
        ::core::compile_error!(concat!("`", stringify!($($other)*), "`: a light has emits_from: [PLACE, …] and name: \"TEXT\""))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __place {
    ($area:ident $point:ident $environment:ident, area) => {
        $area = true
    };
    ($area:ident $point:ident $environment:ident, point) => {
        $point = true
    };
    ($area:ident $point:ident $environment:ident, environment) => {
        $environment = true
    };
    ($area:ident $point:ident $environment:ident, $other:ident) => {
        ::core::compile_error!(concat!("`", stringify!($other), "`: a light emits from area, point and environment"))
    };
}
