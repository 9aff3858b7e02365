//! The passes of the frame with their times, and why each is as it is.

use egui::{CollapsingHeader, Grid, Ui};

use super::super::stage::Stage;
use crate::core::{PassId, Plan, TimeSummary};

#[derive(Default)]
pub(super) struct GraphPanel {
    /// The path of the pass that is explained.
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
        let times = stage.times.summary();
        let mut nodes: Vec<String> = Vec::new();
        for &pass in plan.order() {
            let node = node(plan, pass);
            if !nodes.contains(&node) {
                nodes.push(node);
            }
        }
        for name in nodes {
            let title = if name.is_empty() { "(no node)" } else { &name };
            CollapsingHeader::new(title).default_open(true).show(ui, |ui| {
                Grid::new(&name).num_columns(3).striped(true).show(ui, |ui| {
                    for &pass in plan.order().iter().filter(|&&pass| node(plan, pass) == name) {
                        self.row(ui, plan, pass, &times);
                    }
                });
            });
        }
        self.culled(ui, plan);
        if let Some(why) = self.chosen.as_ref().and_then(|path| plan.explain(path).ok()) {
            ui.separator();
            ui.label(why);
        }
    }

    fn row(&mut self, ui: &mut Ui, plan: &Plan, pass: PassId, times: &[TimeSummary]) {
        let path = plan.pass_path(pass);
        let chosen = self.chosen.as_ref() == Some(&path);
        if ui.selectable_label(chosen, plan.pass(pass).name).clicked() {
            self.chosen = Some(path.clone());
        }
        let Some(time) = times.iter().find(|time| time.pass == path) else { return ui.end_row() };
        ui.monospace(format!("{:.3} ms CPU", time.cpu_ms.median));
        if let Some(gpu_ms) = time.gpu_ms {
            let shared =
                if time.shared_by > 1 { format!(", all {} merged", time.shared_by) } else { String::new() };
            let text = format!("{:.2} ms GPU{shared}", gpu_ms.median);
            ui.monospace(text)
                .on_hover_text(format!("one frame in twenty takes more than {:.2} ms", gpu_ms.high));
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
                    ui.weak(format!("{}: {}", plan.pass_path(id), plan.cull_words(reason)));
                }
            }
        });
    }
}

fn node(plan: &Plan, pass: PassId) -> String {
    plan.pass(pass).node.map(|node| plan.node_path(node)).unwrap_or_default()
}
