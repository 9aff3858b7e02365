//! Lit passes that consume shadows through the technique contract, as render-graph nodes.
//!
//! A frame takes a few calls, each of which adds passes to the graph:
//!
//! 1. [`ViewUniforms::upload`] uploads the camera and the lights;
//! 2. [`Prepass::add_to`] draws depth;
//! 3. the shadow technique adds its maps (`shadowgraph_shadows::add_shadows`);
//! 4. [`Forward::lit`] draws the scene with every light and material, and calls `shadow_visibility` for each light;
//! 5. [`Tonemap::add_to`] converts the result to a displayable image.
//!
//! Nothing here depends on how a shadow technique works. Cameras are those of `shadowgraph_scene`, depth is reversed,
//! and colours are scene-linear until the tonemap.

mod background;
mod clusters;
mod culling;
mod deferred;
mod error;
mod exposure;
mod forward;
mod gbuffer;
mod geometry;
mod jitter;
mod key_light;
mod layer_culling;
mod lit_target;
mod motion;
mod noise;
mod occluders;
mod occlusion_culling;
mod pose;
pub mod post;
mod prepass;
mod screen_pass;
mod shader;
mod sky;
mod tonemap;
mod uniforms;
mod velocity;
mod view_group;

pub use clusters::Clusters;
pub use culling::{CullCount, CullCounts, CullPass, CullView, draw_culled};
pub use deferred::Deferred;
pub use error::Error;
pub use exposure::AmbientLight;
pub use forward::{Forward, LitPipelines};
pub use gbuffer::{GBuffer, GBufferPass};
pub use geometry::{CulledGeometry, Geometry};
pub use key_light::{KeyLight, KeyLightEstimate};
pub use layer_culling::{LayerCullPass, LayerQuery, draw_layers};
pub use lit_target::{LitOutput, LitTarget};
pub use motion::{CameraMotion, PreviousCameras};
pub use occluders::OccluderPyramid;
pub use occlusion_culling::OcclusionCulling;
pub use pose::PosePass;
pub use prepass::Prepass;
pub use shader::fullscreen as fullscreen_shader;
pub use sky::{Backdrop, SkyLight, SkySettings};
pub use tonemap::{Tonemap, TonemapSettings};
pub use uniforms::{GpuLight, GpuView, LightBinding, ViewBuffers, ViewUniforms};
pub use velocity::Velocity;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
