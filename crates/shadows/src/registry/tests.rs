#![allow(clippy::unwrap_used, reason = "tests")]
use shadowgraph_core::Frame;
use shadowgraph_shaders::ModuleSource;

use super::*;
use crate::declare_settings;
use crate::gpu_struct;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::settings::NamedSettings;
use crate::technique::binding::{FILTERED_MAP, SAMPLER, STORAGE, UNIFORM};
use crate::technique::{GpuStruct, ShadowOutputs, ShadowTechnique, SurfaceBuffers};

const HEAD: &str = "#define_import_path shadowgraph::technique\n#import shadowgraph::receiver::Receiver\n";
const COLOR: &str = "fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f { return vec3f(1.0); }\n";

/// A technique whose declarations may be wrong.
#[derive(Default)]
struct TestTechnique {
    name: &'static str,
    wgsl: &'static str,
    types: Vec<wgpu::BindingType>,
    structs: Vec<GpuStruct>,
}

impl ShadowTechnique for TestTechnique {
    fn name(&self) -> &str {
        self.name
    }

    fn requirements(&self, _: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(Requirements::NONE)
    }

    fn modules(&self, _: u32) -> Vec<ModuleSource> {
        vec![ModuleSource::new("mine.wgsl", [HEAD, self.wgsl, COLOR].concat())]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        self.types.clone()
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        self.structs.clone()
    }

    fn add_to<'f>(
        &'f self,
        _: &mut Frame<'f>,
        _: &ShadowInputs<'f>,
        _: &Requirements,
        _: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        Ok(ShadowOutputs::default())
    }
}

const LIT: &str = "fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f { return vec3f(1.0); }\n";
const BOUND: &str = "struct Mine { strength: f32, far: f32 }
    @group(1) @binding(0) var<uniform> mine: Mine;
    fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f { return vec3f(mine.strength); }\n";

fn refused(make: fn(&TechniqueContext<'_>) -> Result<Box<dyn ShadowTechnique>, Error>) -> String {
    refused_kind(TechniqueKind::new("mine", "", make))
}

fn refused_kind(kind: TechniqueKind) -> String {
    let mut techniques = Techniques::built_in();
    let error = techniques.register(kind).unwrap_err().to_string();
    assert_eq!(techniques.kinds().len(), Techniques::built_in().kinds().len());
    assert!(
        error.starts_with(&format!("technique `{}`: ", kind.name)) && error.lines().count() == 1,
        "{error}"
    );
    error
}

#[test]
fn every_built_in_technique_passes_registration() {
    let techniques = Techniques::built_in();
    std::thread::scope(|scope| {
        for kind in techniques.kinds() {
            scope.spawn(move || {
                assert_eq!(check::kind(kind), Ok(()), "{}", kind.name);
                assert!(!kind.summary.is_empty());
            });
        }
    });
}

#[test]
fn a_technique_of_another_crate_is_found_by_its_name() {
    let mut techniques = Techniques::built_in();
    let mine = TechniqueKind::new("mine", "everything is lit", |_| {
        Ok(Box::new(TestTechnique { name: "mine", wgsl: LIT, ..TestTechnique::default() }))
    });
    techniques.register(mine).unwrap();
    assert_eq!(techniques.find("mine").unwrap(), mine);
    assert_eq!(techniques.find("mine+screen").unwrap(), Technique::from(mine).with_screen());
    assert_eq!(techniques.find("screen").unwrap().name(), "pcf+screen");
    assert_eq!(techniques.find("pcf+screen+contact").unwrap().name(), "pcf+contact");
}

#[test]
fn an_unknown_technique_is_an_error_with_the_unknown_part_and_the_known_names() {
    let techniques = Techniques::built_in();
    let wrong = [("", ""), ("soft", "soft"), ("pcf+soft", "+soft"), ("pcf+pcss", "+pcss"), ("pcf+", "+")];
    for (name, part) in wrong {
        let error = techniques.find(name).unwrap_err().to_string();
        assert!(error.starts_with(&format!("unknown technique `{part}`; expected one of: pcf, ")), "{error}");
    }
    for (name, part, near) in [
        ("pfc", "pfc", "pcf"),
        ("PCF", "PCF", "pcf"),
        ("evms", "evms", "evsm"),
        ("msm+scren", "+scren", "+screen"),
    ] {
        let error = techniques.find(name).unwrap_err().to_string();
        let expected =
            format!("unknown technique `{part}`; did you mean `{near}`? expected one of: pcf, pcss, ");
        assert!(error.starts_with(&expected), "{error}");
    }
}

#[test]
fn a_name_that_is_taken_or_has_other_characters_is_an_error() {
    for (name, part) in
        [("pcf", "taken"), ("screen", "taken"), ("Mine", "lower-case letters"), ("", "lower-case letters")]
    {
        let kind = TechniqueKind::new(name, "", |_| {
            Ok(Box::new(TestTechnique { wgsl: LIT, ..TestTechnique::default() }))
        });
        assert!(refused_kind(kind).contains(part), "{name}");
    }
    let other =
        refused(|_| Ok(Box::new(TestTechnique { name: "other", wgsl: LIT, ..TestTechnique::default() })));
    assert!(other.contains("it creates a technique named `other`"), "{other}");
}

#[test]
fn a_missing_function_or_another_return_type_is_an_error() {
    let missing = refused(|_| Ok(Box::new(TestTechnique { name: "mine", ..TestTechnique::default() })));
    assert!(missing.contains("shadow_visibility"), "{missing}");
    let grey = refused(|_| {
        let wgsl = "fn shadow_visibility(light: u32, receiver: Receiver) -> f32 { return 1.0; }\n";
        Ok(Box::new(TestTechnique { name: "mine", wgsl, ..TestTechnique::default() }))
    });
    assert!(grey.contains("shadow_visibility") && grey.contains("vec3"), "{grey}");
}

#[test]
fn an_error_in_wgsl_names_file_and_line() {
    let error = refused(|_| {
        let wgsl =
            "fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {\n    return nothing;\n}\n";
        Ok(Box::new(TestTechnique { name: "mine", wgsl, ..TestTechnique::default() }))
    });
    assert!(error.contains("mine.wgsl:4: ") && error.contains("nothing"), "{error}");
}

#[test]
fn bindings_that_differ_from_the_declared_types_are_an_error() {
    let none =
        refused(|_| Ok(Box::new(TestTechnique { name: "mine", wgsl: BOUND, ..TestTechnique::default() })));
    assert!(none.contains("group: 1, binding: 0"), "{none}");
    let other = refused(|_| {
        Ok(Box::new(TestTechnique {
            name: "mine",
            wgsl: BOUND,
            types: vec![STORAGE],
            ..TestTechnique::default()
        }))
    });
    assert!(other.contains("group: 1, binding: 0"), "{other}");
}

#[test]
fn more_bindings_than_a_lit_pass_leaves_are_an_error() {
    for (ty, count, what) in [
        (STORAGE, 8, "storage buffers"),
        (FILTERED_MAP, 11, "textures"),
        (SAMPLER, 12, "samplers"),
        (UNIFORM, 9, "blocks"),
    ] {
        assert!(check::limits(&vec![ty; count - 1]).is_ok());
        let error = check::limits(&vec![ty; count]).unwrap_err();
        assert!(
            error.starts_with(&format!("it has {count} bindings for ")) && error.contains(what),
            "{error}"
        );
    }
}

#[test]
fn structs_with_another_layout_in_rust_are_an_error() {
    gpu_struct! {
        struct Mine {
            far: f32,
            strength: f32,
        }
    }
    let error = refused(|_| {
        let structs = vec![GpuStruct::new::<Mine>("Mine")];
        Ok(Box::new(TestTechnique { name: "mine", wgsl: BOUND, types: vec![UNIFORM], structs }))
    });
    assert!(error.contains("field `far` of WGSL struct `Mine` is at byte 4, expected 0"), "{error}");
}

declare_settings! {
    /// Settings whose default is out of range.
    struct Strength {
        /// Strength.
        strength: f32 = f32::NAN, 0..=1;
    }
}

impl NamedSettings for Strength {
    const NAME: &'static str = "mine";
}

#[test]
fn default_settings_out_of_range_are_an_error() {
    let kind = TechniqueKind::new("mine", "", |_| {
        Ok(Box::new(TestTechnique { name: "mine", wgsl: LIT, ..TestTechnique::default() }))
    });
    let error = refused_kind(kind.with_settings::<Strength>());
    assert!(
        error.contains("default settings: ") && error.contains("`techniques.mine.strength` is NaN"),
        "{error}"
    );
}

#[test]
fn settings_of_another_technique_are_an_error() {
    let kind = TechniqueKind::new("mine", "", |_| {
        Ok(Box::new(TestTechnique { name: "mine", wgsl: LIT, ..TestTechnique::default() }))
    });
    let error = refused_kind(kind.with_settings::<crate::PcssSettings>());
    assert!(error.contains("its settings are named `pcss`"), "{error}");
}

#[test]
fn settings_of_techniques_are_checked_with_the_others() {
    let techniques = Techniques::built_in();
    let error = |text: &str| {
        let settings: ShadowSettings = ron::from_str(text).unwrap();
        techniques.check(&settings).map_err(|error| error.to_string()).unwrap_err()
    };
    assert!(error("(distance_m: 0.0)").starts_with("invalid value: `distance_m`"));
    let out_of_range = error(r#"(techniques: {"pcss": (filter_taps: 0)})"#);
    assert!(out_of_range.contains("`techniques.pcss.filter_taps` is 0"), "{out_of_range}");
    assert!(error(r#"(techniques: {"contact": (max_steps: 999)})"#).contains("1 to 256"));
    assert!(error(r#"(techniques: {"none": ()})"#).contains("it has no settings"));
    assert!(error(r#"(techniques: {"soft": ()})"#).starts_with("unknown technique `soft`"));
    let kind = error(r#"(techniques: {"pcss": (filter_taps: 2.5)})"#);
    assert!(
        kind.starts_with("settings of technique `pcss`: ")
            && kind.ends_with("(line 1, column 16 of them)")
            && kind.lines().count() == 1,
        "{kind}"
    );
}
