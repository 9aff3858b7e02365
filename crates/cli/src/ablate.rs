//! `shadowgraph bench --ablate`: what each ingredient of a frame costs.

use shadowgraph::scene::{Light, Scene};
use shadowgraph::shadows::{ShadowFilter, ShadowSettings};
use shadowgraph::{Gpu, ViewOptions};
use shadowgraph_quality::TextTable;
use shadowgraph_quality::bench::{Stats, WholeFrame, warm_up, whole_frames_in_turn};

use super::commands::Input;
use super::failure::Failure;
use super::report::COLUMNS;

/// A frame without one ingredient.
struct Ablation {
    name: &'static str,
    /// Leaves it out of the scene or the settings.
    edit: fn(&mut Scene, &mut ShadowSettings),
    /// Leaves it out of a built-in shader: the file, a text in it, and what replaces it.
    shader: Option<(&'static str, &'static str, &'static str)>,
}

/// The ingredients, after the frame that has all of them.
const ABLATIONS: [Ablation; 11] = [
    Ablation { name: "all", edit: |_, _| (), shader: None },
    Ablation { name: "no shadows", edit: |scene, _| remove_shadows(scene), shader: None },
    Ablation {
        name: "shadows of one tap",
        edit: |_, shadows| {
            shadows.cascades.filter = ShadowFilter::Tent2;
            shadows.atlas.filter = ShadowFilter::Tent2;
        },
        shader: None,
    },
    Ablation { name: "one cascade", edit: |_, shadows| shadows.cascades.count = 1, shader: None },
    Ablation {
        name: "one lookup in wide pixels",
        edit: |_, shadows| shadows.supersample = false,
        shader: None,
    },
    Ablation { name: "open creases", edit: |_, shadows| shadows.close_creases = false, shader: None },
    Ablation {
        name: "taps without the receiver's plane",
        edit: |_, _| (),
        shader: Some((
            "shadows/tent.wgsl",
            "    return min(plane.depth + max(",
            "    return min(plane.depth + 0.0 * max(",
        )),
    },
    Ablation { name: "no textures", edit: |scene, _| remove_textures(scene), shader: None },
    Ablation {
        name: "no specular",
        edit: |_, _| (),
        shader: Some((
            "lighting.wgsl",
            "    return (diffuse + specular) * n_dot_l;",
            "    return diffuse * n_dot_l;",
        )),
    },
    Ablation {
        name: "no ambient",
        edit: |_, _| (),
        shader: Some((
            "environment.wgsl",
            "    return ambient(surface, view.ambient_sky, view.ambient_ground);",
            "    return vec3f(0.0);",
        )),
    },
    Ablation { name: "no lights", edit: |scene, _| scene.set_lights([]), shader: None },
];

/// Draws frames without each ingredient, in turns, and returns the table of their times.
///
/// # Errors
/// As [`whole_frames_in_turn`], and if shaders cannot be written to a temporary directory.
pub(crate) fn ablate(gpu: &Gpu, input: &Input, view: &ViewOptions, frames: u32) -> Result<String, Failure> {
    let mut candidates = Vec::new();
    for ablation in &ABLATIONS {
        let mut scene = input.scene.clone();
        let mut view = view.clone();
        (ablation.edit)(&mut scene, &mut view.shadows);
        let mut renderer = input.options.renderer(gpu, scene, &input.camera)?;
        // Shaders are compiled as the first frames are drawn.
        let folder = ablation.shader.map(edited_shader).transpose()?;
        let path = folder.as_ref().map(|folder| folder.path().to_owned());
        shadowgraph::shaders::set_folder(path);
        let warm = warm_up(gpu, &mut renderer, &view);
        shadowgraph::shaders::set_folder(None);
        warm?;
        candidates.push((renderer, view));
    }
    let times = whole_frames_in_turn(gpu, &mut candidates, frames)?;
    Ok(table(&times, &gpu.adapter.name))
}

fn remove_shadows(scene: &mut Scene) {
    let lights = scene.lights().to_vec();
    scene.set_lights(lights.into_iter().map(|light| Light { casts_shadow: false, ..light }));
}

fn remove_textures(scene: &mut Scene) {
    let keys: Vec<_> = scene.materials().map(|(key, _)| key).collect();
    for key in keys {
        let _edited = scene.edit_material(key, |material| {
            material.textures_mut().into_iter().for_each(|texture| *texture = None);
        });
    }
}

/// Writes a built-in shader with a replaced text to a temporary directory.
fn edited_shader((file, text, replacement): (&str, &str, &str)) -> Result<tempfile::TempDir, Failure> {
    let failed = |reason: String| Failure {
        code: Failure::INPUT,
        message: format!("the shader {file} cannot be edited: {reason}"),
    };
    let source = shadowgraph::shaders::builtin(file).map(|module| module.source).unwrap_or_default();
    if !source.contains(text) {
        return Err(failed(format!("it has no `{}`", text.trim())));
    }
    let folder = tempfile::tempdir().map_err(|error| failed(error.to_string()))?;
    let target = folder.path().join(file);
    if let Some(parent) = target.parent() {
        std::fs::create_dir_all(parent).map_err(|error| failed(error.to_string()))?;
    }
    std::fs::write(target, source.replace(text, replacement)).map_err(|error| failed(error.to_string()))?;
    Ok(folder)
}

fn table(times: &[Vec<WholeFrame>], device: &str) -> String {
    let medians: Vec<f64> = times
        .iter()
        .map(|frames| Stats::from_samples(frames.iter().map(|frame| frame.wall.as_secs_f64() * 1e3)).median)
        .collect();
    let all = medians.first().copied().unwrap_or_default();
    let mut rows = vec![["frame", "milliseconds", "relative to all"].map(str::to_owned)];
    for (ablation, median) in ABLATIONS.iter().zip(&medians) {
        rows.push([ablation.name.to_owned(), format!("{median:.2}"), format!("{:.2}", median / all)]);
    }
    format!(
        "whole frames without one ingredient each, in turns, medians of {} on {device}; shadow maps are drawn in each\n{}",
        times.first().map_or(0, Vec::len),
        TextTable { alignment: "lrr", indent: 2, width: COLUMNS }.format(rows)
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn every_text_that_is_replaced_is_in_its_shader() {
        for shader in ABLATIONS.iter().filter_map(|ablation| ablation.shader) {
            let folder = edited_shader(shader).unwrap();
            let written = std::fs::read_to_string(folder.path().join(shader.0)).unwrap();
            assert!(written.contains(shader.2) && !written.contains(shader.1), "{}", shader.0);
        }
    }
}
