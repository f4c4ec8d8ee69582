//! The macro that declares parameters.

/// Declares the parameters of a plugin: a struct with [`Default`] and [`Parameters`](crate::Parameters).
///
/// ```
/// bidir_sdk::parameters! {
///     /// The first paragraph here is the manifest's description.
///     pub struct Weave {
///         /// The first paragraph here is the parameter's help.
///         tint: rgb(min 0.0, max 1.0, texturable, label "Tint") = [0.5, 0.1, 0.1];
///         /// One number for all three is enough.
///         scale: rgb = 1.0;
///         roughness: float(min 0.01, max 1.0) = 0.3;
///         layers: int(min 1, max 8) = 1;
///         flipped: bool = false;
///         distribution: choice Distribution { Beckmann = "beckmann", Ggx = "ggx" } = "ggx";
///     }
/// }
/// # fn main() {
/// assert_eq!(Weave::default().distribution, Distribution::Ggx);
/// # }
/// ```
///
/// | type | field | in a scene |
/// |---|---|---|
/// | `float` | [`Real`](crate::Real) | a float, or a texture if `texturable` |
/// | `rgb` | [`Spectrum`](crate::Spectrum) | a colour, or a texture if `texturable` |
/// | `int` | `i32` | an integer |
/// | `bool` | `bool` | a boolean |
/// | `choice Name { Variant = "value", … }` | the enum `Name`, which this makes | a string |
///
/// Behind the type, in any order: `min` and `max` of every channel, `texturable`, `label`. A default outside `min` … `max`,
/// one that is not among the values of its choice, and a number that JSON cannot write (`1.`, `1_000`) do not compile:
///
/// ```compile_fail
/// bidir_sdk::parameters! { pub struct Rough { alpha: float(min 0.1, max 1.0) = 0.0; } }
/// # fn main() {}
/// ```
/// ```compile_fail
/// bidir_sdk::parameters! { pub struct Rough { alpha: float = 1.; } }
/// # fn main() {}
/// ```
/// ```compile_fail
/// bidir_sdk::parameters! { pub struct Rough { kind: choice Kind { A = "a", B = "b" } = "c"; } }
/// # fn main() {}
/// ```
/// ```compile_fail
/// bidir_sdk::parameters! { pub struct Rough { alpha: double = 1.0; } }
/// # fn main() {}
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[doc = $description:literal])*
        $visibility:vis struct $name:ident { $(
            $(#[doc = $help:literal])*
            $field:ident: $type:ident $($choice:ident { $($variant:ident = $value:literal),+ $(,)? })? $(($($option:tt)*))?
                = $($scalar:literal)? $([$($channel:literal),+ $(,)?])?;
        )* }
    ) => {
        $($(
            #[doc = concat!("The values of [`", stringify!($name), "`]'s `", stringify!($field), "`.")]
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            $visibility enum $choice { $(
                #[doc = concat!("`", $value, "`")]
                $variant,
            )+ }
        )?)*

        $(#[doc = $description])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $visibility struct $name { $(
            $(#[doc = $help])*
            pub $field: $crate::__parameter_type!($type $($choice)?),
        )* }

        impl ::core::default::Default for $name {
            fn default() -> Self {
                Self { $(
                    $field: $crate::__parameter_default!(
                        $type $($choice { $($variant = $value),+ })?, $($scalar)? $([$($channel),+])?
                    ),
                )* }
            }
        }

        impl $crate::Parameters for $name {
            const DESCRIPTION: &'static [&'static str] = &[$($description),*];

            const LIST: &'static [$crate::Parameter] = &$crate::Parameter::lay_out([$({
                let parameter = $crate::Parameter::new(
                    stringify!($field),
                    &[$($help),*],
                    $crate::__parameter_value!($type $($choice { $($value),+ })?, $($scalar)? $([$($channel),+])?),
                );
                $crate::__parameter_options!(parameter; $($($option)*)?)
                    .checked(concat!("the default of parameter `", stringify!($field), "` lies outside its min … max"))
            }),*]);

            #[inline(always)]
            fn from_block(block: &[u8]) -> Self {
                let mut reader = $crate::parameter::Reader(block);
                // A struct's fields are read in the order in which they are written here, which is that of their offsets.
                Self { $($field: $crate::__parameter_read!(reader, $type $($choice { $($variant),+ })?),)* }
            }
        }

        // Checks the parameters even of a struct that nothing uses.
        const _: &[$crate::Parameter] = <$name as $crate::Parameters>::LIST;
    };
    ($($other:tt)*) => {
        ::core::compile_error!("write `pub struct Name { name: type(options) = default; … }`: a `;` behind each parameter, and a literal, or [r, g, b], as each default");
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __parameter_type {
    (float) => { $crate::Real };
    (rgb) => { $crate::Spectrum };
    (int) => { i32 };
    (bool) => { bool };
    (choice $choice:ident) => { $choice };
    ($($other:tt)*) => {
        ::core::compile_error!(concat!(
            "`", stringify!($($other)*), "` is no type of a parameter: there are float, rgb, int, bool, and choice Name { Variant = \"value\", … }"
        ))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __parameter_default {
    (float, $value:literal) => { $value as $crate::Real };
    (rgb, [$r:literal, $g:literal, $b:literal]) => { $crate::Spectrum([$r as $crate::Real, $g as $crate::Real, $b as $crate::Real]) };
    (rgb, $value:literal) => { $crate::Spectrum::splat($value as $crate::Real) };
    (int, $value:literal) => { { let value: i32 = $value; value } };
    (bool, $value:literal) => { { let value: bool = $value; value } };
    (choice $choice:ident { $($variant:ident = $value:literal),+ }, $chosen:literal) => {
        const { [$($choice::$variant),+][$crate::parameter::place(&[$($value),+], $chosen)] }
    };
    // Never compiled: what is wrong is said once, by the parameter's type or value.
    ($($other:tt)*) => { ::core::unreachable!() };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __parameter_value {
    (float, $value:literal) => { $crate::parameter::Value::Float($crate::__number!($value)) };
    (rgb, [$r:literal, $g:literal, $b:literal]) => {
        $crate::parameter::Value::Rgb([$crate::__number!($r), $crate::__number!($g), $crate::__number!($b)])
    };
    (rgb, $value:literal) => { $crate::parameter::Value::Rgb([$crate::__number!($value); 3]) };
    (int, $value:literal) => { $crate::parameter::Value::Int($crate::__number!($value)) };
    (bool, $value:literal) => { $crate::parameter::Value::Bool($value) };
    (choice $choice:ident { $($value:literal),+ }, $chosen:literal) => {
        $crate::parameter::Value::Choice { chosen: $chosen, values: &[$($value),+] }
    };
    ($type:ident $($choice:ident $values:tt)?, $($default:tt)*) => {
        ::core::compile_error!(concat!("`", stringify!($($default)*), "` is no default of a parameter of type ", stringify!($type)))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __number {
    ($value:literal) => {
        $crate::parameter::Number::new(stringify!($value), $value as f64)
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __parameter_options {
    ($parameter:expr;) => { $parameter };
    ($parameter:expr; , $($rest:tt)*) => { $crate::__parameter_options!($parameter; $($rest)*) };
    ($parameter:expr; min $value:literal $($rest:tt)*) => { $crate::__parameter_options!($parameter.min($crate::__number!($value)); $($rest)*) };
    ($parameter:expr; max $value:literal $($rest:tt)*) => { $crate::__parameter_options!($parameter.max($crate::__number!($value)); $($rest)*) };
    ($parameter:expr; texturable $($rest:tt)*) => { $crate::__parameter_options!($parameter.texturable(); $($rest)*) };
    ($parameter:expr; label $label:literal $($rest:tt)*) => { $crate::__parameter_options!($parameter.label($label); $($rest)*) };
    ($parameter:expr; $($other:tt)*) => {
        ::core::compile_error!(concat!(
            "`", stringify!($($other)*), "` is no option of a parameter: there are min NUMBER, max NUMBER, texturable, and label \"TEXT\""
        ))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! __parameter_read {
    ($reader:ident, choice $choice:ident { $($variant:ident),+ }) => {
        // A match, since it folds into a comparison; the first one by an index that is not there.
        match $reader.int() {
            $(index if index == $choice::$variant as i32 => $choice::$variant,)+
            _ => [$($choice::$variant),+][0],
        }
    };
    ($reader:ident, float) => { $reader.float() };
    ($reader:ident, rgb) => { $reader.rgb() };
    ($reader:ident, int) => { $reader.int() };
    ($reader:ident, bool) => { $reader.bool() };
    // Never compiled: the type of the parameter is refused first.
    ($reader:ident, $($other:tt)*) => { ::core::unreachable!() };
}
