//! A pass in which regions are cleared: its textures, and the expected texels.

use super::Gpu;
use crate::Rect;
use crate::desc::Format;
use crate::internal::{RegionClear, RegionClears, Targets};

pub(super) const SIDE: u32 = 8;

/// Two tiles that share an edge, a rectangle that is not on a grid, and the last texel.
const RECTS: [Rect; 4] = [
    Rect { x: 0, y: 0, width: 4, height: 8 },
    Rect { x: 4, y: 0, width: 4, height: 8 },
    Rect { x: 3, y: 2, width: 4, height: 5 },
    Rect { x: 7, y: 7, width: 1, height: 1 },
];

#[derive(Clone, Default)]
pub(super) struct Values {
    pub(super) colors: Vec<Option<[f64; 4]>>,
    pub(super) depth: Option<f32>,
    pub(super) stencil: Option<u32>,
}

impl Values {
    /// Returns the values everywhere after `clear` has cleared everything in `self`.
    fn cleared_by(&self, clear: &Values) -> Values {
        let colors = self.colors.iter().enumerate();
        Values {
            colors: colors.map(|(i, color)| clear.colors.get(i).copied().flatten().or(*color)).collect(),
            depth: clear.depth.or(self.depth),
            stencil: clear.stencil.or(self.stencil),
        }
    }
}

pub(super) struct Stage<'g> {
    gpu: &'g Gpu,
    pub(super) targets: Targets,
    colors: Vec<Option<wgpu::TextureView>>,
    depth_stencil: Option<wgpu::TextureView>,
    pub(super) depth_read_only: bool,
}

impl<'g> Stage<'g> {
    pub(super) fn new(
        gpu: &'g Gpu,
        colors: &[Option<Format>],
        depth_stencil: Option<Format>,
        samples: u32,
    ) -> Self {
        let size = wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 };
        let view = |format: Format| gpu.texture(format, size, 1, samples).create_view(&Default::default());
        Self {
            gpu,
            targets: Targets { colors: colors.to_vec(), depth_stencil, samples },
            colors: colors.iter().map(|format| format.map(view)).collect(),
            depth_stencil: depth_stencil.map(view),
            depth_read_only: false,
        }
    }

    /// Opens a pass that clears everything to `values`, or loads everything, and calls `record`.
    pub(super) fn pass(&self, values: Option<&Values>, record: impl FnOnce(&mut wgpu::RenderPass<'_>)) {
        let colors = self.colors.iter().enumerate().map(|(index, view)| {
            let value = values.map(|values| values.colors[index].unwrap_or_default());
            view.as_ref().map(|view| color_attachment(view, None, value))
        });
        let colors: Vec<_> = colors.collect();
        let read_only = self.depth_read_only && values.is_none();
        let depth_stencil = self.depth_stencil.as_ref();
        let depth_stencil = depth_stencil.map(|view| depth_attachment(view, values, read_only));
        self.gpu.submit(|encoder| {
            record(&mut encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &colors,
                depth_stencil_attachment: depth_stencil,
                ..Default::default()
            }));
        });
    }

    /// Returns the texels of everything that can be read: colours (resolved), then depth, then stencil.
    pub(super) fn read(&self) -> Vec<Vec<Vec<u8>>> {
        let mut all: Vec<_> = self.colors.iter().flatten().map(|color| self.read_color(color)).collect();
        if let Some(view) = self.depth_stencil.as_ref().filter(|_| self.targets.samples == 1) {
            let format = view.texture().format();
            for aspect in [wgpu::TextureAspect::DepthOnly, wgpu::TextureAspect::StencilOnly] {
                let exists = format.aspect_specific_format(aspect).is_some();
                if exists && format.block_copy_size(Some(aspect)).is_some() {
                    all.push(self.gpu.read(view.texture(), aspect, 0, 0));
                }
            }
        }
        all
    }

    fn read_color(&self, view: &wgpu::TextureView) -> Vec<Vec<u8>> {
        let texture = view.texture();
        if texture.sample_count() == 1 {
            return self.gpu.read(texture, wgpu::TextureAspect::All, 0, 0);
        }
        let flags = self.gpu.format_features(texture.format()).flags;
        if !flags.contains(wgpu::TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE) {
            return Vec::new();
        }
        let resolved = self.gpu.texture(texture.format(), texture.size(), 1, 1);
        let resolved_view = resolved.create_view(&Default::default());
        self.gpu.submit(|encoder| {
            encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(color_attachment(view, Some(&resolved_view), None))],
                ..Default::default()
            });
        });
        self.gpu.read(&resolved, wgpu::TextureAspect::All, 0, 0)
    }

    /// Clears each rectangle of [`RECTS`] over `before` and compares all texels with those of a whole-target
    /// `LoadOp::Clear`: of `cleared` inside, of `before` outside.
    pub(super) fn check(&self, before: &Values, cleared: &Values) {
        let mut clears = RegionClears::default();
        let clear = |clears: &mut RegionClears, rect| {
            let clear =
                RegionClear { colors: &cleared.colors, depth: cleared.depth, stencil: cleared.stencil, rect };
            self.pass(None, |pass| {
                // State that an earlier draw of the pass may have left.
                pass.set_scissor_rect(1, 1, 2, 2);
                pass.set_viewport(1.0, 1.0, 2.0, 2.0, 0.0, 0.5);
                clears.record(&self.gpu.device, pass, &self.targets, &clear);
            });
        };
        if self.gpu.adapter.is_none() {
            self.pass(Some(before), |_| ());
            return clear(&mut clears, RECTS[0]);
        }
        self.pass(Some(&before.cleared_by(cleared)), |_| ());
        let inside = self.read();
        self.pass(Some(before), |_| ());
        let outside = self.read();
        for rect in RECTS {
            self.pass(Some(before), |_| ());
            clear(&mut clears, rect);
            let expected = inside.iter().zip(&outside).map(|(inside, outside)| mix(rect, inside, outside));
            assert_eq!(self.read(), expected.collect::<Vec<_>>(), "{:?} in {rect:?}", self.targets);
        }
    }
}

/// Combines the texels of one image inside a rectangle with those of another outside.
fn mix(rect: Rect, inside: &[Vec<u8>], outside: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let is_inside = |index: usize| {
        let (x, y) = (index as u32 % SIDE, index as u32 / SIDE);
        (rect.x..rect.x + rect.width).contains(&x) && (rect.y..rect.y + rect.height).contains(&y)
    };
    let texels = inside.iter().zip(outside).enumerate();
    texels.map(|(index, (a, b))| if is_inside(index) { a } else { b }.clone()).collect()
}

fn color_attachment<'v>(
    view: &'v wgpu::TextureView,
    resolve_target: Option<&'v wgpu::TextureView>,
    value: Option<[f64; 4]>,
) -> wgpu::RenderPassColorAttachment<'v> {
    let ops = ops(value.map(|[r, g, b, a]| wgpu::Color { r, g, b, a }));
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops }
}

fn depth_attachment<'v>(
    view: &'v wgpu::TextureView,
    values: Option<&Values>,
    read_only: bool,
) -> wgpu::RenderPassDepthStencilAttachment<'v> {
    let format = view.texture().format();
    let depth = format.has_depth_aspect() && !read_only;
    let stencil = format.has_stencil_aspect() && !read_only;
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: depth.then(|| ops(values.map(|values| values.depth.unwrap_or_default()))),
        stencil_ops: stencil.then(|| ops(values.map(|values| values.stencil.unwrap_or_default()))),
    }
}

/// Returns operations that clear to a value or load.
fn ops<V>(value: Option<V>) -> wgpu::Operations<V> {
    let load = value.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear);
    wgpu::Operations { load, store: wgpu::StoreOp::Store }
}
