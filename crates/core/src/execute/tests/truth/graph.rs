//! Small graphs as plain data.

use crate::{Rect, Subresource};

/// One mip of one layer of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plane {
    pub(super) texture: usize,
    pub(super) mip: u32,
    pub(super) layer: u32,
}

impl Plane {
    pub(super) fn part(self) -> Subresource {
        Subresource::FULL.mip(self.mip).layer(self.layer)
    }

    /// The part of a rectangle of it, or of all of it.
    pub(super) fn part_in(self, rect: Option<Rect>) -> Subresource {
        rect.map_or(self.part(), |rect| self.part().rect(rect))
    }
}

/// Some words of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) buffer: usize,
    pub(super) start: u32,
    pub(super) end: u32,
}

impl Span {
    pub(super) fn part(self) -> Subresource {
        Subresource::FULL.bytes(u64::from(self.start) * 4..u64::from(self.end) * 4)
    }

    pub(super) fn words(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// The origin of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Transient,
    /// Created by the caller; `true` if its contents are defined.
    Imported(bool),
    /// Last frame's contents of the history with that index.
    Previous(usize),
    Current(usize),
    /// A buffer that is first filled from the CPU.
    Uploaded,
}

#[derive(Clone, Debug)]
pub(super) struct Texture {
    pub(super) role: Role,
    /// Width and height in texels.
    pub(super) size: (u32, u32),
    pub(super) mips: u32,
    pub(super) layers: u32,
    pub(super) exported: bool,
}

impl Texture {
    pub(super) fn plane_size(&self, mip: u32) -> (u32, u32) {
        (self.size.0 >> mip, self.size.1 >> mip)
    }
}

#[derive(Clone, Debug)]
pub(super) struct Buffer {
    pub(super) role: Role,
    pub(super) words: u32,
    pub(super) exported: bool,
}

/// The inputs of a value: a constant, and values read at and around its position.
#[derive(Clone, Debug)]
pub(super) struct Inputs {
    pub(super) constant: u32,
    pub(super) planes: Vec<(Plane, u32)>,
    pub(super) spans: Vec<(Span, u32)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Contents {
    Clear(u32),
    Overwrite,
    Preserve,
}

impl From<Contents> for crate::Contents {
    fn from(contents: Contents) -> Self {
        match contents {
            Contents::Clear(value) => Self::clear_color([f64::from(value), 0.0, 0.0, 0.0]),
            Contents::Overwrite => Self::Overwrite,
            Contents::Preserve => Self::Preserve,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) plane: Plane,
    pub(super) contents: Contents,
    /// The declared rectangle.
    pub(super) rect: Option<Rect>,
}

#[derive(Clone, Debug)]
pub(super) enum Pass {
    Draw {
        inputs: Inputs,
        targets: Vec<Target>,
        /// Region that it draws: everything, its tile, or less than that.
        area: Rect,
        /// Words written besides the texels, and whether the old contents are mixed in.
        words: Option<(Span, bool)>,
        keep: bool,
    },
    Words {
        inputs: Inputs,
        span: Span,
        preserve: bool,
    },
    Texels {
        inputs: Inputs,
        plane: Plane,
        rect: Option<Rect>,
        preserve: bool,
    },
    CopyTexture {
        from: Plane,
        from_rect: Rect,
        to: Plane,
        to_rect: Rect,
    },
    CopyBuffer {
        from: Span,
        to: Span,
        raw: bool,
    },
    Rows {
        from: Plane,
        to: usize,
    },
    Upload {
        buffer: usize,
        words: Vec<u32>,
    },
}

impl Pass {
    /// The planes that the pass writes.
    pub(super) fn planes(&self) -> Vec<Plane> {
        match self {
            Self::Draw { targets, .. } => targets.iter().map(|target| target.plane).collect(),
            Self::Texels { plane, .. } | Self::CopyTexture { to: plane, .. } => vec![*plane],
            Self::Words { .. } | Self::CopyBuffer { .. } | Self::Rows { .. } | Self::Upload { .. } => {
                Vec::new()
            }
        }
    }

    /// The buffer that the pass writes.
    pub(super) fn buffer(&self) -> Option<usize> {
        match self {
            Self::Draw { words, .. } => words.map(|(span, _)| span.buffer),
            Self::Words { span, .. } | Self::CopyBuffer { to: span, .. } => Some(span.buffer),
            Self::Rows { to: buffer, .. } | Self::Upload { buffer, .. } => Some(*buffer),
            Self::Texels { .. } | Self::CopyTexture { .. } => None,
        }
    }
}

/// A graph. The initial contents of its imports follow from the seed.
#[derive(Clone, Debug)]
pub(super) struct Graph {
    pub(super) seed: u64,
    pub(super) textures: Vec<Texture>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) passes: Vec<Pass>,
}

impl Graph {
    /// Describes the graph, with a line for each texture, buffer and pass.
    pub(super) fn lines(&self) -> Vec<String> {
        let textures = self.textures.iter().enumerate().map(|(index, own)| format!("t{index}: {own:?}"));
        let buffers = self.buffers.iter().enumerate().map(|(index, own)| format!("b{index}: {own:?}"));
        let passes = self.passes.iter().enumerate().map(|(index, own)| format!("p{index}: {own:?}"));
        textures.chain(buffers).chain(passes).collect()
    }

    pub(super) fn histories(&self) -> usize {
        self.textures.iter().filter(|texture| matches!(texture.role, Role::Current(_))).count()
    }

    pub(super) fn planes(&self, texture: usize) -> impl Iterator<Item = Plane> + use<> {
        let Texture { mips, layers, .. } = self.textures[texture];
        (0..layers).flat_map(move |layer| (0..mips).map(move |mip| Plane { texture, mip, layer }))
    }

    pub(super) fn all_planes(&self) -> impl Iterator<Item = Plane> {
        (0..self.textures.len()).flat_map(|texture| self.planes(texture))
    }

    pub(super) fn size(&self, plane: Plane) -> (u32, u32) {
        self.textures[plane.texture].plane_size(plane.mip)
    }

    pub(super) fn whole(&self, plane: Plane) -> Rect {
        let (width, height) = self.size(plane);
        Rect::new(0, 0, width, height)
    }
}

/// The texels of a rectangle.
pub(super) fn texels_in(rect: Rect) -> impl Iterator<Item = (u32, u32)> {
    (rect.y..rect.y + rect.height).flat_map(move |y| (rect.x..rect.x + rect.width).map(move |x| (x, y)))
}
