//! The sun at the hours of a day.

use std::path::Path;

use glam::DVec3;
use shadowgraph::options::sun_at;
use shadowgraph::scene::{Light, LightKind, Scene, SolarTime};
use shadowgraph::shadows::{PCF, RAYTRACED};
use shadowgraph_quality::CaseSet;

use super::{count, different, greys_with, pillar_view, pillars, plan};
use crate::stage::{gpu, sun};

/// Returns the sun of the longest day at 52.5 degrees north, at an hour.
fn sun_of_hour(hour: f64) -> Light {
    let time = SolarTime { hour, day: 172.0, latitude: 52.5_f64.to_radians() };
    sun_at(&time, &sun(DVec3::NEG_Y))
}

fn pillars_at(hour: f64) -> Scene {
    let mut scene = pillars(12);
    scene.insert_light(sun_of_hour(hour));
    scene
}

#[test]
fn row_58_shadows_are_right_at_every_hour_of_the_day() {
    let Some(gpu) = gpu() else { return };
    let options = pillar_view(|_| ());
    for hour in [4.5, 6.5, 8.5, 12.5, 16.5, 18.5, 19.5] {
        let scene = pillars_at(hour);
        let truth = greys_with(gpu, &scene, 0, &options, RAYTRACED);
        let shown = greys_with(gpu, &scene, 0, &options, PCF);
        let (dark, wrong) = (count(&truth, |grey| grey < 128), different(&shown, &truth, 127));
        println!("{hour} h: {wrong} wrong pixels, {dark} in shadow");
        assert!(dark > 300, "{hour} h: {dark}");
        assert!(wrong * 16 < dark, "{hour} h: {wrong} {dark}");
    }
}

#[test]
fn row_58_the_sun_casts_no_shadow_at_night() {
    let options = pillar_view(|_| ());
    let nights = [0.5, 2.5, 21.5, 23.5].map(pillars_at);
    for scene in &nights {
        let planned = plan(scene, &options);
        assert!(planned.views.is_empty() && planned.cascades.is_none(), "{:?}", planned.views);
    }
    let Some(gpu) = gpu() else { return };
    for scene in &nights {
        for technique in [PCF, RAYTRACED] {
            let greys = greys_with(gpu, scene, 0, &options, technique);
            // The floor faces away from a sun below the horizon, and the pillars' sides do not.
            assert!(count(&greys, |grey| grey == 255) > 100, "{technique:?}");
            assert_eq!(count(&greys, |grey| grey < 255), 0, "{technique:?}");
        }
    }
}

#[test]
fn row_58_the_suns_of_the_measured_cases_are_those_of_the_hours() {
    let text = include_str!("../../../../docs/day.ron");
    let set = CaseSet::parse(text, Path::new("day.ron")).unwrap();
    let hours = [4.5, 8.5, 12.5, 16.5, 19.5];
    assert_eq!(set.cases.len(), hours.len());
    for (case, hour) in set.cases.iter().zip(hours) {
        let measured = case.sun(case.sun_elevations_deg[0]).kind;
        let (LightKind::Directional { direction: is }, LightKind::Directional { direction: expected }) =
            (measured, sun_of_hour(hour).kind)
        else {
            panic!("suns")
        };
        assert!(is.angle_between(expected) < 0.2_f64.to_radians(), "{hour} h: {is} {expected}");
    }
}
