//! Every built-in file composes, is valid under wgpu's default limits, and keeps the names and layouts that Rust relies on.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use naga::{
    BuiltIn, ShaderStage,
    valid::{Capabilities, ValidationFlags, Validator},
};
use shadowgraph_shaders::{
    EVSM, MAPPED, MAPPED_EXPLANATION, MOMENTS, MSM, ModuleSource, NONE, PAGE_PENUMBRA, PAGE_POOL, PCSS,
    PREFILTER, RAYTRACED, SCREEN, SKY_LIGHT, VIRTUAL, builtin, builtin_files, compose, layout,
};

/// The files with entry points.
fn entries() -> Vec<&'static str> {
    let is_module = |file: &str| builtin(file).unwrap().source.contains("#define_import_path");
    builtin_files().filter(|file| !is_module(file)).collect()
}

/// The files whose module is `shadowgraph::technique`.
fn techniques() -> Vec<ModuleSource> {
    let files = builtin_files().filter_map(builtin);
    files.filter(|file| file.source.contains("#define_import_path shadowgraph::technique")).collect()
}

/// Adds the modules that an entry file cannot do without: the sky, for the background.
fn with_needed(entry: &str, modules: &[ModuleSource]) -> Vec<ModuleSource> {
    let sky = (entry == "background.wgsl").then(|| SKY_LIGHT.with_value("ENVIRONMENT", "2"));
    let pool = modules.contains(&VIRTUAL).then_some(PAGE_POOL);
    modules.iter().cloned().chain(sky).chain(pool).collect()
}

fn composed(entry: &str) -> naga::Module {
    compose(entry, &[NONE]).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the undecorated name.
fn plain(name: &Option<String>) -> String {
    let name = name.as_deref().unwrap_or_default();
    name.split("X_naga_oil").next().unwrap_or_default().to_owned()
}

/// Returns `group.binding name` of every resource, in order.
fn bindings(module: &naga::Module) -> Vec<String> {
    let variables = module.global_variables.iter().filter_map(|(_, v)| v.binding.map(|b| (b, &v.name)));
    let mut table: Vec<_> = variables.map(|(b, name)| (b.group, b.binding, plain(name))).collect();
    table.sort();
    table.into_iter().map(|(group, binding, name)| format!("{group}.{binding} {name}")).collect()
}

#[test]
fn every_entry_is_valid_with_every_technique() {
    assert_eq!(techniques(), [NONE, MAPPED, RAYTRACED, VIRTUAL]);
    assert!(entries().len() >= 26 && entries().contains(&"post/fxaa.wgsl"));
    for entry in entries() {
        for technique in techniques() {
            let name = format!("{entry} with {}", technique.file);
            let module = compose(entry, &with_needed(entry, &[technique]))
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
            validator.validate(&module).unwrap_or_else(|error| panic!("{name}: {error:?}"));
        }
    }
}

#[test]
fn every_entry_is_valid_with_every_filter() {
    for filter in [vec![PCSS], vec![MOMENTS, EVSM], vec![MOMENTS, MSM]] {
        let modules = [vec![MAPPED], filter].concat();
        for entry in entries() {
            let module = compose(entry, &with_needed(entry, &modules))
                .unwrap_or_else(|error| panic!("{entry}: {error}"));
            // Available everywhere except on old OpenGL.
            let capabilities = Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
            let mut validator = Validator::new(ValidationFlags::all(), capabilities);
            validator.validate(&module).unwrap_or_else(|error| panic!("{entry}: {error:?}"));
        }
    }
}

#[test]
fn every_file_is_reached_by_composition() {
    // A module that nothing imports would never be parsed by the other tests.
    let given = [MAPPED_EXPLANATION, PAGE_PENUMBRA, PAGE_POOL, PCSS, MOMENTS, EVSM, MSM, PREFILTER, SCREEN];
    let text: String = builtin_files().filter_map(builtin).chain(given).map(|file| file.source).collect();
    for file in builtin_files().filter(|file| !entries().contains(file)) {
        let source = builtin(file).unwrap().source;
        let path = source.lines().find_map(|line| line.strip_prefix("#define_import_path ")).unwrap();
        assert!(text.contains(&format!("#import {path}")), "nothing imports {file}");
    }
}

#[test]
fn entry_points_have_the_names_that_pipelines_use() {
    let names = |entry| -> Vec<_> { composed(entry).entry_points.into_iter().map(|e| e.name).collect() };
    assert_eq!(
        names("depth.wgsl"),
        [
            "vs_depth",
            "vs_depth_clamp",
            "vs_alpha",
            "vs_alpha_clamp",
            "fs_mask",
            "fs_dither",
            "fs_clamp",
            "fs_mask_clamp",
            "fs_dither_clamp",
            "fs_tint",
            "fs_tint_clamp",
        ]
    );
    assert_eq!(names("forward.wgsl"), ["vs_forward", "fs_forward"]);
    assert_eq!(
        names("tonemap.wgsl"),
        ["vs_tonemap", "fs_tonemap", "fs_tonemap_background", "fs_tonemap_exposed"]
    );
    let show = [
        "vs_show_depth",
        "vs_show_texture",
        "fs_show_depth",
        "fs_show_atlas",
        "fs_show_texture",
        "fs_show_grey",
    ];
    assert_eq!(names("show.wgsl"), show);
}

#[test]
fn bindings_are_where_bind_group_layouts_have_them() {
    let depth = ["0.0 depth_view", "2.0 material", "2.1 base_color_texture", "2.6 base_color_sampler"];
    assert_eq!(bindings(&composed("depth.wgsl"))[..4], depth);
    assert_eq!(bindings(&composed("depth.wgsl"))[4..], ["3.0 instances", "3.1 drawn"]);
    let forward = bindings(&composed("forward.wgsl"));
    let expected = [
        "0.0 view",
        "0.1 lights",
        "2.0 material",
        "2.1 base_color_texture",
        "2.2 metallic_roughness_texture",
        "2.3 normal_texture",
        "2.4 occlusion_texture",
        "2.5 emissive_texture",
        "2.6 base_color_sampler",
        "2.7 metallic_roughness_sampler",
        "2.8 normal_sampler",
        "2.9 occlusion_sampler",
        "2.10 emissive_sampler",
        "3.0 instances",
        "3.1 drawn",
    ];
    assert_eq!(forward, expected);
    assert_eq!(bindings(&composed("tonemap.wgsl")), ["0.0 hdr_texture", "0.1 settings", "0.2 exposure"]);
    assert_eq!(bindings(&composed("show.wgsl")), ["0.0 view", "1.0 depth_texture", "1.0 float_texture"]);
}

#[test]
fn constants_that_pipelines_set_keep_their_names() {
    let names = |entry| -> Vec<_> {
        let module = composed(entry);
        let mut names: Vec<_> = module.overrides.iter().filter_map(|(_, o)| o.name.clone()).collect();
        names.sort();
        names
    };
    assert_eq!(names("forward.wgsl"), ["AOV", "AOV_LIGHT"]);
    assert_eq!(names("depth.wgsl"), ["CASTS", "SLOPE_BIAS"]);
}

#[test]
fn structs_have_the_same_layout_in_wgsl_and_rust() {
    let forward = composed("forward.wgsl");
    let view = [
        ("clip_from_world", 0),
        ("world_from_clip", 64),
        ("view_from_world", 128),
        ("position", 192),
        ("near", 204),
        ("size_px", 208),
        ("far", 216),
        ("exposure", 220),
        ("ambient_sky", 224),
        ("light_count", 236),
        ("ambient_ground", 240),
        ("orthographic", 252),
        ("pixel_right", 256),
        ("noise_changes", 268),
        ("pixel_up", 272),
        ("zero", 284),
        ("noise", 288),
    ];
    layout::check(&forward, "View", 288 + 1024, &view).unwrap();
    let light = [
        ("position", 0),
        ("kind", 12),
        ("direction", 16),
        ("range", 28),
        ("color", 32),
        ("spot_scale", 44),
        ("spot_offset", 48),
    ];
    layout::check(&forward, "Light", 64, &light).unwrap();
    let instance = [
        ("row_x", 0),
        ("row_y", 16),
        ("row_z", 32),
        ("previous_row_x", 48),
        ("previous_row_y", 64),
        ("previous_row_z", 80),
        ("flags", 96),
    ];
    layout::check(&forward, "Instance", 112, &instance).unwrap();
    let material = [
        ("base_color", 0),
        ("emissive", 16),
        ("metallic", 28),
        ("roughness", 32),
        ("normal_scale", 36),
        ("occlusion_strength", 40),
        ("alpha_cutoff", 44),
        ("uv_sets", 48),
        ("flags_index", 52),
        ("caster_cutoff", 56),
        ("uv_transforms", 64),
        ("flags", 224),
    ];
    layout::check(&forward, "Material", 256, &material).unwrap();
    // The members of a ShadowView that it reads.
    let of_shadows = [("clip_from_world", 0), ("of_shadows", 64), ("noise_px", 232)];
    layout::check(&composed("depth.wgsl"), "DepthView", 240, &of_shadows).unwrap();
}

/// Returns the names of the functions that an entry point calls, in order.
fn functions_called(module: &naga::Module, entry: &str) -> Vec<String> {
    fn called(module: &naga::Module, body: &naga::Block) -> Vec<String> {
        let mut names = Vec::new();
        for statement in body {
            if let naga::Statement::Call { function, .. } = statement {
                let function = &module.functions[*function];
                names.push(plain(&function.name));
                names.extend(called(module, &function.body));
            }
        }
        names
    }
    let entry = module.entry_points.iter().find(|e| e.name == entry).unwrap();
    called(module, &entry.function.body)
}

/// Returns whether the stage's position output is declared invariant.
fn has_invariant_position(module: &naga::Module, entry: &str) -> bool {
    let entry = module.entry_points.iter().find(|e| e.name == entry).unwrap();
    assert_eq!(entry.stage, ShaderStage::Vertex);
    let ty = entry.function.result.as_ref().unwrap().ty;
    let naga::TypeInner::Struct { members, .. } = &module.types[ty].inner else { panic!("not a struct") };
    let invariant = naga::Binding::BuiltIn(BuiltIn::Position { invariant: true });
    members.iter().any(|member| member.binding.as_ref() == Some(&invariant))
}

#[test]
fn depth_and_lit_passes_compute_positions_by_the_same_functions() {
    let shared = ["world_position", "clip_position"];
    for (file, entry) in [
        ("depth.wgsl", "vs_depth"),
        ("depth.wgsl", "vs_alpha"),
        ("forward.wgsl", "vs_forward"),
        ("gbuffer.wgsl", "vs_gbuffer"),
        ("velocity.wgsl", "vs_velocity"),
    ] {
        let module = composed(file);
        assert!(has_invariant_position(&module, entry));
        let lit = functions_called(&module, entry);
        assert_eq!(lit.iter().filter(|name| shared.contains(&name.as_str())).count(), 2);
    }
}
