//! Random numbers from a fixed seed, for rays.

use bidir_kernel::Vec3;

/// The generator of Steele, Lea and Flood 2014 (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// In 0 … 1.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 40) as f32 * 2.0_f32.powi(-24)
    }

    /// In −1 … 1, thrice.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// On the unit sphere.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}
