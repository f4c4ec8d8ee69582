//! The lists of checks as tests, one name each.

/// Makes a module `surface_tests` with every check of [`crate::surface`], on each case of the expression:
/// a `Vec<(String, Box<dyn Bsdf>)>`.
#[macro_export]
macro_rules! surface_tests {
    ($cases:expr) => {
        $crate::tests! { surface_tests, surface, $cases,
            samples_follow_the_pdf
            samples_agree_with_eval
            weights_are_value_over_pdf
            reverse_densities_are_those_of_the_way_back
            the_bsdf_is_reciprocal
            nothing_gives_more_than_it_gets
            all_is_finite_at_corners_and_grazing
        }
    };
}

/// Makes a module `light_tests` with every check of [`crate::light`], on each case of the expression:
/// a `Vec<(String, Box<dyn Profile>)>`.
#[macro_export]
macro_rules! light_tests {
    ($cases:expr) => {
        $crate::tests! { light_tests, light, $cases,
            emission_follows_the_pdf
            samples_agree_with_eval
            nothing_shines_that_is_never_sampled
            all_is_finite_at_corners
        }
    };
}

/// One test per check, on all cases.
#[doc(hidden)]
#[macro_export]
macro_rules! tests {
    ($module:ident, $kind:ident, $cases:expr, $($check:ident)+) => {
        mod $module {
            use super::*;
            $(
                #[test]
                fn $check() {
                    for (name, case) in $cases {
                        $crate::$kind::$check(&name, &*case);
                    }
                }
            )+
        }
    };
}
