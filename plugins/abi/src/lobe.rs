//! Kinds of scattering: the bit of each in a record, and its name in a manifest.

/// No lobe: a sample that was absorbed.
pub const NONE: u32 = 0;
/// Reflection into the whole hemisphere.
pub const DIFFUSE_REFLECTION: u32 = 1;
/// Reflection about the mirror direction.
pub const GLOSSY_REFLECTION: u32 = 2;
/// Reflection into one direction.
pub const DELTA_REFLECTION: u32 = 4;
/// Transmission into the whole hemisphere.
pub const DIFFUSE_TRANSMISSION: u32 = 8;
/// Transmission about the refracted direction.
pub const GLOSSY_TRANSMISSION: u32 = 16;
/// Transmission into one direction.
pub const DELTA_TRANSMISSION: u32 = 32;
/// The lobes into one direction: a sample's densities are chances.
pub const DELTA: u32 = DELTA_REFLECTION | DELTA_TRANSMISSION;
/// Every lobe.
pub const ALL: u32 = 63;

/// Every lobe with its name, from the lowest bit up.
pub const NAMES: [(u32, &str); 6] = [
    (DIFFUSE_REFLECTION, "diffuse_reflection"),
    (GLOSSY_REFLECTION, "glossy_reflection"),
    (DELTA_REFLECTION, "delta_reflection"),
    (DIFFUSE_TRANSMISSION, "diffuse_transmission"),
    (GLOSSY_TRANSMISSION, "glossy_transmission"),
    (DELTA_TRANSMISSION, "delta_transmission"),
];

/// The bit of a lobe's name.
pub fn named(name: &str) -> Option<u32> {
    NAMES.iter().find(|(_, known)| *known == name).map(|(bit, _)| *bit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_cover_every_lobe_once_in_order() {
        let bits: std::vec::Vec<_> = NAMES.iter().map(|(bit, _)| *bit).collect();
        assert_eq!(bits, [1, 2, 4, 8, 16, 32]);
        assert_eq!(bits.iter().sum::<u32>(), ALL);
    }

    #[test]
    fn a_name_gives_its_bit_and_another_word_none() {
        assert_eq!(named("glossy_transmission"), Some(GLOSSY_TRANSMISSION));
        assert_eq!(named("glossy"), None);
    }
}
