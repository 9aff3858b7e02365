//! Pages, and requests that are none, against a program that draws on a device that draws nothing.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use super::*;
use serde_json::{Value, json};
use shadowgraph_core::{Contents, Format, TextureDesc};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

/// A program that draws frames on a separate thread until it is dropped.
struct Program {
    url: String,
    address: SocketAddr,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Drawn>>,
}

/// What a program has done.
struct Drawn {
    requests: Vec<PageRequest>,
    /// The longest time that the server took of a frame.
    longest: Duration,
    viewers: usize,
}

/// Draws two passes, and every other frame a third.
fn draw(graph: &mut Graph, (device, queue): &(wgpu::Device, wgpu::Queue), number: u64) -> Executed {
    let mut frame = graph.frame();
    let mut color = frame.create_texture("color", TextureDesc::d2(256, 128, Format::Rgba16Float));
    frame.render_pass("sky").color(&mut color, Contents::clear_color([number as f64, 0.5, 0.5, 1.0]));
    frame.render_pass("ground").color(&mut color, Contents::Preserve);
    if number.is_multiple_of(2) {
        frame.render_pass("sun").color(&mut color, Contents::Preserve);
    }
    frame.export_texture(&color);
    let mut encoder = device.create_command_encoder(&Default::default());
    let executed = graph.compile(frame).unwrap().execute(graph, device, &mut encoder).unwrap();
    queue.submit([encoder.finish()]);
    executed
}

impl Program {
    fn start(controls: Controls) -> Self {
        let mut server = Server::start(0, "A <test>").unwrap();
        let (url, address) = (server.url(), server.address);
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = stop.clone();
        let thread = std::thread::spawn(move || {
            let gpu = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
            let mut graph = Graph::new();
            server.offer(controls);
            let (mut requests, mut longest) = (Vec::new(), Duration::ZERO);
            let mut number = 0;
            while !stopped.load(Ordering::Relaxed) {
                let begun = Instant::now();
                requests.extend(server.take_requests());
                server.begin_frame(&mut graph);
                let own = begun.elapsed();
                let mut executed = draw(&mut graph, &gpu, number);
                let begun = Instant::now();
                let report = FrameReport { times: &[], bytes: graph.bytes() };
                server.end_frame(&gpu.0, &mut executed, &report);
                longest = longest.max(own + begun.elapsed());
                number += 1;
                std::thread::sleep(Duration::from_millis(5));
            }
            requests.extend(server.take_requests());
            Drawn { requests, longest, viewers: server.viewers() }
        });
        Self { url, address, stop, thread: Some(thread) }
    }

    fn end(mut self) -> Drawn {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap()
    }

    /// Sends bytes and returns the answer.
    fn answer(&self, bytes: &[u8]) -> String {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        // The server may have answered before all is sent.
        let _sent = stream.write_all(bytes);
        let mut answer = Vec::new();
        let _read = stream.read_to_end(&mut answer);
        String::from_utf8(answer).unwrap()
    }

    fn get(&self, path: &str) -> String {
        self.answer(format!("GET {path} HTTP/1.1\r\nhost: {}\r\n\r\n", self.address).as_bytes())
    }

    fn path(&self) -> &str {
        self.url.split_once(&self.address.to_string()).unwrap().1
    }

    fn open(&self) -> WebSocket<TcpStream> {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let address = format!("ws://{}{}socket", self.address, self.path());
        client(address, stream).unwrap().0
    }
}

/// Waits for a message with a member.
fn wait_for(socket: &mut WebSocket<TcpStream>, name: &str) -> Value {
    for _ in 0..1000 {
        let message: Value = match socket.read().unwrap() {
            Message::Text(text) => serde_json::from_str(&text).unwrap(),
            _ => continue,
        };
        if let Some(found) = message.get(name) {
            return found.clone();
        }
    }
    panic!("no message with `{name}`");
}

fn send(socket: &mut WebSocket<TcpStream>, message: &Value) {
    socket.send(Message::text(message.to_string())).unwrap();
}

#[test]
fn the_page_is_served_to_those_who_know_its_address() {
    let program = Program::start(Controls::default());
    std::thread::sleep(Duration::from_millis(200));
    let page = program.get(program.path());
    assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.contains("A &lt;test&gt;"), "{}", &page[..400]);
    assert!(page.contains(r#""live":{"plan":"#), "the page knows its plan");
    assert!(program.get(&format!("{}?plan=1", program.path())).starts_with("HTTP/1.1 200 OK"));
    assert!(program.get(program.path().trim_end_matches('/')).starts_with("HTTP/1.1 308"));
    let status = |answer: &str| answer.split(' ').nth(1).unwrap_or("none").to_owned();
    for path in ["/", "/0/", "/favicon.ico", "/../etc/passwd", "//", "/%2e%2e/"] {
        assert_eq!(status(&program.get(path)), "404", "{path}");
    }
    let unknown = [
        format!("{}other", program.path()),
        format!("{}?plan=9", program.path()),
        format!("{}?plan=x", program.path()),
    ];
    assert!(unknown.iter().all(|path| status(&program.get(path)) == "404"));
    assert_eq!(status(&program.get(&format!("{}socket", program.path()))), "400");
    program.end();
}

#[test]
fn hostile_requests_get_one_line_or_nothing() {
    let program = Program::start(Controls::default());
    let status = |answer: &str| answer.split(' ').nth(1).unwrap_or("none").to_owned();
    let refused = [
        (b"POST / HTTP/1.1\r\n\r\n".to_vec(), "400"),
        (b"GET / HTTP/9.9\r\n\r\n".to_vec(), "400"),
        (vec![0; 200], "400"),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01".to_vec(), "400"),
        ([b"GET /".to_vec(), vec![b'a'; 20_000]].concat(), "431"),
        ([b"GET / HTTP/1.1\r\n".to_vec(), b"a: b\r\n".repeat(2_000)].concat(), "400"),
    ];
    for (bytes, expected) in refused {
        let answer = program.answer(&bytes);
        // A connection may be reset before the answer is read.
        assert!(status(&answer) == expected || answer.is_empty(), "{answer}");
    }
    let path = format!("{}socket", program.path());
    let mut request = format!("ws://{}{path}", program.address).into_client_request().unwrap();
    request.headers_mut().insert("origin", "http://example.com".parse().unwrap());
    let refused = client(request, TcpStream::connect(program.address).unwrap()).unwrap_err();
    assert!(refused.to_string().contains("403"), "{refused}");
    // Connections that send nothing are closed, and take no place of others meanwhile.
    let mut silent: Vec<_> = (0..8).map(|_| TcpStream::connect(program.address).unwrap()).collect();
    assert_eq!(status(&program.get(program.path())), "200");
    let begun = Instant::now();
    for stream in &mut silent {
        let mut answer = String::new();
        let _read = stream.read_to_string(&mut answer);
        assert!(answer.is_empty() || status(&answer) == "408", "{answer}");
    }
    assert!(begun.elapsed() < Duration::from_secs(6));
    // Too many are closed at once.
    let many: Vec<_> = (0..64).map(|_| TcpStream::connect(program.address).unwrap()).collect();
    drop(many);
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(status(&program.get(program.path())), "200");
    assert!(program.end().longest < Duration::from_millis(100));
}

#[test]
fn an_open_page_gets_frames_and_the_texture_that_it_watches() {
    let program = Program::start(Controls::default());
    let mut socket = program.open();
    assert_eq!(wait_for(&mut socket, "controls")["freeze"], Value::Null);
    let frames = wait_for(&mut socket, "frames");
    let last = frames.as_array().unwrap().last().unwrap();
    assert!(last["number"].as_u64() > Some(0) && last["bytes"] == 256 * 128 * 8, "{last}");
    let plans = |frames: &Value| -> Vec<u64> {
        frames.as_array().unwrap().iter().filter_map(|frame| frame["plan"].as_u64()).collect()
    };
    let seen = [plans(&wait_for(&mut socket, "frames")), plans(&wait_for(&mut socket, "frames"))].concat();
    assert!(
        seen.contains(&1) && seen.contains(&2) && seen.iter().max() == Some(&2),
        "clear values: {seen:?}"
    );
    let watch = json!({ "watch": { "texture": "color", "version": 1, "mip": 0, "layer": 0 } });
    send(&mut socket, &watch);
    for _ in 0..3 {
        let texture = wait_for(&mut socket, "texture");
        assert_eq!((&texture["version"], &texture["full"]), (&json!(1), &json!([256, 128])));
        assert!(texture["data"].as_str().is_some_and(|data| data.len() > 20), "{texture}");
    }
    for [mip, layer] in [[9, 0], [u32::MAX, 0], [0, 9], [0, u32::MAX]] {
        let beyond = json!({ "texture": "color", "version": 1, "mip": mip, "layer": layer });
        send(&mut socket, &json!({ "watch": beyond }));
        wait_for(&mut socket, "frames");
        wait_for(&mut socket, "frames");
    }
    send(&mut socket, &watch);
    wait_for(&mut socket, "texture");
    send(&mut socket, &json!({ "watch": null }));
    socket.close(None).unwrap();
    while socket.read().is_ok() {}
    std::thread::sleep(Duration::from_millis(100));
    assert_eq!(program.end().viewers, 0);
}

#[test]
fn a_page_can_ask_for_what_is_offered_and_for_nothing_else() {
    let number = OfferedValue::Number { value: 2.0, min: 1.0, max: 4.0 };
    let choice = OfferedValue::Choice { chosen: "pcf".into(), all: vec!["pcf".into(), "none".into()] };
    let controls = Controls {
        freeze: Some(false),
        save_recording: true,
        pixel: true,
        settings: vec![
            Offered { name: "scale".into(), value: number },
            Offered { name: "technique".into(), value: choice },
        ],
    };
    let program = Program::start(controls);
    let mut socket = program.open();
    let offered = wait_for(&mut socket, "controls");
    assert_eq!(offered["settings"][0]["value"]["number"]["max"], 4.0);
    let allowed = [
        json!({ "freeze": true }),
        json!("step"),
        json!("save_recording"),
        json!({ "pixel": [3, 4] }),
        json!({ "set": { "name": "scale", "value": 4.0 } }),
        json!({ "choose": { "name": "technique", "value": "none" } }),
    ];
    allowed.iter().for_each(|request| send(&mut socket, &json!({ "request": request })));
    let refused = [
        json!({ "request": { "quit": true } }),
        json!({ "request": { "set": { "name": "scale", "value": 4.5 } } }),
        json!({ "request": { "set": { "name": "scale", "value": null } } }),
        json!({ "request": { "set": { "name": "technique", "value": 1.0 } } }),
        json!({ "request": { "choose": { "name": "technique", "value": "rm -rf" } } }),
        json!({ "request": { "choose": { "name": "path", "value": "none" } } }),
        json!({ "request": "quit" }),
        json!({ "watch": { "texture": "color", "version": -1, "mip": 0, "layer": 0 } }),
        json!({ "quit": true }),
        json!([[[[]]]]),
    ];
    for message in refused {
        send(&mut socket, &message);
        let reason = wait_for(&mut socket, "refused");
        assert!(reason.as_str().is_some_and(|reason| !reason.is_empty()), "{message}");
    }
    // A message that is too long ends the connection.
    let _sent = socket.send(Message::text("x".repeat(100_000)));
    while socket.read().is_ok() {}
    let requests = program.end().requests;
    let expected = [
        PageRequest::Freeze(true),
        PageRequest::Step,
        PageRequest::SaveRecording,
        PageRequest::Pixel([3, 4]),
        PageRequest::Set { name: "scale".into(), value: 4.0 },
        PageRequest::Choose { name: "technique".into(), value: "none".into() },
    ];
    assert_eq!(requests, expected);
}

#[test]
fn a_page_that_reads_nothing_stalls_no_frame_and_is_dropped() {
    let program = Program::start(Controls::default());
    let mut socket = program.open();
    send(&mut socket, &json!({ "watch": { "texture": "color", "version": null, "mip": 0, "layer": 0 } }));
    std::thread::sleep(Duration::from_secs(2));
    let begun = Instant::now();
    let drawn = program.end();
    assert!(drawn.longest < Duration::from_millis(100), "{:?}", drawn.longest);
    assert!(begun.elapsed() < Duration::from_secs(5), "the server ends");
}

#[test]
fn a_port_that_is_taken_is_an_error_and_a_server_that_is_dropped_frees_it() {
    let first = Server::start(0, "first").unwrap();
    let port = first.address.port();
    let error = Server::start(port, "second").map(|_| ()).unwrap_err();
    assert!(error.code() == "SG0703" && error.to_string().contains(&format!("127.0.0.1:{port}")), "{error}");
    drop(first);
    assert!(Server::start(port, "second").is_ok());
}
