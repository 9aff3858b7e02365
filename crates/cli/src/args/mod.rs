//! The command line.

mod draw;
pub(crate) mod options;

pub(crate) use draw::{DrawArgs, settings_file, technique};

use clap::{Args, Parser, Subcommand, ValueEnum};
use shadowgraph::options::OptionError;
use std::path::{Path, PathBuf};

const USEFUL: &str = "\
The three most useful commands:
  shadowgraph render model.glb --sun \"dir=-1,-2,-1 lux=20000\" -o out/model.png
  shadowgraph render model.glb --aov visibility:0 -o out/shadow.png
  shadowgraph dump model.glb -o out/frame.html

Without a SCENE, the built-in demo scene is used.";

/// Renders scenes with shadows through a render graph, and shows the graph.
#[derive(Debug, Parser)]
#[command(name = "shadowgraph", version, after_help = USEFUL)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a glTF or GLB file, or the built-in scene, to a PNG file
    Render(RenderArgs),
    /// Print the plan of a frame: its passes and resources, with reasons
    Dump(DumpArgs),
    /// Explain the decisions about a pass or a resource of a frame: order, merging, load and store ops, memory
    Explain(ExplainArgs),
    /// Explain a pixel: the passes and textures that its value comes from, and the shadow of each light
    Pixel(PixelArgs),
    /// List pipelines, node kinds and techniques, or describe one of them
    Nodes(NodesArgs),
    /// Show a scene in a window, with its settings, its graph and the times of its passes
    #[cfg(feature = "view")]
    View(ViewArgs),
    /// Measure the cost of a frame: the time of each pass, and the graph compared with hand-written passes
    Bench(BenchArgs),
    /// Compare shadows with ray-traced ground truth: a table, and with -o a page with images
    Measure(MeasureArgs),
}

/// The frames that are drawn.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct FramesArgs {
    /// Number of frames, of which the last is the result. The animations play from --time on. Nodes that accumulate frames, such as
    /// taa, need several, and shadow maps are kept from the second on
    #[arg(long = "frames", value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) count: u32,
    /// Frames per second of the animations
    #[arg(long, value_name = "F", default_value_t = 60.0, allow_negative_numbers = true)]
    #[arg(value_parser = frames_per_second)]
    pub(crate) fps: f64,
}

/// What is recorded.
#[derive(Clone, Debug, Args)]
pub(crate) struct RecordArgs {
    /// Write what the frames are drawn from into a file, from which render --replay draws them again
    #[arg(id = "record", long = "record", value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// With --record: the largest size of the file in MiB, at which recording ends
    #[arg(
        id = "record_mib",
        long = "record-mib",
        value_name = "MIB",
        requires = "record",
        default_value_t = 256
    )]
    #[arg(allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) mib: u32,
}

impl RecordArgs {
    /// Returns the largest size in MiB, if frames are recorded.
    pub(crate) fn limit_mib(&self) -> Option<u32> {
        self.file.is_some().then_some(self.mib)
    }
}

/// The recorded frame that is drawn again.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReplayArgs {
    /// Draw a frame again that --record has recorded, to the bit on the same adapter: the last one, or that of --frame; render draws
    /// all if the output has a number
    #[arg(id = "replay", long = "replay", value_name = "FILE", conflicts_with_all = [
        "scene", "procedural", "variant", "pipeline", "set", "technique", "samples", "settings", "tracks", "size", "camera", "sun", "ground",
        "background", "culling", "time", "animation", "shadow_distance", "aov", "overlay", "shadow_camera", "timings", "count", "fps",
    ])]
    pub(crate) file: Option<PathBuf>,
    /// With --replay: the number of the frame, from 0
    #[arg(long, value_name = "N", requires = "replay", allow_negative_numbers = true)]
    pub(crate) frame: Option<u32>,
}

impl ReplayArgs {
    /// Returns the file, if a recorded frame is drawn.
    pub(crate) fn file(&self) -> Result<Option<&Path>, OptionError> {
        // Other options that conflict with --replay keep the parser from requiring it.
        match (&self.file, self.frame) {
            (None, Some(_)) => Err(OptionError::new("frame", "it is of a recording; give --replay FILE too")),
            (file, _) => Ok(file.as_deref()),
        }
    }
}

/// `shadowgraph render`
#[derive(Debug, Args)]
#[command(mut_arg("record", |record| record.conflicts_with("replay")))]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    #[command(flatten)]
    pub(crate) frames: FramesArgs,
    #[command(flatten)]
    pub(crate) record: RecordArgs,
    #[command(flatten)]
    pub(crate) replay: ReplayArgs,
    /// The PNG file; missing directories are created. %04d stands for the number of the frame, from 0, with at least 4 digits: all
    /// frames are written
    #[arg(short, long, value_name = "FILE", default_value = "out/render.png")]
    pub(crate) output: PathBuf,
    /// After each pass, count texels that are NaN, infinite or, of the textures named here, outside of a range; the exit code is 1 if
    /// there are any. The first pass that wrote one is named, with the pixel and what the pass read there
    #[arg(long, value_name = "TEXTURE=LOW..HIGH,...", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub(crate) check_values: Option<String>,
    /// Draw the last frame only until this version of a texture of the graph is written, and output what its pass has written: depth and integers
    /// stretched to their range, NaN and infinity in magenta
    #[arg(long, value_name = "TEXTURE@VERSION", conflicts_with_all = ["check_values", "record", "replay", "aov", "timings"])]
    #[arg(value_parser = stop_at)]
    pub(crate) stop_at: Option<(String, u32)>,
}

/// `shadowgraph dump`
#[derive(Debug, Args)]
pub(crate) struct DumpArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    #[command(flatten)]
    pub(crate) frames: FramesArgs,
    /// Format of the dump. Default: by the extension of --output (html, json, dot or mmd), otherwise text
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Compare two JSON dumps instead of rendering; the format is text, json or html
    #[arg(long, num_args = 2, value_names = ["A.json", "B.json"], conflicts_with = "DrawArgs")]
    pub(crate) diff: Option<Vec<PathBuf>>,
    /// With --diff: numbers of textures and buffers that differ by at most T times the larger one (or times 1) are equal
    #[arg(long, value_name = "T", requires = "diff", default_value_t = 0.0, allow_negative_numbers = true)]
    #[arg(value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// With --diff: versions of textures and buffers of which at most the fraction F differs, of texels or words, are equal
    #[arg(long, value_name = "F", requires = "diff", default_value_t = 0.0, allow_negative_numbers = true)]
    #[arg(value_parser = tolerance)]
    pub(crate) outliers: f64,
    /// Draw the frame, write a hash of each version of each texture and buffer into the JSON file, and their values into a file next to it,
    /// OUTPUT with the extension `values`: --diff then names the first pass that writes other values from equal inputs
    #[arg(long, requires = "output", conflicts_with_all = ["diff", "timings"])]
    pub(crate) hashes: bool,
    /// With --hashes: the largest size of the file of values in MiB; versions that no longer fit have only a hash
    #[arg(
        long,
        value_name = "MIB",
        requires = "hashes",
        default_value_t = 256,
        allow_negative_numbers = true
    )]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=4096))]
    pub(crate) values_mib: u32,
    /// The output file; missing directories are created. Default: standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

impl DumpArgs {
    /// Returns the format, given by name or by the extension of the file.
    ///
    /// # Errors
    /// An unknown extension without a format by name.
    pub(crate) fn format(&self) -> Result<Format, OptionError> {
        if let Some(format) = self.format {
            return Ok(format);
        }
        let extension = self.output.as_ref().and_then(|file| file.extension());
        Ok(match extension.map(|extension| extension.to_string_lossy().to_lowercase()).as_deref() {
            Some("html" | "htm") => Format::Html,
            Some("json") => Format::Json,
            Some("dot" | "gv") => Format::Dot,
            Some("mmd") => Format::Mermaid,
            Some("txt") | None => Format::Text,
            Some(other) => {
                let reason = format!(
                    "unknown extension `.{other}`; expected one of: txt, html, json, dot, mmd; or give --format"
                );
                return Err(OptionError::new("output", reason));
            }
        })
    }
}

/// `shadowgraph view`
#[cfg(feature = "view")]
#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    #[command(flatten)]
    pub(crate) record: RecordArgs,
    /// GPU time budget of the shadow passes in milliseconds; while they exceed it, shadow distance and resolution are lowered
    #[arg(long, value_name = "MS", allow_negative_numbers = true)]
    pub(crate) budget_ms: Option<f64>,
    /// Serve a page about the frames on this port of 127.0.0.1, and print its address; 0 for any free port
    #[arg(long, value_name = "PORT")]
    pub(crate) serve: Option<u16>,
}

/// `shadowgraph nodes`
#[derive(Debug, Args)]
pub(crate) struct NodesArgs {
    /// A pipeline, a node kind or a technique to describe, or `settings` for the settings that all techniques share
    pub(crate) name: Option<String>,
    /// Print the JSON Schema of pipeline files or, if NAME is `settings`, the JSON Schema of settings files
    #[arg(long)]
    pub(crate) schema: bool,
}

/// `shadowgraph explain`
#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// A pass or a resource, by name or path, such as shadows/cascades/clear
    pub(crate) name: String,
    /// Explain why the pass NAME runs before this one
    #[arg(long, value_name = "PASS")]
    pub(crate) before: Option<String>,
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    #[command(flatten)]
    pub(crate) frames: FramesArgs,
}

/// `shadowgraph pixel`
#[derive(Debug, Args)]
pub(crate) struct PixelArgs {
    /// Column and row of the pixel, from the top left: 0,0 is the first
    #[arg(value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    pub(crate) pixel: [u32; 2],
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    #[command(flatten)]
    pub(crate) frames: FramesArgs,
    #[command(flatten)]
    pub(crate) replay: ReplayArgs,
    /// The output file, text or, with the extension json, JSON; missing directories are created. Default: text on standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// `shadowgraph bench`
#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    /// Number of frames to measure, once with the graph and once with hand-written passes
    #[arg(long, value_name = "N", default_value_t = 1000, allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) frames: u32,
    /// Measure whole frames instead, each until the GPU has finished, and each pass, on the GPU of --adapter; at most 20 frames
    #[arg(long, conflicts_with = "moving")]
    pub(crate) whole_frame: bool,
    /// Measure whole frames without one ingredient each instead, such as shadows, textures or ambient light, in turns; at most 20
    /// frames
    #[arg(long, conflicts_with_all = ["moving", "whole_frame", "shaders"])]
    pub(crate) ablate: bool,
    /// Measure the time from the loaded scene to its first image instead, on the GPU of --adapter
    #[arg(long, conflicts_with_all = ["moving", "whole_frame", "ablate"])]
    pub(crate) first_image: bool,
    /// Measure frames of a scene of 10,000 boxes instead, of which these numbers move in each frame, such as 0,1,100,10000
    #[arg(long, value_name = "N,...", value_delimiter = ',', conflicts_with_all = ["scene", "procedural"])]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=10_000))]
    pub(crate) moving: Vec<u32>,
    /// Measure the CPU time of frames instead with a camera that moves by 5 cm in each
    #[arg(long, conflicts_with_all = ["moving", "whole_frame", "ablate", "first_image"])]
    pub(crate) fly: bool,
    /// Measure the CPU time of frames of these numbers of boxes instead, culled by the CPU and by the GPU, with a camera that moves
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    #[arg(conflicts_with_all = ["scene", "procedural", "moving", "whole_frame", "ablate", "first_image", "fly"])]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(crate) boxes: Vec<u32>,
}

/// `shadowgraph measure`
#[derive(Debug, Args)]
pub(crate) struct MeasureArgs {
    /// A glTF or GLB file. Default: the built-in cases
    #[arg(conflicts_with = "cases")]
    pub(crate) scene: Option<PathBuf>,
    /// Shadow techniques (see `nodes`), separated by commas, or all
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', default_value = "pcf")]
    pub(crate) techniques: Vec<String>,
    /// A RON file with scenes, suns and views
    #[arg(long, value_name = "FILE")]
    pub(crate) cases: Option<PathBuf>,
    /// Number of views that are chosen automatically for the SCENE. Default: 4, with --quick or --motion 1
    #[arg(long, value_name = "N", requires = "scene", allow_negative_numbers = true)]
    #[arg(conflicts_with = "cases")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) views: Option<u32>,
    /// A view of the SCENE, as for render; can be repeated. Default: views that are chosen automatically (see --views)
    #[arg(long, value_name = "CAMERA", requires = "scene", conflicts_with = "cases")]
    pub(crate) camera: Vec<String>,
    /// The sun of the SCENE, as for render
    #[arg(long, value_name = "SUN", requires = "scene", conflicts_with = "cases")]
    pub(crate) sun: Option<String>,
    /// A RON file with shadow settings (see `nodes settings`)
    #[arg(long, value_name = "FILE")]
    pub(crate) settings: Option<PathBuf>,
    /// A RON file with named shadow settings to compare with those of --settings
    #[arg(long, value_name = "FILE")]
    pub(crate) variants: Option<PathBuf>,
    /// Shadow distance in metres, or auto for the end of the visible scene. Default: that of --settings, else 150
    #[arg(long, value_name = "auto|M", allow_negative_numbers = true)]
    pub(crate) shadow_distance: Option<String>,
    /// Image size in pixels. Default: 1280x720, with --quick 640x360
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<String>,
    /// The GPU by name; cpu forces a software adapter. Default: auto
    #[arg(long, value_name = "auto|NAME|cpu")]
    pub(crate) adapter: Option<String>,
    /// Measure one light of each scene, and one view unless --views or --camera is given
    #[arg(long)]
    pub(crate) quick: bool,
    /// Measure flicker over 64 frames in every case, and use twice as many rays; takes half an hour without a GPU
    #[arg(long, conflicts_with = "quick")]
    pub(crate) full: bool,
    /// Measure instead how much noise is left after 16 frames of temporal anti-aliasing, for each technique that draws noise,
    /// with one light and one view of each scene at 192x108
    #[arg(long, conflicts_with_all = ["techniques", "variants", "quick", "full", "output", "check"])]
    pub(crate) noise: bool,
    /// The directory for report.html, report.json and the images; created if missing
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// Measure instead how much shadows change over 32 frames beyond the ray-traced truth while the camera walks, the sun turns by
    /// 0.05 degrees a frame, objects move, or each of these; the default size is 480x270. Without --full, one light of each scene,
    /// and one view unless --views or --camera is given
    #[arg(long, value_enum, value_name = "WHAT", conflicts_with_all = ["variants", "check", "quick"])]
    pub(crate) motion: Option<MotionArg>,
    /// A RON file with bounds to check the results against; violations are listed, and the exit code is 1
    #[arg(long, value_name = "FILE")]
    pub(crate) check: Option<PathBuf>,
}

/// What moves, for `measure --motion`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionArg {
    /// The camera
    Camera,
    /// The sun
    Sun,
    /// Instances that are smaller than half of the scene
    Objects,
    /// Each of them, one after the other
    All,
}

/// The format of a dump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Aligned tables
    Text,
    /// Data for tools
    Json,
    /// Graphviz
    Dot,
    /// Mermaid, for Markdown documents
    Mermaid,
    /// A self-contained web page
    Html,
    /// Trace of pass times for chrome://tracing or ui.perfetto.dev
    Trace,
}

/// Parses a version of a texture.
fn stop_at(text: &str) -> Result<(String, u32), String> {
    let parsed =
        text.rsplit_once('@').and_then(|(name, version)| Some((name.to_owned(), version.parse().ok()?)));
    parsed.ok_or_else(|| "expected TEXTURE@VERSION, such as lit@1".into())
}

/// Parses the place of a pixel.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let parsed =
        text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    parsed.ok_or_else(|| "expected X,Y, column and row from the top left, such as 640,360".into())
}

/// Parses frames per second.
fn tolerance(text: &str) -> Result<f64, String> {
    let tolerance = text.parse().ok().filter(|tolerance| (0.0..=1.0).contains(tolerance));
    tolerance.ok_or_else(|| "expected a number from 0 to 1".into())
}

fn frames_per_second(text: &str) -> Result<f64, String> {
    let fps = text.parse().ok().filter(|fps| (0.01..=10_000.0).contains(fps));
    fps.ok_or_else(|| "expected frames per second, 0.01 to 10000".to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::options::Options;
    use super::*;
    use clap::CommandFactory;
    use shadowgraph::Registry;
    use shadowgraph::options::AdapterChoice;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    fn bench(line: &str) -> Result<BenchArgs, String> {
        let words = ["shadowgraph", "bench"].into_iter().chain(line.split_whitespace());
        let cli = Cli::try_parse_from(words).map_err(|error| error.to_string())?;
        let Some(Command::Bench(args)) = cli.command else { panic!("{cli:?}") };
        Ok(args)
    }

    #[test]
    fn bench_measures_a_thousand_frames_without_a_gpu_by_default() {
        let args = bench("").unwrap();
        assert_eq!((args.frames, args.draw.names_adapter()), (1000, false));
        assert_eq!(args.draw.options(&Registry::built_in()).ok(), Some(Options::default()));
    }

    #[test]
    fn bench_accepts_the_drawing_options_and_a_number_of_frames() {
        let args = bench("hall.glb --frames 20 --adapter cpu --size 64x36").unwrap();
        assert_eq!((args.frames, args.draw.names_adapter()), (20, true));
        let Ok(options) = args.draw.options(&Registry::built_in()) else { panic!("{args:?}") };
        assert_eq!((options.adapter, options.size.width_px), (AdapterChoice::Cpu, 64));
        assert_eq!(args.draw.scene, Some(PathBuf::from("hall.glb")));
    }

    #[test]
    fn bench_rejects_zero_and_too_many_frames() {
        for line in ["--frames 0", "--frames 1000001", "--frames -1", "--frames many"] {
            assert!(bench(line).unwrap_err().contains("--frames"), "{line}");
        }
    }

    fn format(line: &str) -> Result<Format, String> {
        let words = ["shadowgraph", "dump"].into_iter().chain(line.split_whitespace());
        let Ok(Cli { command: Some(Command::Dump(args)) }) = Cli::try_parse_from(words) else {
            panic!("{line}")
        };
        args.format().map_err(|error| error.to_string())
    }

    #[test]
    fn the_format_of_a_dump_follows_the_extension_unless_given() {
        for (line, expected) in [
            ("", Format::Text),
            ("-o frame", Format::Text),
            ("-o frame.TXT", Format::Text),
            ("-o a.b/frame.html", Format::Html),
            ("-o frame.log --format json", Format::Json),
        ] {
            assert_eq!(format(line), Ok(expected), "{line}");
        }
        let error = format("-o frame.htlm").unwrap_err();
        assert_eq!(
            error,
            "output: unknown extension `.htlm`; expected one of: txt, html, json, dot, mmd; or give --format"
        );
    }

    #[test]
    fn the_help_names_the_most_useful_commands() {
        let help = Cli::command().render_help().to_string();
        assert!(help.contains("three most useful") && help.contains("shadowgraph dump model.glb"), "{help}");
    }
}
