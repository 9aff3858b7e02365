//! The variants of the WGSL that looks shadows up in maps: code that no light of a frame needs is not compiled.

use shadowgraph_shaders::ModuleSource;

use crate::settings::ShadowFilter;
use crate::views::{
    BIAS_PLANE, BLEND_HARD, MAP_ATLAS, MAP_CASCADES, SELECT_FACE, SELECT_MAP, ShadowLight, ShadowView,
};

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

/// The map that all lights of a frame are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapUse {
    /// That of cascades.
    Cascades,
    /// The atlas.
    Atlas,
}

/// The maps of a frame: either, or both.
const MAPS: u32 = 3;
/// The variants for shadowed lights with one choice of taps.
const WITH_TAPS: u32 = MAPS * 4;

impl LookupVariant {
    /// Number of variants.
    pub const COUNT: u32 = Self::COUNT_WITHOUT_TAPS + ShadowFilter::ALL.len() as u32 * WITH_TAPS;
    /// Number of variants of techniques whose filter has no taps of [`ShadowFilter`]. They are the first ones.
    pub const COUNT_WITHOUT_TAPS: u32 = WITH_TAPS + 1;

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
        Self::Shadowed(CommonLookup {
            taps: if shadowed().all(|light| light.filter_taps == first.filter_taps) {
                first.filter_taps
            } else {
                0
            },
            map: shadowed().all(|light| light.map == first.map).then_some(map),
            simple: shadowed().all(is_simple),
            untinted: views.iter().all(|view| view.is_tinted == 0),
        })
    }

    /// Returns the variant of techniques whose filter has no taps of [`ShadowFilter`]: one of the first
    /// [`COUNT_WITHOUT_TAPS`](Self::COUNT_WITHOUT_TAPS).
    #[must_use]
    pub fn without_taps(self) -> Self {
        match self {
            Self::Shadowed(common) => Self::Shadowed(CommonLookup { taps: 0, ..common }),
            Self::Unshadowed => Self::Unshadowed,
        }
    }

    /// Returns the index of the variant, below [`COUNT`](Self::COUNT); 0 works for every frame.
    #[must_use]
    pub fn index(self) -> u32 {
        match self {
            Self::Unshadowed => WITH_TAPS,
            Self::Shadowed(common) => {
                let map = common.map.map_or(0, |map| 1 + map as u32);
                let rest = map + MAPS * (u32::from(common.simple) + 2 * u32::from(common.untinted));
                // `Unshadowed` follows the variants without taps.
                rest + common.taps * WITH_TAPS + u32::from(common.taps > 0)
            }
        }
    }

    /// Returns the variant with an index below [`COUNT`](Self::COUNT).
    #[must_use]
    pub fn from_index(index: u32) -> Self {
        if index == WITH_TAPS {
            return Self::Unshadowed;
        }
        let index = index - u32::from(index > WITH_TAPS);
        let (taps, rest) = (index / WITH_TAPS, index % WITH_TAPS);
        let (map, flags) = (rest % MAPS, rest / MAPS);
        let map = [None, Some(MapUse::Cascades), Some(MapUse::Atlas)][map as usize];
        Self::Shadowed(CommonLookup { taps, map, simple: flags & 1 == 1, untinted: flags & 2 == 2 })
    }

    /// Returns the replacement of `shadows/variant.wgsl`.
    pub(crate) fn module(self) -> ModuleSource {
        let shadowed = self != Self::Unshadowed;
        let common = if let Self::Shadowed(common) = self { common } else { CommonLookup::default() };
        let CommonLookup { taps, map, simple, untinted } = common;
        let only_map = match map {
            None => "ANY_MAP".to_owned(),
            Some(MapUse::Cascades) => format!("{MAP_CASCADES}u"),
            Some(MapUse::Atlas) => format!("{MAP_ATLAS}u"),
        };
        let source = format!(
            "#define_import_path shadowgraph::shadows::variant\n\
             const ANY_MAP: u32 = 0xffffffffu;\n\
             const FILTER_TAPS: u32 = {taps}u;\n\
             const ONLY_MAP: u32 = {only_map};\n\
             const SIMPLE: bool = {simple};\n\
             const TINTED: bool = {};\n\
             const SHADOWED: bool = {shadowed};\n",
            !untinted
        );
        ModuleSource::new(format!("shadows/variant.wgsl {}", self.index()), source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_index_is_that_of_its_variant() {
        for index in 0..LookupVariant::COUNT {
            let variant = LookupVariant::from_index(index);
            assert_eq!(variant.index(), index);
            assert!(variant.without_taps().index() < LookupVariant::COUNT_WITHOUT_TAPS);
        }
        assert_eq!(LookupVariant::Shadowed(CommonLookup::default()).index(), 0);
    }

    fn light(map: u32, taps: u32) -> ShadowLight {
        ShadowLight { map, filter_taps: taps, view_count: 1, normal_sine: 1, ..ShadowLight::default() }
    }

    #[test]
    fn a_light_that_needs_more_removes_what_lights_have_in_common() {
        let of = |lights: &[ShadowLight]| LookupVariant::for_frame(lights, &[ShadowView::empty()]);
        let sun = light(MAP_CASCADES, 3);
        let common = CommonLookup { taps: 3, map: Some(MapUse::Cascades), simple: true, untinted: true };
        assert_eq!(of(&[ShadowLight::default(), sun]), LookupVariant::Shadowed(common));
        assert_eq!(
            of(&[sun, light(MAP_ATLAS, 3)]),
            LookupVariant::Shadowed(CommonLookup { map: None, ..common })
        );
        assert_eq!(
            of(&[sun, light(MAP_CASCADES, 2)]),
            LookupVariant::Shadowed(CommonLookup { taps: 0, ..common })
        );
        let blended = ShadowLight { blend: crate::views::BLEND_SOFT, ..sun };
        assert_eq!(of(&[blended]), LookupVariant::Shadowed(CommonLookup { simple: false, ..common }));
        assert_eq!(of(&[ShadowLight::default()]), LookupVariant::Unshadowed);
        let tinted = ShadowView { is_tinted: 1, ..ShadowView::empty() };
        assert_eq!(
            LookupVariant::for_frame(&[sun], &[tinted]),
            LookupVariant::Shadowed(CommonLookup { untinted: false, ..common })
        );
    }
}
