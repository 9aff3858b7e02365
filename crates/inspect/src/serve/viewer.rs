//! An open page: it gets what is new, ten times a second at most, and asks for things.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use shadowgraph_core::PassTime;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

use super::request::PageMessage;
use super::shared::{News, Shared};

/// How long a read waits before new frames are looked for.
const READ_TIMEOUT: Duration = Duration::from_millis(10);
/// The least time between two messages about frames.
const TICK_EVERY: Duration = Duration::from_millis(100);
/// The longest message of a page, bytes.
const MESSAGE_BYTES: usize = 4096;

/// Shows frames to a page until it is closed, is too slow, or the server stops. `rest` are bytes that it has already sent.
pub(super) fn show(stream: TcpStream, rest: Vec<u8>, shared: &Shared) -> std::io::Result<()> {
    stream.set_read_timeout(Some(READ_TIMEOUT))?;
    let config = WebSocketConfig::default()
        .max_message_size(Some(MESSAGE_BYTES))
        .max_frame_size(Some(MESSAGE_BYTES))
        .read_buffer_size(MESSAGE_BYTES);
    let mut viewer = Viewer {
        socket: WebSocket::from_partially_read(stream, rest, Role::Server, Some(config)),
        shared,
        frame: 0,
        ticked: None,
        seen: [0; 3],
    };
    shared.count_viewer(true);
    // However it ends, the page is gone.
    let _ended = viewer.run();
    shared.count_viewer(false);
    Ok(())
}

struct Viewer<'s> {
    socket: WebSocket<TcpStream>,
    shared: &'s Shared,
    /// The number of the last frame that the page knows.
    frame: u64,
    ticked: Option<Instant>,
    /// The changes of messages that it knows.
    seen: [u64; 3],
}

impl Viewer<'_> {
    fn run(&mut self) -> Result<(), Error> {
        while !self.shared.is_stopped() {
            match self.socket.read() {
                Ok(Message::Text(text)) => self.take(&text)?,
                Ok(Message::Close(_)) => return Ok(()),
                Ok(_) => {}
                Err(Error::Io(error))
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(error) => return Err(error),
            }
            self.send_news()?;
        }
        self.socket.close(None)
    }

    /// Takes a message of the page.
    fn take(&mut self, text: &str) -> Result<(), Error> {
        let refused = match serde_json::from_str(text) {
            Ok(PageMessage::Watch(watch)) => {
                self.shared.set_watch(watch.map(Into::into));
                Ok(())
            }
            Ok(PageMessage::Request(request)) => self.shared.request(request),
            Err(error) => Err(format!("not understood: {error}")),
        };
        match refused {
            Ok(()) => Ok(()),
            Err(reason) => self.send(serde_json::json!({ "refused": reason }).to_string()),
        }
    }

    fn send_news(&mut self) -> Result<(), Error> {
        let is_due = self.ticked.is_none_or(|ticked| ticked.elapsed() >= TICK_EVERY);
        let News { ticks, times, messages } = self.shared.news(is_due.then_some(self.frame));
        for (index, message) in messages.iter().enumerate() {
            if message.change > self.seen[index] {
                self.seen[index] = message.change;
                self.send(message.json.to_string())?;
            }
        }
        if let Some(last) = ticks.last() {
            self.ticked = Some(Instant::now());
            self.frame = last.number;
            let pass = |time: &PassTime| (time.cpu_ms, time.gpu_ms);
            let times: Vec<_> = times.iter().map(pass).collect();
            self.send(serde_json::json!({ "frames": ticks, "times": times }).to_string())?;
        }
        Ok(())
    }

    fn send(&mut self, text: String) -> Result<(), Error> {
        self.socket.send(Message::text(text))
    }
}
