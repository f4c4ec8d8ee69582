//! Stanford PLY: ascii and binary, either byte order.
//!
//! An own reader, because it checks every count against the bytes that are there before it takes memory for it,
//! and decodes only the properties of a mesh.

mod attributes;

use std::path::Path;

use self::attributes::{Group, groups};
use super::super::suggest::did_you_mean;
use crate::{
    error::{Error, Result},
    scene::description::{Attribute, Mesh, Per},
};

/// Reads a mesh; polygons become fans, and elements other than vertices and faces are passed over.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Mesh> {
    let fail = |thing: String| Error::in_file(path, thing, "export the mesh again as PLY");
    let (header, body) = header(bytes).map_err(fail)?;
    let mut source = Source { rest: body, format: header.format };
    let mut mesh = Mesh::default();
    if header.elements.iter().filter(|element| element.name == "vertex").count() > 1 {
        return Err(fail("there are two elements \"vertex\"".into()));
    }
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices(&mut source, element, &mut mesh),
            "face" => faces(&mut source, element, &mut mesh),
            _ => (0..element.count).try_for_each(|_| element.properties.iter().try_for_each(|p| source.property(p).map(|_| ()))),
        }
        .map_err(|thing| fail(format!("element {}: {thing}", element.name)))?;
    }
    // Faces may come in several elements; those of only some of them have no say.
    mesh.attributes.retain(|attribute| attribute.per == Per::Vertex || attribute.values.len() == mesh.triangles.len());
    Ok(mesh)
}

type Told<T> = std::result::Result<T, String>;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Ascii,
    Little,
    Big,
}

#[derive(Clone, Copy)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Told<Self> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return Err(format!("the type \"{name}\" is unknown")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

struct Property {
    name: String,
    /// The type of a list's length.
    length: Option<Scalar>,
    item: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    format: Format,
    elements: Vec<Element>,
}

fn header(bytes: &[u8]) -> Told<(Header, &[u8])> {
    let mut rest = bytes;
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    if next_line(&mut rest)? != "ply" {
        return Err("it does not start with \"ply\"".into());
    }
    loop {
        let line = next_line(&mut rest)?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words.as_slice() {
            ["format", "ascii", _] => format = Some(Format::Ascii),
            ["format", "binary_little_endian", _] => format = Some(Format::Little),
            ["format", "binary_big_endian", _] => format = Some(Format::Big),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| format!("\"{line}\" has no count"))?;
                elements.push(Element { name: (*name).into(), count, properties: Vec::new() });
            }
            ["property", kind @ .., name] => {
                let (length, item) = match kind {
                    ["list", length, item] => (Some(Scalar::named(length)?), Scalar::named(item)?),
                    [item] => (None, Scalar::named(item)?),
                    _ => return Err(format!("the header line \"{line}\" is unknown")),
                };
                let owner = elements.last_mut().ok_or("a property before any element")?;
                owner.properties.push(Property { name: (*name).into(), length, item });
            }
            ["comment" | "obj_info", ..] | [] => {}
            ["end_header"] => break,
            _ => return Err(format!("the header line \"{line}\" is unknown")),
        }
    }
    let format = format.ok_or("the header has no format")?;
    // An element takes a byte at least, so that no count is larger than the file.
    if let Some(e) = elements.iter().find(|e| e.count > rest.len() && !e.properties.is_empty()) {
        return Err(format!("it announces {} elements \"{}\" in {} bytes", e.count, e.name, rest.len()));
    }
    elements.retain(|e| !e.properties.is_empty());
    Ok((Header { format, elements }, rest))
}

fn next_line<'a>(rest: &mut &'a [u8]) -> Told<&'a str> {
    let end = rest.iter().position(|&b| b == b'\n').ok_or("the header does not end")?;
    let line = std::str::from_utf8(&rest[..end]).map_err(|_| "the header is not text")?;
    *rest = &rest[end + 1..];
    Ok(line.trim())
}

/// What has not been read yet.
struct Source<'a> {
    rest: &'a [u8],
    format: Format,
}

impl Source<'_> {
    fn scalar(&mut self, kind: Scalar) -> Told<f64> {
        if self.format == Format::Ascii {
            let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).ok_or("the file ends too early")?;
            let word = &self.rest[start..];
            let end = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
            self.rest = &word[end..];
            let text = std::str::from_utf8(&word[..end]).map_err(|_| "not text")?;
            return text.parse().map_err(|_| format!("\"{text}\" is not a number"));
        }
        let size = kind.size();
        let (head, tail) = self.rest.split_at_checked(size).ok_or("the file ends too early")?;
        self.rest = tail;
        let mut bytes = [0; 8];
        for (i, byte) in bytes[..size].iter_mut().enumerate() {
            *byte = head[if self.format == Format::Big { size - 1 - i } else { i }];
        }
        let bits = u64::from_le_bytes(bytes);
        Ok(match kind {
            Scalar::I8 => f64::from(bits as i8),
            Scalar::U8 => f64::from(bits as u8),
            Scalar::I16 => f64::from(bits as i16),
            Scalar::U16 => f64::from(bits as u16),
            Scalar::I32 => f64::from(bits as i32),
            Scalar::U32 => f64::from(bits as u32),
            Scalar::F32 => f64::from(f32::from_bits(bits as u32)),
            Scalar::F64 => f64::from_bits(bits),
        })
    }

    /// How many items follow.
    fn length(&mut self, property: &Property) -> Told<usize> {
        let Some(kind) = property.length else { return Ok(1) };
        let length = self.scalar(kind)?;
        if length < 0.0 || length != length.trunc() || length > self.rest.len() as f64 {
            return Err(format!("a list of {length} items"));
        }
        Ok(length as usize)
    }

    /// Reads a property and returns its last value.
    fn property(&mut self, property: &Property) -> Told<f64> {
        let mut last = 0.0;
        for _ in 0..self.length(property)? {
            last = self.scalar(property.item)?;
        }
        Ok(last)
    }
}

impl Element {
    /// Its attributes, still without values.
    fn attributes(&self, kind: &str, per: Per) -> Vec<(Group, Attribute)> {
        let names: Vec<_> = self.properties.iter().map(|p| p.length.is_none().then_some(p.name.as_str())).collect();
        let empty = |group: Group| {
            let attribute = Attribute { name: group.name.clone(), per, values: Vec::new() };
            (group, attribute)
        };
        groups(kind, &names).into_iter().map(empty).collect()
    }
}

/// An attribute's value in a row of properties; a number is every band.
fn value(group: &Group, row: &[f64]) -> [f32; 3] {
    std::array::from_fn(|band| row[group.at[band.min(group.at.len() - 1)]] as f32)
}

fn vertices(source: &mut Source, element: &Element, mesh: &mut Mesh) -> Told<()> {
    let find = |names: &[&str]| element.properties.iter().position(|p| p.length.is_none() && names.contains(&p.name.as_str()));
    let need = |name: &str| find(&[name]).ok_or_else(|| format!("there is no property \"{name}\""));
    let position = [need("x")?, need("y")?, need("z")?];
    let normal = [find(&["nx"]), find(&["ny"]), find(&["nz"])];
    let uv = [find(&["u", "s", "texture_u"]), find(&["v", "t", "texture_v"])];
    let mut row = vec![0.0; element.properties.len()];
    let mut attributes = element.attributes("vertex_", Per::Vertex);
    for _ in 0..element.count {
        for (value, property) in row.iter_mut().zip(&element.properties) {
            *value = source.property(property)?;
        }
        mesh.positions.push(position.map(|at| row[at] as f32));
        if let [Some(x), Some(y), Some(z)] = normal {
            mesh.normals.push([x, y, z].map(|at| row[at] as f32));
        }
        if let [Some(u), Some(v)] = uv {
            mesh.uvs.push([u, v].map(|at| row[at] as f32));
        }
        for (group, attribute) in &mut attributes {
            attribute.values.push(value(group, &row));
        }
    }
    mesh.attributes.extend(attributes.into_iter().map(|(_, attribute)| attribute));
    Ok(())
}

fn faces(source: &mut Source, element: &Element, mesh: &mut Mesh) -> Told<()> {
    let is_corners = |p: &Property| p.length.is_some() && ["vertex_indices", "vertex_index"].contains(&p.name.as_str());
    if !element.properties.iter().any(is_corners) {
        let has: Vec<&str> = element.properties.iter().map(|p| p.name.as_str()).collect();
        return Err(format!("there is no list \"vertex_indices\" {}", did_you_mean("vertex_indices", &has)).trim_end().into());
    }
    let mut corners = Vec::new();
    let mut row = vec![0.0; element.properties.len()];
    let mut attributes = element.attributes("face_", Per::Triangle);
    let before = mesh.triangles.len();
    for _ in 0..element.count {
        for (last, property) in row.iter_mut().zip(&element.properties) {
            if !is_corners(property) {
                *last = source.property(property)?;
                continue;
            }
            corners.clear();
            for _ in 0..source.length(property)? {
                let index = source.scalar(property.item)?;
                if !(0.0..4_294_967_295.0).contains(&index) || index != index.trunc() {
                    return Err(format!("a face names vertex {index}"));
                }
                corners.push(index as u32);
            }
            if corners.len() < 3 {
                return Err(format!("a face with {} corners", corners.len()));
            }
            mesh.triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
        }
        for (group, attribute) in &mut attributes {
            attribute.values.resize(mesh.triangles.len() - before, value(group, &row));
        }
    }
    mesh.attributes.extend(attributes.into_iter().map(|(_, attribute)| attribute));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(bytes: &[u8]) -> Result<Mesh> {
        read(bytes, Path::new("m.ply"))
    }

    fn ascii(vertices: &str, faces: &str) -> Vec<u8> {
        let counts = (vertices.lines().count(), faces.lines().count());
        format!(
            "ply\r\nformat ascii 1.0\r\ncomment c\nelement vertex {}\nproperty float x\nproperty double y\nproperty float z\n\
             property float s\nproperty float t\nelement face {}\nproperty uchar flags\nproperty list uchar int vertex_index\nend_header\n{vertices}\n{faces}",
            counts.0, counts.1
        )
        .into_bytes()
    }

    const SQUARE: &str = "0 0 0 .1 .2\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1";

    #[test]
    fn ascii_polygons_become_fans() {
        let mesh = mesh(&ascii(SQUARE, "7 4 0 1 2 3")).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.uvs[0], [0.1, 0.2]);
        assert!(mesh.normals.is_empty());
    }

    fn binary(format: &str, number: fn(f32) -> [u8; 4], index: fn(u16) -> [u8; 2]) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list uint8 uint16 vertex_indices\nend_header\n"
        )
        .into_bytes();
        for v in [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 2.5, 0.0, 0.0, 0.0, 1.0] {
            bytes.extend(number(v));
        }
        bytes.push(3);
        [0, 1, 2].into_iter().for_each(|i| bytes.extend(index(i)));
        bytes
    }

    #[test]
    fn both_byte_orders_give_the_same_mesh() {
        let little = mesh(&binary("binary_little_endian", f32::to_le_bytes, u16::to_le_bytes)).unwrap();
        let big = mesh(&binary("binary_big_endian", f32::to_be_bytes, u16::to_be_bytes)).unwrap();
        assert_eq!((&little.positions, &little.normals, &little.triangles), (&big.positions, &big.normals, &big.triangles));
        assert_eq!(little.positions[2], [0.0, 2.5, 0.0]);
        assert_eq!(little.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn each_triangle_of_a_polygon_has_the_polygons_colour() {
        let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar heat_x\n\
                      element face 2\nproperty float r\nproperty float g\nproperty float b\nproperty list uchar int vertex_index\nend_header\n";
        let text = format!("{header}0 0 0 9\n1 0 0 8\n1 1 0 7\n0 1 0 6\n.1 .2 .3 4 0 1 2 3\n.4 .5 .6 3 0 1 2\n");
        let mesh = mesh(text.as_bytes()).unwrap();
        let values = |name: &str| mesh.attributes.iter().find(|attribute| attribute.name == name).map(|attribute| &attribute.values[..]);
        assert_eq!(values("vertex_heat"), Some(&[[9.0; 3], [8.0; 3], [7.0; 3], [6.0; 3]][..]));
        assert_eq!(values("face_color"), Some(&[[0.1, 0.2, 0.3], [0.1, 0.2, 0.3], [0.4, 0.5, 0.6]][..]));
    }

    #[test]
    fn a_file_cut_short_anywhere_is_an_error() {
        let whole = binary("binary_little_endian", f32::to_le_bytes, u16::to_le_bytes);
        for end in 0..whole.len() {
            assert!(mesh(&whole[..end]).is_err(), "{end}");
        }
    }

    #[test]
    fn counts_beyond_the_file_take_no_memory() {
        let header = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n";
        assert!(mesh(header.as_bytes()).unwrap_err().to_string().contains("announces"));
        assert!(mesh(&ascii(SQUARE, "7 4000000000 0 1 2")).is_err());
    }

    #[test]
    fn a_second_list_of_vertices_is_refused() {
        let vertices = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
        let text = format!("ply\nformat ascii 1.0\n{vertices}{vertices}end_header\n0 0 0\n0 0 0\n");
        assert!(mesh(text.as_bytes()).unwrap_err().to_string().contains("two elements \"vertex\""));
    }

    #[test]
    fn faces_that_are_none_are_refused() {
        for faces in ["7 2 0 1", "7 3 0 1 -1", "7 3 0 1 x", "7 3 0 1 1.5"] {
            assert!(mesh(&ascii(SQUARE, faces)).is_err(), "{faces}");
        }
    }
}
