//! `shadowgraph view` in a window on a virtual display.

mod window;

use crate::browser::Page;
use crate::live_page::{Serving, check_rate, watch};
use shadowgraph_tests::animated::{SKINNED, add_floor_and_camera};
use shadowgraph_tests::{program, repository};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use window::{Display, Screenshot, View, changed};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ConnectionExt as _, KEY_PRESS_EVENT, KEY_RELEASE_EVENT,
};

/// Returns the column of pixels in which the panel begins.
fn panel_left(screenshot: &Screenshot) -> u32 {
    // The row between the names of the pages and their contents.
    let is_panel = |x: &u32| (*x..*x + 40).all(|x| screenshot.get_pixel(x, 34).0.iter().all(|&c| c < 40));
    (100..400).find(is_panel).unwrap()
}

/// The image of the scene next to the panel.
fn scene(screenshot: &Screenshot) -> Screenshot {
    let (width, height) = (panel_left(screenshot), screenshot.height());
    image::imageops::crop_imm(screenshot, 0, 0, width - 4, height).to_image()
}

/// Returns whether the scene is visible left of the panel.
fn lit(screenshot: &Screenshot) -> bool {
    let bright =
        screenshot.enumerate_pixels().filter(|(x, _, pixel)| *x < 150 && pixel.0.iter().all(|&c| c > 60));
    bright.count() > 150 * 360 / 5
}

const F2: u32 = 0xffbf;
const F3: u32 = 0xffc0;

#[test]
fn the_window_shows_the_scene_flies_swaps_techniques_and_opens_the_graph() {
    let Some(display) = Display::open() else { return };
    let dir = tempfile::tempdir().unwrap();
    let recording = dir.path().join("view.frames");
    let recording = recording.to_str().unwrap();
    let mut view = View::start(&display, &["--animation", "none", "--record", recording]);
    let empty = Screenshot::new(640, 360);
    view.until("the scene", |view| lit(&view.screenshot()));
    let first = view.keep("1 scene");

    // A frame may take long on a busy machine.
    view.key(u32::from('d'), KEY_PRESS_EVENT);
    view.until("the camera to move", |view| changed(&first, &view.screenshot()) > 0.2);
    view.key(u32::from('d'), KEY_RELEASE_EVENT);
    view.until("the camera to rest", |view| {
        let before = view.screenshot();
        std::thread::sleep(Duration::from_secs(1));
        // The times in the panel change.
        changed(&before, &view.screenshot()) < 0.005
    });
    let moved = view.keep("2 moved");

    // The day passes: shadows and brightness change.
    view.tap(u32::from('l'));
    view.until("the sun to move", |view| changed(&moved, &view.screenshot()) > 0.05);
    view.tap(u32::from('l'));
    std::thread::sleep(Duration::from_secs(3));
    let later = view.keep("3 later");

    view.tap(u32::from('t'));
    view.until("the next technique", |view| view.title(view.window).contains("pcss"));
    view.tap(F3);
    view.wait_for_change(&later);
    std::thread::sleep(Duration::from_secs(3));
    let graph = view.keep("4 graph");

    // Another page has the history of the pixel, as soon as there is one.
    view.click_right([100, 200]);
    view.wait_for_change(&graph);
    let lines = |screenshot: &Screenshot| {
        let panel = image::imageops::crop_imm(screenshot, panel_left(screenshot), 100, 200, 250).to_image();
        let is_text = |pixel: &&image::Rgb<u8>| pixel.0.iter().all(|&channel| channel > 100);
        panel.pixels().filter(is_text).count()
    };
    view.until("the history of a pixel", |view| lines(&view.screenshot()) > 1000);
    let pixel = view.keep("5 pixel");

    view.tap(F2);
    view.wait_for_change(&pixel);
    std::thread::sleep(Duration::from_secs(2));
    view.keep("6 settings");

    // The smallest size, hidden, and back.
    view.resize(1, 1);
    std::thread::sleep(Duration::from_secs(2));
    view.resize(640, 360);
    view.x.unmap_window(view.window).unwrap();
    view.x.flush().unwrap();
    std::thread::sleep(Duration::from_secs(2));
    view.x.map_window(view.window).unwrap();
    view.x.flush().unwrap();
    view.wait_for_change(&empty);
    let back = view.keep("7 back");

    let (status, errors) = view.close();
    assert!(status.success() && !errors.contains("panicked"), "{status}: {errors}");

    // Another process draws the last of the recorded frames again, after all others.
    let image = dir.path().join("last.png");
    let mut replay = Command::new(program().unwrap());
    replay.args(["render", "--adapter", "cpu", "--replay", recording, "-o", image.to_str().unwrap()]);
    let output = replay.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let last = image::open(&image).unwrap().to_rgb8();
    let shown = image::imageops::crop_imm(&back, 0, 0, last.width(), last.height()).to_image();
    // The window filters the image.
    assert!(changed(&last, &shown) < 0.03, "{}", changed(&last, &shown));
    let earlier = image::imageops::crop_imm(&moved, 0, 0, last.width(), last.height()).to_image();
    assert!(changed(&last, &earlier) > 0.05);
}

/// Controls on the first page of the panel, from its left edge.
mod controls {
    // While it is placed by direction.
    pub(super) const AZIMUTH: [i16; 2] = [27, 200];
    pub(super) const ELEVATION: [i16; 2] = [27, 223];
    /// The time of the animations.
    pub(super) const TIME: [i16; 2] = [9, 338];
    // While the sun is placed by time.
    pub(super) const HOUR: [i16; 2] = [27, 200];
    pub(super) const DAY: [i16; 2] = [27, 223];
    pub(super) const LATITUDE: [i16; 2] = [27, 246];
}

#[test]
fn an_animation_plays_and_the_panel_controls_it_and_the_sun() {
    let Some(display) = Display::open() else { return };
    let dir = tempfile::tempdir().unwrap();
    let mut file = (SKINNED.file)();
    add_floor_and_camera(&mut file);
    let file = file.write(dir.path());
    let arguments = [file.to_str().unwrap(), "--sun", "dir=-0.6,-1,-0.3 lux=40000"];
    let mut view = View::start_with_size(&display, [640, 440], &arguments);
    view.until("the scene", |view| lit(&view.screenshot()));

    let started = Instant::now();
    let (mut poses, mut last) = (0, scene(&view.keep("10 play")));
    while poses < 4 {
        let before = last.clone();
        view.until("the next pose", |view| {
            last = scene(&view.screenshot());
            changed(&before, &last) > 0.002
        });
        poses += 1;
    }
    assert!(started.elapsed() < Duration::from_secs(20), "{poses} poses in {:?}", started.elapsed());

    // The times in the panel change, but the scene does not, once the frames in flight are shown.
    let stands = |view: &mut View, what: &str| {
        view.until(what, |view| {
            let before = scene(&view.screenshot());
            std::thread::sleep(Duration::from_secs(3));
            changed(&before, &scene(&view.screenshot())) < 0.0005
        });
    };
    let left = panel_left(&view.screenshot()) as i16;
    // The point of a slider at a fraction of its range.
    let along = |[x, y]: [i16; 2], fraction: f64| [left + x + (8.0 + 84.0 * fraction) as i16, y];
    let another =
        |before: Screenshot| move |view: &mut View| changed(&before, &scene(&view.screenshot())) > 0.005;
    let now = |view: &View| scene(&view.screenshot());

    view.tap(u32::from('p'));
    stands(&mut view, "P to pause");
    // The time at which it paused is any, also one that a place of the slider shows.
    view.press(along(controls::TIME, 0.6));
    stands(&mut view, "the first time to stand");
    for fraction in [0.1, 0.9, 0.3] {
        let before = now(&view);
        view.press_until(along(controls::TIME, fraction), "another time", another(before));
    }
    view.keep("11 scrubbed");
    stands(&mut view, "the time to stand");

    let before = now(&view);
    view.tap(u32::from('p'));
    view.until("it to play again", another(before));
    view.tap(u32::from('p'));
    stands(&mut view, "P to pause again");

    for (control, fraction) in
        [(controls::AZIMUTH, 0.2), (controls::ELEVATION, 0.65), (controls::AZIMUTH, 0.9)]
    {
        let before = now(&view);
        view.press_until(along(control, fraction), "another sun", another(before));
    }
    stands(&mut view, "the sun to stand");
    view.keep("12 sun by direction");

    // A day that plays places the sun by time.
    let before = now(&view);
    view.tap(u32::from('l'));
    view.until("the day to pass", another(before));
    view.tap(u32::from('l'));
    stands(&mut view, "the day to pause");
    view.keep("13 day played");
    // The hour at which it paused is any, too.
    view.press(along(controls::HOUR, 0.8));
    stands(&mut view, "the first hour to stand");
    for (control, fraction) in [(controls::HOUR, 0.4), (controls::LATITUDE, 0.7), (controls::DAY, 0.1)] {
        let before = now(&view);
        view.press_until(along(control, fraction), "another sun", another(before));
    }
    stands(&mut view, "the sun of a time to stand");
    view.keep("14 sun by time");

    let (status, errors) = view.close();
    assert!(
        status.success() && !errors.contains("error") && !errors.contains("panicked"),
        "{status}: {errors}"
    );
}

#[test]
fn an_error_in_a_saved_shader_is_shown_and_the_last_good_frame_stays() {
    let Some(display) = Display::open() else { return };
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("tonemap.wgsl");
    let good = std::fs::read_to_string(repository().join("shaders/wgsl/tonemap.wgsl")).unwrap();
    std::fs::write(&file, &good).unwrap();
    let mut view = View::start(&display, &["--animation", "none", "--shaders", dir.path().to_str().unwrap()]);
    view.until("the scene", |view| lit(&view.screenshot()));
    std::thread::sleep(Duration::from_secs(2));
    let before = view.screenshot();
    let scene = |screenshot: &Screenshot| image::imageops::crop_imm(screenshot, 0, 0, 200, 360).to_image();
    std::fs::write(&file, good.replace("return", "return oops +")).unwrap();
    // The panel shows the error; the frame next to it stays.
    view.wait_for_change(&before);
    let broken = view.keep("7 shader error");
    assert!(changed(&scene(&before), &scene(&broken)) < 0.001, "the last good frame stays");
    std::fs::write(&file, good.replace("@fragment", "\n@fragment")).unwrap();
    view.until("the error to be gone", |view| changed(&before, &view.screenshot()) < 0.02);
    let (status, errors) = view.close();
    assert!(status.success() && !errors.contains("panicked"), "{status}: {errors}");
}

#[test]
fn a_saved_settings_file_is_reloaded_and_an_error_in_it_is_shown() {
    let Some(display) = Display::open() else { return };
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("settings.ron");
    std::fs::write(&file, "(distance_m: 60.0)").unwrap();
    let mut view = View::start(&display, &["--settings", file.to_str().unwrap(), "--technique", "none"]);
    view.until("the scene", |view| lit(&view.screenshot()));
    std::thread::sleep(Duration::from_secs(1));
    let before = view.screenshot();
    std::fs::write(&file, "(distance_m: 0.0)").unwrap();
    view.wait_for_change(&before);
    let shown = view.keep("8 settings error");
    std::fs::write(&file, "(distance_m: 70.0)").unwrap();
    view.wait_for_change(&shown);
    view.keep("9 settings again");
    // It ends with an exit code, not a signal, and with at most two lines.
    let (status, errors) = view.kill();
    assert!(status.code().is_some_and(|code| code <= 1), "{status}: {errors}");
    assert!(!errors.contains("panicked") && errors.lines().count() <= 2, "{errors}");
}

#[test]
fn without_a_display_view_fails_with_one_line() {
    let output = Command::new(program().unwrap())
        .arg("view")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{error}");
    assert!(error.starts_with("error: there is no display") && error.lines().count() == 1, "{error}");
    assert!(!error.contains(".rs"), "{error}");
}

#[test]
fn row_43_the_end_of_a_cascade_is_dragged_in_the_window() {
    let Some(display) = Display::open() else { return };
    let arguments = ["--aov", "cascade", "--camera", "courtyard"];
    let mut view = View::start_with_size(&display, [1000, 600], &arguments);
    let scene = |view: &View| image::imageops::crop_imm(&view.screenshot(), 0, 0, 580, 600).to_image();
    let empty = Screenshot::new(580, 600);
    view.until("the scene", |view| changed(&empty, &scene(view)) > 0.5);
    view.tap(F2);
    std::thread::sleep(Duration::from_secs(4));
    let before = scene(&view);
    // The end of the first cascade.
    view.point([689, 150]);
    view.button(BUTTON_PRESS_EVENT);
    std::thread::sleep(Duration::from_secs(2));
    view.point([705, 150]);
    view.until("a longer first cascade", |view| changed(&before, &scene(view)) > 0.05);
    view.button(BUTTON_RELEASE_EVENT);
    // The settings of the first light, below the names of the pages.
    for at in [[630, 86], [650, 108], [646, 131]] {
        view.point(at);
        for kind in [BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT] {
            std::thread::sleep(Duration::from_millis(700));
            view.button(kind);
        }
        std::thread::sleep(Duration::from_secs(2));
    }
    let window = view.keep("15 splits and lights");
    if let Some(dir) = shadowgraph_tests::images() {
        window.save(dir.join("splits_and_lights.png")).unwrap();
    }
}

/// Starts the program with a window and a page about it.
fn serve(display: &Display, arguments: &[&str]) -> Serving {
    let mut command = Command::new(program().unwrap());
    command.args(["view", "--adapter", "cpu", "--pipeline", "minimal_lit", "--serve", "0"]).args(arguments);
    Serving::start(command.env("DISPLAY", &display.name).env_remove("WAYLAND_DISPLAY"))
}

#[test]
fn the_window_of_a_small_scene_is_watched() {
    let Some(display) = Display::open() else { return };
    // The panel takes half of it.
    let serving = serve(&display, &["--scene", "cube", "--size", "640x180"]);
    let Some(mut page) = Page::open(&serving.url) else { return };
    watch(&mut page, "lighting/lit");
    check_rate(&mut page);
    page.keep("small_scene.png");
}

#[test]
fn the_window_is_watched_on_a_page_that_changes_the_technique() {
    let Some(display) = Display::open() else { return };
    let dir = tempfile::tempdir().unwrap();
    let recording = dir.path().join("page.frames");
    let recording = recording.to_str().unwrap();
    let serving = serve(&display, &["--size", "640x360", "--record", recording]);
    let Some(mut page) = Page::open(&serving.url) else { return };
    watch(&mut page, "lighting/lit");
    page.value("liveView.ask({ pixel: [40, 100] })");
    page.until("liveView.history.textContent.includes('lighting/forward')");
    page.until("liveView.history.textContent.includes('light 0 `sun` (directional)')");
    page.until("liveView.frames.length > 40");
    page.keep("live.png");
    page.value("liveView.ask({ choose: { name: 'technique', value: 'none' } })");
    page.until("liveView.controls.settings[0].value.choice.chosen === 'none'");
    // The page of the new plan, once there is one, watches the same texture.
    let is_new = "passes.every((pass) => !pass.name.startsWith('cascade'))";
    page.until(&format!(
        "{is_new} || (liveView.frames.length > 3 && !liveView.other.hidden && liveView.leave(''))"
    ));
    page.until("liveView.textures > 0 && liveView.wanted.texture === 'lighting/lit'");
    // The passes of the pixel are a path through the graph.
    page.value("liveView.ask({ pixel: [40, 100] })");
    page.until("document.getElementById('path')");
    page.value("document.getElementById('path').click()");
    page.until("graphView.note.textContent.includes('of pixel 40,100') && chosen.path.length > 1");
    page.keep("path.png");
    // The recording so far explains a pixel of one of its frames in another process.
    page.value("document.getElementById('save-recording').click()");
    let begun = Instant::now();
    while !Path::new(recording).exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the recording is not saved");
        std::thread::sleep(Duration::from_millis(100));
    }
    page.close();
    let mut pixel = Command::new(program().unwrap());
    pixel.args(["pixel", "40,100", "--adapter", "cpu", "--replay", recording, "--frame", "2"]);
    let output = pixel.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("lighting/forward") && text.contains("light 0 `sun` (directional)"), "{text}");
}
