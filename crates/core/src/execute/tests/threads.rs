//! Recording on several threads, and submitting step by step.

use super::gpu::{Gpu, NUMBERS, number, square};
use crate::test_device::valid;
use crate::{Bind, BufferExport, Contents, Error, Executed, Frame, Graph, Rect, Subresource, TextureExport};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::ThreadId;

/// Declares sixteen tiles, each drawn several times, separately and merged, with uploads and compute passes between.
fn frame<'f>(
    graph: &Graph,
    (draw, add): (&'f super::Draw, &'f super::Compute),
    threads: &'f Mutex<Vec<ThreadId>>,
) -> (Frame<'f>, Exports) {
    let mut frame = graph.frame();
    // Otherwise all tiles would become one render pass, which one thread would draw.
    frame.fix_order();
    let mut atlas = frame.create_texture("atlas", square(64));
    frame.render_pass("clear").color(&mut atlas, Contents::clear_color([1.0, 0.0, 0.0, 0.0]));
    let mut sums = frame.upload_buffer("sums", vec![0u8; 256]);
    for tile in 0..16 {
        let rect = Rect::new(tile % 4 * 16, tile / 4 * 16, 16, 12 - tile % 3);
        for round in 0..3 {
            let block = frame.uniform(&number(100 * tile + round));
            let mut pass = frame.render_pass("tile");
            let contents =
                if round == 0 { Contents::clear_color([2.0, 0.0, 0.0, 0.0]) } else { Contents::Preserve };
            pass.subresource(Subresource::FULL.rect(rect)).color(&mut atlas, contents);
            pass.body(move |ctx| {
                threads.lock().unwrap().push(std::thread::current().id());
                ctx.pass.set_scissor_rect(rect.x + round, rect.y + 2 * round, 3, 2);
                draw.record(ctx, &[Bind::Uniform(block)])
            });
        }
        let block = frame.uniform(&number(tile + 1));
        let mut pass = frame.compute_pass("add");
        let token = pass.storage_buffer_mut(&mut sums, Contents::Preserve);
        pass.body(move |ctx| add.record(ctx, &[Bind::Uniform(block), Bind::Buffer(token)], 1));
    }
    let (atlas, sums) = (frame.export_texture(&atlas), frame.export_buffer(&sums));
    // Copied by the thread that records the last passes.
    let late = frame.upload_buffer("late", vec![9u8; 256]);
    let late = frame.export_buffer(&late);
    (frame, Exports { atlas, sums, late })
}

struct Exports {
    atlas: TextureExport,
    sums: BufferExport,
    late: BufferExport,
}

impl Exports {
    fn words(&self, gpu: &Gpu, executed: &Executed) -> [Vec<u32>; 3] {
        let words = |export| gpu.words(executed.buffer(export).unwrap());
        [gpu.texels(executed.texture(self.atlas).unwrap(), 0, 0), words(self.sums), words(self.late)]
    }
}

#[test]
fn several_threads_record_the_same_pixels_as_one() {
    for gpu in Gpu::all() {
        let (draw, add) = (gpu.draw("number", NUMBERS), gpu.compute("add_number"));
        let seen = Mutex::new(Vec::new());
        let mut graph = Graph::new();
        let (one, exports) = frame(&graph, (&draw, &add), &seen);
        let executed = gpu.run(&mut graph, one);
        let words = exports.words(&gpu, &executed);
        if gpu.draws {
            assert!([1, 2, 1502].iter().all(|texel| words[0].contains(texel)));
            assert_eq!(words[1..], [[136; 64], [0x0909_0909; 64]]);
        }
        for threads in [0, 1, 2, 3, 7, 1000] {
            seen.lock().unwrap().clear();
            let (several, exports) = frame(&graph, (&draw, &add), &seen);
            let executed = valid(&gpu.device, || {
                let compiled = graph.compile(several).unwrap();
                let (executed, commands) =
                    compiled.execute_on_threads(&mut graph, &gpu.device, threads).unwrap();
                assert!(commands.len() <= threads.max(1), "{} of {threads}", commands.len());
                gpu.queue.submit(commands);
                executed
            });
            assert_eq!(exports.words(&gpu, &executed), words);
            let mut ids = seen.lock().unwrap().clone();
            ids.sort_by_key(|id| format!("{id:?}"));
            ids.dedup();
            assert_eq!(ids.len() > 1, threads > 1);
        }
    }
}

#[test]
fn command_buffers_of_one_frame_may_be_submitted_one_by_one() {
    for gpu in Gpu::all() {
        let (draw, add) = (gpu.draw("number", NUMBERS), gpu.compute("add_number"));
        let seen = Mutex::new(Vec::new());
        let mut graph = Graph::new();
        for _ in 0..3 {
            let (several, exports) = frame(&graph, (&draw, &add), &seen);
            let compiled = graph.compile(several).unwrap();
            let (executed, commands) = compiled.execute_on_threads(&mut graph, &gpu.device, 4).unwrap();
            assert!(commands.len() > 1);
            valid(&gpu.device, || {
                for commands in commands {
                    gpu.queue.submit([commands]);
                    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
                }
            });
            if gpu.draws {
                assert_eq!(exports.words(&gpu, &executed)[1..], [[136; 64], [0x0909_0909; 64]]);
            }
        }
    }
}

#[test]
fn steps_that_are_submitted_one_by_one_give_the_same_pixels() {
    for gpu in Gpu::all() {
        let (draw, add) = (gpu.draw("number", NUMBERS), gpu.compute("add_number"));
        let seen = Mutex::new(Vec::new());
        let mut graph = Graph::new();
        let (whole, exports) = frame(&graph, (&draw, &add), &seen);
        let executed = gpu.run(&mut graph, whole);
        let words = exports.words(&gpu, &executed);
        for _ in 0..2 {
            let (stepwise, exports) = frame(&graph, (&draw, &add), &seen);
            let executed = valid(&gpu.device, || {
                let compiled = graph.compile(stepwise).unwrap();
                compiled.execute_submitted(&mut graph, &gpu.device, &gpu.queue).unwrap()
            });
            assert_eq!(exports.words(&gpu, &executed), words);
        }
    }
}

#[test]
fn each_step_is_submitted_before_the_next_is_recorded() {
    let gpu = Gpu::noop();
    let submitted = Arc::new(AtomicU32::new(0));
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    for number in 0..3 {
        let (device, submitted) = (&gpu.device, submitted.clone());
        let mut pass = frame.encoder_pass("step");
        pass.keep();
        pass.body(move |ctx| {
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
            assert_eq!(submitted.load(Ordering::Relaxed), number);
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 4,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            // wgpu calls back after the submission.
            ctx.encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |_| {
                submitted.fetch_add(1, Ordering::Relaxed);
            });
            Ok(())
        });
    }
    let compiled = graph.compile(frame).unwrap();
    compiled.execute_submitted(&mut graph, &gpu.device, &gpu.queue).unwrap();
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    assert_eq!(submitted.load(Ordering::Relaxed), 3);
}

#[test]
fn of_several_bodies_that_fail_the_first_in_order_is_reported() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    for name in ["a", "b", "c", "d"] {
        let mut pass = frame.encoder_pass(name);
        pass.keep();
        pass.body(move |_| if name == "a" { Ok(()) } else { Err(Error::body("spilt")) });
    }
    let compiled = graph.compile(frame).unwrap();
    let error = compiled.execute_on_threads(&mut graph, &gpu.device, 4).err().unwrap();
    assert_eq!(crate::test_text::without_places(&error), "SG0602: pass `b`: spilt");
}
