//! What other geometry hides is not drawn.

use crate::stage::gpu;
use shadowgraph::options::Aov;
use shadowgraph::{Culling, Pipeline, RenderConfig, Renderer, ViewOptions};
use shadowgraph_samples::city::city;

#[test]
fn in_a_street_at_least_half_of_the_instances_in_view_are_not_drawn() {
    let Some(gpu) = gpu() else { return };
    let mut scene = city(10_000, 1).unwrap();
    // Street lights cost most of the time of an image, and hide nothing.
    scene.set_lights(scene.lights()[..1].to_vec());
    let camera = scene.cameras[0].clone();
    let config = RenderConfig { culling: Culling::Gpu, ..Pipeline::minimal_lit().into() };
    let mut renderer = Renderer::with_config(gpu, scene, &camera, Aov::Color, config).unwrap();
    let options = ViewOptions { camera, size_px: [160, 90], shadows: Default::default() };
    let count = |renderer: &mut Renderer, name: &str| {
        let culled = renderer.draw(gpu, &options).unwrap().counts.culled;
        culled.into_iter().find(|culled| culled.view == name).unwrap().instances as usize
    };
    // In the first frame, nothing has been seen before.
    assert_eq!(count(&mut renderer, "camera, seen before"), 0);
    let in_view = renderer.view(&options, None).list_draws().solid.len();
    let drawn = count(&mut renderer, "camera");
    println!("{drawn} of {in_view} instances in view are drawn");
    assert!(drawn > 50 && 2 * drawn <= in_view, "{drawn} of {in_view}");
    assert_eq!(count(&mut renderer, "camera, seen before"), drawn);
    assert_eq!(count(&mut renderer, "camera, new"), 0);
}
