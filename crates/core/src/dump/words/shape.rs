//! Shapes, sizes, values and lists in few words.

use crate::access::ClearValue;
use crate::desc::ResourceDesc;
use crate::plan::ResourcePlan;
use std::fmt::Write as _;
use wgpu_types::TextureDimension;

/// Bytes in the unit that suits them.
pub(in crate::dump) fn bytes(bytes: u64) -> String {
    match bytes {
        0..1_024 => format!("{bytes} B"),
        1_024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1_024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

/// Shape in a few words: `1280x720 Rgba16Float`.
pub(in crate::dump) fn shape(desc: &ResourceDesc) -> String {
    let ResourceDesc::Texture(desc) = desc else { return "buffer".into() };
    let mut words = format!("{}x{}", desc.size.width, desc.size.height);
    let deep = desc.dimension == TextureDimension::D3;
    if desc.size.depth_or_array_layers > 1 || deep {
        let _ = write!(words, "x{}", desc.size.depth_or_array_layers);
    }
    let _ = write!(words, " {:?}", desc.format);
    for (count, unit) in [(desc.samples, "samples"), (desc.mip_levels, "mips")] {
        if count > 1 {
            let _ = write!(words, ", {count} {unit}");
        }
    }
    if deep { words + ", 3D" } else { words }
}

/// Usages in short words, in the order of wgpu's flags.
pub(in crate::dump) fn usage(resource: &ResourcePlan<'_>) -> String {
    match resource.desc {
        ResourceDesc::Texture(_) => {
            let names = resource.texture_usage.iter_names().map(|(name, _)| name);
            names.map(short).collect::<Vec<_>>().join(" ")
        }
        ResourceDesc::Buffer(_) => {
            let names = resource.buffer_usage.iter_names().map(|(name, _)| name);
            names.map(short).collect::<Vec<_>>().join(" ")
        }
    }
}

fn short(flag: &str) -> String {
    match flag {
        "TEXTURE_BINDING" => "sampled".into(),
        "STORAGE_BINDING" => "storage".into(),
        "RENDER_ATTACHMENT" => "attached".into(),
        "TRANSIENT_ATTACHMENT" => "transient".into(),
        other => other.to_lowercase().replace('_', "-"),
    }
}

/// When a resource is in use: `step 3`, `steps 0 to 2`.
pub(in crate::dump) fn steps(resource: &ResourcePlan<'_>) -> String {
    match resource.steps {
        None => "not used".into(),
        Some((first, last)) if first == last => format!("step {first}"),
        Some((first, last)) => format!("steps {first} to {last}"),
    }
}

/// A clear in words: `clear 0`, `clear 0,0,0,1`.
pub(in crate::dump) fn clear(value: ClearValue) -> String {
    match value {
        ClearValue::Color(rgba) if rgba == [rgba[0]; 4] => format!("clear {}", number(rgba[0])),
        ClearValue::Color(rgba) => format!("clear {}", rgba.map(number).join(",")),
        ClearValue::Depth(depth) => format!("clear {}", number(depth.into())),
        ClearValue::DepthStencil(depth, stencil) => format!("clear {}/{stencil}", number(depth.into())),
    }
}

/// A number with at most three decimals, and more only where it would else be lost.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(text, "0" | "-0") && value != 0.0 { format!("{value:e}") } else { text.into() }
}

pub(in crate::dump) fn quoted(name: &str) -> String {
    format!("`{name}`")
}

/// Names, at least the first and as many more as fit: `` `a`, `b` and 3 more ``.
pub(in crate::dump) fn list(names: &[String], columns: usize) -> String {
    let shown = |count: usize| {
        let mut words = names[..count].to_vec();
        if count < names.len() {
            words.push(format!("{} more", names.len() - count));
        }
        match words.pop() {
            Some(last) if !words.is_empty() => format!("{} and {last}", words.join(", ")),
            last => last.unwrap_or_default(),
        }
    };
    let fits = |words: &String| words.chars().count() <= columns;
    let mut from_most = (1..=names.len()).rev().map(shown);
    from_most.find(fits).unwrap_or_else(|| shown(names.len().min(1)))
}

/// Cuts `text` to `columns` characters, the last one an ellipsis.
pub(in crate::dump) fn clip(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.into();
    }
    let mut cut: String = text.chars().take(columns.saturating_sub(1)).collect();
    cut.push('…');
    cut
}
