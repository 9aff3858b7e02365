//! Computes the results of a graph: pass by pass in order of declaration, on plain arrays.

use super::graph::{Contents, Graph, Inputs, Pass, Plane, Role, Span, Target, texels_in};
use super::random::Random;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Word {
    /// Nothing has been written.
    Undefined,
    /// Written according to the graph, but with any value, such as the padding of rows.
    Unknown,
    Is(u32),
}

impl Word {
    pub(super) fn is_known(self) -> bool {
        matches!(self, Self::Is(_))
    }

    fn get(self) -> Option<u32> {
        match self {
            Self::Is(value) => Some(value),
            Self::Undefined | Self::Unknown => None,
        }
    }
}

impl From<Option<u32>> for Word {
    fn from(value: Option<u32>) -> Self {
        value.map_or(Self::Unknown, Self::Is)
    }
}

/// The contents of all textures and buffers.
#[derive(Clone)]
pub(super) struct State {
    /// Contents by texture, then by layer and mip.
    textures: Vec<Vec<Vec<Word>>>,
    mips: Vec<u32>,
    buffers: Vec<Vec<Word>>,
}

impl State {
    /// Returns the contents before the first frame: the caller's numbers, and zeros in histories.
    pub(super) fn new(graph: &Graph) -> Self {
        let mut random = Random::new(!graph.seed);
        let mut filled = |role: Role, count: u32| -> Vec<Word> {
            let word = |_| match role {
                Role::Imported(_) => Word::Is(random.word()),
                Role::Previous(_) | Role::Current(_) => Word::Is(0),
                Role::Transient | Role::Uploaded => Word::Undefined,
            };
            (0..count).map(word).collect()
        };
        let textures = (0..graph.textures.len()).map(|texture| {
            let role = graph.textures[texture].role;
            let area = |plane| graph.size(plane).0 * graph.size(plane).1;
            graph.planes(texture).map(|plane| filled(role, area(plane))).collect()
        });
        let textures = textures.collect();
        let mips = graph.textures.iter().map(|texture| texture.mips).collect();
        let buffers = graph.buffers.iter().map(|buffer| filled(buffer.role, buffer.words)).collect();
        Self { textures, mips, buffers }
    }

    /// Starts a frame: histories are swapped, and contents of transient resources are undefined.
    pub(super) fn begin(&mut self, graph: &Graph) {
        for (index, texture) in graph.textures.iter().enumerate() {
            if let Role::Previous(history) = texture.role {
                let current =
                    graph.textures.iter().position(|own| own.role == Role::Current(history)).unwrap();
                self.textures[index] = self.textures[current].clone();
            }
        }
        let lost = |role| {
            matches!(role, Role::Transient | Role::Imported(false) | Role::Current(_) | Role::Uploaded)
        };
        for (texture, planes) in graph.textures.iter().zip(&mut self.textures) {
            if lost(texture.role) {
                planes.iter_mut().flatten().for_each(|word| *word = Word::Undefined);
            }
        }
        for (buffer, words) in graph.buffers.iter().zip(&mut self.buffers) {
            if lost(buffer.role) {
                words.fill(Word::Undefined);
            }
        }
    }

    pub(super) fn texture(&self, texture: usize) -> &[Vec<Word>] {
        &self.textures[texture]
    }

    pub(super) fn plane(&self, plane: Plane) -> &[Word] {
        &self.textures[plane.texture][self.index(plane)]
    }

    fn plane_mut(&mut self, plane: Plane) -> &mut [Word] {
        let index = self.index(plane);
        &mut self.textures[plane.texture][index]
    }

    fn index(&self, plane: Plane) -> usize {
        (plane.layer * self.mips[plane.texture] + plane.mip) as usize
    }

    pub(super) fn buffer(&self, buffer: usize) -> &[Word] {
        &self.buffers[buffer]
    }

    pub(super) fn words(&self, span: Span) -> &[Word] {
        &self.buffers[span.buffer][span.words()]
    }

    fn words_mut(&mut self, span: Span) -> &mut [Word] {
        &mut self.buffers[span.buffer][span.words()]
    }

    /// Runs a pass. `salt` differs between frames of the same graph.
    pub(super) fn run(&mut self, graph: &Graph, pass: &Pass, salt: u32) {
        match pass {
            Pass::Draw { inputs, targets, area, words, keep: _ } => {
                let before = self.clone();
                self.clear(graph, targets);
                for place in texels_in(*area) {
                    let value = before.value(graph, inputs, place, salt);
                    self.draw(graph, targets, *words, place, value);
                }
            }
            Pass::Words { inputs, span, preserve } => {
                let before = self.clone();
                for (index, word) in (0..).zip(self.words_mut(*span)) {
                    write(word, before.value(graph, inputs, (index, 0), salt), *preserve);
                }
            }
            Pass::Texels { inputs, plane, rect, preserve } => {
                let before = self.clone();
                let (width, _) = graph.size(*plane);
                for (x, y) in texels_in(rect.unwrap_or(graph.whole(*plane))) {
                    let value = before.value(graph, inputs, (x, y), salt);
                    write(&mut self.plane_mut(*plane)[(x + y * width) as usize], value, *preserve);
                }
            }
            Pass::CopyTexture { .. } | Pass::CopyBuffer { .. } | Pass::Rows { .. } => self.copy(graph, pass),
            Pass::Upload { buffer, words } => {
                self.buffers[*buffer] = words.iter().map(|word| Word::Is(word ^ salt)).collect();
            }
        }
    }

    fn clear(&mut self, graph: &Graph, targets: &[Target]) {
        for Target { plane, contents, rect } in targets {
            let (width, _) = graph.size(*plane);
            let Contents::Clear(value) = contents else { continue };
            for (x, y) in texels_in(rect.unwrap_or(graph.whole(*plane))) {
                self.plane_mut(*plane)[(x + y * width) as usize] = Word::Is(*value);
            }
        }
    }

    fn draw(
        &mut self,
        graph: &Graph,
        targets: &[Target],
        words: Option<(Span, bool)>,
        (x, y): (u32, u32),
        value: Option<u32>,
    ) {
        let extra = value.map(|value| mixed(value, 1));
        let (width, _) = graph.size(targets[0].plane);
        let place = (x + y * width) as usize;
        for (target, value) in targets.iter().zip([value, extra]) {
            self.plane_mut(target.plane)[place] = value.into();
        }
        if let Some((span, preserve)) = words {
            write(&mut self.words_mut(span)[place], extra, preserve);
        }
    }

    fn copy(&mut self, graph: &Graph, pass: &Pass) {
        match *pass {
            Pass::CopyTexture { from, from_rect, to, to_rect } => {
                let (source, (from_width, _)) = (self.plane(from).to_vec(), graph.size(from));
                let (width, _) = graph.size(to);
                for (place, (x, y)) in texels_in(from_rect).zip(texels_in(to_rect)) {
                    let word = source[(place.0 + place.1 * from_width) as usize];
                    self.plane_mut(to)[(x + y * width) as usize] = word;
                }
            }
            Pass::CopyBuffer { from, to, raw: _ } => {
                let source = self.words(from).to_vec();
                self.words_mut(to).copy_from_slice(&source);
            }
            Pass::Rows { from, to } => {
                let (width, _) = graph.size(from);
                let source = self.plane(from).to_vec();
                self.buffers[to].fill(Word::Unknown);
                for (row, words) in source.chunks(width as usize).enumerate() {
                    self.buffers[to][row * 64..][..words.len()].copy_from_slice(words);
                }
            }
            _ => {}
        }
    }

    /// Returns the value that a pass computes at a position; `None` if it depends on unknown contents.
    fn value(&self, graph: &Graph, inputs: &Inputs, (x, y): (u32, u32), salt: u32) -> Option<u32> {
        let mut state = mixed(inputs.constant ^ salt, x + 4099 * y);
        for &(plane, shift) in &inputs.planes {
            let (width, height) = graph.size(plane);
            let (x, y) = ((x + shift) % width, (y + shift) % height);
            state = mixed(state, self.plane(plane)[(x + y * width) as usize].get()?);
        }
        for &(span, shift) in &inputs.spans {
            let words = self.words(span);
            state = mixed(state, words[(x + 16 * y + shift) as usize % words.len()].get()?);
        }
        Some(state)
    }
}

fn write(word: &mut Word, value: Option<u32>, preserve: bool) {
    let value = if preserve { word.get().zip(value).map(|(old, new)| mixed(old, new)) } else { value };
    *word = value.into();
}

fn mixed(state: u32, value: u32) -> u32 {
    (state ^ value).wrapping_mul(2_654_435_761).rotate_left(13)
}
