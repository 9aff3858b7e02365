// The width of the filter of virtual shadow maps: that of the settings, in texels of the level that a point is read from.
#define_import_path shadowgraph::shadows::page_filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::pages::Softness
#import shadowgraph::shadows::types::ShadowLight

// `level`: the one whose texels are as wide as the pixel asks for.
fn softness(projection_index: u32, shadow: ShadowLight, receiver: Receiver, level: f32) -> Softness {
    return Softness(level, 0.0);
}

// The half width of the filter in a level, texels.
fn half_width(shadow: ShadowLight, soft: Softness, level: u32) -> f32 {
    return shadow.filter_half;
}
