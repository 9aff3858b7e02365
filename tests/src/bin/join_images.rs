//! Joins the panels of an image of the documents: `join_images IMAGE [OPTION]... -- PANEL...`. The options are those of
//! `xtask/images.txt`.
#![allow(clippy::print_stderr, reason = "a command-line tool prints for its user")]

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops::{self, FilterType as Scaling};
use image::{Rgb, RgbImage, Rgba, RgbaImage};
use std::error::Error;
use std::process::ExitCode;

/// The width of the border around a panel, pixels.
const BORDER_PX: u32 = 3;

/// The colour of the border and behind pixels without a surface.
const BACKGROUND: [u8; 3] = [80, 112, 144];

/// How panels are joined.
struct Options {
    /// The number of panels in a row; without it there is one panel and no border.
    columns: Option<usize>,
    /// Each pixel becomes a square of this width.
    scale: u32,
    /// The width of the image.
    width: Option<u32>,
    /// Whether the right half of each panel is shown.
    right_half: bool,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    const USAGE: &str = "usage: join_images IMAGE [OPTION]... -- PANEL...";
    let (file, rest) = arguments.split_first().ok_or(USAGE)?;
    let end = rest.iter().position(|word| word == "--").ok_or(USAGE)?;
    let options = options(&rest[..end])?;
    let panels: Vec<RgbImage> =
        rest[end + 1..].iter().map(|file| panel(file, &options)).collect::<Result<_, _>>()?;
    let mut image = match (options.columns, &panels[..]) {
        (_, []) => return Err(USAGE.into()),
        (None, [panel]) => panel.clone(),
        (columns, panels) => join(panels, columns.unwrap_or(1)),
    };
    if let Some(width) = options.width {
        let height = (image.height() * width + image.width() / 2) / image.width();
        image = imageops::resize(&image, width, height, Scaling::Lanczos3);
    }
    let encoder = std::io::BufWriter::new(std::fs::File::create(file)?);
    let encoder = PngEncoder::new_with_quality(encoder, CompressionType::Best, FilterType::Adaptive);
    Ok(image.write_with_encoder(encoder)?)
}

fn options(words: &[String]) -> Result<Options, Box<dyn Error>> {
    let mut options = Options { columns: None, scale: 1, width: None, right_half: false };
    for word in words {
        match word.split_once('=') {
            Some(("columns", number)) => options.columns = Some(number.parse()?),
            Some(("scale", number)) => options.scale = number.parse()?,
            Some(("width", number)) => options.width = Some(number.parse()?),
            Some(("half", "right")) => options.right_half = true,
            _ => {
                return Err(format!(
                    "unknown option `{word}`; expected one of: columns=N, scale=N, width=N, half=right"
                )
                .into());
            }
        }
    }
    Ok(options)
}

/// Reads a panel.
fn panel(file: &str, options: &Options) -> Result<RgbImage, Box<dyn Error>> {
    let panel = image::open(file).map_err(|error| format!("{file}: {error}"))?.into_rgba8();
    let mut opaque = on_background(&panel);
    if options.right_half {
        let half = opaque.width() / 2;
        opaque = imageops::crop_imm(&opaque, half, 0, opaque.width() - half, opaque.height()).to_image();
    }
    let [width, height] = [opaque.width(), opaque.height()].map(|px| px * options.scale);
    Ok(imageops::resize(&opaque, width, height, Scaling::Nearest))
}

fn on_background(panel: &RgbaImage) -> RgbImage {
    RgbImage::from_fn(panel.width(), panel.height(), |x, y| {
        let Rgba([r, g, b, alpha]) = *panel.get_pixel(x, y);
        let mixed = |value: u8, behind: u8| {
            let sum = u32::from(value) * u32::from(alpha) + u32::from(behind) * (255 - u32::from(alpha));
            ((sum + 127) / 255) as u8
        };
        Rgb([mixed(r, BACKGROUND[0]), mixed(g, BACKGROUND[1]), mixed(b, BACKGROUND[2])])
    })
}

/// Puts panels side by side, `columns` in a row, each with a border. A row is as high as its highest panel.
fn join(panels: &[RgbImage], columns: usize) -> RgbImage {
    let rows: Vec<&[RgbImage]> = panels.chunks(columns.max(1)).collect();
    let width_of = |panel: &RgbImage| panel.width() + 2 * BORDER_PX;
    let height_of =
        |row: &[RgbImage]| row.iter().map(|panel| panel.height() + 2 * BORDER_PX).max().unwrap_or(0);
    let width = rows.iter().map(|row| row.iter().map(width_of).sum()).max().unwrap_or(0);
    let height = rows.iter().map(|row| height_of(row)).sum();
    let mut image = RgbImage::from_pixel(width, height, Rgb(BACKGROUND));
    let mut top = BORDER_PX;
    for row in rows {
        let mut left = BORDER_PX;
        for panel in row {
            imageops::replace(&mut image, panel, i64::from(left), i64::from(top));
            left += width_of(panel);
        }
        top += height_of(row);
    }
    image
}
