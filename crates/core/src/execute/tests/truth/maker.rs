//! Random passes that read only what is defined.

use super::graph::{Buffer, Contents, Graph, Inputs, Pass, Plane, Role, Span, Target, texels_in};
use super::interpret::{State, Word};
use super::random::Random;
use crate::Rect;

/// Creates a pass that reads only what is defined so far.
pub(super) struct Maker<'g> {
    pub(super) graph: &'g Graph,
    pub(super) state: &'g State,
    pub(super) random: &'g mut Random,
}

impl Maker<'_> {
    pub(super) fn pass(mut self) -> Option<Pass> {
        match self.random.below(16) {
            0..8 => self.draw(),
            8..10 => self.words(),
            10..12 => self.texels(),
            12..14 => self.copy_texture(),
            14 => self.copy_buffer(),
            _ => self.rows(),
        }
    }

    /// Picks up to two textures and buffers that are known and that the pass does not write, most of them new.
    fn inputs(&mut self, planes: &[Plane], buffer: Option<usize>) -> Inputs {
        let Self { graph, state, random } = self;
        let mut inputs = Inputs { constant: random.word(), planes: Vec::new(), spans: Vec::new() };
        let recent = &graph.passes[graph.passes.len().saturating_sub(3)..];
        let known = |plane: &Plane| state.plane(*plane).iter().all(|word| word.is_known());
        let free: Vec<_> = graph.all_planes().filter(|p| !planes.contains(p) && known(p)).collect();
        let new =
            recent.iter().flat_map(Pass::planes).filter(|plane| free.contains(plane)).collect::<Vec<_>>();
        for _ in 0..random.pick(&[0, 1, 1, 2]) {
            inputs.planes.extend(random.pick_either(&new, &free).map(|plane| (plane, random.below(5))));
        }
        let mut free = Vec::new();
        for (index, own) in graph.buffers.iter().enumerate().filter(|(index, _)| Some(*index) != buffer) {
            let span = |start, end| Span { buffer: index, start, end: own.words.min(end) };
            let blocks = (0..own.words).step_by(64).map(|start| span(start, start + 64));
            let known = |span: &Span| state.words(*span).iter().all(|word| word.is_known());
            free.extend([span(0, own.words)].into_iter().chain(blocks).filter(known));
        }
        let made = |span: &&Span| recent.iter().any(|pass| pass.buffer() == Some(span.buffer));
        let new: Vec<_> = free.iter().filter(made).copied().collect();
        for _ in 0..random.pick(&[0, 1, 1, 2]) {
            inputs.spans.extend(random.pick_either(&new, &free).map(|span| (span, random.below(70))));
        }
        inputs
    }

    /// A plane to write: one that the pass before drew into, so that there is something to merge, a new one, or any.
    fn written(&mut self) -> Option<Plane> {
        if let (Some(Pass::Draw { targets, .. }), true) =
            (self.graph.passes.last(), self.random.below(2) == 0)
        {
            return Some(targets[0].plane);
        }
        let mut free: Vec<_> = self.graph.all_planes().collect();
        free.retain(|plane| !matches!(self.graph.textures[plane.texture].role, Role::Previous(_)));
        let untouched = |plane: &&Plane| self.state.plane(**plane).contains(&Word::Undefined);
        let new: Vec<_> = free.iter().filter(untouched).copied().collect();
        self.random.pick_either(&new, &free)
    }

    /// A tile of a grid, or any rectangle.
    fn rect(&mut self, within: Rect) -> Rect {
        let Rect { x, y, width, height } = within;
        if self.random.below(3) == 0 {
            let (own_width, own_height) = (1 + self.random.below(width), 1 + self.random.below(height));
            let left = x + self.random.below(width - own_width + 1);
            let top = y + self.random.below(height - own_height + 1);
            return Rect::new(left, top, own_width, own_height);
        }
        let columns = self.random.pick(&[1, 2, 2]).min(width);
        let rows = self.random.pick(&[1, 2, 2]).min(height);
        let (width, height) = (width / columns, height / rows);
        let (column, row) = (self.random.below(columns), self.random.below(rows));
        Rect::new(x + column * width, y + row * height, width, height)
    }

    fn known_in(&self, plane: Plane, rect: Rect) -> bool {
        let (width, _) = self.graph.size(plane);
        let words = self.state.plane(plane);
        texels_in(rect).all(|(x, y)| words[(x + y * width) as usize].is_known())
    }

    fn contents(&mut self, plane: Plane, rect: Rect, covered: bool) -> Contents {
        let known = self.known_in(plane, rect);
        match self.random.below(3) {
            0 if covered => Contents::Overwrite,
            1 if known => Contents::Preserve,
            _ => {
                // Often zero, which is what the graph itself clears to, and often what another pass clears to.
                let any = self.random.word();
                Contents::Clear(self.random.pick(&[0, 7, any]))
            }
        }
    }

    fn draw(&mut self) -> Option<Pass> {
        let first = self.written()?;
        let size = self.graph.size(first);
        let mut planes = vec![first];
        let others = self.graph.all_planes().filter(|&plane| {
            let role = self.graph.textures[plane.texture].role;
            plane != first && self.graph.size(plane) == size && !matches!(role, Role::Previous(_))
        });
        let others: Vec<_> = others.collect();
        match self.graph.passes.last() {
            // Draw into the same again.
            Some(Pass::Draw { targets, .. }) if targets[0].plane == first => {
                planes = targets.iter().map(|target| target.plane).collect();
            }
            _ if !others.is_empty() && self.random.below(3) == 0 => planes.push(self.random.pick(&others)),
            _ => {}
        }
        let whole = self.graph.whole(first);
        let tile = (self.random.below(2) == 0).then(|| self.rect(whole));
        let declared = tile.unwrap_or(whole);
        let area = if self.random.below(3) == 0 { self.rect(declared) } else { declared };
        let mut targets = Vec::new();
        for (index, &plane) in planes.iter().enumerate() {
            // Next to a tile of one attachment, another may be declared as a whole.
            let rect = tile.filter(|_| index == 0 || self.random.below(2) == 0);
            let own = rect.unwrap_or(whole);
            targets.push(Target { plane, contents: self.contents(plane, own, own == area), rect });
        }
        let words = (planes.len() == 1 && self.random.below(5) == 0).then(|| self.extra_words(whole, area));
        let words = words.flatten();
        let inputs = self.inputs(&planes, words.map(|(span, _)| span.buffer));
        Some(Pass::Draw { inputs, targets, area, words, keep: self.random.below(12) == 0 })
    }

    /// Words for all texels of an attachment.
    fn extra_words(&mut self, whole: Rect, area: Rect) -> Option<(Span, bool)> {
        let count = whole.width * whole.height;
        let large = |index: &usize| self.graph.buffers[*index].words >= count;
        let buffers: Vec<_> = (0..self.graph.buffers.len()).filter(large).collect();
        if buffers.is_empty() {
            return None;
        }
        let buffer = self.random.pick(&buffers);
        let start = 64 * self.random.below((self.graph.buffers[buffer].words - count) / 64 + 1);
        let span = Span { buffer, start, end: start + count };
        let known = self.state.words(span).iter().all(|word| word.is_known());
        match known {
            true => Some((span, true)),
            false => (area == whole).then_some((span, false)),
        }
    }

    pub(super) fn cover(mut self, plane: Plane) -> Pass {
        let area = self.graph.whole(plane);
        let inputs = self.inputs(&[plane], None);
        let targets = vec![Target { plane, contents: Contents::Overwrite, rect: None }];
        Pass::Draw { inputs, targets, area, words: None, keep: false }
    }

    /// A range of multiples of 256 bytes.
    fn span(&mut self) -> Span {
        let all: Vec<_> = (0..self.graph.buffers.len()).collect();
        let untouched = |buffer: &&usize| self.state.buffer(**buffer).contains(&Word::Undefined);
        let new: Vec<_> = all.iter().filter(untouched).copied().collect();
        let buffer = self.random.pick_either(&new, &all).unwrap_or_default();
        let blocks = self.graph.buffers[buffer].words / 64;
        let count = if self.random.below(2) == 0 { blocks } else { 1 + self.random.below(blocks) };
        let start = self.random.below(blocks - count + 1);
        Span { buffer, start: start * 64, end: (start + count) * 64 }
    }

    fn words(&mut self) -> Option<Pass> {
        let span = self.span();
        let known = self.state.words(span).iter().all(|word| word.is_known());
        let preserve = known && self.random.below(2) == 0;
        Some(Pass::Words { inputs: self.inputs(&[], Some(span.buffer)), span, preserve })
    }

    fn texels(&mut self) -> Option<Pass> {
        let plane = self.written()?;
        let rect = (self.random.below(2) == 0).then(|| self.rect(self.graph.whole(plane)));
        let known = self.known_in(plane, rect.unwrap_or(self.graph.whole(plane)));
        let preserve = known && self.random.below(2) == 0;
        Some(Pass::Texels { inputs: self.inputs(&[plane], None), plane, rect, preserve })
    }

    fn copy_texture(&mut self) -> Option<Pass> {
        let to = self.written()?;
        let all: Vec<_> = self.graph.all_planes().filter(|&plane| plane != to).collect();
        if all.is_empty() {
            return None;
        }
        let from = self.random.pick(&all);
        let (a, b) = (self.graph.size(from), self.graph.size(to));
        let common = Rect::new(0, 0, a.0.min(b.0), a.1.min(b.1));
        let rect = self.rect(common);
        let moved = |random: &mut Random, (width, height): (u32, u32)| Rect {
            x: random.below(width - rect.width + 1),
            y: random.below(height - rect.height + 1),
            ..rect
        };
        let (from_rect, to_rect) = (moved(self.random, a), moved(self.random, b));
        self.known_in(from, from_rect).then_some(Pass::CopyTexture { from, from_rect, to, to_rect })
    }

    fn copy_buffer(&mut self) -> Option<Pass> {
        let (from, to) = (self.span(), self.span());
        let count = 1 + self.random.below((from.end - from.start).min(to.end - to.start));
        let from = Span { end: from.start + count, ..from };
        let to = Span { end: to.start + count, ..to };
        let known = self.state.words(from).iter().all(|word| word.is_known());
        let raw = self.random.below(3) == 0;
        (from.buffer != to.buffer && known).then_some(Pass::CopyBuffer { from, to, raw })
    }

    fn rows(&mut self) -> Option<Pass> {
        let planes: Vec<_> = self.graph.all_planes().filter(|plane| plane.mip == 0).collect();
        let planes: Vec<_> =
            planes.into_iter().filter(|plane| self.graph.textures[plane.texture].layers == 1).collect();
        let large = |&(_, buffer): &(usize, &Buffer)| buffer.words >= 512;
        let buffers: Vec<_> = self.graph.buffers.iter().enumerate().filter(large).map(|(at, _)| at).collect();
        if planes.is_empty() || buffers.is_empty() {
            return None;
        }
        let (from, to) = (self.random.pick(&planes), self.random.pick(&buffers));
        let fits = self.graph.size(from).1 * 64 <= self.graph.buffers[to].words;
        (fits && self.known_in(from, self.graph.whole(from))).then_some(Pass::Rows { from, to })
    }
}
