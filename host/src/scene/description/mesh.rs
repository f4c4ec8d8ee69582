//! Meshes.

/// Triangles with shared vertices.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions, finite.
    pub positions: Vec<[f32; 3]>,
    /// One per vertex, or none: then the triangles are flat. Any length; zero falls back to the triangle's own.
    pub normals: Vec<[f32; 3]>,
    /// One per vertex, or none.
    pub uvs: Vec<[f32; 2]>,
    /// Corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// What else is known of its vertices or triangles, for textures.
    pub attributes: Vec<Attribute>,
}

/// Values of a mesh's vertices or triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// As Mitsuba calls it, such as `vertex_color`.
    pub name: String,
    /// What there is one of them for.
    pub per: Per,
    /// Three bands each; of a number, all the same.
    pub values: Vec<[f32; 3]>,
}

/// What an attribute has one value for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// Each vertex; in between, values are mixed.
    Vertex,
    /// Each triangle.
    Triangle,
}
