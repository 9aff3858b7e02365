//! The shared options of all drawing commands.

use super::options::Options;
use crate::failure::Failure;
use clap::Args;
use shadowgraph::Registry;
use shadowgraph::core::did_you_mean;
use shadowgraph::options::{OptionError, SettingsFile, ShadowDistance, read_tracks};
use shadowgraph::pipelines::{BUILT_IN, Parameters, Pipeline};
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{SettingTracks, ShadowSettings, Technique, Techniques};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The options that all drawing commands share.
#[derive(Clone, Debug, Args)]
pub(crate) struct DrawArgs {
    /// A glTF or GLB file. Default: the built-in demo scene
    pub(crate) scene: Option<PathBuf>,
    /// A procedural scene in place of a file: city:INSTANCES with 10000 to 1000000 instances, city:INSTANCES:SEED, demo, or a test
    /// scene such as cornell
    #[arg(long = "scene", value_name = "NAME", conflicts_with = "scene")]
    pub(crate) procedural: Option<String>,
    /// The variant of the file's materials (KHR_materials_variants). Default: its default materials
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    /// The pipeline: the name of a built-in one (see `nodes`), or a .ron file. Default: forward; for bench minimal_lit
    #[arg(long, value_name = "NAME_OR_FILE")]
    pipeline: Option<String>,
    /// Set a parameter of the pipeline; can be repeated
    #[arg(long = "set", value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// The shadow technique (see `nodes`), such as pcf or pcf+contact
    #[arg(long, value_name = "NAME")]
    technique: Option<String>,
    /// Samples per pixel of colour passes: 1 or 4
    #[arg(long, value_name = "N", default_value_t = 1)]
    samples: u32,
    /// A RON file with shadow settings (see `nodes settings`)
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// A RON file with shadow settings over time (--time) and by the place of the camera
    #[arg(long, value_name = "FILE")]
    tracks: Option<PathBuf>,
    /// Image size in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", allow_hyphen_values = true)]
    size: String,
    /// A camera of the file by index or name, or "eye=X,Y,Z target=X,Y,Z fov_deg=F near=N far=F"
    /// (fov_deg is vertical). Default: the first camera of the file, else one that frames the scene
    #[arg(long, value_name = "CAMERA")]
    camera: Option<String>,
    /// A sun that replaces the file's directional lights: "dir=X,Y,Z lux=L color=R,G,B", where dir is the direction
    /// in which its light travels; "time=HH:MM day=1..366 lat=DEGREES" in place of dir, in true solar time with north -Z and east
    /// +X; or none for no directional lights
    #[arg(long, value_name = "SUN")]
    sun: Option<String>,
    /// The ground under the scene: auto, a plane that receives shadows where the scene has no floor, in colour images by pipelines with
    /// a sky; none; or a square of a colour, #RRGGBB or R,G,B (linear, each 0 to 1), which is part of the scene and 40 of its radii wide
    #[arg(long, value_name = "auto|none|COLOR", default_value = "auto", allow_hyphen_values = true)]
    pub(crate) ground: String,
    /// The background of colour images: sky, the sky of the pipeline; transparent; or a colour, #RRGGBB or R,G,B (linear, each 0 to 1)
    #[arg(long, value_name = "sky|transparent|COLOR", default_value = "sky", allow_hyphen_values = true)]
    background: String,
    /// What culls instances: auto, the GPU in scenes with thousands of instances that share meshes; cpu; or gpu. Images are the same
    #[arg(long, value_name = "auto|cpu|gpu", default_value = "auto")]
    culling: String,
    /// The moment of the animations in seconds; before their start and after their end, the scene stands still
    #[arg(long, value_name = "S", default_value = "0", allow_negative_numbers = true)]
    time: String,
    /// The animations of the file that are played: one by name or index, all or none
    #[arg(long, value_name = "NAME|INDEX|all|none", default_value = "all")]
    animation: String,
    /// Shadow distance in metres, or auto for the end of the visible scene. Default: that of --settings, else auto
    #[arg(long, value_name = "auto|M", allow_negative_numbers = true)]
    shadow_distance: Option<String>,
    /// The image to output: color, visibility:N (of light N), cascade, depth, normal, atlas, of the technique virtual pages and pool, or
    /// the name of a texture of the graph
    #[arg(long, value_name = "NAME", default_value = "color")]
    aov: String,
    /// Lines over the image that show what shadow maps cover: frusta, the slices of the view and the boxes of tiles; spheres, those of
    /// cascades; or tiles, with their borders. With --shadow-camera they are seen from outside
    #[arg(long, value_name = "frusta|spheres|tiles")]
    overlay: Option<String>,
    /// A camera, as for --camera, that shadows are fitted to in place of the one of the image
    #[arg(long, value_name = "CAMERA")]
    shadow_camera: Option<String>,
    /// The GPU by name; cpu forces a software adapter. Default: auto; without this option, bench measures
    /// only the CPU where it need not draw
    #[arg(long, value_name = "auto|NAME|cpu")]
    pub(crate) adapter: Option<String>,
    /// A directory of WGSL files, such as shaders/wgsl of a checkout, that replace the built-in files of the same names. The window
    /// reloads them when they are saved
    #[arg(long, value_name = "DIR")]
    pub(crate) shaders: Option<PathBuf>,
    /// Print a table of CPU and GPU time per pass
    #[arg(long)]
    timings: bool,
}

impl DrawArgs {
    /// Returns the arguments with this pipeline unless one is given.
    pub(crate) fn with_default_pipeline(&self, name: &str) -> Self {
        let pipeline = Some(self.pipeline.clone().unwrap_or_else(|| name.to_owned()));
        Self { pipeline, ..self.clone() }
    }

    /// Returns the arguments with another scene: a file or, without one, a procedural scene or the built-in one.
    pub(crate) fn with_scene(
        &self,
        scene: Option<PathBuf>,
        variant: Option<String>,
        procedural: Option<String>,
    ) -> Self {
        Self { scene, variant, procedural, ..self.clone() }
    }

    /// Returns the name of the scene: its file, or that of a procedural one.
    pub(crate) fn scene_name(&self) -> String {
        match (&self.scene, &self.procedural) {
            (Some(file), _) => file.display().to_string(),
            (None, Some(name)) => name.clone(),
            (None, None) => "the demo scene".into(),
        }
    }

    /// Returns whether an adapter is requested.
    pub(crate) fn names_adapter(&self) -> bool {
        self.adapter.is_some()
    }

    /// Returns the settings file, if given.
    #[cfg(feature = "view")]
    pub(crate) fn settings_file(&self) -> Option<&Path> {
        self.settings.as_deref()
    }

    /// Checks that the lights that the settings name exist in the scene.
    ///
    /// # Errors
    /// One line with the file, the location and the light.
    pub(crate) fn check_lights(&self, settings: &ShadowSettings, scene: &Scene) -> Result<(), OptionError> {
        let wrong = settings.check_lights(scene.lights()).err();
        match (wrong, &self.settings) {
            (Some(error), Some(file)) => Err(SettingsFile::error(file, &error)),
            _ => Ok(()),
        }
    }

    /// Reads the file of settings over time and place; without one, the tracks are empty.
    ///
    /// # Errors
    /// One line with the file, the location and the value.
    fn tracks(&self, settings: &ShadowSettings) -> Result<SettingTracks, OptionError> {
        self.tracks
            .as_deref()
            .map_or_else(|| Ok(SettingTracks::default()), |file| read_tracks(file, settings))
    }

    /// Returns whether times are requested.
    pub(crate) fn times(&self) -> bool {
        self.timings
    }

    /// Parses and checks every option.
    ///
    /// # Errors
    /// One line with the option and the problem of its value.
    pub(crate) fn options(&self, registry: &Registry) -> Result<Options, Failure> {
        let techniques = &registry.techniques;
        let file = settings_file(self.settings.as_deref(), techniques)?;
        let named = self.technique.as_deref().map(|name| technique("technique", name, techniques));
        let shadow_distance = match &self.shadow_distance {
            None if file.has_distance => ShadowDistance::Metres(file.settings.distance_m.into()),
            given => or_default(given.as_deref())?,
        };
        let shadow_camera = self.shadow_camera.as_deref().map(str::parse).transpose();
        Ok(Options {
            pipeline: self.pipeline(registry)?,
            technique: named.transpose()?,
            samples: self.samples,
            tracks: self.tracks(&file.settings)?,
            settings: file.settings,
            size: self.size.parse()?,
            camera: or_default(self.camera.as_deref())?,
            sun: or_default(self.sun.as_deref())?,
            ground: self.ground.parse()?,
            background: self.background.parse()?,
            culling: self.culling.parse()?,
            animation: self.animation.parse()?,
            time: self.time.parse()?,
            shadow_distance,
            aov: self.aov.parse()?,
            overlay: self.overlay.as_deref().map(str::parse).transpose()?,
            shadow_camera: shadow_camera.map_err(|error| OptionError { option: "shadow_camera", ..error })?,
            adapter: or_default(self.adapter.as_deref())?,
            timings: self.timings,
            check_values: None,
        })
    }

    /// Reads and checks the pipeline.
    ///
    /// # Errors
    /// One line with the location and the problem.
    pub(crate) fn pipeline(&self, registry: &Registry) -> Result<Pipeline, OptionError> {
        let parameters = self.set.iter().map(|text| parameter(text)).collect::<Result<_, _>>()?;
        let parameters = Parameters(parameters);
        let name = self.pipeline.as_deref().unwrap_or(BUILT_IN[0]);
        let file = Path::new(name);
        let is_file = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron"));
        let pipeline = if is_file {
            Pipeline::load(file, &registry.nodes, &registry.techniques, &parameters)
        } else if BUILT_IN.contains(&name) {
            Pipeline::built_in(name, &parameters)
        } else {
            let hint = did_you_mean(name, BUILT_IN.iter().copied());
            let reason = format!("unknown pipeline `{name}` (files end in .ron){hint}");
            return Err(OptionError::new("pipeline", reason));
        };
        pipeline.map_err(|error| OptionError::new("pipeline", error.to_string()))
    }

    /// Returns the file of the pipeline, if it is not built in.
    #[cfg(feature = "view")]
    pub(crate) fn pipeline_file(&self) -> Option<&Path> {
        let file = Path::new(self.pipeline.as_deref()?);
        file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")).then_some(file)
    }
}

/// Parses `name=value`, with the value as in a pipeline file; strings need no quotes.
fn parameter(text: &str) -> Result<(String, serde_json::Value), OptionError> {
    let Some((name, value)) = text.split_once('=') else {
        return Err(OptionError::new("set", format!("invalid value `{text}`; expected NAME=VALUE")));
    };
    let value = ron::from_str(value).ok().filter(|value: &serde_json::Value| !value.is_null());
    let text = || serde_json::Value::String(text[name.len() + 1..].to_owned());
    Ok((name.to_owned(), value.unwrap_or_else(text)))
}

/// Reads the file of `--settings`, if given.
///
/// # Errors
/// One line with the file and the problem.
pub(crate) fn settings_file(
    file: Option<&Path>,
    techniques: &Techniques,
) -> Result<SettingsFile, OptionError> {
    file.map_or_else(|| Ok(SettingsFile::default()), |file| SettingsFile::load(file, techniques))
}

/// Returns the technique that an option names.
///
/// # Errors
/// One line with the option and the known names.
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
    use crate::args::{Cli, Command};
    use clap::Parser;
    use shadowgraph::options::{AdapterChoice, AnimationChoice, AnimationTime, Aov};

    fn options(line: &str) -> Result<Options, String> {
        let words =
            ["shadowgraph", "render"].into_iter().chain(line.split(';').filter(|word| !word.is_empty()));
        let cli = Cli::try_parse_from(words).map_err(|error| error.to_string())?;
        let Some(Command::Render(args)) = cli.command else { panic!("{cli:?}") };
        args.draw.options(&Registry::built_in()).map_err(|failure| failure.message)
    }

    #[test]
    fn without_options_the_defaults_apply() {
        assert_eq!(options("").unwrap(), Options::default());
    }

    #[test]
    fn every_option_of_the_design_is_accepted() {
        let line = "scene.glb;--pipeline;forward;--technique;pcf;--size;320x180;--camera;1;--sun;none;\
            --shadow-distance;80;--time;-1.5;--animation;walk;--aov;visibility:1;--adapter;cpu;--timings;-o;a/b.png";
        let options = options(line).unwrap();
        assert_eq!(options.size.to_string(), "320x180");
        assert_eq!(options.aov, Aov::Visibility(1));
        assert_eq!(options.adapter, AdapterChoice::Cpu);
        assert_eq!(options.shadow_distance, ShadowDistance::Metres(80.0));
        assert_eq!(
            (options.animation, options.time),
            (AnimationChoice::Scene("walk".into()), AnimationTime(-1.5))
        );
        assert!(options.timings);
    }

    #[test]
    fn an_invalid_value_is_an_error_of_one_line_with_the_option() {
        for (line, start) in [
            ("--technique;soft", "--technique: unknown technique `soft`; expected one of: pcf, pcss, "),
            ("--pipeline;my.ron", "--pipeline: my.ron: cannot be read: "),
            (
                "--pipeline;mine",
                "--pipeline: unknown pipeline `mine` (files end in .ron); did you mean `minimal`?",
            ),
            ("--size;0x4", "--size: width 0"),
            ("--sun;dir=0,0,0", "--sun: dir must not be zero"),
            ("--time;soon", "--time: invalid value `soon`; expected -1000000000 to 1000000000 seconds"),
            ("--sun;time=12:60 day=1 lat=0", "--sun: invalid value `time=12:60`; expected HH:MM"),
            ("--settings;no/such.ron", "--settings: no/such.ron: cannot be read"),
        ] {
            let error = options(line).unwrap_err();
            assert!(error.starts_with(start) && error.lines().count() == 1, "{error}");
        }
    }

    #[test]
    fn a_procedural_scene_takes_the_place_of_a_file() {
        let draw = |line: &str| {
            let cli = Cli::try_parse_from(["shadowgraph", "render"].into_iter().chain(line.split(';')));
            cli.map(|cli| match cli.command {
                Some(Command::Render(args)) => args.draw,
                other => panic!("{other:?}"),
            })
        };
        assert_eq!(draw("--scene;city:20000").unwrap().scene_name(), "city:20000");
        assert_eq!(draw("a.glb").unwrap().scene_name(), "a.glb");
        assert!(draw("a.glb;--scene;demo").is_err());
    }

    #[test]
    fn the_option_overrides_the_distance_of_the_settings() {
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
    fn tracks_are_read_and_their_errors_have_a_location() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("tracks.ron");
        let line = format!("--tracks;{}", file.display());
        std::fs::write(&file, include_str!("../../../../docs/tracks.ron")).unwrap();
        let tracks = options(&line).unwrap().tracks;
        assert_eq!((tracks.tracks.len(), tracks.zones.len(), tracks.end_s()), (2, 1, 10.0));
        std::fs::write(&file, "(tracks: [\n(setting: \"distance_m\", keys: [(0, -1)])])").unwrap();
        let error = options(&line).unwrap_err();
        let expected =
            "tracks.ron:2:1: invalid value: `tracks.0.distance_m` is -1; allowed: 0.001 to 1000000 (metres)";
        assert!(error.starts_with("--tracks: ") && error.ends_with(expected), "{error}");
    }

    #[test]
    fn a_value_that_starts_with_a_minus_sign_reaches_its_option() {
        let error = options("--shadow-distance;-3").unwrap_err();
        assert!(error.starts_with("--shadow-distance: invalid value `-3`"), "{error}");
    }
}
