// The width of the filter of virtual shadow maps: that of the settings, in texels of the level that a point is read from.
#define_import_path shadowgraph::shadows::page_filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::types::ShadowLight

// How soft the shadows of a point are.
struct Softness {
    // The level that it is read from; the fraction says how near it is to the next one.
    level: f32,
    // The half width of the filter, texels of level 0.
    radius: f32,
}

// `level`: the one whose texels are as wide as the pixel asks for.
fn softness(projection_index: u32, shadow: ShadowLight, receiver: Receiver, level: f32) -> Softness {
    return Softness(level, 0.0);
}

// The half width of the filter in a level, texels.
fn half_width(shadow: ShadowLight, soft: Softness, level: u32) -> f32 {
    return shadow.filter_half;
}
