//! Mitsuba's own format, `.serialized`: meshes one after the other, each compressed, and where they begin at the file's end.
//!
//! Counts are held against what so many bytes can unpack to before anything is kept, and memory grows with what was unpacked.

use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    path::Path,
};

use flate2::read::ZlibDecoder;

use super::Facets;
use crate::{
    error::{Error, Result},
    scene::description::{Attribute, Mesh, Per},
};

const FORMAT: u16 = 0x041c;
/// Without names, and with offsets of 4 bytes.
const THIRD: u16 = 3;
const FOURTH: u16 = 4;

const NORMALS: u32 = 0x1;
const UVS: u32 = 0x2;
const COLOURS: u32 = 0x8;
const FLAT: u32 = 0x10;
const DOUBLE: u32 = 0x2000;

/// What a compressed byte of a mesh may unpack to: DEFLATE could do four times as much, but no mesh does.
const MOST_OUT_OF_A_BYTE: u64 = 256;
/// As of other meshes' files.
const MOST_UNPACKED: u64 = super::MAX_BYTES;
/// Of a mesh's name.
const LONGEST_NAME: usize = 1 << 16;

type Told<T> = std::result::Result<T, String>;

/// The mesh with that index, from 0, and whether the file calls its triangles flat.
pub(super) fn read(bytes: &[u8], index: u32, path: &Path) -> Result<(Mesh, Facets)> {
    let fail = |thing: String| Error::in_file(path, thing, "export the mesh again, as PLY or OBJ");
    let (offset, meshes) = begin(bytes, index).map_err(fail)?;
    let Some(offset) = offset else {
        let thing = format!("has no mesh {index} (counted from 0): there are {meshes}");
        return Err(Error::in_file(path, thing, "mend shape_index"));
    };
    mesh(bytes.get(offset..).unwrap_or(&[])).map_err(fail)
}

/// The part of a file that holds a mesh, so that a file of many is not read whole for each; nothing where that cannot be told.
pub(super) fn part(path: &Path, index: u32) -> io::Result<Option<Vec<u8>>> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut start = [0; 4];
    file.read_exact(&mut start)?;
    let size = match header(&start) {
        Ok(THIRD) => 4_u64,
        Ok(_) => 8,
        Err(_) => return Ok(None),
    };
    let mut field = |at: u64, size: u64| {
        let mut bytes = [0; 8];
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut bytes[..size as usize])?;
        io::Result::Ok(u64::from_le_bytes(bytes))
    };
    let Some(end) = length.checked_sub(4) else { return Ok(None) };
    let count = field(end, 4)?;
    let Some(table) = count.checked_mul(size).and_then(|bytes| end.checked_sub(bytes)) else { return Ok(None) };
    let index = u64::from(index);
    if index >= count {
        return Ok(None);
    }
    let first = field(table + index * size, size)?;
    let last = if index + 1 < count { field(table + (index + 1) * size, size)? } else { table };
    if first >= last || last > table || last - first > MOST_UNPACKED {
        return Ok(None);
    }
    let mut part = vec![0; (last - first) as usize];
    file.seek(SeekFrom::Start(first))?;
    file.read_exact(&mut part)?;
    Ok(Some(part))
}

/// Where a mesh begins, if there is one, and how many there are.
fn begin(bytes: &[u8], index: u32) -> Told<(Option<usize>, u32)> {
    let version = header(bytes)?;
    if index == 0 {
        return Ok((Some(0), 1));
    }
    let early = || "the file ends too early".to_owned();
    let (rest, count) = bytes.split_last_chunk::<4>().ok_or_else(early)?;
    let count = u32::from_le_bytes(*count);
    if index >= count {
        return Ok((None, count));
    }
    let from_end = (count - index) as usize;
    let field = |size: usize| {
        let start = rest.len().checked_sub(size.checked_mul(from_end)?)?;
        rest.get(start..start + size)
    };
    let offset = if version == THIRD {
        field(4).and_then(|field| field.try_into().ok()).map(|field| u64::from(u32::from_le_bytes(field)))
    } else {
        field(8).and_then(|field| field.try_into().ok()).map(u64::from_le_bytes)
    };
    let offset = offset.and_then(|offset| usize::try_from(offset).ok()).filter(|offset| *offset < bytes.len());
    Ok((Some(offset.ok_or_else(|| format!("where mesh {index} begins is not in the file"))?), count))
}

/// The version.
fn header(bytes: &[u8]) -> Told<u16> {
    let Some(&[a, b, c, d]) = bytes.first_chunk::<4>() else { return Err("the file ends too early".into()) };
    if u16::from_le_bytes([a, b]) != FORMAT {
        return Err("it is no serialized mesh: it does not start with 1C 04".into());
    }
    match u16::from_le_bytes([c, d]) {
        version @ (THIRD | FOURTH) => Ok(version),
        other => Err(format!("version {other} of the format is unknown; there are 3 and 4")),
    }
}

fn mesh(bytes: &[u8]) -> Told<(Mesh, Facets)> {
    let version = header(bytes)?;
    let packed = &bytes[4..];
    let most = (packed.len() as u64).saturating_mul(MOST_OUT_OF_A_BYTE).saturating_add(LONGEST_NAME as u64).min(MOST_UNPACKED);
    let mut source = Source(BufReader::new(ZlibDecoder::new(packed).take(most)));
    let flags = u32::from_le_bytes(source.bytes()?);
    if version == FOURTH {
        source.name()?;
    }
    let [vertices, triangles] = [source.bytes()?, source.bytes()?].map(u64::from_le_bytes);
    let real: u64 = if flags & DOUBLE == 0 { 4 } else { 8 };
    let least = vertices.saturating_mul(3 * real).saturating_add(triangles.saturating_mul(12));
    if least > most || vertices > u64::from(u32::MAX) {
        return Err(format!("it announces {vertices} vertices and {triangles} triangles in {} bytes", bytes.len()));
    }
    let mut mesh = Mesh { positions: source.rows(vertices, real)?, ..Mesh::default() };
    if flags & NORMALS != 0 {
        mesh.normals = source.rows(vertices, real)?;
    }
    if flags & UVS != 0 {
        mesh.uvs = source.rows(vertices, real)?;
    }
    if flags & COLOURS != 0 {
        let values = source.rows(vertices, real)?;
        mesh.attributes.push(Attribute { name: "vertex_color".into(), per: Per::Vertex, values });
    }
    for _ in 0..triangles {
        let corner = |source: &mut Source| source.bytes().map(u32::from_le_bytes);
        mesh.triangles.push([corner(&mut source)?, corner(&mut source)?, corner(&mut source)?]);
    }
    Ok((mesh, if flags & FLAT == 0 { Facets::Smooth } else { Facets::Flat }))
}

/// What is unpacked.
struct Source<'a>(BufReader<io::Take<ZlibDecoder<&'a [u8]>>>);

impl Source<'_> {
    fn bytes<const N: usize>(&mut self) -> Told<[u8; N]> {
        let mut bytes = [0; N];
        self.0.read_exact(&mut bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => "the mesh ends too early".to_owned(),
            _ => format!("the mesh cannot be unpacked ({error})"),
        })?;
        Ok(bytes)
    }

    /// Passes over a text that ends with 0.
    fn name(&mut self) -> Told<()> {
        for _ in 0..LONGEST_NAME {
            if self.bytes()? == [0] {
                return Ok(());
            }
        }
        Err(format!("the mesh's name is longer than {LONGEST_NAME} bytes"))
    }

    fn rows<const N: usize>(&mut self, count: u64, real: u64) -> Told<Vec<[f32; N]>> {
        let mut rows = Vec::new();
        for _ in 0..count {
            let mut row = [0.0; N];
            for value in &mut row {
                *value = if real == 4 { f32::from_le_bytes(self.bytes()?) } else { f64::from_le_bytes(self.bytes()?) as f32 };
            }
            rows.push(row);
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::{Compression, write::ZlibEncoder};

    use super::*;

    /// A square with coordinates, each part of the stream as the format has it.
    fn square(version: u16, flags: u32, width: f64) -> Vec<u8> {
        let mut body = flags.to_le_bytes().to_vec();
        if version == FOURTH {
            body.extend(b"a square\0");
        }
        [4_u64, 2].into_iter().for_each(|count| body.extend(count.to_le_bytes()));
        let mut real = |values: &[f64]| {
            for value in values {
                if flags & DOUBLE == 0 { body.extend((*value as f32).to_le_bytes()) } else { body.extend(value.to_le_bytes()) }
            }
        };
        real(&[0.0, 0.0, 0.0, width, 0.0, 0.0, width, 1.0, 0.0, 0.0, 1.0, 0.0]);
        if flags & NORMALS != 0 {
            real(&[0.0, 0.0, 1.0].repeat(4));
        }
        if flags & UVS != 0 {
            real(&[0.0, 0.25, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
        }
        if flags & COLOURS != 0 {
            real(&[0.5; 12]);
        }
        [0_u32, 1, 2, 0, 2, 3].into_iter().for_each(|corner| body.extend(corner.to_le_bytes()));
        packed(version, &body)
    }

    fn packed(version: u16, body: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(body).unwrap();
        [&FORMAT.to_le_bytes()[..], &version.to_le_bytes(), &encoder.finish().unwrap()].concat()
    }

    fn file(version: u16, meshes: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = meshes.concat();
        let mut offset = 0;
        for mesh in meshes {
            if version == THIRD {
                bytes.extend((offset as u32).to_le_bytes())
            } else {
                bytes.extend((offset as u64).to_le_bytes())
            }
            offset += mesh.len();
        }
        bytes.extend((meshes.len() as u32).to_le_bytes());
        bytes
    }

    fn told(bytes: &[u8], index: u32) -> String {
        read(bytes, index, Path::new("m.serialized")).unwrap_err().to_string()
    }

    #[test]
    fn both_versions_and_both_precisions_give_the_same_mesh() {
        for version in [THIRD, FOURTH] {
            for precision in [0x1000, DOUBLE] {
                let flags = NORMALS | UVS | COLOURS | precision;
                let bytes = file(version, &[square(version, flags, 1.0), square(version, flags, 2.0)]);
                for (index, width) in [(0, 1.0), (1, 2.0)] {
                    let (mesh, facets) = read(&bytes, index, Path::new("m.serialized")).unwrap();
                    assert_eq!((mesh.positions[1], mesh.uvs[0], facets), ([width, 0.0, 0.0], [0.0, 0.25], Facets::Smooth));
                    assert_eq!((&mesh.attributes[0].name[..], mesh.attributes[0].values[3]), ("vertex_color", [0.5; 3]));
                    assert_eq!((mesh.normals, mesh.triangles), (vec![[0.0, 0.0, 1.0]; 4], vec![[0, 1, 2], [0, 2, 3]]));
                }
            }
        }
    }

    #[test]
    fn a_mesh_is_found_in_its_file_without_the_others() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.serialized");
        for version in [THIRD, FOURTH] {
            let meshes = [square(version, 0, 1.0), square(version, UVS, 2.0)];
            std::fs::write(&path, file(version, &meshes)).unwrap();
            for (index, mesh) in meshes.iter().enumerate() {
                assert_eq!(part(&path, index as u32).unwrap().as_ref(), Some(mesh));
            }
            assert_eq!(part(&path, 2).unwrap(), None);
            std::fs::write(&path, &meshes[0]).unwrap();
            assert_eq!(part(&path, 0).unwrap(), None, "without a table the whole file is read");
        }
    }

    #[test]
    fn a_file_may_say_that_its_triangles_are_flat() {
        let (mesh, facets) = read(&square(FOURTH, FLAT, 1.0), 0, Path::new("m.serialized")).unwrap();
        assert!(mesh.normals.is_empty() && mesh.uvs.is_empty());
        assert_eq!(facets, Facets::Flat);
    }

    #[test]
    fn an_index_beyond_the_last_mesh_is_told_with_how_many_there_are() {
        let bytes = file(FOURTH, &[square(FOURTH, 0, 1.0), square(FOURTH, 0, 2.0)]);
        assert!(told(&bytes, 2).contains("has no mesh 2 (counted from 0): there are 2"), "{}", told(&bytes, 2));
        let mut lies = bytes.clone();
        let end = lies.len() - 4;
        lies[end..].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(told(&lies, 1).contains("where mesh 1 begins is not in the file"));
    }

    #[test]
    fn a_file_cut_short_anywhere_is_an_error() {
        let whole = square(FOURTH, UVS, 1.0);
        // Of the checksum at the end nothing is asked.
        for end in 0..whole.len() - 8 {
            assert!(read(&whole[..end], 0, Path::new("m.serialized")).is_err(), "{end}");
        }
    }

    #[test]
    fn counts_beyond_what_the_file_can_hold_take_no_memory() {
        let counts = |vertices: u64, triangles: u64| {
            let body = [&0_u32.to_le_bytes()[..], b"\0", &vertices.to_le_bytes(), &triangles.to_le_bytes()].concat();
            told(&packed(FOURTH, &body), 0)
        };
        for (vertices, triangles) in [(u64::MAX, 1), (1, u64::MAX), (1 << 40, 1 << 40)] {
            assert!(counts(vertices, triangles).contains("announces"), "{}", counts(vertices, triangles));
        }
        assert!(counts(100, 1).contains("ends too early"));
    }

    #[test]
    fn what_is_no_serialized_mesh_is_told() {
        assert!(told(b"ply\n", 0).contains("it is no serialized mesh"));
        assert!(told(&[0x1c, 4, 5, 0], 0).contains("version 5"));
        assert!(told(&[0x1c, 4, 4, 0, 1, 2, 3, 4], 0).contains("cannot be unpacked"));
    }
}
