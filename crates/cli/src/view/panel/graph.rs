//! The passes of the frame with their times and explanations.

use egui::{CollapsingHeader, Grid, Ui};

use super::super::stage::Stage;
use shadowgraph::core::{NodeId, PassId, Plan, TimeSummary};
use shadowgraph::{CulledView, FrameCounts};

#[derive(Default)]
pub(super) struct GraphPanel {
    /// Path of the explained pass.
    chosen: Option<String>,
}

impl GraphPanel {
    pub(super) fn show(&mut self, ui: &mut Ui, stage: &Stage) {
        let Some(plan) = &stage.plan else { return };
        ui.label(format!(
            "{} passes in {} steps, {} culled; {:.1} MiB",
            plan.order().len(),
            plan.steps().len(),
            plan.culled_count(),
            plan.slot_bytes() as f64 / 1_048_576.0
        ));
        drawn(ui, &stage.counts);
        let times = stage.times.summary();
        // Times are in order of recording; the first frame of a new plan has none yet.
        let times = |index: usize| times.get(index).filter(|_| times.len() == plan.order().len());
        let mut nodes: Vec<Option<NodeId>> = Vec::new();
        for &pass in plan.order() {
            let node = plan.pass(pass).node;
            if !nodes.contains(&node) {
                nodes.push(node);
            }
        }
        for node in nodes {
            let name = node.map_or("(no node)".into(), |node| plan.node_path(node));
            CollapsingHeader::new(&name).default_open(true).show(ui, |ui| {
                Grid::new(&name).num_columns(3).striped(true).show(ui, |ui| {
                    for (index, &pass) in plan.order().iter().enumerate() {
                        if plan.pass(pass).node == node {
                            self.row(ui, plan, pass, times(index));
                        }
                    }
                });
            });
        }
        self.culled(ui, plan);
        if let Some(why) =
            self.chosen.as_ref().and_then(|path| shadowgraph::inspect::explain(plan, path).ok())
        {
            ui.separator();
            ui.label(why);
        }
    }

    fn row(&mut self, ui: &mut Ui, plan: &Plan, pass: PassId, time: Option<&TimeSummary>) {
        let chosen = self.chosen.as_ref().is_some_and(|path| *path == plan.pass_path(pass));
        if ui.selectable_label(chosen, plan.pass(pass).name).clicked() {
            self.chosen = Some(plan.pass_path(pass));
        }
        let Some(time) = time else { return ui.end_row() };
        ui.monospace(format!("{:.3} ms CPU", time.cpu_ms.median));
        if let Some(gpu_ms) = time.gpu_ms {
            let shared = if time.shared_by > 1 {
                format!(", shared by {} merged passes", time.shared_by)
            } else {
                String::new()
            };
            let text = format!("{:.2} ms GPU{shared}", gpu_ms.median);
            ui.monospace(text).on_hover_text(format!("95th percentile {:.2} ms", gpu_ms.high));
        }
        ui.end_row();
    }

    fn culled(&mut self, ui: &mut Ui, plan: &Plan) {
        if plan.culled_count() == 0 {
            return;
        }
        CollapsingHeader::new("culled").show(ui, |ui| {
            for (id, pass) in plan.passes() {
                if let Some(reason) = pass.culled {
                    ui.weak(format!("{}: {}", plan.pass_path(id), plan.describe_cull(reason)));
                }
            }
        });
    }
}

/// Shows how many of all instances the views draw that the GPU culls.
fn drawn(ui: &mut Ui, (counts, all): &(FrameCounts, usize)) {
    shadow_counts(ui, counts);
    if counts.culled.is_empty() {
        return;
    }
    CollapsingHeader::new(format!("drawn of {all} instances")).default_open(true).show(ui, |ui| {
        Grid::new("drawn").num_columns(2).striped(true).show(ui, |ui| {
            for CulledView { view, instances } in &counts.culled {
                ui.label(view);
                ui.monospace(instances.to_string());
                ui.end_row();
            }
        });
    });
}

/// Shows what the shadow technique counts.
fn shadow_counts(ui: &mut Ui, counts: &FrameCounts) {
    if counts.shadows.is_empty() {
        return;
    }
    CollapsingHeader::new("shadows").default_open(true).show(ui, |ui| {
        Grid::new("shadow counts").num_columns(2).striped(true).show(ui, |ui| {
            for (name, count) in &counts.shadows {
                ui.label(*name);
                ui.monospace(count.to_string());
                ui.end_row();
            }
        });
        if let Some(warning) = &counts.shadow_warning {
            ui.colored_label(ui.visuals().warn_fg_color, warning);
        }
    });
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput, Shape};

    use super::*;

    #[test]
    fn counts_are_shown_with_their_names() {
        let views = [("camera", 12), ("cascade 0", 345)];
        let culled = views.map(|(view, instances)| CulledView { view: view.into(), instances }).to_vec();
        let shadow_warning = Some("the pool is too small".to_owned());
        let counts = FrameCounts { culled, shadows: vec![("pages needed", 67)], shadow_warning };
        let mut output =
            Context::default().run_ui(RawInput::default(), |ui| drawn(ui, &(counts.clone(), 1000)));
        output.textures_delta.clear();
        let texts: Vec<_> = output
            .shapes
            .iter()
            .filter_map(|clipped| match &clipped.shape {
                Shape::Text(text) => Some(text.galley.text().to_owned()),
                _ => None,
            })
            .collect();
        let expected = ["drawn of 1000 instances", "camera", "12", "cascade 0", "345"];
        for expected in expected.into_iter().chain(["pages needed", "67", "the pool is too small"]) {
            assert!(texts.iter().any(|text| text == expected), "{expected}: {texts:?}");
        }
    }
}
