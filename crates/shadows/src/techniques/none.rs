//! `none`: everything is lit. The lower bound of cost, and for passes that need surface buffers only.

use shadowgraph_core::Frame;
use shadowgraph_shaders::{ModuleSource, NONE};

use crate::error::Error;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::technique::{ShadowOutputs, ShadowTechnique, SurfaceBuffers};

/// The technique without shadows.
pub struct NoShadows;

impl ShadowTechnique for NoShadows {
    fn name(&self) -> &str {
        "none"
    }

    fn requirements(&self, _inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(Requirements::NONE)
    }

    fn modules(&self, _variant: u32) -> Vec<ModuleSource> {
        vec![NONE]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        Vec::new()
    }

    fn add_to<'f>(
        &'f self,
        _frame: &mut Frame<'f>,
        _inputs: &ShadowInputs<'f>,
        _requirements: &Requirements,
        _buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        Ok(ShadowOutputs::default())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::caster_view::CasterView;
    use crate::casters::ShadowCasters;
    use crate::settings::ShadowSettings;
    use glam::DVec3;
    use shadowgraph_scene::{Aabb, Camera, CullVolume};

    struct NoCasters;
    impl ShadowCasters for NoCasters {
        fn cull(&self, _: &CullVolume, _: &mut Vec<u32>) {}
        fn bounds(&self) -> Aabb {
            Aabb::EMPTY
        }
        fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) -> u32 {
            0
        }
    }

    #[test]
    fn no_shadows_add_no_pass_and_bind_nothing() {
        let inputs = ShadowInputs {
            view: 0,
            camera: &Camera::framing(&Aabb::EMPTY, 1.0),
            aspect: 1.0,
            lights: &[],
            casters: &NoCasters,
            origin_world: DVec3::ZERO,
            settings: &ShadowSettings::default(),
        };
        let mut frame = Frame::new();
        let outputs = NoShadows.add_to(&mut frame, &inputs, &Requirements::NONE, None).unwrap();
        assert!(outputs.bindings.is_empty() && outputs.debug.is_empty());
        assert_eq!(frame.compile().unwrap().plan().pass_count(), 0);
    }
}
