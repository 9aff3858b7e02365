//! Casters of tiles: those of a list, and those that the GPU finds.

use shadowgraph_core::{Frame, Pass, Rendering};
use shadowgraph_scene::{ConvexVolume, CullVolume};

use super::contents::{ALL_STATIC, Versions};
use super::reasons::tile_name;
use crate::caster_view::CasterPass;
use crate::casters::ShadowCasters;
use crate::culled::{CulledInstances, CulledTokens};
use crate::gpu_casters::CasterQuery;
use crate::plan::TilePlan;

/// The casters of a tile, or of a part of one.
#[derive(Clone, Debug, Default)]
pub(super) struct TileCasters {
    pub(super) listed: Vec<u32>,
    /// The index of a query.
    culled: Option<u32>,
}

/// What the GPU finds for a map in a frame.
#[derive(Default)]
pub(super) struct Queries(Vec<CasterQuery>);

impl TileCasters {
    /// Returns the casters that matter to the view.
    pub(super) fn seen(tile: &TilePlan, pass: CasterPass, queries: &mut Queries) -> Self {
        let culled = tile.culled_of(pass).map(|volume| queries.push(tile_name(tile), volume, false));
        Self { listed: tile.casters_of(pass).to_vec(), culled }
    }

    /// Returns static casters, which the GPU finds in the volume if they are not listed.
    pub(super) fn all_static(
        tile: &TilePlan,
        casters: &Versions,
        volume: &CullVolume,
        queries: &mut Queries,
    ) -> Self {
        let is_culled = casters.iter().any(|(caster, _)| *caster == ALL_STATIC);
        let listed = casters.iter().map(|(caster, _)| *caster).filter(|&caster| caster != ALL_STATIC);
        Self {
            listed: listed.collect(),
            culled: is_culled.then(|| queries.push(format!("{} static", tile_name(tile)), volume, true)),
        }
    }

    /// Returns casters of a list.
    pub(super) fn listed(listed: Vec<u32>) -> Self {
        Self { listed, culled: None }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.listed.is_empty() && self.culled.is_none()
    }

    /// Declares that a pass draws them.
    pub(super) fn read_in(
        &self,
        pass: &mut Pass<'_, '_, Rendering>,
        culled: Option<&CulledInstances>,
    ) -> Option<CulledTokens> {
        culled?.read_in(pass, self.culled?)
    }
}

impl Queries {
    fn push(&mut self, name: String, volume: &CullVolume, only_static: bool) -> u32 {
        let CullVolume { planes: ConvexVolume { planes }, .. } = volume;
        self.0.push(CasterQuery { name, volume: ConvexVolume { planes: planes.clone() }, only_static });
        self.0.len() as u32 - 1
    }

    /// Adds the passes that find them.
    pub(super) fn add_to<'f>(
        &self,
        frame: &mut Frame<'f>,
        casters: &'f dyn ShadowCasters,
    ) -> Option<CulledInstances> {
        let gpu = casters.gpu().filter(|_| !self.0.is_empty())?;
        Some(frame.node("cull casters", |frame| gpu.cull(frame, &self.0)))
    }
}
