//! Connections: the page, and the sockets of open pages.

use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use tungstenite::handshake::machine::TryParse;
use tungstenite::handshake::server::{Request, create_response, write_response};

use super::shared::Shared;
use super::viewer;

/// Connections at the same time; others are closed at once.
const CONNECTIONS: usize = 32;
/// The longest head of a request, bytes.
const HEAD_BYTES: usize = 8192;
/// A head must arrive within this time, and a page must be read within it.
const TIMEOUT: Duration = Duration::from_secs(3);
/// How often the listener looks for connections.
const ACCEPT_EVERY: Duration = Duration::from_millis(10);

/// Serves connections until the server stops. Each runs on a separate thread.
pub(super) fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    let open = Arc::new(AtomicUsize::new(0));
    while !shared.is_stopped() {
        let Ok((stream, _)) = listener.accept() else {
            std::thread::sleep(ACCEPT_EVERY);
            continue;
        };
        if open.load(Ordering::Relaxed) >= CONNECTIONS {
            continue;
        }
        open.fetch_add(1, Ordering::Relaxed);
        let (shared, counted) = (shared.clone(), open.clone());
        let spawned = std::thread::Builder::new().name("frame page viewer".into()).spawn(move || {
            // A connection that fails is gone.
            let _gone = answer(stream, &shared);
            counted.fetch_sub(1, Ordering::Relaxed);
        });
        if spawned.is_err() {
            open.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

/// Serves one request.
fn answer(mut stream: TcpStream, shared: &Shared) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let (request, rest) = match read_head(&mut stream)? {
        Ok(read) => read,
        Err(Refusal(status, reason)) => return refuse(&mut stream, status, reason),
    };
    let path = request.uri().path();
    let Some(file) = path.strip_prefix('/').and_then(|path| path.strip_prefix(shared.token())) else {
        return refuse(&mut stream, "404 Not Found", "the address lacks the token that the program prints");
    };
    match file {
        "" => redirect(&mut stream, shared.token()),
        "/" => match page(&request, shared) {
            Some(page) => respond(&mut stream, "200 OK", "text/html; charset=utf-8", &page),
            None => refuse(&mut stream, "404 Not Found", "there is no frame of that plan"),
        },
        "/socket" if is_foreign(&request) => refuse(&mut stream, "403 Forbidden", "another page's request"),
        "/socket" => match create_response(&request) {
            Ok(response) => {
                let mut bytes = Vec::new();
                write_response(&mut bytes, &response).map_err(std::io::Error::other)?;
                stream.write_all(&bytes)?;
                viewer::show(stream, rest, shared)
            }
            Err(_) => refuse(&mut stream, "400 Bad Request", "expected a web socket"),
        },
        _ => refuse(&mut stream, "404 Not Found", "unknown address"),
    }
}

/// The status of a request that is refused, and why.
struct Refusal(&'static str, &'static str);

/// Reads the head of a request; returns it with the bytes that follow.
fn read_head(stream: &mut TcpStream) -> std::io::Result<Result<(Request, Vec<u8>), Refusal>> {
    let begun = Instant::now();
    let mut bytes = Vec::new();
    loop {
        let left = TIMEOUT.saturating_sub(begun.elapsed());
        if left.is_zero() {
            return Ok(Err(Refusal("408 Request Timeout", "the request takes too long")));
        }
        stream.set_read_timeout(Some(left))?;
        let mut part = [0; 1024];
        match stream.read(&mut part) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => bytes.extend_from_slice(&part[..count]),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => continue,
            Err(error) => return Err(error),
        }
        match Request::try_parse(&bytes) {
            Ok(Some((head, request))) => return Ok(Ok((request, bytes.split_off(head)))),
            Ok(None) if bytes.len() < HEAD_BYTES => {}
            Ok(None) => {
                return Ok(Err(Refusal("431 Request Header Fields Too Large", "the request is too long")));
            }
            Err(_) => return Ok(Err(Refusal("400 Bad Request", "expected GET and HTTP/1.1"))),
        }
    }
}

/// Returns the page of the plan that the address asks for.
fn page(request: &Request, shared: &Shared) -> Option<String> {
    let plan = request.uri().query().and_then(|query| query.strip_prefix("plan="));
    match plan {
        None => Some(shared.page(None).unwrap_or_else(|| WAITING.into())),
        Some(number) => shared.page(Some(number.parse().ok()?)),
    }
}

/// Shown until there is a frame.
const WAITING: &str =
    "<!doctype html><meta http-equiv=refresh content=1><title>Frame</title><p>Waiting for the first frame.";

/// Returns whether a page of another origin asks.
fn is_foreign(request: &Request) -> bool {
    let header = |name| request.headers().get(name).and_then(|value| value.to_str().ok());
    let Some(origin) = header("origin") else { return false };
    header("host").is_none_or(|host| origin.strip_prefix("http://") != Some(host))
}

fn redirect(stream: &mut TcpStream, token: &str) -> std::io::Result<()> {
    let head = format!(
        "HTTP/1.1 308 Permanent Redirect\r\nlocation: /{token}/\r\ncontent-length: 0\r\nconnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())
}

fn refuse(stream: &mut TcpStream, status: &str, reason: &str) -> std::io::Result<()> {
    respond(stream, status, "text/plain; charset=utf-8", &format!("{reason}\n"))
}

fn respond(stream: &mut TcpStream, status: &str, kind: &str, body: &str) -> std::io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status}\r\ncontent-type: {kind}\r\ncontent-length: {}\r\ncache-control: no-store\r\n\
         referrer-policy: no-referrer\r\nx-content-type-options: nosniff\r\nx-frame-options: DENY\r\nconnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())
}
