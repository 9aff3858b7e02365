//! Import of glTF 2.0 and GLB files.
//!
//! Drawn: meshes (triangles, strips and fans) and their instances, metallic-roughness materials,
//! PNG and JPEG images, cameras, and the extensions [`SUPPORTED_EXTENSIONS`]. Skins, morph targets and
//! animations are drawn at rest; each thing that is not drawn as written gives a line in `Scene::notes`.
//! Meshes that no drawn node uses, and images that no material uses, are not read.
//!
//! A file is not trusted: every index, offset, count and size is checked against the bytes that are
//! there before anything is allocated, references may not leave the file's own folder, and the size of
//! what is loaded is limited (see the constants). Whatever is wrong is one [`Error`](crate::Error) that says where.

mod accessors;
mod buffers;
mod cameras;
mod container;
mod document;
mod fault;
mod files;
mod images;
mod lights;
mod load;
mod materials;
mod mesh;
mod nodes;
mod notes;
mod textures;
mod triangles;
mod uri;
mod validate;

pub use images::{MAX_IMAGE_BYTES, MAX_IMAGE_SIZE_PX};
pub use load::{Progress, load, load_with_progress};
pub use validate::{MAX_BYTES, MAX_INDICES, MAX_INSTANCES, MAX_VERTICES, MAX_WORLD_M, SUPPORTED_EXTENSIONS};
