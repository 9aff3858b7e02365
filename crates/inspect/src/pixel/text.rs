//! The history of a pixel as text.

use std::fmt::Write as _;

use super::{PixelHistory, PixelPass, PixelTexel, PixelWrite, WriteEffect};

/// Layers and mip levels that are printed of one texture.
const MAX_TEXELS: usize = 8;

impl PixelHistory {
    /// Returns the history as text: the passes, the last one first, with what they wrote and read.
    #[must_use]
    pub fn to_text(&self) -> String {
        let ([x, y], [width, height]) = (self.place.pixel, self.place.size_px);
        let mut text = format!("pixel {x},{y} of `{}`, {width} x {height}\n", self.output);
        for pass in &self.passes {
            write_pass(&mut text, pass);
        }
        text
    }
}

fn write_pass(text: &mut String, pass: &PixelPass) {
    let _ = writeln!(text, "\n{}", pass.pass);
    for write in &pass.writes {
        let _ = writeln!(text, "  {}", described(write));
    }
    for read in pass.reads.iter().filter(|read| !read.texels.is_empty()) {
        let _ = writeln!(text, "  read {} v{}: {}", read.resource, read.version, values(&read.texels));
    }
    let others = pass.reads.iter().filter(|read| read.texels.is_empty());
    let others: Vec<_> = others.map(|read| format!("{} v{}", read.resource, read.version)).collect();
    if !others.is_empty() {
        let _ = writeln!(text, "  read, without a texel at the pixel: {}", others.join(", "));
    }
}

fn described(write: &PixelWrite) -> String {
    let PixelWrite { texture, version, effect, before, after } = write;
    match effect {
        WriteEffect::Elsewhere => format!("wrote {texture} v{version}, which has no texel at the pixel"),
        WriteEffect::Kept => format!("left {texture} v{version} as it was: {}", values(after)),
        WriteEffect::Cleared => format!("cleared {texture} v{version}: {}", values(after)),
        WriteEffect::Written if before.is_empty() => format!("wrote {texture} v{version}: {}", values(after)),
        WriteEffect::Written => {
            format!("wrote {texture} v{version}: {}, before {}", values(after), values(before))
        }
    }
}

fn values(texels: &[PixelTexel]) -> String {
    let several = texels.len() > 1;
    let mut parts: Vec<String> = texels.iter().take(MAX_TEXELS).map(|texel| value(texel, several)).collect();
    if texels.len() > MAX_TEXELS {
        parts.push(format!("{} more", texels.len() - MAX_TEXELS));
    }
    parts.join("; ")
}

fn value(texel: &PixelTexel, several: bool) -> String {
    let numbers = match &texel.problem {
        Some(problem) => problem.clone(),
        None => texel.value.iter().map(|&value| number(value)).collect::<Vec<_>>().join(" "),
    };
    let PixelTexel { mip, layer, is_stencil, .. } = texel;
    match (several, is_stencil) {
        (false, false) => numbers,
        (false, true) => format!("stencil {numbers}"),
        (true, true) => format!("stencil of layer {layer}: {numbers}"),
        (true, false) if *mip > 0 => format!("mip {mip}, layer {layer}: {numbers}"),
        (true, false) => format!("layer {layer}: {numbers}"),
    }
}

/// Writes a number with five significant digits.
fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if value.fract() == 0.0 && size < 1e6 => format!("{value}"),
        _ if !(1e-4..1e6).contains(&size) => format!("{value:.4e}"),
        _ => {
            let digits = (4 - size.log10().floor() as i32).clamp(0, 9) as usize;
            let text = format!("{value:.digits$}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_five_digits() {
        let text = [0.0, 1.0, -2.5, 0.123456, 1234.5678, 1e-7, 65504.0, f64::NAN, f64::INFINITY].map(number);
        assert_eq!(text, ["0", "1", "-2.5", "0.12346", "1234.6", "1.0000e-7", "65504", "NaN", "inf"]);
    }
}
