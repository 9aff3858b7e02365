//! Histories: textures that carry contents from one frame to the next.

use super::Frame;
use crate::declaration::{Declaration, Origin};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::{NodeId, Texture};
use crate::history::{HistoryUse, Resize};
use crate::name::Name;

/// A pair of textures: the contents from the previous frame, and the contents that this frame writes for the next.
///
/// The graph keeps both halves and swaps them whenever a frame that declares the history is executed. Frames that do
/// not declare it do not change it; it is released when it has been unused for as many frames as
/// [`PoolLimits`](crate::PoolLimits) allows. It is identified by its name and the views ([`Frame::view`]) around it. The
/// contents are kept if a later frame adds a usage or uses the history differently.
///
/// Passes of this frame must write all of `current`. It is a root, so these passes are not culled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct History {
    /// Contents from the previous frame, read only; zeros if there are none.
    pub previous: Texture,
    /// Contents that this frame writes for the next.
    pub current: Texture,
    /// Whether `previous` holds what an earlier frame wrote. False in the first frame, after a resize that resets, and
    /// after a change of format, layers, samples or dimension.
    ///
    /// The value assumes that no other frame is executed between this frame's [`Graph::frame`](crate::Graph::frame) and
    /// its execution: a frame that is declared ahead does not consider earlier frames that are not executed yet. The
    /// plan does not depend on it.
    pub valid: bool,
}

impl Frame<'_> {
    /// Declares a history: a pair of textures that carries contents from frame to frame. A duplicate name
    /// in the same view is an error.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, Resize, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut colour =
    ///     frame.history("accumulated", TextureDesc::d2(64, 64, Format::Rgba16Float), Resize::Reset);
    /// let mut pass = frame.render_pass("accumulate");
    /// let _before = pass.sample(&colour.previous);
    /// pass.color(&mut colour.current, Contents::Overwrite);
    /// assert!(!colour.valid, "the first frame has no history");
    /// # frame.compile()?;
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn history(&mut self, name: impl Name, desc: TextureDesc, resize: Resize) -> History {
        let history = self.work.histories.len() as u32;
        let desc = ResourceDesc::Texture(desc);
        let previous = self.add_resource(PreviousName(&name), desc, Origin::Previous { history });
        let current = self.add_resource(&name, desc, Origin::Current { history });
        let own =
            HistoryUse { previous: previous.resource, current: current.resource, resize, view: self.view };
        if self.work.histories.iter().any(|other| is_duplicate(&self.decl, &own, other)) {
            let resource = self.decl.resource_name(own.current).into();
            let problem = "duplicate history name in its view".into();
            self.errors.push(Error::InvalidResource { resource, problem });
        }
        self.work.histories.push(own);
        let valid = self.prior.history_valid(&self.decl, self.view, current.resource, resize);
        History { previous: Texture(previous), current: Texture(current), valid }
    }
}

/// Returns whether two histories have the same name and view.
fn is_duplicate(decl: &Declaration, one: &HistoryUse, other: &HistoryUse) -> bool {
    decl.resource_name(one.current) == decl.resource_name(other.current)
        && have_same_path(decl, one.view, other.view)
}

/// Returns whether two nodes have the same path.
fn have_same_path(decl: &Declaration, one: Option<NodeId>, other: Option<NodeId>) -> bool {
    let (Some(one), Some(other)) = (one, other) else { return one == other };
    let (one, other) = (&decl.nodes[one.index()], &decl.nodes[other.index()]);
    decl.names.get(one.name) == decl.names.get(other.name) && have_same_path(decl, one.parent, other.parent)
}

/// The name of the previous texture of a history.
struct PreviousName<N>(N);

impl<N: Name> Name for PreviousName<N> {
    fn write_to(&self, text: &mut String) {
        self.0.write_to(text);
        text.push_str(" before");
    }
}
