//! Typed reading of accessors: every offset, count and index is checked against the bytes that are there.

use ::gltf::json;
use json::accessor::{ComponentType, Type};
use json::validation::Checked;

use super::buffers::Buffers;

/// The elements of an accessor, before sparse replacement.
struct Elements<'a> {
    /// From the first element on; `None`: all zeros.
    bytes: Option<&'a [u8]>,
    stride: usize,
}

impl<'a> Elements<'a> {
    /// Returns the bytes of an element of `size` bytes.
    fn get(&self, index: usize, size: usize) -> &'a [u8] {
        const ZEROS: [u8; 16] = [0; 16];
        let bytes = match self.bytes {
            None => ZEROS.get(..size),
            Some(bytes) => bytes.get(index * self.stride..).and_then(|bytes| bytes.get(..size)),
        };
        bytes.unwrap_or_default()
    }
}

/// What an accessor holds, checked.
#[derive(Clone, Copy)]
struct Shape {
    count: usize,
    component: ComponentType,
    /// How many components each element has.
    width: usize,
    normalized: bool,
}

impl Shape {
    fn element_bytes(&self) -> usize {
        self.component.size() * self.width
    }
}

impl Buffers<'_> {
    /// Returns the number of elements of an accessor.
    ///
    /// # Errors
    /// If there is no such accessor.
    pub(super) fn accessor_count(&self, index: usize) -> Result<u64, String> {
        Ok(self.accessor(index)?.count.0)
    }

    /// Reads an accessor of vectors as f32, normalised integers as glTF says; at most `max_count` elements.
    ///
    /// Vectors of fewer than `N` components are filled up from `fill`, as far as `least` allows.
    ///
    /// # Errors
    /// Says which part of the accessor is wrong and what is allowed.
    pub(super) fn vectors<const N: usize>(
        &self,
        index: usize,
        least: usize,
        fill: [f32; N],
        max_count: usize,
    ) -> Result<Vec<[f32; N]>, String> {
        let shape = self.shape(index, max_count)?;
        if !(least..=N).contains(&shape.width) {
            let range = if least == N { format!("{N}") } else { format!("{least} or {N}") };
            return Err(format!("has {} components per element (allowed: {range})", shape.width));
        }
        if shape.component == ComponentType::U32 {
            return Err("holds 32-bit integers (allowed: floats, 8-bit and 16-bit integers)".into());
        }
        let mut vectors = vec![fill; shape.count];
        let read = |vector: &mut [f32; N], bytes: &[u8]| {
            for (value, bytes) in vector.iter_mut().zip(bytes.chunks_exact(shape.component.size())) {
                *value = component_f32(&shape, bytes);
            }
        };
        self.for_each(index, shape, |i, bytes| {
            if let Some(vector) = vectors.get_mut(i) {
                read(vector, bytes);
            }
        })?;
        Ok(vectors)
    }

    /// Reads an accessor of indices; at most `max_count`.
    ///
    /// # Errors
    /// Says which part of the accessor is wrong and what is allowed.
    pub(super) fn indices(&self, index: usize, max_count: usize) -> Result<Vec<u32>, String> {
        let shape = self.shape(index, max_count)?;
        let unsigned = matches!(shape.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if shape.width != 1 || !unsigned {
            return Err("does not hold indices (allowed: SCALAR of unsigned integers)".into());
        }
        let mut indices = vec![0u32; shape.count];
        self.for_each(index, shape, |i, bytes| {
            if let Some(value) = indices.get_mut(i) {
                *value = unsigned_integer(bytes);
            }
        })?;
        Ok(indices)
    }

    fn accessor(&self, index: usize) -> Result<&json::Accessor, String> {
        self.document().accessors.get(index).ok_or_else(|| "does not exist".to_owned())
    }

    fn shape(&self, index: usize, max_count: usize) -> Result<Shape, String> {
        let accessor = self.accessor(index)?;
        let Checked::Valid(component) = accessor.component_type else {
            return Err("has an unknown componentType (allowed: 5120 to 5123, 5125, 5126)".into());
        };
        let Checked::Valid(kind) = accessor.type_ else {
            return Err("has an unknown type (allowed: SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4)".into());
        };
        if matches!(kind, Type::Mat2 | Type::Mat3 | Type::Mat4) {
            return Err("holds matrices (allowed: SCALAR, VEC2, VEC3, VEC4)".into());
        }
        let count = usize::try_from(accessor.count.0).ok().filter(|count| *count <= max_count);
        let Some(count) = count else {
            let count = accessor.count.0;
            return Err(format!(
                "has {count} elements, more than a scene may have (allowed: up to {max_count})"
            ));
        };
        Ok(Shape {
            count,
            component: component.0,
            width: kind.multiplicity(),
            normalized: accessor.normalized,
        })
    }

    /// Hands every element's bytes to `visit`, sparse replacements last. Elements that the file leaves at
    /// zero are handed over as zero bytes.
    fn for_each(
        &self,
        index: usize,
        shape: Shape,
        mut visit: impl FnMut(usize, &[u8]),
    ) -> Result<(), String> {
        let accessor = self.accessor(index)?;
        let size = shape.element_bytes();
        let base = match accessor.buffer_view {
            None => Elements { bytes: None, stride: size },
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                self.elements(view.value(), offset, shape.count, size)?
            }
        };
        for i in 0..shape.count {
            visit(i, base.get(i, size));
        }
        match &accessor.sparse {
            None => Ok(()),
            Some(sparse) => {
                self.for_each_sparse(sparse, shape, visit).map_err(|reason| format!("sparse: {reason}"))
            }
        }
    }

    fn for_each_sparse(
        &self,
        sparse: &json::accessor::sparse::Sparse,
        shape: Shape,
        mut visit: impl FnMut(usize, &[u8]),
    ) -> Result<(), String> {
        let count = usize::try_from(sparse.count.0).ok().filter(|count| *count <= shape.count);
        let Some(count) = count else {
            return Err(format!("count is {} (allowed: up to {})", sparse.count.0, shape.count));
        };
        let Checked::Valid(index_type) = sparse.indices.component_type else {
            return Err("indices have an unknown componentType (allowed: 5121, 5123, 5125)".into());
        };
        let (index_size, size) = (index_type.0.size(), shape.element_bytes());
        let indices = &sparse.indices;
        let indices = self.elements(indices.buffer_view.value(), indices.byte_offset.0, count, index_size)?;
        let values = &sparse.values;
        let values = self.elements(values.buffer_view.value(), values.byte_offset.0, count, size)?;
        for i in 0..count {
            let at = unsigned_integer(indices.get(i, index_size));
            match usize::try_from(at).ok().filter(|at| *at < shape.count) {
                None => return Err(format!("index {at} does not exist (allowed: below {})", shape.count)),
                Some(at) => visit(at, values.get(i, size)),
            }
        }
        Ok(())
    }

    /// Finds `count` elements of `size` bytes in a buffer view, and makes sure that they are all there.
    fn elements(&self, view: usize, offset: u64, count: usize, size: usize) -> Result<Elements<'_>, String> {
        let found = self.view(view)?;
        let stride = found.stride.unwrap_or(size);
        if stride < size {
            return Err(format!("bufferView {view} has a byteStride of {stride} (allowed: {size} to 252)"));
        }
        let span = match count.checked_sub(1) {
            None => Some(0),
            Some(last) => last.checked_mul(stride).and_then(|start| start.checked_add(size)),
        };
        let bytes = usize::try_from(offset).ok().and_then(|offset| found.bytes.get(offset..));
        match bytes.filter(|bytes| span.is_some_and(|span| span <= bytes.len())) {
            Some(bytes) => Ok(Elements { bytes: Some(bytes), stride }),
            None => Err(format!(
                "{count} elements of {size} bytes (byteOffset {offset}, stride {stride}) do not fit in bufferView {view} of {} bytes",
                found.bytes.len()
            )),
        }
    }
}

/// Decodes a component; integers are scaled to 0..1 or -1..1 if the accessor is normalised.
fn component_f32(shape: &Shape, bytes: &[u8]) -> f32 {
    let scaled = |value: f32, max: f32| if shape.normalized { (value / max).max(-1.0) } else { value };
    match (shape.component, bytes) {
        (ComponentType::I8, &[a]) => scaled(f32::from(i8::from_le_bytes([a])), 127.0),
        (ComponentType::U8, &[a]) => scaled(f32::from(a), 255.0),
        (ComponentType::I16, &[a, b]) => scaled(f32::from(i16::from_le_bytes([a, b])), 32767.0),
        (ComponentType::U16, &[a, b]) => scaled(f32::from(u16::from_le_bytes([a, b])), 65535.0),
        (ComponentType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        _ => 0.0,
    }
}

/// Decodes an unsigned integer of up to four bytes.
fn unsigned_integer(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, byte| value << 8 | u32::from(*byte))
}
