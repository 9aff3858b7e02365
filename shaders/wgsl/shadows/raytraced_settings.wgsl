// The settings of the technique `raytraced`.
#define_import_path shadowgraph::shadows::raytraced_settings

struct RaytracedSettings {
    // Number of rays: one goes to the light's centre, several cover its disc.
    rays: u32,
    // Directional lights: the angular radius.
    sun_radius_rad: f32,
    // Spot and point lights: the radius.
    light_radius_m: f32,
    // The pixels to either side over which noise is averaged.
    denoise_px: u32,
}
