//! Typed reading of accessors: every offset, count and index is checked against the available bytes.

use std::borrow::Cow;

use ::gltf::json;
use json::accessor::{ComponentType, Type};
use json::validation::Checked;

use super::buffers::Buffers;

/// The elements of an accessor, before sparse replacement.
struct Elements<'a> {
    /// The bytes from the first element on; `None`: all zeros.
    bytes: Option<Cow<'a, [u8]>>,
    stride: usize,
}

impl<'a> Elements<'a> {
    /// Returns the bytes of an element of `size` bytes.
    fn get(&self, index: usize, size: usize) -> &[u8] {
        const ZEROS: [u8; 64] = [0; 64];
        let bytes = match &self.bytes {
            None => ZEROS.get(..size),
            Some(bytes) => bytes.get(index * self.stride..).and_then(|bytes| bytes.get(..size)),
        };
        bytes.unwrap_or_default()
    }
}

/// The layout of an accessor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) count: usize,
    pub(super) component: ComponentType,
    pub(super) kind: Type,
    pub(super) normalized: bool,
}

impl Layout {
    /// Returns the number of components of an element.
    fn width(&self) -> usize {
        self.kind.multiplicity()
    }

    /// Returns the number of bytes of an element.
    pub(super) fn element_bytes(&self) -> usize {
        self.component.size() * self.width()
    }

    fn is_matrix(&self) -> bool {
        matches!(self.kind, Type::Mat2 | Type::Mat3 | Type::Mat4)
    }
}

/// An accessor whose elements all lie in the available bytes.
pub(super) struct Accessor<'a> {
    layout: Layout,
    base: Elements<'a>,
    sparse: Option<Sparse<'a>>,
}

/// The elements of an accessor that are replaced.
struct Sparse<'a> {
    /// Indices of the elements, each below their number.
    targets: Vec<usize>,
    values: Elements<'a>,
}

impl Buffers<'_> {
    /// Returns the number of elements of an accessor.
    ///
    /// # Errors
    /// The accessor does not exist.
    pub(super) fn accessor_count(&self, index: usize) -> Result<u64, String> {
        Ok(self.json_accessor(index)?.count.0)
    }

    /// Returns an accessor of at most `max_count` elements. Elements without data in the file are zero bytes.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn accessor(&self, index: usize, max_count: usize) -> Result<Accessor<'_>, String> {
        let json = self.json_accessor(index)?;
        let layout = layout(json, max_count)?;
        let size = layout.element_bytes();
        let base = match json.buffer_view {
            None => Elements { bytes: None, stride: size },
            Some(view) => {
                let offset = json.byte_offset.map_or(0, |offset| offset.0);
                self.elements(view.value(), offset, layout.count, size)?
            }
        };
        let sparse = json.sparse.as_ref().map(|sparse| self.sparse(sparse, layout));
        let sparse = sparse.transpose().map_err(|reason| format!("sparse: {reason}"))?;
        Ok(Accessor { layout, base, sparse })
    }

    fn json_accessor(&self, index: usize) -> Result<&json::Accessor, String> {
        self.document().accessors.get(index).ok_or_else(|| "does not exist".to_owned())
    }

    fn sparse(&self, sparse: &json::accessor::sparse::Sparse, layout: Layout) -> Result<Sparse<'_>, String> {
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
        let target = |i| {
            let target = unsigned_integer(indices.get(i, index_size));
            let existing = usize::try_from(target).ok().filter(|target| *target < layout.count);
            existing.ok_or_else(|| format!("index {target} does not exist (allowed: below {})", layout.count))
        };
        Ok(Sparse { targets: (0..count).map(target).collect::<Result<_, _>>()?, values })
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
            Some(bytes) => Ok(Elements { bytes: Some(Cow::Borrowed(bytes)), stride }),
            None => Err(format!(
                "{count} elements of {size} bytes (byteOffset {offset}, stride {stride}) do not fit in bufferView {view} of {} bytes",
                found.bytes.len()
            )),
        }
    }
}

impl Accessor<'_> {
    /// Creates an accessor of elements that follow each other in `bytes`, which has all of them.
    pub(super) fn packed(layout: Layout, bytes: Vec<u8>) -> Self {
        let base = Elements { bytes: Some(Cow::Owned(bytes)), stride: layout.element_bytes() };
        Self { layout, base, sparse: None }
    }

    /// Returns the number of elements.
    pub(super) fn count(&self) -> usize {
        self.layout.count
    }

    /// Reads vectors as f32, normalised integers as glTF says.
    ///
    /// Vectors of at least `min` components are filled up to `N` from `fill`.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn vectors<const N: usize>(
        &self,
        min: usize,
        fill: [f32; N],
    ) -> Result<Vec<[f32; N]>, String> {
        let width = self.layout.width();
        self.check_no_matrix()?;
        if !(min..=N).contains(&width) {
            let range = if min == N { format!("{N}") } else { format!("{min} or {N}") };
            return Err(format!("has {width} components per element (allowed: {range})"));
        }
        if self.layout.component == ComponentType::U32 {
            return Err("contains 32-bit integers (allowed: floats, 8-bit and 16-bit integers)".into());
        }
        Ok(self.values(fill))
    }

    /// Reads single floats.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn floats(&self) -> Result<Vec<f32>, String> {
        if (self.layout.kind, self.layout.component) != (Type::Scalar, ComponentType::F32) {
            return Err("does not contain single floats (allowed: SCALAR of 5126)".into());
        }
        Ok(self.values([0.0; 1]).into_flattened())
    }

    /// Reads matrices, column by column.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn matrices(&self) -> Result<Vec<[f32; 16]>, String> {
        if (self.layout.kind, self.layout.component) != (Type::Mat4, ComponentType::F32) {
            return Err("does not contain matrices of 4 x 4 floats (allowed: MAT4 of 5126)".into());
        }
        Ok(self.values([0.0; 16]))
    }

    /// Reads four joints per element.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn joints(&self) -> Result<Vec<[u16; 4]>, String> {
        let unsigned = matches!(self.layout.component, ComponentType::U8 | ComponentType::U16);
        if self.layout.kind != Type::Vec4 || !unsigned || self.layout.normalized {
            return Err("does not contain joints (allowed: VEC4 of 5121 or 5123, not normalized)".into());
        }
        Ok(self.collect([0; 4], |joints: &mut [u16; 4], bytes| {
            for (joint, bytes) in joints.iter_mut().zip(bytes.chunks_exact(self.layout.component.size())) {
                *joint = unsigned_integer(bytes) as u16;
            }
        }))
    }

    /// Reads indices.
    ///
    /// # Errors
    /// The message says what in the accessor is invalid and what is allowed.
    pub(super) fn indices(&self) -> Result<Vec<u32>, String> {
        self.check_no_matrix()?;
        let unsigned =
            matches!(self.layout.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if self.layout.width() != 1 || !unsigned {
            return Err("does not contain indices (allowed: SCALAR of unsigned integers)".into());
        }
        Ok(self.collect(0, |index: &mut u32, bytes| *index = unsigned_integer(bytes)))
    }

    fn check_no_matrix(&self) -> Result<(), String> {
        if self.layout.is_matrix() {
            return Err("contains matrices (allowed: SCALAR, VEC2, VEC3, VEC4)".into());
        }
        Ok(())
    }

    /// Reads elements as f32; components that they lack are those of `fill`.
    fn values<const N: usize>(&self, fill: [f32; N]) -> Vec<[f32; N]> {
        self.collect(fill, |vector: &mut [f32; N], bytes| {
            for (value, bytes) in vector.iter_mut().zip(bytes.chunks_exact(self.layout.component.size())) {
                *value = component_f32(&self.layout, bytes);
            }
        })
    }

    /// Reads every element over `fill`, the replaced ones last.
    fn collect<T: Copy>(&self, fill: T, read: impl Fn(&mut T, &[u8])) -> Vec<T> {
        let (count, size) = (self.layout.count, self.layout.element_bytes());
        let mut elements = vec![fill; count];
        for (i, element) in elements.iter_mut().enumerate() {
            read(element, self.base.get(i, size));
        }
        if let Some(Sparse { targets, values }) = &self.sparse {
            for (i, target) in targets.iter().enumerate() {
                elements.get_mut(*target).into_iter().for_each(|element| read(element, values.get(i, size)));
            }
        }
        elements
    }
}

/// Reads the layout of an accessor of at most `max_count` elements.
fn layout(accessor: &json::Accessor, max_count: usize) -> Result<Layout, String> {
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
    Ok(Layout { count, component: component.0, kind, normalized: accessor.normalized })
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
