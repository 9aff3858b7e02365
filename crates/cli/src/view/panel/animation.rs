//! The controls of the scene's animations.

use egui::{ComboBox, DragValue, Slider, Ui};

use super::super::stage::Stage;
use shadowgraph::scene::AnimationSelection;

/// Plays, pauses, sets the time and the speed, and selects the animation; nothing for a scene without any.
pub(super) fn show(ui: &mut Ui, stage: &mut Stage) {
    let hierarchy = &stage.scene.hierarchy;
    if hierarchy.animations.is_empty() {
        return;
    }
    let name = |selection| match selection {
        AnimationSelection::All => "all".to_owned(),
        AnimationSelection::None => "none".to_owned(),
        AnimationSelection::One(index) => {
            let name = hierarchy.animations.get(index).and_then(|animation| animation.name.as_deref());
            format!("{index} {}", name.unwrap_or_default())
        }
    };
    let playback = &mut stage.playback;
    ui.horizontal(|ui| {
        ui.label("Animation");
        ComboBox::from_id_salt("animation").selected_text(name(playback.selection)).show_ui(ui, |ui| {
            let each = (0..hierarchy.animations.len()).map(AnimationSelection::One);
            for choice in [AnimationSelection::All, AnimationSelection::None].into_iter().chain(each) {
                ui.selectable_value(&mut playback.selection, choice, name(choice));
            }
        });
        let label = if playback.is_playing { "Pause (P)" } else { "Play (P)" };
        if ui.button(label).clicked() {
            playback.is_playing = !playback.is_playing;
        }
    });
    ui.horizontal(|ui| {
        let end_s = f64::from(hierarchy.end_s(playback.selection));
        ui.add(Slider::new(&mut playback.time_s, 0.0..=end_s.max(1e-3)).suffix(" s").text("Time"));
        ui.add(DragValue::new(&mut playback.speed).range(-10.0..=10.0).speed(0.01).prefix("x "));
    });
}
