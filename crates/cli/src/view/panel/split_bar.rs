//! The splits of cascades: a bar with a segment for each cascade, whose borders can be dragged.

use egui::{Align2, Color32, CursorIcon, FontId, Rect, Sense, Ui, pos2, vec2};

use shadowgraph::shadows::{CascadeSettings, SplitScheme, split_distances};

const HEIGHT: f32 = 24.0;
/// Half the width of a border that can be dragged.
const GRIP: f32 = 5.0;
/// The least length of a cascade, as a fraction of the whole.
const SHORTEST: f64 = 1e-3;

/// The colours of cascades in images.
const COLORS: [Color32; 8] = [
    Color32::from_rgb(255, 89, 77),
    Color32::from_rgb(102, 230, 89),
    Color32::from_rgb(89, 140, 255),
    Color32::from_rgb(255, 217, 77),
    Color32::from_rgb(77, 230, 230),
    Color32::from_rgb(255, 153, 64),
    Color32::from_rgb(153, 153, 153),
    Color32::from_rgb(255, 128, 204),
];

/// The scale of the bar: nearby metres are wider.
#[derive(Clone, Copy)]
struct Scale {
    near_m: f64,
    far_m: f64,
}

impl Scale {
    /// Returns the place of a view depth, 0 to 1.
    fn place(self, depth_m: f64) -> f64 {
        ((depth_m - self.near_m) / (self.far_m - self.near_m)).clamp(0.0, 1.0).sqrt()
    }

    /// Returns the view depth of a place.
    fn depth_m(self, place: f64) -> f64 {
        let place = place.clamp(0.0, 1.0);
        self.near_m + (self.far_m - self.near_m) * place * place
    }
}

/// Returns the ends of cascades after one that is not the last was moved: it stays between its neighbours.
fn moved(ends_m: &[f64], near_m: f64, index: usize, to_m: f64) -> Vec<f64> {
    let (begin_m, last_m) =
        (index.checked_sub(1).map_or(near_m, |before| ends_m[before]), ends_m[ends_m.len() - 1]);
    let shortest_m = (last_m - near_m) * SHORTEST;
    let mut moved = ends_m.to_vec();
    moved[index] =
        to_m.clamp(begin_m + shortest_m, (ends_m[index + 1] - shortest_m).max(begin_m + shortest_m));
    moved
}

/// Shows the bar of the cascades between two view depths, and returns whether a border was moved. Then the splits are in metres.
pub(super) fn show(ui: &mut Ui, cascades: &mut CascadeSettings, near_m: f64, far_m: f64) -> bool {
    if cascades.count == 0 || far_m <= near_m {
        return false;
    }
    let scale = Scale { near_m, far_m };
    let ends_m = split_distances(&cascades.split, cascades.count, near_m, far_m);
    let (bar, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let x = |depth_m: f64| bar.left() + bar.width() * scale.place(depth_m) as f32;
    let mut begin_m = near_m;
    for (&end_m, color) in ends_m.iter().zip(COLORS) {
        let segment = Rect::from_min_max(pos2(x(begin_m), bar.top()), pos2(x(end_m), bar.bottom()));
        ui.painter().rect_filled(segment, 0.0, color);
        if segment.width() > 30.0 {
            let text = format!("{end_m:.1}");
            ui.painter().text(
                segment.center(),
                Align2::CENTER_CENTER,
                text,
                FontId::proportional(11.0),
                Color32::BLACK,
            );
        }
        begin_m = end_m;
    }
    let mut dragged = None;
    for (index, &end_m) in ends_m[..ends_m.len() - 1].iter().enumerate() {
        let grip = Rect::from_center_size(pos2(x(end_m), bar.center().y), vec2(2.0 * GRIP, HEIGHT));
        let response = ui.interact(grip, ui.scope_id().with(("split", index)), Sense::drag());
        let response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
        let width = if response.hovered() || response.dragged() { 3.0 } else { 1.0 };
        ui.painter().vline(x(end_m), bar.y_range(), (width, Color32::BLACK));
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            dragged = Some((index, scale.depth_m(f64::from((pointer.x - bar.left()) / bar.width()))));
        }
    }
    let Some((index, to_m)) = dragged else { return false };
    let ends_m = moved(&ends_m, near_m, index, to_m);
    let ends_m = ends_m[..ends_m.len() - 1].iter().map(|end_m| *end_m as f32).collect();
    cascades.split = SplitScheme::Metres(ends_m);
    true
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn places_and_depths_are_inverse_and_nearby_metres_are_wider() {
        let scale = Scale { near_m: 0.5, far_m: 100.0 };
        for place in [0.0, 0.25, 0.5, 1.0] {
            assert!((scale.place(scale.depth_m(place)) - place).abs() < 1e-12);
        }
        assert_eq!((scale.place(-3.0), scale.place(1e9), scale.depth_m(2.0)), (0.0, 1.0, 100.0));
        assert!(scale.place(10.0) > 0.3);
    }

    #[test]
    fn a_border_stays_between_its_neighbours() {
        let ends_m = [10.0, 30.0, 60.0, 100.0];
        assert_eq!(moved(&ends_m, 0.0, 1, 40.0), [10.0, 40.0, 60.0, 100.0]);
        assert_eq!(moved(&ends_m, 0.0, 1, 5.0), [10.0, 10.1, 60.0, 100.0]);
        assert_eq!(moved(&ends_m, 0.0, 2, 500.0), [10.0, 30.0, 99.9, 100.0]);
        assert_eq!(moved(&ends_m, 0.0, 0, -1.0), [0.1, 30.0, 60.0, 100.0]);
    }

    /// Runs the bar for some frames, with the pointer at these places along it, pressed but in the first and the last frame.
    fn drag(cascades: &mut CascadeSettings, places: &[f32]) -> bool {
        let context = egui::Context::default();
        let mut changed = false;
        for (frame, place) in places.iter().enumerate() {
            let mut input = egui::RawInput {
                screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 100.0))),
                ..egui::RawInput::default()
            };
            let pos = pos2(place * 400.0, 12.0);
            input.events.push(egui::Event::PointerMoved(pos));
            let pressed = frame == 1;
            if pressed || frame + 1 == places.len() {
                let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
                input.events.push(egui::Event::PointerButton { pos, button, pressed, modifiers });
            }
            let mut output = context.run_ui(input, |ui| changed |= show(ui, cascades, 0.0, 100.0));
            output.textures_delta.clear();
        }
        changed
    }

    #[test]
    fn row_43_a_border_is_dragged_along_the_bar() {
        let mut cascades = CascadeSettings {
            split: SplitScheme::Metres(vec![10.0, 25.0, 50.0]),
            ..CascadeSettings::default()
        };
        // 25 m are half-way along the bar.
        assert!(drag(&mut cascades, &[0.5, 0.5, 0.55, 0.6, 0.6]));
        let ends_m = split_distances(&cascades.split, 4, 0.0, 100.0);
        assert!((ends_m[1] - 36.0).abs() < 1.0 && (ends_m[0], ends_m[2]) == (10.0, 50.0), "{ends_m:?}");
        assert!(matches!(cascades.split, SplitScheme::Metres(_)));
        let before = cascades.clone();
        assert!(!drag(&mut cascades, &[0.2, 0.2, 0.25, 0.25]), "no border is there");
        assert_eq!(cascades, before);
    }
}
