//! The version of the ABI. It only ever grows: a module of 1.0 loads for ever.

/// The version that this crate describes.
pub const VERSION: Version = Version { major: 1, minor: 0 };

/// A version of the ABI. Minors add, majors would break.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Version {
    /// What both sides must have in common.
    pub major: u16,
    /// What a host must have at least.
    pub minor: u16,
}

impl Version {
    /// What `bidir_abi` answers: major « 16 | minor.
    pub const fn pack(self) -> i32 {
        ((self.major as u32) << 16 | self.minor as u32) as i32
    }

    /// From what `bidir_abi` answered.
    pub const fn unpack(packed: i32) -> Self {
        Self { major: (packed as u32 >> 16) as u16, minor: packed as u16 }
    }

    /// Whether a host of this version takes a module of the version `theirs`: the same major, and no minor beyond its own.
    pub const fn accepts(self, theirs: Self) -> bool {
        theirs.major == self.major && theirs.minor <= self.minor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_version_is_packed_with_its_major_on_top() {
        assert_eq!(VERSION.pack(), 0x1_0000);
        assert_eq!(Version { major: 0x8001, minor: 0xfffe }.pack(), i32::from_ne_bytes(0x8001_fffe_u32.to_ne_bytes()));
    }

    #[test]
    fn a_packed_version_unpacks_to_itself() {
        for version in [VERSION, Version { major: 0xffff, minor: 0 }, Version { major: 0, minor: 0xffff }] {
            assert_eq!(Version::unpack(version.pack()), version);
        }
    }

    #[test]
    fn a_host_takes_its_own_major_up_to_its_own_minor() {
        let host = Version { major: 1, minor: 2 };
        assert!(host.accepts(Version { major: 1, minor: 0 }) && host.accepts(host));
        assert!(!host.accepts(Version { major: 1, minor: 3 }));
        assert!(!host.accepts(Version { major: 2, minor: 0 }) && !host.accepts(Version { major: 0, minor: 0 }));
    }
}
