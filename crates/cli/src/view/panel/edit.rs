//! A form for any settings: what their fields are follows from their values, and what they may be from their checks.

use egui::{CollapsingHeader, ComboBox, DragValue, Label, RichText, Ui};
use serde_json::Value;

use crate::limits::{Check, Limit, Limits};

/// Shows a form for all fields, and tells whether one was changed.
pub(super) fn edit(ui: &mut Ui, root: &mut Value, limits: &mut Limits, check: Check<'_>) -> bool {
    let names: Vec<String> =
        root.as_object().map(|fields| fields.keys().cloned().collect()).unwrap_or_default();
    let mut form = Form { root, limits, check, changed: false };
    for name in names {
        form.field(ui, &name, &format!("/{name}"));
    }
    form.changed
}

struct Form<'f> {
    root: &'f mut Value,
    limits: &'f mut Limits,
    check: Check<'f>,
    changed: bool,
}

impl Form<'_> {
    fn field(&mut self, ui: &mut Ui, name: &str, path: &str) {
        let Some(value) = self.root.pointer(path).cloned() else { return };
        let limit = self.limits.of(self.root, path, self.check).clone();
        match value {
            Value::Object(_) if limit.variants.is_empty() => self.group(ui, name, path),
            Value::Array(items) if items.iter().any(|item| !item.is_number()) => {
                ui.weak(format!("{name}: {} entries, changed in a settings file", items.len()));
            }
            Value::Array(items) => self.numbers(ui, name, path, &items),
            value => {
                ui.horizontal(|ui| {
                    ui.label(name).on_hover_text(&limit.allowed);
                    self.leaf(ui, path, value, &limit);
                });
            }
        }
    }

    fn group(&mut self, ui: &mut Ui, name: &str, path: &str) {
        let fields = self.root.pointer(path).and_then(Value::as_object);
        let names: Vec<String> = fields.map(|fields| fields.keys().cloned().collect()).unwrap_or_default();
        CollapsingHeader::new(name).id_salt(path).default_open(true).show(ui, |ui| {
            for name in names {
                self.field(ui, &name, &format!("{path}/{name}"));
            }
        });
    }

    fn leaf(&mut self, ui: &mut Ui, path: &str, value: Value, limit: &Limit) {
        match value {
            Value::Bool(mut on) => {
                if ui.checkbox(&mut on, "").changed() {
                    self.set(path, on.into());
                }
            }
            Value::Number(number) => {
                let mut number = number.as_f64().unwrap_or_default();
                if drag(ui, &mut number, limit) {
                    self.set(path, if limit.whole { (number as i64).into() } else { number.into() });
                }
                ui.add(Label::new(RichText::new(&limit.allowed).weak()).truncate());
            }
            Value::String(_) | Value::Object(_) => self.variant(ui, path, &value, limit),
            Value::Null => {
                if ui.small_button("set").clicked() {
                    self.set_to_any(path);
                }
            }
            Value::Array(_) => {}
        }
    }

    /// A choice of names, and the numbers that belong to the one that is chosen.
    fn variant(&mut self, ui: &mut Ui, path: &str, value: &Value, limit: &Limit) {
        let (name, payload) = match value {
            Value::String(name) => (name.clone(), None),
            Value::Object(fields) => match fields.iter().next() {
                Some((name, payload)) => (name.clone(), Some(payload.clone())),
                None => return,
            },
            _ => return,
        };
        let mut chosen = None;
        ComboBox::from_id_salt(path).selected_text(&name).show_ui(ui, |ui| {
            for (other, value) in &limit.variants {
                if ui.selectable_label(*other == name, other).clicked() {
                    chosen = Some(value.clone());
                }
            }
        });
        if let Some(value) = chosen {
            return self.set(path, value);
        }
        let path = format!("{path}/{name}");
        match payload {
            Some(Value::Number(_)) => self.field(ui, "", &path),
            Some(Value::Array(items)) => self.numbers(ui, "", &path, &items),
            Some(Value::Object(fields)) => {
                for field in fields.keys() {
                    self.field(ui, field, &format!("{path}/{field}"));
                }
            }
            _ => {}
        }
    }

    fn numbers(&mut self, ui: &mut Ui, name: &str, path: &str, items: &[Value]) {
        ui.horizontal_wrapped(|ui| {
            ui.label(name);
            for (index, item) in items.iter().enumerate() {
                let path = format!("{path}/{index}");
                let limit = self.limits.of(self.root, &path, self.check).clone();
                let mut number = item.as_f64().unwrap_or_default();
                if drag(ui, &mut number, &limit) {
                    self.set(&path, number.into());
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

    /// Puts the first value that is taken where there is none.
    fn set_to_any(&mut self, path: &str) {
        for value in [Value::from(1.0), 0.5.into(), 1.into(), true.into()] {
            let mut tried = self.root.clone();
            if let Some(place) = tried.pointer_mut(path) {
                *place = value.clone();
            }
            if (self.check)(&tried).is_ok() {
                return self.set(path, value);
            }
        }
    }
}

fn drag(ui: &mut Ui, number: &mut f64, limit: &Limit) -> bool {
    let (low, high) = limit.range.unwrap_or((f64::MIN, f64::MAX));
    // A part of the range, or of the number where that is wide.
    let reach = (high - low).min(number.abs().max(0.01) * 10.0);
    let speed = if limit.whole { 0.05 } else { reach * 0.002 };
    let drag = DragValue::new(number).range(low..=high).speed(speed);
    let drag = if limit.whole { drag.fixed_decimals(0) } else { drag.max_decimals(5) };
    ui.add(drag).changed()
}
