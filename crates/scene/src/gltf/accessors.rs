//! Typed reading of accessors: every offset, count and index is checked against the available bytes.

use ::gltf::json;
use json::accessor::{ComponentType, Type};
use json::validation::Checked;

use super::buffers::Buffers;

/// The elements of an accessor, before sparse replacement.
struct Elements<'a> {
    /// The bytes from the first element on; `None`: all zeros.
    bytes: Option<&'a [u8]>,
    stride: usize,
}

impl<'a> Elements<'a> {
    /// Returns the bytes of an element of `size` bytes.
    fn get(&self, index: usize, size: usize) -> &'a [u8] {
        const ZEROS: [u8; 64] = [0; 64];
        let bytes = match self.bytes {
            None => ZEROS.get(..size),
            Some(bytes) => bytes.get(index * self.stride..).and_then(|bytes| bytes.get(..size)),
        };
        bytes.unwrap_or_default()
    }
}

/// The checked layout of an accessor.
#[derive(Clone, Copy)]
struct Layout {
    count: usize,
    component: ComponentType,
    kind: Type,
    /// Number of components of an element.
    width: usize,
    normalized: bool,
}

impl Layout {
    fn element_bytes(&self) -> usize {
        self.component.size() * self.width
    }
}

impl Buffers<'_> {
    /// Returns the number of elements of an accessor.
    ///
    /// # Errors
    /// The accessor does not exist.
    pub(super) fn accessor_count(&self, index: usize) -> Result<u64, String> {
        Ok(self.accessor(index)?.count.0)
    }

    /// Reads an accessor of vectors as f32, normalised integers as glTF says; at most `max_count` elements.
    ///
    /// Vectors of at least `min` components are filled up to `N` from `fill`.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn vectors<const N: usize>(
        &self,
        index: usize,
        min: usize,
        fill: [f32; N],
        max_count: usize,
    ) -> Result<Vec<[f32; N]>, String> {
        let layout = self.layout(index, max_count)?;
        if !(min..=N).contains(&layout.width) {
            let range = if min == N { format!("{N}") } else { format!("{min} or {N}") };
            return Err(format!("has {} components per element (allowed: {range})", layout.width));
        }
        if layout.component == ComponentType::U32 {
            return Err("contains 32-bit integers (allowed: floats, 8-bit and 16-bit integers)".into());
        }
        self.values(index, layout, fill)
    }

    /// Reads an accessor of single floats; at most `max_count`.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn floats(&self, index: usize, max_count: usize) -> Result<Vec<f32>, String> {
        let layout = self.layout(index, max_count)?;
        if (layout.kind, layout.component) != (Type::Scalar, ComponentType::F32) {
            return Err("does not contain single floats (allowed: SCALAR of 5126)".into());
        }
        Ok(self.values::<1>(index, layout, [0.0])?.into_flattened())
    }

    /// Reads an accessor of matrices, column by column; at most `max_count`.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn matrices(&self, index: usize, max_count: usize) -> Result<Vec<[f32; 16]>, String> {
        let layout = self.any_layout(index, max_count)?;
        if (layout.kind, layout.component) != (Type::Mat4, ComponentType::F32) {
            return Err("does not contain matrices of 4 x 4 floats (allowed: MAT4 of 5126)".into());
        }
        self.values(index, layout, [0.0; 16])
    }

    /// Reads an accessor of four joints per element; at most `max_count` elements.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn joints(&self, index: usize, max_count: usize) -> Result<Vec<[u16; 4]>, String> {
        let layout = self.layout(index, max_count)?;
        let unsigned = matches!(layout.component, ComponentType::U8 | ComponentType::U16);
        if layout.kind != Type::Vec4 || !unsigned || layout.normalized {
            return Err("does not contain joints (allowed: VEC4 of 5121 or 5123, not normalized)".into());
        }
        let mut joints = vec![[0; 4]; layout.count];
        self.for_each(index, layout, |i, bytes| {
            let components = bytes.chunks_exact(layout.component.size());
            for (joint, bytes) in joints.get_mut(i).into_iter().flatten().zip(components) {
                *joint = unsigned_integer(bytes) as u16;
            }
        })?;
        Ok(joints)
    }

    /// Reads elements as f32; components that they lack are those of `fill`.
    fn values<const N: usize>(
        &self,
        index: usize,
        layout: Layout,
        fill: [f32; N],
    ) -> Result<Vec<[f32; N]>, String> {
        let mut vectors = vec![fill; layout.count];
        let read = |vector: &mut [f32; N], bytes: &[u8]| {
            for (value, bytes) in vector.iter_mut().zip(bytes.chunks_exact(layout.component.size())) {
                *value = component_f32(&layout, bytes);
            }
        };
        self.for_each(index, layout, |i, bytes| {
            if let Some(vector) = vectors.get_mut(i) {
                read(vector, bytes);
            }
        })?;
        Ok(vectors)
    }

    /// Reads an accessor of indices; at most `max_count`.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn indices(&self, index: usize, max_count: usize) -> Result<Vec<u32>, String> {
        let layout = self.layout(index, max_count)?;
        let unsigned =
            matches!(layout.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if layout.width != 1 || !unsigned {
            return Err("does not contain indices (allowed: SCALAR of unsigned integers)".into());
        }
        let mut indices = vec![0u32; layout.count];
        self.for_each(index, layout, |i, bytes| {
            if let Some(value) = indices.get_mut(i) {
                *value = unsigned_integer(bytes);
            }
        })?;
        Ok(indices)
    }

    fn accessor(&self, index: usize) -> Result<&json::Accessor, String> {
        self.document().accessors.get(index).ok_or_else(|| "does not exist".to_owned())
    }

    /// Returns the layout of an accessor without matrices.
    fn layout(&self, index: usize, max_count: usize) -> Result<Layout, String> {
        let layout = self.any_layout(index, max_count)?;
        match layout.kind {
            Type::Mat2 | Type::Mat3 | Type::Mat4 => {
                Err("contains matrices (allowed: SCALAR, VEC2, VEC3, VEC4)".into())
            }
            _ => Ok(layout),
        }
    }

    fn any_layout(&self, index: usize, max_count: usize) -> Result<Layout, String> {
        let accessor = self.accessor(index)?;
        let Checked::Valid(component) = accessor.component_type else {
            return Err("has an unknown componentType (allowed: 5120 to 5123, 5125, 5126)".into());
        };
        let Checked::Valid(kind) = accessor.type_ else {
            return Err("has an unknown type (allowed: SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4)".into());
        };
        let count = usize::try_from(accessor.count.0).ok().filter(|count| *count <= max_count);
        let Some(count) = count else {
            let count = accessor.count.0;
            return Err(format!(
                "has {count} elements, more than the scene may still have (allowed: up to {max_count})"
            ));
        };
        Ok(Layout {
            count,
            component: component.0,
            kind,
            width: kind.multiplicity(),
            normalized: accessor.normalized,
        })
    }

    /// Calls `visit` with every element's bytes, sparse replacements last. Elements without data in the file are
    /// zero bytes.
    fn for_each(
        &self,
        index: usize,
        layout: Layout,
        mut visit: impl FnMut(usize, &[u8]),
    ) -> Result<(), String> {
        let accessor = self.accessor(index)?;
        let size = layout.element_bytes();
        let base = match accessor.buffer_view {
            None => Elements { bytes: None, stride: size },
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                self.elements(view.value(), offset, layout.count, size)?
            }
        };
        for i in 0..layout.count {
            visit(i, base.get(i, size));
        }
        match &accessor.sparse {
            None => Ok(()),
            Some(sparse) => {
                self.for_each_sparse(sparse, layout, visit).map_err(|reason| format!("sparse: {reason}"))
            }
        }
    }

    fn for_each_sparse(
        &self,
        sparse: &json::accessor::sparse::Sparse,
        layout: Layout,
        mut visit: impl FnMut(usize, &[u8]),
    ) -> Result<(), String> {
        let count = usize::try_from(sparse.count.0).ok().filter(|count| *count <= layout.count);
        let Some(count) = count else {
            return Err(format!("count is {} (allowed: up to {})", sparse.count.0, layout.count));
        };
        let Checked::Valid(index_type) = sparse.indices.component_type else {
            return Err("indices have an unknown componentType (allowed: 5121, 5123, 5125)".into());
        };
        let (index_size, size) = (index_type.0.size(), layout.element_bytes());
        let indices = &sparse.indices;
        let indices = self.elements(indices.buffer_view.value(), indices.byte_offset.0, count, index_size)?;
        let values = &sparse.values;
        let values = self.elements(values.buffer_view.value(), values.byte_offset.0, count, size)?;
        for i in 0..count {
            let target = unsigned_integer(indices.get(i, index_size));
            match usize::try_from(target).ok().filter(|target| *target < layout.count) {
                None => {
                    return Err(format!("index {target} does not exist (allowed: below {})", layout.count));
                }
                Some(target) => visit(target, values.get(i, size)),
            }
        }
        Ok(())
    }

    /// Returns `count` elements of `size` bytes in a buffer view after checking that they all lie in it.
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
fn component_f32(layout: &Layout, bytes: &[u8]) -> f32 {
    let scaled = |value: f32, max: f32| if layout.normalized { (value / max).max(-1.0) } else { value };
    match (layout.component, bytes) {
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
