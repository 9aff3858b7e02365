//! Checks of a frame that do not need a device, before anything else.

mod access;
mod contents;
mod pass;

#[cfg(feature = "gpu")]
pub(crate) use pass::copy_extent;

use crate::declaration::{Declaration, Origin};
use crate::desc::{BufferDesc, ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::ResourceId;
use wgpu_types::TextureDimension;

/// Far more than devices allow, and few enough that sums stay in range.
const MAX_TEXELS: u128 = 1 << 40;
const MAX_BYTES: u64 = 1 << 44;

/// Checks everything that does not depend on a device.
pub(super) fn validate(decl: &Declaration) -> Result<(), Error> {
    for (index, resource) in decl.resources.iter().enumerate() {
        if let Some(problem) = shape_problem(resource.origin, &resource.desc) {
            let resource = decl.resource_path(ResourceId(index as u32));
            return Err(Error::InvalidResource { resource, problem });
        }
    }
    let mut contents = contents::Contents::new(decl);
    let mut seen = vec![u32::MAX; decl.resources.len()];
    for id in decl.pass_ids() {
        pass::check(decl, id, &mut seen)?;
        for access in decl.accesses(id) {
            access::check(decl, id, access)?;
        }
        contents.pass(decl, id)?;
    }
    contents.exports(decl)
}

/// Checks the clear values only.
pub(super) fn validate_clears(decl: &Declaration) -> Result<(), Error> {
    let accesses = |pass| decl.accesses(pass).iter().map(move |access| (pass, access));
    decl.pass_ids().flat_map(accesses).try_for_each(|(pass, access)| access::check_clear(decl, pass, access))
}

fn shape_problem(origin: Origin, desc: &ResourceDesc) -> Option<String> {
    match desc {
        ResourceDesc::Buffer(BufferDesc { bytes, .. }) => {
            let odd = origin == Origin::Transient && bytes % 4 != 0;
            if *bytes > MAX_BYTES {
                return Some(format!("it has {bytes} bytes, more than any device has; make it smaller"));
            }
            (*bytes == 0 || odd).then(|| format!("it has {bytes} bytes; give it a multiple of 4, at least 4"))
        }
        ResourceDesc::Texture(desc) => texture_problem(desc),
    }
}

fn texture_problem(desc: &TextureDesc) -> Option<String> {
    let size = desc.size;
    if [size.width, size.height, size.depth_or_array_layers].contains(&0) {
        return Some("a side is 0; every side must be at least 1".into());
    }
    if desc.texels() > MAX_TEXELS {
        return Some("it has more texels than any device can store; make it smaller".into());
    }
    let max = size.max_mips(desc.dimension);
    if desc.mip_levels == 0 || desc.mip_levels > max {
        return Some(format!("it has {} mip levels; expected 1 to {max}", desc.mip_levels));
    }
    if ![1, 2, 4, 8, 16].contains(&desc.samples) {
        return Some(format!("it has {} samples; expected 1, or 4 for multisampling", desc.samples));
    }
    let flat = desc.dimension == TextureDimension::D2 && desc.mip_levels == 1;
    let single = size.depth_or_array_layers == 1;
    (desc.samples > 1 && !(flat && single))
        .then(|| "it is multisampled, so it must be 2D with one mip level and one layer".into())
}
