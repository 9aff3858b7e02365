//! A procedural city of 10,000 to 1,000,000 instances, created in code.

mod builder;
mod building;
mod materials;
mod random;
mod shapes;
mod street;
#[cfg(test)]
mod tests;
mod traffic;

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3, Vec3};

use self::builder::CityBuilder;
use self::random::Random;
use shadowgraph_scene::{Camera, Light, LightKind, Projection, Scene};

/// The numbers of instances that a [`city`] can have.
pub const CITY_INSTANCES: RangeInclusive<u32> = 10_000..=1_000_000;

/// Width of a block of buildings with its pavement, metres.
const BLOCK_M: f64 = 60.0;
/// Width of the roadway between two blocks, metres.
const ROADWAY_M: f64 = 14.0;
/// Distance between the centres of two blocks, metres.
const PITCH_M: f64 = BLOCK_M + ROADWAY_M;
/// Height of the pavement above the roadway, metres.
const KERB_M: f64 = 0.15;

/// Creates a city of exactly this number of instances; `None` outside of [`CITY_INSTANCES`]. The same number and seed give the same
/// scene.
///
/// Square blocks of 60 m lie around the origin in rings, with streets of 14 m between them; their number grows with that of the
/// instances, to about 1,100 blocks, 2.5 km wide. A block has six buildings with a window per instance, or it is a park. It has 40
/// trees with alpha-cut leaves, parked cars, and 24 street lights (spots), up to 1,000 in all, of which the 64 nearest to the origin
/// cast shadows. Trees more than two rings away are simpler: the city has 1 to 20 million triangles.
///
/// Two cars drive around each of the inner blocks, up to 500 in all, in the animation "traffic" of 30 s.
///
/// Cameras: "street" at eye height, "crossing" over a junction, "roofs" over a large part of the city. The sun is low.
///
/// ```
/// use shadowgraph_samples::city::city;
/// let scene = city(10_000, 1).expect("a number in the range");
/// assert_eq!(scene.instances().len(), 10_000);
/// assert!(city(9_999, 1).is_none());
/// ```
#[must_use]
pub fn city(instances: u32, seed: u64) -> Option<Scene> {
    if !CITY_INSTANCES.contains(&instances) {
        return None;
    }
    let mut builder = CityBuilder::new(instances as usize);
    builder.insert_light(sun());
    for index in 0.. {
        let block = Block::new(index, seed);
        if !(builder.has_room() && block.build(&mut builder)) {
            break;
        }
    }
    let mut scene = builder.finish();
    scene.cameras = cameras();
    Some(scene)
}

/// A block of the city.
struct Block {
    /// Its number, in the order of rings around the origin.
    index: u32,
    /// The number of its ring.
    ring: u32,
    center: DVec2,
    random: Random,
}

impl Block {
    fn new(index: u32, seed: u64) -> Self {
        let cell = ring_cell(index);
        let ring = cell[0].unsigned_abs().max(cell[1].unsigned_abs());
        let center = DVec2::new(f64::from(cell[0]) + 0.5, f64::from(cell[1]) + 0.5) * PITCH_M;
        Self { index, ring, center, random: Random::new(seed, index) }
    }

    /// Adds everything on the block and the streets around it; returns whether all of it fitted.
    fn build(mut self, builder: &mut CityBuilder) -> bool {
        street::build(&mut self, builder)
            && traffic::build(&mut self, builder)
            && match self.is_park() {
                true => street::park(&mut self, builder),
                false => building::build(&mut self, builder),
            }
    }

    fn is_park(&self) -> bool {
        self.index % 11 == 7
    }

    /// Returns the world position of a point on the block, relative to its centre.
    fn to_world(&self, x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(self.center.x + x, y, self.center.y + z)
    }
}

/// Returns the cell of a grid, counted in square rings around the cell 0, 0.
fn ring_cell(index: u32) -> [i32; 2] {
    let Some(index) = index.checked_sub(1) else { return [0, 0] };
    // Rings 1 to r have 4 r (r + 1) cells.
    let ring = (0..).find(|ring| index < 4 * ring * (ring + 1)).unwrap_or(0);
    let (within, side) = (index - 4 * ring * (ring - 1), 2 * ring);
    let (radius, along) = (ring as i32, (within % side) as i32);
    match within / side {
        0 => [radius, along - radius],
        1 => [radius - along, radius],
        2 => [-radius, radius - along],
        _ => [along - radius, -radius],
    }
}

/// Returns the low evening sun.
fn sun() -> Light {
    Light {
        name: Some("sun".to_owned()),
        kind: LightKind::Directional { direction: DVec3::new(-0.78, -0.42, -0.46).normalize() },
        color: Vec3::new(1.0, 0.82, 0.62),
        intensity: 4_000.0,
        casts_shadow: true,
    }
}

fn cameras() -> Vec<Camera> {
    let named = |name: &str, eye: DVec3, target: DVec3, far: f64| {
        let projection = Projection::Perspective { fov_y: 55f64.to_radians(), near: 0.1, far: Some(far) };
        Camera { name: Some(name.to_owned()), ..Camera::look_at(eye, target, DVec3::Y, projection) }
    };
    vec![
        named("street", DVec3::new(1.2, 1.8, 70.0), DVec3::new(0.0, 4.0, 0.0), 800.0),
        named("crossing", DVec3::new(-4.0, 13.0, 26.0), DVec3::new(1.0, 1.0, -4.0), 800.0),
        named("roofs", DVec3::new(120.0, 110.0, 190.0), DVec3::new(0.0, 0.0, -40.0), 3_000.0),
    ]
}
