//! The contents of a frame: what its passes wrote, and how long they took; and all of `shadowgraph-inspect`, which shows them.

mod above;
pub mod lights;

use std::ops::ControlFlow;

use shadowgraph_core::{
    Buffer, Contained, FrameCapture, PendingCapture, Plan, ResourceDesc, ResourceId, TextureDesc,
    TextureSnapshot, Timer, did_you_mean,
};
use shadowgraph_scene::Light;
use shadowgraph_shadows::{ShadowLight, ShadowView};

#[doc(no_inline)]
pub use shadowgraph_inspect::*;

use crate::gpu::Gpu;
use crate::rendered::RenderedFrame;
use crate::renderer::{Drawn, Renderer};
use crate::view_options::ViewOptions;

/// A view that was drawn, with what its passes wrote.
#[derive(Debug)]
pub struct InspectedFrame {
    /// The view as [`draw`](Renderer::draw) draws it, with times.
    pub frame: RenderedFrame,
    /// Every texture of the frame, after each pass that wrote it.
    pub textures: Vec<TextureSnapshot>,
    /// The views of shadow maps; empty for a technique without maps.
    pub views: Vec<ShadowView>,
    /// The range of views of each light; empty for a technique without maps.
    pub lights: Vec<ShadowLight>,
}

impl Renderer {
    /// Draws a view like [`draw`](Self::draw), measures it, and draws it once more to capture all that its passes write.
    ///
    /// # Errors
    /// As `draw`.
    pub fn inspect(&mut self, gpu: &Gpu, options: &ViewOptions) -> Result<InspectedFrame, crate::Error> {
        // Shows how the maps are drawn, which the first frame did.
        let options = &ViewOptions { shadows: options.shadows.without_cache(), ..options.clone() };
        // Drivers may compile shaders at the first draw.
        self.draw(gpu, options)?;
        let frame = self.draw_timed(gpu, options, Some(&mut Timer::new()))?;
        let mut capture: Option<PendingCapture> = None;
        let Drawn { shadow_buffers, .. } = self.draw_with(gpu, options, |compiled, graph| {
            gpu.submit(|encoder| {
                let (executed, taken) = compiled.execute_captured(graph, &gpu.device, encoder)?;
                capture = Some(taken);
                Ok(executed)
            })
        })?;
        let captured = match capture {
            Some(capture) => capture.wait(&gpu.device)?,
            None => FrameCapture::default(),
        };
        let (mut views, mut lights): (Vec<ShadowView>, Vec<ShadowLight>) = match &shadow_buffers {
            Some([views, lights]) => (read_structs(&captured, views), read_structs(&captured, lights)),
            None => (Vec::new(), Vec::new()),
        };
        // The buffers may be as large as the uniform blocks that read them.
        lights.truncate(self.scene().lights().len());
        let ends = lights.iter().map(|light| light.first_view + light.view_count);
        views.truncate(ends.max().unwrap_or(0) as usize);
        Ok(InspectedFrame { frame, textures: captured.textures, views, lights })
    }
}

impl Renderer {
    /// Draws a view like [`draw`](Self::draw), pass by pass, and records all that its passes write.
    ///
    /// # Errors
    /// As `draw`.
    pub fn record_contents(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        recorder: &mut ContentsRecorder,
    ) -> Result<RenderedFrame, crate::Error> {
        let Drawn { frame, .. } = self.draw_with(gpu, options, |compiled, graph| {
            let mut add = |contained| {
                recorder.add(&contained);
                ControlFlow::Continue(())
            };
            Ok(compiled.execute_visited(graph, &gpu.device, &gpu.queue, &mut add)?)
        })?;
        Ok(frame)
    }

    /// Draws a view like [`draw`](Self::draw), pass by pass, and returns the history of a pixel of its image: column and row from the top left.
    ///
    /// # Errors
    /// As `draw`, and for a pixel outside of the image.
    pub fn pixel_history(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        pixel: [u32; 2],
    ) -> Result<(RenderedFrame, PixelHistory), crate::Error> {
        options.pixel_index(pixel)?;
        let mut recorder = PixelRecorder::new(PixelPlace { pixel, size_px: options.size_px });
        let Drawn { frame, image, .. } = self.draw_with(gpu, options, |compiled, graph| {
            let plan = compiled.shared_plan();
            let mut add = |contained| {
                recorder.add(&plan, &contained);
                ControlFlow::Continue(())
            };
            Ok(compiled.execute_visited(graph, &gpu.device, &gpu.queue, &mut add)?)
        })?;
        let history = recorder.history(&frame.plan, image);
        Ok((frame, history))
    }

    /// Draws a view until a version of a texture is written, by name or path, and returns it as an image. The passes after that do not run, so
    /// the next frame begins with incomplete histories.
    ///
    /// # Errors
    /// As [`draw`](Self::draw); for a texture or a version that the frame does not write; for texels that cannot be shown.
    pub fn stop_at(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        texture: &str,
        version: u32,
    ) -> Result<VersionImage, crate::Error> {
        let mut found = None;
        self.draw_with(gpu, options, |compiled, graph| {
            let plan = compiled.shared_plan();
            let (id, desc) = written(&plan, texture, version)?;
            let mut visit = |contained: Contained| {
                if contained.resource != id || contained.version != version {
                    return ControlFlow::Continue(());
                }
                found = Some(VersionImage::new(&plan, &desc, &contained));
                ControlFlow::Break(())
            };
            Ok(compiled.execute_visited(graph, &gpu.device, &gpu.queue, &mut visit)?)
        })?;
        let image = found.unwrap_or_else(|| Err("no pass that runs writes it".into()));
        image.map_err(|reason| crate::Error::NoImage { name: texture.into(), version, reason })
    }
}

impl InspectedFrame {
    /// Returns the HTML page of the frame: its plan, times and textures, its lights, and the volumes of its shadow maps.
    pub fn page(&self, scene_lights: &[Light], options: &ViewOptions) -> HtmlPage<'_> {
        let mut page = self.frame.page(scene_lights);
        page.snapshots.clone_from(&self.textures);
        page.drawings.extend(above::from_above(self, scene_lights, options));
        page
    }
}

/// Returns the texture of a name or path, if the frame writes the version.
fn written(plan: &Plan, texture: &str, version: u32) -> Result<(ResourceId, TextureDesc), crate::Error> {
    let is_named = |id: ResourceId, name: &str| name == texture || plan.resource_path(id) == texture;
    let textures = || {
        plan.resources().filter_map(|(id, resource)| match resource.desc {
            ResourceDesc::Texture(desc) => Some((id, resource.name, desc)),
            ResourceDesc::Buffer(_) => None,
        })
    };
    let Some((id, _, desc)) = textures().rev().find(|(id, name, _)| is_named(*id, name)) else {
        let hint = did_you_mean(texture, textures().map(|(_, name, _)| name));
        return Err(crate::Error::UnknownTexture { name: texture.into(), hint });
    };
    let writes = plan.order().iter().flat_map(|&pass| plan.accesses(pass));
    let writes = writes.filter(|access| access.resource == id && access.contents.is_some());
    let last = writes.map(|access| access.version + 1).max().unwrap_or(0);
    if (1..=last).contains(&version) {
        return Ok((id, desc));
    }
    let reason = match last {
        0 => "no pass writes it".into(),
        last => format!("expected a version from 1 to {last}"),
    };
    Err(crate::Error::NoImage { name: texture.into(), version, reason })
}

/// Returns the last captured contents of a buffer as structs.
fn read_structs<R: bytemuck::AnyBitPattern>(captured: &FrameCapture, buffer: &Buffer) -> Vec<R> {
    let last = captured.buffers.iter().rev().find(|(id, _)| *id == buffer.id());
    let bytes = last.map_or(&[][..], |(_, bytes)| bytes);
    bytes.chunks_exact(size_of::<R>()).map(bytemuck::pod_read_unaligned).collect()
}
