#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use super::*;
use crate::build_context::BuildContext;
use crate::error::Error;
use crate::render_view::RenderView;
use serde_json::json;
use shadowgraph_core::Frame;

/// Declares a kind of node that does nothing.
macro_rules! kind {
    ($name:ident, $text:literal, $inputs:expr, $outputs:expr, $settings:expr) => {
        struct $name;
        impl Node for $name {
            const NAME: &'static str = $text;
            const ABOUT: &'static str = "does nothing";
            const INPUTS: &'static [Port] = $inputs;
            const OUTPUTS: &'static [Port] = $outputs;
            const SETTINGS: &'static [Setting] = $settings;
            fn new(_context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
                Ok(Self)
            }
            fn add<'f>(
                &'f self,
                _frame: &mut Frame<'f>,
                _view: &'f RenderView<'f>,
                _ports: &mut Ports<'_, 'f>,
            ) -> Result<(), Error> {
                Ok(())
            }
        }
    };
}

kind!(Known, "tonemap", &[], &[], &[]);
kind!(TwoInputs, "a", &[Port::texture("x", ""), Port::texture("x", "")], &[], &[]);
kind!(TwoOutputs, "b", &[], &[Port::texture("x", ""), Port::texture("x", "")], &[]);
kind!(Default_, "c", &[], &[], &[Setting::new("n", SettingType::Integer(9, 0, 8), "")]);
kind!(PlaceholderBuffer, "d", &[Port::new("x", PortKind::Buffer, "").or_placeholder([0.0; 4])], &[], &[]);
kind!(
    Good,
    "e",
    &[Port::texture("x", "the source")],
    &[],
    &[Setting::new("n", SettingType::Integer(8, 0, 8), "how many")]
);

fn error<N: Node>() -> String {
    Nodes::built_in().register::<N>().unwrap_err().to_string()
}

#[test]
fn an_invalid_kind_is_refused() {
    assert!(error::<Known>().contains("a kind of this name is already registered"));
    assert!(error::<TwoInputs>().contains("duplicate input `x`"));
    assert!(error::<TwoOutputs>().contains("duplicate output `x`"));
    assert!(error::<Default_>().contains("invalid default: n is 9; allowed: 0 to 8"));
    assert!(error::<PlaceholderBuffer>().contains("only textures have placeholders"));
}

#[test]
fn a_kind_is_described_with_ports_ranges_and_defaults() {
    let mut nodes = Nodes::built_in();
    nodes.register::<Good>().unwrap();
    let text = nodes.describe("e").unwrap();
    assert!(text.contains("input    x") && text.contains("texture: the source"), "{text}");
    assert!(text.contains("8; 0 to 8: how many"), "{text}");
    assert!(nodes.describe("tonemapp").unwrap_err().to_string().ends_with("did you mean `tonemap`?"));
    assert!(nodes.describe("?").unwrap_err().to_string().contains("expected one of: view"));
}

#[test]
fn every_built_in_kind_is_valid_and_describes_everything() {
    let built_in = Nodes::built_in();
    assert_eq!(built_in.check_all(), Ok(()));
    for kind in built_in.kinds() {
        assert!(!kind.about.is_empty() && !kind.outputs.is_empty(), "{}", kind.name);
        let ports = kind.inputs.iter().chain(kind.outputs).map(|port| port.about);
        let phrases = ports.chain(kind.settings.iter().map(|setting| setting.about));
        assert!(phrases.into_iter().all(|about| !about.is_empty()), "{}", kind.name);
    }
}

#[test]
fn values_out_of_range_or_of_another_type_are_errors_with_what_is_allowed() {
    let check = |ty, value| Setting::new("n", ty, "").in_units("metres").check(&value);
    assert_eq!(check(SettingType::Toggle(true), json!(false)), Ok(()));
    assert!(check(SettingType::Toggle(true), json!(1)).unwrap_err().contains("true or false"));
    assert_eq!(check(SettingType::Number(0.5, 0.0, 1.0), json!(1)), Ok(()));
    let high = check(SettingType::Number(0.5, 0.0, 1.0), json!(1.5)).unwrap_err();
    assert_eq!(high, "n is 1.5; allowed: 0 to 1 (metres)");
    let text = check(SettingType::Number(0.5, 0.0, 1.0), json!("1")).unwrap_err();
    assert_eq!(text, "n is \"1\"; allowed: a number, 0 to 1 (metres)");
    let fraction = check(SettingType::Integer(1, 0, 4), json!(0.5)).unwrap_err();
    assert_eq!(fraction, "n is 0.5; allowed: an integer, 0 to 4 (metres)");
    assert!(check(SettingType::Choice("a", &["a", "b"]), json!("c")).unwrap_err().contains("one of a, b"));
    assert_eq!(check(SettingType::Text(""), json!("any")), Ok(()));
    assert_eq!(check(SettingType::Color([0.0; 3]), json!([1, 0.5, 0])), Ok(()));
    for wrong in [json!([1, 2]), json!([1, 2, 3, 4]), json!([1, 2, -1]), json!([1, 2, "3"]), json!("red")] {
        assert!(check(SettingType::Color([0.0; 3]), wrong).is_err());
    }
}

#[test]
fn reading_a_setting_that_is_not_declared_is_an_error_of_the_kind() {
    const RADIUS: Setting = Setting::new("radius", SettingType::Number(0.5, 0.0, 1.0), "");
    let settings = Settings::new("mine", vec![(&RADIUS, json!(0.5))]);
    assert_eq!(settings.number("radius").unwrap(), 0.5);
    for error in [settings.number("radios").unwrap_err(), settings.toggle("radius").unwrap_err()] {
        assert!(error.to_string().contains("invalid node kind `mine`"), "{error}");
    }
}

#[test]
fn scalars_are_written_in_their_order() {
    static SETTINGS: [Setting; 4] = [
        Setting::new("on", SettingType::Toggle(false), ""),
        Setting::new("curve", SettingType::Choice("a", &["a", "b"]), ""),
        Setting::new("steps", SettingType::Integer(8, -9, 9), ""),
        Setting::new("radius", SettingType::Number(0.5, 0.0, 9.0), ""),
    ];
    let values = [json!(true), json!("b"), json!(-1), json!(2)];
    let settings = Settings::new("mine", SETTINGS.iter().zip(values).collect());
    let expected = [1u32.to_ne_bytes(), u32::MAX.to_ne_bytes(), 2.0f32.to_ne_bytes()];
    assert_eq!(settings.scalars(), expected.concat());
}
