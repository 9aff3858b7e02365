//! Bind groups from tokens.

use super::context::Resources;
use crate::error::Error;
use crate::handle::{BufferToken, TextureToken, Uniform};
use crate::pool::{Bound, Caches, GroupKey, Purpose};
use crate::shader_pass::Program;
use arrayvec::ArrayVec;
use std::borrow::Borrow;
use std::num::NonZeroU64;
use std::ops::Range;

/// One entry of a bind group; its place in the list is its binding number.
pub enum Bind<'a> {
    /// The part of a texture that the access declares: one layer as 2D, several as a 2D array.
    Texture(TextureToken),
    /// The same as a 2D array, one layer too: for shaders that take any number of layers.
    TextureArray(TextureToken),
    /// The part of a buffer that the access declares.
    Buffer(BufferToken),
    /// This range of the buffer, in bytes; with a dynamic offset, the range at offset 0.
    BufferRange(BufferToken, Range<u64>),
    /// A uniform block of this frame.
    Uniform(Uniform),
    /// A sampler of yours.
    Sampler(&'a wgpu::Sampler),
    /// A view of yours that is not part of the graph.
    ExternalView(&'a wgpu::TextureView),
    /// A buffer of yours that is not part of the graph.
    ExternalBuffer(&'a wgpu::Buffer),
}

/// Entries of most groups fit in here, so that looking one up allocates nothing.
const INLINE: usize = 8;

impl Resources<'_> {
    /// Returns a bind group of `layout` with `entries` at bindings 0, 1, 2 and so on.
    ///
    /// Groups are cached by the physical objects that they bind: asking every frame costs a look-up, and a new one
    /// is made exactly when an object behind it is another.
    ///
    /// ```
    /// use shadowgraph_core::{Bind, Contents, Frame, Texture, wgpu};
    /// /// `layout` has a texture at binding 0 and a sampler at binding 1.
    /// fn blur<'f>(
    ///     frame: &mut Frame<'f>,
    ///     (pipeline, layout, sampler): (&'f wgpu::RenderPipeline, &'f wgpu::BindGroupLayout, &'f wgpu::Sampler),
    ///     scene: &Texture,
    ///     target: &mut Texture,
    /// ) {
    ///     let mut pass = frame.render_pass("blur");
    ///     let scene = pass.sample(scene); // a token: it goes into the body, the handle does not
    ///     pass.color(target, Contents::Overwrite);
    ///     pass.body(move |ctx| {
    ///         let group = ctx.bind_group(layout, &[Bind::Texture(scene), Bind::Sampler(sampler)])?;
    ///         ctx.pass.set_pipeline(pipeline);
    ///         ctx.pass.set_bind_group(0, &group, &[]);
    ///         ctx.pass.draw(0..3, 0..1);
    ///         Ok(())
    ///     });
    /// }
    /// ```
    ///
    /// # Errors
    /// [`Error::Undeclared`] if a token belongs to another pass.
    pub fn bind_group(
        &self,
        layout: &wgpu::BindGroupLayout,
        entries: &[Bind<'_>],
    ) -> Result<wgpu::BindGroup, Error> {
        self.group(layout, entries.iter(), None)
    }

    /// Returns a bind group for a program, whose error it is if the entries do not fit.
    pub(crate) fn checked_group<'e>(
        &'e self,
        layout: &wgpu::BindGroupLayout,
        entries: impl ExactSizeIterator<Item = Bind<'e>> + Clone,
        program: &Program,
    ) -> Result<wgpu::BindGroup, Error> {
        self.group(layout, entries, Some(program))
    }

    fn group<'e>(
        &'e self,
        layout: &wgpu::BindGroupLayout,
        entries: impl ExactSizeIterator<Item: Borrow<Bind<'e>>> + Clone,
        program: Option<&Program>,
    ) -> Result<wgpu::BindGroup, Error> {
        let last = self.recording.realised.last_groups.as_ref();
        if let Some(key) = last.and_then(|last| last.get(self, layout, entries.clone()))
            && let Some(group) = self.caches().bind_groups.again(key)
        {
            return Ok(group);
        }
        let (key, group) = if entries.len() > INLINE {
            let bound = entries.clone().map(|entry| self.bound(entry.borrow()));
            self.find_group(layout, &bound.collect::<Result<Vec<_>, _>>()?, program)?
        } else {
            let mut bound = ArrayVec::<Bound<'_>, INLINE>::new();
            for entry in entries.clone() {
                bound.push(self.bound(entry.borrow())?);
            }
            self.find_group(layout, &bound, program)?
        };
        if let Some(last) = last {
            last.keep(self, layout, entries, key);
        }
        Ok(group)
    }

    fn find_group(
        &self,
        layout: &wgpu::BindGroupLayout,
        bound: &[Bound<'_>],
        program: Option<&Program>,
    ) -> Result<(GroupKey, wgpu::BindGroup), Error> {
        let mut caches = self.caches();
        let Caches { views, bind_groups, .. } = &mut *caches;
        bind_groups.get(layout, bound, || {
            let views: Vec<_> = bound
                .iter()
                .map(|bound| match *bound {
                    Bound::Texture(texture, part, purpose) => Some(views.get(texture, part, purpose)),
                    _ => None,
                })
                .collect();
            let create = || create(self.device(), layout, bound, &views);
            let Some(program) = program else { return Ok(create()) };
            let place = format!(
                "what pass `{}` binds in group 0 must be exactly what the shader uses there, in order: ",
                self.recording.plan.pass_path(self.pass)
            );
            program.checked(self.device(), &place, create)
        })
    }

    fn bound<'e>(&'e self, entry: &Bind<'e>) -> Result<Bound<'e>, Error> {
        Ok(match entry {
            Bind::Texture(token) => self.bound_texture(*token, Purpose::Binding)?,
            Bind::TextureArray(token) => self.bound_texture(*token, Purpose::ArrayBinding)?,
            Bind::Buffer(token) => {
                let buffer = self.buffer(*token)?;
                // The physical buffer may be larger than what was declared.
                let Range { start, end } = self.byte_range(token.0);
                Bound::Buffer(buffer, start, NonZeroU64::new(end - start))
            }
            Bind::BufferRange(token, range) => {
                let size = NonZeroU64::new(range.end.saturating_sub(range.start));
                Bound::Buffer(self.buffer(*token)?, range.start, size)
            }
            Bind::Uniform(uniform) => {
                let buffer = self.uniforms(uniform)?;
                Bound::Buffer(buffer, uniform.start.into(), NonZeroU64::new(uniform.size.into()))
            }
            Bind::Sampler(sampler) => Bound::Sampler(sampler),
            Bind::ExternalView(view) => Bound::View(view),
            Bind::ExternalBuffer(buffer) => Bound::Buffer(buffer, 0, None),
        })
    }

    fn bound_texture(&self, token: TextureToken, purpose: Purpose) -> Result<Bound<'_>, Error> {
        let part = crate::Subresource { rect: None, ..self.part(token.0) };
        Ok(Bound::Texture(self.texture(token)?, part, purpose))
    }
}

fn create(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    bound: &[Bound<'_>],
    views: &[Option<wgpu::TextureView>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = bound
        .iter()
        .zip(views)
        .enumerate()
        .filter_map(|(binding, (bound, own_view))| {
            let resource = match *bound {
                Bound::Texture(..) => wgpu::BindingResource::TextureView(own_view.as_ref()?),
                Bound::View(view) => wgpu::BindingResource::TextureView(view),
                Bound::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
                Bound::Buffer(buffer, offset, size) => {
                    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size })
                }
            };
            Some(wgpu::BindGroupEntry { binding: binding as u32, resource })
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}
