//! Errors in WGSL are reported with file and line, in a short message.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use shadowgraph_shaders::{ModuleSource, NONE, compose, compose_source};

fn error_of(entry: &str, extra: &[ModuleSource]) -> String {
    compose_source(&ModuleSource::new("mine.wgsl", entry.to_owned()), extra).unwrap_err().to_string()
}

const ENTRY_OF_A_TECHNIQUE: &str = "\
#import shadowgraph::receiver::Receiver
#import shadowgraph::technique::shadow_visibility
@fragment fn fs() -> @location(0) vec4f {
    var receiver: Receiver;
    return vec4f(shadow_visibility(0u, receiver), 1.0);
}
";

#[test]
fn an_error_in_a_users_module_names_its_file_and_line() {
    let technique = ModuleSource::new(
        "my_shadows.wgsl",
        "#define_import_path shadowgraph::technique\n\
         #import shadowgraph::receiver::Receiver\n\
         \n\
         fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {\n    \
             return vec3f(reciever.view_depth);\n\
         }\n",
    );
    assert_eq!(
        error_of(ENTRY_OF_A_TECHNIQUE, &[technique]),
        "my_shadows.wgsl:5: no definition in scope for identifier: `reciever` (unknown identifier)\n    \
         return vec3f(reciever.view_depth);"
    );
}

#[test]
fn a_wrong_type_in_a_users_module_names_its_file_and_line() {
    let technique = ModuleSource::new(
        "my_shadows.wgsl",
        "#define_import_path shadowgraph::technique\n\
         #import shadowgraph::receiver::Receiver\n\
         fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {\n    \
             return receiver.view_depth;\n\
         }\n",
    );
    let text = error_of(ENTRY_OF_A_TECHNIQUE, &[technique]);
    assert!(text.starts_with("my_shadows.wgsl:4: "), "{text}");
    assert!(text.lines().count() <= 3 && !text.contains("naga_oil"), "{text}");
}

#[test]
fn an_error_in_the_entry_file_is_found_below_its_imports() {
    let entry = "#import shadowgraph::view::{\n    view, // the camera\n    lights,\n}\n\
        @fragment fn fs() -> @location(0) vec4f {\n    return vec4f(view.exposur);\n}\n";
    assert_eq!(
        error_of(entry, &[]),
        "mine.wgsl:6: invalid field accessor `exposur` (invalid accessor)\n    return vec4f(view.exposur);"
    );
}

#[test]
fn text_that_is_not_wgsl_is_an_error_with_a_line() {
    for (entry, line) in
        [("fn", 1), ("\n\nfn f( {", 3), ("\u{0}", 1), ("#ifdef A\n", 1), ("@fragment\nfn é(", 2)]
    {
        let text = error_of(entry, &[]);
        assert!(text.starts_with(&format!("mine.wgsl:{line}: ")), "{entry:?}: {text}");
        assert!(text.lines().count() <= 3, "{entry:?}: {text}");
    }
    assert!(compose_source(&ModuleSource::new("empty.wgsl", ""), &[]).is_ok());
}

#[test]
fn an_unknown_import_is_an_error_with_similar_names() {
    let entry = "// mine\n#import shadowgraph::recevier::Receiver\nfn f(receiver: Receiver) {}\n";
    let text = error_of(entry, &[]);
    let start = "mine.wgsl:2: unknown module `shadowgraph::recevier::Receiver`; \
        did you mean one of: shadowgraph::receiver, ";
    assert!(text.starts_with(start), "{text}");
    // Also if nothing of it is used, or if it is written inline.
    assert!(error_of("#import a::b\n", &[]).starts_with("mine.wgsl:1: unknown module `a::b`"));
    let inline = "fn f() -> f32 {\n    return shadowgraph::veiw::view.near;\n}\n";
    assert!(error_of(inline, &[]).starts_with("mine.wgsl:2: unknown module `shadowgraph::veiw`"));
}

#[test]
fn an_item_that_a_module_does_not_have_is_named() {
    let entry = "#import shadowgraph::view::vieww\nfn f() -> f32 {\n    return vieww.near;\n}\n";
    let text = error_of(entry, &[]);
    assert!(text.starts_with("mine.wgsl:3: ") && text.contains("`vieww`"), "{text}");
}

#[test]
fn a_missing_technique_is_an_error_that_lists_the_built_in_ones() {
    let text = compose("forward.wgsl", &[]).unwrap_err().to_string();
    assert!(text.starts_with("shade.wgsl:"), "{text}");
    assert!(
        text.contains("no module was passed for `shadowgraph::technique`")
            && text.contains("shadows/none.wgsl"),
        "{text}"
    );
}

#[test]
fn an_unknown_entry_file_is_an_error_that_lists_the_existing_ones() {
    let text = compose("foward.wgsl", &[]).unwrap_err().to_string();
    let start = "unknown built-in entry file `foward.wgsl`; expected one of: background.wgsl, blur.wgsl, check.wgsl, check_explanation.wgsl, ";
    assert!(text.starts_with(start), "{text}");
    assert!(
        text.contains(", pages_update.wgsl, pages_view.wgsl, pose.wgsl, post/bloom.wgsl, ")
            && text.contains(", tonemap.wgsl"),
        "{text}"
    );
    assert!(!text.contains(" view.wgsl") && !text.contains("prefilter.wgsl"), "{text}");
    // A module is no entry file.
    assert!(compose("view.wgsl", &[]).is_err());
}

#[test]
fn modules_need_separate_import_paths() {
    let nameless = ModuleSource::new("nameless.wgsl", "fn f() {}");
    assert!(error_of("", &[nameless]).starts_with("nameless.wgsl: expected a line"));
    let other = ModuleSource::new("other.wgsl", NONE.source);
    assert_eq!(
        error_of("", &[NONE, other]),
        "duplicate import path `shadowgraph::technique` in shadows/none.wgsl and other.wgsl: pass one of them"
    );
}

#[test]
fn a_cycle_of_imports_is_an_error_that_shows_it() {
    let a = ModuleSource::new("a.wgsl", "#define_import_path a\n#import b::f\nfn e() { f(); }\n");
    let b = ModuleSource::new("b.wgsl", "#define_import_path b\n#import a::e\nfn f() { e(); }\n");
    let text = error_of("#import a::e\nfn g() { e(); }\n", &[a, b]);
    assert_eq!(text, "cycle of module imports: a.wgsl -> b.wgsl -> a.wgsl");
}

#[test]
fn a_name_that_cannot_be_exported_is_named() {
    let module = ModuleSource::new("m.wgsl", "#define_import_path m\n\nstruct S { row0: vec4f }\n");
    let text = error_of("#import m::S\nfn f(s: S) -> vec4f { return s.row0; }\n", &[module]);
    assert!(text.starts_with("m.wgsl:3: `row0` cannot be exported"), "{text}");
}

#[test]
fn a_passed_module_replaces_a_built_in_one() {
    let tonemap = compose("tonemap.wgsl", &[]).unwrap();
    let mine = "#define_import_path shadowgraph::fullscreen\n\
        struct FullscreenVertex { @builtin(position) position: vec4f, @location(0) uv: vec2f }\n\
        fn fullscreen_vertex(vertex_index: u32) -> FullscreenVertex {\n    \
            return FullscreenVertex(vec4f(0.0), vec2f(0.0));\n}\n";
    let other = compose("tonemap.wgsl", &[ModuleSource::new("mine.wgsl", mine)]).unwrap();
    assert_ne!(format!("{:?}", tonemap.functions), format!("{:?}", other.functions));
}
