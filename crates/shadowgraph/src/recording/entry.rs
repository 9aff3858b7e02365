//! What a recording has of a frame: a line of its file, in RON, whose numbers read back as the same bits.

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use shadowgraph_scene::{Camera, Instance, Light, Material, MeshPose, ShadowCasting};

use crate::background::Background;
use crate::culling::Culling;
use crate::shadow_lines::ShadowLines;

/// The first line of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Header {
    /// [`FORMAT`].
    pub(crate) format: String,
    /// [`VERSION`].
    pub(crate) version: u32,
    /// How the program finds the scene.
    pub(crate) source: Value,
    pub(crate) scene: SceneSummary,
}

pub(crate) const FORMAT: &str = "shadowgraph recording";
pub(crate) const VERSION: u32 = 1;

/// The scene as it was when the recording began.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneSummary {
    pub(crate) instances: usize,
    pub(crate) materials: usize,
    pub(crate) meshes: usize,
    /// A hash of the vertices and indices of all meshes.
    pub(crate) geometry: u64,
}

/// A frame. What is left out is as in the frame before, or absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct FrameEntry {
    /// If it is the first of a renderer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) renderer: Option<RendererEntry>,
    #[serde(skip_serializing_if = "SceneEdits::is_empty")]
    pub(crate) edits: SceneEdits,
    /// The height of the ground; absent: there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ground: Option<f64>,
    /// Absent: that of the view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) shadow_camera: Option<Camera>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) overlay: Option<ShadowLines>,
    pub(crate) views: Vec<ViewEntry>,
}

/// A renderer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RendererEntry {
    /// Edits of the scene before it was created.
    #[serde(default, skip_serializing_if = "SceneEdits::is_empty")]
    pub(crate) edits: SceneEdits,
    /// Whether the scene had the shadow modes of the settings.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) has_modes: bool,
    /// The origin of GPU space, metres.
    pub(crate) origin_world: DVec3,
    pub(crate) aov: String,
    pub(crate) technique: String,
    pub(crate) pipeline: PipelineEntry,
    pub(crate) samples: u32,
    pub(crate) background: Background,
    pub(crate) culling: Culling,
}

/// A pipeline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PipelineEntry {
    /// The name of a built-in pipeline or of a file.
    pub(crate) name: String,
    /// The text of a file; absent for a built-in pipeline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) text: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) parameters: Vec<(String, Value)>,
}

/// A view.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct ViewEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) camera: Option<Camera>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) size_px: Option<[u32; 2]>,
    /// RON.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) settings: Option<String>,
}

/// Edits of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct SceneEdits {
    /// Instances by their numbers, the order in which the scene lists them, in the order of the edits.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) instances: Vec<(usize, InstanceEdit)>,
    /// Materials by their numbers; absent: it was edited and is as before.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) materials: Vec<(usize, Option<Material>)>,
    /// Lights by their numbers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) lights: Vec<(usize, Light)>,
    /// All lights, if their number or their order has changed, before the edits of `lights`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) all_lights: Option<Vec<Light>>,
}

impl SceneEdits {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Changes of an instance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct InstanceEdit {
    #[serde(skip_serializing_if = "Option::is_none")]
    world_from_local: Option<DAffine3>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pose: Option<PoseEntry>,
    /// Whether it is drawn, casts shadows, and receives them.
    #[serde(skip_serializing_if = "Option::is_none")]
    flags: Option<(bool, ShadowCasting, bool)>,
}

/// The pose of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
enum PoseEntry {
    Rest,
    Posed { joints: Vec<DAffine3>, weights: Vec<f32> },
}

impl InstanceEdit {
    /// Returns what changed; `None` if it has another mesh, material or name.
    pub(crate) fn between(before: &Instance, after: &Instance) -> Option<Self> {
        let identity = |instance: &Instance| (instance.mesh, instance.material);
        let flags = |instance: &Instance| (instance.visible, instance.casts, instance.receives_shadows);
        if identity(before) != identity(after) || before.name != after.name {
            return None;
        }
        let moved = before.world_from_local != after.world_from_local;
        Some(Self {
            world_from_local: moved.then_some(after.world_from_local),
            pose: (before.pose != after.pose).then(|| PoseEntry::new(after.pose.as_ref())),
            flags: (flags(before) != flags(after)).then(|| flags(after)),
        })
    }

    pub(crate) fn apply_to(&self, instance: &mut Instance) {
        let Self { world_from_local, pose, flags } = self;
        if let Some(world_from_local) = world_from_local {
            instance.world_from_local = *world_from_local;
        }
        if let Some(pose) = pose {
            instance.pose = pose.pose();
        }
        if let Some(flags) = *flags {
            (instance.visible, instance.casts, instance.receives_shadows) = flags;
        }
    }
}

impl PoseEntry {
    fn new(pose: Option<&MeshPose>) -> Self {
        pose.map_or(Self::Rest, |MeshPose { joints, weights }| Self::Posed {
            joints: joints.to_vec(),
            weights: weights.clone(),
        })
    }

    fn pose(&self) -> Option<MeshPose> {
        match self {
            Self::Rest => None,
            Self::Posed { joints, weights } => {
                Some(MeshPose { joints: joints.as_slice().into(), weights: weights.clone() })
            }
        }
    }
}
