//! The panel next to the image: choices, settings, the graph and its times.

mod animation;
mod edit;
mod graph;
mod lights;
mod settings;
mod split_bar;
mod sun;

use std::path::PathBuf;

use egui::load::SizedTexture;
use egui::{ComboBox, Image, InputState, Key, ScrollArea, Sense, TextEdit, TextureId, Ui};

use super::fly::FlyInput;
use super::stage::Stage;
use graph::GraphPanel;
use settings::SettingsPanel;
use shadowgraph::core::TimeSummary;
use shadowgraph::options::Aov;
use shadowgraph::pipelines::BUILT_IN;
use shadowgraph::shadows::Technique;
use shadowgraph::{Pipeline, ShadowLines};

/// An action to perform after the frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Action {
    /// Open a scene; `None`: the built-in one.
    Open(Option<PathBuf>),
    /// Write the page of a frame of this size.
    SaveDump { size_px: [u32; 2] },
    /// Write the settings to a file.
    SaveSettings,
}

/// Size of the image, and the requested action.
pub(super) struct Shown {
    pub(super) size_points: [f32; 2],
    pub(super) action: Option<Action>,
}

/// Page of the panel. F1 to F4 open them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Page {
    #[default]
    Scene,
    Settings,
    Graph,
    Pixel,
}

#[derive(Default)]
pub(super) struct Panel {
    page: Page,
    /// The file of the scene, as typed.
    file: String,
    settings: SettingsPanel,
    graph: GraphPanel,
}

const PAGES: [(Page, Key, &str); 4] = [
    (Page::Scene, Key::F1, "Scene (F1)"),
    (Page::Settings, Key::F2, "Settings (F2)"),
    (Page::Graph, Key::F3, "Graph (F3)"),
    (Page::Pixel, Key::F4, "Pixel (F4)"),
];

impl Panel {
    /// Lays out the window; `image_id` is the last image.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        stage: &mut Stage,
        image_id: Option<TextureId>,
        adapter: &str,
    ) -> Shown {
        self.keys(ui, stage);
        let mut action = None;
        let panel = egui::Panel::right("panel").default_size(400.0).size_range(200.0..=560.0);
        panel.show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (page, _, name) in PAGES {
                    ui.selectable_value(&mut self.page, page, name);
                }
            });
            ui.separator();
            if let Some(error) = &stage.file_error {
                ui.colored_label(ui.visuals().error_fg_color, error);
                ui.separator();
            }
            if let Some(error) = &stage.error {
                ui.colored_label(ui.visuals().error_fg_color, error);
                ui.weak("The image is that of the last valid frame.");
                ui.separator();
            }
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match self.page {
                Page::Scene => {
                    ui.weak(adapter);
                    action = self.open(ui).or(scene(ui, stage));
                }
                Page::Settings => action = self.settings.show(ui, stage),
                Page::Graph => self.graph.show(ui, stage),
                Page::Pixel => pixel(ui, stage),
            });
        });
        let frame = egui::Frame::NONE;
        let size_points = egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            let size = ui.available_size();
            if let Some(id) = image_id {
                let image = Image::new(SizedTexture::new(id, size)).sense(Sense::click_and_drag());
                let response = ui.add(image);
                if response.dragged() {
                    let moved = response.drag_delta();
                    stage.fly.turn(moved.x.into(), moved.y.into());
                }
                if response.secondary_clicked()
                    && let Some(at) = response.interact_pointer_pos()
                {
                    let points = (at - response.rect.min).max(egui::Vec2::ZERO) * ui.ctx().pixels_per_point();
                    (stage.picked, self.page) = (Some([points.x as u32, points.y as u32]), Page::Pixel);
                }
                if response.clicked() {
                    // Keys control the camera again.
                    ui.ctx().memory_mut(|memory| memory.stop_text_input());
                }
            }
            [size.x.max(1.0), size.y.max(1.0)]
        });
        let size_points = size_points.inner;
        let scale = ui.ctx().pixels_per_point();
        let action = action.map(|action| match action {
            Action::SaveDump { .. } => {
                Action::SaveDump { size_px: size_points.map(|p| (p * scale).max(1.0) as u32) }
            }
            Action::SaveSettings | Action::Open(_) => action,
        });
        Shown { size_points, action }
    }

    /// Another scene, by the name of its file.
    fn open(&mut self, ui: &mut Ui) -> Option<Action> {
        let mut action = None;
        ui.horizontal(|ui| {
            let hint =
                TextEdit::singleline(&mut self.file).hint_text("a glTF or GLB file").desired_width(200.0);
            let typed = ui.add(hint);
            let entered = typed.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            if (ui.button("Open").clicked() || entered) && !self.file.is_empty() {
                action = Some(Action::Open(Some(PathBuf::from(self.file.trim()))));
            }
            if ui.button("Built-in").clicked() {
                action = Some(Action::Open(None));
            }
        });
        action
    }

    /// Keys that work while nothing is typed: pages, the next technique, freezing, playing animations and the day.
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
        if ui.input(|input| input.key_pressed(Key::P)) {
            stage.playback.is_playing = !stage.playback.is_playing;
        }
        if ui.input(|input| input.key_pressed(Key::F)) {
            stage.freeze(!stage.is_frozen());
        }
        if let Some(sun) = stage.sun.as_mut().filter(|_| ui.input(|input| input.key_pressed(Key::L))) {
            sun.play(!sun.plays);
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

/// Returns the movement that the pressed keys request.
pub(in crate::view) fn fly_input(input: &InputState) -> FlyInput {
    let way = |there: [Key; 2], back: [Key; 2]| {
        let down = |keys: [Key; 2]| keys.into_iter().any(|key| input.key_down(key));
        f64::from(u8::from(down(there))) - f64::from(u8::from(down(back)))
    };
    FlyInput {
        right: way([Key::D, Key::ArrowRight], [Key::A, Key::ArrowLeft]),
        up: way([Key::E, Key::PageUp], [Key::Q, Key::PageDown]),
        ahead: way([Key::W, Key::ArrowUp], [Key::S, Key::ArrowDown]),
        fast: input.modifiers.shift,
    }
}

/// Shows what is known of the pixel that was clicked.
fn pixel(ui: &mut Ui, stage: &Stage) {
    ui.weak("A right click on the image shows the passes that a pixel comes from, and its shadows.");
    if let Some(text) = &stage.pixel {
        ui.monospace(text);
    }
}

fn scene(ui: &mut Ui, stage: &mut Stage) -> Option<Action> {
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
        ui.label("Output");
        output_choice(ui, stage);
    });
    if let Some(sun) = &mut stage.sun {
        sun::show(ui, sun);
    }
    ui.horizontal(|ui| {
        ui.label("Lines");
        let shown = stage.overlay.map_or("none", ShadowLines::name);
        ComboBox::from_id_salt("lines").selected_text(shown).show_ui(ui, |ui| {
            ui.selectable_value(&mut stage.overlay, None, "none");
            for lines in ShadowLines::ALL {
                ui.selectable_value(&mut stage.overlay, Some(lines), lines.name());
            }
        });
    });
    let mut frozen = stage.is_frozen();
    if ui.checkbox(&mut frozen, "Freeze the shadow camera (F)").changed() {
        stage.freeze(frozen);
    }
    animation::show(ui, stage);
    if let Some(controller) = &stage.controller {
        ui.label(format!("Shadow quality: level {} (0 is the best)", controller.level()));
    }
    ui.horizontal(|ui| {
        ui.label("Speed");
        let drag = egui::DragValue::new(&mut stage.fly.speed).range(0.01..=1e4).speed(0.1).suffix(" m/s");
        ui.add(drag);
    });
    ui.separator();
    let mut action = None;
    if ui.button("Save the page of this frame").clicked() {
        action = Some(Action::SaveDump { size_px: [1, 1] });
    }
    if ui.button("Save the settings").clicked() {
        action = Some(Action::SaveSettings);
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
    ui.weak("W A S D or arrow keys move, E and Q up and down, Shift faster; drag to look around; T selects the next technique; P plays and pauses, L the day.");
    action
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
fn output_choice(ui: &mut Ui, stage: &mut Stage) {
    let mut choices = vec![Aov::Color, Aov::Cascade, Aov::Depth, Aov::Normal, Aov::Atlas];
    choices.extend((0..stage.scene.lights().len().min(16)).map(|light| Aov::Visibility(light as u32)));
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
