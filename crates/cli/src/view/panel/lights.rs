//! Settings of single lights.

use egui::{CollapsingHeader, Ui};
use serde_json::Value;

use super::super::stage::Stage;
use super::edit::edit;
use shadowgraph::scene::Light;
use shadowgraph::shadows::{LightRef, LightShadows, ShadowSettings};

/// Shows the settings of each light of the scene.
pub(super) fn show(ui: &mut Ui, stage: &mut Stage) {
    let lights = stage.scene.lights().to_vec();
    for (index, light) in lights.iter().enumerate() {
        let name = light.name.as_deref().unwrap_or("light");
        CollapsingHeader::new(format!("{index}: {name}")).id_salt(("light", index)).show(ui, |ui| {
            let entry = entry(&stage.settings, &lights, index);
            let mut has_own = entry.is_some();
            if ui.checkbox(&mut has_own, "its own settings").changed() {
                set_own(&mut stage.settings, entry, index, has_own);
            }
            if let Some(entry) = entry.filter(|_| has_own) {
                edit_light(ui, &mut stage.settings, entry);
            }
        });
    }
}

/// Returns the index of a light's entry in the settings.
fn entry(settings: &ShadowSettings, lights: &[Light], index: usize) -> Option<usize> {
    settings.lights.iter().position(|own| match &own.light {
        LightRef::Index(number) => *number as usize == index,
        LightRef::Name(name) => {
            lights.iter().position(|light| light.name.as_ref() == Some(name)) == Some(index)
        }
    })
}

/// Adds or removes the entry of a light.
fn set_own(settings: &mut ShadowSettings, entry: Option<usize>, index: usize, has_own: bool) {
    match entry {
        Some(entry) if !has_own => drop(settings.lights.remove(entry)),
        None if has_own => settings.lights.push(LightShadows::new(LightRef::Index(index as u32))),
        _ => {}
    }
}

fn edit_light(ui: &mut Ui, settings: &mut ShadowSettings, entry: usize) {
    let Ok(mut value) = serde_json::to_value(&settings.lights[entry]) else { return };
    let check = |value: &Value| {
        let read: LightShadows = serde_json::from_value(value.clone()).map_err(|error| error.to_string())?;
        let tried = ShadowSettings { lights: vec![read], ..ShadowSettings::default() };
        tried.validate().map_err(|error| error.to_string())
    };
    if edit(ui, &mut value, LightShadows::SETTINGS, &check)
        && check(&value).is_ok()
        && let Ok(read) = serde_json::from_value(value)
    {
        settings.lights[entry] = read;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowgraph::glam::DVec3;

    #[test]
    fn row_43_each_light_may_have_its_own_settings() {
        let lights =
            ["sun", "lamp"].map(|name| Light { name: Some(name.into()), ..Light::sun(DVec3::NEG_Y, 1.0) });
        let mut settings =
            ShadowSettings { lights: vec![LightShadows::new("lamp".into())], ..ShadowSettings::default() };
        assert_eq!([0, 1].map(|index| entry(&settings, &lights, index)), [None, Some(0)]);
        set_own(&mut settings, None, 0, true);
        assert_eq!([0, 1].map(|index| entry(&settings, &lights, index)), [Some(1), Some(0)]);
        set_own(&mut settings, Some(0), 1, false);
        assert_eq!([0, 1].map(|index| entry(&settings, &lights, index)), [Some(0), None]);
    }
}
