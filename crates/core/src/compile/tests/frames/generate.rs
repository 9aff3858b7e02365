//! Random frames from bytes, as a fuzzer gives them.
//!
//! Frames are valid by construction, but for a few accesses to contents that may be undefined: what is
//! defined is tracked cell by cell.

use super::cells::{Cell, Cells, cells_of};
use super::resources::{COLORS, DEPTHS};
use super::{AccessSpec, PassSpec, ResourceSpec, Source, Spec, SubresourceSpec};
use crate::{Access, Contents, Format, Options, OrderPolicy, Origin, PassKind, ResourceDesc};

/// Generates a frame of up to 20 passes.
pub(in super::super) fn frame_from_bytes(bytes: &[u8]) -> Spec {
    Generator::new(bytes, true).frame(20)
}

/// Generates a valid frame of up to `passes` passes.
pub(in super::super) fn small_frame_from_bytes(bytes: &[u8], passes: usize) -> Spec {
    Generator::new(bytes, false).frame(passes)
}

/// A frame being generated, and the state of its contents.
pub(super) struct Generator<'b> {
    pub(super) source: Source<'b>,
    pub(super) spec: Spec,
    /// Whether accesses may read undefined contents.
    wild: bool,
    /// Defined cells of each resource.
    pub(super) cells: Vec<Vec<Cell>>,
    pub(super) defined: Vec<Cells>,
    /// Sizes of most textures of the frame.
    pub(super) sizes: [(u32, u32); 2],
    /// Formats of its textures: colour, then depth. Few, so that textures can share slots.
    pub(super) formats: [[Format; 2]; 2],
    /// The current pass, and what it has used.
    pub(super) pass: PassSpec,
    touched: Vec<Touched>,
}

/// The accesses of a pass so far.
struct Touched {
    resource: usize,
    /// Parts that wgpu tracks together with it, for another attachment and for other accesses.
    extents: [Cells; 2],
    written: bool,
    attached: bool,
}

impl<'b> Generator<'b> {
    fn new(bytes: &'b [u8], wild: bool) -> Self {
        let mut source = Source::new(bytes);
        let mut size = || (1 + source.below(6) as u32, 1 + source.below(6) as u32);
        let sizes = [size(), size()];
        let mut format = |formats| source.pick(formats);
        let formats = [[format(&COLORS), format(&COLORS)], [format(&DEPTHS), format(&DEPTHS)]];
        let order = match source.below(8) {
            0..5 => OrderPolicy::Automatic,
            5..7 => OrderPolicy::Memory,
            _ => OrderPolicy::Declared,
        };
        let (merge, transient_attachments) = (!source.chance(32), !source.chance(32));
        let options = Options { order, merge, transient_attachments };
        Self {
            source,
            spec: Spec { options, ..Spec::default() },
            wild,
            cells: Vec::new(),
            defined: Vec::new(),
            sizes,
            formats,
            pass: PassSpec::new(PassKind::Render),
            touched: Vec::new(),
        }
    }

    fn frame(mut self, most: usize) -> Spec {
        let passes = 1 + self.source.below(most).max(self.source.below(most));
        while self.spec.passes.len() < passes && !self.source.is_empty() {
            self.any_pass();
        }
        self.finish_histories();
        self.export();
        self.spec
    }

    fn any_pass(&mut self) {
        match self.source.below(16) {
            0..8 => self.render_pass(),
            8..12 => self.compute_pass(),
            12 | 13 => self.encoder_pass(),
            14 => self.copy_pass(),
            _ => self.upload(),
        }
    }

    pub(super) fn begin(&mut self, kind: PassKind) {
        self.pass = PassSpec::new(kind);
        self.touched.clear();
    }

    /// Adds the pass to the frame, unless it is empty.
    pub(super) fn end(&mut self) {
        let mut pass = std::mem::replace(&mut self.pass, PassSpec::new(PassKind::Render));
        if pass.accesses.is_empty() {
            return;
        }
        if self.source.chance(12) {
            pass.nodes = 1 + self.source.below(2);
        }
        if !pass.uploads() {
            pass.keep = self.source.chance(20);
            self.order_by_name(&mut pass);
        }
        for access in pass.accesses.iter().filter(|access| access.writes()) {
            let written = access.subresource.cells(&self.cells[access.resource]);
            self.defined[access.resource] = self.defined[access.resource].union(&written);
        }
        self.spec.passes.push(pass);
    }

    fn order_by_name(&mut self, pass: &mut PassSpec) {
        while !self.spec.passes.is_empty() && self.source.chance(16) {
            let other = self.source.below(self.spec.passes.len());
            if !self.spec.passes[other].uploads() && !pass.after.contains(&other) {
                pass.after.push(other);
            }
        }
    }

    /// Returns the part of a resource that a pass of this kind cannot use in two ways: wgpu does not track tiles or bytes
    /// within one pass, and slices of a volume only as attachments.
    fn extents(&self, resource: usize, subresource: SubresourceSpec) -> [Cells; 2] {
        let [with_attachments, with_others] = match (self.pass.kind, self.spec.desc(resource)) {
            (PassKind::Copy | PassKind::Encoder, _) => [subresource; 2],
            (_, ResourceDesc::Texture(desc)) => [subresource.subresources(), subresource.tracked(desc)],
            (_, ResourceDesc::Buffer(_)) => [SubresourceSpec::default(); 2],
        };
        let cells = &self.cells[resource];
        [with_attachments.cells(cells), with_others.cells(cells)]
    }

    /// Returns whether the pass may use a part in addition to its other accesses.
    pub(super) fn is_free(
        &self,
        resource: usize,
        subresource: SubresourceSpec,
        writes: bool,
        attaches: bool,
    ) -> bool {
        let extents = self.extents(resource, subresource);
        let clash = |other: &Touched| {
            let own = usize::from(!(attaches && other.attached));
            other.resource == resource
                && (writes || other.written)
                && other.extents[own].overlaps(&extents[own])
        };
        !self.touched.iter().any(clash)
    }

    pub(super) fn is_defined(&mut self, resource: usize, subresource: SubresourceSpec) -> bool {
        let cells = subresource.cells(&self.cells[resource]);
        self.defined[resource].covers(&cells) || self.wild && self.source.chance(1)
    }

    /// Adds an access to the pass.
    pub(super) fn touch(
        &mut self,
        resource: usize,
        access: Access,
        contents: Option<Contents>,
        subresource: SubresourceSpec,
    ) {
        let own = AccessSpec { resource, access, contents, subresource };
        let (written, attached) = (own.writes(), own.access.is_attachment());
        let extents = self.extents(resource, subresource);
        self.touched.push(Touched { resource, extents, written, attached });
        self.pass.accesses.push(own);
    }

    pub(super) fn add_resource(&mut self, desc: ResourceDesc, origin: Origin) -> usize {
        let cells = cells_of(&desc);
        let filled = matches!(origin, Origin::Imported { defined: true } | Origin::Previous { .. });
        self.defined.push(if filled { Cells::first(cells.len()) } else { Cells::default() });
        self.cells.push(cells);
        self.spec.resources.push(ResourceSpec { desc, origin, uploaded: false });
        self.spec.resources.len() - 1
    }

    /// Writes what is still undefined of the histories.
    fn finish_histories(&mut self) {
        for resource in 0..self.spec.resources.len() {
            let whole = Cells::first(self.cells[resource].len());
            let current = matches!(self.spec.resources[resource].origin, Origin::Current { .. });
            if current && !self.defined[resource].covers(&whole) {
                self.begin(PassKind::Encoder);
                self.touch(
                    resource,
                    Access::CopyTarget,
                    Some(Contents::Overwrite),
                    SubresourceSpec::default(),
                );
                self.end();
            }
        }
    }

    /// Exports a few resources, most often one at least.
    fn export(&mut self) {
        let is_whole = |resource: &usize| {
            let whole = Cells::first(self.cells[*resource].len());
            self.defined[*resource].covers(&whole)
                && self.spec.resources[*resource].written(&self.spec, *resource)
        };
        let whole: Vec<usize> = (0..self.spec.resources.len()).filter(is_whole).collect();
        let Some(&last) = whole.last() else { return };
        if !self.source.chance(16) {
            self.spec.exports.push(last);
        }
        while self.source.chance(144) {
            let resource = self.source.pick(&whole);
            if !self.spec.exports.contains(&resource) {
                self.spec.exports.push(resource);
            }
        }
    }
}

impl ResourceSpec {
    fn written(&self, spec: &Spec, resource: usize) -> bool {
        let mut accesses = spec.passes.iter().flat_map(|pass| &pass.accesses);
        accesses.any(|access| access.resource == resource && access.writes())
    }
}
