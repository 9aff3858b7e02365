//! Settings over time and place.

use super::{count, greys, pillar_view, pillars};
use crate::stage::{gpu, sun, sun_direction};
use glam::DVec3;
use shadowgraph::ViewOptions;
use shadowgraph::shadows::{SettingTracks, ShadowSettings};

fn tracks(text: &str) -> SettingTracks {
    let tracks: SettingTracks = ron::from_str(text).unwrap();
    tracks.check(&ShadowSettings::default()).unwrap();
    tracks
}

#[test]
fn row_46_settings_follow_key_frames_and_zones() {
    let tracks = tracks(
        r#"(
            tracks: [
                (setting: "distance_m", keys: [(1.0, 20.0), (3.0, 60.0)]),
                (setting: "cascades.split.lambda", keys: [(0.0, 0.5)]),
                (setting: "cascades.filter", keys: [(0.0, "Tent2"), (2.0, "Tent7")]),
                (setting: "cascades.count", keys: [(0.0, 4), (2.0, 2)]),
                (setting: "supersample", keys: [(0.0, true), (3.0, false)]),
            ],
            zones: [(center: (10, 0, 0), radius_m: 2, blend_m: 4, settings: {"fade_fraction": 0.5, "cascades.cache": false})],
        )"#,
    );
    let base = ShadowSettings::default();
    let at = |time_s, x| tracks.settings_for(&base, time_s, DVec3::X * x).unwrap();
    let distances = [0.0, 1.0, 1.5, 2.0, 9.0].map(|time_s| at(time_s, 0.0).distance_m);
    assert_eq!(distances, [20.0, 20.0, 30.0, 40.0, 60.0]);
    let [early, late] = [1.9, 2.0].map(|time_s| at(time_s, 0.0).cascades);
    assert_eq!((early.count, late.count), (4, 2));
    assert_eq!((early.filter.taps(), late.filter.taps()), (1, 4));
    assert_eq!([2.9, 3.0].map(|time_s| at(time_s, 0.0).supersample), [true, false]);
    // 2 m away from the zone's edge, half of it applies.
    let fades = [0.0, 6.0, 8.5, 10.0].map(|x| at(0.0, x).fade_fraction);
    assert!((fades[1] - 0.3).abs() < 1e-6 && fades[0] == base.fade_fraction && fades[3] == 0.5, "{fades:?}");
    assert_eq!([5.0, 7.0].map(|x| at(0.0, x).cascades.cache), [true, false]);
    assert_eq!(tracks.end_s(), 3.0);
}

#[test]
fn row_46_tracks_that_cannot_be_played_are_refused() {
    let refused = |text: &str| {
        let tracks: SettingTracks = ron::from_str(text).unwrap();
        tracks.check(&ShadowSettings::default()).unwrap_err().to_string()
    };
    for (text, error) in [
        (
            r#"(setting: "distance", keys: [(0, 1)])"#,
            "`tracks.0.setting` is distance; allowed: the path of a shadow setting",
        ),
        (r#"(setting: "distance_m", keys: [])"#, "`tracks.0.keys` is empty; allowed: one key frame or more"),
        (
            r#"(setting: "distance_m", keys: [(1, 1), (1, 2)])"#,
            "`tracks.0.keys` is 1, 1; allowed: finite times in ascending order",
        ),
        (
            r#"(setting: "distance_m", keys: [(0, 1), (1, -2)])"#,
            "`tracks.0.distance_m` is -2; allowed: 0.001 to 1000000",
        ),
        (
            r#"(setting: "distance_m", keys: [(0, "far")])"#,
            "`tracks.0.distance_m` is \"far\"; allowed: a number",
        ),
        (
            r#"(setting: "cascades.count", keys: [(0, 2.5)])"#,
            "`tracks.0.cascades.count` is 2.5; allowed: a whole number",
        ),
        (r#"(setting: "cascades", keys: [(0, 2)])"#, "`tracks.0.cascades` is 2; allowed: a setting that is"),
        (
            r#"(setting: "techniques.pcss.blocker_taps", keys: [(0, 2)])"#,
            "`tracks.0.setting` is techniques.pcss",
        ),
    ] {
        let found = refused(&format!("(tracks: [{text}])"));
        assert!(found.contains(error), "{found}\n{error}");
    }
    let zone = refused(r#"(zones: [(center: (0, 0, 0), radius_m: -1, settings: {})])"#);
    assert!(zone.contains("`zones.0.radius_m` is -1; allowed: 0 or more (metres)"), "{zone}");
}

#[test]
fn row_46_shadows_reach_farther_as_time_passes() {
    let Some(gpu) = gpu() else { return };
    let tracks = tracks(r#"(tracks: [(setting: "distance_m", keys: [(0.0, 6.0), (4.0, 18.0)])])"#);
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let dark = [0.0, 2.0, 4.0].map(|time_s| {
        let options = pillar_view(|_| ());
        let shadows = tracks.settings_for(&options.shadows, time_s, options.camera.position_world()).unwrap();
        count(&greys(gpu, &scene, 0, &ViewOptions { shadows, ..options }), |grey| grey < 128)
    });
    assert!(dark.is_sorted_by(|a, b| a + 100 < *b), "{dark:?}");
}
