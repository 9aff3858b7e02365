//! Buildings: a body, bands, windows, and what stands on the roof.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec2, DVec3};

use super::builder::CityBuilder;
use super::{Block, KERB_M};
use shadowgraph_scene::MaterialKey;

/// Height of a floor, metres.
const FLOOR_M: f64 = 3.2;
/// Size of a window and how far it stands out of the wall, metres.
const WINDOW_M: DVec3 = DVec3::new(1.3, 1.7, 0.12);
/// Distance between the centres of windows at least, metres.
const WINDOW_PITCH_M: f64 = 2.6;

/// A building with a rectangular base.
struct Building {
    /// Centre of the base, relative to that of the block.
    center: DVec2,
    /// Half of its width along x and z, metres.
    half: DVec2,
    floors: u32,
    wall: MaterialKey,
    trim: MaterialKey,
    window: MaterialKey,
}

/// Adds six buildings in two rows; returns whether all of them fitted.
pub(super) fn build(block: &mut Block, builder: &mut CityBuilder) -> bool {
    (0..6).all(|lot| {
        let center = DVec2::new(f64::from(lot % 3) * 16.4 - 16.4, f64::from(lot / 3) * 26.0 - 13.0);
        let half = DVec2::new(block.random.between(6.4, 8.1), block.random.between(7.0, 10.0));
        let high = block.random.happens(if block.ring < 3 { 0.35 } else { 0.12 });
        let floors = block.random.between(3.0, 7.0) + if high { block.random.between(3.0, 9.0) } else { 0.0 };
        let building = Building {
            center,
            half,
            floors: floors as u32,
            wall: block.random.pick(&builder.materials.walls),
            trim: block.random.pick(&builder.materials.trims),
            window: block.random.pick(&builder.materials.windows),
        };
        building.bodies(block, builder) && building.windows(block, builder) && building.roof(block, builder)
    })
}

impl Building {
    fn height(&self) -> f64 {
        f64::from(self.floors) * FLOOR_M
    }

    /// Adds the body, the plinth, and a band around the first floor and the roof.
    fn bodies(&self, block: &Block, builder: &mut CityBuilder) -> bool {
        let mut part = |material, from: f64, to: f64, out: f64| {
            let size = DVec3::new((self.half.x + out) * 2.0, to - from, (self.half.y + out) * 2.0);
            builder.add_box(material, block.to_world(self.center.x, KERB_M + from, self.center.y), size)
        };
        let top = self.height();
        part(self.wall, 0.0, top, 0.0)
            && part(self.trim, 0.0, 0.5, 0.08)
            && part(self.trim, FLOOR_M - 0.1, FLOOR_M + 0.15, 0.14)
            && part(self.trim, top - 0.35, top + 0.4, 0.3)
    }

    fn windows(&self, block: &Block, builder: &mut CityBuilder) -> bool {
        (0..4).all(|side| {
            let (wide, deep) =
                if side % 2 == 0 { (self.half.x, self.half.y) } else { (self.half.y, self.half.x) };
            let columns = ((wide * 2.0 - 0.8) / WINDOW_PITCH_M) as u32;
            let turn = DQuat::from_rotation_y(f64::from(side) * FRAC_PI_2);
            let base = block.to_world(self.center.x, KERB_M, self.center.y);
            (0..self.floors * columns).all(|index| {
                let (floor, column) = (f64::from(index / columns), f64::from(index % columns));
                let along = (column + 0.5) / f64::from(columns) * 2.0 - 1.0;
                let place = DVec3::new(along * (wide - 0.2), floor * FLOOR_M + 0.95, deep);
                let transform =
                    DAffine3::from_scale_rotation_translation(WINDOW_M, turn, base + turn * place);
                builder.add(builder.shapes.window, Some(self.window), transform).is_some()
            })
        })
    }

    /// Adds a stair head, boxes of machinery, and sometimes a water tank.
    fn roof(&self, block: &mut Block, builder: &mut CityBuilder) -> bool {
        let top = KERB_M + self.height();
        let random = &mut block.random;
        let reach = self.half - 2.2;
        let places: Vec<DVec2> = (0..5)
            .map(|_| DVec2::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0)) * reach + self.center)
            .collect();
        let sizes: Vec<f64> = (0..3).map(|_| random.between(0.7, 1.5)).collect();
        let (has_tank, turn) = (random.happens(0.4), random.between(0.0, FRAC_PI_2));
        let at = |place: DVec2| block.to_world(place.x, top, place.y);
        let trim = self.trim;
        let boxes = sizes
            .iter()
            .zip(&places)
            .all(|(&size, &place)| builder.add_box(trim, at(place), DVec3::new(size * 1.4, size, size)));
        boxes
            && builder.add_box(self.wall, at(places[3]), DVec3::new(3.0, 2.6, 3.6))
            && (!has_tank || {
                let transform =
                    DAffine3::from_rotation_translation(DQuat::from_rotation_y(turn), at(places[4]));
                builder.add(builder.shapes.tank, None, transform).is_some()
            })
    }
}
