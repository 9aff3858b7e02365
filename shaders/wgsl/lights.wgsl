// The lights of a frame. A lit pass with few of them replaces this module by `few_lights.wgsl`.
#define_import_path shadowgraph::lights
#import shadowgraph::light::Light
#import shadowgraph::view::view

@group(0) @binding(1) var<storage, read> lights: array<Light>;

fn light_count() -> u32 {
    return view.light_count;
}

fn light_at(index: u32) -> Light {
    return lights[index];
}
