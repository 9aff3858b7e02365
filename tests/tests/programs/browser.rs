//! A page in headless Chromium, driven through its debugging protocol.

use serde_json::{Value, json};
use shadowgraph_tests::{images, on_path, skip};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket, client};

const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// How long a page may take for anything.
const TIMEOUT: Duration = Duration::from_secs(60);
/// The same with WebGPU: software drivers compile shaders for seconds, and other tests run at the same time.
const WEBGPU_TIMEOUT: Duration = Duration::from_secs(240);

/// Options of a browser without WebGPU.
const PLAIN: [&str; 1] = ["--disable-gpu"];
/// Options of a browser with WebGPU on the software driver that it brings along.
const WEBGPU: [&str; 6] = [
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-angle=swiftshader",
    "--use-vulkan=swiftshader",
    "--enable-features=Vulkan",
    "--disable-vulkan-surface",
];

/// Returns the name of a browser; `None` without one.
pub(crate) fn installed() -> Option<&'static str> {
    let found = BROWSERS.into_iter().find(|name| on_path(name));
    if found.is_none() {
        skip("pages", "no Chromium is installed");
    }
    found
}

pub(crate) struct Page {
    browser: Child,
    socket: WebSocket<TcpStream>,
    /// How long the page may take for anything.
    timeout: Duration,
    sent: u64,
    /// What the page complained about.
    faults: Vec<String>,
    _data: TempDir,
}

impl Page {
    /// Opens an address; `None` without a browser.
    pub(crate) fn open(url: &str) -> Option<Self> {
        Self::open_with(url, &PLAIN, TIMEOUT)
    }

    /// Opens an address in a browser with WebGPU; `None` without a browser.
    pub(crate) fn open_with_webgpu(url: &str) -> Option<Self> {
        Self::open_with(url, &WEBGPU, WEBGPU_TIMEOUT)
    }

    fn open_with(url: &str, options: &[&str], timeout: Duration) -> Option<Self> {
        let data = tempfile::tempdir().unwrap();
        let mut browser = Command::new(installed()?)
            .args(options)
            .args(["--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .args(["--disable-extensions", "--remote-debugging-port=0", "--window-size=1400,900"])
            .arg(format!("--user-data-dir={}", data.path().display()))
            .arg(url)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(browser.stderr.take().unwrap()).lines();
        let mut lines = lines.map_while(Result::ok);
        let line = lines.find(|line| line.contains("DevTools listening on ")).expect("a debugging port");
        // Nobody may wait for a full pipe.
        std::thread::spawn(move || lines.for_each(drop));
        let address = line.split("ws://").nth(1).and_then(|rest| rest.split('/').next()).unwrap();
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(timeout)).unwrap();
        let (socket, _) = client(target(address), stream).unwrap();
        let mut page = Self { browser, socket, timeout, sent: 0, faults: Vec::new(), _data: data };
        for method in ["Runtime.enable", "Log.enable"] {
            page.call(method, &json!({}));
        }
        Some(page)
    }

    /// Calls a method of the protocol.
    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.sent += 1;
        let message = json!({ "id": self.sent, "method": method, "params": parameters });
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else { continue };
            let answer: Value = serde_json::from_str(&text).unwrap();
            match answer["method"].as_str() {
                Some("Runtime.exceptionThrown" | "Log.entryAdded") => self.faults.push(text.to_string()),
                Some("Runtime.consoleAPICalled") if answer["params"]["type"] == "error" => {
                    self.faults.push(text.to_string());
                }
                Some(_) => {}
                None if answer["id"] == self.sent => return answer["result"].clone(),
                None => {}
            }
        }
    }

    /// Returns the value of an expression on the page.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let result = self.call("Runtime.evaluate", &parameters);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    /// Ends the process that draws for all pages of the browser, as a crash of the driver does.
    pub(crate) fn crash_gpu(&mut self) {
        self.call("Browser.crashGpuProcess", &json!({}));
    }

    /// Waits until an expression is true.
    pub(crate) fn until(&mut self, expression: &str) {
        let begun = Instant::now();
        // The page may be one that waits for the first frame, or be left for another.
        let holds =
            format!("(() => {{ try {{ return Boolean({expression}); }} catch {{ return false; }} }})()");
        while self.value(&holds) != true {
            assert!(begun.elapsed() < self.timeout, "waited too long for {expression}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Writes what the page looks like to a file for the documents, or below the output directory of tests.
    pub(crate) fn keep(&mut self, name: &str) {
        use base64::Engine as _;
        let data = self.call("Page.captureScreenshot", &json!({}))["data"].clone();
        let image = base64::prelude::BASE64_STANDARD.decode(data.as_str().unwrap()).unwrap();
        let folder = images().unwrap_or_else(|| Path::new(env!("CARGO_TARGET_TMPDIR")).join("live_page"));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(name), image).unwrap();
    }

    /// Closes the page, which must have complained about nothing.
    pub(crate) fn close(self) {
        assert!(self.faults.is_empty(), "{:#?}", self.faults);
    }

    /// Closes the page, which may have complained about a file that is not there.
    pub(crate) fn close_after(mut self, missing: &str) {
        self.faults.retain(|fault| !fault.contains(missing));
        self.close();
    }

    /// Closes the page, which may have complained about connections that are refused.
    pub(crate) fn close_after_the_program(mut self) {
        self.faults.retain(|fault| !fault.contains("ERR_CONNECTION_"));
        self.close();
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        let _killed = self.browser.kill();
        let _ended = self.browser.wait();
    }
}

/// Returns the debugging address of the page, once there is one.
fn target(address: &str) -> String {
    let begun = Instant::now();
    loop {
        let mut stream = TcpStream::connect(address).unwrap();
        write!(stream, "GET /json/list HTTP/1.1\r\nhost: {address}\r\nconnection: close\r\n\r\n").unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
        let mut answer = Vec::new();
        let _closed = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer);
        let list = answer.split_once("\r\n\r\n").map_or("", |(_, body)| body);
        let pages: Vec<Value> = serde_json::from_str(list).unwrap_or_default();
        let is_page = |url: &str| url.starts_with("http://127") || url.starts_with("file:");
        let mut pages = pages.iter().filter(|page| page["url"].as_str().is_some_and(is_page));
        if let Some(url) = pages.next().and_then(|page| page["webSocketDebuggerUrl"].as_str()) {
            return url.to_owned();
        }
        assert!(begun.elapsed() < TIMEOUT, "no page: {answer}");
        std::thread::sleep(Duration::from_millis(100));
    }
}
