//! Checks of an access: format, clear value, and usages of an import.

use crate::access::{Access, ClearValue};
use crate::declaration::{AccessDecl, Declaration, Origin, WriteMode};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::PassId;

pub(super) fn check(decl: &Declaration, pass: PassId, access: &AccessDecl) -> Result<(), Error> {
    let resource = decl.resource(access.resource);
    let names = || (decl.pass_name(pass), decl.resource_path(access.resource));
    if let ResourceDesc::Texture(desc) = &resource.desc
        && let Some(problem) = format_problem(access.access, desc)
    {
        let (pass, resource) = names();
        let access = access.access.as_str();
        return Err(Error::Format { pass, resource, access, format: desc.format, problem });
    }
    check_clear(decl, pass, access)?;
    if matches!(resource.origin, Origin::Imported { .. })
        && let Some(needed) = missing_usage(decl, access)
    {
        let (pass, resource) = names();
        return Err(Error::ImportUsage { pass, resource, access: access.access.as_str(), needed });
    }
    Ok(())
}

pub(super) fn check_clear(decl: &Declaration, pass: PassId, access: &AccessDecl) -> Result<(), Error> {
    if let WriteMode::Clear(clear) = access.contents
        && let Some(problem) = clear_problem(access.access, decl.clears[clear as usize])
    {
        let (pass, resource) = (decl.pass_name(pass), decl.resource_path(access.resource));
        return Err(Error::Clear { pass, resource, problem });
    }
    Ok(())
}

fn format_problem(access: Access, desc: &TextureDesc) -> Option<&'static str> {
    let depth = desc.format.is_depth_stencil_format();
    match access {
        Access::Color(_) | Access::Resolve(_) if depth => Some("is a depth format; use `depth`"),
        Access::Color(_) | Access::Resolve(_) if desc.format.is_compressed() => {
            Some("is compressed and cannot be rendered to; use an uncompressed format")
        }
        Access::Depth | Access::DepthRead if !depth => Some("is not a depth format; use `color`"),
        Access::StorageRead | Access::StorageWrite if depth => {
            Some("is a depth format, which cannot be a storage texture; sample it, or use `R32Float`")
        }
        Access::StorageRead | Access::StorageWrite if desc.samples > 1 => {
            Some("is multisampled here, which a storage texture cannot be; resolve it first")
        }
        _ => None,
    }
}

fn clear_problem(access: Access, value: ClearValue) -> Option<&'static str> {
    let depth_outside = |depth: f32| !(0.0..=1.0).contains(&depth);
    match (access, value) {
        (Access::Color(_), ClearValue::Color(_)) => None,
        (Access::Color(_), _) => Some("a depth, but it is a colour attachment; use `Contents::clear_color`"),
        (Access::Depth, ClearValue::Color(_)) => {
            Some("a colour, but it is a depth attachment; use `Contents::clear_depth`")
        }
        (Access::Depth, ClearValue::Depth(depth) | ClearValue::DepthStencil(depth, _))
            if depth_outside(depth) =>
        {
            Some("a depth outside 0 to 1")
        }
        (Access::Depth, ClearValue::DepthStencil(_, stencil)) if stencil > 255 => {
            Some("a stencil outside 0 to 255")
        }
        (Access::Depth, _) => None,
        _ => Some("a clear value, but only attachments can be cleared; use `Contents::Overwrite`"),
    }
}

fn missing_usage(decl: &Declaration, access: &AccessDecl) -> Option<String> {
    let resource = decl.resource(access.resource);
    match resource.desc {
        ResourceDesc::Texture(_) => {
            let missing = access.access.texture_usage() - resource.texture_usage;
            (!missing.is_empty()).then(|| flags(missing.iter_names()))
        }
        ResourceDesc::Buffer(_) => {
            let missing = access.access.buffer_usage() - resource.buffer_usage;
            (!missing.is_empty()).then(|| flags(missing.iter_names()))
        }
    }
}

fn flags<F>(names: impl Iterator<Item = (&'static str, F)>) -> String {
    names.map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(" and ")
}
