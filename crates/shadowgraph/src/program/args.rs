//! The command line.

use super::failure::Failure;
use crate::Registry;
use crate::nodes::near_words;
use crate::options::{OptionError, Options, SettingsFile, ShadowDistance};
use crate::pipelines::{BUILT_IN, Choices, Pipeline};
use crate::scene::Scene;
use crate::shadows::{ShadowSettings, Technique, Techniques};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};
use std::str::FromStr;

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
                return Err(OptionError::new("--output", reason));
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
    /// A pipeline, a kind of node or a technique, to be told all about: its file, or its ports and settings with ranges
    pub(crate) name: Option<String>,
    /// Print the JSON Schema of pipeline files, for editors
    #[arg(long, conflicts_with = "name")]
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

/// The options that all drawing commands share.
#[derive(Clone, Debug, Args)]
pub(crate) struct DrawArgs {
    /// A glTF or GLB file; without it the built-in demo scene
    pub(crate) scene: Option<PathBuf>,
    /// The pipeline: a built-in one by name (`nodes` lists them), or a .ron file
    #[arg(long, value_name = "NAME_OR_FILE", default_value = "forward")]
    pipeline: String,
    /// A parameter of the pipeline; can be given several times
    #[arg(long = "set", value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// A tier of quality of the pipeline. Default: what its file has for the device
    #[arg(long, value_name = "NAME")]
    tier: Option<String>,
    /// The shadow technique, one of those that `nodes` lists, such as pcf, or pcf+contact
    #[arg(long, value_name = "NAME")]
    technique: Option<String>,
    /// Samples a pixel while colours are drawn: 1 or 4
    #[arg(long, value_name = "N", default_value_t = 1)]
    samples: u32,
    /// Shadow settings in RON
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// Size of the picture, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", allow_hyphen_values = true)]
    size: String,
    /// A camera of the file by index or name, or "eye=X,Y,Z target=X,Y,Z fov_deg=F near=N far=F"
    /// (fov_deg is vertical). Default: the file's first, else one that frames the scene
    #[arg(long, value_name = "CAMERA")]
    camera: Option<String>,
    /// "dir=X,Y,Z lux=L color=R,G,B" replaces the file's directional lights (dir = the way the light
    /// travels); none removes them
    #[arg(long, value_name = "SUN")]
    sun: Option<String>,
    /// How far shadows reach, metres. Default: what --settings says, else auto, as far as the scene is seen
    #[arg(long, value_name = "auto|M", allow_negative_numbers = true)]
    shadow_distance: Option<String>,
    /// What the picture shows: color, visibility:N (light N), cascade, depth, normal, atlas, or a
    /// texture of the graph by name
    #[arg(long, value_name = "NAME", default_value = "color")]
    aov: String,
    /// Which GPU; cpu insists on a software driver. Default: auto; for bench no GPU, only the CPU's share
    #[arg(long, value_name = "auto|NAME|cpu")]
    adapter: Option<String>,
    /// Print a table of CPU and GPU time per pass
    #[arg(long)]
    timings: bool,
}

impl DrawArgs {
    /// Returns whether a GPU is asked for.
    pub(crate) fn names_adapter(&self) -> bool {
        self.adapter.is_some()
    }

    /// Returns the file of settings, if there is one.
    #[cfg(feature = "view")]
    pub(crate) fn settings_file(&self) -> Option<&Path> {
        self.settings.as_deref()
    }

    /// Checks that the scene has the lights that the settings name.
    ///
    /// # Errors
    /// One line with the file, the place and the light.
    pub(crate) fn check_lights(&self, settings: &ShadowSettings, scene: &Scene) -> Result<(), OptionError> {
        let wrong = settings.check_lights(&scene.lights).err();
        match (wrong, &self.settings) {
            (Some(error), Some(file)) => Err(SettingsFile::wrong(file, &error)),
            _ => Ok(()),
        }
    }

    /// Returns whether times are asked for.
    pub(crate) fn times(&self) -> bool {
        self.timings
    }

    /// Parses and checks every option.
    ///
    /// # Errors
    /// One line with the option and what is wrong with its value.
    pub(crate) fn options(&self, registry: &Registry) -> Result<Options, Failure> {
        let techniques = &registry.techniques;
        let file = settings_file(self.settings.as_deref(), techniques)?;
        let named = self.technique.as_deref().map(|name| technique("--technique", name, techniques));
        let shadow_distance = match &self.shadow_distance {
            None if file.has_distance => ShadowDistance::Metres(file.settings.distance_m.into()),
            given => or_default(given.as_deref())?,
        };
        Ok(Options {
            pipeline: self.pipeline(registry)?,
            technique: named.transpose()?,
            samples: self.samples,
            settings: file.settings,
            size: self.size.parse()?,
            camera: or_default(self.camera.as_deref())?,
            sun: or_default(self.sun.as_deref())?,
            shadow_distance,
            aov: self.aov.parse()?,
            adapter: or_default(self.adapter.as_deref())?,
            timings: self.timings,
        })
    }
}

impl DrawArgs {
    /// Reads and checks the pipeline.
    ///
    /// # Errors
    /// One line with the place and what is wrong there.
    pub(crate) fn pipeline(&self, registry: &Registry) -> Result<Pipeline, OptionError> {
        let parameters = self.set.iter().map(|text| parameter(text)).collect::<Result<_, _>>()?;
        let choices = Choices { parameters, tier: self.tier.clone(), device: None };
        let file = Path::new(&self.pipeline);
        let is_file = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron"));
        let pipeline = if is_file {
            Pipeline::load(file, &registry.nodes, &registry.techniques, &choices)
        } else if BUILT_IN.contains(&self.pipeline.as_str()) {
            Pipeline::built_in(&self.pipeline, &choices)
        } else {
            let near = near_words(&self.pipeline, BUILT_IN.iter().copied());
            let reason = format!("there is no pipeline `{}` (files end in .ron){near}", self.pipeline);
            return Err(OptionError::new("--pipeline", reason));
        };
        pipeline.map_err(|error| OptionError::new("--pipeline", error.to_string()))
    }

    /// Returns the pipeline's file, if it is one.
    #[cfg(feature = "view")]
    pub(crate) fn pipeline_file(&self) -> Option<&Path> {
        let file = Path::new(&self.pipeline);
        file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron")).then_some(file)
    }
}

/// `name=value`, the value as a pipeline file has it; a text needs no quotes.
fn parameter(text: &str) -> Result<(String, serde_json::Value), OptionError> {
    let Some((name, value)) = text.split_once('=') else {
        return Err(OptionError::new("--set", format!("`{text}` is not NAME=VALUE")));
    };
    let value = ron::from_str(value).ok().filter(|value: &serde_json::Value| !value.is_null());
    let text = || serde_json::Value::String(text[name.len() + 1..].to_owned());
    Ok((name.to_owned(), value.unwrap_or_else(text)))
}

/// Reads `--settings`, if there are any.
///
/// # Errors
/// One line with the file and what is wrong in it.
pub(crate) fn settings_file(
    file: Option<&Path>,
    techniques: &Techniques,
) -> Result<SettingsFile, OptionError> {
    file.map_or_else(|| Ok(SettingsFile::default()), |file| SettingsFile::load(file, techniques))
}

/// Finds a technique that an option names.
///
/// # Errors
/// One line with the option and the names there are.
pub(crate) fn technique(
    option: &'static str,
    name: &str,
    techniques: &Techniques,
) -> Result<Technique, OptionError> {
    techniques.find(name).map_err(|error| OptionError::new(option, error.to_string()))
}

fn or_default<T: FromStr<Err = OptionError> + Default>(text: Option<&str>) -> Result<T, OptionError> {
    text.map_or_else(|| Ok(T::default()), str::parse)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;
    use crate::options::{AdapterChoice, Aov};
    use clap::CommandFactory;

    fn options(line: &str) -> Result<Options, String> {
        let words =
            ["shadowgraph", "render"].into_iter().chain(line.split(';').filter(|word| !word.is_empty()));
        let cli = Cli::try_parse_from(words).map_err(|error| error.to_string())?;
        let Some(Command::Render(args)) = cli.command else { panic!("{cli:?}") };
        args.draw.options(&Registry::built_in()).map_err(|failure| failure.message)
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn no_option_at_all_means_the_defaults() {
        assert_eq!(options("").unwrap(), Options::default());
    }

    #[test]
    fn every_option_of_the_design_is_taken() {
        let line = "scene.glb;--pipeline;forward;--technique;pcf;--size;320x180;--camera;1;--sun;none;\
            --shadow-distance;80;--aov;visibility:1;--adapter;cpu;--timings;-o;a/b.png";
        let options = options(line).unwrap();
        assert_eq!(options.size.to_string(), "320x180");
        assert_eq!(options.aov, Aov::Visibility(1));
        assert_eq!(options.adapter, AdapterChoice::Cpu);
        assert_eq!(options.shadow_distance, ShadowDistance::Metres(80.0));
        assert!(options.timings);
    }

    #[test]
    fn a_wrong_value_is_one_line_with_the_option() {
        for (line, start) in [
            ("--technique;soft", "--technique: there is no technique `soft`; there is: pcf, pcss, "),
            ("--pipeline;my.ron", "--pipeline: my.ron: cannot be read: "),
            (
                "--pipeline;mine",
                "--pipeline: there is no pipeline `mine` (files end in .ron); did you mean `minimal`?",
            ),
            ("--size;0x4", "--size: the width 0"),
            ("--sun;dir=0,0,0", "--sun: dir has no length"),
            ("--settings;no/such.ron", "--settings: no/such.ron: cannot be read"),
        ] {
            let error = options(line).unwrap_err();
            assert!(error.starts_with(start) && error.lines().count() == 1, "{error}");
        }
    }

    #[test]
    fn the_distance_of_the_settings_holds_unless_the_option_says_another() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("settings.ron");
        std::fs::write(&file, "(distance_m: 60.0)").unwrap();
        let line = format!("--settings;{}", file.display());
        assert_eq!(options(&line).unwrap().shadow_distance, ShadowDistance::Metres(60.0));
        assert_eq!(
            options(&format!("{line};--shadow-distance;auto")).unwrap().shadow_distance,
            ShadowDistance::Auto
        );
    }

    #[test]
    fn a_value_that_starts_with_a_minus_sign_reaches_its_option() {
        let error = options("--shadow-distance;-3").unwrap_err();
        assert!(error.starts_with("--shadow-distance: `-3` is neither auto"), "{error}");
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
