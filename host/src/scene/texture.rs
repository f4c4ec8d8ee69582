//! Looking a texture up.

use bidir_kernel::{Real, Spectrum, Vec2, math};

use crate::scene::description::{Bitmap, Mesh, Per, Texture, UvTransform, Wrap};

/// Where on a surface a texture is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// The surface's.
    pub uv: Vec2,
    /// Where in its mesh.
    pub face: Face,
}

/// Where in a mesh; of no meaning where no texture asks for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Face {
    /// The number of the triangle.
    pub triangle: u32,
    /// The weight of its second corner.
    pub b1: Real,
    /// The weight of its third corner.
    pub b2: Real,
}

impl From<Vec2> for Coordinates {
    fn from(uv: Vec2) -> Self {
        Self { uv, face: Face::default() }
    }
}

impl UvTransform {
    fn apply(&self, uv: Vec2) -> Vec2 {
        let Self([[a, b, c], [d, e, f]]) = self;
        Vec2::new(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f)
    }
}

impl Texture {
    /// The texture's value there; an attribute asks for the face, all others for uv alone.
    #[inline]
    pub fn at(&self, at: impl Into<Coordinates>) -> Spectrum {
        let at = at.into();
        match self {
            Self::Constant(value) => *value,
            Self::Bitmap(bitmap) => bitmap.at(at.uv),
            Self::Checkerboard { color0, color1, to_uv } => {
                let uv = to_uv.apply(at.uv);
                let half = |x: Real| x - math::floor(x) > 0.5;
                if half(uv.x) == half(uv.y) { *color0 } else { *color1 }
            }
            Self::Attribute { mesh, index, scale } => attribute(mesh, *index, at.face).unwrap_or(Spectrum::BLACK) * *scale,
        }
    }
}

/// What a mesh says of a place on it; nothing if it has no such place.
fn attribute(mesh: &Mesh, index: usize, Face { triangle, b1, b2 }: Face) -> Option<Spectrum> {
    let attribute = mesh.attributes.get(index)?;
    let value = |of: u32| attribute.values.get(of as usize).copied().map(Spectrum);
    match attribute.per {
        Per::Triangle => value(triangle),
        Per::Vertex => {
            let [a, b, c] = *mesh.triangles.get(triangle as usize)?;
            Some(value(a)? * (1.0 - b1 - b2) + value(b)? * b1 + value(c)? * b2)
        }
    }
}

impl Texture {
    /// Over a whole period; a bitmap's over its texels.
    pub fn mean(&self) -> Spectrum {
        match self {
            Self::Constant(value) => *value,
            Self::Bitmap(bitmap) => bitmap.texels.mean(),
            Self::Checkerboard { color0, color1, .. } => (*color0 + *color1) * 0.5,
            Self::Attribute { mesh, index, scale } => {
                let values = mesh.attributes.get(*index).map_or(&[][..], |attribute| &attribute.values);
                let sum = values.iter().fold(Spectrum::BLACK, |sum, value| sum + Spectrum(*value));
                sum * (*scale / values.len().max(1) as Real)
            }
        }
    }

    /// How fast its luminance grows with u and v.
    pub fn slope(&self, uv: Vec2) -> Vec2 {
        match self {
            Self::Bitmap(bitmap) => bitmap.slope(uv),
            // Steps have no slope.
            Self::Constant(_) | Self::Checkerboard { .. } => Vec2::ZERO,
            // The loader lets only images be heights.
            Self::Attribute { .. } => Vec2::ZERO,
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::scene::description::Attribute;

    #[test]
    fn an_attribute_is_mixed_between_vertices_and_the_same_all_over_a_triangle() {
        let [red, green, blue] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let vertices = Attribute { name: "vertex_color".into(), per: Per::Vertex, values: vec![red, green, blue] };
        let triangles = Attribute { name: "face_color".into(), per: Per::Triangle, values: vec![red, blue] };
        let mesh = Arc::new(Mesh { triangles: vec![[0, 1, 2], [2, 1, 0]], attributes: vec![vertices, triangles], ..Mesh::default() });
        let at = |index, triangle| {
            let texture = Texture::Attribute { mesh: mesh.clone(), index, scale: 2.0 };
            texture.at(Coordinates { uv: Vec2::ZERO, face: Face { triangle, b1: 0.25, b2: 0.5 } })
        };
        assert_eq!(at(0, 0), Spectrum([0.5, 0.5, 1.0]));
        assert_eq!(at(0, 1), Spectrum([1.0, 0.5, 0.5]));
        assert_eq!((at(1, 0), at(1, 1)), (Spectrum([2.0, 0.0, 0.0]), Spectrum([0.0, 0.0, 2.0])));
        assert_eq!((at(0, 9), at(9, 0)), (Spectrum::BLACK, Spectrum::BLACK));
    }
}
