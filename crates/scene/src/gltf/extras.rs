//! Shadow modes in the `extras` of materials and nodes.

use ::gltf::json::Extras;
use serde::Deserialize;
use serde_json::Value;

use super::document::Document;
use super::error::describe;
use super::notes::Notes;
use crate::material::Material;
use crate::scene::{Instance, MaterialCasts, ObjectShadows, ShadowCasting};

/// The entries of `extras` that are read. Everything else in it belongs to other programs.
#[derive(Default, Deserialize)]
#[serde(default)]
struct ShadowExtras {
    shadow_casts: Value,
    shadow_cutoff: Value,
    shadow_receives: Value,
}

impl ShadowExtras {
    fn read(extras: &Extras) -> Self {
        extras.as_ref().and_then(|json| serde_json::from_str(json.get()).ok()).unwrap_or_default()
    }

    /// Returns whether it receives shadows. Exporters write toggles as numbers, too.
    fn receives(&self) -> Result<Option<bool>, String> {
        match (&self.shadow_receives, self.shadow_receives.as_f64()) {
            (Value::Null, _) => Ok(None),
            (Value::Bool(receives), _) => Ok(Some(*receives)),
            (_, Some(number)) if number == 0.0 || number == 1.0 => Ok(Some(number == 1.0)),
            (other, _) => Err(ignored("shadow_receives", other, "true, false")),
        }
    }

    fn cutoff(&self) -> Result<Option<f32>, String> {
        match self.shadow_cutoff.as_f64() {
            _ if self.shadow_cutoff.is_null() => Ok(None),
            Some(cutoff) if (0.0..=1.0).contains(&cutoff) => Ok(Some(cutoff as f32)),
            _ => Err(ignored("shadow_cutoff", &self.shadow_cutoff, "0 to 1")),
        }
    }

    /// Returns one of the named values.
    fn casts<T: Copy>(&self, modes: &[(&str, T)]) -> Result<Option<T>, String> {
        if self.shadow_casts.is_null() {
            return Ok(None);
        }
        let name = match &self.shadow_casts {
            Value::Bool(true) => "on",
            Value::Bool(false) => "off",
            other => other.as_str().unwrap_or_default(),
        };
        let known = modes.iter().find(|(known, _)| name.eq_ignore_ascii_case(known));
        let names = || modes.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        known
            .map(|(_, mode)| Some(*mode))
            .ok_or_else(|| ignored("shadow_casts", &self.shadow_casts, &names()))
    }
}

/// Returns the note on a value that is not allowed.
fn ignored(name: &str, value: &Value, allowed: &str) -> String {
    let text: String = value.to_string().chars().take(40).collect();
    format!("extras {name} {text} is ignored (allowed: {allowed})")
}

/// Gives a material the modes of its extras; adds a note for each value that is not allowed.
pub(super) fn apply_to_material(extras: &Extras, material: &mut Material, location: &str, notes: &mut Notes) {
    let extras = ShadowExtras::read(extras);
    let mut noted = |reason: String| notes.add(location, reason);
    let modes = [
        ("on", MaterialCasts::On),
        ("clip", MaterialCasts::Clip(material.caster_cutoff())),
        ("dither", MaterialCasts::Dither),
        ("tint", MaterialCasts::Tint),
        ("off", MaterialCasts::Off),
    ];
    if let Some(casts) = extras.casts(&modes).map_err(&mut noted).unwrap_or_default() {
        casts.apply_to(material);
    }
    let cutoff = extras.cutoff().map_err(&mut noted).unwrap_or_default();
    material.shadow_cutoff = cutoff.or(material.shadow_cutoff);
    let receives = extras.receives().map_err(&mut noted).unwrap_or_default();
    material.receives_shadows = receives.unwrap_or(material.receives_shadows);
}

/// Returns the modes in the extras of each node; adds a note for each value that is not allowed.
pub(super) fn of_nodes(document: &Document, notes: &mut Notes) -> Vec<ObjectShadows> {
    let modes = [("on", ShadowCasting::On), ("only", ShadowCasting::ShadowOnly), ("off", ShadowCasting::Off)];
    let read = |(i, node): (usize, &::gltf::json::Node)| {
        let extras = ShadowExtras::read(&node.extras);
        let mut noted = |reason: String| notes.add(describe("node", i, node.name.as_deref()), reason);
        let casts = extras.casts(&modes).map_err(&mut noted).unwrap_or_default();
        let receives = extras.receives().map_err(&mut noted).unwrap_or_default();
        ObjectShadows { casts, receives }
    };
    document.nodes.iter().enumerate().map(read).collect()
}

/// Gives an instance the modes of its node.
pub(super) fn apply_to_instance(shadows: Option<&ObjectShadows>, instance: Instance) -> Instance {
    let Some(shadows) = shadows else { return instance };
    Instance {
        casts: shadows.casts.unwrap_or(instance.casts),
        receives_shadows: shadows.receives.unwrap_or(instance.receives_shadows),
        ..instance
    }
}
