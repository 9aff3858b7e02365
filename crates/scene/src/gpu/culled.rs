//! Draws of instances that the GPU has culled.

use std::ops::Range;

use super::draw_list::{Draw, DrawPipeline, MaterialUse};
use super::scene::GpuScene;

/// Size of the arguments of an indexed indirect draw, bytes.
const ARGUMENTS_BYTES: u64 = size_of::<wgpu::util::DrawIndexedIndirectArgs>() as u64;
/// Size of a number of an instance, bytes.
const NUMBER_BYTES: u64 = size_of::<u32>() as u64;

/// What the pass reads that culls instances: `cull.wgsl`.
#[derive(Clone, Copy, Debug)]
pub struct CullInputs<'s> {
    /// The transforms of the instances.
    pub instances: &'s wgpu::Buffer,
    /// The batches: instances that one draw can draw.
    pub batches: &'s wgpu::Buffer,
    /// Number of instances, with numbers that no instance has.
    pub instance_count: u32,
    /// Number of batches.
    pub batch_count: u32,
    /// Numbers of instances of the list of one view.
    pub slot_count: u32,
    /// Whether draws begin with the first instance of their arguments: the device has `INDIRECT_FIRST_INSTANCE`.
    pub first_instance: bool,
}

impl CullInputs<'_> {
    /// Returns the size of the lists of some views, bytes.
    #[must_use]
    pub fn list_bytes(&self, views: u32) -> u64 {
        // Where lists are bound at an offset for each draw, all have the size of one.
        let lists = u64::from(views) + u64::from(!self.first_instance);
        lists * self.view_bytes()
    }

    /// Returns the size of the list of a view, bytes.
    #[must_use]
    pub fn view_bytes(&self) -> u64 {
        u64::from(self.slot_count) * NUMBER_BYTES
    }

    /// Returns the size of the draws of some views, bytes, with the number of visible instances of each.
    #[must_use]
    pub fn draw_bytes(&self, views: u32) -> u64 {
        self.count_bytes(views).end
    }

    /// Returns the bytes of the draws that have the number of visible instances of each view.
    #[must_use]
    pub fn count_bytes(&self, views: u32) -> Range<u64> {
        let views = u64::from(views);
        let begin = views * u64::from(self.batch_count) * ARGUMENTS_BYTES;
        begin..begin + views * NUMBER_BYTES
    }
}

/// The draws of one culled view.
#[derive(Clone, Copy, Debug)]
pub struct CulledView<'v> {
    /// Group 3: the transforms, and at a dynamic offset the list of a view, of [`CullInputs::view_bytes`].
    pub group: &'v wgpu::BindGroup,
    /// The draws of all views.
    pub draws: &'v wgpu::Buffer,
    /// The index of the view.
    pub view: u32,
}

impl GpuScene {
    /// Returns what the pass reads that culls instances.
    #[must_use]
    pub fn cull_inputs(&self) -> CullInputs<'_> {
        CullInputs {
            instances: self.instances.buffer(),
            batches: self.batches.buffer(),
            instance_count: self.instances.len(),
            batch_count: self.batches.list().len() as u32,
            slot_count: self.batches.slots(),
            first_instance: self.first_instance,
        }
    }

    /// Records the draws of a view that the GPU has culled, of the batches that have a pipeline. Sets the same state as
    /// [`draw`](Self::draw). Returns the number of draw calls.
    pub fn draw_culled<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        view: CulledView<'_>,
        pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
    ) -> u32 {
        let batches = self.batches.list();
        let mut calls = Calls::new(self, view);
        self.geometry.set_indices(pass);
        for (index, batch) in (0u32..).zip(batches) {
            let draw = &batch.draw;
            let Some(pipeline) = pipeline_for(draw) else { continue };
            let Some(group) = self.materials.group(draw.material) else { continue };
            let Some(ranges) = self.geometry.ranges(draw.mesh) else { continue };
            if calls.pipeline != Some(pipeline.pipeline) {
                calls.flush(pass);
                pass.set_pipeline(pipeline.pipeline);
                calls.pipeline = Some(pipeline.pipeline);
            }
            let material = Some((draw.material, pipeline.material));
            if pipeline.material != MaterialUse::None && calls.material != material {
                calls.flush(pass);
                pass.set_bind_group(2, group.get(pipeline.material), &[]);
                calls.material = material;
            }
            if draw.posed.is_some() {
                calls.flush(pass);
                self.posed.set_vertices(pass, ranges.vertex_count());
            } else if calls.is_posed != Some(false) {
                calls.flush(pass);
                self.geometry.set_vertices(pass);
            }
            calls.is_posed = Some(draw.posed.is_some());
            calls.push(pass, index, batch.first_slot);
        }
        calls.flush(pass);
        calls.count
    }
}

/// The state of a pass, and draws that are recorded by the next call.
struct Calls<'v, 'p> {
    culled: CulledView<'v>,
    batch_count: u32,
    /// The list of the view, bytes.
    list_offset: u64,
    first_instance: bool,
    pipeline: Option<&'p wgpu::RenderPipeline>,
    material: Option<(u32, MaterialUse)>,
    is_posed: Option<bool>,
    /// The first batch that is not recorded, and the number of those.
    pending: (u32, u32),
    /// Number of calls.
    count: u32,
}

impl<'v> Calls<'v, '_> {
    fn new(scene: &GpuScene, culled: CulledView<'v>) -> Self {
        let inputs = scene.cull_inputs();
        Self {
            culled,
            batch_count: inputs.batch_count,
            list_offset: u64::from(culled.view) * inputs.view_bytes(),
            first_instance: inputs.first_instance,
            pipeline: None,
            material: None,
            is_posed: None,
            pending: (0, 0),
            count: 0,
        }
    }

    /// Adds the draw of a batch.
    fn push(&mut self, pass: &mut wgpu::RenderPass<'_>, batch: u32, first_slot: u32) {
        if !self.first_instance {
            // Draws begin with instance 0, which is the first of the list.
            let offset = self.list_offset + u64::from(first_slot) * NUMBER_BYTES;
            pass.set_bind_group(3, self.culled.group, &[offset as u32]);
            self.pending = (batch, 1);
            self.record(pass);
            return;
        }
        let (first, count) = self.pending;
        if count > 0 && first + count == batch {
            self.pending.1 += 1;
        } else {
            self.flush(pass);
            self.pending = (batch, 1);
        }
    }

    /// Records the draws that are not yet recorded.
    fn flush(&mut self, pass: &mut wgpu::RenderPass<'_>) {
        if self.pending.1 > 0 {
            if self.count == 0 {
                pass.set_bind_group(3, self.culled.group, &[self.list_offset as u32]);
            }
            self.record(pass);
        }
    }

    fn record(&mut self, pass: &mut wgpu::RenderPass<'_>) {
        let (first, count) = std::mem::take(&mut self.pending);
        let offset = u64::from(self.culled.view * self.batch_count + first) * ARGUMENTS_BYTES;
        if count == 1 {
            pass.draw_indexed_indirect(self.culled.draws, offset);
        } else {
            pass.multi_draw_indexed_indirect(self.culled.draws, offset, count);
        }
        self.count += 1;
    }
}
