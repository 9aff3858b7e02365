//! Distant towers, an obelisk and an aqueduct, whose shadows lie beyond any near shadow map.

use glam::{DAffine3, DVec3};

use super::arch::ArchBay;
use super::builder::SceneBuilder;
use crate::mesh_builder::{MeshBuilder, box_on_ground, tapered_shaft};

/// Adds all distant objects.
pub(super) fn build(builder: &mut SceneBuilder) {
    let tower = builder.add_mesh("tower", tower());
    for (x, z, rotation, size) in
        [(-74.0, -66.0, 0.3, 1.0), (-62.0, -150.0, 0.8, 1.2), (70.0, -120.0, 0.1, 1.0)]
    {
        let transform = DAffine3::from_scale_rotation_translation(
            DVec3::splat(size),
            glam::DQuat::from_rotation_y(rotation),
            DVec3::new(x, -0.15, z),
        );
        builder.add_instance("tower", tower, builder.materials.masonry, transform);
    }
    let mut obelisk = box_on_ground(7.0, 1.2, 7.0);
    obelisk.append_translated(&box_on_ground(5.0, 1.4, 5.0), DVec3::Y * 1.2);
    obelisk.append_translated(&tapered_shaft(2.6..=27.0, 1.7, 1.1), DVec3::ZERO);
    obelisk.append_translated(&tapered_shaft(27.0..=29.4, 1.1, 0.02), DVec3::ZERO);
    let obelisk = builder.add_mesh("obelisk", obelisk);
    builder.add_instance_at("obelisk", obelisk, builder.materials.stone, DVec3::new(2.0, -0.15, -105.0));
    aqueduct(builder);
}

/// Returns a square tower of about 34 m with ledges and a roof.
fn tower() -> MeshBuilder {
    let mut shape = tapered_shaft(0.0..=4.0, 4.6, 3.8);
    shape.append_translated(&tapered_shaft(4.0..=26.0, 3.5, 3.2), DVec3::ZERO);
    shape.append_translated(&box_on_ground(8.0, 1.0, 8.0), DVec3::Y * 18.0);
    shape.append_translated(&box_on_ground(8.4, 0.9, 8.4), DVec3::Y * 25.6);
    for (x, z) in [(-3.4, -3.4), (3.4, -3.4), (-3.4, 3.4), (3.4, 3.4)] {
        shape.append_translated(&box_on_ground(1.1, 3.4, 1.1), DVec3::new(x, 26.5, z));
    }
    shape.append_translated(&box_on_ground(8.4, 0.5, 8.4), DVec3::Y * 29.9);
    shape.append_translated(&tapered_shaft(30.4..=35.5, 3.9, 0.05), DVec3::ZERO);
    shape
}

/// Adds a row of tall arches across the plain.
fn aqueduct(builder: &mut SceneBuilder) {
    const BAYS: u32 = 18;
    const PIER: f64 = 11.0;
    let arch = ArchBay { width: 12.0, radius: 4.6, height: 6.4, thickness: 3.2, segments: 14 };
    let mut bay = arch.wall();
    let pier = box_on_ground(arch.width - 2.0 * arch.radius, PIER, arch.thickness + 0.6);
    // Only the left pier: the right one belongs to the next bay.
    bay.append_translated(&pier, DVec3::new(-arch.width * 0.5, -PIER, 0.0));
    bay.append_translated(&box_on_ground(arch.width, 0.8, arch.thickness + 0.8), DVec3::Y * arch.height);
    let bay = builder.add_mesh("aqueduct bay", bay);
    let rotation = DAffine3::from_rotation_y(0.35);
    for i in 0..BAYS {
        let x = arch.width * (f64::from(i) - f64::from(BAYS) * 0.5);
        let transform = DAffine3::from_translation(DVec3::new(-110.0, PIER - 0.15, -160.0)) * rotation;
        let transform = transform * DAffine3::from_translation(DVec3::X * x);
        builder.add_instance("aqueduct bay", bay, builder.materials.masonry, transform);
    }
}
