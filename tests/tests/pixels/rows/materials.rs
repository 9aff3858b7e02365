//! Materials as casters and receivers.

use super::{Greys, count, cube_view, greys, plan};
use crate::stage::{add_instance, box_mesh, cube_on_floor, gpu, material, nth_instance, nth_material, sun};
use glam::{DVec3, Vec4};
use shadowgraph::Renderer;
use shadowgraph::options::Aov;
use shadowgraph::scene::{AlphaMode, CasterMode, Material, Scene};
use shadowgraph::shadows::{RAYTRACED, ShadowFilter};
use shadowgraph_quality::{Comparator, Points, Probe, Query};

/// Returns a sheet of a material, 1.5 m above a floor, under a vertical sun. Its alpha is 0.6.
fn sheet(change: impl FnOnce(&mut Material)) -> Scene {
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.remove_instance(nth_instance(&scene, 1)).unwrap();
    let mesh = scene.insert_mesh(box_mesh(DVec3::new(-1.0, 1.5, -1.0), DVec3::new(1.0, 1.51, 1.0)));
    let mut sheet =
        Material { alpha: AlphaMode::Blend, base_color: Vec4::new(0.8, 0.8, 0.8, 0.6), ..material() };
    change(&mut sheet);
    let sheet = scene.insert_material(sheet).unwrap();
    add_instance(&mut scene, mesh, sheet, DVec3::ZERO);
    scene.insert_light(sun(DVec3::NEG_Y));
    scene
}

fn shadows(scene: &Scene) -> Option<Greys> {
    let mut options = cube_view(|settings| settings.cascades.filter = ShadowFilter::Tent7);
    options.camera = crate::stage::camera(DVec3::new(0.0, 0.8, 3.5), DVec3::new(0.0, 0.0, 0.0));
    Some(greys(gpu()?, scene, 0, &options))
}

#[test]
fn row_24_casters_are_solid_clipped_dithered_or_none() {
    let mode = |mode| shadows(&sheet(|sheet| sheet.casts = Some(mode)));
    let Some(on) = mode(CasterMode::On) else { return };
    let [clip, dither, off] =
        [CasterMode::Clip, CasterMode::Dither, CasterMode::Off].map(|m| mode(m).unwrap());
    let dark = count(&on, |grey| grey == 0);
    assert!(dark > 1000);
    // Its alpha is above one half: all of it remains.
    assert_eq!(count(&clip, |grey| grey == 0), dark);
    assert_eq!(count(&off, |grey| grey < 255), 0);
    // 60 % of the texels are filled: a filter over many of them gives about 0.4.
    let under: Vec<u8> =
        dither.iter().zip(&on).filter(|(_, on)| **on == Some(0)).filter_map(|(d, _)| *d).collect();
    let mean = under.iter().map(|grey| f64::from(*grey)).sum::<f64>() / under.len() as f64;
    assert!((mean - 0.4 * 255.0).abs() < 15.0, "{mean}");
    let thin = shadows(&sheet(|sheet| {
        sheet.casts = Some(CasterMode::Clip);
        sheet.base_color.w = 0.4;
    }));
    assert_eq!(count(&thin.unwrap(), |grey| grey < 255), 0, "clipped away");
}

#[test]
fn row_24_dithered_shadows_are_stable_when_the_camera_moves() {
    let Some(gpu) = gpu() else { return };
    let scene = sheet(|sheet| sheet.casts = Some(CasterMode::Dither));
    // Few, large texels.
    let mut options = cube_view(|settings| {
        settings.cascades.filter = ShadowFilter::Tent2;
        settings.cascades.map_size_px = 256;
    });
    options.camera = crate::stage::camera(DVec3::new(0.0, 0.8, 3.5), DVec3::new(0.0, 0.0, 0.0));
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(0)).unwrap();
    let reference =
        Comparator::new(gpu, &renderer, 0).unwrap().reference(&mut renderer, &options, 0).unwrap();
    let (points, probe) = (Points::new(gpu, &reference.surfaces), Probe::new(gpu, &renderer).unwrap());
    let query = Query { light: 0, coarser: false };
    let mut seen = Vec::new();
    for step in 0..6 {
        // Over several texels.
        options.camera.world_from_view.translation += DVec3::new(0.07, 0.0, 0.03) * f64::from(step);
        seen.push(probe.evaluate(gpu, &renderer, &options, &points, query).unwrap().visibility);
    }
    let (dark, lit) =
        (seen[0].iter().filter(|v| **v < 0.1).count(), seen[0].iter().filter(|v| **v > 0.9).count());
    assert!(dark > 1000 && lit > 1000, "{dark} {lit}");
    for later in &seen[1..] {
        let changed = seen[0].iter().zip(later).filter(|(a, b)| (**a - **b).abs() > 0.02).count();
        assert!(changed < 200, "{changed} of {}", later.len());
    }
}

#[test]
fn row_24_a_scene_without_casters_has_no_map() {
    let options = cube_view(|_| ());
    let casters = |mode| {
        let mut scene = sheet(|sheet| sheet.casts = mode);
        let floor = nth_material(&scene, 0);
        scene.edit_material(floor, |floor| floor.casts = Some(CasterMode::Off)).unwrap();
        plan(&scene, &options).cascades.is_some()
    };
    assert_eq!([casters(None), casters(Some(CasterMode::Off))], [true, false]);
}

#[test]
fn row_24_unlit_materials_cast_shadows_and_receiving_can_be_disabled() {
    let Some(unlit) = shadows(&sheet(|sheet| (sheet.unlit, sheet.alpha) = (true, AlphaMode::Opaque))) else {
        return;
    };
    assert!(count(&unlit, |grey| grey == 0) > 1000);
    let mut bright = sheet(|sheet| sheet.alpha = AlphaMode::Opaque);
    bright.edit_material(nth_material(&bright, 0), |floor| floor.receives_shadows = false).unwrap();
    assert_eq!(count(&shadows(&bright).unwrap(), |grey| grey < 255), 0);
}

#[test]
fn row_24_rays_and_maps_agree_on_caster_modes() {
    let Some(gpu) = gpu() else { return };
    for mode in [CasterMode::On, CasterMode::Clip, CasterMode::Off] {
        let scene = sheet(|sheet| sheet.casts = Some(mode));
        let options = cube_view(|_| ());
        let (mapped, traced) =
            (greys(gpu, &scene, 0, &options), super::greys_with(gpu, &scene, 0, &options, RAYTRACED));
        let dark = |greys: &Greys| count(greys, |grey| grey < 128);
        assert!(dark(&mapped).abs_diff(dark(&traced)) < 100, "{mode:?}: {} {}", dark(&mapped), dark(&traced));
    }
}
