// Lines over an image that show what shadow maps cover: an instance for each shadow view, six vertices for each line.
//
//   vs_frusta     the slice of the camera's view that a cascade is fitted to (12 lines), and the box or pyramid of the tile (12)
//   vs_spheres    the sphere of a cascade: three circles of SIDES lines
//   vs_tiles      the tile in the middle of its box, or at the end of its pyramid (4), and the part inside its border (4)
#import shadowgraph::view::view
#import shadowgraph::shadows::types::{ShadowView, NOT_A_CASCADE}
#import shadowgraph::shadows::colors::{cascade_tint, to_linear}

// The camera that the shadows are fitted to. Right and up reach from the centre of the image to its edge: at a view depth of 1 m, or
// everywhere if it is orthographic.
struct ShadowCamera {
    eye: vec3f,
    orthographic: u32,
    right: vec3f,
    width_px: f32,
    up: vec3f,
    forward: vec3f,
}

@group(1) @binding(0) var<storage, read> shadow_views: array<ShadowView>;
@group(1) @binding(1) var<uniform> shadow_camera: ShadowCamera;

const SIDES: u32 = 48u;
const TAU: f32 = 6.2831853;
// The view depth at which lines are cut, as a factor of the near plane.
const NEAR_CUT: f32 = 1.001;

struct LineVertex {
    @builtin(position) position: vec4f,
    @location(0) color: vec3f,
}

// Rows of a matrix.
fn row(m: mat4x4f, i: u32) -> vec4f {
    return vec4f(m[0][i], m[1][i], m[2][i], m[3][i]);
}

fn is_perspective(shadow_view: ShadowView) -> bool {
    return shadow_view.light.w == 1.0;
}

// The point of a tile at x and y, -1 to 1, and z from 0 at the light's end to 1.
fn tile_point(shadow_view: ShadowView, at: vec3f) -> vec3f {
    let m = shadow_view.clip_from_world;
    let x = row(m, 0u);
    let y = row(m, 1u);
    if is_perspective(shadow_view) {
        let axis = row(m, 3u).xyz;
        let depth = shadow_view.near_m + at.z * shadow_view.depth_range_m;
        let across = x.xyz * (at.x / dot(x.xyz, x.xyz)) + y.xyz * (at.y / dot(y.xyz, y.xyz));
        return shadow_view.light.xyz + depth * (across + axis / dot(axis, axis));
    }
    // The rows are orthogonal.
    let z = row(m, 2u);
    let depth = 1.0 - at.z;
    return x.xyz * ((at.x - x.w) / dot(x.xyz, x.xyz)) + y.xyz * ((at.y - y.w) / dot(y.xyz, y.xyz))
        + z.xyz * ((depth - z.w) / dot(z.xyz, z.xyz));
}

// A corner of a box by its number: bits 0, 1 and 2 are x, y and z.
fn corner(number: u32) -> vec3f {
    let bits = vec3f(f32(number & 1u), f32((number >> 1u) & 1u), f32(number >> 2u));
    return vec3f(2.0 * bits.xy - 1.0, bits.z);
}

// The corners of edge 0 to 11 of a box.
fn edge(number: u32) -> vec2u {
    let axis = number / 4u;
    let others = number % 4u;
    // Inserts a zero bit at the axis.
    let low = others & ((1u << axis) - 1u);
    let first = low | ((others >> axis) << (axis + 1u));
    return vec2u(first, first | (1u << axis));
}

fn slice_point(shadow_view: ShadowView, at: vec3f) -> vec3f {
    let depth = mix(shadow_view.begin_m, shadow_view.end_m, at.z);
    let across = shadow_camera.right * at.x + shadow_camera.up * at.y;
    return shadow_camera.eye + shadow_camera.forward * depth + across * select(depth, 1.0, shadow_camera.orthographic == 1u);
}

// No part of a line.
fn nothing() -> LineVertex {
    return LineVertex(vec4f(2.0, 2.0, 2.0, 1.0), vec3f(0.0));
}

// A vertex of the quad along a line.
fn quad(vertex: u32, from_point: vec3f, to_point: vec3f, color: vec3f) -> LineVertex {
    var a = view.clip_from_world * vec4f(from_point, 1.0);
    var b = view.clip_from_world * vec4f(to_point, 1.0);
    let cut = select(view.near * NEAR_CUT, -1e30, view.orthographic == 1u);
    if a.w < cut && b.w < cut {
        return nothing();
    }
    if a.w < cut {
        a = mix(a, b, (cut - a.w) / (b.w - a.w));
    }
    if b.w < cut {
        b = mix(b, a, (cut - b.w) / (a.w - b.w));
    }
    let to_px = 0.5 * view.size_px;
    let along = (b.xy / b.w - a.xy / a.w) * to_px;
    let across = vec2f(-along.y, along.x) / max(length(along), 1e-6) * (0.5 * shadow_camera.width_px) / to_px;
    // Two triangles: a-, a+, b-, b-, a+, b+.
    let is_end = vertex == 2u || vertex == 3u || vertex == 5u;
    let side = select(-1.0, 1.0, vertex == 1u || vertex == 4u || vertex == 5u);
    let end = select(a, b, is_end);
    return LineVertex(vec4f(end.xy / end.w + side * across, 0.5, 1.0), color);
}

fn is_empty(shadow_view: ShadowView) -> bool {
    return all(row(shadow_view.clip_from_world, 3u) == vec4f(0.0));
}

@vertex
fn vs_frusta(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> LineVertex {
    let shadow_view = shadow_views[instance];
    let line = vertex / 6u;
    let is_slice = line < 12u;
    if is_empty(shadow_view) || is_slice && shadow_view.cascade == NOT_A_CASCADE {
        return nothing();
    }
    let corners = edge(line % 12u);
    let color = cascade_tint(shadow_view.cascade);
    if is_slice {
        let from_point = slice_point(shadow_view, corner(corners.x));
        let to_point = slice_point(shadow_view, corner(corners.y));
        return quad(vertex % 6u, from_point, to_point, mix(color, vec3f(1.0), 0.6));
    }
    let from_point = tile_point(shadow_view, corner(corners.x));
    return quad(vertex % 6u, from_point, tile_point(shadow_view, corner(corners.y)), color);
}

fn circle_point(shadow_view: ShadowView, circle: u32, side: u32) -> vec3f {
    let angle = f32(side) * TAU / f32(SIDES);
    let at = vec2f(cos(angle), sin(angle));
    var offset = vec3f(at, 0.0);
    if circle == 1u {
        offset = vec3f(at.x, 0.0, at.y);
    }
    if circle == 2u {
        offset = vec3f(0.0, at);
    }
    return shadow_view.center + shadow_view.radius * offset;
}

@vertex
fn vs_spheres(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> LineVertex {
    let shadow_view = shadow_views[instance];
    if is_empty(shadow_view) || shadow_view.cascade == NOT_A_CASCADE {
        return nothing();
    }
    let line = vertex / 6u;
    let from_point = circle_point(shadow_view, line / SIDES, line % SIDES);
    let to_point = circle_point(shadow_view, line / SIDES, line % SIDES + 1u);
    return quad(vertex % 6u, from_point, to_point, cascade_tint(shadow_view.cascade));
}

// The corners of the part inside the border, -1 to 1: left, top, right, bottom.
fn inside_border(shadow_view: ShadowView) -> vec4f {
    let to_clip = shadow_view.clip_from_world;
    let to_map = shadow_view.map_from_world;
    var inside = vec4f(0.0);
    for (var i = 0u; i < 2u; i++) {
        // Along each axis the map is the tile, scaled and moved.
        let clip = row(to_clip, i);
        let map = row(to_map, i);
        let scale = dot(map.xyz, clip.xyz) / dot(clip.xyz, clip.xyz);
        var origin = map.w - scale * clip.w;
        if is_perspective(shadow_view) {
            let axis = row(to_clip, 3u).xyz;
            origin = dot(map.xyz, axis) / dot(axis, axis);
        }
        inside[i] = (shadow_view.uv_min[i] - origin) / scale;
        inside[i + 2u] = (shadow_view.uv_max[i] - origin) / scale;
    }
    return inside;
}

@vertex
fn vs_tiles(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> LineVertex {
    let shadow_view = shadow_views[instance];
    if is_empty(shadow_view) {
        return nothing();
    }
    let line = vertex / 6u;
    let is_inner = line >= 4u;
    let bounds = select(vec4f(-1.0, -1.0, 1.0, 1.0), inside_border(shadow_view), is_inner);
    let ends = vec2u(line % 4u, (line + 1u) % 4u);
    var points: array<vec3f, 2>;
    for (var i = 0u; i < 2u; i++) {
        // Around the rectangle.
        let end = ends[i];
        let x = select(bounds.x, bounds.z, end == 1u || end == 2u);
        let y = select(bounds.y, bounds.w, end >= 2u);
        points[i] = tile_point(shadow_view, vec3f(x, y, select(0.5, 1.0, is_perspective(shadow_view))));
    }
    let color = cascade_tint(shadow_view.cascade);
    return quad(vertex % 6u, points[0], points[1], select(color, mix(color, vec3f(1.0), 0.6), is_inner));
}

@fragment
fn fs_encoded(in: LineVertex) -> @location(0) vec4f {
    return vec4f(in.color, 1.0);
}

// For a target that encodes what is written.
@fragment
fn fs_linear(in: LineVertex) -> @location(0) vec4f {
    return vec4f(to_linear(in.color), 1.0);
}
