// The shadow views and lights of a frame. A frame with few of them replaces this module by `few_views.wgsl`.
#define_import_path shadowgraph::shadows::views
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}

@group(1) @binding(0) var<storage, read> shadow_views: array<ShadowView>;
@group(1) @binding(1) var<storage, read> shadow_lights: array<ShadowLight>;

// The shadows of a light of the scene.
fn light_shadow(light: u32) -> ShadowLight {
    var shadow = shadow_lights[light];
    if light >= arrayLength(&shadow_lights) {
        shadow.view_count = 0u;
    }
    return shadow;
}

// A view of a light, by its index among those of the light.
fn light_view(light: ShadowLight, index: u32) -> ShadowView {
    return shadow_views[light.first_view + index];
}
