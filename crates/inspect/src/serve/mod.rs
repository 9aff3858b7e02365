//! A page about the frames of a running program.

mod connection;
mod controls;
mod request;
mod shared;
mod viewer;

pub use controls::{Controls, Offered, OfferedValue};
pub use request::PageRequest;

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use shadowgraph_core::{Executed, Graph, PassTime, Plan, wgpu};

use crate::error::Error;
use crate::pixel::PixelHistory;
use shared::{PlanNumber, Shared, Tick, WatchedFrame};

/// Textures are copied this often, more than ten times a second, or with every frame if frames take longer.
const INTERVAL: Duration = Duration::from_millis(90);

/// Serves a page about the frames of a running program: its graph, times, memory, and any texture while it changes.
///
/// The page is that of [`HtmlPage`](crate::HtmlPage) with one more view. Its address has a random token, without which nothing is
/// answered. It can change nothing but what the program [offers](Self::offer). Pages are answered by threads of their own, and always get
/// the newest frame: a slow one misses frames. Several pages watch the same texture. Without a page, a frame costs some loads of numbers.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Graph, TextureDesc, wgpu};
/// use shadowgraph_inspect::{Controls, FrameReport, PageRequest, Server};
/// # let (device, queue) = wgpu::Device::noop(&Default::default());
/// let mut server = Server::start(0, "My engine")?;
/// println!("{}", server.url()); // http://127.0.0.1:40123/d3b0…/
/// server.offer(Controls { freeze: Some(false), ..Controls::default() });
/// let mut graph = Graph::new();
/// let mut is_frozen = false;
/// for _ in 0..3 {
///     for request in server.take_requests() {
///         if let PageRequest::Freeze(freeze) = request {
///             is_frozen = freeze;
///         }
///     }
///     let mut frame = graph.frame();
///     let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
///     frame.render_pass("draw").color(&mut color, Contents::clear_color([1.0; 4]));
///     frame.export_texture(&color);
///     server.begin_frame(&mut graph);
///     let mut encoder = device.create_command_encoder(&Default::default());
///     let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
///     queue.submit([encoder.finish()]);
///     server.end_frame(&device, &mut executed, &FrameReport { times: &[], bytes: graph.bytes() });
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Server {
    shared: Arc<Shared>,
    address: SocketAddr,
    accepting: Option<JoinHandle<()>>,
    encoding: Option<(SyncSender<WatchedFrame>, JoinHandle<()>)>,
    /// The watched texture that has not arrived yet.
    pending: Option<WatchedFrame>,
    /// When the next copy is due.
    next_copy: Instant,
    /// Whether the graph watches what the page shows.
    is_watching: bool,
    /// The plan of the last frame, and its number if a page has seen it.
    plan: Option<(Arc<Plan>, Option<PlanNumber>)>,
    last_frame: Option<Instant>,
    frames: u64,
}

/// What the page shows of a frame besides its plan.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameReport<'r> {
    /// The times of the passes as [`Timer::read`](shadowgraph_core::Timer::read) returns them; empty if they are not measured.
    pub times: &'r [PassTime],
    /// The memory of the graph: [`Graph::bytes`].
    pub bytes: u64,
}

impl Server {
    /// Serves on a port of this machine, 127.0.0.1: 0 for any free one. `title` is that of the page.
    ///
    /// # Errors
    /// [`Error::Serve`] if the port is taken, or the system has no random numbers or threads.
    pub fn start(port: u16, title: &str) -> Result<Self, Error> {
        Self::start_on(SocketAddr::from((Ipv4Addr::LOCALHOST, port)), title)
    }

    /// Serves on an address of any network. Who knows the page's address can see all textures: connections are not encrypted.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_on(address: SocketAddr, title: &str) -> Result<Self, Error> {
        let failed = |problem: String| Error::Serve { address, problem };
        let listener = TcpListener::bind(address).map_err(|error| failed(error.to_string()))?;
        listener.set_nonblocking(true).map_err(|error| failed(error.to_string()))?;
        let address = listener.local_addr().map_err(|error| failed(error.to_string()))?;
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(|error| failed(error.to_string()))?;
        let token = format!("{:032x}", u128::from_ne_bytes(random));
        let shared = Arc::new(Shared::new(token, title));
        let thread = |name: &str, work: Box<dyn FnOnce() + Send>| {
            let spawned = std::thread::Builder::new().name(name.into()).spawn(work);
            spawned.map_err(|error| failed(error.to_string()))
        };
        let accepted = shared.clone();
        let accepting = thread("frame page", Box::new(move || connection::accept(&listener, &accepted)))?;
        let (sender, arrived) = sync_channel::<WatchedFrame>(1);
        let encoded = shared.clone();
        let encode = move || arrived.iter().for_each(|arrived| encoded.set_texture(arrived));
        let encoding = thread("frame page textures", Box::new(encode))?;
        Ok(Self {
            shared,
            address,
            accepting: Some(accepting),
            encoding: Some((sender, encoding)),
            pending: None,
            next_copy: Instant::now(),
            is_watching: false,
            plan: None,
            last_frame: None,
            frames: 0,
        })
    }

    /// Returns the address of the page.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.shared.token())
    }

    /// Returns the number of open pages.
    #[must_use]
    pub fn viewers(&self) -> usize {
        self.shared.viewers()
    }

    /// Offers controls to the page, or others than before.
    pub fn offer(&mut self, controls: Controls) {
        self.shared.offer(controls);
    }

    /// Returns the requests of pages since the last call, for what is offered, in order.
    pub fn take_requests(&mut self) -> Vec<PageRequest> {
        self.shared.take_requests()
    }

    /// Lets the graph copy the texture that a page shows, if it is time. Call it before a frame is executed.
    pub fn begin_frame(&mut self, graph: &mut Graph) {
        self.hand_over();
        let watch = match self.viewers() > 0 && self.pending.is_none() && Instant::now() >= self.next_copy {
            true => self.shared.watch(),
            false => None,
        };
        if watch.is_some() {
            self.next_copy = (self.next_copy + INTERVAL).max(Instant::now());
        }
        if watch.is_some() || self.is_watching {
            self.is_watching = watch.is_some();
            graph.watch(watch);
        }
    }

    /// Shows an executed frame, before or after it is submitted.
    pub fn end_frame(&mut self, device: &wgpu::Device, executed: &mut Executed, report: &FrameReport<'_>) {
        let now = Instant::now();
        let interval = self.last_frame.replace(now).map(|last| now - last);
        self.frames += 1;
        let plan = executed.shared_plan();
        if self.plan.as_ref().is_none_or(|(known, _)| !Arc::ptr_eq(known, &plan)) {
            self.shared.set_last_plan(plan.clone());
            self.plan = Some((plan, None));
        }
        if self.viewers() == 0 {
            self.pending = None;
            return;
        }
        if let Some(texture) = executed.take_watched() {
            let (plan, device) = (executed.shared_plan(), device.clone());
            self.pending = Some(WatchedFrame { texture, plan, device });
        }
        self.hand_over();
        let interval_ms = interval.map_or(0.0, |interval| interval.as_secs_f64() * 1e3);
        let plan = self.plan_number();
        let tick = Tick { number: self.frames, interval_ms, bytes: report.bytes, plan };
        self.shared.add_frame(tick, report.times);
    }

    /// Shows the history that a [`PageRequest::Pixel`] is for, and what the program says about the shadows there, which can be nothing.
    pub fn answer_pixel(&mut self, history: &PixelHistory, shadows: &str) {
        self.shared.set_pixel(history, shadows);
    }

    /// Lets the watched texture be encoded, if it has arrived.
    fn hand_over(&mut self) {
        if let Some(arrived) = self.pending.take_if(|watched| watched.texture.is_ready())
            && let Some((sender, _)) = &self.encoding
        {
            // Where the last one is still being encoded, this one is left out.
            let _sent = sender.try_send(arrived);
        }
    }

    /// Returns the number of the last frame's plan.
    fn plan_number(&mut self) -> PlanNumber {
        let Some((_, number)) = &mut self.plan else { return 0 };
        *number.get_or_insert_with(|| self.shared.number_last_plan())
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.stop();
        if let Some((sender, encoding)) = self.encoding.take() {
            drop(sender);
            let _ended = encoding.join();
        }
        if let Some(accepting) = self.accepting.take() {
            let _ended = accepting.join();
        }
    }
}

#[cfg(test)]
mod tests;
