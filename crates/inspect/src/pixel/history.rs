//! The passes that contribute to a pixel.

use serde::Serialize;
use shadowgraph_core::{ClearValue, Contents, PassId, Plan, ResourceDesc, ResourceId, Subresource};

use super::{PixelPlace, PixelRecorder, PixelTexel};

/// The history of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelHistory {
    /// The pixel.
    #[serde(flatten)]
    pub place: PixelPlace,
    /// The texture at whose end the history begins.
    pub output: String,
    /// The passes that contributed to the pixel, the last one first.
    pub passes: Vec<PixelPass>,
}

/// A pass that wrote a texel of the history.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelPass {
    /// Path of the pass.
    pub pass: String,
    /// What it wrote, of what contributed to the pixel.
    pub writes: Vec<PixelWrite>,
    /// What it read, if it changed the texel.
    pub reads: Vec<PixelRead>,
}

/// A write to a texture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelWrite {
    /// Path of the texture.
    pub texture: String,
    /// The version that it made.
    pub version: u32,
    /// What it did to the texels.
    pub effect: WriteEffect,
    /// The texels before, if the write kept earlier contents.
    pub before: Vec<PixelTexel>,
    /// The texels after.
    pub after: Vec<PixelTexel>,
}

/// What a pass did to a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WriteEffect {
    /// It has another value than before, or earlier contents were not needed.
    Written,
    /// It was cleared, and nothing was drawn over it.
    Cleared,
    /// It has the value that it had before.
    Kept,
    /// The texture has no texel at the place of the pixel.
    Elsewhere,
}

/// A texture or buffer that a pass read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelRead {
    /// Path of the resource.
    pub resource: String,
    /// The version.
    pub version: u32,
    /// The last pass that wrote it; none for an import or a history that no pass has written yet.
    pub written_by: Option<String>,
    /// The texels at the place of the pixel; none of a shadow map, a table or a buffer.
    pub texels: Vec<PixelTexel>,
}

/// A part of a version that contributed to the pixel.
struct Need {
    resource: ResourceId,
    version: u32,
    part: Subresource,
}

pub(super) fn history(recorder: &PixelRecorder, plan: &Plan, output: ResourceId) -> PixelHistory {
    let walk = Walk { recorder, plan };
    let mut needs = vec![Need { resource: output, version: u32::MAX, part: Subresource::FULL }];
    let passes = plan.order().iter().rev().filter_map(|&pass| walk.pass(pass, &mut needs)).collect();
    PixelHistory { place: recorder.place, output: plan.resource_path(output), passes }
}

struct Walk<'w> {
    recorder: &'w PixelRecorder,
    plan: &'w Plan,
}

impl Walk<'_> {
    /// Returns the pass if it wrote what is needed, and replaces that by what it read.
    fn pass(&self, pass: PassId, needs: &mut Vec<Need>) -> Option<PixelPass> {
        let mut writes = Vec::new();
        let mut has_changed = false;
        for access in self.plan.accesses(pass) {
            let Some(contents) = access.contents else { continue };
            let desc = self.plan.resource(access.resource).desc;
            let version = access.version + 1;
            let is_needed = |need: &Need| {
                need.resource == access.resource
                    && need.version >= version
                    && need.part.overlaps(&access.subresource, &desc)
            };
            if !needs.iter().any(is_needed) {
                continue;
            }
            let write = self.write(access.resource, version, &access.subresource, contents);
            if !contents.preserves() {
                let covers = |need: &Need| access.subresource.contains(&need.part, &desc);
                needs.retain(|need| !is_needed(need) || !covers(need));
            }
            has_changed |= write.effect == WriteEffect::Written;
            writes.push(write);
        }
        if writes.is_empty() {
            return None;
        }
        let mut reads = Vec::new();
        if has_changed {
            for access in self.plan.accesses(pass).filter(|access| access.contents.is_none()) {
                let read = self.read(access.resource, access.version, &access.subresource);
                if !read.texels.is_empty() {
                    let (resource, version, part) = (access.resource, access.version, access.subresource);
                    needs.push(Need { resource, version, part });
                }
                if !reads.contains(&read) {
                    reads.push(read);
                }
            }
        }
        Some(PixelPass { pass: self.plan.pass_path(pass), writes, reads })
    }

    fn write(
        &self,
        resource: ResourceId,
        version: u32,
        part: &Subresource,
        contents: Contents,
    ) -> PixelWrite {
        let after = self.texels(resource, version, part);
        let before = if contents.preserves() { self.texels(resource, version - 1, part) } else { Vec::new() };
        let effect = match contents {
            _ if after.is_empty() => WriteEffect::Elsewhere,
            Contents::Preserve if before == after => WriteEffect::Kept,
            Contents::Clear(value) if after.iter().all(|texel| is_cleared(texel, value)) => {
                WriteEffect::Cleared
            }
            _ => WriteEffect::Written,
        };
        PixelWrite { texture: self.plan.resource_path(resource), version, effect, before, after }
    }

    fn read(&self, resource: ResourceId, version: u32, part: &Subresource) -> PixelRead {
        PixelRead {
            resource: self.plan.resource_path(resource),
            version,
            written_by: self.writer(resource, version, part).map(|pass| self.plan.pass_path(pass)),
            texels: self.texels(resource, version, part),
        }
    }

    fn texels(&self, resource: ResourceId, version: u32, part: &Subresource) -> Vec<PixelTexel> {
        let desc: ResourceDesc = self.plan.resource(resource).desc;
        let contains = |texel: &PixelTexel| part.overlaps(&texel.subresource(), &desc);
        self.recorder.texels_in(resource, version, contains)
    }

    /// Returns the last pass that wrote a part of a version or of earlier ones.
    fn writer(&self, resource: ResourceId, version: u32, part: &Subresource) -> Option<PassId> {
        let desc = self.plan.resource(resource).desc;
        self.plan.order().iter().rev().copied().find(|&pass| {
            self.plan.accesses(pass).any(|access| {
                access.resource == resource
                    && access.contents.is_some()
                    && access.version < version
                    && access.subresource.overlaps(part, &desc)
            })
        })
    }
}

/// Returns whether a texel has a clear value, as exactly as its format can.
fn is_cleared(texel: &PixelTexel, clear: ClearValue) -> bool {
    const STEP: f64 = 1.0 / 255.0;
    let wanted: &[f64] = match clear {
        ClearValue::Color(ref rgba) => rgba,
        ClearValue::DepthStencil(_, stencil) if texel.is_stencil => &[f64::from(stencil)],
        ClearValue::Depth(_) if texel.is_stencil => &[0.0],
        ClearValue::Depth(depth) | ClearValue::DepthStencil(depth, _) => &[f64::from(depth)],
    };
    // All formats have 0 and 1 exactly, and far surfaces have nearly the depth 0.
    let is_same = |is: f64, wanted: f64| match wanted {
        0.0 | 1.0 => is == wanted,
        _ => (is - wanted).abs() <= STEP * wanted.abs().max(1.0),
    };
    let mut pairs = texel.value.iter().zip(wanted);
    texel.problem.is_none() && pairs.all(|(&is, &wanted)| is_same(is, wanted))
}
