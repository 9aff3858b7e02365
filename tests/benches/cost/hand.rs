//! The same frames without a graph: the chain's passes written by hand, with full knowledge of the frame.
//!
//! Textures, views and bind groups are created once. Textures are shared exactly as in the graph, in the same order:
//! more textures would cost wgpu more tracking and be an unfair reference.

use crate::drawing::{Drawing, texture};
use crate::frames::chain::{Chain, RESULT, SOURCE};
use shadowgraph_core::{Graph, Texture, wgpu};

pub(crate) struct Hand<'d> {
    drawing: &'d Drawing,
    passes: Vec<HandPass<'d>>,
}

struct HandPass<'d> {
    name: &'d str,
    target: wgpu::TextureView,
    clears: bool,
    pipeline: &'d wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl<'d> Hand<'d> {
    pub(crate) fn new(drawing: &'d Drawing, chain: &'d Chain) -> Self {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let handles: &mut Vec<Texture> = &mut Vec::new();
        chain.declare(&mut frame, handles, 0.0, |frame, texture| chain.import(frame, texture), |_, _, _| {});
        let compiled = graph.compile(frame).expect("the frame is valid");
        let plan = compiled.plan();
        let textures: Vec<wgpu::Texture> = plan.slots().map(|_| texture(&drawing.device)).collect();
        let physical: Vec<&wgpu::Texture> = plan
            .resources()
            .enumerate()
            .map(|(index, (_, resource))| match (index, resource.slot) {
                (SOURCE | RESULT, _) => &drawing.ends[index],
                (_, slot) => &textures[slot.expect("every texture is used").index()],
            })
            .collect();
        let view = |at: usize| physical[at].create_view(&Default::default());
        let pass = |id: &shadowgraph_core::PassId| {
            let declared = &chain.passes[id.index()];
            let program = drawing.program(declared.samples.len());
            let views: Vec<_> = declared.samples.iter().map(|&at| view(at)).collect();
            let entries: Vec<_> = (0..)
                .zip(&views)
                .map(|(binding, view)| wgpu::BindGroupEntry {
                    binding,
                    resource: wgpu::BindingResource::TextureView(view),
                })
                .collect();
            let group = drawing.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &program.layout,
                entries: &entries,
            });
            HandPass {
                name: &declared.name,
                target: view(declared.target),
                clears: declared.clears,
                pipeline: &program.pipeline,
                group,
            }
        };
        Self { drawing, passes: plan.order().iter().map(pass).collect() }
    }

    /// Records and submits a frame.
    pub(crate) fn frame(&self) {
        let mut encoder = self.drawing.device.create_command_encoder(&Default::default());
        for pass in &self.passes {
            let load = if pass.clears { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load };
            let mut recorded = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(pass.name),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &pass.target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            });
            recorded.set_pipeline(pass.pipeline);
            recorded.set_bind_group(0, &pass.group, &[]);
            recorded.draw(0..3, 0..1);
        }
        self.drawing.queue.submit([encoder.finish()]);
    }
}
