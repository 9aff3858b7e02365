use naga::valid::{Capabilities, ValidationFlags, Validator};

use shadowgraph_shadows::rays::{RayInstance, RayNode, RaySurface, RayTexture, RayTriangle};

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
    for (name, bytes) in [
        ("RayNode", size_of::<RayNode>()),
        ("RayTriangle", size_of::<RayTriangle>()),
        ("RayInstance", size_of::<RayInstance>()),
        ("RaySurface", size_of::<RaySurface>()),
        ("RayTexture", size_of::<RayTexture>()),
    ] {
        let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
        let naga::TypeInner::Struct { span, .. } = found.1.inner else { panic!("{name}") };
        assert_eq!(span as usize, bytes, "{name}");
    }
    let mut bindings: Vec<_> = module
        .global_variables
        .iter()
        .map(|(_, v)| (v.binding.as_ref().unwrap().binding, v.name.clone().unwrap()))
        .collect();
    bindings.sort();
    let names = ["ray_nodes", "ray_triangles", "ray_instances", "ray_surfaces", "ray_words"];
    assert_eq!(bindings.into_iter().map(|(_, name)| name).collect::<Vec<_>>(), names);
}

#[test]
fn the_shader_has_the_constants_of_the_code() {
    assert_eq!(shadowgraph_shadows::rays::MESH_DEPTH + shadowgraph_shadows::rays::TOP_DEPTH, 96);
    assert_eq!(shadowgraph_shadows::rays::RAY_INSTANCE, 0x8000_0000);
    assert_eq!(shadowgraph_shadows::rays::TINT, -1.0);
    assert_eq!(shadowgraph_shadows::rays::LIGHT_DISTANCE_FRACTION, 1.0 - 1.0 / 4096.0);
    assert_eq!(shadowgraph_shadows::rays::OFFSET_PER_COORDINATE, 1.0 / 1_048_576.0);
    assert_eq!(shadowgraph_shadows::rays::OFFSET_PER_VIEW_DISTANCE, 1.0 / 131_072.0);
    for text in [
        "RAY_STACK: u32 = 96u",
        "RAY_INSTANCE: u32 = 0x80000000u",
        "RAY_MARGIN: f32 = 1.0 / 262144.0",
        "RAY_TINT: f32 = -1.0",
        "1.0 - 1.0 / 4096.0",
        "coordinates / 1048576.0",
        "/ 131072.0",
    ] {
        assert!(TEXT.contains(text), "{text}");
    }
}
