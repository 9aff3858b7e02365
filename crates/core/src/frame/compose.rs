//! Composition of a frame from nodes.

use super::Frame;
use crate::declaration::NodeDecl;
use crate::error::Error;
use crate::handle::NodeId;
use crate::name::Name;
use std::any::{Any, TypeId, type_name};

impl Frame<'_> {
    /// Runs `build` and groups every pass that it adds under the node `name`. Nodes nest; a node without passes is
    /// removed.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, Texture, TextureDesc};
    ///
    /// /// A node is a function that adds passes and returns handles.
    /// fn clear(frame: &mut Frame<'_>) -> Texture {
    ///     frame.node("background", |frame| {
    ///         let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    ///         frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0, 0.0, 0.0, 1.0]));
    ///         color
    ///     })
    /// }
    /// # clear(&mut Frame::new());
    /// ```
    pub fn node<R>(&mut self, name: impl Name, build: impl FnOnce(&mut Self) -> R) -> R {
        let parent = self.node;
        let id = NodeId(self.decl.nodes.len() as u32);
        let declared = |frame: &Self| (frame.decl.passes.len(), frame.decl.resources.len());
        let before = declared(self);
        let name = self.decl.names.push(name);
        self.decl.nodes.push(NodeDecl { name, parent });
        self.node = Some(id);
        let result = build(self);
        self.node = parent;
        let is_empty = declared(self) == before && self.decl.nodes.len() == id.index() + 1;
        if is_empty && self.view != Some(id) {
            self.decl.nodes.pop();
        }
        result
    }

    /// Runs `build` as a node for one view, such as an eye or half of a split screen. Each view can repeat the same
    /// declarations and has its own histories, identified by the name of the view.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let eyes = ["left", "right"].map(|eye| {
    ///     frame.view(eye, |frame| {
    ///         let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    ///         frame.render_pass("draw").color(&mut color, Contents::clear_color([0.0; 4]));
    ///         color
    ///     })
    /// });
    /// for eye in &eyes {
    ///     frame.export_texture(eye);
    /// }
    /// let plan = frame.compile()?.into_plan();
    /// assert_eq!(plan.pass_path(plan.order()[1]), "right/draw");
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn view<R>(&mut self, name: impl Name, build: impl FnOnce(&mut Self) -> R) -> R {
        let outer = self.view;
        let result = self.node(name, |frame| {
            frame.view = frame.node;
            build(frame)
        });
        self.view = outer;
        result
    }

    /// Runs `build` only if `condition` is true. Later nodes with an optional input take the `Option`, or a placeholder
    /// from [`or_placeholder`](Self::or_placeholder).
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let (width, height) = (64, 64);
    /// let bloom = frame.when(width > 100, |frame| {
    ///     let mut glow = frame.create_texture("glow", TextureDesc::d2(width, height, Format::Rgba16Float));
    ///     frame.render_pass("glow").color(&mut glow, Contents::clear_color([0.0; 4]));
    ///     glow
    /// });
    /// assert!(bloom.is_none());
    /// ```
    pub fn when<R>(&mut self, condition: bool, build: impl FnOnce(&mut Self) -> R) -> Option<R> {
        condition.then(|| build(self))
    }

    /// Publishes a value of a node, such as a struct of handles, for nodes that do not get it as an argument. It is
    /// looked up by type; a second value of a type replaces the first.
    ///
    /// ```
    /// use shadowgraph_core::{Format, Frame, Texture, TextureDesc};
    /// struct SceneDepth(Texture);
    ///
    /// let mut frame = Frame::new();
    /// let depth = frame.create_texture("depth", TextureDesc::d2(64, 64, Format::Depth32Float));
    /// frame.publish(SceneDepth(depth));
    /// let SceneDepth(depth) = frame.published()?;
    /// # let _ = depth;
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn publish<T: Any + Send>(&mut self, value: T) {
        self.published.insert(TypeId::of::<T>(), Box::new(value));
    }

    /// Returns the last published value of type `T`.
    ///
    /// # Errors
    /// [`Error::NotPublished`] if there is none.
    pub fn published<T: Any + Send>(&self) -> Result<&T, Error> {
        let value = self.published.get(&TypeId::of::<T>()).and_then(|value| value.downcast_ref());
        value.ok_or_else(|| {
            let location = match self.node {
                Some(id) => {
                    let mut path = String::new();
                    self.decl.write_node_path(id, &mut path);
                    format!("node `{path}`")
                }
                None => "the frame".into(),
            };
            Error::NotPublished { location, value: type_name::<T>() }
        })
    }
}
