//! Vertex buffers that passes of a frame write.

use shadowgraph_core::{Buffer, Frame, Pass, Rendering};

/// The vertex buffers that passes of a frame write and that draws of the scene read, such as those of skinned meshes.
/// [Publish](Frame::publish) them after these passes: the passes that draw shadow maps, and those of the crate
/// `shadowgraph-lighting`, then declare that they read them.
///
/// ```
/// use shadowgraph_core::{BufferDesc, Contents, Frame};
/// use shadowgraph_shadows::VertexBuffers;
/// let mut frame = Frame::new();
/// let mut vertices = frame.create_buffer("vertices", BufferDesc::new(60));
/// frame.compute_pass("skinning").storage_buffer_mut(&mut vertices, Contents::Overwrite);
/// frame.publish(VertexBuffers(vec![vertices]));
/// let buffers = VertexBuffers::published_in(&frame);
/// let mut pass = frame.render_pass("draw");
/// buffers.read_in(&mut pass);
/// ```
#[derive(Clone, Debug, Default)]
pub struct VertexBuffers(pub Vec<Buffer>);

impl VertexBuffers {
    /// Returns the last published buffers; none if none have been published.
    pub fn published_in(frame: &Frame<'_>) -> Self {
        frame.published::<Self>().cloned().unwrap_or_default()
    }

    /// Declares that a pass reads the buffers.
    pub fn read_in(&self, pass: &mut Pass<'_, '_, Rendering>) {
        for buffer in &self.0 {
            pass.vertex_buffer(buffer);
        }
    }
}
