//! Import of glTF 2.0 and GLB files.
//!
//! Drawn: meshes (triangles, strips and fans) and their instances, metallic-roughness materials,
//! PNG, JPEG, WebP and KTX2 images, cameras, animations, skins, morph targets, and the extensions [`SUPPORTED_EXTENSIONS`]. Everything that is
//! not drawn as the file says adds a line to `Scene::notes`.
//! Meshes that no drawn node uses, and images that no material uses, are not read.
//!
//! Files are not trusted: every index, offset, count and size is checked against the available bytes before
//! anything is allocated, references must not leave the file's directory, and the size of a scene is limited (see
//! the constants). Every error is one [`Error`](crate::Error) that says where in the file it is.

mod accessors;
mod animations;
mod buffers;
mod cameras;
mod container;
mod conversions;
mod document;
mod draco;
mod error;
mod extras;
mod files;
mod hierarchy;
mod images;
mod instancing;
mod ktx2;
mod lights;
mod load;
mod materials;
mod mesh;
mod meshopt;
mod nodes;
mod notes;
mod skins;
mod specular_glossiness;
mod textures;
mod transmission;
mod uri;
mod validate;
mod variants;

pub use images::{MAX_IMAGE_BYTES, MAX_IMAGE_SIZE_PX};
pub use load::{LoadOptions, Progress, load, load_bytes, load_with, referenced_files};
pub use validate::{
    MAX_BYTES, MAX_INDICES, MAX_INSTANCES, MAX_JOINTS, MAX_KEYFRAME_VALUES, MAX_MORPH_WEIGHTS, MAX_VERTICES,
    MAX_WORLD_M, SUPPORTED_EXTENSIONS,
};
