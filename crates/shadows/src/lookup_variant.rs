//! The variants of `pcf`'s WGSL: code that no light of a frame needs is not compiled.

use shadowgraph_shaders::ModuleSource;

use crate::settings::ShadowFilter;

/// The filters of the shadowed lights of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PcfVariant {
    /// Several filters.
    Mixed,
    /// One filter for all: [`ShadowFilter::taps`], 1 to 4.
    OneFilter {
        /// Number of comparisons along each axis.
        taps: u32,
    },
    /// No shadowed light: no shadow code at all.
    Unshadowed,
}

impl PcfVariant {
    /// Number of variants.
    pub const COUNT: u32 = 2 + ShadowFilter::ALL.len() as u32;

    /// Returns the index of the variant, below [`COUNT`](Self::COUNT); 0 works for every frame.
    #[must_use]
    pub fn index(self) -> u32 {
        match self {
            Self::Mixed => 0,
            Self::OneFilter { taps } => taps,
            Self::Unshadowed => Self::COUNT - 1,
        }
    }

    pub(crate) fn from_index(index: u32) -> Self {
        match index {
            taps @ 1..=4 => Self::OneFilter { taps },
            5 => Self::Unshadowed,
            _ => Self::Mixed,
        }
    }

    /// Returns the replacement of `shadows/variant.wgsl`.
    pub(crate) fn module(self) -> ModuleSource {
        let taps = if let Self::OneFilter { taps } = self { taps } else { 0 };
        let shadowed = self != Self::Unshadowed;
        let source = format!(
            "#define_import_path shadowgraph::shadows::variant\n\
             const FILTER_TAPS: u32 = {taps}u;\n\
             const SHADOWED: bool = {shadowed};\n"
        );
        ModuleSource::new(format!("shadows/variant.wgsl as {self:?}"), source)
    }
}
