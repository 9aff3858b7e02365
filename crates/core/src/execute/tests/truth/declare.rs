//! Declares a graph as a frame.

use super::gpu::{Gpu, Imports, Params, Tokens};
use super::graph::{Graph, Inputs, Pass, Plane, Role, Span, Target};
use crate::builder::ShaderPass;
use crate::{
    Bind, Buffer, BufferDesc, BufferExport, Format, Frame, Rect, Resize, Texture, TextureDesc, TextureExport,
};

/// The exports of the frame, by index in the graph.
pub(super) struct Exports {
    pub(super) textures: Vec<(usize, TextureExport)>,
    pub(super) buffers: Vec<(usize, BufferExport)>,
}

/// Declares all passes of a graph and exports what it says.
pub(super) fn declare<'f>(
    frame: &mut Frame<'f>,
    graph: &Graph,
    gpu: &'f Gpu,
    imports: &Imports,
    salt: u32,
) -> Exports {
    let mut declarer = Declarer::new(frame, graph, gpu, imports, salt);
    for (index, pass) in graph.passes.iter().enumerate() {
        declarer.pass(index, pass);
    }
    declarer.exports()
}

struct Declarer<'d, 'f> {
    frame: &'d mut Frame<'f>,
    graph: &'d Graph,
    gpu: &'f Gpu,
    salt: u32,
    textures: Vec<Texture>,
    /// An upload exists once it has been declared.
    buffers: Vec<Option<Buffer>>,
}

impl<'d, 'f> Declarer<'d, 'f> {
    fn new(frame: &'d mut Frame<'f>, graph: &'d Graph, gpu: &'f Gpu, imports: &Imports, salt: u32) -> Self {
        let mut textures: Vec<Texture> = Vec::new();
        for (index, own) in graph.textures.iter().enumerate() {
            let (width, height) = own.size;
            let desc = TextureDesc::d2(width, height, Format::R32Uint).layers(own.layers);
            let desc = TextureDesc { mip_levels: own.mips, ..desc };
            match (own.role, &imports.textures[index]) {
                (Role::Imported(defined), Some(texture)) => {
                    textures.push(frame.import_texture(format_args!("t{index}"), texture, defined));
                }
                (Role::Previous(history), _) => {
                    let name = format_args!("h{history} of {}", graph.seed);
                    let history = frame.history(name, desc, Resize::Reset);
                    textures.extend([history.previous, history.current]);
                }
                (Role::Current(_), _) => {}
                _ => textures.push(frame.create_texture(format_args!("t{index}"), desc)),
            }
        }
        let buffers = graph.buffers.iter().enumerate().map(|(index, own)| {
            let name = format_args!("b{index}");
            match (own.role, &imports.buffers[index]) {
                (Role::Uploaded, _) => None,
                (Role::Imported(defined), Some(buffer)) => Some(frame.import_buffer(name, buffer, defined)),
                _ => Some(frame.create_buffer(name, BufferDesc::new(u64::from(own.words) * 4))),
            }
        });
        let buffers = buffers.collect();
        Self { frame, graph, gpu, salt, textures, buffers }
    }

    fn pass(&mut self, index: usize, pass: &Pass) {
        match pass {
            Pass::Draw { inputs, targets, area, words, keep } => {
                self.draw(index, inputs, targets, (*area, *words, *keep));
            }
            Pass::Words { inputs, span, preserve } => self.words(index, inputs, *span, *preserve),
            Pass::Texels { inputs, plane, rect, preserve } => {
                self.texels(index, inputs, (*plane, *rect), *preserve)
            }
            Pass::Upload { buffer, words } => {
                let bytes: Vec<u8> = words.iter().flat_map(|word| (word ^ self.salt).to_le_bytes()).collect();
                self.buffers[*buffer] = Some(self.frame.upload_buffer(format_args!("b{buffer}"), bytes));
            }
            Pass::CopyTexture { .. } | Pass::CopyBuffer { .. } | Pass::Rows { .. } => self.copy(index, pass),
        }
    }

    fn draw(
        &mut self,
        index: usize,
        inputs: &Inputs,
        targets: &[Target],
        (area, words, keep): (Rect, Option<(Span, bool)>, bool),
    ) {
        let whole = self.graph.whole(targets[0].plane);
        let preserve = words.is_some_and(|(_, preserve)| preserve);
        let params = Params { preserve, stride: whole.width, ..Default::default() };
        let params = self.frame.uniform(&params.bytes(inputs, self.salt));
        let mut pass = self.frame.render_pass(format_args!("p{index} draw"));
        let tokens = tokens(&mut pass, params, inputs, &self.textures, &self.buffers);
        for target in targets {
            let part = target.plane.part_in(target.rect);
            pass.subresource(part).color(&mut self.textures[target.plane.texture], target.contents.into());
        }
        let written = words.and_then(|(span, preserve)| {
            let buffer = self.buffers[span.buffer].as_mut()?;
            Some(pass.subresource(span.part()).storage_buffer_mut(buffer, preserved(preserve)))
        });
        if keep {
            pass.keep();
        }
        // The graph sets the scissor to the tile, or to all.
        let declared = targets.iter().find_map(|target| target.rect).unwrap_or(whole);
        let scissor = Some(area).filter(|&area| area != declared);
        let (gpu, two) = (self.gpu, targets.len() == 2);
        pass.body(move |ctx| {
            let draw = match written {
                _ if two => &gpu.two_targets,
                Some(_) => &gpu.target_and_words,
                None => &gpu.one_target,
            };
            let group = gpu.group(ctx, &draw.layout, &tokens, written.map(Bind::Buffer))?;
            draw.record(&mut ctx.pass, &group, scissor);
            Ok(())
        });
    }

    fn words(&mut self, index: usize, inputs: &Inputs, span: Span, preserve: bool) {
        let params = Params { preserve, ..Default::default() };
        let params = self.frame.uniform(&params.bytes(inputs, self.salt));
        let mut pass = self.frame.compute_pass(format_args!("p{index} words"));
        let tokens = tokens(&mut pass, params, inputs, &self.textures, &self.buffers);
        let Some(buffer) = self.buffers[span.buffer].as_mut() else { return };
        let written = pass.subresource(span.part()).storage_buffer_mut(buffer, preserved(preserve));
        let gpu = self.gpu;
        pass.body(move |ctx| {
            let group = gpu.group(ctx, &gpu.words.layout, &tokens, Some(Bind::Buffer(written)))?;
            ctx.pass.set_pipeline(&gpu.words.pipeline);
            ctx.pass.set_bind_group(0, &group, &[]);
            ctx.pass.dispatch_workgroups((span.end - span.start) / 64, 1, 1);
            Ok(())
        });
    }

    fn texels(
        &mut self,
        index: usize,
        inputs: &Inputs,
        (plane, rect): (Plane, Option<Rect>),
        preserve: bool,
    ) {
        let whole = self.graph.whole(plane);
        let Rect { x, y, width, height } = rect.unwrap_or(whole);
        let params = Params { preserve, origin: (x, y), size: (width, height), ..Default::default() };
        let params = self.frame.uniform(&params.bytes(inputs, self.salt));
        let mut pass = self.frame.compute_pass(format_args!("p{index} texels"));
        let tokens = tokens(&mut pass, params, inputs, &self.textures, &self.buffers);
        let part = plane.part_in(rect);
        let target = &mut self.textures[plane.texture];
        let written = pass.subresource(part).storage_texture_mut(target, preserved(preserve));
        let gpu = self.gpu;
        pass.body(move |ctx| {
            let group = gpu.group(ctx, &gpu.texels.layout, &tokens, Some(Bind::Texture(written)))?;
            ctx.pass.set_pipeline(&gpu.texels.pipeline);
            ctx.pass.set_bind_group(0, &group, &[]);
            ctx.pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
            Ok(())
        });
    }

    fn copy(&mut self, index: usize, pass: &Pass) {
        match *pass {
            Pass::CopyTexture { from, from_rect, to, to_rect } => {
                let source = self.textures[from.texture].clone();
                let (from, part) = (from.part().rect(from_rect), to.part().rect(to_rect));
                let target = &mut self.textures[to.texture];
                let mut pass = self.frame.copy_pass(format_args!("p{index} copy"));
                pass.texture_region(&source, from, target, part);
            }
            Pass::CopyBuffer { from, to, raw } => {
                let Some(source) = self.buffers[from.buffer].clone() else { return };
                let Some(target) = self.buffers[to.buffer].as_mut() else { return };
                if !raw {
                    let mut pass = self.frame.copy_pass(format_args!("p{index} copy"));
                    pass.buffer_range(&source, from.part(), target, to.part());
                    return;
                }
                let mut pass = self.frame.encoder_pass(format_args!("p{index} raw copy"));
                let source = pass.subresource(from.part()).copy_source_buffer(&source);
                let target =
                    pass.subresource(to.part()).copy_target_buffer(target, crate::Contents::Overwrite);
                pass.body(move |ctx| {
                    let (source, target) = (ctx.buffer(source)?, ctx.buffer(target)?);
                    let at = |span: Span| u64::from(span.start) * 4;
                    let size = at(Span { start: from.end, ..from }) - at(from);
                    ctx.encoder.copy_buffer_to_buffer(source, at(from), target, at(to), size);
                    Ok(())
                });
            }
            Pass::Rows { from, to } => {
                let source = self.textures[from.texture].clone();
                let Some(target) = self.buffers[to].as_mut() else { return };
                self.frame.copy_pass(format_args!("p{index} rows")).texture_to_buffer(&source, target);
            }
            _ => {}
        }
    }

    fn exports(self) -> Exports {
        let mut exports = Exports { textures: Vec::new(), buffers: Vec::new() };
        for (index, texture) in self.textures.iter().enumerate() {
            if self.graph.textures[index].exported {
                exports.textures.push((index, self.frame.export_texture(texture)));
            }
        }
        for (index, buffer) in self.buffers.iter().enumerate() {
            if let (Some(buffer), true) = (buffer, self.graph.buffers[index].exported) {
                exports.buffers.push((index, self.frame.export_buffer(buffer)));
            }
        }
        exports
    }
}

fn preserved(preserve: bool) -> crate::Contents {
    if preserve { crate::Contents::Preserve } else { crate::Contents::Overwrite }
}

/// Declares what a pass reads.
fn tokens<K: ShaderPass>(
    pass: &mut crate::Pass<'_, '_, K>,
    params: crate::Uniform,
    inputs: &Inputs,
    textures: &[Texture],
    buffers: &[Option<Buffer>],
) -> Tokens {
    let plane = |(plane, _): &(Plane, u32)| pass.subresource(plane.part()).sample(&textures[plane.texture]);
    let textures = inputs.planes.iter().map(plane).collect();
    let span = |(span, _): &(Span, u32)| {
        Some(pass.subresource(span.part()).storage_buffer(buffers[span.buffer].as_ref()?))
    };
    let buffers = inputs.spans.iter().filter_map(span).collect();
    Tokens { params, textures, buffers }
}
