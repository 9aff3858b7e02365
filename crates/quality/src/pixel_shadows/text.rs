//! The shadows at a pixel as text.

use std::fmt::Write as _;

use super::{PixelBlocker, PixelLight, PixelRemedy, PixelShadows, PixelSurface, Reachability};

impl PixelShadows {
    /// Returns the shadows as text, a line for each light.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!("shadows of `{}`\n", self.technique);
        let Some(surface) = &self.surface else {
            text.push_str("  no surface: the background, or the ground of `--ground auto`, whose shadows are not explained\n");
            return text;
        };
        let PixelSurface { position_world: [x, y, z], normal: [a, b, c], view_depth_m, instance } = surface;
        let named = instance.as_ref().map_or_else(String::new, |name| format!(" of `{name}`"));
        let _ = writeln!(
            text,
            "  surface{named} at {x:.3} {y:.3} {z:.3}, normal {a:.3} {b:.3} {c:.3}, {view_depth_m:.3} m in front of the camera"
        );
        for light in &self.lights {
            let name = if light.name.is_empty() { String::new() } else { format!(" `{}`", light.name) };
            let _ = writeln!(text, "  light {}{name} ({}): {}", light.light, light.kind, described(light));
            for fact in screen_space(light).into_iter().chain(light.facts.iter().map(ToString::to_string)) {
                let _ = writeln!(text, "    {fact}");
            }
        }
        text
    }
}

fn described(light: &PixelLight) -> String {
    match light.reach {
        Reachability::FacesAway => return "dark: the surface faces away".into(),
        Reachability::Outside => return "dark: outside of its range or cone".into(),
        Reachability::Reached => {}
    }
    let visibility = light.visibility.map(|rgb| format!("visibility {}, ", shown(rgb))).unwrap_or_default();
    let truth = match (&light.blocker, light.ray) {
        (Some(PixelBlocker { instance, distance_m }), _) => {
            format!("blocked by `{instance}`, {distance_m:.3} m away")
        }
        (None, Some(rgb)) if rgb != [1.0; 3] => format!("{} passes translucent surfaces", channels(rgb)),
        (None, _) => "nothing blocks".into(),
    };
    let unshadowed = light.unshadowed.as_ref().map_or_else(String::new, |why| format!("; no shadows: {why}"));
    let place = if light.is_at_edge {
        "at an edge, where the technique differs"
    } else {
        "the technique is wrong here"
    };
    let differs = match &light.remedy {
        Some(PixelRemedy { setting, visibility }) => {
            format!("; {place}: with `{setting}` it is {}", shown(*visibility))
        }
        None if light.differs() => format!("; {place}, and no setting that was tried helps"),
        None => String::new(),
    };
    format!("{visibility}{truth}{differs}{unshadowed}")
}

/// Says how the image differs from the visibility at the surface, if by more than rounding and one step of a filter.
fn screen_space(light: &PixelLight) -> Option<String> {
    let [at_point, image] =
        [light.visibility_at_point?, light.visibility?.map(|byte| f32::from(byte) / 255.0)];
    let differs = at_point.iter().zip(image).any(|(a, b)| (a - b).abs() > 0.05);
    differs.then(|| format!("without screen space: visibility {}", channels(at_point)))
}

fn shown(visibility: [u8; 3]) -> String {
    channels(visibility.map(|byte| f32::from(byte) / 255.0))
}

/// Writes equal channels once.
fn channels(rgb: [f32; 3]) -> String {
    match rgb {
        [r, g, b] if r == g && g == b => format!("{r:.3}"),
        [r, g, b] => format!("{r:.3} {g:.3} {b:.3}"),
    }
}
