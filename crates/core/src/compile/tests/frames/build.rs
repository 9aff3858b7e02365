//! Declares the frame of a spec with the builder.

use super::{AccessSpec, PassSpec, Spec};
use crate::{
    Access, Buffer, Compute, Contents, Encoding, Frame, Origin, Pass, PassId, PassKind, Rendering, Resize,
    ResourceDesc, ResourceId, ShaderPass, Texture,
};
use crate::{BufferUsages, TextureUsages};

pub(in super::super) enum Handle {
    Texture(Texture),
    Buffer(Buffer),
}

/// Ids of the builder for the items of a spec.
#[derive(Default)]
pub(in super::super) struct Names {
    pub(in super::super) handles: Vec<Option<Handle>>,
    passes: Vec<Option<PassId>>,
    /// Index in the spec of each id.
    resources: Vec<usize>,
}

impl Handle {
    pub(in super::super) fn id(&self) -> ResourceId {
        match self {
            Self::Texture(texture) => texture.id(),
            Self::Buffer(buffer) => buffer.id(),
        }
    }
}

impl Names {
    /// Returns the plan's id of a resource of the spec.
    pub(in super::super) fn id(&self, resource: usize) -> ResourceId {
        self.handles[resource].as_ref().map(Handle::id).unwrap_or_else(|| unreachable!("it is declared"))
    }

    /// Returns the index in the spec of a resource of the plan. Uploads create theirs late, so the numbers differ.
    pub(in super::super) fn resource(&self, id: ResourceId) -> usize {
        self.resources[id.index()]
    }
}

impl Spec {
    /// Declares the frame.
    pub(in super::super) fn build(&self) -> (Frame<'static>, Names) {
        let mut frame = Frame::new();
        let names = self.build_in(&mut frame);
        (frame, names)
    }

    /// Declares the frame in an empty frame.
    pub(in super::super) fn build_in(&self, frame: &mut Frame<'static>) -> Names {
        let mut names = Names::default();
        frame.set_options(self.options);
        for index in 0..self.resources.len() {
            names.declare_resource(frame, self, index);
        }
        for (index, pass) in self.passes.iter().enumerate() {
            names.pass(frame, self, index, pass.nodes);
        }
        for &export in &self.exports {
            match &names.handles[export] {
                Some(Handle::Texture(texture)) => {
                    let _export = frame.export_texture(texture);
                }
                Some(Handle::Buffer(buffer)) => {
                    let _export = frame.export_buffer(buffer);
                }
                None => {}
            }
        }
        let mut resources: Vec<usize> = (0..self.resources.len()).collect();
        resources.sort_by_key(|&resource| names.id(resource));
        names.resources = resources;
        names
    }
}

impl Names {
    fn declare_resource(&mut self, frame: &mut Frame<'static>, spec: &Spec, index: usize) {
        let (resource, name) = (spec.resources[index], format_args!("r{index}"));
        let handle = match (resource.origin, resource.desc) {
            _ if resource.uploaded => None,
            (Origin::Transient, ResourceDesc::Texture(desc)) => {
                Some(Handle::Texture(frame.create_texture(name, desc)))
            }
            (Origin::Transient, ResourceDesc::Buffer(desc)) => {
                Some(Handle::Buffer(frame.create_buffer(name, desc)))
            }
            (Origin::Imported { defined }, ResourceDesc::Texture(desc)) => {
                let usage = TextureUsages::all() - TextureUsages::TRANSIENT_ATTACHMENT;
                Some(Handle::Texture(frame.declare_import_texture(name, desc, usage, defined)))
            }
            (Origin::Imported { defined }, ResourceDesc::Buffer(desc)) => {
                let usage = BufferUsages::all();
                Some(Handle::Buffer(frame.declare_import_buffer(name, desc, usage, defined)))
            }
            (Origin::Previous { .. }, ResourceDesc::Texture(desc)) => {
                let history = frame.history(name, desc, Resize::Reset);
                self.handles.push(Some(Handle::Texture(history.previous)));
                Some(Handle::Texture(history.current))
            }
            // Created with its `Previous`.
            (Origin::Current { .. }, _) => return,
            (Origin::Previous { .. }, ResourceDesc::Buffer(_)) => unreachable!("histories are textures"),
        };
        self.handles.push(handle);
    }

    /// Declares a pass, with this many nodes around it.
    fn pass(&mut self, frame: &mut Frame<'static>, spec: &Spec, index: usize, nodes: usize) {
        if nodes > 0 {
            return frame.node(format_args!("n{index}"), |frame| self.pass(frame, spec, index, nodes - 1));
        }
        let pass = &spec.passes[index];
        if let (true, [access]) = (pass.uploads(), &pass.accesses[..]) {
            let bytes = vec![0; spec.desc(access.resource).bytes() as usize];
            let buffer = frame.upload_buffer(format_args!("p{index}"), bytes);
            self.handles[access.resource] = Some(Handle::Buffer(buffer));
            self.passes.push(None);
            return;
        }
        self.declare(frame, index, pass);
    }

    fn declare(&mut self, frame: &mut Frame<'static>, index: usize, pass: &PassSpec) {
        let name = format_args!("p{index}");
        let Self { handles, passes, .. } = self;
        let after: Vec<PassId> = pass.after.iter().filter_map(|&other| passes[other]).collect();
        let id = match pass.kind {
            PassKind::Render => {
                let mut declared = frame.render_pass(name);
                pass.accesses.iter().for_each(|access| render(&mut declared, access, handles));
                finish(declared, pass, &after)
            }
            PassKind::Compute => {
                let mut declared = frame.compute_pass(name);
                pass.accesses.iter().for_each(|access| compute(&mut declared, access, handles));
                finish(declared, pass, &after)
            }
            PassKind::Encoder => {
                let mut declared = frame.encoder_pass(name);
                pass.accesses.iter().for_each(|access| encode(&mut declared, access, handles));
                finish(declared, pass, &after)
            }
            PassKind::Copy => {
                let mut declared = frame.copy_pass(name);
                for ends in pass.accesses.chunks_exact(2) {
                    copy(&mut declared, ends[0], ends[1], handles);
                }
                finish(declared, pass, &after)
            }
        };
        passes.push(Some(id));
    }
}

fn finish<K>(mut declared: Pass<'_, 'static, K>, pass: &PassSpec, after: &[PassId]) -> PassId {
    if pass.keep {
        declared.keep();
    }
    after.iter().for_each(|&other| declared.after(other));
    declared.id()
}

fn texture(handles: &mut [Option<Handle>], resource: usize) -> &mut Texture {
    match &mut handles[resource] {
        Some(Handle::Texture(texture)) => texture,
        _ => unreachable!("resource {resource} is a texture by now"),
    }
}

fn buffer(handles: &mut [Option<Handle>], resource: usize) -> &mut Buffer {
    match &mut handles[resource] {
        Some(Handle::Buffer(buffer)) => buffer,
        _ => unreachable!("resource {resource} is a buffer by now"),
    }
}

fn render(pass: &mut Pass<'_, 'static, Rendering>, access: &AccessSpec, handles: &mut [Option<Handle>]) {
    let contents = access.contents.unwrap_or(Contents::Overwrite);
    pass.subresource(access.subresource.to_subresource());
    match access.access {
        Access::Color(_) => {
            let _token = pass.color(texture(handles, access.resource), contents);
        }
        Access::Resolve(_) => {
            let _token = pass.resolve(texture(handles, access.resource));
        }
        Access::Depth => {
            let _token = pass.depth(texture(handles, access.resource), contents);
        }
        Access::DepthRead => {
            let _token = pass.depth_read(texture(handles, access.resource));
        }
        Access::Vertex => {
            let _token = pass.vertex_buffer(buffer(handles, access.resource));
        }
        Access::Index => {
            let _token = pass.index_buffer(buffer(handles, access.resource));
        }
        _ => shade(pass, access, handles),
    }
}

fn compute(pass: &mut Pass<'_, 'static, Compute>, access: &AccessSpec, handles: &mut [Option<Handle>]) {
    pass.subresource(access.subresource.to_subresource());
    shade(pass, access, handles);
}

fn encode(pass: &mut Pass<'_, 'static, Encoding>, access: &AccessSpec, handles: &mut [Option<Handle>]) {
    let contents = access.contents.unwrap_or(Contents::Overwrite);
    pass.subresource(access.subresource.to_subresource());
    let of_texture = matches!(handles[access.resource], Some(Handle::Texture(_)));
    match (access.access, of_texture) {
        (Access::CopySource, true) => {
            let _token = pass.copy_source(texture(handles, access.resource));
        }
        (Access::CopySource, false) => {
            let _token = pass.copy_source_buffer(buffer(handles, access.resource));
        }
        (Access::CopyTarget, true) => {
            let _token = pass.copy_target(texture(handles, access.resource), contents);
        }
        (Access::CopyTarget, false) => {
            let _token = pass.copy_target_buffer(buffer(handles, access.resource), contents);
        }
        (Access::Color(_), _) => {
            let _token = pass.attachment(texture(handles, access.resource), contents);
        }
        _ => shade(pass, access, handles),
    }
}

/// Declares the accesses of a shader.
fn shade<K: ShaderPass>(
    pass: &mut Pass<'_, 'static, K>,
    access: &AccessSpec,
    handles: &mut [Option<Handle>],
) {
    let contents = access.contents.unwrap_or(Contents::Overwrite);
    let of_texture = matches!(handles[access.resource], Some(Handle::Texture(_)));
    match (access.access, of_texture) {
        (Access::Sampled, _) => {
            let _token = pass.sample(texture(handles, access.resource));
        }
        (Access::StorageRead, true) => {
            let _token = pass.storage_texture(texture(handles, access.resource));
        }
        (Access::StorageRead, false) => {
            let _token = pass.storage_buffer(buffer(handles, access.resource));
        }
        (Access::StorageWrite, true) => {
            let _token = pass.storage_texture_mut(texture(handles, access.resource), contents);
        }
        (Access::StorageWrite, false) => {
            let _token = pass.storage_buffer_mut(buffer(handles, access.resource), contents);
        }
        (Access::Uniform, _) => {
            let _token = pass.uniform_buffer(buffer(handles, access.resource));
        }
        (Access::Indirect, _) => {
            let _token = pass.indirect_buffer(buffer(handles, access.resource));
        }
        (other, _) => unreachable!("{other:?} is not for this kind of pass"),
    }
}

/// Declares one copy.
fn copy(
    pass: &mut Pass<'_, 'static, crate::Copying>,
    from: AccessSpec,
    to: AccessSpec,
    handles: &mut [Option<Handle>],
) {
    let (source_part, target_part) = (from.subresource.to_subresource(), to.subresource.to_subresource());
    let source = match &handles[from.resource] {
        Some(Handle::Texture(texture)) => Handle::Texture(texture.clone()),
        Some(Handle::Buffer(buffer)) => Handle::Buffer(buffer.clone()),
        None => unreachable!("the source is declared"),
    };
    match (source, &mut handles[to.resource]) {
        (Handle::Texture(source), Some(Handle::Texture(target))) => {
            let _token = pass.texture_region(&source, source_part, target, target_part);
        }
        (Handle::Buffer(source), Some(Handle::Buffer(target))) => {
            let _token = pass.buffer_range(&source, source_part, target, target_part);
        }
        (Handle::Texture(source), Some(Handle::Buffer(target))) => {
            let _token = pass.texture_to_buffer(&source, target);
        }
        _ => unreachable!("there is no such copy"),
    }
}
