//! The output of a technique is validated against its declarations.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use glam::{DVec3, Vec3};
use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
use shadowgraph_scene::{Aabb, Camera, CullVolume, Light, LightKind};
use shadowgraph_shaders::ModuleSource;
use shadowgraph_shadows::{
    CasterView, Error, Requirements, ShadowBinding, ShadowCasters, ShadowInputs, ShadowOutputs,
    ShadowSettings, ShadowTechnique, SurfaceBuffers, Technique, TechniqueContext, Techniques, add_shadows,
    binding,
};

struct NoCasters;

impl ShadowCasters for NoCasters {
    fn cull(&self, _: &CullVolume, _: &mut Vec<u32>) {}
    fn bounds(&self) -> Aabb {
        Aabb::EMPTY
    }
    fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) -> u32 {
        0
    }
}

/// A technique whose output differs from its declarations.
#[derive(Clone, Copy)]
enum Inconsistent {
    TooFew,
    OtherKind,
    OtherFormat,
    MaskOfOtherSize,
    MaskOfOtherFormat,
    NoSuchVariant,
    Consistent,
}

impl ShadowTechnique for Inconsistent {
    fn name(&self) -> &str {
        "inconsistent"
    }

    fn requirements(&self, _: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(Requirements::NONE)
    }

    fn modules(&self, _: u32) -> Vec<ModuleSource> {
        Vec::new()
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        vec![binding::STORAGE, binding::DEPTH_MAP]
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _: &ShadowInputs<'f>,
        _: &Requirements,
        _: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let buffer = ShadowBinding::Buffer(frame.upload_buffer("buffer", vec![0; 16]));
        let format = if matches!(self, Self::OtherFormat) { Format::R32Float } else { Format::Depth32Float };
        let map = ShadowBinding::Texture(frame.create_texture("map", TextureDesc::d2(4, 4, format)));
        let bindings = match self {
            Self::TooFew => vec![buffer],
            Self::OtherKind => vec![map, buffer],
            _ => vec![buffer, map],
        };
        let mask = match self {
            Self::MaskOfOtherSize => Some(TextureDesc::d2(32, 64, Format::Rgba8Unorm)),
            Self::MaskOfOtherFormat => Some(TextureDesc::d2(64, 64, Format::R8Unorm)),
            Self::Consistent => Some(TextureDesc::d2(64, 64, Format::Rgba8Unorm)),
            _ => None,
        };
        let mask = mask.map(|desc| frame.create_texture("mask", desc));
        let variant = if matches!(self, Self::NoSuchVariant) { 1 } else { 0 };
        Ok(ShadowOutputs { bindings, mask, variant, ..ShadowOutputs::default() })
    }
}

fn sun() -> Light {
    let kind = LightKind::Directional { direction: DVec3::NEG_Y };
    Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true }
}

/// Adds a technique to a frame.
fn add(technique: &dyn ShadowTechnique, settings: &ShadowSettings) -> Result<(), Error> {
    let (lights, camera) = ([sun()], Camera::framing(&Aabb::EMPTY, 1.0));
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.0,
        lights: &lights,
        casters: &NoCasters,
        origin_world: DVec3::ZERO,
        settings,
    };
    let mut frame = Frame::new();
    let mut surfaces = frame.create_texture("surfaces", TextureDesc::d2(64, 64, Format::Rgba32Float));
    frame.render_pass("surfaces").color(&mut surfaces, Contents::clear_color([0.0; 4]));
    let buffers = SurfaceBuffers {
        size_px: [64, 64],
        view: frame.upload_buffer("view", vec![0; 272]),
        lights: frame.upload_buffer("lights", vec![0; 64]),
        surfaces,
        has_blended: false,
        ground_height: None,
    };
    add_shadows(technique, &mut frame, &inputs, Some(&buffers)).map(drop)
}

#[test]
fn an_error_names_the_technique_and_the_inconsistency() {
    let settings = ShadowSettings::default();
    for (technique, part) in [
        (Inconsistent::TooFew, "`add_to` returned 1 bindings, but `binding_types` has 2"),
        (Inconsistent::OtherKind, "returned a texture Depth32Float as D2 as binding 0, but"),
        (Inconsistent::OtherFormat, "returned a texture R32Float as D2 as binding 1, but"),
        (Inconsistent::MaskOfOtherSize, "the screen mask is 32x64 Rgba8Unorm with 1 layers; expected 64x64"),
        (Inconsistent::MaskOfOtherFormat, "the screen mask is 64x64 R8Unorm"),
        (Inconsistent::NoSuchVariant, "`add_to` returned variant 1, but `variant_count` is 1"),
    ] {
        let error = add(&technique, &settings).unwrap_err().to_string();
        assert!(error.starts_with("technique `inconsistent`: ") && error.contains(part), "{error}");
        assert_eq!(error.lines().count(), 1);
    }
    assert_eq!(add(&Inconsistent::Consistent, &settings), Ok(()));
}

#[test]
fn invalid_settings_of_a_technique_are_an_error_with_their_path() {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let make = |technique: Technique| technique.make(&TechniqueContext::new(&device)).unwrap();
    let kinds = Techniques::built_in();
    for (name, text, part) in [
        (
            "pcss",
            "(light_radius_m: NaN)",
            "`techniques.pcss.light_radius_m` is NaN; allowed: 0 to 10 (metres)",
        ),
        ("pcss", "(lamp_radius_m: NaN)", "`techniques.pcss.light_radius_m` is NaN"),
        ("evsm", "(positive_exponent: inf)", "`techniques.evsm.positive_exponent` is inf"),
        ("evsm", "(away: 43.0)", "`techniques.evsm.positive_exponent` is 43"),
        (
            "evsm",
            "(precision: Half, positive_exponent: 40.0)",
            "`techniques.evsm.positive_exponent` is 40; allowed: 1 to 42, with Half up to 5.54",
        ),
        ("evsm", "(downscale: 3)", "`techniques.evsm.downscale` is 3; allowed: 1, 2 or 4"),
        (
            "evsm",
            "(downscale: 4, blur_texels: 4, mips: 3)",
            "`techniques.evsm.blur_texels` is 4; allowed: 0 to 4 (texels), downscale x (",
        ),
        ("msm", "(bias: -1.0)", "`techniques.msm.bias` is -1; allowed: 0.00001 to 0.1"),
        ("msm", "(mips: 0)", "`techniques.msm.mips` is 0; allowed: 1 to 3"),
        ("sdsm", "(lambda: 2.0)", "`techniques.sdsm.lambda` is 2; allowed: 0 to 1"),
        ("raytraced", "(rays: 0)", "`techniques.raytraced.rays` is 0; allowed: 1 to 64"),
        ("raytraced", "(rays: many)", "settings of technique `raytraced`: "),
    ] {
        let settings: ShadowSettings =
            ron::from_str(&format!("(techniques: {{\"{name}\": {text}}})")).unwrap();
        let technique = make(kinds.find(name).unwrap());
        let error = add(technique.as_ref(), &settings).unwrap_err().to_string();
        assert!(error.contains(part) && error.lines().count() == 1, "{error}");
        // The registry finds it before any frame.
        assert_eq!(kinds.check(&settings).unwrap_err().to_string(), error);
    }
}

#[test]
fn every_technique_with_every_modifier_is_consistent_with_its_declarations() {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    for &kind in Techniques::built_in().kinds() {
        let alone = Technique::from(kind);
        for technique in [alone, alone.with_screen(), alone.with_contact()] {
            let made = technique.make(&TechniqueContext::new(&device)).unwrap();
            assert_eq!(made.name(), technique.name());
            assert_eq!(add(made.as_ref(), &ShadowSettings::default()), Ok(()), "{}", technique.name());
        }
    }
}
