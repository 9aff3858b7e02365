//! A program of many passes whose textures are watched: how many arrive, and what its frames take.

use super::watch;
use crate::browser::Page;
use serde_json::json;
use shadowgraph::core::{Contents, Format, FullscreenShader, Graph, TextureDesc};
use shadowgraph::inspect::{FrameReport, Server};
use shadowgraph::options::AdapterChoice;
use shadowgraph::{Gpu, wgpu};
use shadowgraph_tests::skip;
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tungstenite::Message;

const PASSES: u32 = 65;
/// The least time of a frame: 60 a second.
const FRAME: Duration = Duration::from_micros(16_667);
/// How long each state is measured.
const MEASURED: Duration = Duration::from_secs(2);

const SHADER: &str = "
@group(0) @binding(0) var before: texture_2d<f32>;
@group(0) @binding(1) var<uniform> moved: vec4u;
@fragment fn soften(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = textureDimensions(before);
    let at = vec2u(position.xy);
    let start = vec4f(vec2f((at + moved.xy) % size) / vec2f(size), 0.0, 1.0);
    let near = textureLoad(before, at, 0) + textureLoad(before, (at + vec2u(1, 0)) % size, 0);
    return select(0.5 * near, start, moved.w == 1u);
}";

/// A connection that watches a texture and draws nothing.
struct Client {
    received: Arc<AtomicU32>,
    ends: Arc<AtomicBool>,
    reading: Option<JoinHandle<()>>,
}

impl Client {
    fn watch(url: &str, texture: &str) -> Self {
        let address = url.trim_start_matches("http://").split('/').next().unwrap();
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let socket = url.replace("http://", "ws://") + "socket";
        let (mut socket, _) = tungstenite::client(socket, stream).unwrap();
        let watch = json!({ "watch": { "texture": texture, "version": null, "mip": 0, "layer": 0 } });
        socket.send(Message::text(watch.to_string())).unwrap();
        let (received, ends) = (Arc::new(AtomicU32::new(0)), Arc::new(AtomicBool::new(false)));
        let (counted, stopped) = (received.clone(), ends.clone());
        let read = move || {
            while !stopped.load(Ordering::Relaxed) {
                let message = socket.read().unwrap();
                let is_texture = message.to_text().is_ok_and(|text| text.starts_with("{\"texture\""));
                counted.fetch_add(u32::from(is_texture), Ordering::Relaxed);
            }
        };
        Self { received, ends, reading: Some(std::thread::spawn(read)) }
    }

    fn count(&self) -> u32 {
        self.received.load(Ordering::Relaxed)
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        self.reading.take().unwrap().join().unwrap();
    }
}

/// Returns the median of the times of frames.
fn median(frames: &mut [f64]) -> f64 {
    frames.sort_by(f64::total_cmp);
    frames[frames.len() / 2]
}

/// Draws frames of a chain of passes until `ends`, and sends the time of each.
fn draw(gpu: &Gpu, mut server: Server, ends: &AtomicBool, times: &mpsc::Sender<f64>) {
    let shader = FullscreenShader::wgsl("soften", SHADER);
    let mut graph = Graph::new();
    let size = TextureDesc::d2(320, 180, Format::Rgba16Float);
    for number in 0u32.. {
        if ends.load(Ordering::Relaxed) {
            return;
        }
        let begun = Instant::now();
        server.begin_frame(&mut graph);
        let mut frame = graph.frame();
        let mut before = frame.create_texture("start", size);
        frame.render_pass("clear").color(&mut before, Contents::clear_color([0.0; 4]));
        for pass in 1..PASSES {
            let mut made = frame.create_texture(format_args!("softened {pass}"), size);
            let moved = [number % 320, 0, 0, u32::from(pass == 1)];
            let bytes: Vec<u8> = moved.iter().flat_map(|word| word.to_le_bytes()).collect();
            frame
                .fullscreen(format_args!("soften {pass}"), &shader)
                .sample(&before)
                .uniform(&bytes)
                .draw(&mut made);
            before = made;
        }
        frame.export_texture(&before);
        let compiled = graph.compile(frame).unwrap();
        assert_eq!(compiled.plan().order().len(), PASSES as usize);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut executed = compiled.execute(&mut graph, &gpu.device, &mut encoder).unwrap();
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        server.end_frame(&gpu.device, &mut executed, &FrameReport { times: &[], bytes: graph.bytes() });
        let _sent = times.send(begun.elapsed().as_secs_f64() * 1e3);
        std::thread::sleep(FRAME.saturating_sub(begun.elapsed()));
    }
}

#[test]
fn ten_textures_a_second_arrive_from_a_program_of_65_passes() {
    let gpu = match Gpu::open(&AdapterChoice::Cpu) {
        Ok(gpu) => gpu,
        Err(reason) => return skip("many_passes", &reason.to_string()),
    };
    let server = Server::start(0, "many passes").unwrap();
    let url = server.url();
    let (sender, times) = mpsc::channel();
    let ends = Arc::new(AtomicBool::new(false));
    let stopped = ends.clone();
    let program = std::thread::spawn(move || draw(&gpu, server, &stopped, &sender));
    let measured = || {
        times.try_iter().for_each(drop);
        std::thread::sleep(MEASURED);
        let mut frames: Vec<f64> = times.try_iter().collect();
        median(&mut frames)
    };
    measured();
    let alone = measured();
    let client = Client::watch(&url, "softened 64");
    let (before, begun) = (client.count(), Instant::now());
    let received = measured();
    let per_second = (client.count() - before) as f64 / begun.elapsed().as_secs_f64();
    drop(client);
    let between = measured();
    println!(
        "{per_second:.1} textures a second received; ms a frame: {alone:.2} alone, {received:.2} received, {between:.2} alone"
    );
    let Some(mut page) = Page::open(&url) else { return ends.store(true, Ordering::Relaxed) };
    page.until("liveView.frames.length > 10");
    let opened = measured();
    watch(&mut page, "softened 64");
    let count = |page: &mut Page| page.value("liveView.textures").as_f64().unwrap();
    let (before, begun) = (count(&mut page), Instant::now());
    let watched = measured();
    let per_second = (count(&mut page) - before) / begun.elapsed().as_secs_f64();
    page.close();
    let closed = measured();
    println!(
        "{per_second:.1} textures a second; ms a frame: {alone:.2} without a page, {opened:.2} with one, {watched:.2} \
         watched, {closed:.2} without"
    );
    ends.store(true, Ordering::Relaxed);
    program.join().unwrap();
    // 10 on an idle machine.
    assert!(per_second > 1.0, "{per_second}");
}
