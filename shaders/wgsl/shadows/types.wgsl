// Data of each shadow view (a tile of a map) and of each light's shadows.
// World is relative to the frame's origin. Depth is reversed: 1 nearest to the light, 0 farthest.
#define_import_path shadowgraph::shadows::types

// 256 bytes: also the dynamic offset at which a view is bound to draw into its tile.
struct ShadowView {
    // To the tile: x and y -w to w, y up.
    clip_from_world: mat4x4f,
    // To the map: x/w and y/w 0 to 1 over all of it, y down. All zeros: the empty view.
    map_from_world: mat4x4f,
    // The tile without its border, in texture coordinates: around points inside, the filter stays in the tile.
    uv_min: vec2f,
    uv_max: vec2f,
    // The direction to the light (w 0, unit length), or the light's position (w 1).
    light: vec4f,
    // The bounding sphere that the tile covers.
    center: vec3f,
    radius: f32,
    // Longer side of a texel, metres; for a spot light at 1 m along its axis.
    texel_world: f32,
    // Change of depth over that length towards the light; for a spot light multiplied by the distance.
    depth_per_texel: f32,
    // Factor of rows 0 and 1 of clip_from_world, times texel_scale, that gives the light's unit axes.
    axis_scale: f32,
    // Metres from depth 1 to depth 0.
    depth_range_m: f32,
    // Metres from a spot light to depth 1 along its axis; 0 for a directional light.
    near_m: f32,
    // NOT_A_CASCADE in the atlas.
    cascade: u32,
    // View depths of the cascade's split, metres.
    begin_m: f32,
    end_m: f32,
    // Left, top, width, height.
    tile_px: vec4u,
    // Factor of all biases.
    bias_scale: f32,
    // The smallest difference of depths that the map resolves.
    depth_step: f32,
    // Offset from a pixel of the map to its world-aligned texel, modulo 1024.
    noise_px: vec2u,
    // 1: translucent casters are drawn into it.
    is_tinted: u32,
    // 1: no caster is beyond depth 0, so points there are looked up too, at depth 0.
    is_open: u32,
    // Width and height of a texel, as fractions of texel_world.
    texel_scale: vec2f,
}

const NOT_A_CASCADE: u32 = 0xffffffffu;

// 160 bytes. One for each light of the scene.
struct ShadowLight {
    first_view: u32,
    // 0: no shadows.
    view_count: u32,
    // MAP_*.
    map: u32,
    // SELECT_*.
    select: u32,
    // BLEND_*.
    blend: u32,
    // Comparisons of the filter along each axis, 1 to 4.
    filter_taps: u32,
    // BIAS_*.
    bias_method: u32,
    // 1: the bias along the normal is scaled by the sine of the angle between normal and light.
    normal_sine: u32,
    // Opacity of the shadows, 0 to 1.
    strength: f32,
    // Offset of receivers along their normal, texels.
    normal_bias_texels: f32,
    // Offset of taps towards the light, relative to the slope that bias_method follows.
    slope_bias: f32,
    // The least slope that taps allow for in every direction, texels per texel.
    min_slope: f32,
    // The largest slope that slope_bias follows, texels per texel.
    max_slope: f32,
    // Constant offset of all taps towards the light, texels.
    depth_bias_texels: f32,
    // Distance where the shadows end, metres.
    fade_end_m: f32,
    // Rate of the fade before that.
    fade_per_m: f32,
    // The outer part of a view that is blended with the next.
    blend_fraction: f32,
    // The outer part of the last view over which shadows fade out; 0: none.
    edge_fade: f32,
    // Half the width of the filter's tent at the camera, texels, and its decrease per metre of view depth.
    filter_half: f32,
    filter_falloff: f32,
    // 1: shadows are evaluated at several points of a pixel that is wider than texels.
    supersample: u32,
    // 1: points behind a crease are dark.
    close_creases: u32,
    // 1: the distance of the fade is that from the camera, 0: the view depth.
    fades_by_radius: u32,
    // 1: the view of a point is selected by ends_m.
    branch_free: u32,
    // The camera's position.
    eye: vec3f,
    // The ends of the cascades, metres of view depth; unused ones are huge.
    ends_m: array<vec4f, 2>,
    // Width and height of a texel of the map, texture coordinates; 0 without cascades.
    texel_uv: vec2f,
    // 0, for indices that are not constant.
    zero: u32,
}

const MAP_CASCADES: u32 = 0u;
const MAP_ATLAS: u32 = 1u;

// The first view that covers the point, the first whose sphere contains it, the one whose view depths contain it, or a cube
// face. After the last view of SELECT_SPHERE and SELECT_DEPTH there is an empty view.
const SELECT_MAP: u32 = 0u;
const SELECT_SPHERE: u32 = 1u;
const SELECT_DEPTH: u32 = 2u;
const SELECT_FACE: u32 = 3u;

const BLEND_HARD: u32 = 0u;
const BLEND_SOFT: u32 = 1u;
const BLEND_DITHER: u32 = 2u;

// Along the receiver's plane, by the receiver's slope, by the map's gradient.
const BIAS_PLANE: u32 = 0u;
const BIAS_SLOPE: u32 = 1u;
const BIAS_GRADIENT: u32 = 2u;
const BIAS_RASTER: u32 = 3u;
