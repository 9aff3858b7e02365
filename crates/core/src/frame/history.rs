//! Histories: what one frame leaves to the next.

use super::Frame;
use crate::declaration::{Declaration, Origin};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::{NodeId, Texture};
use crate::history::{HistoryUse, Resize};
use crate::name::Name;

/// A texture of two frames: what it held in the frame before, and what it shall hold now.
///
/// The graph keeps both halves and swaps them whenever a frame that declares the history is executed. Frames that do
/// not declare it leave it as it is, until as many have gone by as [`PoolLimits`](crate::PoolLimits) lets things lie
/// idle. Its key is its name and the views ([`Frame::view`]) around it. A usage that a later frame adds does not cost
/// the contents, nor does a change of what the frame does with it otherwise.
///
/// `current` must be written as a whole by passes of this frame; it is a root, so they stay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct History {
    /// What the frame before left; zeros where there is nothing. It is only read.
    pub previous: Texture,
    /// What this frame writes for the next.
    pub current: Texture,
    /// Whether `previous` holds what an earlier frame wrote. False in the first frame, after a resize that resets, and
    /// after a change of format, layers, samples or dimension.
    ///
    /// It tells what will be so if no other frame is executed between this one's [`Graph::frame`](crate::Graph::frame)
    /// and its own execution; of frames that are declared ahead, the later ones do not know of the earlier. The plan
    /// does not depend on it.
    pub valid: bool,
}

impl Frame<'_> {
    /// Declares a history: a pair of textures that carries contents from frame to frame. A second one of the same name
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
    /// assert!(!colour.valid, "nothing was there before the first frame");
    /// # frame.compile()?;
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn history(&mut self, name: impl Name, desc: TextureDesc, resize: Resize) -> History {
        let history = self.work.histories.len() as u32;
        let desc = ResourceDesc::Texture(desc);
        let previous = self.add_resource(Before(&name), desc, Origin::Previous { history });
        let current = self.add_resource(&name, desc, Origin::Current { history });
        let own =
            HistoryUse { previous: previous.resource, current: current.resource, resize, view: self.view };
        if self.work.histories.iter().any(|other| is_same(&self.decl, &own, other)) {
            let resource = self.decl.resource_name(own.current).into();
            let problem = "duplicate history name in its view".into();
            self.errors.push(Error::InvalidResource { resource, problem });
        }
        self.work.histories.push(own);
        let valid = self.known.history_valid(&self.decl, self.view, current.resource, resize);
        History { previous: Texture(previous), current: Texture(current), valid }
    }
}

/// Whether two histories would share their textures.
fn is_same(decl: &Declaration, one: &HistoryUse, other: &HistoryUse) -> bool {
    decl.resource_name(one.current) == decl.resource_name(other.current)
        && is_path(decl, one.view, other.view)
}

/// Whether two nodes have the same path.
fn is_path(decl: &Declaration, one: Option<NodeId>, other: Option<NodeId>) -> bool {
    let (Some(one), Some(other)) = (one, other) else { return one == other };
    let (one, other) = (&decl.nodes[one.index()], &decl.nodes[other.index()]);
    decl.names.get(one.name) == decl.names.get(other.name) && is_path(decl, one.parent, other.parent)
}

/// The name of a history's former half.
struct Before<N>(N);

impl<N: Name> Name for Before<N> {
    fn write_to(&self, text: &mut String) {
        self.0.write_to(text);
        text.push_str(" before");
    }
}
