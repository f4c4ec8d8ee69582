//! Looking a texture up.

use bidir_kernel::{Real, Spectrum, Vec2, math};

use crate::scene::description::{Bitmap, Texture, UvTransform, Wrap};

impl UvTransform {
    fn apply(&self, uv: Vec2) -> Vec2 {
        let Self([[a, b, c], [d, e, f]]) = self;
        Vec2::new(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f)
    }
}

impl Texture {
    /// The texture's value at `uv`.
    #[inline]
    pub fn at(&self, uv: Vec2) -> Spectrum {
        match self {
            Self::Constant(value) => *value,
            Self::Bitmap(bitmap) => bitmap.at(uv),
            Self::Checkerboard { color0, color1, to_uv } => {
                let uv = to_uv.apply(uv);
                let half = |x: Real| x - math::floor(x) > 0.5;
                if half(uv.x) == half(uv.y) { *color0 } else { *color1 }
            }
        }
    }
}

impl Texture {
    /// Over a whole period; a bitmap's over its texels.
    pub fn mean(&self) -> Spectrum {
        match self {
            Self::Constant(value) => *value,
            Self::Bitmap(bitmap) => {
                let mut sums = [0.0; 3];
                for texel in bitmap.texels.iter() {
                    sums.iter_mut().zip(texel.0).for_each(|(sum, band)| *sum += f64::from(band));
                }
                Spectrum(sums.map(|sum| (sum / bitmap.texels.len().max(1) as f64) as Real))
            }
            Self::Checkerboard { color0, color1, .. } => (*color0 + *color1) * 0.5,
        }
    }

    /// How fast its luminance grows with u and v.
    pub fn slope(&self, uv: Vec2) -> Vec2 {
        match self {
            Self::Bitmap(bitmap) => bitmap.slope(uv),
            // Steps have no slope.
            Self::Constant(_) | Self::Checkerboard { .. } => Vec2::ZERO,
        }
    }
}

impl Bitmap {
    /// Of what [`Self::at`] is between texels.
    fn slope(&self, uv: Vec2) -> Vec2 {
        if self.nearest {
            return Vec2::ZERO;
        }
        let at = self.to_uv.apply(uv);
        let (x, y) = (at.x * self.width as Real - 0.5, at.y * self.height as Real - 0.5);
        let (left, top) = (math::floor(x), math::floor(y));
        let (u, v) = (x - left, y - top);
        let height = |i: i64, j: i64| luminance(self.texel(left as i64 + i, top as i64 + j));
        let (a, b, c, d) = (height(0, 0), height(1, 0), height(0, 1), height(1, 1));
        let along_x = ((b - a) * (1.0 - v) + (d - c) * v) * self.width as Real;
        let along_y = ((c - a) * (1.0 - u) + (d - b) * u) * self.height as Real;
        let UvTransform([[xu, xv, _], [yu, yv, _]]) = self.to_uv;
        Vec2::new(along_x * xu + along_y * yu, along_x * xv + along_y * yv)
    }

    fn at(&self, uv: Vec2) -> Spectrum {
        let uv = self.to_uv.apply(uv);
        let (x, y) = (uv.x * self.width as Real, uv.y * self.height as Real);
        if self.nearest {
            return self.texel(math::floor(x) as i64, math::floor(y) as i64);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (math::floor(x), math::floor(y));
        let (u, v) = (x - left, y - top);
        let (i, j) = (left as i64, top as i64);
        let upper = self.texel(i, j) * (1.0 - u) + self.texel(i + 1, j) * u;
        let lower = self.texel(i, j + 1) * (1.0 - u) + self.texel(i + 1, j + 1) * u;
        upper * (1.0 - v) + lower * v
    }

    fn texel(&self, x: i64, y: i64) -> Spectrum {
        let x = wrapped(x, i64::from(self.width), self.wrap);
        let y = wrapped(y, i64::from(self.height), self.wrap);
        self.texels.get(y * self.width as usize + x).unwrap_or(Spectrum::BLACK)
    }
}

/// Of linear sRGB (Rec. 709).
fn luminance(color: Spectrum) -> Real {
    0.212_671 * color[0] + 0.715_16 * color[1] + 0.072_169 * color[2]
}

fn wrapped(i: i64, size: i64, wrap: Wrap) -> usize {
    let i = match wrap {
        Wrap::Repeat => i.rem_euclid(size),
        Wrap::Clamp => i.clamp(0, size - 1),
        Wrap::Mirror => {
            let i = i.rem_euclid(2 * size);
            i.min(2 * size - 1 - i)
        }
    };
    i as usize
}
