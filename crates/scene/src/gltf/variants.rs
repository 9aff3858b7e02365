//! The choice of a material by KHR_materials_variants.

use ::gltf::json::mesh::Primitive;

use super::document::Document;
use super::error::{ImportError, clean_name};
use super::notes::Notes;

const NAME: &str = "KHR_materials_variants";

/// Returns the index of a variant of the file; `None` for its default materials.
///
/// # Errors
/// The file has no variant with this name.
pub(super) fn find(
    document: &Document,
    name: Option<&str>,
    notes: &mut Notes,
) -> Result<Option<u32>, ImportError> {
    let variants = document.variants();
    let names: Vec<_> =
        variants.iter().map(|variant| format!("{:?}", clean_name(Some(&variant.name)))).collect();
    let names = names.join(", ");
    match name {
        None if variants.is_empty() => Ok(None),
        None => {
            notes.add(NAME, format!("the default materials are drawn (variants: {names})"));
            Ok(None)
        }
        Some(name) => match variants.iter().position(|variant| variant.name == name) {
            Some(index) => Ok(u32::try_from(index).ok()),
            None if variants.is_empty() => Err(ImportError::new(NAME, "the file has no variants")),
            None => {
                let reason = format!("unknown variant {name:?}; expected one of: {names}");
                Err(ImportError::new(NAME, reason))
            }
        },
    }
}

/// Returns the index of the material of a primitive, if it has one.
pub(super) fn material(primitive: &Primitive, variant: Option<u32>) -> Option<usize> {
    let variants = primitive.extensions.as_ref().and_then(|e| e.khr_materials_variants.as_ref());
    let mapped = variants.zip(variant).and_then(|(variants, variant)| {
        let mapping = variants.mappings.iter().find(|mapping| mapping.variants.contains(&variant))?;
        usize::try_from(mapping.material).ok()
    });
    mapped.or(primitive.material.map(|material| material.value()))
}
