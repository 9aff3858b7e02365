//! `shadowgraph bench --first-image`: the time from a loaded scene to its first image.

use std::time::{Duration, Instant};

use shadowgraph::{Gpu, ViewOptions};
use shadowgraph_quality::TextTable;

use super::commands::Input;
use super::failure::Failure;
use super::report::COLUMNS;

/// Draws the first image of a scene, and returns the lines to print.
pub(crate) fn first_image(input: Input, view: &ViewOptions) -> Result<String, Failure> {
    let mut clock = Instant::now();
    let mut lap = || std::mem::replace(&mut clock, Instant::now()).elapsed();
    let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
    let opened = lap();
    let mut renderer = input.renderer(&gpu)?;
    let uploaded = lap();
    renderer.draw(&gpu, view)?;
    let first = lap();
    renderer.draw(&gpu, view)?;
    Ok(table([opened, uploaded, first], lap(), &gpu.adapter.name))
}

/// Formats the times of the steps to the first image and of the second image.
fn table(steps: [Duration; 3], second: Duration, device: &str) -> String {
    let row = |name: &str, time: Duration| [name.to_owned(), format!("{:.2}", time.as_secs_f64())];
    let [opened, uploaded, first] = steps;
    let rows = vec![
        ["step", "seconds"].map(str::to_owned),
        row("open the GPU", opened),
        row("upload the scene", uploaded),
        row("compile shaders and draw", first),
        row("first image", steps.iter().sum()),
        row("second image", second),
    ];
    format!(
        "from the loaded scene to the first image, on {device}; the driver may have kept shaders from earlier runs\n{}",
        TextTable { alignment: "lr", indent: 2, width: COLUMNS }.format(rows)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_image_takes_all_steps() {
        let text = table([10, 200, 3000].map(Duration::from_millis), Duration::from_millis(40), "a GPU");
        assert!(text.lines().any(|line| line.trim() == "first image                  3.21"), "{text}");
    }
}
