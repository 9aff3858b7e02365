//! Whether the CPU or the GPU culls instances.

use std::fmt;

use serde::{Deserialize, Serialize};
use shadowgraph_scene::gpu::GpuScene;

/// What finds the instances that views and shadow maps show. Images are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Culling {
    /// The GPU in scenes with at least 4,096 instances, of which at least four share a draw on average; else the CPU.
    #[default]
    Auto,
    /// The CPU, with a tree of bounds. Its time grows with the number of visible instances.
    Cpu,
    /// The GPU, with a compute pass over all instances. The CPU's time does not depend on their number.
    Gpu,
}

/// The smallest number of instances that the GPU culls.
const MIN_INSTANCES: usize = 4096;
/// The smallest number of instances of a draw, on average.
const MIN_PER_DRAW: usize = 4;

/// What culls the instances of a frame, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CullChoice {
    pub(crate) on_gpu: bool,
    why: Why,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Why {
    Configured,
    Few { instances: usize },
    Different { instances: usize, draws: usize },
    Many { instances: usize, draws: usize },
}

impl Culling {
    /// Chooses for a scene.
    pub(crate) fn choose(self, scene: &GpuScene) -> CullChoice {
        let (instances, draws) = (scene.instance_count(), scene.batch_count());
        let (on_gpu, why) = match self {
            Self::Cpu => (false, Why::Configured),
            Self::Gpu => (true, Why::Configured),
            Self::Auto if instances < MIN_INSTANCES => (false, Why::Few { instances }),
            Self::Auto if instances < MIN_PER_DRAW * draws => (false, Why::Different { instances, draws }),
            Self::Auto => (true, Why::Many { instances, draws }),
        };
        CullChoice { on_gpu, why }
    }
}

impl fmt::Display for CullChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "culled on the {}: ", if self.on_gpu { "GPU" } else { "CPU" })?;
        match self.why {
            Why::Configured => f.write_str("configured"),
            Why::Few { instances } => write!(f, "{instances} instances, fewer than {MIN_INSTANCES}"),
            Why::Different { instances, draws } => {
                write!(f, "{instances} instances need {draws} draws, with fewer than {MIN_PER_DRAW} in each")
            }
            Why::Many { instances, draws } => write!(f, "{instances} instances in {draws} draws"),
        }
    }
}
