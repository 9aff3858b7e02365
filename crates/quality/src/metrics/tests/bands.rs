//! Tests of the band, compared with the faces of the scene and a search of all pixels.

use std::time::{Duration, Instant};

use glam::DVec3;

use super::test_image::{Camera, TestImage, above, grazing};
use crate::metrics::band::squared_distances;
use crate::metrics::*;

/// The band by the faces that were hit, and by looking at every pixel within reach.
fn by_faces(image: &TestImage) -> Vec<bool> {
    let [width, height] = image.size;
    let samples = image.seen();
    let apart = |a: usize, b: usize| {
        let receivers = samples.is_receiver(a) && samples.is_receiver(b);
        image.faces[a] != image.faces[b] || (receivers && image.truth[a] != image.truth[b])
    };
    let at_edge = |at: usize| {
        let (x, y) = (at % width, at / width);
        (x > 0 && apart(at, at - 1))
            || (x + 1 < width && apart(at, at + 1))
            || (y > 0 && apart(at, at - width))
            || (y + 1 < height && apart(at, at + width))
    };
    let edges: Vec<usize> = (0..width * height).filter(|&at| at_edge(at)).collect();
    let inside = |at: usize| {
        let reach_px = (1.5 * f64::from(image.texel_px[at])).max(2.0);
        let near = |edge: &usize| {
            let x = (at % width) as f64 - (edge % width) as f64;
            let y = (at / width) as f64 - (edge / width) as f64;
            x.hypot(y) + 0.5 <= reach_px
        };
        edges.iter().any(near)
    };
    (0..width * height).map(inside).collect()
}

#[test]
fn the_band_is_what_a_search_of_all_pixels_finds_at_faces_and_shadows() {
    for camera in [above(), grazing()] {
        let mut image = TestImage::new([128, 72], &camera, 1e3, true);
        // A different radius for every pixel, some below 2 pixels.
        image.texel_px = image.by_pixel(|x, y| ((x * 7 + y * 13) % 5) as f32 * 1.2);
        let found = band(&image.seen());
        let expected = by_faces(&image);
        let different = (0..expected.len()).filter(|&at| found.contains(at) != expected[at]).count();
        assert_eq!(different, 0);
        assert!(found.count() > 500 && found.count() < expected.len() / 2, "{}", found.count());
    }
}

#[test]
fn a_grazing_floor_has_no_band_but_at_its_border() {
    // Down to 1 degree and with roll; the floor ends 200 m away, the sky is above.
    for up in [DVec3::Y, DVec3::new(0.4, 1.0, 0.0), DVec3::X] {
        let eye = DVec3::new(0.0, 1.6, 0.0);
        let camera = Camera { eye, target: DVec3::new(1.0, 1.55, -3.0), up, fov_y: 0.8 };
        let image = TestImage::new([320, 180], &camera, 200.0, false);
        let sky = image.faces.iter().filter(|face| **face == 0).count();
        assert!(sky > 5000 && sky < 50_000, "{sky}");
        let found = band(&image.seen());
        let expected = by_faces(&image);
        assert!((0..expected.len()).all(|at| found.contains(at) == expected[at]));
    }
}

#[test]
fn a_floor_that_fills_the_image_has_no_band_at_all() {
    for camera in [above(), grazing()] {
        let image = TestImage::new([320, 180], &camera, 1e4, false);
        assert_eq!(band(&image.seen()).count(), 0);
    }
}

#[test]
fn a_step_of_less_than_half_a_pixel_is_no_silhouette_and_a_bend_below_10_degrees_no_crease() {
    let mut image = TestImage::new([64, 48], &above(), 1e3, false);
    let pixel_m = image.pixel_m_at_1m * 6.0;
    let raised = |image: &mut TestImage, step_m: f32| {
        for at in (0..64 * 48).filter(|at| at % 64 >= 32) {
            image.positions[at].y = step_m;
        }
        band(&image.seen()).count()
    };
    assert_eq!(raised(&mut image, 0.4 * pixel_m), 0);
    assert_eq!(raised(&mut image, 0.6 * pixel_m), 4 * 48);
    assert_eq!(raised(&mut image, 0.0), 0);
    let bent = |image: &mut TestImage, degrees: f32| {
        for at in (0..64 * 48).filter(|at| at % 64 >= 32) {
            image.normals[at] = glam::Quat::from_rotation_z(degrees.to_radians()) * glam::Vec3::Y;
        }
        band(&image.seen()).count()
    };
    assert_eq!(bent(&mut image, 9.5), 0);
    assert_eq!(bent(&mut image, 10.5), 4 * 48);
}

#[test]
fn truth_that_changes_where_a_surface_turns_from_the_light_is_no_edge() {
    let mut image = TestImage::new([64, 48], &above(), 1e3, false).with_truth(|x, _| x >= 32);
    image.n_dot_l = image.by_pixel(|x, _| if x >= 32 { 0.06 } else { 0.04 });
    assert_eq!(band(&image.seen()).count(), 0);
}

#[test]
fn a_large_image_with_wide_bands_takes_well_under_a_second() {
    let mut image = TestImage::new([1280, 720], &grazing(), 1e3, true);
    image.texel_px.fill(40.0 / 1.5);
    let samples = image.seen();
    let time = |_| {
        let start = Instant::now();
        assert!(band(&samples).count() > 50_000);
        start.elapsed()
    };
    let times: Vec<Duration> = (0..5).map(time).collect();
    println!("band of 40 px at 1280x720: {times:?}");
    assert!(times.iter().any(|time| *time < Duration::from_millis(1_000)), "{times:?}");
}

#[test]
fn normals_rounded_to_a_thousandth_make_no_silhouettes_up_to_the_horizon() {
    let eye = DVec3::new(0.0, 1.6, 0.0);
    let camera = Camera { eye, target: DVec3::new(1.0, 1.6, -3.0), up: DVec3::Y, fov_y: 0.05 };
    let mut image = TestImage::new([160, 90], &camera, 5000.0, false);
    let expected = by_faces(&image);
    image.normals.fill(glam::Vec3::new(8e-4, 1.0, -5e-4).normalize());
    let found = band(&image.seen());
    assert!((0..expected.len()).all(|at| found.contains(at) == expected[at]));
}

#[test]
fn a_smooth_hill_seen_along_its_slope_has_no_band() {
    // A hill of facets that bend by 4 degrees each.
    let mut image = TestImage::new([96, 96], &above(), 1e3, false);
    let depth_m = 20.0;
    image.pixel_m_at_1m = 1e-3;
    for at in 0..96 * 96 {
        let (x, y) = ((at % 96) as f32, (at / 96) as f32);
        // Facets of 8 rows, from 40 to 85 degrees away from the camera; each row is a pixel across the view.
        let angle = |row: f32| (40.0 + 4.0 * (row / 8.0).floor()).to_radians();
        let height_m: f32 = (0..y as usize).map(|row| angle(row as f32 + 1.0).tan() * 0.02).sum();
        image.positions[at] = glam::Vec3::new(x * 0.02, height_m, -y * 0.02);
        image.normals[at] = glam::Vec3::new(0.0, angle(y).cos(), angle(y).sin());
        image.depths_m[at] = depth_m;
    }
    assert_eq!(band(&image.seen()).count(), 0);
}

#[test]
fn distances_are_those_of_a_search_of_all_marked_pixels() {
    let (width, height) = (61, 47);
    for every in [2, 6, 15, 40, 100, 700, 5000] {
        let random =
            |at: usize| (at as u32).wrapping_mul(2_654_435_761).rotate_left(15).is_multiple_of(every);
        let marked: Vec<bool> = (0..width * height).map(|at| at > 0 && random(at)).collect();
        let found = squared_distances(&marked, width);
        for (at, found) in found.iter().enumerate() {
            let squared = |other: usize| {
                let x = (at % width).abs_diff(other % width);
                (x * x + (at / width).abs_diff(other / width).pow(2)) as f32
            };
            let nearest = (0..marked.len()).filter(|&other| marked[other]).map(squared);
            assert_eq!(*found, nearest.fold(f32::INFINITY, f32::min), "1 of {every}, {at}");
        }
    }
}
