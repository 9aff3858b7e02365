// Finds the shadow map tiles that a point is read from, and their weights.
#define_import_path shadowgraph::shadows::tiles
#import shadowgraph::receiver::{Receiver, RECEIVER_COARSER, receiver_noise}
#import shadowgraph::shadows::cube::cube_face
#import shadowgraph::shadows::lookup::{Lookup, covers_receiver, incidence_in, look_up}
#import shadowgraph::shadows::types::{
    ShadowView, ShadowLight, SELECT_MAP, SELECT_SPHERE, SELECT_DEPTH, SELECT_FACE, BLEND_HARD, BLEND_DITHER,
}
#import shadowgraph::shadows::variant::{DIRECTIONAL, ONE_LIGHT, SIMPLE}
#import shadowgraph::shadows::views::light_view

// The index of the light's view, from `first` on, that a point is read from; view_count, the empty view, if there is none.
fn select_view(light: ShadowLight, receiver: Receiver, first: u32) -> u32 {
    var chosen = light.view_count;
    if SIMPLE || light.select == SELECT_FACE {
        return cube_face(receiver.position - light_view(light, 0u).light.xyz);
    }
    if light.select == SELECT_SPHERE {
        for (var i = light.view_count; i > first; i--) {
            let sphere = light_view(light, i - 1u);
            let offset = receiver.position - sphere.center;
            let inside = dot(offset, offset) < sphere.radius * sphere.radius;
            chosen = select(chosen, i - 1u, inside);
        }
        return chosen;
    }
    // The number of views that end before the point.
    if light.branch_free == 1u {
        let is_behind = vec4f(receiver.view_depth) >= light.ends_m[0];
        let is_far_behind = vec4f(receiver.view_depth) >= light.ends_m[1];
        let behind = select(vec4u(0u), vec4u(1u), is_behind) + select(vec4u(0u), vec4u(1u), is_far_behind);
        chosen = behind.x + behind.y + behind.z + behind.w;
    } else {
        chosen = 0u;
        for (var i = 0u; i < light.view_count; i++) {
            chosen += select(0u, 1u, receiver.view_depth >= light_view(light, i).end_m);
        }
    }
    // Points in front of the first view, which can begin late, are in the last one: it covers all.
    let is_before = receiver.view_depth < light_view(light, 0u).begin_m;
    return max(select(chosen, light.view_count - 1u, is_before), first);
}

// The lookup of a point in the first cascade that covers it; in the last one where none does.
fn find_cascade(light: ShadowLight, receiver: Receiver) -> Lookup {
    let incidence = incidence_in(light_view(light, 0u), light, receiver);
    var chosen = 0u;
    loop {
        let covered = covers_receiver(light_view(light, chosen), light, receiver, incidence);
        if covered || chosen + 1u >= light.view_count {
            break;
        }
        chosen++;
    }
    var lookup = look_up(light_view(light, chosen), light, receiver, incidence);
    lookup.view = chosen;
    return lookup;
}

// The lookup of a point in the light's views, from `first` on.
fn find(light: ShadowLight, receiver: Receiver, first: u32) -> Lookup {
    var lookup: Lookup;
    if ONE_LIGHT {
        return find_cascade(light, receiver);
    }
    var begin = first;
    var end = light.view_count;
    if !(SIMPLE && DIRECTIONAL) && light.select != SELECT_MAP {
        begin = select_view(light, receiver, first);
        end = begin + 1u;
    }
    // The first view that covers the point has the finest texels.
    loop {
        let shadow_view = light_view(light, begin);
        lookup = look_up(shadow_view, light, receiver, incidence_in(shadow_view, light, receiver));
        lookup.view = begin;
        begin++;
        if lookup.covered || begin >= end {
            break;
        }
    }
    return lookup;
}

// 1 inside a view, falling to 0 over its outer `fraction`.
fn inner_weight(light: ShadowLight, receiver: Receiver, lookup: Lookup, fraction: f32) -> f32 {
    let outer = light_view(light, lookup.view);
    if light.select == SELECT_SPHERE {
        let offset = receiver.position - outer.center;
        let relative = dot(offset, offset) / (outer.radius * outer.radius);
        return saturate((1.0 - relative) / (1.0 - (1.0 - fraction) * (1.0 - fraction)));
    }
    if light.select == SELECT_DEPTH {
        let length_m = outer.end_m - outer.begin_m;
        return saturate((outer.end_m - receiver.view_depth) / (fraction * length_m));
    }
    let size = outer.uv_max - outer.uv_min;
    let to_edge = min(lookup.uv - outer.uv_min, outer.uv_max - lookup.uv) / size;
    let depth = lookup.plane.depth;
    return saturate(2.0 * min(min(to_edge.x, to_edge.y), min(depth, 1.0 - depth)) / fraction);
}

// The strength of shadows at this distance: full before the fade begins, 0 at its end.
fn shadow_fade(light: ShadowLight, receiver: Receiver) -> f32 {
    var distance_m = receiver.view_depth;
    if !SIMPLE && light.fades_by_radius == 1u {
        distance_m = distance(light.eye, receiver.position);
    }
    return light.strength * saturate((light.fade_end_m - distance_m) * light.fade_per_m);
}

// The strength of shadows at the outer edge of the last view.
fn edge_fade(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    if SIMPLE || light.edge_fade <= 0.0 || lookup.view + 1u != light.view_count {
        return 1.0;
    }
    return inner_weight(light, receiver, lookup, light.edge_fade);
}

// The weight of a view where the next one covers the point too: lower near its edge.
fn blend_weight(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    if (receiver.flags & RECEIVER_COARSER) != 0u {
        return 0.0;
    }
    let inner = inner_weight(light, receiver, lookup, light.blend_fraction);
    if light.blend == BLEND_DITHER {
        return select(0.0, 1.0, receiver_noise(receiver) < inner);
    }
    return inner;
}

// The view that a point is read from, the next one, and the weight of the first; 1 if there is no next one.
struct Blend {
    first: Lookup,
    next: Lookup,
    weight: f32,
}

fn blend_at(light: ShadowLight, receiver: Receiver) -> Blend {
    var blend: Blend;
    blend.weight = 1.0;
    let blends = !SIMPLE && (light.blend != BLEND_HARD || (receiver.flags & RECEIVER_COARSER) != 0u);
    var begin = 0u;
    var is_next = false;
    loop {
        let lookup = find(light, receiver, begin);
        if !is_next {
            blend.first = lookup;
            begin = lookup.view + 1u;
        } else if lookup.covered {
            // Its biases are in its own texels.
            blend.next = lookup;
            blend.weight = blend_weight(light, receiver, blend.first);
        }
        if !blends || is_next || !lookup.covered || begin >= light.view_count {
            break;
        }
        is_next = true;
    }
    return blend;
}
