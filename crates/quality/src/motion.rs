//! Cameras and suns that move a little from frame to frame.

use glam::{DAffine3, DVec3};
use shadowgraph_scene::{Camera, EditError, LightKind, Projection, Scene};

use super::comparator::pixel_m_at_1m;
use super::report::Motion;

/// Movement on screen from one frame to the next, pixels.
pub const STEP_PX: f64 = 0.37;

/// Ten kilometres, where f32 has steps of a millimetre.
pub const FAR_OFFSET_M: DVec3 = DVec3::new(8_000.0, 0.0, 6_000.0);

/// Returns the camera for a frame of a motion. `height_px` is the height of the image. Objects at the distance
/// `distance_m` move by [`STEP_PX`] when the camera translates.
#[must_use]
pub fn camera_for_frame(
    camera: &Camera,
    motion: Motion,
    frame: u32,
    height_px: u32,
    distance_m: f64,
) -> Camera {
    let pixels = STEP_PX * f64::from(frame);
    let pixel = f64::from(pixel_m_at_1m(camera, height_px));
    let (step, projection) = match motion {
        Motion::Translate => {
            let offset_m = match camera.projection {
                Projection::Perspective { .. } => pixels * pixel * distance_m,
                Projection::Orthographic { .. } => pixels * pixel,
            };
            (DAffine3::from_translation(DVec3::new(0.8, 0.0, -0.6) * offset_m), camera.projection)
        }
        Motion::Rotate => {
            let yaw = DAffine3::from_rotation_y(pixels * pixel * 0.9);
            (yaw * DAffine3::from_rotation_x(pixels * pixel * 0.4), camera.projection)
        }
        // The upper edge of the image moves by the step.
        Motion::Zoom => {
            let factor = (1.0 - STEP_PX / (0.5 * f64::from(height_px))).powi(frame as i32);
            (DAffine3::IDENTITY, zoomed(camera.projection, factor))
        }
    };
    Camera { name: camera.name.clone(), world_from_view: camera.world_from_view * step, projection }
}

/// Returns the camera for a frame of a walk: it moves for 16 frames, then it turns, by [`STEP_PX`] each frame. As
/// [`camera_for_frame`] otherwise.
#[must_use]
pub fn camera_walk(camera: &Camera, frame: u32, height_px: u32, distance_m: f64) -> Camera {
    let walked = camera_for_frame(camera, Motion::Translate, frame.min(16), height_px, distance_m);
    camera_for_frame(&walked, Motion::Rotate, frame.saturating_sub(16), height_px, distance_m)
}

/// Turn of the sun from one frame to the next, radians: 0.05 degrees, as in 12 seconds of a day.
pub const SUN_STEP: f64 = 0.05 * std::f64::consts::PI / 180.0;

/// Returns the direction of a sun's light for a frame of its path, on a great circle that changes azimuth and elevation, by
/// [`SUN_STEP`] each frame. `direction` is not zero.
#[must_use]
pub fn turned_sun(direction: DVec3, frame: u32) -> DVec3 {
    let from = direction.normalize();
    let east = DVec3::Y.cross(from).try_normalize().unwrap_or(DVec3::X);
    let across = 0.8 * east + 0.6 * from.cross(east);
    let (sin, cos) = (SUN_STEP * f64::from(frame)).sin_cos();
    from * cos + across * sin
}

fn zoomed(projection: Projection, factor: f64) -> Projection {
    match projection {
        Projection::Perspective { fov_y, near, far } => {
            Projection::Perspective { fov_y: 2.0 * ((fov_y * 0.5).tan() * factor).atan(), near, far }
        }
        Projection::Orthographic { half_width, half_height, near, far } => Projection::Orthographic {
            half_width: half_width * factor,
            half_height: half_height * factor,
            near,
            far,
        },
    }
}

/// Returns a scene with all its instances and lights moved by `offset`; its cameras stay.
///
/// # Errors
/// For an offset that is not finite.
pub(super) fn translated(scene: &Scene, offset: DVec3) -> Result<Scene, EditError> {
    let mut moved = scene.clone();
    for (key, instance) in scene.instances() {
        let mut transform = instance.world_from_local;
        transform.translation += offset;
        moved.move_instance(key, transform)?;
    }
    let lights = scene.lights().iter().cloned().map(|mut light| {
        match &mut light.kind {
            LightKind::Spot { position_world, .. } | LightKind::Point { position_world, .. } => {
                *position_world += offset;
            }
            LightKind::Directional { .. } => {}
        }
        light
    });
    moved.set_lights(lights);
    Ok(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEIGHT_PX: u32 = 180;

    fn camera() -> Camera {
        let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
        Camera::look_at(DVec3::new(1.0, 2.0, 5.0), DVec3::ZERO, DVec3::Y, projection)
    }

    /// Returns the position of a point in an image of 320x180, pixels.
    fn pixel(camera: &Camera, point: DVec3) -> DVec3 {
        let clip = camera.clip_from_view(320.0 / 180.0) * camera.view_from_world() * point.extend(1.0);
        clip.truncate() / clip.w * DVec3::new(160.0, 90.0, 0.0)
    }

    #[test]
    fn every_motion_moves_the_image_by_a_fraction_of_a_pixel_per_frame() {
        let camera = camera();
        let target = camera.position_world() + camera.forward_world() * 5.4;
        // Not the centre, because zooming does not move it.
        let point = target + DVec3::Y * 1.8;
        for motion in [Motion::Translate, Motion::Rotate, Motion::Zoom] {
            let at = |frame| pixel(&camera_for_frame(&camera, motion, frame, HEIGHT_PX, 5.4), point);
            for frame in 0..64 {
                let step = at(frame).distance(at(frame + 1));
                assert!((0.05..0.8).contains(&step), "{motion:?}, frame {frame}: {step} pixels");
            }
        }
    }

    #[test]
    fn the_sun_turns_by_a_twentieth_of_a_degree_in_azimuth_and_elevation() {
        for direction in [DVec3::new(0.5, -1.0, -0.6), DVec3::NEG_Y, DVec3::new(2.0, -0.1, 0.0)] {
            assert!(turned_sun(direction, 0).distance(direction.normalize()) < 1e-12);
            for frame in 0..32 {
                let (before, after) = (turned_sun(direction, frame), turned_sun(direction, frame + 1));
                assert!((before.angle_between(after).to_degrees() - 0.05).abs() < 1e-9, "{direction}");
            }
            assert!(turned_sun(direction, 31).y > direction.normalize().y || direction.x == 0.0);
        }
    }

    #[test]
    fn the_first_frame_has_the_original_camera() {
        for motion in [Motion::Translate, Motion::Rotate, Motion::Zoom] {
            let first = camera_for_frame(&camera(), motion, 0, HEIGHT_PX, 5.0);
            assert!(first.world_from_view.abs_diff_eq(camera().world_from_view, 1e-12), "{motion:?}");
        }
    }
}
