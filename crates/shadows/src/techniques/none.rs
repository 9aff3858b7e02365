//! `none`: everything is lit. The floor of what shadows cost, and for passes that want surfaces alone.

use shadowgraph_core::Frame;
use shadowgraph_shaders::{ModuleSource, NONE};

use super::layout::layout;
use crate::technique::{Screen, ShadowOutputs, ShadowTechnique};
use crate::{Error, Needs, ShadowInputs};

/// The technique without shadows.
pub struct NoShadows {
    layout: wgpu::BindGroupLayout,
}

impl NoShadows {
    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { layout: layout(device, "no shadows", &[]) }
    }
}

impl ShadowTechnique for NoShadows {
    fn name(&self) -> &str {
        "none"
    }

    fn needs(&self, _inputs: &ShadowInputs<'_>) -> Needs {
        Needs { kernel_radius_texels: 0.0, bias_texels: 0.0, blocker_reach_m: 0.0 }
    }

    fn modules(&self, _variant: u32) -> Vec<ModuleSource> {
        vec![NONE]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        Vec::new()
    }

    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn add_to<'f>(
        &'f self,
        _frame: &mut Frame<'f>,
        _inputs: &ShadowInputs<'f>,
        _screen: Option<&Screen>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        Ok(ShadowOutputs::default())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::{CasterView, ShadowCasters, ShadowSettings};
    use glam::DVec3;
    use shadowgraph_scene::{Aabb, Camera, CullVolume};

    struct Nothing;
    impl ShadowCasters for Nothing {
        fn cull(&self, _: &CullVolume, _: &mut Vec<u32>) {}
        fn bounds(&self) -> Aabb {
            Aabb::EMPTY
        }
        fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) {}
    }

    #[test]
    fn no_shadows_add_no_pass_and_bind_nothing() {
        let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let technique = NoShadows::new(&device);
        let inputs = ShadowInputs {
            view: 0,
            camera: &Camera::framing(&Aabb::EMPTY, 1.0),
            aspect: 1.0,
            lights: &[],
            casters: &Nothing,
            origin_world: DVec3::ZERO,
            settings: &ShadowSettings::default(),
        };
        let mut frame = Frame::new();
        let outputs = technique.add_to(&mut frame, &inputs, None).unwrap();
        assert!(outputs.bindings.is_empty() && outputs.debug.is_empty());
        assert_eq!(frame.compile().unwrap().plan().pass_count(), 0);
    }
}
