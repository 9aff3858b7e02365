#![allow(clippy::unwrap_used, reason = "tests")]

use proptest::prelude::*;

use super::*;

fn perspective(far: Option<f64>) -> Camera {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far };
    Camera::look_at(DVec3::new(3.0, 4.0, 5.0), DVec3::new(-1.0, 0.5, 0.0), DVec3::Y, projection)
}

fn orthographic() -> Camera {
    let projection = Projection::Orthographic { half_width: 3.0, half_height: 2.0, near: 0.5, far: 40.0 };
    Camera::look_at(DVec3::new(3.0, 4.0, 5.0), DVec3::new(-1.0, 0.5, 0.0), DVec3::Y, projection)
}

fn clip(camera: &Camera, aspect: f64, view: DVec3) -> DVec3 {
    let clip = camera.clip_from_view(aspect) * view.extend(1.0);
    clip.truncate() / clip.w
}

#[test]
fn depth_is_one_at_the_near_plane_and_zero_at_the_far_plane() {
    for (camera, far) in [(perspective(Some(50.0)), 50.0), (perspective(None), 1e15), (orthographic(), 40.0)]
    {
        assert!((clip(&camera, 1.5, DVec3::NEG_Z * camera.near()).z - 1.0).abs() < 1e-12);
        assert!(clip(&camera, 1.5, DVec3::NEG_Z * far).z.abs() < 1e-12);
    }
}

#[test]
fn corners_of_a_slice_project_to_the_corners_of_the_image() {
    for camera in [perspective(Some(50.0)), orthographic()] {
        for aspect in [0.5, 1.5, 3.0] {
            for (i, corner) in camera.slice_corners_view(aspect, 1.0, 20.0).into_iter().enumerate() {
                let clip = clip(&camera, aspect, corner);
                let expected =
                    DVec2::new(if i & 1 == 0 { -1.0 } else { 1.0 }, if i & 2 == 0 { -1.0 } else { 1.0 });
                assert!(clip.truncate().abs_diff_eq(expected, 1e-12), "{clip}");
            }
        }
    }
}

#[test]
fn an_orthographic_image_is_never_stretched_or_cropped() {
    for aspect in [0.5, 1.5, 3.0] {
        let half = orthographic().half_size(aspect, 1.0);
        assert!((half.x / half.y - aspect).abs() < 1e-12);
        assert!(half.x >= 3.0 && half.y >= 2.0);
    }
}

#[test]
fn look_at_is_rigid_and_upright_even_where_the_direction_is_undefined() {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
    for (eye, up) in
        [(DVec3::Y, DVec3::Y), (DVec3::ZERO, DVec3::Y), (DVec3::Z, DVec3::ZERO), (DVec3::X, DVec3::Y)]
    {
        let camera = Camera::look_at(eye, DVec3::ZERO, up, projection);
        let rotation = camera.world_from_view.matrix3;
        assert!((rotation * rotation.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12));
        assert!((rotation.determinant() - 1.0).abs() < 1e-12);
    }
    assert!(perspective(None).world_from_view.matrix3.y_axis.y > 0.0);
}

#[test]
fn framing_shows_every_corner_and_fills_the_image() {
    let box_of = |min: [f64; 3], max: [f64; 3]| Aabb { min: min.into(), max: max.into() };
    let cases = [
        box_of([-1.0; 3], [1.0; 3]),
        box_of([-300.0, 0.0, -300.0], [300.0, 2.0, 300.0]),
        box_of([0.0; 3], [0.001, 0.05, 0.001]),
        box_of([9999.0, 0.0, 0.0], [10001.0, 0.0, 2.0]),
        box_of([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]),
        box_of([0.0, -1.0, -1.0], [0.0, 1.0, 1.0]),
        box_of([-1e6; 3], [1e6; 3]),
    ];
    for bounds in cases {
        for aspect in [0.5, 16.0 / 9.0] {
            let camera = Camera::framing(&bounds, aspect);
            let clips = bounds
                .corners()
                .map(|corner| clip(&camera, aspect, camera.view_from_world().transform_point3(corner)));
            let extent = clips.iter().map(|clip| clip.truncate().abs().max_element()).fold(0.0, f64::max);
            assert!((0.9..=0.96).contains(&extent), "{bounds:?} extends to {extent}");
            assert!(clips.iter().all(|clip| clip.z > 0.0 && clip.z < 1.0), "{bounds:?} {clips:?}");
            assert!(camera.position_world().y > bounds.center().y);
        }
    }
}

#[test]
fn framing_a_point_or_an_empty_box_gives_a_valid_camera() {
    for bounds in [
        Aabb::EMPTY,
        Aabb { min: DVec3::ONE, max: DVec3::ONE },
        Aabb { min: DVec3::splat(1e9), max: DVec3::splat(1e9) },
    ] {
        let camera = Camera::framing(&bounds, 1.5);
        assert!(camera.world_from_view.is_finite());
        assert!(camera.near() > 0.0 && camera.far().unwrap() > camera.near());
        assert!(camera.frustum(1.5).contains_point(bounds.center()));
    }
}

proptest! {
    #[test]
    fn the_frustum_contains_exactly_what_projects_into_the_image(
        x in -30.0..30.0, y in -30.0..30.0, z in -60.0..5.0, aspect in 0.3..3.0, ortho: bool,
    ) {
        let camera = if ortho { orthographic() } else { perspective(Some(50.0)) };
        let view = DVec3::new(x, y, z);
        let point = camera.world_from_view.transform_point3(view);
        let clip = camera.clip_from_view(aspect) * view.extend(1.0);
        let inside = clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z >= 0.0 && clip.z <= clip.w;
        // Points on the border may fall to either side.
        let border = [clip.w - clip.x.abs(), clip.w - clip.y.abs(), clip.z, clip.w - clip.z];
        prop_assume!(border.iter().all(|distance| distance.abs() > 1e-9));
        prop_assert_eq!(camera.frustum(aspect).contains_point(point), inside);
    }

    #[test]
    fn culling_never_rejects_a_box_with_a_point_inside(
        center in prop::array::uniform3(-60.0..60.0), half in prop::array::uniform3(0.0..20.0),
        at in prop::array::uniform3(-1.0..=1.0), aspect in 0.3..3.0, kind in 0usize..3,
    ) {
        let camera = [perspective(Some(50.0)), perspective(None), orthographic()].into_iter().nth(kind).unwrap();
        let (center, half) = (DVec3::from(center), DVec3::from(half));
        let bounds = Aabb { min: center - half, max: center + half };
        let point = (center + half * DVec3::from(at)).clamp(bounds.min, bounds.max);
        let frustum = camera.frustum(aspect);
        prop_assert!(!frustum.contains_point(point) || frustum.intersects(&bounds));
    }
}

#[test]
fn errors_of_invalid_cameras_name_the_value() {
    let angle = |fov_y, near, far| Projection::Perspective { fov_y, near, far };
    let boxed =
        |half_width, half_height, near, far| Projection::Orthographic { half_width, half_height, near, far };
    for (projection, aspect, text) in [
        (angle(0.0, 0.1, None), 1.0, "vertical field of view is 0 radians"),
        (angle(3.2, 0.1, None), 1.0, "vertical field of view is 3.2 radians"),
        (angle(f64::NAN, 0.1, None), 1.0, "vertical field of view is NaN radians"),
        (angle(1.0, 0.0, None), 1.0, "near plane is at 0 m"),
        (angle(1.0, f64::INFINITY, None), 1.0, "near plane is at inf m"),
        (angle(1.0, 2.0, Some(2.0)), 1.0, "far plane is at 2 m; it must be beyond its near plane, at 2 m"),
        (angle(1.0, 2.0, Some(f64::NAN)), 1.0, "far plane is at NaN m"),
        (boxed(0.0, 1.0, 0.0, 1.0), 1.0, "half width is 0 m and its half height 1 m"),
        (boxed(1.0, 1.0, f64::NAN, 1.0), 1.0, "near plane is at NaN m"),
        (boxed(1.0, 1.0, 1.0, -1.0), 1.0, "far plane is at -1 m"),
        (angle(1.0, 0.1, None), f64::NAN, "aspect ratio is NaN"),
        (angle(1.0, 0.1, None), 0.0, "aspect ratio is 0"),
    ] {
        let camera = Camera { projection, ..perspective(None) };
        let error = camera.check(aspect).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
    let mut infinite = perspective(None);
    infinite.world_from_view.translation.y = f64::INFINITY;
    assert_eq!(infinite.check(1.0), Err(CameraError::Transform));
    assert_eq!(perspective(None).check(1.0), Ok(()));
    // An orthographic near plane may lie behind the camera.
    let behind = Camera { projection: boxed(1.0, 1.0, -5.0, 5.0), ..perspective(None) };
    assert_eq!(behind.check(1.0), Ok(()));
}
