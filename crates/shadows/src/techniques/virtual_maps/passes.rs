//! The passes that bring the pages of a frame up to date.

use shadowgraph_core::{Bind, Buffer, BufferDesc, Contents, Format, Frame, Texture, TextureDesc, Uniform};
use shadowgraph_shaders::compose;

use super::plan::{MAX_COARSE, VirtualPlan};
use super::pool_view::PoolView;
use super::projections::PAGE_PX;
use super::settings::VirtualSettings;
use super::store::{Boxes, MAX_BOXES, POOL_FORMAT, PageStore, StoreState};
use super::tints::{TintPasses, Tints};
use crate::error::Error;
use crate::layered_casters::{LayerTokens, LayeredCasters, LayeredInstances};
use crate::plan::ShadowInputs;
use crate::technique::binding::{DEPTH_MAP, FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{ShadowCounts, SurfaceBuffers, layout};
use crate::techniques::compute::{WRITTEN, dispatch, pipeline, shader};
use crate::vertex_buffers::VertexBuffers;
use std::sync::Arc;

/// The side of a workgroup that marks pages, pixels: 8 x 8 threads, each with 4 x 4 pixels.
const WORKGROUP_PX: u32 = 32;
/// Threads of a workgroup of passes over pages.
const THREADS: u32 = 64;
/// Workgroups of passes over lists whose length the CPU does not know.
const LIST_WORKGROUPS: u32 = 32;
/// The most pages that the pixels of a frame request, and that it may need at any coarsening.
const REQUESTS: u32 = 1 << 16;
const NEEDS: u32 = 1 << 17;
/// Bytes of `ListedPage`, `Counters` and `LayerView`, and of the header of `LayerViews`.
const LISTED_BYTES: u32 = 24;
const COUNTER_BYTES: u64 = 48;
const VIEW_BYTES: u64 = 96;
const VIEWS_HEADER_BYTES: u64 = 32;

/// The numbers of `Counters` that are read back, from `requested` on, and their bytes.
const COUNTS: [&str; 8] = [
    "pages requested",
    "pages listed",
    ShadowCounts::PAGES,
    "pages resident",
    "static pages drawn",
    "composite pages drawn",
    ShadowCounts::CASTERS,
    "coarsening, quarters of a level",
];
const COUNT_BYTES: std::ops::Range<u64> = 16..COUNTER_BYTES;

/// Returns a sentence if the pool is too small for texels that are as narrow as pixels, or a list for the pages.
fn warning(counts: &[u32], level_bias: f32) -> Option<String> {
    if let [requested, listed, ..] = *counts
        && (requested > REQUESTS || listed > NEEDS)
    {
        return Some(format!(
            "shadow maps are coarser in parts of the image: it needs more pages than `virtual` can list; raise level_bias, which is {level_bias}"
        ));
    }
    let quarters = counts.last().copied().filter(|quarters| *quarters > 0)?;
    let texels = (level_bias + quarters as f32 / 4.0).exp2();
    (texels > 1.0).then(|| {
        format!("texels of shadow maps are up to {texels:.1} times as wide as pixels: the pool of `virtual` (pool_mib) is too small")
    })
}

/// The pipelines and their layouts.
pub(super) struct Passes {
    view_layout: wgpu::BindGroupLayout,
    state_layout: wgpu::BindGroupLayout,
    mark_layout: wgpu::BindGroupLayout,
    update_layout: wgpu::BindGroupLayout,
    combine_layout: wgpu::BindGroupLayout,
    store_layout: wgpu::BindGroupLayout,
    mark: wgpu::ComputePipeline,
    validate: wgpu::ComputePipeline,
    list: wgpu::ComputePipeline,
    allocate: wgpu::ComputePipeline,
    finish: wgpu::ComputePipeline,
    ranges: wgpu::ComputePipeline,
    combine: wgpu::ComputePipeline,
    store: wgpu::RenderPipeline,
    tints: TintPasses,
    pool_view: PoolView,
}

/// The buffers of a frame.
pub(super) struct FrameBuffers {
    pub(super) projections: Buffer,
    pub(super) levels: Buffer,
    pub(super) lights: Buffer,
    pub(super) table: Buffer,
    pub(super) pages: Buffer,
    pub(super) pool: Texture,
    /// If the pool has them.
    pub(super) tints: Option<Tints>,
    /// The pool as an image.
    pub(super) pool_view: Texture,
}

impl Passes {
    pub(super) fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let view_layout = layout(device, "view", &[UNIFORM]);
        let state = [UNIFORM, STORAGE, STORAGE, WRITTEN, WRITTEN, WRITTEN];
        let state_layout = layout(device, "pages", &state);
        let mark_layout = layout(device, "mark pages", &[FLOAT_MAP, STORAGE]);
        let update_layout = layout(device, "update pages", &[WRITTEN; 3]);
        let marking = shader(device, "pages_mark.wgsl", compose("pages_mark.wgsl", &[])?);
        let mark = pipeline(device, &marking, "cs_mark", &[&view_layout, &state_layout, &mark_layout]);
        let updating = shader(device, "pages_update.wgsl", compose("pages_update.wgsl", &[])?);
        let update =
            |entry| pipeline(device, &updating, entry, &[&view_layout, &state_layout, &update_layout]);
        let combine_layout =
            layout(device, "combine pages", &[STORAGE, WRITTEN, UNIFORM, DEPTH_MAP, WRITTEN, STORAGE]);
        let combining = shader(device, "pages_combine.wgsl", compose("pages_combine.wgsl", &[])?);
        let (store_layout, store) = store_pipeline(device)?;
        Ok(Self {
            mark,
            validate: update("cs_validate"),
            list: update("cs_list"),
            allocate: update("cs_allocate"),
            finish: update("cs_finish"),
            ranges: pipeline(device, &combining, "cs_static", &[&combine_layout]),
            combine: pipeline(device, &combining, "cs_composite", &[&combine_layout]),
            store,
            tints: TintPasses::new(device)?,
            pool_view: PoolView::new(device)?,
            view_layout,
            state_layout,
            mark_layout,
            update_layout,
            combine_layout,
            store_layout,
        })
    }

    /// Adds the passes. The frame leaves `next` in the store when it is recorded.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (inputs, buffers, settings): (&ShadowInputs<'f>, &SurfaceBuffers, &VirtualSettings),
        (plan, casters): (&VirtualPlan, &'f dyn LayeredCasters),
        (store, next, boxes): (&Arc<PageStore>, StoreState, &Boxes),
    ) -> FrameBuffers {
        let block = frame_block((inputs, buffers.ground_height), settings, plan, (store, &next, boxes));
        let upload = |frame: &mut Frame<'f>, name: &'static str, bytes: &[u8]| {
            frame.upload_buffer(name, bytes.to_vec())
        };
        let list_bytes = u64::from(LISTED_BYTES) * u64::from(REQUESTS + NEEDS);
        let lists = BufferDesc::new(list_bytes).unordered(LISTED_BYTES);
        let mut steps = Steps {
            block: upload(frame, "pages of the frame", &block),
            projections: upload(frame, "projections", bytemuck::cast_slice(&plan.projections)),
            levels: upload(frame, "levels", bytemuck::cast_slice(&plan.levels)),
            lights: upload(frame, "shadow lights", bytemuck::cast_slice(&plan.lights)),
            marks: frame.import_buffer("page marks", &store.marks, true),
            counters: upload(frame, "page counters", &[0; COUNTER_BYTES as usize]),
            lists: frame.create_buffer("page lists", lists),
            table: frame.import_buffer("page table", &store.table, true),
            pages: frame.import_buffer("physical pages", &store.pages, true),
            views: frame.create_buffer(
                "page views",
                BufferDesc::new(VIEWS_HEADER_BYTES + VIEW_BYTES * u64::from(store.size.pages)),
            ),
            view: buffers.view.clone(),
            scratch: Contents::Overwrite,
        };
        let validated = store.size.pages.max(plan.coarse.len() as u32).div_ceil(THREADS);
        let committed = store.clone();
        self.update(frame, &mut steps, "validate", vec![(&self.validate, validated)], move || {
            *committed.known() = next;
        });
        self.mark(frame, &mut steps, buffers);
        let allocation = vec![(&self.list, LIST_WORKGROUPS), (&self.allocate, 1)];
        self.update(frame, &mut steps, "allocate", allocation, || {});
        let drawn = casters.cull_layers(frame, &mut steps.views, store.size.pages);
        self.update(frame, &mut steps, "finish", vec![(&self.finish, 4)], || {});
        let mut depths = frame.import_buffer("page depths", &store.depths, true);
        draw(frame, casters, &drawn, &steps.views, &mut depths);
        let [width, height] = store.size.size_px;
        let size = frame.uniform(bytemuck::cast_slice(&[width, height, store.size.columns, 0]));
        let mut pool = frame.import_texture("page pool", &store.pool, true);
        self.combine(frame, &mut steps, (&pool, size), &mut depths);
        let mut tints = store.tints.as_ref().map(|store| store.import(frame));
        if let Some(tints) = &mut tints {
            self.tints.add_to(frame, (casters, &drawn), (&steps.views, &mut depths), tints);
        }
        self.store(frame, &steps, (&mut pool, size), &mut depths);
        let Steps { projections, levels, lights, table, pages, counters, .. } = steps;
        let pool_view =
            self.pool_view.add_to(frame, [&projections, &levels, &table, &pages], &pool, store.size.size_px);
        let level_bias = settings.level_bias;
        let warning = Arc::new(move |counts: &[u32]| warning(counts, level_bias));
        frame.publish(ShadowCounts { names: &COUNTS, buffer: counters, bytes: COUNT_BYTES, warning });
        FrameBuffers { projections, levels, lights, table, pages, pool, tints, pool_view }
    }

    /// Adds a pass with some steps of `pages_update.wgsl`. `recorded` is called when it is recorded.
    fn update<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        steps: &mut Steps,
        name: &'static str,
        dispatches: Vec<(&'f wgpu::ComputePipeline, u32)>,
        recorded: impl FnOnce() + Send + 'f,
    ) {
        let mut pass = frame.compute_pass(name);
        let view = pass.uniform_buffer(&steps.view);
        let state = steps.state(&mut pass);
        let [table, pages] = [&mut steps.table, &mut steps.pages]
            .map(|buffer| Bind::Buffer(pass.storage_buffer_mut(buffer, Contents::Preserve)));
        let views = Bind::Buffer(pass.storage_buffer_mut(&mut steps.views, steps.scratch));
        let update = [table, pages, views];
        steps.scratch = Contents::Preserve;
        pass.body(move |ctx| {
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view)])?,
                ctx.bind_group(&self.state_layout, &state)?,
                ctx.bind_group(&self.update_layout, &update)?,
            ];
            for (pipeline, workgroups) in dispatches {
                dispatch(&mut ctx.pass, pipeline, &groups, [workgroups, 1, 1]);
            }
            recorded();
            Ok(())
        });
    }

    /// Adds the pass that marks the pages that visible surfaces are read from.
    fn mark<'f>(&'f self, frame: &mut Frame<'f>, steps: &mut Steps, buffers: &SurfaceBuffers) {
        let mut pass = frame.compute_pass("mark");
        let view = pass.uniform_buffer(&steps.view);
        let state = steps.state(&mut pass);
        let (surfaces, lights) = (pass.sample(&buffers.surfaces), pass.storage_buffer(&steps.lights));
        let [width, height] = buffers.size_px.map(|side| side.div_ceil(WORKGROUP_PX));
        pass.body(move |ctx| {
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view)])?,
                ctx.bind_group(&self.state_layout, &state)?,
                ctx.bind_group(&self.mark_layout, &[Bind::Texture(surfaces), Bind::Buffer(lights)])?,
            ];
            dispatch(&mut ctx.pass, &self.mark, &groups, [width, height, 1]);
            Ok(())
        });
    }

    /// Adds the pass that finds the ranges of drawn pages and adds static casters to the layers of composite ones.
    fn combine<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        steps: &mut Steps,
        (pool, size): (&Texture, Uniform),
        depths: &mut Buffer,
    ) {
        let mut pass = frame.compute_pass("combine");
        let views = pass.storage_buffer(&steps.views);
        let depths = pass.storage_buffer_mut(depths, Contents::Preserve);
        let pool = pass.sample(pool);
        let pages = pass.storage_buffer_mut(&mut steps.pages, Contents::Preserve);
        let projections = pass.storage_buffer(&steps.projections);
        pass.body(move |ctx| {
            let bindings = [
                Bind::Buffer(views),
                Bind::Buffer(depths),
                Bind::Uniform(size),
                Bind::Texture(pool),
                Bind::Buffer(pages),
                Bind::Buffer(projections),
            ];
            let groups = [ctx.bind_group(&self.combine_layout, &bindings)?];
            dispatch(&mut ctx.pass, &self.ranges, &groups, [LIST_WORKGROUPS, 1, 1]);
            dispatch(&mut ctx.pass, &self.combine, &groups, [LIST_WORKGROUPS, 1, 1]);
            Ok(())
        });
    }

    /// Adds the pass that stores drawn pages in the pool.
    fn store<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        steps: &Steps,
        (pool, size): (&mut Texture, Uniform),
        depths: &mut Buffer,
    ) {
        let mut pass = frame.render_pass("store");
        let views = pass.storage_buffer(&steps.views);
        let depths = pass.storage_buffer_mut(depths, Contents::Preserve);
        let pages = pass.storage_buffer(&steps.pages);
        let counters = pass.indirect_buffer(&steps.counters);
        pass.depth(pool, Contents::Preserve);
        pass.body(move |ctx| {
            let bindings =
                [Bind::Buffer(views), Bind::Buffer(depths), Bind::Uniform(size), Bind::Buffer(pages)];
            let group = ctx.bind_group(&self.store_layout, &bindings)?;
            ctx.pass.set_pipeline(&self.store);
            ctx.pass.set_bind_group(0, &group, &[]);
            let counters = ctx.buffer(counters)?;
            ctx.pass.draw_indirect(counters, 0);
            Ok(())
        });
    }
}

/// Adds the pass that draws the casters of pages.
fn draw<'f>(
    frame: &mut Frame<'f>,
    casters: &'f dyn LayeredCasters,
    drawn: &LayeredInstances,
    views: &Buffer,
    depths: &mut Buffer,
) {
    let mut target = frame.create_texture("page", TextureDesc::d2(PAGE_PX, PAGE_PX, Format::R8Unorm));
    let vertices = VertexBuffers::published_in(frame);
    let mut pass = frame.render_pass("draw");
    vertices.read_in(&mut pass);
    let tokens = LayerTokens::in_pass(&mut pass, drawn, views, depths);
    pass.color(&mut target, Contents::clear_color([0.0; 4]));
    pass.body(move |ctx| casters.draw_layers(ctx, tokens).map(|_| ()));
}

/// The resources that the passes of a frame share.
struct Steps {
    view: Buffer,
    block: Buffer,
    projections: Buffer,
    levels: Buffer,
    lights: Buffer,
    marks: Buffer,
    counters: Buffer,
    lists: Buffer,
    table: Buffer,
    pages: Buffer,
    views: Buffer,
    /// What a pass finds in the lists and views: nothing before the first.
    scratch: Contents,
}

impl Steps {
    /// Declares the accesses of group 1.
    fn state(
        &mut self,
        pass: &mut shadowgraph_core::Pass<'_, '_, shadowgraph_core::Compute>,
    ) -> [Bind<'static>; 6] {
        let block = Bind::Buffer(pass.uniform_buffer(&self.block));
        let [projections, levels] =
            [&self.projections, &self.levels].map(|buffer| Bind::Buffer(pass.storage_buffer(buffer)));
        let [marks, counters] = [&mut self.marks, &mut self.counters]
            .map(|buffer| Bind::Buffer(pass.storage_buffer_mut(buffer, Contents::Preserve)));
        let lists = Bind::Buffer(pass.storage_buffer_mut(&mut self.lists, self.scratch));
        [block, projections, levels, marks, counters, lists]
    }
}

/// Returns the bytes of `PagesFrame` of `pages_state.wgsl`.
fn frame_block(
    (inputs, ground_height): (&ShadowInputs<'_>, Option<f32>),
    settings: &VirtualSettings,
    plan: &VirtualPlan,
    (store, next, boxes): (&PageStore, &StoreState, &Boxes),
) -> Vec<u8> {
    let changed = boxes.changed.as_deref().unwrap_or_default();
    let ends = [changed.len(), boxes.moved.len(), boxes.movers.len()].map(|count| count as u32);
    let all = changed.iter().chain(&boxes.moved).chain(&boxes.movers);
    let mut words: Vec<glam::Vec4> = all
        .flat_map(|bounds| {
            let center = (bounds.center() - inputs.origin_world).as_vec3();
            // Rounding of the centre is covered too.
            let half_size = bounds.half_extent().as_vec3() * 1.000_001 + center.abs() * 1e-6;
            [center, half_size].map(|part| part.extend(0.0))
        })
        .collect();
    words.resize(2 * MAX_BOXES, glam::Vec4::ZERO);
    let mut coarse = plan.coarse.clone();
    coarse.resize(MAX_COARSE, [0; 4]);
    let header = [
        next.frame,
        store.size.pages,
        store.size.columns,
        inputs.lights.len() as u32,
        plan.coarse.len() as u32,
        ends[0],
        ends[0] + ends[1],
        ends[0] + ends[1] + ends[2],
        REQUESTS,
        NEEDS,
        settings.level_bias.to_bits(),
        u32::from(boxes.changed.is_none()),
        ground_height.unwrap_or(0.0).to_bits(),
        u32::from(ground_height.is_some()),
        0,
        0,
    ];
    [bytemuck::cast_slice(&header), bytemuck::cast_slice(&coarse), bytemuck::cast_slice::<_, u8>(&words)]
        .concat()
}

fn store_pipeline(device: &wgpu::Device) -> Result<(wgpu::BindGroupLayout, wgpu::RenderPipeline), Error> {
    let shader = shader(device, "pages_store.wgsl", compose("pages_store.wgsl", &[])?);
    let buffer = |binding, visibility, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let (both, fragment) = (wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::ShaderStages::FRAGMENT);
    let storage = |read_only| wgpu::BufferBindingType::Storage { read_only };
    let store_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("store pages"),
        entries: &[
            buffer(0, both, storage(true)),
            buffer(1, fragment, storage(false)),
            buffer(2, both, wgpu::BufferBindingType::Uniform),
            buffer(3, wgpu::ShaderStages::VERTEX, storage(true)),
        ],
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("store pages"),
        bind_group_layouts: &[Some(&store_layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("store pages"),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: Some("vs_store"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: POOL_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: Some("fs_store"),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    Ok((store_layout, pipeline))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_name_the_setting_that_is_too_small() {
        let counts = |requested, listed, quarters| [requested, listed, 9, 9, 9, 0, 9, quarters];
        assert_eq!(COUNTS.len(), counts(0, 0, 0).len());
        assert_eq!(warning(&counts(REQUESTS, NEEDS, 5), -1.25), None);
        let said = warning(&counts(9, 9, 9), -1.25);
        assert!(said.is_some_and(|said| said.contains("2.0 times") && said.contains("pool_mib")));
        for counts in [counts(REQUESTS + 1, 9, 0), counts(9, NEEDS + 1, 0)] {
            assert!(warning(&counts, -1.25).is_some_and(|said| said.contains("level_bias, which is -1.25")));
        }
    }
}
