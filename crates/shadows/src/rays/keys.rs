//! Keys of what a ray scene has.

use slotmap::new_key_type;

new_key_type! {
    /// A mesh of a [`RayScene`].
    pub struct RayMeshKey;
    /// The surfaces of a mesh's triangles.
    pub struct RaySurfacesKey;
    /// A texture of surfaces.
    pub struct RayTextureKey;
    /// A mesh in the world.
    pub struct RayInstanceKey;
}
