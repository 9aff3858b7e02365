//! Random graphs.

use super::graph::{Buffer, Graph, Pass, Role, Texture};
use super::interpret::{State, Word};
use super::maker::Maker;
use super::random::Random;

impl Graph {
    /// Creates the graph of a seed. It reads only contents that the interpreter knows as defined.
    pub(super) fn random(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut graph = Self { seed, textures: Vec::new(), buffers: Vec::new(), passes: Vec::new() };
        graph.declare(&mut random);
        let mut state = State::new(&graph);
        state.begin(&graph);
        graph.upload(&mut random, &mut state);
        let passes = 6 + random.below(18);
        for _ in 0..passes {
            let made =
                (0..10).find_map(|_| Maker { graph: &graph, state: &state, random: &mut random }.pass());
            if let Some(pass) = made {
                graph.add(pass, &mut state);
            }
        }
        graph.fill_histories(&mut random, &mut state);
        graph.export(&mut random, &state);
        graph
    }

    fn add(&mut self, pass: Pass, state: &mut State) {
        state.run(self, &pass, 0);
        self.passes.push(pass);
    }

    fn declare(&mut self, random: &mut Random) {
        let sizes = [(8, 8), (8, 8), (16, 16), (16, 8)];
        // Most have the same shape, so that they can share a slot.
        let common = random.pick(&sizes);
        for _ in 0..4 + random.below(6) {
            let role = random.pick(&[Role::Imported(true), Role::Imported(false)]);
            let role = if random.below(5) == 0 { role } else { Role::Transient };
            let (mips, layers) = random.pick(&[(1, 1), (1, 1), (2, 1), (1, 3), (2, 3)]);
            let any = Texture { role, size: random.pick(&sizes), mips, layers, exported: false };
            let same = Texture { size: common, mips: 1, layers: 1, ..any.clone() };
            self.textures.push(if random.below(4) == 0 { any } else { same });
        }
        for history in 0..random.pick(&[0, 0, 0, 1, 1, 2]) {
            let (size, mips) = (random.pick(&sizes), 1 + random.below(2));
            for role in [Role::Previous(history), Role::Current(history)] {
                self.textures.push(Texture { role, size, mips, layers: 1, exported: false });
            }
        }
        for _ in 0..2 + random.below(4) {
            let role = random.pick(&[Role::Imported(true), Role::Imported(false), Role::Uploaded]);
            let role = if random.below(3) == 0 { role } else { Role::Transient };
            let words = random.pick(&[64, 128, 192, 256, 256, 256, 1024]);
            self.buffers.push(Buffer { role, words, exported: false });
        }
    }

    fn upload(&mut self, random: &mut Random, state: &mut State) {
        for buffer in 0..self.buffers.len() {
            if self.buffers[buffer].role == Role::Uploaded {
                let words = (0..self.buffers[buffer].words).map(|_| random.word()).collect();
                self.add(Pass::Upload { buffer, words }, state);
            }
        }
    }

    /// Writes the histories, which must be written in each frame.
    fn fill_histories(&mut self, random: &mut Random, state: &mut State) {
        for plane in self.all_planes().collect::<Vec<_>>() {
            let current = matches!(self.textures[plane.texture].role, Role::Current(_));
            if current && !state.plane(plane).iter().all(|word| word.is_known()) {
                let maker = Maker { graph: self, state, random };
                let pass = maker.cover(plane);
                self.add(pass, state);
            }
        }
    }

    /// Exports the results of the last passes and little else, so that lifetimes end before the frame does.
    fn export(&mut self, random: &mut Random, state: &State) {
        let last = &self.passes[self.passes.len().saturating_sub(2)..];
        let planes: Vec<_> = last.iter().flat_map(Pass::planes).map(|plane| plane.texture).collect();
        let buffers: Vec<_> = last.iter().filter_map(Pass::buffer).collect();
        for (index, texture) in self.textures.iter_mut().enumerate() {
            let whole = state.texture(index).iter().flatten().all(|word| *word != Word::Undefined);
            texture.exported = whole && (planes.contains(&index) || random.below(5) == 0);
        }
        for (index, buffer) in self.buffers.iter_mut().enumerate() {
            let whole = state.buffer(index).iter().all(|word| *word != Word::Undefined);
            buffer.exported = whole && (buffers.contains(&index) || random.below(5) == 0);
        }
    }
}
