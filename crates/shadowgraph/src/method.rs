//! How pictures are drawn.

use shadowgraph_shadows::{Technique, TechniqueKind};

use crate::Pipeline;

/// How pictures are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// The shadows; `None`: those that the pipeline says, `pcf` where it says nothing.
    pub technique: Option<Technique>,
    /// The passes.
    pub pipeline: Pipeline,
    /// How many samples each pixel has while colours are drawn: 1, or 4 for smooth edges.
    pub samples: u32,
}

impl Default for Method {
    fn default() -> Self {
        Self { technique: None, pipeline: Pipeline::default(), samples: 1 }
    }
}

impl Method {
    /// Returns the technique that shadows are made with, without what the pipeline adds to it.
    pub fn technique(&self) -> Technique {
        self.technique.or(self.pipeline.technique()).unwrap_or_default()
    }
}

impl From<Technique> for Method {
    fn from(technique: Technique) -> Self {
        Self { technique: Some(technique), ..Self::default() }
    }
}

impl From<TechniqueKind> for Method {
    fn from(kind: TechniqueKind) -> Self {
        Technique::from(kind).into()
    }
}

impl From<Pipeline> for Method {
    fn from(pipeline: Pipeline) -> Self {
        Self { pipeline, ..Self::default() }
    }
}
