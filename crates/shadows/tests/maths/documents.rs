//! The tables of settings in the documents.

use std::path::Path;

use shadowgraph_shadows::{
    BudgetConfig, LightShadows, QualityLevel, ShadowSettings, Techniques, settings_file,
};

/// The files with all settings in `docs/shadows.md`, written from the descriptions.
fn documented() -> String {
    let all = settings_file(ShadowSettings::SETTINGS, 1);
    let light = settings_file(LightShadows::SETTINGS, 3);
    let techniques = Techniques::built_in();
    let mut own = String::new();
    for name in techniques.with_settings() {
        let fields = settings_file(techniques.describe_settings(name), 3);
        own += &format!("        \"{name}\": (\n{fields}        ),\n");
    }
    let [budget, levels] = BudgetConfig::SETTINGS else { panic!("{:?}", BudgetConfig::SETTINGS) };
    let budget = settings_file(std::slice::from_ref(budget), 1);
    let levels = format!("    levels: [ // {}\n", levels.allowed());
    let level = settings_file(QualityLevel::SETTINGS, 3);
    format!(
        "Every field with its default. An empty struct, `()`, means the same.\n\n\
         ```ron\n(\n{all})\n```\n\n\
         In an entry of `lights`, every field but `light` can be left out:\n\n\
         ```ron\n(\n    lights: [\n        (\n{light}        ),\n    ],\n)\n```\n\n\
         The settings of techniques and modifiers, in `techniques`:\n\n\
         ```ron\n(\n    techniques: {{\n{own}    }},\n)\n```\n\n\
         A time budget (`BudgetConfig`, row 28), which code can read from RON:\n\n\
         ```ron budget\n(\n{budget}{levels}        (\n{level}        ),\n    ],\n)\n```\n"
    )
}

/// `UPDATE_GOLDEN=1` writes the page.
#[test]
fn the_documents_list_all_settings_as_they_are_declared() {
    const BEGIN: &str = "<!-- written by the tests: UPDATE_GOLDEN=1 cargo test -p shadowgraph-shadows the_documents_list -->\n\n";
    const END: &str = "\n<!-- end of what the tests write -->";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/shadows.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once(BEGIN).unwrap();
    let (written, after) = rest.split_once(END).unwrap();
    let expected = documented();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, [before, BEGIN, &expected, END, after].concat()).unwrap();
    } else {
        assert_eq!(written, expected, "UPDATE_GOLDEN=1 writes the page");
    }
}
