//! Stable keys of what a scene has.

slotmap::new_key_type! {
    /// The key of a mesh of a [`Scene`](crate::Scene). The key of a removed mesh never becomes that of another one.
    pub struct MeshKey;
    /// The key of a material of a [`Scene`](crate::Scene). The key of a removed material never becomes that of another one.
    pub struct MaterialKey;
    /// The key of an image of a [`Scene`](crate::Scene). The key of a removed image never becomes that of another one.
    pub struct ImageKey;
    /// The key of an instance of a [`Scene`](crate::Scene). The key of a removed instance never becomes that of another one.
    pub struct InstanceKey;
    /// The key of a light of a [`Scene`](crate::Scene). The key of a removed light never becomes that of another one.
    pub struct LightKey;
}
