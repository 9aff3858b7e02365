//! Every setting, live.

use std::collections::BTreeMap;

use egui::{CollapsingHeader, Ui};
use serde_json::Value;

use super::super::stage::Stage;
use super::Wish;
use super::edit::edit;
use crate::limits::{Limits, check_own, check_shared, shared};
use shadowgraph::shadows::ShadowSettings;

#[derive(Default)]
pub(super) struct SettingsPanel {
    /// By technique; that of all is empty.
    limits: BTreeMap<&'static str, Limits>,
}

impl SettingsPanel {
    pub(super) fn show(&mut self, ui: &mut Ui, stage: &mut Stage) -> Option<Wish> {
        let mut wish = None;
        ui.horizontal(|ui| {
            if ui.button("Save").clicked() {
                wish = Some(Wish::SaveSettings);
            }
            if ui.button("Defaults").clicked() {
                let distance_m = stage.settings.distance_m;
                stage.settings = ShadowSettings { distance_m, ..ShadowSettings::default() };
            }
        });
        ui.label(&stage.note);
        CollapsingHeader::new("Shadow maps").default_open(true).show(ui, |ui| self.shared(ui, stage));
        let names: Vec<&'static str> = stage.registry.techniques.with_settings().collect();
        for name in names {
            let used = stage.technique.name().split('+').any(|part| part == name);
            CollapsingHeader::new(name).default_open(used).show(ui, |ui| self.own(ui, stage, name));
        }
        wish
    }

    fn shared(&mut self, ui: &mut Ui, stage: &mut Stage) {
        let Ok(mut value) = shared(&stage.settings) else { return };
        let limits = self.limits.entry("").or_default();
        if edit(ui, &mut value, limits, &check_shared)
            && let Ok(read) = serde_json::from_value::<ShadowSettings>(value)
            && read.validate().is_ok()
        {
            let techniques = std::mem::take(&mut stage.settings.techniques);
            stage.settings = ShadowSettings { techniques, ..read };
        }
    }

    fn own(&mut self, ui: &mut Ui, stage: &mut Stage, name: &'static str) {
        let Some(Ok(mut value)) = stage.registry.techniques.own_settings(name, &stage.settings) else {
            return;
        };
        let (techniques, settings) = (&stage.registry.techniques, &stage.settings);
        let check = |value: &Value| check_own(techniques, name, settings, value);
        if edit(ui, &mut value, self.limits.entry(name).or_default(), &check) {
            // What is out of range stays as it was.
            let _refused = stage.registry.techniques.set_own_settings(name, &mut stage.settings, value);
        }
    }
}
