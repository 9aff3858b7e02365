//! Errors.

/// An error while a scene is drawn. Every message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The number of samples per pixel is not supported.
    #[error("unsupported sample count {samples}; expected 1 or 4")]
    SampleCount {
        /// The number of samples.
        samples: u32,
    },
    /// A pipeline has a node that does not support multisampling.
    #[error("the node `{kind}` does not support {samples} samples per pixel: remove it, or use 1 sample")]
    SingleSampleOnly {
        /// The kind of node.
        kind: &'static str,
        /// The number of samples.
        samples: u32,
    },
    /// The requested adapter does not exist.
    #[error("no usable graphics adapter ({wanted}): {reason}")]
    NoAdapter {
        /// The requested adapter.
        wanted: String,
        /// The adapters that were found, and what to install.
        reason: String,
    },
    /// The adapter does not create a device.
    #[error("failed to create a device on {adapter}: {reason}")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// The image is larger than the adapter allows.
    #[error("image size {width}x{height} exceeds the adapter's max_texture_dimension_2d, {limit}")]
    ImageSize {
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
        /// The limit, pixels.
        limit: u32,
    },
    /// The pixel is not one of the image.
    #[error("pixel {},{} is outside of the image; expected 0,0 to {},{}", pixel[0], pixel[1], size_px[0] - 1, size_px[1] - 1)]
    PixelOutside {
        /// Column and row.
        pixel: [u32; 2],
        /// Width and height of the image.
        size_px: [u32; 2],
    },
    /// The target of a colour image has no sRGB format.
    #[error("the target's format {format:?} does not encode colours; expected an sRGB format")]
    TargetFormat {
        /// The target's format.
        format: shadowgraph_core::Format,
    },
    /// A light that the scene does not have.
    #[error("unknown light {light}; {lights}")]
    UnknownLight {
        /// The index.
        light: u32,
        /// The lights of the scene.
        lights: String,
    },
    /// A texture that the graph does not have.
    #[error("unknown output or texture `{name}`{hint}")]
    UnknownTexture {
        /// The name.
        name: String,
        /// The closest name, or all.
        hint: String,
    },
    /// A version of a texture that cannot be shown.
    #[error("`{name}@{version}`: {reason}")]
    NoImage {
        /// The texture's name.
        name: String,
        /// The version.
        version: u32,
        /// The problem, and what is expected.
        reason: String,
    },
    /// A texture of a format that cannot be displayed.
    #[error(
        "texture `{name}` ({format:?}): integer textures cannot be displayed; the HTML page of the frame shows them"
    )]
    NotDisplayable {
        /// The texture's name.
        name: String,
        /// Its format.
        format: shadowgraph_core::Format,
    },
    /// A pipeline is invalid.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// A pipeline does not have an output that an AOV needs.
    #[error("`{aov}` needs the output `{output}`, which the pipeline {pipeline} does not have")]
    MissingOutput {
        /// The AOV.
        aov: String,
        /// The pipeline.
        pipeline: String,
        /// The output that it needs.
        output: &'static str,
    },
    /// The implementation of a kind of node is invalid.
    #[error("invalid node kind `{kind}`: {reason}")]
    NodeKind {
        /// The name of the kind.
        kind: &'static str,
        /// The problem.
        reason: String,
    },
    /// A kind of node that is not registered.
    #[error("unknown node kind `{name}`{hint}")]
    UnknownNodeKind {
        /// The name.
        name: String,
        /// The closest name, or all.
        hint: String,
    },
    /// An input of a node has no value in this frame.
    #[error("input `{port}` of `{node}` is not connected in this frame: connect it, or remove the node")]
    Unconnected {
        /// The node.
        node: String,
        /// Its input.
        port: String,
    },
    /// wgpu reported a validation error or an internal error.
    #[error("wgpu error: {0}")]
    Gpu(String),
    /// The frame cannot be compiled or executed.
    #[error(transparent)]
    Graph(#[from] shadowgraph_core::Error),
    /// The scene cannot be loaded or uploaded.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
    /// An edit of the scene was refused.
    #[error(transparent)]
    Edit(#[from] shadowgraph_scene::EditError),
    /// The camera is invalid.
    #[error(transparent)]
    Camera(#[from] shadowgraph_scene::CameraError),
    /// The shadows cannot be drawn.
    #[error(transparent)]
    Shadows(#[from] shadowgraph_shadows::Error),
    /// The lit passes cannot be built.
    #[error(transparent)]
    Lighting(#[from] shadowgraph_lighting::Error),
    /// A recorded frame is invalid.
    #[error("{0}")]
    Recorded(String),
    /// A shader does not compose.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
}

/// An error in a pipeline: where it is, what is wrong, and what is expected, in one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{location}: {problem}")]
pub struct PipelineError {
    /// The file, with line and column if it is one location in it.
    pub location: String,
    /// The problem, and what is expected.
    pub problem: String,
}
