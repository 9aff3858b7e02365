//! Explanation of the order of two passes.

use super::Page;
use crate::dump::positions::Positions;
use crate::handle::PassId;
use crate::plan::{Dependency, OrderReason, Plan};

impl Plan {
    /// Explains why `before` runs before `after`: the shortest chain of dependencies from one to the other, one on each
    /// line, or that nothing orders them. See [`why_before`](Self::why_before) for the chain itself.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// let mut picture = frame.create_texture("picture", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    /// let mut draw = frame.render_pass("draw");
    /// draw.color(&mut scene, Contents::clear_color([0.0; 4]));
    /// let draw = draw.id();
    /// let mut tonemap = frame.render_pass("tonemap");
    /// tonemap.sample(&scene);
    /// tonemap.color(&mut picture, Contents::Overwrite);
    /// let tonemap = tonemap.id();
    /// frame.export_texture(&picture);
    /// let why = frame.compile()?.plan().explain_why_before(draw, tonemap);
    /// assert!(why.contains("`tonemap` needs what `draw` wrote to `scene`"));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn explain_why_before(&self, before: PassId, after: PassId) -> String {
        let (first, second) = (self.pass_path(before), self.pass_path(after));
        for (pass, path) in [(before, &first), (after, &second)] {
            if let Some(reason) = self.pass(pass).culled {
                return Page::new(&format!("`{path}` does not run: {}", self.describe_cull(reason))).0;
            }
        }
        if before == after {
            return Page::new(&format!("`{first}` and `{second}` are the same pass")).0;
        }
        if let Some(chain) = self.why_before(before, after) {
            return self.explain_chain(&format!("`{first}` runs before `{second}`"), &chain);
        }
        if let Some(chain) = self.why_before(after, before) {
            return self.explain_chain(&format!("`{first}` runs after `{second}`"), &chain);
        }
        let positions = Positions::new(self);
        let at = |pass| positions.get(pass).map(|position| position.order);
        let (early, late) = if at(before) < at(after) { (before, after) } else { (after, before) };
        let mut page = Page::new(&format!("nothing orders `{first}` and `{second}`"));
        page.line(
            1,
            &format!("`{}` runs first: {}", self.pass_path(early), self.explain_choice(early, late)),
        );
        page.0
    }

    /// Explains why `early` was scheduled before `late`, although nothing orders them.
    fn explain_choice(&self, early: PassId, late: PassId) -> String {
        let positions = Positions::new(self);
        let at = |pass| positions.get(pass).map(|position| position.order);
        let reason = self.order_reason(early);
        let chosen = !matches!(
            reason,
            Some(OrderReason::Fixed | OrderReason::DeclarationNeedsLess | OrderReason::BackwardsNeedsLess)
        );
        let undone = self.waits_for(late).iter().map(|d| d.before).filter(|&pass| at(pass) > at(early)).min();
        match (undone, reason) {
            (Some(pass), _) if chosen => {
                format!("`{}` was still waiting for `{}`", self.pass_path(late), self.pass_path(pass))
            }
            (_, reason) => reason.map(|reason| self.describe_order(reason)).unwrap_or_default(),
        }
    }

    fn explain_chain(&self, heading: &str, chain: &[Dependency]) -> String {
        let mut page = Page::new(heading);
        for dependency in chain {
            page.line(1, &self.explain_dependency(dependency));
        }
        page.0
    }
}
