//! What a browser lacks.

use shadowgraph::wgpu;

/// Features that change what is drawn or measured, and what happens without them.
const FEATURES: [(wgpu::Features, &str); 4] = [
    (wgpu::Features::TIMESTAMP_QUERY, "no times of passes: the browser has no timestamp queries"),
    (
        wgpu::Features::DEPTH_CLIP_CONTROL,
        "shadow casters in front of the near plane are clamped in the vertex shader: no depth clip control",
    ),
    (
        wgpu::Features::INDIRECT_FIRST_INSTANCE,
        "draws that the GPU has culled bind their instances one by one: no indirect first instance",
    ),
    (
        wgpu::Features::TEXTURE_COMPRESSION_BC,
        "compressed textures for desktop GPUs are expanded: no BC formats",
    ),
];

/// Returns what the browser of an adapter lacks, a line each.
pub(super) fn missing_in(adapter: &wgpu::Adapter) -> Vec<String> {
    let features = adapter.features();
    let compressed = wgpu::Features::TEXTURE_COMPRESSION_ASTC | wgpu::Features::TEXTURE_COMPRESSION_ETC2;
    let missing = FEATURES.iter().filter(|(feature, _)| !features.contains(*feature));
    // Any family of compressed formats is enough.
    let missing = missing.filter(|(feature, _)| {
        *feature != wgpu::Features::TEXTURE_COMPRESSION_BC || !features.intersects(compressed)
    });
    let always =
        "times of merged passes are those of all of them; copies and counts of triangles are not measured";
    missing.map(|(_, line)| (*line).to_owned()).chain([always.to_owned()]).collect()
}
