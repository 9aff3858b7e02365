//! The page about a running program, used in headless Chromium.

mod many_passes;

use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::browser::Page;
use crate::examples::example;

/// A program that serves a page, until it is dropped.
pub(super) struct Serving {
    program: Child,
    pub(super) url: String,
}

impl Serving {
    pub(super) fn start(command: &mut Command) -> Self {
        let mut program = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(program.stdout.take().unwrap()).lines().map_while(Result::ok);
        let url = lines.find(|line| line.starts_with("http://127.0.0.1:")).expect("an address");
        std::thread::spawn(move || lines.for_each(drop));
        Self { program, url }
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        let _killed = self.program.kill();
        let _ended = self.program.wait();
    }
}

/// Watches the last version of a texture, and waits for its first texels.
pub(super) fn watch(page: &mut Page, texture: &str) {
    page.until("liveView.socket?.readyState === WebSocket.OPEN && liveView.frames.length > 0");
    let choose = format!(
        "{{ const found = [...liveView.texture.options].find((option) => option.textContent === '{texture}');
        liveView.texture.value = found.value; liveView.texture.dispatchEvent(new Event('change')); }}"
    );
    page.value(&choose);
    page.until("liveView.textures > 0");
}

fn count(page: &mut Page) -> f64 {
    page.value("liveView.textures").as_f64().unwrap()
}

/// Prints how many textures arrive in a second, and checks that they do: on an idle machine 10 of a frame that takes less than a tenth of one.
pub(super) fn check_rate(page: &mut Page) {
    let (before, begun) = (count(page), Instant::now());
    std::thread::sleep(Duration::from_secs(3));
    let per_second = (count(page) - before) / begun.elapsed().as_secs_f64();
    println!("{per_second:.1} textures a second, {}", page.value("liveView.numbers.textContent"));
    assert!(per_second > 0.2, "{per_second}");
}

/// The sum of the shown texels.
const SUM: &str = "liveView.texels.reduce((sum, value) => sum + value, 0)";

#[test]
fn the_custom_engine_is_watched_while_it_runs_frozen_and_moved_by_steps() {
    let serving =
        Serving::start(Command::new(example("custom_engine")).args(["--serve", "0", "--size", "320x180"]));
    let Some(mut page) = Page::open(&serving.url) else { return };
    watch(&mut page, "depth");
    check_rate(&mut page);
    // Frozen, what is watched stays; a step changes it once.
    page.value("liveView.ask({ freeze: true })");
    page.until("liveView.controls.freeze === true");
    let settled = |page: &mut Page| -> Value {
        let after = count(page) + 3.0;
        page.until(&format!("liveView.textures > {after}"));
        page.value(SUM)
    };
    let frozen = settled(&mut page);
    assert_eq!(settled(&mut page), frozen);
    page.value("liveView.ask('step')");
    let stepped = settled(&mut page);
    assert_ne!(stepped, frozen);
    assert_eq!(settled(&mut page), stepped);
    page.value("liveView.ask({ freeze: false })");
    page.until("liveView.controls.freeze === false");
    assert_ne!(settled(&mut page), stepped);
    page.keep("custom_engine.png");
    // What is not offered is refused.
    page.value("liveView.ask({ pixel: [1, 1] })");
    page.until("liveView.state.textContent.startsWith('refused: ')");
    drop(serving);
    page.until("liveView.state.textContent.startsWith('the program has ended')");
    page.close_after_the_program();
}
