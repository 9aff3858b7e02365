// The background of a lit pass, at the far plane. What is the same for the whole image is read in the vertex stage: in fragment
// shaders Mesa's software driver reads uniforms pixel by pixel.
#import shadowgraph::view::{ViewRay, view_ray_points}
#import shadowgraph::fullscreen::fullscreen_vertex
#import shadowgraph::environment::{Dome, background_along, sky_dome}

struct BackgroundVertex {
    @builtin(position) position: vec4f,
    // The ray of the pixel: its start on the near plane, and a point ahead. Both are linear over the image.
    @location(0) start: vec3f,
    @location(1) ahead: vec3f,
    @location(2) @interpolate(flat) to_sun: vec3f,
    @location(3) @interpolate(flat) radiance: vec3f,
    @location(4) @interpolate(flat) distribution_a: vec3f,
    @location(5) @interpolate(flat) distribution_b: vec3f,
    @location(6) @interpolate(flat) distribution_c: vec3f,
    @location(7) @interpolate(flat) distribution_d: vec3f,
    @location(8) @interpolate(flat) distribution_e: vec3f,
    @location(9) @interpolate(flat) distribution_f: vec3f,
    @location(10) @interpolate(flat) distribution_g: vec3f,
    @location(11) @interpolate(flat) distribution_h: vec3f,
    @location(12) @interpolate(flat) distribution_i: vec3f,
    @location(13) @interpolate(flat) ground_irradiance: vec3f,
}

@vertex
fn vs_background(@builtin(vertex_index) vertex_index: u32) -> BackgroundVertex {
    let vertex = fullscreen_vertex(vertex_index);
    let points = view_ray_points(vertex.position.xy);
    let dome = sky_dome();
    let d = dome.distribution;
    return BackgroundVertex(
        vertex.position, points[0], points[1], dome.to_sun, dome.radiance, d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], d[8],
        dome.ground_irradiance,
    );
}

@fragment
fn fs_background(in: BackgroundVertex) -> @location(0) vec4f {
    let dome = Dome(
        in.to_sun,
        in.radiance,
        array(
            in.distribution_a, in.distribution_b, in.distribution_c, in.distribution_d, in.distribution_e,
            in.distribution_f, in.distribution_g, in.distribution_h, in.distribution_i,
        ),
        in.ground_irradiance,
    );
    let ray = ViewRay(in.start, normalize(in.ahead - in.start));
    return background_along(ray, in.position.xy, dome);
}
