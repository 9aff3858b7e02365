use naga::valid::{Capabilities, ValidationFlags, Validator};

const TEXT: &str = include_str!("../../../../shaders/wgsl/rays.wgsl");

fn module() -> naga::Module {
    let (first, rest) = TEXT.split_once('\n').unwrap();
    assert_eq!(first, "#define_import_path shadowgraph::rays");
    naga::front::wgsl::parse_str(rest).unwrap_or_else(|error| panic!("{}", error.emit_to_string(rest)))
}

#[test]
fn the_shader_is_valid_and_asks_for_nothing_special() {
    let module = module();
    Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    assert!(module.functions.iter().any(|(_, f)| f.name.as_deref() == Some("ray_passed")));
}

#[test]
fn the_shader_has_the_records_of_the_buffers() {
    let module = module();
    for (name, bytes) in [("RayNode", 32), ("RayTriangle", 48), ("RayCut", 64), ("RayTexture", 16)] {
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
    let names = ["ray_nodes", "ray_triangles", "ray_cuts", "ray_textures", "ray_texels"];
    assert_eq!(bindings.into_iter().map(|(_, name)| name).collect::<Vec<_>>(), names);
}

#[test]
fn the_shader_has_the_constants_of_the_code() {
    assert_eq!(shadowgraph_shadows::rays::MAX_DEPTH, 64);
    assert_eq!(shadowgraph_shadows::rays::TINT, -1.0);
    assert_eq!(shadowgraph_shadows::rays::WAY_TO_LIGHT, 1.0 - 1.0 / 4096.0);
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
