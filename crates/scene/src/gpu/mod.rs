//! The GPU copy of a scene, and its draws.
//!
//! [`GpuScene`] holds all vertices in one buffer, all indices in another, the transforms of the instances in a
//! storage buffer (group 3) and a bind group for each material (group 2). It records the draws of a [`DrawList`]
//! with the caller's pipelines; [`DepthPipelines`] has those that draw only depth. Groups 0 and 1 belong to the
//! caller.
//!
//! ```
//! use glam::{DAffine3, DVec3};
//! use shadowgraph_scene::gpu::GpuScene;
//! use shadowgraph_scene::{Material, Mesh, Scene, origin_near};
//!
//! // A device that does nothing; a real one comes from an adapter.
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//! let mut scene = Scene::default();
//! let cube = scene.add(Mesh::cuboid(DVec3::ZERO, DVec3::ONE), Material::default(), DAffine3::IDENTITY)?;
//! let eye_world = DVec3::new(3.0, 2.0, 4.0);
//! let mut gpu = GpuScene::new(&device, &queue, &scene, origin_near(eye_world))?;
//! // The upload has everything.
//! let _ = scene.take_changes();
//! // Every frame:
//! scene.move_instance(cube, DAffine3::from_translation(DVec3::Y))?;
//! let changes = scene.take_changes();
//! gpu.update(&device, &queue, &scene, &changes)?;
//! let draws = gpu.draw_list(&[0], eye_world);
//! assert_eq!((draws.solid.len(), gpu.all_bounds().max.y), (1, 2.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batches;
#[cfg(feature = "gltf")]
mod block_texture;
mod coverage;
mod culled;
mod depth;
mod draw_list;
mod element_buffer;
mod geometry;
mod instances;
mod key;
mod layers;
mod limits;
mod material_features;
mod materials;
mod mips;
mod numbers;
mod posed;
mod scene;
mod static_changes;
mod textures;
mod update;
mod write_batch;

pub use batches::CullFlags;
pub use culled::{CullInputs, CulledView};
pub use depth::{CasterPipelines, DepthPipelines, DepthTarget};
pub use draw_list::{Draw, DrawList, DrawPipeline, MaterialUse};
pub use geometry::{previous_vertex_layout, vertex_layout};
pub use key::{AlphaKey, PipelineKey};
pub use layers::{LAYER_DRAW_BYTES, LAYER_TARGET, LayerDraws, LayerPipelines};
pub use material_features::MaterialFeatures;
pub use materials::MaterialLayouts;
pub use posed::{PoseDone, PoseInputs};
pub use scene::GpuScene;
