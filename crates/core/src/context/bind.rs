//! Bind groups from tokens.

use super::Resources;
use super::entry_keys::{entry_key, matches};
use crate::error::Error;
use crate::handle::{Bind, TextureToken};
use crate::pipeline::ProgrammableStage;
use crate::pool::{BoundResource, Caches, EntryKey, GroupKey, ViewUsage};
use crate::subresource::Subresource;
use arrayvec::ArrayVec;
use std::borrow::Borrow;
use std::num::NonZeroU64;
use std::ops::Range;

/// Entries that fit without allocating; most groups have fewer.
const INLINE_ENTRIES: usize = 8;

impl Resources<'_> {
    /// Returns a bind group of `layout` with `entries` at bindings 0, 1, 2 and so on.
    ///
    /// Groups are cached by the physical objects that they bind: calling this every frame costs a look-up, and a new group
    /// is created only when an object has changed.
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
    ///     let scene = pass.sample(scene); // a token: the body captures it in place of the handle
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

    /// Returns a bind group for a shader; entries that do not match it are an error of the shader.
    pub(crate) fn checked_group<'e>(
        &'e self,
        layout: &wgpu::BindGroupLayout,
        entries: impl ExactSizeIterator<Item = Bind<'e>> + Clone,
        stage: &ProgrammableStage,
    ) -> Result<wgpu::BindGroup, Error> {
        self.group(layout, entries, Some(stage))
    }

    fn group<'e>(
        &'e self,
        layout: &wgpu::BindGroupLayout,
        entries: impl ExactSizeIterator<Item: Borrow<Bind<'e>>> + Clone,
        stage: Option<&ProgrammableStage>,
    ) -> Result<wgpu::BindGroup, Error> {
        let pass_groups = self.recording.resolved.pass_groups.as_ref();
        let same = |keys: &[EntryKey]| {
            keys.len() == entries.len()
                && keys.iter().zip(entries.clone()).all(|(key, entry)| matches(key, self, entry.borrow()))
        };
        if let Some(group) = pass_groups.and_then(|groups| groups.find(self.pass, layout, same)) {
            return Ok(group.clone());
        }
        let (key, group) = if entries.len() > INLINE_ENTRIES {
            let bound = entries.clone().map(|entry| self.bound(entry.borrow()));
            self.find_group(layout, &bound.collect::<Result<Vec<_>, _>>()?, stage)?
        } else {
            let mut bound = ArrayVec::<BoundResource<'_>, INLINE_ENTRIES>::new();
            for entry in entries.clone() {
                bound.push(self.bound(entry.borrow())?);
            }
            self.find_group(layout, &bound, stage)?
        };
        if let Some(groups) = pass_groups {
            let keys = || entries.map(|entry| entry_key(self, entry.borrow())).collect();
            groups.insert(self.pass, layout, keys, (key, &group));
        }
        Ok(group)
    }

    fn find_group(
        &self,
        layout: &wgpu::BindGroupLayout,
        bound: &[BoundResource<'_>],
        stage: Option<&ProgrammableStage>,
    ) -> Result<(GroupKey, wgpu::BindGroup), Error> {
        let mut caches = self.caches();
        let Caches { views, bind_groups, .. } = &mut *caches;
        bind_groups.get_or_create(layout, bound, || {
            let views: Vec<_> = bound
                .iter()
                .map(|bound| match *bound {
                    BoundResource::Texture(texture, part, usage) => Some(views.get(texture, part, usage)),
                    _ => None,
                })
                .collect();
            let create = || create(self.device(), layout, bound, &views);
            let Some(stage) = stage else { return Ok(create()) };
            let prefix = format!(
                "the bindings of pass {} must be exactly those that the shader uses in group 0, in order: ",
                self.pass_name()
            );
            stage.checked(self.device(), &prefix, create)
        })
    }

    fn bound<'e>(&'e self, entry: &Bind<'e>) -> Result<BoundResource<'e>, Error> {
        Ok(match entry {
            Bind::Texture(token) => self.bound_texture(*token, ViewUsage::Binding)?,
            Bind::TextureArray(token) => self.bound_texture(*token, ViewUsage::ArrayBinding)?,
            Bind::Buffer(token) => {
                let buffer = self.buffer(*token)?;
                // The physical buffer may be larger than what was declared.
                let Range { start, end } = self.byte_range(token.0);
                BoundResource::Buffer(buffer, start, NonZeroU64::new(end - start))
            }
            Bind::BufferRange(token, range) => {
                let size = NonZeroU64::new(range.end.saturating_sub(range.start));
                BoundResource::Buffer(self.buffer(*token)?, range.start, size)
            }
            Bind::Uniform(uniform) => {
                let buffer = self.uniforms(uniform)?;
                BoundResource::Buffer(buffer, uniform.start.into(), NonZeroU64::new(uniform.size.into()))
            }
            Bind::Sampler(sampler) => BoundResource::Sampler(sampler),
            Bind::ExternalView(view) => BoundResource::View(view),
            Bind::ExternalBuffer(buffer) => BoundResource::Buffer(buffer, 0, None),
        })
    }

    fn bound_texture(&self, token: TextureToken, usage: ViewUsage) -> Result<BoundResource<'_>, Error> {
        let part = Subresource { rect: None, ..self.part(token.0) };
        Ok(BoundResource::Texture(self.texture(token)?, part, usage))
    }
}

fn create(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    bound: &[BoundResource<'_>],
    views: &[Option<wgpu::TextureView>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = bound
        .iter()
        .zip(views)
        .enumerate()
        .filter_map(|(binding, (bound, cached_view))| {
            let resource = match *bound {
                BoundResource::Texture(..) => wgpu::BindingResource::TextureView(cached_view.as_ref()?),
                BoundResource::View(view) => wgpu::BindingResource::TextureView(view),
                BoundResource::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
                BoundResource::Buffer(buffer, offset, size) => {
                    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size })
                }
            };
            Some(wgpu::BindGroupEntry { binding: binding as u32, resource })
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}
