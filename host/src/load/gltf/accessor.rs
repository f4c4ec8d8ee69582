//! Accessors: numbers in buffers.

use ::gltf::json::{
    Accessor, Index,
    accessor::{ComponentType, GenericComponentType, IndexComponentType, sparse::Sparse},
    validation::Checked,
};

use super::asset::{Asset, DAMAGED, label};
use crate::error::Result;

/// The most elements of an accessor that has no bytes, but zeros.
const MAX_ZEROS: u64 = 1 << 24;

/// Where elements lie in bytes.
struct Layout<'a> {
    bytes: &'a [u8],
    start: u64,
    stride: u64,
    component: ComponentType,
    normalized: bool,
}

impl Layout<'_> {
    /// Whether `count` elements of `size` bytes lie in it.
    fn holds(&self, count: u64, size: u64) -> bool {
        let end = |last: u64| last.checked_mul(self.stride)?.checked_add(self.start)?.checked_add(size);
        count == 0 || end(count - 1).is_some_and(|end| end <= self.bytes.len() as u64)
    }

    fn element<T: Copy, const N: usize>(&self, at: u64, read: Read<T>) -> Option<[T; N]> {
        let size = self.component.size();
        let first = usize::try_from(at.checked_mul(self.stride)?.checked_add(self.start)?).ok()?;
        let bytes = self.bytes.get(first..first.checked_add(N * size)?)?;
        let mut found = [read(self.component, self.normalized, bytes)?; N];
        for (value, bytes) in found.iter_mut().zip(bytes.chunks_exact(size)) {
            *value = read(self.component, self.normalized, bytes)?;
        }
        Some(found)
    }
}

/// Reads a component at the beginning of bytes, of some type, as a fraction or not; `None` for what it may not be.
type Read<T> = fn(ComponentType, bool, &[u8]) -> Option<T>;

impl Asset {
    /// Vectors of `N` floats, or of whole numbers that stand for such.
    pub(super) fn floats<const N: usize>(&self, index: Index<Accessor>, what: &str) -> Result<Vec<[f32; N]>> {
        self.elements(index, what, float)
    }

    /// Whole numbers.
    pub(super) fn whole(&self, index: Index<Accessor>, what: &str) -> Result<Vec<u32>> {
        Ok(self.elements::<u32, 1>(index, what, whole)?.into_iter().map(|[value]| value).collect())
    }

    fn elements<T: Copy + Default, const N: usize>(&self, index: Index<Accessor>, what: &str, read: Read<T>) -> Result<Vec<[T; N]>> {
        let Some(accessor) = self.root.get(index) else { return Err(self.missing(&format!("accessor {}", index.value()))) };
        let name = format!("{}, the {what},", label("accessor", index.value(), accessor.name.as_ref()));
        let fail = |thing: String| self.error(format!("{name} {thing}"), DAMAGED);
        let Checked::Valid(GenericComponentType(component)) = accessor.component_type else {
            return Err(fail("is of no type that glTF has".into()));
        };
        match accessor.type_ {
            Checked::Valid(kind) if kind.multiplicity() == N => {}
            _ => return Err(fail(format!("has not {N} numbers in each element"))),
        }
        let count = accessor.count.0;
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let bytes = self.view(view)?;
                let size = (N * component.size()) as u64;
                let stride = self.root.get(view).and_then(|view| view.byte_stride).map_or(size, |stride| stride.0 as u64);
                let start = accessor.byte_offset.unwrap_or_default().0;
                let layout = Layout { bytes, start, stride, component, normalized: accessor.normalized };
                if stride < size || !layout.holds(count, size) {
                    let thing = format!("has {count} elements of {size} bytes, {stride} apart, from {start} of {} bytes", bytes.len());
                    return Err(fail(thing));
                }
                let elements = (0..count).map(|at| layout.element(at, read));
                elements.collect::<Option<Vec<_>>>().ok_or_else(|| fail(format!("cannot be of {component:?}")))?
            }
            None if count <= MAX_ZEROS => vec![[T::default(); N]; count as usize],
            None => return Err(fail(format!("has {count} elements and no bytes"))),
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&mut values, sparse, component, accessor.normalized, read)
                .map_err(|e| fail(format!("is sparse, and {}", e.thing)))?;
        }
        Ok(values)
    }

    /// Puts a sparse accessor's values in their places.
    fn replace<T: Copy, const N: usize>(
        &self,
        values: &mut [[T; N]],
        sparse: &Sparse,
        component: ComponentType,
        normalized: bool,
        read: Read<T>,
    ) -> Result<()> {
        let Checked::Valid(IndexComponentType(of_index)) = sparse.indices.component_type else {
            return Err(self.error("its indices are no whole numbers", DAMAGED));
        };
        let (bytes, start) = (self.view(sparse.indices.buffer_view)?, sparse.indices.byte_offset.0);
        let indices = Layout { bytes, start, stride: of_index.size() as u64, component: of_index, normalized: false };
        let (bytes, start) = (self.view(sparse.values.buffer_view)?, sparse.values.byte_offset.0);
        let new = Layout { bytes, start, stride: (N * component.size()) as u64, component, normalized };
        let outside = || self.error("its values lie outside their buffer, or name elements that are not there", DAMAGED);
        for at in 0..sparse.count.0 {
            let [index] = indices.element::<u32, 1>(at, whole).ok_or_else(outside)?;
            let value = new.element(at, read).ok_or_else(outside)?;
            *values.get_mut(index as usize).ok_or_else(outside)? = value;
        }
        Ok(())
    }
}

/// Whole numbers stand for fractions where they are normalized (glTF 2.0, §3.6.2.2), and for themselves where KHR_mesh_quantization says so.
fn float(component: ComponentType, normalized: bool, bytes: &[u8]) -> Option<f32> {
    let (value, most) = match component {
        ComponentType::F32 => return Some(f32::from_le_bytes(*bytes.first_chunk()?)),
        ComponentType::I8 => (f32::from(i8::from_le_bytes(*bytes.first_chunk()?)), 127.0),
        ComponentType::U8 => (f32::from(*bytes.first()?), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes(*bytes.first_chunk()?)), 32767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes(*bytes.first_chunk()?)), 65535.0),
        ComponentType::U32 => return None,
    };
    Some(if normalized { (value / most).max(-1.0) } else { value })
}

fn whole(component: ComponentType, _: bool, bytes: &[u8]) -> Option<u32> {
    match component {
        ComponentType::U8 => bytes.first().map(|byte| (*byte).into()),
        ComponentType::U16 => Some(u16::from_le_bytes(*bytes.first_chunk()?).into()),
        ComponentType::U32 => Some(u32::from_le_bytes(*bytes.first_chunk()?)),
        ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => None,
    }
}
