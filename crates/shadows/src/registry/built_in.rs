//! The techniques that come with Shadowgraph.

use super::TechniqueKind;
use crate::techniques::{
    Evsm, EvsmSettings, Msm, MsmSettings, NoShadows, Pcf, Pcss, PcssSettings, Raytraced, RaytracedSettings,
    Sdsm, SdsmSettings,
};

/// `pcf`: the default.
pub const PCF: TechniqueKind = TechniqueKind::new(
    "pcf",
    "shadow maps: cascades for suns, an atlas for lamps, evenly soft edges",
    |context| Ok(Box::new(Pcf::new(context.device))),
);

/// `pcss`: [`Pcss`].
pub const PCSS: TechniqueKind = TechniqueKind::new(
    "pcss",
    "shadow maps with edges that get softer away from what casts them",
    |context| Ok(Box::new(Pcss::new(context.device))),
)
.with_settings::<PcssSettings>();

/// `evsm`: [`Evsm`].
pub const EVSM: TechniqueKind = TechniqueKind::new(
    "evsm",
    "exponential variance shadow maps: evenly soft edges that cost the same however soft",
    |context| Ok(Box::new(Evsm::new(context.device)?)),
)
.with_settings::<EvsmSettings>();

/// `msm`: [`Msm`].
pub const MSM: TechniqueKind =
    TechniqueKind::new("msm", "moment shadow maps: as evsm, in 64 bits a texel", |context| {
        Ok(Box::new(Msm::new(context.device)?))
    })
    .with_settings::<MsmSettings>();

/// `sdsm`: [`Sdsm`].
pub const SDSM: TechniqueKind = TechniqueKind::new(
    "sdsm",
    "shadow maps whose cascades the GPU fits to the surfaces that are seen",
    |context| Ok(Box::new(Sdsm::new(context.device)?)),
)
.with_settings::<SdsmSettings>();

/// `raytraced`: [`Raytraced`].
pub const RAYTRACED: TechniqueKind = TechniqueKind::new(
    "raytraced",
    "rays through the scene's triangles, hard or soft: what the others are measured against",
    |context| Ok(Box::new(Raytraced::new(context.device, &context.rays()?)?)),
)
.with_settings::<RaytracedSettings>();

/// `none`: [`NoShadows`].
pub const NONE: TechniqueKind =
    TechniqueKind::new("none", "everything is lit: the floor of cost", |_| Ok(Box::new(NoShadows)));

/// The default first.
pub(super) const ALL: [TechniqueKind; 7] = [PCF, PCSS, EVSM, MSM, SDSM, RAYTRACED, NONE];
