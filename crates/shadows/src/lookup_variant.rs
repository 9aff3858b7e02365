//! The variants of the WGSL that looks shadows up in maps: code that no light of a frame needs is not compiled.

use std::sync::OnceLock;

use shadowgraph_shaders::{FEW_VIEWS as FEW_VIEWS_MODULE, ModuleSource};

use crate::settings::ShadowFilter;
use crate::views::{
    BIAS_PLANE, BLEND_HARD, MAP_ATLAS, MAP_CASCADES, SELECT_FACE, SELECT_MAP, ShadowLight, ShadowView,
};

/// The largest number of [`ShadowView`]s that are read from a uniform block. `FEW_VIEWS` of `few_views.wgsl`.
pub(crate) const FEW_VIEWS: usize = 32;
/// The largest number of lights of a scene whose [`ShadowLight`]s are read from a uniform block. `FEW_LIGHTS` of `few_views.wgsl`.
pub(crate) const FEW_LIGHTS: usize = 32;

/// A variant of the WGSL that looks shadows up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LookupVariant {
    /// For frames in which no light has shadows: no shadow code at all.
    Unshadowed,
    /// For frames in which some light has shadows.
    Shadowed(CommonLookup),
}

/// What the lookups of a frame's shadowed lights have in common. The default, nothing, works for every frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct CommonLookup {
    /// Where views and lights are read from.
    pub source: LookupSource,
    /// [`ShadowFilter::taps`], 1 to 4, if all lights have the same; 0 if they differ.
    pub taps: u32,
    /// The map that all lights are in, if they are in one.
    pub map: Option<MapUse>,
    /// Whether all lights have the default [`BiasMethod`](crate::BiasMethod), [`NormalBias`](crate::NormalBias) and
    /// [`DistanceMeasure`](crate::DistanceMeasure), and cascades that neither blend nor fade out at the edge of the last one and
    /// are selected by [`Map`](crate::CascadeSelection::Map).
    pub simple: bool,
    /// Whether translucent casters are drawn into no map.
    pub untinted: bool,
}

/// Where a frame's shadow views and lights are read from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LookupSource {
    /// Storage buffers of any size.
    #[default]
    Storage,
    /// Uniform blocks: the scene has at most 32 lights, and their shadows have at most 32 views.
    Uniform,
    /// As `Uniform`; only the scene's first light has shadows, [simple](CommonLookup::simple) ones in cascades.
    OneLight,
}

/// The map that all lights of a frame are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapUse {
    /// That of cascades.
    Cascades,
    /// The atlas.
    Atlas,
}

impl LookupVariant {
    /// Returns all variants. The first works for every frame. Those of techniques whose filter has no taps of [`ShadowFilter`] are
    /// the first [`count_without_taps`](Self::count_without_taps).
    #[must_use]
    pub fn all() -> &'static [Self] {
        static ALL: OnceLock<Vec<LookupVariant>> = OnceLock::new();
        ALL.get_or_init(|| {
            let taps = (0..).take(ShadowFilter::ALL.len() + 1);
            let mut all: Vec<_> = taps.flat_map(Self::with_taps).collect();
            all.insert(Self::count_without_taps() as usize - 1, Self::Unshadowed);
            all
        })
    }

    /// Returns the variants for shadowed lights with these taps.
    fn with_taps(taps: u32) -> impl Iterator<Item = Self> {
        let maps = [None, Some(MapUse::Cascades), Some(MapUse::Atlas)];
        let sources = [LookupSource::Storage, LookupSource::Uniform];
        let any = sources.into_iter().flat_map(move |source| {
            let simple = [false, true].into_iter();
            simple.flat_map(move |simple| {
                maps.map(|map| CommonLookup { source, taps, map, simple, untinted: false })
            })
        });
        let one = CommonLookup {
            source: LookupSource::OneLight,
            taps,
            map: Some(MapUse::Cascades),
            simple: true,
            untinted: false,
        };
        any.chain([one])
            .flat_map(|tinted| [tinted, CommonLookup { untinted: true, ..tinted }])
            .map(Self::Shadowed)
    }

    /// Returns the number of variants of techniques whose filter has no taps of [`ShadowFilter`].
    #[must_use]
    pub fn count_without_taps() -> u32 {
        Self::with_taps(0).count() as u32 + 1
    }

    /// Returns the best variant for the lights and views of a frame.
    #[must_use]
    pub fn for_frame(lights: &[ShadowLight], views: &[ShadowView]) -> Self {
        let shadowed = || lights.iter().filter(|light| light.view_count > 0);
        let Some(first) = shadowed().next() else { return Self::Unshadowed };
        let is_simple = |light: &ShadowLight| {
            light.blend == BLEND_HARD
                && light.edge_fade <= 0.0
                && light.bias_method == BIAS_PLANE
                && light.normal_sine == 1
                && light.fades_by_radius == 0
                && matches!(light.select, SELECT_MAP | SELECT_FACE)
        };
        let map = match first.map {
            MAP_CASCADES => MapUse::Cascades,
            _ => MapUse::Atlas,
        };
        let common = CommonLookup {
            source: LookupSource::Storage,
            taps: if shadowed().all(|light| light.filter_taps == first.filter_taps) {
                first.filter_taps
            } else {
                0
            },
            map: shadowed().all(|light| light.map == first.map).then_some(map),
            simple: shadowed().all(is_simple),
            untinted: views.iter().all(|view| view.is_tinted == 0),
        };
        let is_one = || {
            lights[0].view_count > 0
                && shadowed().count() == 1
                && first.first_view == 0
                && (map, common.simple) == (MapUse::Cascades, true)
        };
        let source = match (lights.len(), views.len()) {
            (..=FEW_LIGHTS, ..=FEW_VIEWS) if is_one() => LookupSource::OneLight,
            (..=FEW_LIGHTS, ..=FEW_VIEWS) => LookupSource::Uniform,
            _ => LookupSource::Storage,
        };
        Self::Shadowed(CommonLookup { source, ..common })
    }

    /// Returns the variant of techniques whose filter has no taps of [`ShadowFilter`].
    #[must_use]
    pub fn without_taps(self) -> Self {
        match self {
            Self::Shadowed(common) => Self::Shadowed(CommonLookup { taps: 0, ..common }),
            Self::Unshadowed => Self::Unshadowed,
        }
    }

    /// Returns the index of the variant among [`all`](Self::all).
    #[must_use]
    pub fn index(self) -> u32 {
        Self::all().iter().position(|other| *other == self).unwrap_or(0) as u32
    }

    /// Whether views and lights are read from uniform blocks.
    pub(crate) fn reads_uniforms(self) -> bool {
        matches!(self, Self::Shadowed(common) if common.source != LookupSource::Storage)
    }

    /// Returns the replacements of `shadows/variant.wgsl` and `shadows/views.wgsl` for the variant with this index among
    /// [`all`](Self::all).
    pub(crate) fn modules(index: u32) -> Vec<ModuleSource> {
        let variant = Self::all().get(index as usize).copied().unwrap_or(Self::Unshadowed);
        let shadowed = variant != Self::Unshadowed;
        let common = if let Self::Shadowed(common) = variant { common } else { CommonLookup::default() };
        let CommonLookup { source, taps, map, simple, untinted } = common;
        let only_map = match map {
            None => "ANY_MAP".to_owned(),
            Some(MapUse::Cascades) => format!("{MAP_CASCADES}u"),
            Some(MapUse::Atlas) => format!("{MAP_ATLAS}u"),
        };
        let text = format!(
            "#define_import_path shadowgraph::shadows::variant\n\
             const ANY_MAP: u32 = 0xffffffffu;\n\
             const FILTER_TAPS: u32 = {taps}u;\n\
             const ONLY_MAP: u32 = {only_map};\n\
             const DIRECTIONAL: bool = {};\n\
             const SIMPLE: bool = {simple};\n\
             const TINTED: bool = {};\n\
             const SHADOWED: bool = {shadowed};\n\
             const ONE_LIGHT: bool = {};\n",
            map == Some(MapUse::Cascades),
            !untinted,
            source == LookupSource::OneLight,
        );
        let mut modules = vec![ModuleSource::new(format!("shadows/variant.wgsl {index}"), text)];
        modules.extend(variant.reads_uniforms().then_some(FEW_VIEWS_MODULE));
        modules
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_index_is_that_of_its_variant() {
        for (index, variant) in (0..).zip(LookupVariant::all()) {
            assert_eq!(variant.index(), index);
            assert!(variant.without_taps().index() < LookupVariant::count_without_taps());
        }
        assert_eq!(LookupVariant::Shadowed(CommonLookup::default()).index(), 0);
    }

    #[test]
    fn uniform_blocks_have_the_sizes_of_the_wgsl() {
        let source = FEW_VIEWS_MODULE.source;
        let words =
            [("VIEW_WORDS", size_of::<ShadowView>() / 16), ("LIGHT_WORDS", size_of::<ShadowLight>() / 16)];
        for (name, size) in [("FEW_VIEWS", FEW_VIEWS), ("FEW_LIGHTS", FEW_LIGHTS)].into_iter().chain(words) {
            assert!(source.contains(&format!("const {name}: u32 = {size}u;")), "{name}");
        }
    }

    fn light(map: u32, taps: u32) -> ShadowLight {
        ShadowLight { map, filter_taps: taps, view_count: 1, normal_sine: 1, ..ShadowLight::default() }
    }

    #[test]
    fn a_light_that_needs_more_removes_what_lights_have_in_common() {
        let of = |lights: &[ShadowLight]| LookupVariant::for_frame(lights, &[ShadowView::empty()]);
        let sun = light(MAP_CASCADES, 3);
        let common = CommonLookup {
            source: LookupSource::Uniform,
            taps: 3,
            map: Some(MapUse::Cascades),
            simple: true,
            untinted: true,
        };
        assert_eq!(of(&[ShadowLight::default(), sun]), LookupVariant::Shadowed(common));
        assert_eq!(
            of(&[sun, light(MAP_ATLAS, 3)]),
            LookupVariant::Shadowed(CommonLookup { map: None, ..common })
        );
        assert_eq!(
            of(&[sun, light(MAP_CASCADES, 2)]),
            LookupVariant::Shadowed(CommonLookup { taps: 0, ..common })
        );
        let one = CommonLookup { source: LookupSource::OneLight, ..common };
        assert_eq!(of(&[sun, ShadowLight::default()]), LookupVariant::Shadowed(one));
        let many = CommonLookup { source: LookupSource::Storage, ..common };
        assert_eq!(of(&[sun; FEW_LIGHTS + 1]), LookupVariant::Shadowed(many));
        let blended = ShadowLight { blend: crate::views::BLEND_SOFT, ..sun };
        assert_eq!(of(&[blended]), LookupVariant::Shadowed(CommonLookup { simple: false, ..common }));
        assert_eq!(of(&[ShadowLight::default()]), LookupVariant::Unshadowed);
        let tinted = ShadowView { is_tinted: 1, ..ShadowView::empty() };
        assert_eq!(
            LookupVariant::for_frame(&[sun], &[tinted]),
            LookupVariant::Shadowed(CommonLookup { untinted: false, ..one })
        );
    }
}
