//! A server of files in memory and in a directory, for pages of tests.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;

/// The files of a server.
pub(super) struct Files {
    /// A directory, for paths without a file in memory.
    pub(super) directory: PathBuf,
    /// Contents by path.
    pub(super) memory: HashMap<String, Vec<u8>>,
}

/// Serves files until the test ends, and returns the address.
pub(super) fn serve(files: Files) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let files = Arc::new(files);
    std::thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            let files = files.clone();
            // Browsers open connections that they do not use.
            std::thread::spawn(move || drop(answer(stream, &files)));
        }
    });
    format!("http://{address}")
}

fn answer(mut stream: TcpStream, files: &Files) -> std::io::Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let path = request.split(' ').nth(1).unwrap_or("/").split('?').next().unwrap_or("/");
    let path = path.trim_start_matches('/');
    // Browsers ask for it on their own.
    let icon = (path == "favicon.ico").then(Vec::new);
    let found =
        files.memory.get(path).cloned().or(icon).or_else(|| std::fs::read(files.directory.join(path)).ok());
    let kind = match path.rsplit('.').next() {
        Some("html") => "text/html",
        Some("css") => "text/css",
        Some("js") => "text/javascript",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    };
    let (status, body) = found.map_or(("404 Not Found", Vec::new()), |body| ("200 OK", body));
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\ncontent-type: {kind}\r\ncontent-length: {length}\r\nconnection: close\r\n\r\n"
    )?;
    stream.write_all(&body)
}
