//! Checks that a struct has the same memory layout in WGSL and in Rust.

use naga::TypeInner;

use crate::error::Error;
use crate::report::plain_names;

/// A member of a WGSL struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name in WGSL.
    pub name: String,
    /// Its offset in the struct, in bytes.
    pub offset: usize,
    /// Its type if it is a scalar of four bytes (`f32`, `i32` or `u32`), otherwise empty.
    pub scalar: &'static str,
}

/// A WGSL struct's size and fields.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Bytes, rounded up to the struct's alignment.
    pub size: usize,
    /// Fields in the order of declaration.
    pub fields: Vec<Field>,
}

/// Finds the layout of a struct in a composed module by its name (`View`).
///
/// # Errors
///
/// [`Error::StructNotFound`] if there is no struct of this name, or several that differ.
pub fn struct_layout(module: &naga::Module, struct_name: &str) -> Result<Layout, Error> {
    let structs = structs(module);
    let mut found: Vec<&Layout> = Vec::new();
    for (name, layout) in &structs {
        if name == struct_name && !found.contains(&layout) {
            found.push(layout);
        }
    }
    match found[..] {
        [layout] => Ok(layout.clone()),
        _ => Err(Error::StructNotFound {
            name: struct_name.to_owned(),
            count: found.len(),
            known: structs.into_iter().map(|(name, _)| name).collect::<Vec<_>>().join(", "),
        }),
    }
}

/// Checks a struct of Rust against the WGSL struct of a composed module that has its fields by the same names: see
/// [`layout::check`](crate::layout::check), whose result it returns.
///
/// ```
/// use shadowgraph_shaders::{check_layout, compose};
///
/// #[repr(C)]
/// struct Settings {
///     background: [f32; 4],
///     has_background: u32,
///     _padding: [u32; 3],
/// }
/// let module = compose("tonemap.wgsl", &[])?;
/// check_layout!(&module, "Settings", Settings: background, has_background)?;
/// # Ok::<(), shadowgraph_shaders::Error>(())
/// ```
#[macro_export]
macro_rules! check_layout {
    ($module:expr, $name:expr, $type:ty: $($field:ident),+ $(,)?) => {
        $crate::layout::check(
            $module,
            $name,
            ::core::mem::size_of::<$type>(),
            &[$((stringify!($field), ::core::mem::offset_of!($type, $field))),+],
        )
    };
}

/// Checks a struct of a composed module against its size and field offsets (in bytes) in Rust. All WGSL fields must be listed,
/// in any order, without padding that WGSL does not declare.
///
/// ```
/// use shadowgraph_shaders::{compose, layout};
///
/// let module = compose("depth.wgsl", &[])?;
/// let rows = ["row_x", "row_y", "row_z", "previous_row_x", "previous_row_y", "previous_row_z"];
/// let mut fields: Vec<_> = rows.into_iter().zip((0..).step_by(16)).collect();
/// fields.push(("flags", 96));
/// layout::check(&module, "Instance", 112, &fields)?;
/// # Ok::<(), shadowgraph_shaders::Error>(())
/// ```
///
/// # Errors
///
/// The first difference: the struct is missing or has another size, or a field is missing, unexpected or at another offset.
pub fn check(
    module: &naga::Module,
    struct_name: &str,
    size: usize,
    fields: &[(&str, usize)],
) -> Result<(), Error> {
    let layout = struct_layout(module, struct_name)?;
    let name = || struct_name.to_owned();
    for &(field, expected) in fields {
        let Some(actual) = layout.fields.iter().find(|f| f.name == field) else {
            let known = layout.fields.iter().map(|f| f.name.as_str()).collect::<Vec<_>>().join(", ");
            return Err(Error::FieldMissing { name: name(), field: field.to_owned(), known });
        };
        let actual = actual.offset;
        if actual != expected {
            return Err(Error::FieldOffset { name: name(), field: field.to_owned(), actual, expected });
        }
    }
    if let Some(extra) = layout.fields.iter().find(|f| !fields.iter().any(|(field, _)| *field == f.name)) {
        let Field { name: field, offset, .. } = extra.clone();
        return Err(Error::FieldUnexpected { name: name(), field, offset });
    }
    if layout.size != size {
        return Err(Error::StructSize { name: name(), actual: layout.size, expected: size });
    }
    Ok(())
}

/// Checks the types of scalars of a struct, `f32`, `i32` or `u32`. Fields that the struct lacks are ignored; [`check`] finds them.
///
/// # Errors
///
/// The struct is missing, or a field has another type.
pub fn check_types(module: &naga::Module, struct_name: &str, fields: &[(&str, &str)]) -> Result<(), Error> {
    let layout = struct_layout(module, struct_name)?;
    let wrong = fields.iter().find_map(|(field, expected)| {
        let actual = layout.fields.iter().find(|actual| actual.name == *field)?;
        (actual.scalar != *expected).then_some((actual, *expected))
    });
    wrong.map_or(Ok(()), |(field, expected)| {
        Err(Error::FieldType {
            name: struct_name.to_owned(),
            field: field.name.clone(),
            actual: field.scalar.to_owned(),
            expected: expected.to_owned(),
        })
    })
}

/// Returns every struct of the module with its name in the source.
fn structs(module: &naga::Module) -> Vec<(String, Layout)> {
    let mut structs = Vec::new();
    for (_, ty) in module.types.iter() {
        if let (Some(name), TypeInner::Struct { members, span }) = (&ty.name, &ty.inner) {
            let fields = members.iter().map(|member| Field {
                name: member.name.clone().unwrap_or_default(),
                offset: member.offset as usize,
                scalar: scalar(&module.types[member.ty].inner),
            });
            structs.push((plain_names(name), Layout { size: *span as usize, fields: fields.collect() }));
        }
    }
    structs
}

/// Returns the name of a scalar type of four bytes.
fn scalar(ty: &TypeInner) -> &'static str {
    match ty {
        TypeInner::Scalar(naga::Scalar::F32) => "f32",
        TypeInner::Scalar(naga::Scalar::I32) => "i32",
        TypeInner::Scalar(naga::Scalar::U32) => "u32",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;

    const TWO: &str = "struct Two { first: vec3f, second: f32, third: f32 }\n\
        @group(0) @binding(0) var<uniform> two: Two;";

    fn two() -> naga::Module {
        naga::front::wgsl::parse_str(TWO).unwrap()
    }

    #[test]
    fn equal_layouts_pass_in_any_order_of_fields() {
        check(&two(), "Two", 32, &[("third", 16), ("first", 0), ("second", 12)]).unwrap();
    }

    #[test]
    fn each_difference_is_named() {
        let module = two();
        let text =
            |size, fields: &[(&str, usize)]| check(&module, "Two", size, fields).unwrap_err().to_string();
        let right = [("first", 0), ("second", 12), ("third", 16)];
        assert_eq!(text(20, &right), "WGSL struct `Two` has 32 bytes, expected 20");
        let moved = [("first", 0), ("second", 16), ("third", 16)];
        assert_eq!(text(32, &moved), "field `second` of WGSL struct `Two` is at byte 12, expected 16");
        let renamed = [("first", 0), ("other", 12)];
        assert_eq!(
            text(32, &renamed),
            "WGSL struct `Two` has no field `other`; its fields: first, second, third"
        );
        assert_eq!(text(32, &right[..2]), "WGSL struct `Two` has an unexpected field `third` at byte 16");
        assert_eq!(
            check(&module, "One", 0, &[]).unwrap_err().to_string(),
            "expected one struct `One`, found 0; the module's structs: Two"
        );
    }

    #[test]
    fn a_scalar_of_another_type_is_named() {
        let module = two();
        check_types(&module, "Two", &[("third", "f32"), ("second", "f32"), ("fourth", "u32")]).unwrap();
        let error = |field| check_types(&module, "Two", &[(field, "u32")]).unwrap_err().to_string();
        assert_eq!(error("third"), "field `third` of WGSL struct `Two` is of type `f32`, expected `u32`");
        assert_eq!(error("first"), "field `first` of WGSL struct `Two` is no scalar, expected `u32`");
    }
}
