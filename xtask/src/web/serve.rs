//! Serves a directory on this machine.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::thread;
use std::time::Duration;

/// The port, and those that are tried after it.
const PORTS: std::ops::Range<u16> = 8080..8100;
/// How long a browser may take for a request.
const TIMEOUT: Duration = Duration::from_secs(10);
/// The longest request that is read, bytes.
const MAX_REQUEST: u64 = 8192;

/// Serves a directory until the program is ended, and prints its address.
///
/// # Errors
/// When no port is free.
pub(super) fn run(directory: &Path) -> Result<(), String> {
    let listen = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port)).ok();
    let listener = PORTS.into_iter().find_map(listen).ok_or("no port from 8080 to 8099 is free")?;
    let address = listener.local_addr().map_err(|error| format!("cannot listen: {error}"))?;
    println!("Open http://{address}/ in a browser with WebGPU; Ctrl+C ends.");
    for stream in listener.incoming().flatten() {
        let directory = directory.to_owned();
        // A browser that goes away in the middle of an answer has its reasons.
        thread::spawn(move || drop(answer(stream, &directory)));
    }
    Ok(())
}

fn answer(mut stream: TcpStream, directory: &Path) -> std::io::Result<()> {
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let mut lines = BufReader::new(std::io::Read::take(&stream, MAX_REQUEST)).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    // The headers do not matter here, but an unread request resets the connection.
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let Some(path) = path(&request) else {
        return stream
            .write_all(b"HTTP/1.1 400 Bad Request\r\ncontent-length: 0\r\nconnection: close\r\n\r\n");
    };
    let Ok(mut file) = File::open(directory.join(&path)) else {
        return stream.write_all(b"HTTP/1.1 404 Not Found\r\ncontent-length: 0\r\nconnection: close\r\n\r\n");
    };
    let (length, kind) = (file.metadata()?.len(), media_type(&path));
    write!(
        stream,
        "HTTP/1.1 200 OK\r\ncontent-type: {kind}\r\ncontent-length: {length}\r\ncache-control: no-cache\r\nconnection: close\r\n\r\n"
    )?;
    if !request.starts_with("HEAD ") {
        std::io::copy(&mut file, &mut stream)?;
    }
    Ok(())
}

/// Returns the path of a request below the directory; `None` for one that is malformed or leads out of it.
fn path(request: &str) -> Option<PathBuf> {
    let target = request.strip_prefix("GET /").or_else(|| request.strip_prefix("HEAD /"))?;
    let target = target.split([' ', '?']).next()?;
    let target = decoded(if target.is_empty() { "index.html" } else { target })?;
    let path = Path::new(&target);
    path.components().all(|part| matches!(part, Component::Normal(_))).then(|| path.to_owned())
}

/// Decodes the `%20` of a path; `None` if it is not UTF-8 then.
fn decoded(text: &str) -> Option<String> {
    let mut parts = text.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        bytes.push(u8::from_str_radix(part.get(..2)?, 16).ok()?);
        bytes.extend_from_slice(&part.as_bytes()[2..]);
    }
    String::from_utf8(bytes).ok()
}

fn media_type(path: &Path) -> &'static str {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_stay_within_the_directory() {
        assert_eq!(path("GET / HTTP/1.1"), Some("index.html".into()));
        assert_eq!(path("HEAD /page.js?x=1 HTTP/1.1"), Some("page.js".into()));
        assert_eq!(path("GET /my%20hall.glb HTTP/1.1"), Some("my hall.glb".into()));
        let refused =
            ["GET /../secret HTTP/1.1", "GET /%2e%2e/secret HTTP/1.1", "GET /%2Fetc/passwd HTTP/1.1"];
        for request in
            refused.into_iter().chain(["GET //etc/passwd HTTP/1.1", "GET /a/../../b", "POST / HTTP/1.1", ""])
        {
            assert_eq!(path(request), None, "{request}");
        }
    }
}
