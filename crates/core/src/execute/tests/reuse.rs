//! Tests that objects are kept from frame to frame, or dropped.

use super::gpu::{Gpu, NUMBERS, square};
use crate::{Bind, Contents, Frame, Graph, PoolLimits, TextureExport};

/// A chain of textures, the first cleared to a value, each other drawn from the previous one, the last of them exported.
fn chain<'f>(
    graph: &Graph,
    draw: &'f super::Draw,
    first: u32,
    side: u32,
    length: u32,
) -> (Frame<'f>, TextureExport) {
    let mut frame = graph.frame();
    let mut last = frame.create_texture("first", square(side));
    frame.render_pass("first").color(&mut last, Contents::clear_color([first.into(), 0.0, 0.0, 0.0]));
    for _ in 1..length {
        let mut next = frame.create_texture("next", square(side));
        let mut pass = frame.render_pass("next");
        let token = pass.sample(&last);
        pass.color(&mut next, Contents::Overwrite);
        pass.body(move |ctx| draw.record(ctx, &[Bind::Texture(token)]));
        last = next;
    }
    let export = frame.export_texture(&last);
    (frame, export)
}

fn groups(graph: &Graph) -> usize {
    graph.device.caches().bind_groups.len()
}

struct Chains<'g> {
    gpu: &'g Gpu,
    draw: super::Draw,
    graph: Graph,
}

impl<'g> Chains<'g> {
    fn new(gpu: &'g Gpu) -> Self {
        Self { gpu, draw: gpu.draw("loaded", NUMBERS), graph: Graph::new() }
    }

    /// Runs a frame, checks its numbers, and returns its export.
    fn run(&mut self, side: u32, length: u32) -> wgpu::Texture {
        self.run_cleared(1, side, length)
    }

    /// Does the same with another value of the first texture.
    fn run_cleared(&mut self, first: u32, side: u32, length: u32) -> wgpu::Texture {
        let (frame, export) = chain(&self.graph, &self.draw, first, side, length);
        let executed = self.gpu.run(&mut self.graph, frame);
        let texture = executed.texture(export).unwrap().clone();
        self.gpu.assert_filled(&texture, first + length - 1);
        texture
    }
}

const fn bytes(side: u32) -> u64 {
    side as u64 * side as u64 * 4
}

#[test]
fn equal_frames_get_the_same_textures_and_bind_groups() {
    for gpu in Gpu::all() {
        let mut chains = Chains::new(&gpu);
        let first = chains.run(16, 6);
        assert_eq!((chains.graph.bytes(), groups(&chains.graph)), (2 * bytes(16), 2));
        for _ in 0..20 {
            assert_eq!(chains.run(16, 6), first);
        }
        assert_eq!((chains.graph.bytes(), groups(&chains.graph)), (2 * bytes(16), 2));
        assert_eq!(chains.graph.plan_counts().reused, 20);
    }
}

#[test]
fn frames_with_other_clear_values_share_objects_and_are_cleared_to_them() {
    for gpu in Gpu::all() {
        let mut chains = Chains::new(&gpu);
        let first = chains.run_cleared(1, 16, 6);
        for value in [2, 3, 1, 2, 7, 7, 1] {
            assert_eq!(chains.run_cleared(value, 16, 6), first);
        }
        assert_eq!(groups(&chains.graph), 2);
        let counts = chains.graph.plan_counts();
        assert_eq!((counts.compiled, counts.cleared, counts.reused), (1, 3, 4));
    }
}

#[test]
fn one_plan_whose_body_binds_another_texture_each_time_gets_the_right_group() {
    const TEXTURES: u32 = 7;
    for gpu in Gpu::all() {
        let (draw, mut graph) = (gpu.draw("loaded", NUMBERS), Graph::new());
        let draw = &draw;
        for number in (0..4 * TEXTURES).map(|round| round * 3 % TEXTURES) {
            let mut frame = graph.frame();
            let sources = [(); TEXTURES as usize].map(|()| frame.create_texture("source", square(8)));
            let sources = std::array::from_fn::<_, { TEXTURES as usize }, _>(|value| {
                let mut source = sources[value].clone();
                let clear = Contents::clear_color([value as f64, 0.0, 0.0, 0.0]);
                frame.render_pass("fill").color(&mut source, clear);
                source
            });
            let mut target = frame.create_texture("target", square(8));
            let mut pass = frame.render_pass("add one");
            let tokens = sources.each_ref().map(|source| pass.sample(source));
            pass.color(&mut target, Contents::Overwrite);
            pass.body(move |ctx| draw.record(ctx, &[Bind::Texture(tokens[number as usize])]));
            let export = frame.export_texture(&target);
            let executed = gpu.run(&mut graph, frame);
            gpu.assert_filled(executed.texture(export).unwrap(), number + 1);
        }
        assert_eq!(graph.plan_counts().compiled, 1);
        assert_eq!(groups(&graph), TEXTURES as usize, "one group for each texture");
    }
}

#[test]
fn plans_that_alternate_keep_their_textures() {
    for gpu in Gpu::all() {
        let mut chains = Chains::new(&gpu);
        let kinds = [(16, 5), (16, 4), (8, 3), (12, 7)];
        let first = kinds.map(|(side, length)| chains.run(side, length));
        let held = (chains.graph.bytes(), groups(&chains.graph));
        for round in 0..20 {
            // In another order each time.
            for index in (0..4).map(|index| (index * 3 + round) % 4) {
                let (side, length) = kinds[index];
                assert_eq!(chains.run(side, length), first[index]);
            }
        }
        assert_eq!((chains.graph.bytes(), groups(&chains.graph)), held);
    }
}

#[test]
fn plans_beyond_the_kept_ones_find_their_textures_again() {
    let gpu = Gpu::noop();
    let mut chains = Chains::new(&gpu);
    let mut round = || [2, 3, 4, 5, 6, 7].map(|length| chains.run(16, length));
    let first = round();
    assert_eq!([round(), round()], [first.clone(), first]);
    assert_eq!(chains.graph.bytes(), 3 * bytes(16), "one of them for what the first frame used it for only");
}

#[test]
fn objects_that_are_idle_longer_than_the_limit_are_dropped() {
    for gpu in Gpu::all() {
        for idle_frames in [0, 1, 8, 20] {
            let mut chains = Chains::new(&gpu);
            chains.graph.set_limits(PoolLimits { idle_frames, ..Default::default() });
            chains.run(64, 3);
            for frame in 1..=idle_frames {
                chains.run(8, 2);
                assert_eq!(chains.graph.bytes(), 2 * (bytes(64) + bytes(8)), "idle for {frame}");
            }
            chains.run(8, 2);
            assert_eq!(chains.graph.bytes(), 2 * bytes(8), "of {idle_frames}");
            chains.run(8, 2);
            assert_eq!(groups(&chains.graph), 1);
        }
    }
}

#[test]
fn above_the_budget_the_longest_idle_is_dropped_first_and_used_ones_are_kept() {
    for gpu in Gpu::all() {
        let mut chains = Chains::new(&gpu);
        let budget_bytes = Some(2 * (bytes(32) + bytes(16)));
        chains.graph.set_limits(PoolLimits { idle_frames: 100, budget_bytes });
        chains.run(32, 2);
        let kept = chains.run(16, 2);
        assert_eq!(chains.graph.bytes(), 2 * (bytes(32) + bytes(16)), "within the budget nothing is dropped");
        chains.run(8, 2);
        assert_eq!(chains.graph.bytes(), bytes(32) + 2 * (bytes(16) + bytes(8)), "one of the oldest");
        assert_eq!(chains.run(16, 2), kept);
        chains.run(64, 3);
        assert_eq!(chains.graph.bytes(), 2 * bytes(64), "more than the budget, but needed");
        assert_ne!(chains.run(16, 2), kept);
        assert_eq!(chains.graph.bytes(), 2 * bytes(16));
    }
}

#[test]
fn a_frame_that_only_changed_in_size_and_back_is_right() {
    for gpu in Gpu::all() {
        let mut chains = Chains::new(&gpu);
        for side in [16, 8, 16, 24, 8] {
            chains.run(side, 5);
        }
        assert!(chains.graph.plan_counts().resized > 0);
    }
}

#[test]
fn two_frames_in_flight_share_textures_without_interference() {
    for gpu in Gpu::all() {
        let mut chains = Chains::new(&gpu);
        let mut commands = Vec::new();
        let mut backs = Vec::new();
        for length in [3, 5, 3, 5] {
            let (frame, export) = chain(&chains.graph, &chains.draw, 1, 16, length);
            let compiled = chains.graph.compile(frame).unwrap();
            let mut encoder = gpu.encoder();
            let executed = compiled.execute(&mut chains.graph, &gpu.device, &mut encoder).unwrap();
            let texture = executed.texture(export).unwrap();
            backs.push((gpu.read_texels(&mut encoder, texture, (0, 0)), length));
            commands.push(encoder.finish());
        }
        crate::test_device::valid(&gpu.device, || gpu.queue.submit(commands));
        for (back, length) in backs {
            let bytes = back.wait(&gpu.device).unwrap();
            assert!(!gpu.draws || bytes.chunks(4).all(|texel| texel == length.to_le_bytes()));
        }
        assert_eq!(chains.graph.bytes(), 2 * bytes(16));
    }
}
