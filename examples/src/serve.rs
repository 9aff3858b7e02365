//! Frames on a page in a browser, without a window.

use super::{Arguments, Canvas, Example, Failure, target};
use shadowgraph::inspect::{Controls, PageRequest, Server};
use shadowgraph::{Gpu, wgpu};
use std::time::{Duration, Instant};

/// The least time of a frame: 60 a second.
const FRAME: Duration = Duration::from_micros(16_667);

/// Draws frames until the program is ended, or some.
pub(super) fn run<E: Example>(gpu: &Gpu, port: u16, arguments: &Arguments) -> Result<(), Failure> {
    let mut example = E::new(gpu, arguments.argument.as_deref())?;
    let target = target(&gpu.device, arguments.size_px);
    let mut server = Server::start(port, E::NAME)?;
    println!("{}", server.url());
    let (mut is_frozen, mut number) = (false, 0);
    for _ in 0..arguments.frames.unwrap_or(u32::MAX) {
        let begun = Instant::now();
        let mut moves = !is_frozen;
        for request in server.take_requests() {
            match request {
                PageRequest::Freeze(freeze) => is_frozen = freeze,
                PageRequest::Step => moves = true,
                _ => {}
            }
        }
        server.offer(Controls { freeze: Some(is_frozen), ..Controls::default() });
        number += u32::from(moves);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let server = Some(&mut server);
        example.draw(Canvas { gpu, encoder: &mut encoder, target: &target, number, server })?;
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        std::thread::sleep(FRAME.saturating_sub(begun.elapsed()));
    }
    Ok(())
}
