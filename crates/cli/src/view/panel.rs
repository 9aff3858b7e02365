//! What is around the picture: choices, settings, the graph and its times.

mod edit;
mod graph;
mod settings;

use std::path::PathBuf;

use egui::load::SizedTexture;
use egui::{ComboBox, Image, InputState, Key, ScrollArea, Sense, TextEdit, TextureId, Ui};

use super::fly::Steer;
use super::stage::Stage;
use graph::GraphPanel;
use settings::SettingsPanel;
use shadowgraph::Pipeline;
use shadowgraph::core::TimeSummary;
use shadowgraph::options::Aov;
use shadowgraph::pipelines::BUILT_IN;
use shadowgraph::shadows::Technique;

/// What is to be done after the frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Wish {
    /// Show another scene; `None`: the built-in one.
    Open(Option<PathBuf>),
    /// Write a page about the frame, drawn in this size.
    SaveDump { size_px: [u32; 2] },
    /// Write the settings to a file.
    SaveSettings,
}

/// How much room there is for the picture, and what the user wants.
pub(super) struct Shown {
    pub(super) size_points: [f32; 2],
    pub(super) wish: Option<Wish>,
}

/// Which page of the panel is open. F1 to F3 open them too.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Page {
    #[default]
    Scene,
    Settings,
    Graph,
}

#[derive(Default)]
pub(super) struct Panel {
    page: Page,
    /// The scene's file, as it is typed.
    file: String,
    settings: SettingsPanel,
    graph: GraphPanel,
}

const PAGES: [(Page, Key, &str); 3] = [
    (Page::Scene, Key::F1, "Scene (F1)"),
    (Page::Settings, Key::F2, "Settings (F2)"),
    (Page::Graph, Key::F3, "Graph (F3)"),
];

impl Panel {
    /// Lays the window out; `picture` is what was drawn last.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        stage: &mut Stage,
        picture: Option<TextureId>,
        adapter: &str,
    ) -> Shown {
        self.keys(ui, stage);
        let mut wish = None;
        let panel = egui::Panel::right("panel").default_size(400.0).size_range(200.0..=560.0);
        panel.show(ui, |ui| {
            ui.horizontal(|ui| {
                for (page, _, name) in PAGES {
                    ui.selectable_value(&mut self.page, page, name);
                }
            });
            ui.separator();
            if let Some(refused) = &stage.refused {
                ui.colored_label(ui.visuals().error_fg_color, refused);
                ui.separator();
            }
            if let Some(error) = &stage.error {
                ui.colored_label(ui.visuals().error_fg_color, error);
                ui.weak("The picture is the last good one.");
                ui.separator();
            }
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match self.page {
                Page::Scene => {
                    ui.weak(adapter);
                    wish = self.open(ui).or(scene(ui, stage));
                }
                Page::Settings => wish = self.settings.show(ui, stage),
                Page::Graph => self.graph.show(ui, stage),
            });
        });
        let frame = egui::Frame::NONE;
        let size_points = egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            let size = ui.available_size();
            if let Some(id) = picture {
                let image = Image::new(SizedTexture::new(id, size)).sense(Sense::click_and_drag());
                let response = ui.add(image);
                if response.dragged() {
                    let moved = response.drag_delta();
                    stage.fly.turn(moved.x.into(), moved.y.into());
                }
                if response.clicked() {
                    // Keys fly again.
                    ui.ctx().memory_mut(|memory| memory.stop_text_input());
                }
            }
            [size.x.max(1.0), size.y.max(1.0)]
        });
        let size_points = size_points.inner;
        let scale = ui.ctx().pixels_per_point();
        let wish = wish.map(|wish| match wish {
            Wish::SaveDump { .. } => {
                Wish::SaveDump { size_px: size_points.map(|p| (p * scale).max(1.0) as u32) }
            }
            Wish::SaveSettings | Wish::Open(_) => wish,
        });
        Shown { size_points, wish }
    }

    /// Another scene, by the name of its file.
    fn open(&mut self, ui: &mut Ui) -> Option<Wish> {
        let mut wish = None;
        ui.horizontal(|ui| {
            let hint =
                TextEdit::singleline(&mut self.file).hint_text("a glTF or GLB file").desired_width(200.0);
            let typed = ui.add(hint);
            let entered = typed.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            if (ui.button("Open").clicked() || entered) && !self.file.is_empty() {
                wish = Some(Wish::Open(Some(PathBuf::from(self.file.trim()))));
            }
            if ui.button("Built-in").clicked() {
                wish = Some(Wish::Open(None));
            }
        });
        wish
    }

    /// Keys that work while nothing is typed: pages, the next technique, freezing.
    fn keys(&mut self, ui: &Ui, stage: &mut Stage) {
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        for (page, key, _) in PAGES {
            if ui.input(|input| input.key_pressed(key)) {
                self.page = page;
            }
        }
        if ui.input(|input| input.key_pressed(Key::T)) {
            next_technique(stage);
        }
        if ui.input(|input| input.key_pressed(Key::F)) {
            stage.freeze(!stage.frozen);
        }
    }
}

/// Takes the technique after the one that is chosen.
fn next_technique(stage: &mut Stage) {
    let kinds = stage.registry.techniques.kinds();
    let name = stage.technique.name();
    let base = name.split('+').next().unwrap_or_default();
    let at = kinds.iter().position(|kind| kind.name == base).unwrap_or_default();
    stage.technique = Technique::from(kinds[(at + 1) % kinds.len()]);
}

/// Which ways the keys steer.
pub(in crate::view) fn steer(input: &InputState) -> Steer {
    let way = |there: [Key; 2], back: [Key; 2]| {
        let down = |keys: [Key; 2]| keys.into_iter().any(|key| input.key_down(key));
        f64::from(u8::from(down(there))) - f64::from(u8::from(down(back)))
    };
    Steer {
        right: way([Key::D, Key::ArrowRight], [Key::A, Key::ArrowLeft]),
        up: way([Key::E, Key::PageUp], [Key::Q, Key::PageDown]),
        ahead: way([Key::W, Key::ArrowUp], [Key::S, Key::ArrowDown]),
        fast: input.modifiers.shift,
    }
}

fn scene(ui: &mut Ui, stage: &mut Stage) -> Option<Wish> {
    ui.horizontal(|ui| {
        ui.label("Technique");
        technique(ui, stage);
    });
    ui.horizontal(|ui| {
        ui.label("Pipeline");
        ComboBox::from_id_salt("pipeline").selected_text(stage.pipeline.name()).show_ui(ui, |ui| {
            for pipeline in BUILT_IN.iter().filter_map(|name| name.parse::<Pipeline>().ok()) {
                let chosen = stage.pipeline == pipeline;
                let label = ui.selectable_label(chosen, pipeline.name()).on_hover_text(pipeline.about());
                if label.clicked() {
                    stage.pipeline = pipeline;
                }
            }
        });
    });
    ui.horizontal(|ui| {
        ui.label("Shows");
        shows(ui, stage);
    });
    let mut frozen = stage.frozen;
    if ui.checkbox(&mut frozen, "Shadows stay where the camera was (F)").changed() {
        stage.freeze(frozen);
    }
    ui.horizontal(|ui| {
        ui.label("Speed");
        let drag = egui::DragValue::new(&mut stage.fly.speed).range(0.01..=1e4).speed(0.1).suffix(" m/s");
        ui.add(drag);
    });
    ui.separator();
    let mut wish = None;
    if ui.button("Save a page about this frame").clicked() {
        wish = Some(Wish::SaveDump { size_px: [1, 1] });
    }
    if ui.button("Save the settings").clicked() {
        wish = Some(Wish::SaveSettings);
    }
    ui.label(&stage.note);
    ui.separator();
    let position = stage.fly.camera().position_world();
    ui.monospace(format!("camera {:.1} {:.1} {:.1}", position.x, position.y, position.z));
    let summary = stage.times.summary();
    let gpu_ms = summary.iter().filter_map(TimeSummary::gpu_share_ms).reduce(|a, b| a + b);
    if let Some(gpu_ms) = gpu_ms {
        ui.monospace(format!("GPU {gpu_ms:.2} ms, the median of {} frames", stage.times.frames()));
    }
    ui.separator();
    ui.weak("W A S D or arrows fly, E and Q up and down, Shift faster; drag to look around; T is the next technique.");
    wish
}

fn technique(ui: &mut Ui, stage: &mut Stage) {
    ComboBox::from_id_salt("technique").selected_text(stage.technique.name()).show_ui(ui, |ui| {
        for kind in stage.registry.techniques.kinds().to_vec() {
            let plain = Technique::from(kind);
            for choice in [plain, plain.with_screen(), plain.with_contact()] {
                let label = ui.selectable_value(&mut stage.technique, choice, choice.name());
                label.on_hover_text(kind.summary);
            }
        }
    });
}

/// Outputs, and every texture of the frame.
fn shows(ui: &mut Ui, stage: &mut Stage) {
    let mut choices = vec![Aov::Color, Aov::Cascade, Aov::Depth, Aov::Normal, Aov::Atlas];
    choices.extend((0..stage.scene.lights.len().min(16)).map(|light| Aov::Visibility(light as u32)));
    if let Some(plan) = &stage.plan {
        let textures = plan.resources().filter(|(_, resource)| {
            matches!(resource.desc, shadowgraph::core::ResourceDesc::Texture(desc) if desc.samples == 1)
        });
        choices.extend(textures.map(|(_, resource)| Aov::Texture(resource.name.to_owned())));
    }
    ComboBox::from_id_salt("shows").selected_text(stage.aov.to_string()).show_ui(ui, |ui| {
        for choice in choices {
            let name = choice.to_string();
            ui.selectable_value(&mut stage.aov, choice, name);
        }
    });
}
