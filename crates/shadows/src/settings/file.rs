//! Settings files with all settings, for documents.

use std::fmt::Write as _;

use super::describe::{Setting, SettingType};

/// Returns the fields of a struct as a RON file has them: one in a line, each with its default, and what is allowed as a comment.
/// `indent` is the number of levels around them.
pub fn settings_file(settings: &[Setting], indent: usize) -> String {
    let mut out = String::new();
    write_fields(&mut out, settings, indent);
    out
}

fn write_fields(out: &mut String, settings: &[Setting], indent: usize) {
    let lines: Vec<(&Setting, String)> = settings
        .iter()
        .map(|setting| {
            let value = match setting.ty {
                SettingType::Struct(_) => "(".to_owned(),
                SettingType::Other(None, _) => "\"name\"".to_owned(),
                SettingType::Other(Some(_), _) => "{}".to_owned(),
                ty => ty.ron(&ty.default_value()),
            };
            (setting, format!("{}: {value}", setting.name))
        })
        .collect();
    let scalar = |setting: &Setting| !matches!(setting.ty, SettingType::Struct(_));
    let widths = lines.iter().filter(|(setting, _)| scalar(setting)).map(|(_, line)| line.len() + 1);
    let width = widths.filter(|width| *width <= 32).max().unwrap_or_default();
    let margin = "    ".repeat(indent);
    for (setting, line) in lines {
        match setting.ty {
            SettingType::Struct(fields) => {
                let _ = writeln!(out, "{margin}{line}");
                write_fields(out, fields, indent + 1);
                let _ = writeln!(out, "{margin}),");
            }
            _ => {
                let _ = writeln!(out, "{margin}{:<width$} // {}", line + ",", comment(setting));
            }
        }
    }
}

/// Describes a setting in one line: what is allowed and what it does.
fn comment(setting: &Setting) -> String {
    let about = first_sentence(setting.about);
    match setting.ty {
        SettingType::Toggle(_) => about.to_owned(),
        _ => format!("{}. {about}", setting.allowed()),
    }
}

/// The first sentence of a description, without its full stop.
fn first_sentence(about: &str) -> &str {
    about.split(". ").next().unwrap_or_default().trim_end_matches('.')
}
