//! What can go wrong between a scene and its picture.

/// Why a scene could not be drawn. Every message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Pictures cannot be drawn with this many samples a pixel.
    #[error("--samples {samples}: pictures have 1 or 4 samples a pixel")]
    Samples {
        /// How many were asked for.
        samples: u32,
    },
    /// A pipeline has a node that cannot be drawn with several samples a pixel.
    #[error(
        "--samples {samples}: the pipeline's `{kind}` has one sample a pixel: leave the node out, or draw with one"
    )]
    OneSample {
        /// The kind of node.
        kind: &'static str,
        /// How many were asked for.
        samples: u32,
    },
    /// There is no adapter to draw with.
    #[error("no usable graphics adapter ({wanted}): {reason}")]
    NoAdapter {
        /// Which was asked for.
        wanted: String,
        /// What was found, and what to install.
        reason: String,
    },
    /// The adapter gives no device.
    #[error("{adapter} gives no device: {reason}")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// The picture is larger than the adapter allows.
    #[error("--size {width}x{height}: this adapter's max_texture_dimension_2d is {limit}")]
    PictureSize {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Pixels.
        limit: u32,
    },
    /// The target is not for colours.
    #[error("the target has the format {format:?}, which stores light as it is: give an sRGB format")]
    TargetFormat {
        /// The target's format.
        format: shadowgraph_core::Format,
    },
    /// A renderer of another output.
    #[error("only --aov color is measured: the passes encoded by hand draw nothing else")]
    BenchAov,
    /// A light that the scene does not have.
    #[error("--aov visibility:{light}: {there_are}")]
    NoLight {
        /// The index asked for.
        light: u32,
        /// How many there are.
        there_are: String,
    },
    /// A texture that the graph does not have.
    #[error("--aov {name}: there is no such output or texture{hint}")]
    NoTexture {
        /// The name asked for.
        name: String,
        /// A name that is like it, or all.
        hint: String,
    },
    /// A texture that is no picture.
    #[error(
        "--aov {name}: {format:?} holds whole numbers, which are no picture; `dump -o frame.html` shows them"
    )]
    NoPicture {
        /// The texture's name.
        name: String,
        /// Its format.
        format: shadowgraph_core::Format,
    },
    /// A pipeline is not right.
    #[error(transparent)]
    Pipeline(#[from] crate::pipelines::PipelineError),
    /// A pipeline has no such output.
    #[error("--aov {aov}: the outputs of pipeline {pipeline} name no `{output}`")]
    NoOutput {
        /// What is to be shown.
        aov: String,
        /// The pipeline.
        pipeline: String,
        /// What that would need.
        output: &'static str,
    },
    /// A kind of node contradicts itself: a mistake of whoever wrote it.
    #[error("the kind of node `{kind}` is wrong: {fault}")]
    NodeKind {
        /// Its name.
        kind: &'static str,
        /// What is wrong.
        fault: String,
    },
    /// A kind of node that there is not.
    #[error("there is no kind of node `{name}`{hint}")]
    NoNodeKind {
        /// The name asked for.
        name: String,
        /// A name that is like it, or all.
        hint: String,
    },
    /// A node that the frame gives nothing to read.
    #[error("`{port}` of `{node}` is not there in this frame: feed it, or leave the node out")]
    Unfed {
        /// The node.
        node: String,
        /// Its input.
        port: String,
    },
    /// Cases to measure cannot be read.
    #[error("{place}: {reason}")]
    Cases {
        /// The file.
        place: String,
        /// What is wrong, where, and what is allowed.
        reason: String,
    },
    /// Pictures that are compared do not fit together.
    #[error(transparent)]
    Metrics(#[from] crate::measure::metrics::MetricsError),
    /// The GPU refused something that was recorded, or was lost.
    #[error("the GPU failed: {0}")]
    Gpu(String),
    /// The frame does not compile or record.
    #[error(transparent)]
    Graph(#[from] shadowgraph_core::Error),
    /// The scene does not load or fit.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
    /// The camera sees nothing.
    #[error(transparent)]
    Camera(#[from] shadowgraph_scene::CameraError),
    /// The shadows cannot be planned.
    #[error(transparent)]
    Shadows(#[from] shadowgraph_shadows::Error),
    /// The lit passes cannot be made.
    #[error(transparent)]
    Lighting(#[from] shadowgraph_lighting::Error),
    /// A shader does not compose.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
}
