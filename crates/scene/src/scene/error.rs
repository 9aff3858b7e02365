//! Errors of edits.

/// An edit of a scene that was refused. The scene is as it was before.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The key is of another scene, or its value was removed.
    #[error("the {kind} does not exist: its key is of another scene, or it was removed")]
    StaleKey {
        /// The kind of value: "mesh".
        kind: &'static str,
    },
    /// Others refer to the value to remove.
    #[error("{what} is used by {users} {by}; remove them first, or let them use another")]
    InUse {
        /// The value: "mesh \"cube\"".
        what: String,
        /// The number of values that refer to it.
        users: u32,
        /// Their kind: "instances".
        by: &'static str,
    },
    /// A transform has values that are not finite.
    #[error("{what}: its transform has a value that is not finite (allowed: finite numbers)")]
    NotFinite {
        /// The instance: "instance \"cube\"".
        what: String,
    },
    /// An image does not have the bytes of its size.
    #[error(
        "{what}: {width} x {height} pixels of 4 bytes (allowed: at least 1 x 1) do not have {bytes} bytes"
    )]
    ImageSize {
        /// The image: "image \"bark\"".
        what: String,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// The bytes that it has.
        bytes: usize,
    },
    /// A pose has fewer joints than its mesh needs.
    #[error("{what}: its pose has {joints} joints (allowed: none, or at least {needed})")]
    TooFewJoints {
        /// The instance: "instance \"cube\"".
        what: String,
        /// The number of joints.
        joints: usize,
        /// The number that the mesh needs.
        needed: usize,
    },
    /// An animation moves something too far away.
    #[error("{what}: it is moved over 1e15 m from the world's origin (allowed: up to 1e15 m)")]
    OutOfRange {
        /// The node and the time: "node 3 \"arm\" at 2 s".
        what: String,
    },
}
