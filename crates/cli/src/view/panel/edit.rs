//! A form for any settings, made from their descriptions.

use egui::{CollapsingHeader, ComboBox, DragValue, Label, RichText, Ui};
use serde_json::Value;

use shadowgraph::shadows::{Payload, Setting, SettingType, Variant};

/// Checks settings; an error says what is wrong.
pub(super) type Check<'c> = &'c dyn Fn(&Value) -> Result<(), String>;

/// Shows a form for all fields of `root`, and returns whether one was changed.
pub(super) fn edit(ui: &mut Ui, root: &mut Value, settings: &[Setting], check: Check<'_>) -> bool {
    let mut form = Form { root, check, changed: false };
    for setting in settings {
        form.field(ui, setting, &format!("/{}", setting.name));
    }
    form.changed
}

struct Form<'f> {
    root: &'f mut Value,
    check: Check<'f>,
    changed: bool,
}

impl Form<'_> {
    fn field(&mut self, ui: &mut Ui, setting: &Setting, path: &str) {
        let Some(value) = self.root.pointer(path).cloned() else { return };
        match (setting.ty, &value) {
            (SettingType::Struct(fields), _) => self.group(ui, setting, fields, path),
            (SettingType::List(_, SettingType::Number(..)), Value::Array(items)) => {
                self.numbers(ui, setting, path, items);
            }
            (SettingType::List(..), Value::Array(items)) => {
                ui.weak(format!("{}: {} entries, edited in a settings file", setting.name, items.len()));
            }
            (SettingType::Other(..), _) => {}
            _ => {
                ui.horizontal(|ui| {
                    let label = ui.label(setting.name);
                    label.on_hover_text(format!("{}\n{}", setting.about, setting.allowed()));
                    self.leaf(ui, setting, path, &value);
                });
            }
        }
    }

    fn group(&mut self, ui: &mut Ui, setting: &Setting, fields: &[Setting], path: &str) {
        CollapsingHeader::new(setting.name).id_salt(path).default_open(true).show(ui, |ui| {
            for field in fields {
                self.field(ui, field, &format!("{path}/{}", field.name));
            }
        });
    }

    fn leaf(&mut self, ui: &mut Ui, setting: &Setting, path: &str, value: &Value) {
        match setting.ty {
            SettingType::Toggle(_) => {
                let mut on = value.as_bool().unwrap_or_default();
                if ui.checkbox(&mut on, "").changed() {
                    self.set(path, on.into());
                }
            }
            SettingType::Integer(..) | SettingType::PowerOfTwo(..) | SettingType::Number(..) => {
                let mut number = value.as_f64().unwrap_or_default();
                if drag(ui, &mut number, setting.ty) {
                    let whole = !matches!(setting.ty, SettingType::Number(..));
                    self.set(path, if whole { (number as i64).into() } else { number.into() });
                }
                ui.add(Label::new(RichText::new(setting.allowed()).weak()).truncate());
            }
            SettingType::Enum(_, variants) => self.variant(ui, variants, path, value),
            SettingType::Optional(inner) => {
                if !value.is_null() {
                    self.leaf(ui, &Setting { ty: *inner, ..*setting }, path, value);
                } else if ui.small_button("set").clicked() {
                    self.set(path, inner.default_value());
                }
            }
            _ => {}
        }
    }

    /// A choice of variants, and the values that the chosen one carries.
    fn variant(&mut self, ui: &mut Ui, variants: &'static [Variant], path: &str, value: &Value) {
        let is_chosen = |variant: &&Variant| match variant.payload {
            Payload::Empty => value.as_str() == Some(variant.name),
            _ => value.get(variant.name).is_some(),
        };
        let Some(current) = variants.iter().find(is_chosen) else { return };
        let mut chosen = None;
        ComboBox::from_id_salt(path).selected_text(current.name).show_ui(ui, |ui| {
            for variant in variants {
                let label = ui.selectable_label(variant.name == current.name, variant.name);
                if label.on_hover_text(variant.about).clicked() {
                    chosen = Some(variant);
                }
            }
        });
        if let Some(value) = chosen.and_then(|variant| self.example(path, variant)) {
            return self.set(path, value);
        }
        let path = format!("{path}/{}", current.name);
        match current.payload {
            Payload::Empty => {}
            Payload::Value(setting) => self.field(ui, setting, &path),
            Payload::Fields(fields) => {
                for field in fields {
                    self.field(ui, field, &format!("{path}/{}", field.name));
                }
            }
        }
    }

    /// The first example of a variant that is valid with the other settings. A list may need another length.
    fn example(&self, path: &str, variant: &Variant) -> Option<Value> {
        examples(variant).find(|value| {
            let mut tried = self.root.clone();
            let place = tried.pointer_mut(path).map(|place| *place = value.clone());
            place.is_some() && (self.check)(&tried).is_ok()
        })
    }

    fn numbers(&mut self, ui: &mut Ui, setting: &Setting, path: &str, items: &[Value]) {
        let SettingType::List(_, item) = setting.ty else { return };
        ui.horizontal_wrapped(|ui| {
            ui.label(setting.name).on_hover_text(setting.allowed());
            for (index, value) in items.iter().enumerate() {
                let mut number = value.as_f64().unwrap_or_default();
                if drag(ui, &mut number, *item) {
                    self.set(&format!("{path}/{index}"), number.into());
                }
            }
            let set = |form: &mut Self, items: Vec<Value>| form.set(path, Value::Array(items));
            if ui.small_button("+").clicked() {
                let next = items.last().cloned().unwrap_or_else(|| 1.0.into());
                set(self, [items, &[next]].concat());
            }
            if !items.is_empty() && ui.small_button("−").clicked() {
                set(self, items[..items.len() - 1].to_vec());
            }
        });
    }

    fn set(&mut self, path: &str, value: Value) {
        if let Some(place) = self.root.pointer_mut(path) {
            *place = value;
            self.changed = true;
        }
    }
}

/// Examples of a variant: its default, and for a list of numbers also rising lists of other lengths.
pub(super) fn examples(variant: &Variant) -> impl Iterator<Item = Value> {
    let high = match variant.payload {
        Payload::Value(Setting { ty: SettingType::List(_, SettingType::Number(_, _, high)), .. }) => {
            Some(*high)
        }
        _ => None,
    };
    let name = variant.name;
    let lists = high.into_iter().flat_map(move |high| {
        // Ends of cascades in metres are of no use as parts of a million.
        let high = high.min(100.0);
        (0..8).map(move |count| {
            let ends: Vec<f64> = (1..=count).map(|i| high * f64::from(i) / f64::from(count + 1)).collect();
            serde_json::json!({ name: ends })
        })
    });
    std::iter::once(variant.example()).chain(lists)
}

/// Shows a number that is kept within its range.
fn drag(ui: &mut Ui, number: &mut f64, ty: SettingType) -> bool {
    let (low, high, whole) = match ty {
        SettingType::Number(_, low, high) => (low, high, false),
        SettingType::Integer(_, low, high) | SettingType::PowerOfTwo(_, low, high) => {
            (low as f64, high as f64, true)
        }
        _ => (f64::MIN, f64::MAX, false),
    };
    if let SettingType::PowerOfTwo(..) = ty {
        return powers_of_two(ui, number, low, high);
    }
    // A part of the range, or of the number if the range is wide.
    let reach = (high - low).min(number.abs().max(0.01) * 10.0);
    let speed = if whole { 0.05 } else { reach * 0.002 };
    let drag = DragValue::new(number).range(low..=high).speed(speed);
    let drag = if whole { drag.fixed_decimals(0) } else { drag.max_decimals(5) };
    ui.add(drag).changed()
}

/// Shows a number with buttons that halve and double it.
fn powers_of_two(ui: &mut Ui, number: &mut f64, low: f64, high: f64) -> bool {
    let before = *number;
    ui.label(format!("{number}"));
    if ui.small_button("−").clicked() {
        *number = (*number / 2.0).max(low);
    }
    if ui.small_button("+").clicked() {
        *number = (*number * 2.0).min(high);
    }
    *number != before
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::super::settings::{check_shared, shared};
    use super::*;
    use shadowgraph::shadows::{CascadeSettings, ShadowSettings, SplitScheme};

    #[test]
    fn the_window_can_switch_from_each_variant_to_each_other_with_any_number_of_cascades() {
        for count in 1..=8 {
            let settings = ShadowSettings {
                cascades: CascadeSettings {
                    count,
                    split: SplitScheme::Standard,
                    ..CascadeSettings::default()
                },
                ..ShadowSettings::default()
            };
            let mut root = shared(&settings).unwrap();
            let form = Form { root: &mut root, check: &check_shared, changed: false };
            for variant in SplitScheme::VARIANTS {
                let value = form.example("/cascades/split", variant);
                assert!(value.is_some(), "{} with {count} cascades", variant.name);
            }
        }
    }
}
