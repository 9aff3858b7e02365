//! Every number of a settings file, replaced by extreme values one after the other.

use glam::DVec3;
use shadowgraph_scene::{LightKind, origin_near};
use shadowgraph_shadows::{
    ContactSettings, Error, EvsmSettings, LightRef, LightShadows, MsmSettings, PcssSettings,
    RaytracedSettings, ScreenSettings, SdsmSettings, ShadowInputs, ShadowSettings, ShadowView, SplitScheme,
    Techniques, plan_shadows,
};

use crate::common::{Boxes, camera, cube, light, spot, sun};

/// Returns the ranges of numbers in a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let is_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let mut found = Vec::new();
    let mut begin = None;
    for (at, c) in text.char_indices() {
        // `Tent5` and `Depth32` contain digits, but are identifiers.
        let begins = is_number(c) && !text[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        match begin {
            None if begins => begin = Some(at),
            Some(first) if !is_number(c) => {
                found.push((first, at));
                begin = None;
            }
            _ => {}
        }
    }
    found
}

fn usable(settings: &ShadowSettings) -> bool {
    let camera = camera(DVec3::new(0.0, 2.0, 8.0), DVec3::ZERO);
    let point = LightKind::Point { position_world: DVec3::new(1.0, 3.0, 0.0), range: Some(9.0) };
    let spot = spot(DVec3::new(0.0, 4.0, 0.0), DVec3::NEG_Y, 12.0, 0.6);
    let lights = [sun(DVec3::new(0.3, -1.0, 0.2), 9.0), spot, light(point, 50.0)];
    let casters = Boxes(vec![cube(DVec3::ZERO, 1.0), cube(DVec3::new(0.0, 0.0, -30.0), 1.0)]);
    let plan = plan_shadows(&ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.5,
        lights: &lights,
        casters: &casters,
        origin_world: origin_near(camera.position_world()),
        settings,
    });
    let plan = match plan {
        Ok(plan) => plan,
        // The number of lights does not depend on the settings alone.
        Err(error) => return matches!(error, Error::UnknownLight { .. }),
    };
    let is_finite = |view: &ShadowView| {
        view.map_from_world.is_finite()
            && [view.texel_world, view.radius, view.end_m].iter().all(|m| m.is_finite())
    };
    plan.views.iter().all(is_finite)
}

#[test]
fn no_number_in_a_settings_file_makes_a_plan_that_is_not_finite() {
    let own = LightShadows {
        depth_texels: Some(0.5),
        slope: Some(1.0),
        normal_texels: Some(0.5),
        near_m: Some(0.1),
        ..LightShadows::new(LightRef::Index(1))
    };
    let mut settings = ShadowSettings { lights: vec![own], ..ShadowSettings::default() };
    settings.cascades.bias_scales = vec![1.0, 2.0];
    settings.techniques.set(&PcssSettings::default()).unwrap();
    settings.techniques.set(&ScreenSettings::default()).unwrap();
    settings.techniques.set(&ContactSettings::default()).unwrap();
    settings.techniques.set(&EvsmSettings::default()).unwrap();
    settings.techniques.set(&MsmSettings::default()).unwrap();
    settings.techniques.set(&RaytracedSettings::default()).unwrap();
    settings.techniques.set(&SdsmSettings::default()).unwrap();
    let techniques = Techniques::built_in();
    let splits = [
        SplitScheme::Ratios(vec![0.1, 0.2, 0.4]),
        SplitScheme::Metres(vec![10.0, 20.0, 40.0]),
        SplitScheme::Factor(3.0),
        SplitScheme::Geometric { first_m: 6.0 },
        SplitScheme::Practical { lambda: 0.5 },
    ];
    let (mut refused, mut planned) = (0, 0);
    for split in splits {
        settings.cascades.split = split;
        let text = ron::to_string(&settings).unwrap();
        for (begin, end) in numbers(&text) {
            for number in ["0", "1", "-1", "3", "0.5", "8192", "1e30", "NaN", "inf", "-inf"] {
                let text = [&text[..begin], number, &text[end..]].concat();
                let read = ron::from_str::<ShadowSettings>(&text).map_err(|error| error.to_string());
                let checked = read.and_then(|settings| {
                    techniques.check(&settings).map_err(|error| error.to_string())?;
                    Ok(settings)
                });
                match checked {
                    Ok(settings) => {
                        assert!(usable(&settings), "{text}");
                        planned += 1;
                    }
                    Err(error) => {
                        assert!(!error.is_empty() && error.lines().count() == 1, "{error}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(refused > 500 && planned > 300, "{refused} {planned}");
}
