//! The sun's place, and the day that plays.

use egui::{CollapsingHeader, Slider, Ui};

use super::super::sun::{Placement, Sun};

/// Shows the controls of the sun.
pub(super) fn show(ui: &mut Ui, sun: &mut Sun) {
    CollapsingHeader::new("Sun").default_open(true).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.selectable_value(&mut sun.place, Placement::Direction, "Direction");
            ui.selectable_value(&mut sun.place, Placement::Time, "Time");
        });
        match sun.place {
            Placement::Direction => {
                degrees(ui, &mut sun.sky.azimuth, 0.0..=360.0, "azimuth, from north (-Z) over east (+X)");
                degrees(ui, &mut sun.sky.elevation, -90.0..=90.0, "elevation");
            }
            Placement::Time => {
                ui.add(Slider::new(&mut sun.time.hour, 0.0..=24.0).suffix(" h").text("true solar time"));
                ui.add(Slider::new(&mut sun.time.day, 1.0..=366.0).step_by(1.0).text("day of the year"));
                degrees(ui, &mut sun.time.latitude, -90.0..=90.0, "latitude");
            }
        }
        ui.horizontal(|ui| {
            let mut plays = sun.plays;
            if ui.checkbox(&mut plays, "Play the day (L)").changed() {
                sun.play(plays);
            }
            let speed = egui::DragValue::new(&mut sun.hours_per_second).range(-24.0..=24.0).speed(0.01);
            ui.add(speed.suffix(" h/s"));
        });
        if sun.place == Placement::Direction {
            sun.plays = false;
        }
    });
}

/// Shows a slider in degrees for an angle in radians.
fn degrees(ui: &mut Ui, angle: &mut f64, range: std::ops::RangeInclusive<f64>, name: &str) {
    let mut angle_deg = angle.to_degrees();
    if ui.add(Slider::new(&mut angle_deg, range).suffix("\u{b0}").text(name)).changed() {
        *angle = angle_deg.to_radians();
    }
}
