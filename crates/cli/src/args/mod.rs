//! The command line.

mod draw;
pub(crate) mod options;

pub(crate) use draw::{DrawArgs, settings_file, technique};

use clap::{Args, Parser, Subcommand, ValueEnum};
use shadowgraph::options::OptionError;
use std::path::PathBuf;

const USEFUL: &str = "\
The three most useful commands:
  shadowgraph render model.glb --sun \"dir=-1,-2,-1 lux=20000\" -o out/model.png
  shadowgraph render model.glb --aov visibility:0 -o out/shadow.png
  shadowgraph dump model.glb -o out/frame.html

Without a SCENE the built-in demo scene is taken.";

/// Draws scenes with shadows through a render graph, and shows the graph.
#[derive(Debug, Parser)]
#[command(name = "shadowgraph", version, after_help = USEFUL)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw a glTF or GLB file, or the built-in scene, to a PNG
    Render(RenderArgs),
    /// Show the plan of a frame: passes, resources, and why each is as it is
    Dump(DumpArgs),
    /// Say why a pass or a resource of a frame is as it is
    Explain(ExplainArgs),
    /// List pipelines, kinds of nodes and techniques, or tell all about one of them
    Nodes(NodesArgs),
    /// Look around a scene in a window, with every setting, the graph and its times beside it
    #[cfg(feature = "view")]
    View(ViewArgs),
    /// Measure a frame: the graph beside the same passes encoded by hand, and the time of each pass
    Bench(BenchArgs),
    /// Measure shadows against ray-traced truth: a table, and with -o a page with pictures
    Measure(MeasureArgs),
}

/// `shadowgraph render`
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    /// How many frames are drawn; the last is the picture. One shows nothing of a node that mixes frames, such as taa
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: u32,
    /// The PNG; a missing folder is created
    #[arg(short, long, value_name = "FILE", default_value = "out/render.png")]
    pub(crate) output: PathBuf,
}

/// `shadowgraph dump`
#[derive(Debug, Args)]
pub(crate) struct DumpArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    /// The form of the dump. Default: that of the ending of --output (html, json, dot or mmd), text for txt and without one
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Show what differs between two dumps in JSON, as text, json or html, instead of a frame
    #[arg(long, num_args = 2, value_names = ["A.json", "B.json"], conflicts_with = "DrawArgs")]
    pub(crate) diff: Option<Vec<PathBuf>>,
    /// The file; a missing folder is created. Without it the dump goes to standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

impl DumpArgs {
    /// Returns the form that is asked for, by name or by the ending of the file.
    ///
    /// # Errors
    /// For an ending that names no form where none is asked for by name.
    pub(crate) fn format(&self) -> Result<Format, OptionError> {
        if let Some(format) = self.format {
            return Ok(format);
        }
        let ending = self.output.as_ref().and_then(|file| file.extension());
        Ok(match ending.map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("html" | "htm") => Format::Html,
            Some("json") => Format::Json,
            Some("dot" | "gv") => Format::Dot,
            Some("mmd") => Format::Mermaid,
            Some("txt") | None => Format::Text,
            Some(other) => {
                let reason =
                    format!("`.{other}` is no form of a dump: txt, html, json, dot or mmd, or say --format");
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
    /// A folder of WGSL files that take the place of the built-in ones of the same name, and are read again when they
    /// are saved, such as shaders/wgsl of the checkout
    #[arg(long, value_name = "DIR")]
    pub(crate) shaders: Option<PathBuf>,
}

/// `shadowgraph nodes`
#[derive(Debug, Args)]
pub(crate) struct NodesArgs {
    /// Describe one pipeline, kind of node or technique, or `settings`: its file, or its ports and settings with ranges
    pub(crate) name: Option<String>,
    /// Print the JSON Schema of pipeline files for editors, with `settings` that of settings files
    #[arg(long)]
    pub(crate) schema: bool,
}

/// `shadowgraph explain`
#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// A pass, by its name or with its nodes before it such as shadows/cascades/clear, or a resource likewise
    pub(crate) name: String,
    /// Say why the pass NAME runs before this one
    #[arg(long, value_name = "PASS")]
    pub(crate) before: Option<String>,
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
}

/// `shadowgraph bench`
#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    /// How many frames are measured on either side
    #[arg(long, value_name = "N", default_value_t = 1000, allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) frames: u32,
}

/// `shadowgraph measure`
#[derive(Debug, Args)]
pub(crate) struct MeasureArgs {
    /// A glTF or GLB file; without it the built-in cases
    #[arg(conflicts_with = "cases")]
    pub(crate) scene: Option<PathBuf>,
    /// The shadow techniques, with commas between, or all: those that `nodes` lists
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', default_value = "pcf")]
    pub(crate) techniques: Vec<String>,
    /// Scenes, suns and views in RON
    #[arg(long, value_name = "FILE")]
    pub(crate) cases: Option<PathBuf>,
    /// How many views are chosen for the SCENE
    #[arg(long, value_name = "N", default_value_t = 4, requires = "scene", allow_negative_numbers = true)]
    #[arg(conflicts_with = "cases")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) views: u32,
    /// A view of the SCENE, as for render; can be given several times. Default: --views
    #[arg(long, value_name = "CAMERA", requires = "scene", conflicts_with = "cases")]
    pub(crate) camera: Vec<String>,
    /// The SCENE's sun, as for render
    #[arg(long, value_name = "SUN", requires = "scene", conflicts_with = "cases")]
    pub(crate) sun: Option<String>,
    /// Shadow settings in RON
    #[arg(long, value_name = "FILE")]
    pub(crate) settings: Option<PathBuf>,
    /// Further shadow settings in RON, each with a name, to compare with those of --settings
    #[arg(long, value_name = "FILE")]
    pub(crate) variants: Option<PathBuf>,
    /// How far shadows reach, metres. Default: what the settings say, else 150
    #[arg(long, value_name = "auto|M", allow_negative_numbers = true)]
    pub(crate) shadow_distance: Option<String>,
    /// Size of the pictures, pixels. Default: 1280x720, with --quick 640x360
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<String>,
    /// Which GPU; cpu insists on a software driver. Default: auto
    #[arg(long, value_name = "auto|NAME|cpu")]
    pub(crate) adapter: Option<String>,
    /// One light of each scene, and one view unless --camera names them
    #[arg(long)]
    pub(crate) quick: bool,
    /// Flicker over 64 frames in every case, twice as many rays: half an hour without a GPU
    #[arg(long, conflicts_with = "quick")]
    pub(crate) full: bool,
    /// The folder for report.html, report.json and the pictures; a missing one is created
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// Bounds in RON: what is beyond them is named, and the exit code is 1
    #[arg(long, value_name = "FILE")]
    pub(crate) check: Option<PathBuf>,
}

/// The form of a dump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Aligned tables
    Text,
    /// Data for tools
    Json,
    /// Graphviz
    Dot,
    /// Mermaid, for pages of documents
    Mermaid,
    /// One page that opens in any browser
    Html,
    /// Times of passes for chrome://tracing or ui.perfetto.dev
    Trace,
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
    fn bench_takes_the_options_of_drawing_and_a_number_of_frames() {
        let args = bench("hall.glb --frames 20 --adapter cpu --size 64x36").unwrap();
        assert_eq!((args.frames, args.draw.names_adapter()), (20, true));
        let Ok(options) = args.draw.options(&Registry::built_in()) else { panic!("{args:?}") };
        assert_eq!((options.adapter, options.size.width_px), (AdapterChoice::Cpu, 64));
        assert_eq!(args.draw.scene, Some(PathBuf::from("hall.glb")));
    }

    #[test]
    fn bench_refuses_no_frames_and_too_many() {
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
    fn the_form_of_a_dump_is_that_of_the_files_ending_unless_the_option_says_another() {
        for (line, form) in [
            ("", Format::Text),
            ("-o frame", Format::Text),
            ("-o frame.TXT", Format::Text),
            ("-o a.b/frame.html", Format::Html),
            ("-o frame.log --format json", Format::Json),
        ] {
            assert_eq!(format(line), Ok(form), "{line}");
        }
        let error = format("-o frame.htlm").unwrap_err();
        assert_eq!(
            error,
            "--output: `.htlm` is no form of a dump: txt, html, json, dot or mmd, or say --format"
        );
    }

    #[test]
    fn the_help_names_the_most_useful_commands() {
        let help = Cli::command().render_help().to_string();
        assert!(help.contains("three most useful") && help.contains("shadowgraph dump model.glb"), "{help}");
    }
}
