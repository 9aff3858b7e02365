//! Far away: towers, an obelisk and an aqueduct, whose shadows lie beyond any near shadow map.

use glam::{DAffine3, DVec3};

use super::arch::ArchBay;
use super::stage::Stage;
use crate::solids::shape::{Shape, standing_box, tapered_shaft};

/// Adds all of it.
pub(super) fn build(stage: &mut Stage) {
    let tower = stage.mesh("tower", tower());
    for (x, z, turn, size) in [(-74.0, -66.0, 0.3, 1.0), (-62.0, -150.0, 0.8, 1.2), (70.0, -120.0, 0.1, 1.0)]
    {
        let placed = DAffine3::from_scale_rotation_translation(
            DVec3::splat(size),
            glam::DQuat::from_rotation_y(turn),
            DVec3::new(x, -0.15, z),
        );
        stage.place("tower", tower, stage.paint.masonry, placed);
    }
    let mut obelisk = standing_box(7.0, 1.2, 7.0);
    obelisk.append_at(&standing_box(5.0, 1.4, 5.0), DVec3::Y * 1.2);
    obelisk.append_at(&tapered_shaft(2.6..=27.0, 1.7, 1.1), DVec3::ZERO);
    obelisk.append_at(&tapered_shaft(27.0..=29.4, 1.1, 0.02), DVec3::ZERO);
    let obelisk = stage.mesh("obelisk", obelisk);
    stage.place_at("obelisk", obelisk, stage.paint.stone, DVec3::new(2.0, -0.15, -105.0));
    aqueduct(stage);
}

/// A square tower of about 34 m with ledges and a roof.
fn tower() -> Shape {
    let mut shape = tapered_shaft(0.0..=4.0, 4.6, 3.8);
    shape.append_at(&tapered_shaft(4.0..=26.0, 3.5, 3.2), DVec3::ZERO);
    shape.append_at(&standing_box(8.0, 1.0, 8.0), DVec3::Y * 18.0);
    shape.append_at(&standing_box(8.4, 0.9, 8.4), DVec3::Y * 25.6);
    for (x, z) in [(-3.4, -3.4), (3.4, -3.4), (-3.4, 3.4), (3.4, 3.4)] {
        shape.append_at(&standing_box(1.1, 3.4, 1.1), DVec3::new(x, 26.5, z));
    }
    shape.append_at(&standing_box(8.4, 0.5, 8.4), DVec3::Y * 29.9);
    shape.append_at(&tapered_shaft(30.4..=35.5, 3.9, 0.05), DVec3::ZERO);
    shape
}

/// A row of tall arches across the plain.
fn aqueduct(stage: &mut Stage) {
    const BAYS: u32 = 18;
    const PIER: f64 = 11.0;
    let arch = ArchBay { width: 12.0, radius: 4.6, height: 6.4, thickness: 3.2, segments: 14 };
    let mut bay = arch.wall();
    let pier = standing_box(arch.width - 2.0 * arch.radius, PIER, arch.thickness + 0.6);
    // Only the left one: the right one is the next bay's.
    bay.append_at(&pier, DVec3::new(-arch.width * 0.5, -PIER, 0.0));
    bay.append_at(&standing_box(arch.width, 0.8, arch.thickness + 0.8), DVec3::Y * arch.height);
    let bay = stage.mesh("aqueduct bay", bay);
    let turn = DAffine3::from_rotation_y(0.35);
    for i in 0..BAYS {
        let x = arch.width * (f64::from(i) - f64::from(BAYS) * 0.5);
        let placed = DAffine3::from_translation(DVec3::new(-110.0, PIER - 0.15, -160.0)) * turn;
        let placed = placed * DAffine3::from_translation(DVec3::X * x);
        stage.place("aqueduct bay", bay, stage.paint.masonry, placed);
    }
}
