//! Cameras, lights, bounds, meshes and materials; glTF import, culling and GPU upload.
//!
//! The vocabulary is plain data: an engine with its own scene uses [`Camera`], [`Light`], [`Aabb`] and
//! [`ConvexVolume`] alone, without the features `gltf` (import of glTF and GLB files) and `gpu` (the GPU
//! copy of a scene and the draws of it).
//!
//! Conventions: right-handed world, +Y up, metres, seconds, radians; cameras look along -Z; depth is
//! reversed (near 1, far 0); matrices are named `destination_from_source`. Transforms are f64 and
//! absolute; GPU space is relative to [`origin_near`] the camera.

pub mod animation;
mod bounds;
mod camera;
mod cull;
mod error;
mod floor;
mod framing;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "gpu")]
pub mod gpu;
mod ground;
mod keys;
mod light;
mod material;
mod mesh;
mod origin;
mod scene;
mod sun;

pub use bounds::{Aabb, ConvexVolume, Plane};
pub use camera::{Camera, CameraError, Projection};
pub use cull::{BoundingSphere, Cone, CullTree, CullVolume};
pub use error::Error;
pub use ground::GroundPlane;
pub use keys::{ImageKey, InstanceKey, LightKey, MaterialKey, MeshKey};
pub use light::{Light, LightKind, MIN_ILLUMINANCE_LX};
pub use material::{
    AlphaMode, CasterMode, Filter, Image, Material, Sampler, TextureRef, Wrap, linear_from_srgb,
    srgb_from_linear,
};
pub use mesh::{Influence, Mesh, MeshPose, MorphDelta, MorphTarget, SkinWeights, Vertex};
pub use origin::{ORIGIN_GRID_M, origin_near};
pub use scene::{
    AnimationSelection, Attachment, ByName, Changes, EditError, Hierarchy, Instance, MaterialCasts,
    MaterialShadows, ObjectShadows, Scene, ShadowCasting, ShadowModes,
};
pub use sun::{SkyDirection, SolarTime};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
