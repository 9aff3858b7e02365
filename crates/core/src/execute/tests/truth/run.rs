//! Runs graphs on a device in many ways and compares them with the interpreter.

use super::copies::{Copies, Held, copied_bytes};
use super::declare::{Exports, declare};
use super::gpu::{Gpu, Imports};
use super::graph::Graph;
use super::interpret::State;
use crate::test_device::block_on;
use crate::{Executed, Options, OrderPolicy, Plan, ResourceDesc, WatchedTexture};

/// One way to run a graph.
struct Variation {
    name: &'static str,
    options: Options,
    mode: RecordMode,
    poison: bool,
    /// Number of consecutive frames of the same graph.
    frames: u32,
    submission: Submission,
}

/// Options for recording a frame.
#[derive(Clone, Copy)]
enum RecordMode {
    OneEncoder,
    Threads(usize),
    /// The frame is captured.
    Capture,
    /// A version of a texture is watched, another one in each frame.
    Watch,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Submission {
    /// The frames share an encoder.
    OneEncoder,
    /// All frames are recorded, then submitted together.
    Together,
    /// Each frame completes before the next is recorded.
    OneByOne,
}

fn variations() -> [Variation; 9] {
    let plain = || Variation {
        name: "plain",
        options: Options::default(),
        mode: RecordMode::OneEncoder,
        poison: false,
        frames: 2,
        submission: Submission::Together,
    };
    let ordered = |order| Options { order, ..Options::default() };
    let apart = Options { merge: false, transient_attachments: false, ..Options::default() };
    [
        Variation { frames: 3, ..plain() },
        Variation { name: "in one encoder", submission: Submission::OneEncoder, ..plain() },
        Variation { name: "one by one", submission: Submission::OneByOne, ..plain() },
        Variation { name: "declared order", options: ordered(OrderPolicy::Declared), frames: 1, ..plain() },
        Variation {
            name: "least memory, poisoned",
            options: ordered(OrderPolicy::Memory),
            poison: true,
            ..plain()
        },
        Variation { name: "nothing merged", options: apart, ..plain() },
        Variation { name: "two threads", mode: RecordMode::Threads(2), ..plain() },
        Variation { name: "captured", mode: RecordMode::Capture, ..plain() },
        Variation { name: "watched", mode: RecordMode::Watch, frames: 4, ..plain() },
    ]
}

/// A render graph for each variation, whose pool is dirty from everything it ran before.
pub(super) struct Runner<'g> {
    gpu: &'g Gpu,
    graphs: Vec<(Variation, crate::Graph)>,
    /// The plan of each graph's first plain frame.
    pub(super) plans: Vec<Plan>,
}

/// Reasons why graphs failed.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) kind: Kind,
    pub(super) text: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The compiler or the executor returned an error.
    Validation,
    /// wgpu reported a validation error.
    Invalid,
    /// A number differs from the interpreter's.
    Wrong,
}

impl<'g> Runner<'g> {
    pub(super) fn new(gpu: &'g Gpu) -> Self {
        let graph = |variation: Variation| {
            let mut graph = crate::Graph::new();
            graph.set_poison(variation.poison);
            (variation, graph)
        };
        Self { gpu, graphs: variations().into_iter().map(graph).collect(), plans: Vec::new() }
    }

    /// Runs every graph in every variation, compares all results, and returns the number of compared words.
    pub(super) fn run(&mut self, graphs: &[Graph], compare: bool) -> Result<usize, Failure> {
        let scope = self.gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let frames: u64 = self.graphs.iter().map(|(variation, _)| u64::from(variation.frames)).sum();
        let mut copies = Copies::new(self.gpu, graphs.iter().map(copied_bytes).sum::<u64>() * frames);
        let mut commands = Vec::new();
        let mut outcome = Ok(());
        for (index, graph) in graphs.iter().enumerate() {
            for (variation, pool) in &mut self.graphs {
                let mut run = Run { gpu: self.gpu, variation, pool, graph, index, copies: &mut copies };
                match run.frames(&mut commands) {
                    Ok(plan) if variation.name == "plain" => self.plans.push(plan),
                    Ok(_) => {}
                    Err(text) => {
                        let text = format!("seed {}, {}: {text}", graph.seed, variation.name);
                        outcome = Err(Failure { kind: Kind::Validation, text });
                    }
                }
            }
        }
        self.gpu.queue.submit(commands);
        let mut objections = std::mem::take(&mut *self.gpu.objections.lock().unwrap());
        objections.extend(block_on(scope.pop()).map(|error| error.to_string()));
        if !objections.is_empty() {
            return Err(Failure { kind: Kind::Invalid, text: objections.join("\n") });
        }
        outcome?;
        if compare { copies.compare(graphs) } else { Ok(0) }
    }
}

/// One graph in one variation.
struct Run<'r, 'g> {
    gpu: &'g Gpu,
    variation: &'r Variation,
    pool: &'r mut crate::Graph,
    graph: &'r Graph,
    index: usize,
    copies: &'r mut Copies<'g>,
}

impl Run<'_, '_> {
    /// Records the frames, and returns the plan of the first.
    fn frames(&mut self, commands: &mut Vec<wgpu::CommandBuffer>) -> Result<Plan, String> {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let imports = self.gpu.imports(self.graph);
        let mut state = State::new(self.graph);
        let mut plan = None;
        let mut shared = None;
        for number in 0..self.variation.frames {
            let salt = number * 0x0101_0101;
            state.begin(self.graph);
            for pass in &self.graph.passes {
                state.run(self.graph, pass, salt);
            }
            let mut encoder =
                shared.take().unwrap_or_else(|| device.create_command_encoder(&Default::default()));
            let (executed, exports) = self.frame(&mut encoder, &imports, salt, commands)?;
            let place = (self.index, format!("{}, frame {number}", self.variation.name));
            let held = Held { executed: &executed, exports: &exports, imports: &imports };
            self.copies.copy(&mut encoder, self.graph, &held, &state, place);
            plan.get_or_insert_with(|| executed.plan().clone());
            match self.variation.submission {
                Submission::OneEncoder => shared = Some(encoder),
                Submission::Together => commands.push(encoder.finish()),
                Submission::OneByOne => {
                    queue.submit(std::mem::take(commands).into_iter().chain([encoder.finish()]));
                    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
                }
            }
        }
        commands.extend(shared.map(wgpu::CommandEncoder::finish));
        plan.ok_or_else(|| "no frame".into())
    }

    fn frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        imports: &Imports,
        salt: u32,
        commands: &mut Vec<wgpu::CommandBuffer>,
    ) -> Result<(Executed, Exports), String> {
        let mut frame = self.pool.frame();
        frame.set_options(self.variation.options);
        let exports = declare(&mut frame, self.graph, self.gpu, imports, salt);
        let compiled = self.pool.compile(frame).map_err(|error| error.to_string())?;
        let plan = compiled.shared_plan();
        let executed = match self.variation.mode {
            RecordMode::OneEncoder => compiled.execute(self.pool, &self.gpu.device, encoder),
            RecordMode::Watch => {
                self.pool.watch(watch(&plan, salt));
                compiled.execute(self.pool, &self.gpu.device, encoder)
            }
            RecordMode::Capture => compiled
                .execute_captured(self.pool, &self.gpu.device, encoder)
                .map(|(executed, _capture)| executed),
            RecordMode::Threads(threads) => {
                let recorded = compiled.execute_on_threads(self.pool, &self.gpu.device, threads);
                recorded.map(|(executed, own)| {
                    commands.extend(own);
                    executed
                })
            }
        };
        let executed = executed.map_err(|error| error.to_string())?;
        assert_eq!(executed.plan(), &*plan, "the plan is the frame's, however it is recorded");
        Ok((executed, exports))
    }
}

/// Chooses a version of a texture that the frame writes.
fn watch(plan: &Plan, salt: u32) -> Option<WatchedTexture> {
    let written: Vec<_> = plan
        .order()
        .iter()
        .flat_map(|&pass| plan.accesses(pass))
        .filter(|access| {
            access.contents.is_some()
                && matches!(plan.resource(access.resource).desc, ResourceDesc::Texture(_))
        })
        .map(|access| (access.resource, access.version + 1))
        .collect();
    let &(resource, version) = written.get(salt as usize % written.len().max(1))?;
    let texture = plan.resource_path(resource);
    Some(WatchedTexture { texture, version: Some(version), mip: 0, layer: 0 })
}
