//! Every setting, live.

use egui::{CollapsingHeader, Ui};
use serde_json::Value;

use super::super::stage::Stage;
use super::Action;
use super::edit::edit;
use super::{lights, split_bar};
use shadowgraph::shadows::{ShadowSettings, TechniqueSettings, Techniques};

#[derive(Default)]
pub(super) struct SettingsPanel;

impl SettingsPanel {
    pub(super) fn show(&mut self, ui: &mut Ui, stage: &mut Stage) -> Option<Action> {
        let mut action = None;
        ui.horizontal(|ui| {
            if ui.button("Save").clicked() {
                action = Some(Action::SaveSettings);
            }
            if ui.button("Defaults").clicked() {
                let distance_m = stage.settings.distance_m;
                stage.settings = ShadowSettings { distance_m, ..ShadowSettings::default() };
            }
        });
        ui.label(&stage.note);
        CollapsingHeader::new("Lights").show(ui, |ui| lights::show(ui, stage));
        CollapsingHeader::new("Shadow maps").default_open(true).show(ui, |ui| {
            ui.label("ends of the cascades, metres").on_hover_text("Drag a border to move it");
            let (near_m, far_m) = (stage.fly.camera().near(), f64::from(stage.settings.distance_m));
            split_bar::show(ui, &mut stage.settings.cascades, near_m, far_m);
            edit_shared(ui, stage);
        });
        let names: Vec<&'static str> = stage.registry.techniques.with_settings().collect();
        for name in names {
            let used = stage.technique.name().split('+').any(|part| part == name);
            CollapsingHeader::new(name).default_open(used).show(ui, |ui| edit_technique(ui, stage, name));
        }
        action
    }
}

/// Shows the settings that all techniques share.
fn edit_shared(ui: &mut Ui, stage: &mut Stage) {
    let Ok(mut value) = shared(&stage.settings) else { return };
    if edit(ui, &mut value, ShadowSettings::SETTINGS, &check_shared)
        && let Ok(read) = serde_json::from_value::<ShadowSettings>(value)
        && read.validate().is_ok()
    {
        // JSON has another type for techniques, and another order of names.
        let ShadowSettings { techniques, materials, objects, .. } = std::mem::take(&mut stage.settings);
        stage.settings = ShadowSettings { techniques, materials, objects, ..read };
    }
}

/// Shows the settings of one technique.
fn edit_technique(ui: &mut Ui, stage: &mut Stage, name: &'static str) {
    let Some(Ok(mut value)) = stage.registry.techniques.technique_settings(name, &stage.settings) else {
        return;
    };
    let (techniques, settings) = (&stage.registry.techniques, &stage.settings);
    let check = |value: &Value| check_technique(techniques, name, settings, value);
    if edit(ui, &mut value, techniques.describe_settings(name), &check) {
        // Values out of range are dropped.
        let _refused = stage.registry.techniques.set_technique_settings(name, &mut stage.settings, value);
    }
}

/// Returns the settings that all techniques share as JSON.
pub(super) fn shared(settings: &ShadowSettings) -> Result<Value, serde_json::Error> {
    let settings = ShadowSettings { techniques: TechniqueSettings::default(), ..settings.clone() };
    let mut value = serde_json::to_value(settings)?;
    if let Some(fields) = value.as_object_mut() {
        fields.remove("techniques");
    }
    Ok(value)
}

/// Checks the settings that all techniques share.
pub(super) fn check_shared(value: &Value) -> Result<(), String> {
    let read: ShadowSettings = serde_json::from_value(value.clone()).map_err(|error| error.to_string())?;
    read.validate().map_err(|error| error.to_string())
}

/// Checks the settings of one technique.
fn check_technique(
    techniques: &Techniques,
    name: &str,
    settings: &ShadowSettings,
    value: &Value,
) -> Result<(), String> {
    let set = techniques.set_technique_settings(name, &mut settings.clone(), value.clone());
    set.map_err(|error| error.to_string())
}
