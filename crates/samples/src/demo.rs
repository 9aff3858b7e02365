//! The built-in demo scene: a stone courtyard in the evening sun, created in code.

mod arch;
mod builder;
mod court;
mod far;
mod hall;
mod motion;
pub(crate) mod noise;
mod props;
mod textures;

use glam::{DVec3, Vec3};

use self::builder::SceneBuilder;
use shadowgraph_scene::{Camera, Light, LightKind, Projection, Scene};

/// Elevation of the sun above the horizon, degrees.
const SUN_ELEVATION_DEG: f64 = 33.0;
/// Heading of the sunlight, from east towards north, degrees.
const SUN_HEADING_DEG: f64 = 25.0;

/// Creates the demo scene: a courtyard of about 30 m with an arcade, stairs, an alpha-tested fence, a ball on the
/// ground, a flagpole with ropes, towers up to 200 m away; one sun, and three coloured spots in a shaded hall.
///
/// Its animation of 12 s turns the rings in the hall, swings the lanterns of the spots, and sways the flag and the banners.
///
/// Cameras: "courtyard" shows all of it, "contact" is close to the ball and the fence. The scene is always the
/// same, has fewer than 60,000 triangles and needs no file.
///
/// ```
/// let scene = shadowgraph_samples::demo::demo_scene();
/// assert_eq!(scene.lights().len(), 4);
/// assert_eq!(scene.cameras[0].name.as_deref(), Some("courtyard"));
/// ```
#[must_use]
pub fn demo_scene() -> Scene {
    let mut builder = SceneBuilder::new();
    court::build(&mut builder);
    props::build(&mut builder);
    hall::build(&mut builder);
    far::build(&mut builder);
    let mut scene = builder.scene;
    scene.insert_light(sun());
    scene.cameras = cameras();
    scene
}

/// Returns the sun: warm light from the south-west.
fn sun() -> Light {
    let (sin, cos) = SUN_ELEVATION_DEG.to_radians().sin_cos();
    let (north, east) = SUN_HEADING_DEG.to_radians().sin_cos();
    Light {
        name: Some("sun".to_owned()),
        kind: LightKind::Directional { direction: DVec3::new(east * cos, -sin, -north * cos) },
        color: Vec3::new(1.0, 0.90, 0.76),
        intensity: 20_000.0,
        casts_shadow: true,
    }
}

/// Returns the cameras: the whole court, and the contact of the ball with the ground.
fn cameras() -> Vec<Camera> {
    let named = |name: &str, eye: DVec3, target: DVec3, fov_deg: f64| {
        let projection = Projection::Perspective { fov_y: fov_deg.to_radians(), near: 0.1, far: Some(320.0) };
        Camera { name: Some(name.to_owned()), ..Camera::look_at(eye, target, DVec3::Y, projection) }
    };
    let (ball, radius) = props::BALL;
    vec![
        named("courtyard", DVec3::new(9.6, 4.9, 14.4), DVec3::new(-2.3, 1.7, -4.6), 46.0),
        named("contact", ball + DVec3::new(2.6, 3.2, 5.2), ball + DVec3::new(-0.6, radius * 0.4, -0.2), 38.0),
    ]
}

#[cfg(test)]
mod tests;
