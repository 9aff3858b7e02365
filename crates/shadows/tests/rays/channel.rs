use glam::{Vec2, Vec3};
use shadowgraph_shadows::rays::{ChannelTexture, Error, Filter, RayScene, Surface, Wrap};

use crate::common::{cutout_square, insert, ray, scene, texture};

const RAMP: [u8; 4] = [0, 51, 102, 255];

fn ramp(wrap: Wrap, filter: Filter, u: f32) -> f32 {
    (texture([4, 1], &RAMP, wrap, filter).value(Vec2::new(u, 0.5)) * 255.0).round()
}

#[test]
fn nearest_reads_the_texel_that_contains_the_point() {
    for (u, texel) in [(0.0, 0.0), (0.24, 0.0), (0.26, 51.0), (0.74, 102.0), (0.99, 255.0)] {
        assert_eq!(ramp(Wrap::Repeat, Filter::Nearest, u), texel, "{u}");
    }
}

#[test]
fn bilinear_interpolates_the_texels_around_the_point() {
    for (u, texel) in [(0.125, 0.0), (0.25, 26.0), (0.375, 51.0), (0.5, 77.0)] {
        assert_eq!(ramp(Wrap::Repeat, Filter::Bilinear, u), texel, "{u}");
    }
    let four = texture([2, 2], &[0, 255, 255, 0], Wrap::Clamp, Filter::Bilinear);
    assert_eq!(four.value(Vec2::splat(0.5)), 0.5);
    assert!((four.value(Vec2::new(0.5, 0.25)) - 0.5).abs() < 1e-6);
}

#[test]
fn outside_the_square_each_axis_uses_its_own_address_mode() {
    let nearest = |wrap| [-0.4, -0.1, 1.1, 1.9, 2.1].map(|u| ramp(wrap, Filter::Nearest, u));
    assert_eq!(nearest(Wrap::Repeat), [102.0, 255.0, 0.0, 255.0, 0.0]);
    assert_eq!(nearest(Wrap::Mirror), [51.0, 0.0, 255.0, 0.0, 0.0]);
    assert_eq!(nearest(Wrap::Clamp), [0.0, 0.0, 255.0, 255.0, 255.0]);
    // At the seam between two squares.
    assert_eq!(ramp(Wrap::Repeat, Filter::Bilinear, 0.0), 128.0);
    assert_eq!(ramp(Wrap::Repeat, Filter::Bilinear, -1e-9), 128.0);
    assert_eq!(ramp(Wrap::Mirror, Filter::Bilinear, 1.0), 255.0);
    assert_eq!(ramp(Wrap::Clamp, Filter::Bilinear, 5.0), 255.0);
    let both =
        ChannelTexture::new([2, 2], vec![0, 51, 102, 255], [Wrap::Repeat, Wrap::Clamp], Filter::Nearest);
    assert_eq!(both.unwrap().value(Vec2::new(1.6, 7.0)), 1.0);
}

#[test]
fn rays_pass_only_the_holes_of_a_checkerboard() {
    let texels: Vec<u8> = (0..64).map(|i| if (i % 8 + i / 8) % 2 == 0 { 255 } else { 0 }).collect();
    let board = texture([8, 8], &texels, Wrap::Repeat, Filter::Nearest);
    let mut scene = RayScene::default();
    let board = scene.insert_texture(&[board]).unwrap();
    insert(&mut scene, &cutout_square(1.0, 4.0, Some(board), 1.0)).unwrap();
    for (column, row) in (0..64).map(|n| (n % 8, n / 8)) {
        let below = Vec3::new(column as f32 - 3.5, 0.0, row as f32 - 3.4);
        let ray = ray(below, below + Vec3::Y);
        assert_eq!(scene.is_occluded(&ray), (column + row) % 2 == 0, "{below}");
        assert_eq!(scene.nearest_distance(&ray).is_some(), (column + row) % 2 == 0, "{below}");
    }
}

#[test]
fn a_ray_continues_through_a_hole_to_the_surface_behind_it() {
    let mut occluders = cutout_square(1.0, 1.0, None, 0.2);
    occluders.extend(cutout_square(2.0, 1.0, None, 0.8));
    let scene = scene(&occluders);
    assert_eq!(scene.nearest_distance(&ray(Vec3::ZERO, Vec3::Y)), Some(2.0));
}

#[test]
fn the_factor_is_interpolated_and_multiplies_the_texture() {
    let mut scene = RayScene::default();
    let half = scene.insert_texture(&[texture([1, 1], &[128], Wrap::Repeat, Filter::Bilinear)]).unwrap();
    let mut occluders = cutout_square(1.0, 1.0, Some(half), 1.0);
    for occluder in &mut occluders {
        let across = occluder.corners.map(|corner| corner.x + 1.0);
        let Surface::Cutout(cutout) = &mut occluder.surface else { panic!() };
        cutout.alpha = across;
    }
    insert(&mut scene, &occluders).unwrap();
    let is_occluded = |x: f32| scene.is_occluded(&ray(Vec3::new(x, 0.0, 0.3), Vec3::new(x, 1.0, 0.3)));
    // 128 / 255 times x + 1 is one half at x = -0.0039.
    assert!(!is_occluded(-0.02) && is_occluded(0.02));
}

#[test]
fn a_texture_needs_one_byte_per_texel() {
    let wrap = [Wrap::Repeat; 2];
    for (size, bytes) in [([2, 2], 3), ([2, 2], 5), ([0, 4], 0), ([4, 0], 0)] {
        let error = ChannelTexture::new(size, vec![0; bytes], wrap, Filter::Nearest).unwrap_err();
        assert_eq!(error, Error::Texels { width: size[0], height: size[1], bytes });
    }
}
