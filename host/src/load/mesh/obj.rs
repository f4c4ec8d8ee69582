//! Wavefront OBJ: `v`, `vt`, `vn` and `f`; everything else is passed over, as Mitsuba does.
//!
//! An own reader, because messages name the line, and because a corner without a normal must not borrow another's.

use std::{collections::HashMap, path::Path};

use crate::{
    error::{Error, Place, Result},
    scene::description::Mesh,
};

/// A corner's position, texture coordinate and normal, from 0.
type Corner = (u32, Option<u32>, Option<u32>);

/// Reads a mesh; polygons become fans.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Mesh> {
    let mut reader = Reader::default();
    for (number, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let fail = |thing: String| {
            let place = Place { file: path.to_owned(), position: Some((number as u32 + 1, 1)) };
            Error::at(&place, thing, "mend the line, or export the mesh again")
        };
        // Names may be in any encoding; what matters here is ASCII.
        let Ok(line) = std::str::from_utf8(line) else {
            if matches!(line.split(u8::is_ascii_whitespace).find(|w| !w.is_empty()), Some(b"v" | b"vt" | b"vn" | b"f")) {
                return Err(fail("the line is not text".into()));
            }
            continue;
        };
        reader.line(line).map_err(fail)?;
    }
    reader.mesh(path)
}

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    corners: Vec<Corner>,
    vertices: HashMap<Corner, u32>,
    triangles: Vec<[u32; 3]>,
}

impl Reader {
    fn line(&mut self, line: &str) -> std::result::Result<(), String> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => self.positions.push(numbers(words)?),
            Some("vt") => self.uvs.push(numbers(words)?),
            Some("vn") => self.normals.push(numbers(words)?),
            Some("f") => return self.face(words),
            _ => {}
        }
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> std::result::Result<(), String> {
        let mut face: Vec<u32> = Vec::with_capacity(4);
        for word in words.take_while(|w| !w.starts_with('#')) {
            let mut parts = word.split('/');
            let position = index(parts.next(), self.positions.len(), word)?.ok_or_else(|| format!("\"{word}\" names no vertex"))?;
            let corner = (position, index(parts.next(), self.uvs.len(), word)?, index(parts.next(), self.normals.len(), word)?);
            let next = self.corners.len() as u32;
            let vertex = *self.vertices.entry(corner).or_insert(next);
            if vertex == next {
                self.corners.push(corner);
            }
            face.push(vertex);
        }
        if face.len() < 3 {
            return Err(format!("a face with {} corners", face.len()));
        }
        self.triangles.extend(face[1..].windows(2).map(|pair| [face[0], pair[0], pair[1]]));
        Ok(())
    }

    fn mesh(self, path: &Path) -> Result<Mesh> {
        if self.corners.len() > u32::MAX as usize / 2 {
            return Err(Error::in_file(path, "has more than 2^31 vertices", "split it"));
        }
        // What only some corners have is 0 for the rest: there, the triangle's own normal is used.
        let normal = |c: &Corner| c.2.map_or([0.0; 3], |n| self.normals[n as usize]);
        let uv = |c: &Corner| c.1.map_or([0.0; 2], |t| self.uvs[t as usize]);
        let any_normals = self.corners.iter().any(|c| c.2.is_some());
        let any_uvs = self.corners.iter().any(|c| c.1.is_some());
        Ok(Mesh {
            positions: self.corners.iter().map(|c| self.positions[c.0 as usize]).collect(),
            normals: if any_normals { self.corners.iter().map(normal).collect() } else { Vec::new() },
            uvs: if any_uvs { self.corners.iter().map(uv).collect() } else { Vec::new() },
            triangles: self.triangles,
            attributes: Vec::new(),
        })
    }
}

/// The first N numbers; what follows (a weight, a colour) is passed over.
fn numbers<'a, const N: usize>(mut words: impl Iterator<Item = &'a str>) -> std::result::Result<[f32; N], String> {
    let mut out = [0.0; N];
    for value in &mut out {
        let word = words.next().ok_or_else(|| format!("fewer than {N} numbers"))?;
        *value = word.parse().map_err(|_| format!("\"{word}\" is not a number"))?;
    }
    Ok(out)
}

/// An index from 0 out of one from 1, or backwards from −1, or none.
fn index(text: Option<&str>, count: usize, word: &str) -> std::result::Result<Option<u32>, String> {
    let Some(text) = text.filter(|t| !t.is_empty()) else { return Ok(None) };
    let number: i64 = text.parse().map_err(|_| format!("\"{word}\" is not a corner"))?;
    let from_zero = if number < 0 { count as i64 + number } else { number - 1 };
    match u32::try_from(from_zero) {
        Ok(index) if (index as usize) < count => Ok(Some(index)),
        _ => Err(format!("\"{word}\" names number {number}, but there are only {count} so far")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(text: &str) -> Result<Mesh> {
        read(text.as_bytes(), Path::new("m.obj"))
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn polygons_become_fans() {
        assert_eq!(mesh(&format!("{SQUARE}f 1 2 3 4\n")).unwrap().triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn negative_indices_count_backwards() {
        let mesh = mesh(&format!("{SQUARE}f -4 -3 -2\r\n")).unwrap();
        assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    }

    #[test]
    fn corners_that_differ_in_uv_or_normal_are_vertices_of_their_own() {
        let mesh = mesh(&format!("{SQUARE}vt 0 0\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\nf 1/2 3/1/1 4//1\n")).unwrap();
        assert_eq!(mesh.positions.len(), 5);
        assert_eq!(mesh.normals[3], [0.0; 3]);
        assert_eq!(mesh.uvs[3], [1.0, 0.0]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (line, thing) in [
            ("v 1 2", "fewer than 3"),
            ("v 1 2 x", "is not a number"),
            ("f 1 2", "a face with 2 corners"),
            ("f 1 2 5", "only 4"),
            ("f 0 1 2", "only 4"),
            ("f 1 2 -5", "only 4"),
            ("f 1/1 2 3", "only 0"),
            ("f a 2 3", "not a corner"),
            ("f 99999999999999999999 2 3", "not a corner"),
        ] {
            let error = mesh(&format!("{SQUARE}{line}\n")).unwrap_err().to_string();
            assert!(error.starts_with("m.obj:5:1: ") && error.contains(thing), "{error}");
        }
    }
}
