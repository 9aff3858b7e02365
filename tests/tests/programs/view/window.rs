//! A virtual display, and the program in a window on it.

use shadowgraph_tests::{on_path, program, repository, skip};
use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux,
    ConnectionExt as _, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT,
    MOTION_NOTIFY_EVENT, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// A software driver takes about a second for a frame of a debug build.
const TIMEOUT: Duration = Duration::from_secs(120);

/// A virtual display.
pub(super) struct Display {
    server: Child,
    pub(super) name: String,
}

impl Display {
    pub(super) fn open() -> Option<Self> {
        if !on_path("Xvfb") {
            skip("view", "Xvfb is not installed");
            return None;
        }
        if !drivers() {
            skip("view", "no graphics driver is installed");
            return None;
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1024x640x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Some(Self { server, name: format!(":{}", number.trim()) })
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _gone = self.server.kill();
        let _ended = self.server.wait();
    }
}

/// The program and its window.
pub(super) struct View {
    child: Child,
    pub(super) x: RustConnection,
    root: Window,
    pub(super) window: Window,
    size_px: [u16; 2],
}

pub(super) type Screenshot = image::RgbImage;

impl View {
    /// Starts the program and waits for its window.
    pub(super) fn start(display: &Display, arguments: &[&str]) -> Self {
        Self::start_with_size(display, [640, 360], arguments)
    }

    pub(super) fn start_with_size(display: &Display, size_px: [u16; 2], arguments: &[&str]) -> Self {
        let [width, height] = size_px;
        let child = Command::new(program().unwrap())
            .args(["view", "--size", &format!("{width}x{height}"), "--adapter", "cpu"])
            .args(arguments)
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (x, screen) = x11rb::connect(Some(&display.name)).unwrap();
        let root = x.setup().roots[screen].root;
        let mut view = Self { child, x, root, window: 0, size_px };
        view.until("a window", |view| {
            let children = view.x.query_tree(view.root).unwrap().reply().unwrap().children;
            let named = children.into_iter().find(|&window| view.title(window).starts_with("Shadowgraph"));
            view.window = named.unwrap_or(0);
            named.is_some()
        });
        // There is no window manager to do it.
        view.until("the first frame", |view| view.title(view.window).contains(", "));
        view.x.set_input_focus(InputFocus::PARENT, view.window, x11rb::CURRENT_TIME).unwrap();
        view.x.flush().unwrap();
        view
    }

    pub(super) fn title(&self, window: Window) -> String {
        let name = self.x.get_property(false, window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64).unwrap();
        name.reply().map(|name| String::from_utf8_lossy(&name.value).into_owned()).unwrap_or_default()
    }

    /// Waits, while the program runs.
    pub(super) fn until(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> bool) {
        let started = Instant::now();
        while !holds(self) {
            if let Some(status) = self.child.try_wait().unwrap() {
                panic!("waiting for {what}, the program ended with {status}: {}", self.errors());
            }
            assert!(started.elapsed() < TIMEOUT, "waited too long for {what}");
            std::thread::sleep(Duration::from_millis(200));
        }
    }

    fn errors(&mut self) -> String {
        let mut text = String::new();
        if let Some(mut errors) = self.child.stderr.take() {
            let _read = errors.read_to_string(&mut text);
        }
        text
    }

    pub(super) fn screenshot(&self) -> Screenshot {
        let [width, height] = self.size_px;
        let image = self.x.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0).unwrap();
        let bytes = image.reply().unwrap().data;
        let rgb: Vec<u8> = bytes.chunks_exact(4).flat_map(|bgrx| [bgrx[2], bgrx[1], bgrx[0]]).collect();
        Screenshot::from_raw(width.into(), height.into(), rgb).unwrap()
    }

    /// Saves the screen as an image for a person to look at.
    pub(super) fn keep(&self, name: &str) -> Screenshot {
        let dir = repository().join("target/tmp/view");
        std::fs::create_dir_all(&dir).unwrap();
        let screenshot = self.screenshot();
        screenshot.save(dir.join(format!("{name}.png"))).unwrap();
        screenshot
    }

    pub(super) fn key(&self, keysym: u32, kind: u8) {
        let setup = self.x.setup();
        let count = setup.max_keycode - setup.min_keycode + 1;
        let map = self.x.get_keyboard_mapping(setup.min_keycode, count).unwrap().reply().unwrap();
        let per = usize::from(map.keysyms_per_keycode);
        let place = map.keysyms.chunks(per).position(|keys| keys.first() == Some(&keysym)).unwrap();
        let code = setup.min_keycode + place as u8;
        self.x.xtest_fake_input(kind, code, 0, self.root, 0, 0, 0).unwrap();
        self.x.flush().unwrap();
    }

    pub(super) fn tap(&self, keysym: u32) {
        self.key(keysym, KEY_PRESS_EVENT);
        std::thread::sleep(Duration::from_millis(30));
        self.key(keysym, KEY_RELEASE_EVENT);
    }

    /// Moves the pointer.
    pub(super) fn point(&self, [x, y]: [i16; 2]) {
        self.x.xtest_fake_input(MOTION_NOTIFY_EVENT, 0, 0, self.root, x, y, 0).unwrap();
        self.x.flush().unwrap();
    }

    pub(super) fn button(&self, kind: u8) {
        self.button_of(kind, 1);
    }

    fn button_of(&self, kind: u8, number: u8) {
        self.x.xtest_fake_input(kind, number, 0, self.root, 0, 0, 0).unwrap();
        self.x.flush().unwrap();
    }

    /// Clicks the right button of the mouse at a point.
    pub(super) fn click_right(&self, at: [i16; 2]) {
        self.point(at);
        std::thread::sleep(Duration::from_millis(500));
        self.button_of(BUTTON_PRESS_EVENT, 3);
        self.button_of(BUTTON_RELEASE_EVENT, 3);
    }

    /// Presses the button of the mouse at a point for a second.
    pub(super) fn press(&self, at: [i16; 2]) {
        self.point(at);
        self.button(BUTTON_PRESS_EVENT);
        std::thread::sleep(Duration::from_secs(1));
        self.button(BUTTON_RELEASE_EVENT);
    }

    /// Presses the button of the mouse at a point until a condition holds, and releases it.
    pub(super) fn press_until(&mut self, at: [i16; 2], what: &str, holds: impl FnMut(&mut Self) -> bool) {
        self.point(at);
        self.button(BUTTON_PRESS_EVENT);
        self.until(what, holds);
        self.button(BUTTON_RELEASE_EVENT);
    }

    pub(super) fn resize(&self, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.x.configure_window(self.window, &size).unwrap();
        self.x.flush().unwrap();
    }

    /// Waits for a frame that differs.
    pub(super) fn wait_for_change(&mut self, before: &Screenshot) {
        self.until("another frame", |view| changed(before, &view.screenshot()) > 0.02);
    }

    /// Closes the window as the button of its title bar does, and returns how the program ended.
    pub(super) fn close(self) -> (ExitStatus, String) {
        let atom = |name: &str| self.x.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom;
        let data = [atom("WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let message = ClientMessageEvent::new(32, self.window, atom("WM_PROTOCOLS"), data);
        self.x.send_event(false, self.window, EventMask::NO_EVENT, message).unwrap();
        self.x.flush().unwrap();
        self.end()
    }

    /// Destroys the window, and returns how the program ended.
    pub(super) fn kill(self) -> (ExitStatus, String) {
        self.x.kill_client(self.window).unwrap();
        self.x.flush().unwrap();
        self.end()
    }

    fn end(mut self) -> (ExitStatus, String) {
        let started = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                let errors = self.errors();
                return (status, errors);
            }
            assert!(started.elapsed() < TIMEOUT, "the window is closed, but the program still runs");
            std::thread::sleep(Duration::from_millis(100));
        }
    }
}

impl Drop for View {
    fn drop(&mut self) {
        let _gone = self.child.kill();
        let _ended = self.child.wait();
    }
}

/// Returns the fraction of pixels that clearly differ.
pub(super) fn changed(a: &Screenshot, b: &Screenshot) -> f64 {
    let differs = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|c| a[c].abs_diff(b[c]) > 12);
    let count = a.pixels().zip(b.pixels()).filter(|&pair| differs(pair)).count();
    count as f64 / f64::from(a.width() * a.height())
}

/// Returns whether there is a driver.
fn drivers() -> bool {
    let choice = shadowgraph::options::AdapterChoice::Cpu;
    shadowgraph::Gpu::open(&choice).is_ok()
}
