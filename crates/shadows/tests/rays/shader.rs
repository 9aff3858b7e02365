use glam::{Vec2, Vec3, Vec4};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use shadowgraph_shadows::rays::{Cutout, GpuRayScene, Occluder, RayScene, Surface, Tint};

const TEXT: &str = include_str!("../../../../shaders/wgsl/rays.wgsl");

fn module() -> naga::Module {
    let lines = |line: &&str| !line.starts_with('#');
    let own = TEXT.lines().filter(lines).collect::<Vec<_>>().join("\n");
    let whole = format!("const CUTOUTS: bool = true;\nconst TINTS: bool = true;\n{own}");
    naga::front::wgsl::parse_str(&whole).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&whole)))
}

#[test]
fn the_shader_is_valid_and_needs_no_features() {
    let module = module();
    Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    assert!(module.functions.iter().any(|(_, f)| f.name.as_deref() == Some("ray_passed")));
}

#[test]
fn the_shader_has_the_structs_of_the_buffers() {
    let module = module();
    for (name, bytes) in [("RayNode", 32), ("RayTriangle", 48), ("RayMaterial", 64), ("RayTexture", 16)] {
        let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
        let naga::TypeInner::Struct { span, .. } = found.1.inner else { panic!("{name}") };
        assert_eq!(span, bytes, "{name}");
    }
    let mut bindings: Vec<_> = module
        .global_variables
        .iter()
        .map(|(_, v)| (v.binding.as_ref().unwrap().binding, v.name.clone().unwrap()))
        .collect();
    bindings.sort();
    let names = ["ray_nodes", "ray_triangles", "ray_materials", "ray_textures", "ray_texels"];
    assert_eq!(bindings.into_iter().map(|(_, name)| name).collect::<Vec<_>>(), names);
}

#[test]
fn the_shader_has_the_constants_of_the_code() {
    assert_eq!(shadowgraph_shadows::rays::MAX_DEPTH, 64);
    assert_eq!(shadowgraph_shadows::rays::TINT, -1.0);
    assert_eq!(shadowgraph_shadows::rays::LIGHT_DISTANCE_FRACTION, 1.0 - 1.0 / 4096.0);
    assert_eq!(shadowgraph_shadows::rays::OFFSET_PER_COORDINATE, 1.0 / 1_048_576.0);
    assert_eq!(shadowgraph_shadows::rays::OFFSET_PER_VIEW_DISTANCE, 1.0 / 131_072.0);
    for text in [
        "RAY_STACK: u32 = 64u",
        "RAY_TINT: f32 = -1.0",
        "1.0 - 1.0 / 4096.0",
        "coordinates / 1048576.0",
        "/ 131072.0",
    ] {
        assert!(TEXT.contains(text), "{text}");
    }
}

#[test]
fn unused_kinds_of_materials_are_not_compiled() {
    let square = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let (texture, uv) = (None, [Vec2::ZERO; 3]);
    let cutout = Surface::Cutout(Cutout { texture, uv, alpha: [1.0; 3], cutoff: 0.5 });
    let tint = Surface::Tint(Tint { texture, uv, color: [Vec4::ONE; 3] });
    for surfaces in
        [vec![], vec![Surface::Opaque], vec![cutout], vec![tint], vec![Surface::Opaque, tint, cutout]]
    {
        let occluders: Vec<_> =
            surfaces.iter().map(|&surface| Occluder { corners: square, surface }).collect();
        let scene = RayScene::new(&occluders, Vec::new()).unwrap();
        let text = GpuRayScene::new(&scene, 1 << 27).unwrap().surfaces().source;
        let has = |name: &str, surface| {
            assert!(text.contains(&format!("{name}: bool = {};", surfaces.contains(&surface))), "{text}");
        };
        has("CUTOUTS", cutout);
        has("TINTS", tint);
    }
}
