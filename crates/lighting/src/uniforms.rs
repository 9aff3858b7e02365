//! The uniforms of the camera and the lights: `View` and `Light` of `shadowgraph::view`.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, DVec4, Mat4, Vec2, Vec3};
use shadowgraph_core::{Buffer, Frame, Texture};
use shadowgraph_scene::{Camera, Light, LightKind, Projection};

use crate::exposure::AmbientLight;
use crate::jitter::Jitter;
use crate::motion::CameraMotion;
use crate::noise::noise_of;

/// The largest number of lights that lit passes read from a uniform block. `FEW_LIGHTS` of `few_lights.wgsl`.
pub(crate) const MAX_FEW_LIGHTS: usize = 32;

/// The camera of a frame, 288 bytes; in the buffer of the view, noise follows. World space here is relative to the frame's origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuView {
    /// World to clip space; depth reversed.
    pub clip_from_world: Mat4,
    /// Clip space to world.
    pub world_from_clip: Mat4,
    /// World to view space.
    pub view_from_world: Mat4,
    /// Position of the camera, metres.
    pub position: Vec3,
    /// Near plane, metres.
    pub near: f32,
    /// Size of the image, pixels.
    pub size_px: Vec2,
    /// Far plane, metres; 0: infinitely far.
    pub far: f32,
    /// The factor of radiance.
    pub exposure: f32,
    /// Radiance of the sky.
    pub ambient_sky: Vec3,
    /// Number of lights.
    pub light_count: u32,
    /// Radiance of the ground.
    pub ambient_ground: Vec3,
    /// 1 for an orthographic camera, else 0.
    pub orthographic: u32,
    /// The step to the next pixel to the right, metres at 1 m in front of the camera; at any distance, if it is orthographic.
    pub pixel_right: Vec3,
    /// 1 if noise changes from frame to frame, else 0.
    pub noise_changes: u32,
    /// The step to the next pixel up, like `pixel_right`.
    pub pixel_up: Vec3,
    /// 0.
    pub zero: u32,
}

/// A light, 64 bytes. World space here is relative to the frame's origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuLight {
    /// Position, metres; zero for directional lights.
    pub position: Vec3,
    /// 0 directional, 1 spot, 2 point.
    pub kind: u32,
    /// The direction in which the light travels, unit length; zero for point lights.
    pub direction: Vec3,
    /// Range, metres; 0: unlimited.
    pub range: f32,
    /// Linear colour times lux or candela.
    pub color: Vec3,
    /// Spot cone: `saturate(cos(angle) * spot_scale + spot_offset)` squared.
    pub spot_scale: f32,
    /// The offset of the spot cone; see `spot_scale`.
    pub spot_offset: f32,
    /// Padding, zero.
    pub padding: [u32; 3],
}

/// The camera and the lights of a frame.
pub struct ViewUniforms {
    /// The camera.
    pub view: GpuView,
    /// The lights, in the scene's order.
    pub lights: Vec<GpuLight>,
    /// The jitter of sample positions, pixels.
    pub jitter_px: Vec2,
    /// The camera's motion since the view's previous frame.
    pub motion: Arc<CameraMotion>,
    /// The number of the frame whose noise shaders draw; `None`: noise that is the same in every frame.
    pub noise_frame: Option<u32>,
}

/// How shaders read the lights of a frame. They are compiled for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightBinding {
    /// A storage buffer with any number of lights.
    #[default]
    Storage,
    /// A uniform block with at most 32 lights.
    Uniform,
    /// A uniform block with exactly one light, a directional one.
    Sun,
}

impl LightBinding {
    fn new(lights: &[GpuLight]) -> Self {
        match lights {
            [light] if light.kind == GpuLight::DIRECTIONAL => Self::Sun,
            _ if lights.len() <= MAX_FEW_LIGHTS => Self::Uniform,
            _ => Self::Storage,
        }
    }
}

/// The contents of bind group 0 of lit passes.
#[derive(Clone, Debug)]
pub struct ViewBuffers {
    /// One [`GpuView`], and the noise of the frame.
    pub view: Buffer,
    /// [`GpuLight`]s, and zeros up to the size of a uniform block of few.
    pub lights: Buffer,
    /// How shaders read the lights.
    pub light_binding: LightBinding,
    /// The lights of each cluster, if they were computed ([`Clusters`](crate::Clusters)).
    pub clusters: Option<Texture>,
    /// Ambient occlusion, if it was computed ([`Occlusion`](crate::post::Occlusion)).
    pub occlusion: Option<Texture>,
    /// The light of the sky, if it was computed ([`SkyLight`](crate::SkyLight)).
    pub sky: Option<Buffer>,
    /// The height of the plane that receives shadows, if there is one, metres relative to the frame's origin.
    pub ground_height: Option<f32>,
    /// The jitter of sample positions in this frame, pixels ([`Jitter`]).
    pub jitter_px: Vec2,
    /// The camera's motion since the view's previous frame.
    pub motion: Arc<CameraMotion>,
}

impl ViewUniforms {
    /// Creates the uniforms of a camera that stands still, and lights, for an image of `size_px`, relative to `origin_world`.
    pub fn new(
        camera: &Camera,
        size_px: [u32; 2],
        lights: &[Light],
        origin_world: DVec3,
        ambient_light: &AmbientLight,
    ) -> Self {
        let view = GpuView {
            ambient_sky: ambient_light.sky,
            ambient_ground: ambient_light.ground,
            exposure: ambient_light.exposure,
            light_count: lights.len() as u32,
            ..GpuView::for_camera(camera, size_px, origin_world)
        };
        let lights = lights.iter().map(|light| GpuLight::new(light, origin_world)).collect();
        let [width, height] = size_px.map(f64::from);
        let motion = Arc::new(CameraMotion::still(camera, width / height));
        Self { view, lights, jitter_px: Vec2::ZERO, motion, noise_frame: None }
    }

    /// Sets the camera's motion since the view's previous frame ([`PreviousCameras`](crate::PreviousCameras)).
    #[must_use]
    pub fn moving(self, motion: CameraMotion) -> Self {
        Self { motion: Arc::new(motion), ..self }
    }

    /// Offsets the sample positions of pixels, for temporal anti-aliasing.
    #[must_use]
    pub fn jittered(mut self, jitter: Jitter) -> Self {
        let [width, height] = self.view.size_px.to_array().map(|px| px as u32);
        self.view.clip_from_world = jitter.clip_translation([width, height]) * self.view.clip_from_world;
        self.view.world_from_clip = self.view.clip_from_world.inverse();
        self.jitter_px = jitter.offset_px();
        self
    }

    /// Gives shaders the noise of a frame, for pipelines that average frames; `None`, the default: noise is the same in every
    /// frame.
    #[must_use]
    pub fn with_noise(self, noise_frame: Option<u32>) -> Self {
        Self { noise_frame, ..self }
    }

    /// Returns the contents of [`ViewBuffers::view`].
    pub fn view_bytes(&self) -> Vec<u8> {
        let view = GpuView { noise_changes: u32::from(self.noise_frame.is_some()), ..self.view };
        [bytemuck::bytes_of(&view), &noise_of(self.noise_frame)].concat()
    }

    /// Returns the contents of [`ViewBuffers::lights`].
    pub fn light_bytes(&self) -> Vec<u8> {
        let mut bytes = bytemuck::cast_slice(&self.lights).to_vec();
        bytes.resize(self.lights.len().max(MAX_FEW_LIGHTS) * size_of::<GpuLight>(), 0);
        bytes
    }

    /// Adds the node that uploads the uniforms.
    pub fn upload(&self, frame: &mut Frame<'_>) -> ViewBuffers {
        frame.node("view", |frame| ViewBuffers {
            view: frame.upload_buffer("view", self.view_bytes()),
            lights: frame.upload_buffer("lights", self.light_bytes()),
            light_binding: LightBinding::new(&self.lights),
            clusters: None,
            occlusion: None,
            sky: None,
            ground_height: None,
            jitter_px: self.jitter_px,
            motion: self.motion.clone(),
        })
    }
}

impl GpuView {
    fn for_camera(camera: &Camera, size_px: [u32; 2], origin_world: DVec3) -> Self {
        let [width, height] = size_px.map(f64::from);
        // In f64 until the end: the translation is small once it is relative to the origin.
        let view_from_world = camera.view_from_world() * DMat4::from_translation(origin_world);
        let clip_from_view = camera.clip_from_view(width / height);
        let clip_from_world = clip_from_view * view_from_world;
        let axes = view_from_world.transpose();
        let step = |axis: DVec4, px: f64, scale: f64| (axis.truncate() * 2.0 / (px * scale)).as_vec3();
        Self {
            pixel_right: step(axes.x_axis, width, clip_from_view.x_axis.x),
            pixel_up: step(axes.y_axis, height, clip_from_view.y_axis.y),
            clip_from_world: clip_from_world.as_mat4(),
            world_from_clip: clip_from_world.inverse().as_mat4(),
            view_from_world: view_from_world.as_mat4(),
            position: (camera.position_world() - origin_world).as_vec3(),
            near: camera.near() as f32,
            size_px: Vec2::new(width as f32, height as f32),
            far: camera.far().map_or(0.0, |far| far as f32),
            orthographic: u32::from(matches!(camera.projection, Projection::Orthographic { .. })),
            ..Self::zeroed()
        }
    }
}

impl GpuLight {
    /// The kind of directional lights.
    const DIRECTIONAL: u32 = 0;

    /// Converts a light, relative to `origin_world`; one that is not usable becomes zeros, which give no light.
    pub fn new(light: &Light, origin_world: DVec3) -> Self {
        if !light.is_usable() {
            return Self::zeroed();
        }
        let relative = |position: DVec3| (position - origin_world).as_vec3();
        let range = |range: Option<f64>| range.map_or(0.0, |range| range as f32);
        let common = Self {
            kind: u32::from(light.kind.order()),
            color: light.color * light.intensity,
            ..Self::zeroed()
        };
        match light.kind {
            LightKind::Directional { direction } => {
                Self { direction: direction.normalize().as_vec3(), ..common }
            }
            LightKind::Point { position_world, range: end } => {
                Self { position: relative(position_world), range: range(end), ..common }
            }
            LightKind::Spot { position_world, direction, range: end, inner_angle, outer_angle } => {
                // KHR_lights_punctual: full light up to the inner angle, none from the outer angle on.
                let cos_outer = outer_angle.cos();
                let scale = 1.0 / (inner_angle.cos() - cos_outer).max(0.001);
                Self {
                    position: relative(position_world),
                    direction: direction.normalize().as_vec3(),
                    range: range(end),
                    spot_scale: scale as f32,
                    spot_offset: (-cos_outer * scale) as f32,
                    ..common
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use std::mem::offset_of;

    use shadowgraph_shaders::{MAPPED, check_layout, compose, layout};

    use super::*;
    use crate::key_light::KeyLight;

    #[test]
    fn uniforms_have_the_layout_of_the_wgsl_structs() {
        let module = compose("forward.wgsl", &[MAPPED]).unwrap();
        let view = [
            ("clip_from_world", offset_of!(GpuView, clip_from_world)),
            ("world_from_clip", offset_of!(GpuView, world_from_clip)),
            ("view_from_world", offset_of!(GpuView, view_from_world)),
            ("position", offset_of!(GpuView, position)),
            ("near", offset_of!(GpuView, near)),
            ("size_px", offset_of!(GpuView, size_px)),
            ("far", offset_of!(GpuView, far)),
            ("exposure", offset_of!(GpuView, exposure)),
            ("ambient_sky", offset_of!(GpuView, ambient_sky)),
            ("light_count", offset_of!(GpuView, light_count)),
            ("ambient_ground", offset_of!(GpuView, ambient_ground)),
            ("orthographic", offset_of!(GpuView, orthographic)),
            ("pixel_right", offset_of!(GpuView, pixel_right)),
            ("noise_changes", offset_of!(GpuView, noise_changes)),
            ("pixel_up", offset_of!(GpuView, pixel_up)),
            ("zero", offset_of!(GpuView, zero)),
            ("noise", size_of::<GpuView>()),
        ];
        layout::check(&module, "View", size_of::<GpuView>() + noise_of(None).len(), &view).unwrap();
        check_layout!(&module, "Light", GpuLight:
            position, kind, direction, range, color, spot_scale, spot_offset,
        )
        .unwrap();
        for (name, size) in [("FEW_LIGHTS", MAX_FEW_LIGHTS), ("LIGHT_WORDS", size_of::<GpuLight>() / 16)] {
            let line = format!("const {name}: u32 = {size}u;");
            assert!(shadowgraph_shaders::FEW_LIGHTS.source.contains(&line), "{line}");
        }
    }

    fn spot(inner_angle: f64, outer_angle: f64) -> GpuLight {
        let kind = LightKind::Spot {
            position_world: DVec3::new(1024.5, 0.0, 0.0),
            direction: DVec3::NEG_Y,
            range: None,
            inner_angle,
            outer_angle,
        };
        let light = Light { name: None, kind, color: Vec3::ONE, intensity: 2.0, casts_shadow: true };
        GpuLight::new(&light, DVec3::new(1024.0, 0.0, 0.0))
    }

    #[test]
    fn a_spot_light_is_full_inside_its_inner_angle_and_zero_outside_its_outer_angle() {
        let light = spot(0.3, 0.6);
        let factor = |angle: f32| (angle.cos() * light.spot_scale + light.spot_offset).clamp(0.0, 1.0);
        assert_eq!(factor(0.2), 1.0);
        assert!(factor(0.601) < 1e-3 && factor(0.45) > 0.0);
        assert_eq!(light.position, Vec3::new(0.5, 0.0, 0.0));
    }

    #[test]
    fn positions_keep_their_precision_far_from_the_world_origin() {
        let eye = DVec3::new(1.0e7 + 0.125, 2.0, -3.0e6);
        let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
        let camera = Camera::look_at(eye, eye + DVec3::NEG_Z, DVec3::Y, projection);
        let origin_world = shadowgraph_scene::origin_near(eye);
        let ambient_light = AmbientLight::for_key_light(KeyLight { directional_lx: 1.0, local_lx: 0.0 });
        let uniforms = ViewUniforms::new(&camera, [64, 64], &[], origin_world, &ambient_light);
        assert_eq!(uniforms.view.position.as_dvec3() + origin_world, eye);
        let clip = uniforms.view.clip_from_world * (uniforms.view.position + Vec3::NEG_Z * 0.1).extend(1.0);
        assert!((clip.z / clip.w - 1.0).abs() < 1e-4, "the near plane has depth 1: {clip}");
    }
}
