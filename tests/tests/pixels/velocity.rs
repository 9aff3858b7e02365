//! Motion vectors against motion that is computed in f64.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use shadowgraph::Gpu;
use shadowgraph::core::{Graph, Subresource};
use shadowgraph::lighting::post::Jitter;
use shadowgraph::lighting::{
    AmbientLight, Geometry, KeyLight, PosePass, Prepass, PreviousCameras, Velocity, ViewUniforms,
};
use shadowgraph::scene::gpu::GpuScene;
use shadowgraph::scene::{Camera, Influence, MeshPose, Projection, Scene, SkinWeights, origin_near};

use crate::stage::{CUBE_MAX, CUBE_MIN, SIZE_PX, camera, cube_on_floor, gpu, ray_box};

/// The largest error, pixels.
const BOUND_PX: f64 = 0.05;

/// Returns the aspect ratio of the images.
fn aspect() -> f64 {
    f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1])
}

/// Returns the position of a point in the image, pixels; of a direction (`w` 0) the position that it vanishes at.
fn pixel(camera: &Camera, point: DVec3, w: f64) -> DVec2 {
    let clip = camera.clip_from_view(aspect()) * camera.view_from_world() * point.extend(w);
    let ndc = clip.truncate().truncate() / clip.w;
    (ndc * DVec2::new(0.5, -0.5) + 0.5) * DVec2::from(SIZE_PX.map(f64::from))
}

/// Returns the origin and the direction of the ray through a position in the image.
fn ray(camera: &Camera, px: DVec2) -> (DVec3, DVec3) {
    let ndc = (px / DVec2::from(SIZE_PX.map(f64::from)) - 0.5) * DVec2::new(2.0, -2.0);
    let view_from_clip = camera.clip_from_view(aspect()).inverse();
    let at = |depth: f64| {
        let point = view_from_clip * ndc.extend(depth).extend(1.0);
        camera.world_from_view.transform_point3(point.truncate() / point.w)
    };
    (at(1.0), (at(0.5) - at(1.0)).normalize())
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Hit {
    /// A face of the cube by its normal.
    Cube(DVec3),
    Floor,
    Background,
}

/// The stage: a floor of 40 m around `offset`, and the cube with its transform in both frames.
#[derive(Clone, Copy)]
struct Stage {
    offset: DVec3,
    cube: [DAffine3; 2],
    /// Whether a skin moves the cube.
    is_skinned: bool,
}

impl Stage {
    /// Returns the stage with everything at rest.
    fn resting(offset: DVec3) -> Self {
        Self { offset, cube: [DAffine3::from_translation(offset); 2], is_skinned: false }
    }

    /// Casts a ray in the second frame. Returns what it meets, and the point in both frames or (of the background) the direction.
    fn cast(&self, (origin, direction): (DVec3, DVec3)) -> (Hit, [DVec3; 2]) {
        let local_from_world = self.cube[1].inverse();
        let to_cube = local_from_world.transform_vector3(direction);
        let from = local_from_world.transform_point3(origin);
        let cube = ray_box(from, to_cube, CUBE_MIN, CUBE_MAX);
        let floor = -origin.y / direction.y;
        let on_floor = origin + direction * floor;
        let hits_floor = floor > 0.0 && (on_floor - self.offset).abs().max_element() < 20.0;
        match cube {
            Some((distance, normal)) if !hits_floor || distance < floor => {
                let local = from + to_cube * distance;
                (Hit::Cube(normal), self.cube.map(|cube| cube.transform_point3(local)))
            }
            _ if hits_floor => (Hit::Floor, [on_floor; 2]),
            _ => (Hit::Background, [direction; 2]),
        }
    }
}

/// Moves the cube: by its transform, or by a joint of its skin that is relative to a transform which moves too.
fn move_cube(scene: &mut Scene, stage: &Stage, frame: usize) {
    let (key, instance) = scene.instances().nth(1).unwrap();
    if scene.mesh(instance.mesh).unwrap().skin.is_none() {
        return scene.move_instance(key, stage.cube[frame]).unwrap();
    }
    let anchor = DAffine3::from_translation(stage.offset + DVec3::splat(frame as f64));
    let pose = MeshPose { joints: [anchor.inverse() * stage.cube[frame]].into(), weights: vec![] };
    scene.pose_instance(key, anchor, Some(pose)).unwrap();
}

/// Gives the cube a skin of one joint.
fn add_skin(scene: &mut Scene) {
    let key = scene.instances().nth(1).unwrap().1.mesh;
    let mut mesh = scene.mesh(key).unwrap().clone();
    let influences = vec![Influence { joint: 0, weight: 1.0 }; mesh.vertices.len() * 4];
    mesh.skin = Some(SkinWeights::new(influences, 4, &mesh.vertices).unwrap());
    scene.replace_mesh(key, mesh).unwrap();
}

/// Draws the second of two frames and returns its motion vectors by row.
fn velocities(gpu: &Gpu, cameras: [&Camera; 2], jitter: Jitter, stage: &Stage) -> Vec<DVec2> {
    let mut scene = cube_on_floor(stage.offset);
    if stage.is_skinned {
        add_skin(&mut scene);
    }
    move_cube(&mut scene, stage, 0);
    let [previous, current] = cameras;
    let origins = cameras.map(|camera| origin_near(camera.position_world()));
    let mut uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene, origins[0]).unwrap();
    drop(scene.take_changes());
    if stage.cube[1] != stage.cube[0] {
        move_cube(&mut scene, stage, 1);
    }
    uploaded.update(&gpu.device, &gpu.queue, &scene, &scene.clone().take_changes()).unwrap();
    uploaded.set_origin(&gpu.device, &gpu.queue, &scene, origins[1]).unwrap();
    let previous_cameras = PreviousCameras::default();
    previous_cameras.set(0, previous, aspect());
    let (mut visible, mut graph) = (Vec::new(), Graph::new());
    uploaded.cull(&current.frustum(aspect()).into(), &mut visible);
    let draws = uploaded.draw_list(&visible, current.position_world());
    let geometry = &Geometry { scene: &uploaded, draws: &draws, culled: None, size_px: SIZE_PX };
    let prepass = Prepass::new(&gpu.device, uploaded.layouts(), 1).unwrap();
    let passes = Velocity::new(&gpu.device, uploaded.layouts()).unwrap();
    let mut frame = graph.frame();
    let ambient_light = AmbientLight::for_key_light(KeyLight { directional_lx: 1.0, local_lx: 0.0 });
    let view = ViewUniforms::new(current, SIZE_PX, &[], origins[1], &ambient_light)
        .moving(previous_cameras.motion(0, current, aspect()))
        .jittered(jitter)
        .upload(&mut frame);
    PosePass::new(&gpu.device).unwrap().add_to(&mut frame, &uploaded);
    let depth = prepass.add_to(&mut frame, &view, geometry);
    let velocity = passes.add_to(&mut frame, &view, &depth, geometry);
    let request = frame.read_back_texture(&velocity, Subresource::FULL);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame).unwrap().execute(&mut graph, &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let bytes = executed.read_back(request).unwrap().wait(&gpu.device).unwrap();
    let axis = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().unwrap()));
    bytes.chunks_exact(8).map(|texel| DVec2::new(axis(&texel[..4]), axis(&texel[4..]))).collect()
}

/// Compares all pixels but those at edges, and returns the largest error and the longest motion, pixels. At least `kinds` of what
/// rays meet must be seen.
fn compare(gpu: &Gpu, cameras: [&Camera; 2], jitter: Jitter, stage: &Stage, kinds: usize) -> [f64; 2] {
    let [previous, current] = cameras;
    let found = velocities(gpu, cameras, jitter, stage);
    let (mut worst, mut longest, mut seen, mut skipped) = (0.0f64, 0.0f64, Vec::new(), 0);
    for (index, velocity) in (0..).zip(&found) {
        let corner = DVec2::new(f64::from(index % SIZE_PX[0]), f64::from(index / SIZE_PX[0]));
        let at = corner + 0.5 - jitter.offset_px().as_dvec2();
        let cast_at = |by: DVec2| stage.cast(ray(current, at + by));
        let (hit, [before, now]) = cast_at(DVec2::ZERO);
        if [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().any(|by| cast_at(*by * 0.1).0 != hit) {
            skipped += 1;
            continue;
        }
        let w = if hit == Hit::Background { 0.0 } else { 1.0 };
        let expected = pixel(previous, before, w) - pixel(current, now, w);
        assert!(velocity.is_finite(), "{hit:?} at {at}: {velocity}");
        worst = worst.max(velocity.distance(expected));
        longest = longest.max(expected.length());
        if !seen.contains(&hit) {
            seen.push(hit);
        }
    }
    assert!(skipped < found.len() / 50 && seen.len() >= kinds, "{skipped} skipped, seen {seen:?}");
    println!("velocity: wrong by at most {worst:.5} of {longest:.1} pixels");
    [worst, longest]
}

#[test]
fn velocity_of_a_moving_camera_is_the_analytic_motion() {
    let Some(gpu) = gpu() else { return };
    let rest_stage = Stage::resting(DVec3::ZERO);
    let rest = camera(DVec3::new(2.0, 1.6, 4.0), DVec3::new(0.0, 0.8, 0.0));
    let walks = camera(DVec3::new(2.1, 1.7, 3.7), DVec3::new(0.1, 0.9, -0.3));
    let turns = camera(DVec3::new(2.0, 1.6, 4.0), DVec3::new(2.5, 0.9, 0.0));
    let infinite =
        Camera { projection: Projection::Perspective { fov_y: 0.9, near: 0.01, far: None }, ..walks.clone() };
    // The field of view changes too.
    let zooms =
        Camera { projection: Projection::Perspective { fov_y: 0.6, near: 0.1, far: None }, ..turns.clone() };
    for (moved, jitter) in [(&walks, 3), (&turns, 0), (&infinite, 5), (&zooms, 7)] {
        let [worst, longest] = compare(gpu, [&rest, moved], Jitter::for_frame(jitter), &rest_stage, 4);
        assert!(worst < BOUND_PX && longest > 10.0, "{worst} of {longest}");
    }
    // Motions by hundreds of pixels.
    let [worst, longest] = compare(gpu, [&turns, &rest], Jitter::for_frame(1), &rest_stage, 4);
    assert!(worst < BOUND_PX && longest > 150.0, "{worst} of {longest}");
}

#[test]
fn a_camera_that_stands_still_has_no_velocity_at_all() {
    let Some(gpu) = gpu() else { return };
    let rest = camera(DVec3::new(2.0, 1.6, 4.0), DVec3::new(0.0, 0.8, 0.0));
    let found = velocities(gpu, [&rest, &rest], Jitter::for_frame(4), &Stage::resting(DVec3::ZERO));
    assert!(found.iter().all(|velocity| *velocity == DVec2::ZERO));
}

#[test]
fn velocity_is_right_in_the_frame_in_which_the_origin_moves() {
    let Some(gpu) = gpu() else { return };
    // On both sides of the border between two points of the origin's grid.
    let offset = DVec3::new(10_000.0 * 1024.0 + 512.0, 0.0, 0.0);
    let at = |x: f64| camera(offset + DVec3::new(x, 1.6, 4.0), offset + DVec3::new(x - 1.0, 0.8, 0.0));
    let (before, after) = (at(-0.05), at(0.05));
    assert_ne!(origin_near(before.position_world()), origin_near(after.position_world()));
    let [worst, longest] = compare(gpu, [&before, &after], Jitter::for_frame(2), &Stage::resting(offset), 3);
    assert!(worst < BOUND_PX && longest > 3.0, "{worst} of {longest}");
}

#[test]
fn an_orthographic_camera_has_velocity() {
    let Some(gpu) = gpu() else { return };
    let at = |x: f64| {
        let projection = Projection::Orthographic { half_width: 3.0, half_height: 2.0, near: 0.1, far: 60.0 };
        Camera { projection, ..camera(DVec3::new(x, 3.0, 4.0), DVec3::new(x, 0.0, 0.0)) }
    };
    let [worst, longest] =
        compare(gpu, [&at(0.4), &at(0.0)], Jitter::for_frame(6), &Stage::resting(DVec3::ZERO), 3);
    assert!(worst < BOUND_PX && longest > 15.0, "{worst} of {longest}");
}

#[test]
fn velocity_of_rigid_and_skinned_instances_is_the_analytic_motion() {
    let Some(gpu) = gpu() else { return };
    let rest = camera(DVec3::new(2.0, 1.6, 4.0), DVec3::new(0.0, 0.8, 0.0));
    let walks = camera(DVec3::new(2.1, 1.7, 3.7), DVec3::new(0.1, 0.9, -0.3));
    let transform = |at: DVec3, turn: f64, scale: DVec3| {
        let rotation = DQuat::from_rotation_y(turn) * DQuat::from_rotation_x(0.4 * turn);
        DAffine3::from_scale_rotation_translation(scale, rotation, at)
    };
    let from = transform(DVec3::new(0.0, 0.3, 0.0), 0.2, DVec3::ONE);
    let falls = transform(DVec3::new(0.0, 0.1, 0.0), 0.2, DVec3::ONE);
    let tumbles = transform(DVec3::new(0.4, 0.6, 0.5), 0.9, DVec3::ONE);
    let grows = transform(DVec3::new(-0.3, 0.4, 0.2), 0.3, DVec3::new(1.3, 0.8, -1.1));
    let back = transform(DVec3::new(-0.2, 0.4, 0.3), 0.2, DVec3::new(1.2, 0.8, -1.0));
    let motions = [([from, falls], &rest, 1), ([from, tumbles], &walks, 6), ([grows, back], &walks, 0)];
    for ((cube, camera, jitter), is_skinned) in
        motions.into_iter().flat_map(|motion| [(motion, false), (motion, true)])
    {
        // A skin gives one winding to all its triangles: its first joint is mirrored only with the instance.
        if is_skinned && cube[0].matrix3.determinant() < 0.0 {
            continue;
        }
        let stage = Stage { offset: DVec3::ZERO, cube, is_skinned };
        let [worst, longest] = compare(gpu, [&rest, camera], Jitter::for_frame(jitter), &stage, 4);
        assert!(worst < BOUND_PX && longest > 8.0, "{worst} of {longest}");
    }
}
