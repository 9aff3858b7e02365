//! Configuration of rendering.

use shadowgraph_shadows::{Technique, TechniqueKind};

use crate::background::Background;
use crate::culling::Culling;
use crate::pipelines::pipeline::Pipeline;

/// Configuration of rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderConfig {
    /// The shadow technique; `None` for that of the pipeline, or `pcf` if it names none.
    pub technique: Option<Technique>,
    /// The pipeline.
    pub pipeline: Pipeline,
    /// Samples per pixel of colour images: 1, or 4 for smooth edges.
    pub samples: u32,
    /// What is drawn behind the scene.
    pub background: Background,
    /// What finds the instances that views and shadow maps show.
    pub culling: Culling,
}

impl Default for RenderConfig {
    fn default() -> Self {
        Self {
            technique: None,
            pipeline: Pipeline::default(),
            samples: 1,
            background: Background::Sky,
            culling: Culling::Auto,
        }
    }
}

impl RenderConfig {
    /// Returns the shadow technique, without what the pipeline adds to it.
    pub fn technique(&self) -> Technique {
        self.technique.or(self.pipeline.technique()).unwrap_or_default()
    }
}

impl From<Technique> for RenderConfig {
    fn from(technique: Technique) -> Self {
        Self { technique: Some(technique), ..Self::default() }
    }
}

impl From<TechniqueKind> for RenderConfig {
    fn from(kind: TechniqueKind) -> Self {
        Technique::from(kind).into()
    }
}

impl From<Pipeline> for RenderConfig {
    fn from(pipeline: Pipeline) -> Self {
        Self { pipeline, ..Self::default() }
    }
}
