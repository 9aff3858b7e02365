//! What a technique gives to a frame is checked against what it said.
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

struct Nothing;

impl ShadowCasters for Nothing {
    fn cull(&self, _: &CullVolume, _: &mut Vec<u32>) {}
    fn bounds(&self) -> Aabb {
        Aabb::EMPTY
    }
    fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) -> u32 {
        0
    }
}

/// Says one thing and gives another.
#[derive(Clone, Copy)]
enum Liar {
    TooFew,
    OtherKind,
    OtherFormat,
    MaskOfOtherSize,
    MaskOfOtherFormat,
    NoSuchVariant,
    Honest,
}

impl ShadowTechnique for Liar {
    fn name(&self) -> &str {
        "liar"
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
        _: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let buffer = ShadowBinding::Buffer(frame.upload_buffer("records", vec![0; 16]));
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
            Self::Honest => Some(TextureDesc::d2(64, 64, Format::Rgba8Unorm)),
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

/// What a frame says to a technique.
fn added(technique: &dyn ShadowTechnique, settings: &ShadowSettings) -> Result<(), Error> {
    let (lights, camera) = ([sun()], Camera::framing(&Aabb::EMPTY, 1.0));
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.0,
        lights: &lights,
        casters: &Nothing,
        origin_world: DVec3::ZERO,
        settings,
    };
    let mut frame = Frame::new();
    let mut surfaces = frame.create_texture("surfaces", TextureDesc::d2(64, 64, Format::Rgba32Float));
    frame.render_pass("surfaces").color(&mut surfaces, Contents::clear_color([0.0; 4]));
    let screen = SurfaceBuffers {
        size_px: [64, 64],
        view: frame.upload_buffer("view", vec![0; 256]),
        lights: frame.upload_buffer("lights", vec![0; 64]),
        surfaces,
        has_blended: false,
    };
    add_shadows(technique, &mut frame, &inputs, Some(&screen)).map(drop)
}

#[test]
fn a_frame_names_the_technique_that_lies_and_how() {
    let settings = ShadowSettings::default();
    for (liar, part) in [
        (Liar::TooFew, "a frame has 1 bindings, and `binding_types` says 2"),
        (Liar::OtherKind, "binding 0 of a frame is a texture Depth32Float as D2"),
        (Liar::OtherFormat, "binding 1 of a frame is a texture R32Float as D2"),
        (
            Liar::MaskOfOtherSize,
            "its screen mask is 32x64 Rgba8Unorm with 1 layers, and the picture's has to be 64x64",
        ),
        (Liar::MaskOfOtherFormat, "its screen mask is 64x64 R8Unorm"),
        (Liar::NoSuchVariant, "a frame asks for variant 1, and there are 1"),
    ] {
        let error = added(&liar, &settings).unwrap_err().to_string();
        assert!(error.starts_with("technique `liar`: ") && error.contains(part), "{error}");
        assert_eq!(error.lines().count(), 1);
    }
    assert_eq!(added(&Liar::Honest, &settings), Ok(()));
}

#[test]
fn settings_that_a_technique_cannot_have_end_the_frame_with_its_name() {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let make = |technique: Technique| technique.make(&TechniqueContext::new(&device)).unwrap();
    let kinds = Techniques::built_in();
    for (name, text, part) in [
        ("pcss", "(lamp_radius_m: NaN)", "`lamp_radius_m` is NaN"),
        ("evsm", "(away: inf)", "`away` is inf"),
        ("evsm", "(precision: Half, away: 40.0)", "`away` is 40; allowed: 1 to 5.54 with Half"),
        ("evsm", "(downscale: 3)", "`downscale` is 3; allowed: 1, 2 or 4"),
        ("evsm", "(downscale: 4, blur_texels: 4, mips: 3)", "`blur_texels` is 4; allowed: so few that"),
        ("msm", "(bias: -1.0)", "`bias` is -1"),
        ("msm", "(mips: 0)", "`mips` is 0; allowed: 1 to 3"),
        ("sdsm", "(lambda: 2.0)", "`lambda` is 2; allowed: 0 to 1"),
        ("raytraced", "(rays: 0)", "`rays` is 0; allowed: 1 to 64"),
        ("raytraced", "(rays: many)", "its settings: "),
    ] {
        let settings: ShadowSettings =
            ron::from_str(&format!("(techniques: {{\"{name}\": {text}}})")).unwrap();
        let technique = make(kinds.find(name).unwrap());
        let error = added(technique.as_ref(), &settings).unwrap_err().to_string();
        assert!(error.starts_with(&format!("technique `{name}`: ")) && error.contains(part), "{error}");
        // The registry finds it before any frame.
        assert_eq!(kinds.check(&settings).unwrap_err().to_string(), error);
    }
}

#[test]
fn every_technique_and_what_goes_on_top_of_it_gives_what_it_says() {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    for &kind in Techniques::built_in().kinds() {
        let alone = Technique::from(kind);
        for technique in [alone, alone.collected(), alone.with_contact()] {
            let made = technique.make(&TechniqueContext::new(&device)).unwrap();
            assert_eq!(made.name(), technique.name());
            assert_eq!(added(made.as_ref(), &ShadowSettings::default()), Ok(()), "{}", technique.name());
        }
    }
}
