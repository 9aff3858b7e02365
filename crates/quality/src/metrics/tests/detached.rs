//! Shadows that begin late, in perspective.

use glam::DVec3;

use super::test_image::{Camera, TestImage, above, box_shadows, grazing, sun};
use crate::metrics::*;

/// The box's shadow moved along the floor, away from the sun.
fn moved_away(image: &TestImage, by_m: f64) -> Vec<f32> {
    let towards = sun().with_y(0.0).normalize();
    let lit = |at: usize| {
        let point = image.positions[at].as_dvec3();
        image.faces[at] != 1 || !box_shadows(point + towards * by_m)
    };
    (0..image.truth.len()).map(|at| f32::from(u8::from(lit(at)))).collect()
}

#[test]
fn a_shadow_moved_away_by_20_cm_is_detached_by_20_cm() {
    // The longest way of a step on the floor next to the box, rounded to pixels, cm.
    for (camera, pixel_cm) in [(above(), 2.5), (grazing(), 4.5)] {
        let mut image = TestImage::new([640, 360], &camera, 1e3, true);
        for by_m in [0.2, 0.1] {
            image.visibility = moved_away(&image, by_m);
            let all = image.all();
            let PeterPanning { cm, texels, missing } = all.peter_panning;
            println!("{by_m} m: {:?}, {:?}", all.peter_panning, all.missing_contacts);
            assert!(cm.count > 50, "{cm:?}");
            assert!((cm.mean - by_m * 100.0).abs() < pixel_cm / 4.0, "{cm:?}");
            assert!((cm.p99 - by_m * 100.0).abs() < pixel_cm, "{cm:?}");
            // Texels are 5 cm wide.
            assert!((texels.mean - cm.mean / 5.0).abs() < 1e-4 && texels.count == cm.count);
            assert!(missing * 20 < cm.count, "{missing} of {}", cm.count);
            // Near blockers are within 25 cm along the ray, 21.6 cm along the floor.
            let share = by_m * 100.0 / (25.0 * 30.0_f64.to_radians().cos());
            let missing_fraction = all.missing_contacts.missing_percent / 100.0;
            assert!((missing_fraction - share).abs() < 0.08, "{missing_fraction} {share}");
        }
    }
}

#[test]
fn a_shadow_that_is_missing_altogether_is_lost_with_its_length() {
    for camera in [above(), grazing()] {
        let mut image = TestImage::new([320, 180], &camera, 1e3, true);
        image.visibility.fill(1.0);
        let all = image.all();
        assert_eq!(all.peter_panning.missing, all.peter_panning.cm.count);
        assert_eq!(all.missing_contacts.missing_percent, 100.0);
        // 1 m high, the sun at 30 degrees: up to 173 cm, less from the shorter chords at the corners.
        assert!(
            all.peter_panning.cm.mean > 60.0 && all.peter_panning.cm.p99 < 180.0,
            "{:?}",
            all.peter_panning
        );
    }
}

#[test]
fn texels_count_only_where_their_size_is_known_and_widen_what_counts_as_contact() {
    let mut image = TestImage::new([320, 180], &above(), 1e3, true);
    image.visibility = moved_away(&image, 0.2);
    image.texel_m.fill(0.0);
    let unknown = image.all().peter_panning;
    assert_eq!((unknown.texels, unknown.cm.count > 0), (Summary::default(), true));
    // At 40 cm away nothing touches, unless a texel is as wide.
    let away: Vec<f32> = image.blockers_m.iter().map(|distance| distance + 0.3).collect();
    image.blockers_m = away;
    assert_eq!(image.all().peter_panning.cm.count, 0);
    image.texel_m.fill(0.4);
    assert!(image.all().peter_panning.cm.count >= unknown.cm.count);
}

#[test]
fn light_nearly_straight_from_above_detaches_nothing() {
    let mut image = TestImage::new([320, 180], &above(), 1e3, true);
    image.visibility.fill(1.0);
    let images = Images {
        towards_light: TowardsLight::Uniform(glam::Vec3::new(0.05, 1.0, 0.05).normalize()),
        ..image.images()
    };
    assert_eq!(peter_panning(&Samples::new(images).unwrap()).cm.count, 0);
}

#[test]
fn directions_per_pixel_measure_like_one_for_all() {
    let mut image = TestImage::new([320, 180], &grazing(), 1e3, true);
    image.visibility = moved_away(&image, 0.2);
    let directions = vec![sun().as_vec3(); image.truth.len()];
    let images = Images { towards_light: TowardsLight::PerPixel(&directions), ..image.images() };
    assert_eq!(peter_panning(&Samples::new(images).unwrap()), image.all().peter_panning);
}

/// A bare floor from above, rows along the world's x. The sun is up and to the left, 3 pixels to 4. Columns
/// 10 to 19 should be dark but are measured as lit, with a near blocker; those before are no receivers.
/// Returns the side of a pixel too.
fn stripe() -> (TestImage, f64) {
    let camera = Camera { up: DVec3::NEG_Z, ..above() };
    let mut image = TestImage::new([64, 48], &camera, 1e3, false);
    image.truth = image.by_pixel(|x, _| f32::from(u8::from(!(10..20).contains(&x))));
    image.blockers_m.fill(0.01);
    image.n_dot_l = image.by_pixel(|x, _| if x < 10 { 0.0 } else { 0.5 });
    let pixel_cm = f64::from(image.positions[1].x - image.positions[0].x) * 100.0;
    (image, pixel_cm)
}

/// Number of contacts, longest distance in pixels, number of missing ones. The lowest rows leave the image first.
fn walked((image, pixel_cm): (TestImage, f64)) -> (usize, f64, usize) {
    let PeterPanning { cm, missing, .. } = image.all().peter_panning;
    (cm.count, (cm.p99 / pixel_cm * 1e3).round() / 1e3, missing)
}

#[test]
fn a_walk_goes_along_the_light_until_it_is_dark_or_lost() {
    // A step is 0.75 right and 1 down. The first pixel right of column 19 is 10 right and 13 down; along
    // (0.6, 0.8) that is 6 + 10.4.
    assert_eq!(walked(stripe()), (48, 16.4, 48));
    // Dark from column 13 on: 3 right and 4 down, 5 pixels. Only the last rows are missing: 44 to 47.
    let (mut image, pixel_cm) = stripe();
    image.visibility = image.by_pixel(|x, _| f32::from(u8::from(x < 13)));
    assert_eq!(walked((image, pixel_cm)), (48, 5.0, 4));
    // Another piece of surface from column 16 on: 15 is last reached 5 right and 7 down, 3 + 5.6.
    let (mut image, pixel_cm) = stripe();
    for at in (0..64 * 48).filter(|at| at % 64 >= 16) {
        image.positions[at].y = 0.2;
        image.blockers_m[at] = 1.0;
    }
    assert_eq!(walked((image, pixel_cm)), (48, 8.6, 48));
}

#[test]
fn contacts_should_be_dark_and_have_their_caster_on_the_light_s_side() {
    let (mut image, pixel_cm) = stripe();
    image.truth[30 * 64 + 10] = 1.0;
    assert_eq!(walked((image, pixel_cm)).0, 47);
    // The caster on the other side: what it touches is lit by a light from there only.
    let (mut image, pixel_cm) = stripe();
    image.n_dot_l = image.by_pixel(|x, _| if x < 20 { 0.5 } else { 0.0 });
    assert_eq!(walked((image, pixel_cm)).0, 0);
}
