//! The built-in techniques.

use super::TechniqueKind;
use crate::techniques::{
    Evsm, EvsmSettings, Msm, MsmSettings, NoShadows, Pcf, Pcss, PcssSettings, Raytraced, RaytracedSettings,
    Sdsm, SdsmSettings, VirtualMaps, VirtualSettings,
};

/// `pcf`: the default.
pub const PCF: TechniqueKind = TechniqueKind::new(
    "pcf",
    "shadow maps: cascades for directional lights, an atlas for spot and point lights, a filter of fixed width",
    |context| Ok(Box::new(Pcf::new(context.device))),
);

/// `pcss`: [`Pcss`].
pub const PCSS: TechniqueKind = TechniqueKind::new(
    "pcss",
    "shadow maps with penumbrae that widen with the distance from the caster",
    |context| Ok(Box::new(Pcss::new(context.device))),
)
.with_settings::<PcssSettings>();

/// `evsm`: [`Evsm`].
pub const EVSM: TechniqueKind = TechniqueKind::new(
    "evsm",
    "exponential variance shadow maps: filtered before the lookup, so a wide filter costs no more than a narrow one",
    |context| Ok(Box::new(Evsm::new(context.device)?)),
)
.with_settings::<EvsmSettings>();

/// `msm`: [`Msm`].
pub const MSM: TechniqueKind =
    TechniqueKind::new("msm", "moment shadow maps: like evsm, with 64 bits per texel", |context| {
        Ok(Box::new(Msm::new(context.device)?))
    })
    .with_settings::<MsmSettings>();

/// `sdsm`: [`Sdsm`].
pub const SDSM: TechniqueKind = TechniqueKind::new(
    "sdsm",
    "sample distribution shadow maps: cascades that the GPU fits to the visible surfaces",
    |context| Ok(Box::new(Sdsm::new(context.device)?)),
)
.with_settings::<SdsmSettings>();

/// `virtual`: [`VirtualMaps`].
pub const VIRTUAL: TechniqueKind = TechniqueKind::new(
    "virtual",
    "virtual shadow maps: pages of texels as fine as pixels, drawn where they are seen and kept from frame to frame",
    |context| Ok(Box::new(VirtualMaps::new(context.device)?)),
)
.with_settings::<VirtualSettings>();

/// `raytraced`: [`Raytraced`].
pub const RAYTRACED: TechniqueKind = TechniqueKind::new(
    "raytraced",
    "ray-traced hard or soft shadows: the reference for the other techniques",
    |context| Ok(Box::new(Raytraced::new(context.device)?)),
)
.with_settings::<RaytracedSettings>();

/// `none`: [`NoShadows`].
pub const NONE: TechniqueKind =
    TechniqueKind::new("none", "no shadows: everything is lit", |_| Ok(Box::new(NoShadows)));

/// The default first.
pub(super) const ALL: [TechniqueKind; 8] = [PCF, PCSS, EVSM, MSM, SDSM, VIRTUAL, RAYTRACED, NONE];
