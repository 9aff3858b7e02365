//! `shadowgraph measure`: compares shadows with ray-traced ground truth.

use std::path::{Path, PathBuf};

use super::args::{MeasureArgs, MotionArg, settings_file, technique};
use super::commands;
use super::console;
use super::failure::Failure;
use super::progress::Progress;
use shadowgraph::Gpu;
use shadowgraph::options::{AdapterChoice, CameraChoice, OptionError, Size, SunChoice};
use shadowgraph::output::{Pixels, write_png, write_text};
use shadowgraph::scene::Camera;
use shadowgraph::shadows::{Technique, Techniques};
use shadowgraph_quality::report::{
    Bound, Bounds, CaseReport, ImageFiles, MotionReport, Moving, Report, motion_markdown, motion_table, page,
    table,
};
use shadowgraph_quality::{
    Case, CaseImages, CaseSet, MOTION_FRAMES, MOTION_RAYS, MOTION_SIZE_PX, Measured, MeasuredScene,
    MotionMeasured, MotionTask, Task, Variant, VariantSet, automatic_views, built_in_cases, measure,
    measure_motion,
};

/// Number of views that are chosen automatically for a scene.
const AUTOMATIC_VIEWS: u32 = 4;

/// Directory of the images in the output directory.
const IMAGES: &str = "images";

/// The parsed command line.
struct Plan {
    task: Task,
    adapter: AdapterChoice,
    work: Work,
    bounds: Option<(PathBuf, Bounds)>,
}

/// The scenes to measure.
pub(super) enum Work {
    Cases { cases: Vec<Case>, folder: PathBuf },
    Scene { measured_scene: Box<MeasuredScene>, views_named: bool },
}

/// Measures, prints the table, writes the files, and checks the bounds.
pub(crate) fn measure_command(args: &MeasureArgs, registry: &shadowgraph::Registry) -> Result<(), Failure> {
    let techniques = &registry.techniques;
    if let Some(motion) = args.motion {
        return motion_command(args, motion, techniques);
    }
    let plan = plan(args, techniques)?;
    let gpu = Gpu::open(&plan.adapter).map_err(Failure::no_device)?;
    let output = args.output.as_deref().map(Output::new).transpose()?;
    let progress = Progress::if_slow("measuring");
    let mut report = Report {
        version: Report::VERSION,
        adapter: gpu.adapter.name.clone(),
        size_px: plan.task.size_px,
        settings: plan.task.settings.clone(),
        variants: plan.task.variants.clone(),
        cases: Vec::new(),
    };
    plan.work.each(args.quick, &mut |part, measured_scene| {
        progress.set(&measured_scene.name, part);
        measure(&gpu, measured_scene, &plan.task, &mut |measured: Measured| {
            let Measured { report: mut case, images } = measured;
            if let (Some(output), Some(images)) = (&output, images) {
                case.images = Some(output.write_images(report.cases.len(), &case, &images)?);
            }
            report.cases.push(case);
            Ok(())
        })
    })?;
    drop(progress);
    console::print(&table(&report))?;
    if let Some(output) = output {
        let page = output.finish(&report)?;
        console::print(&format!("\nwrote {}\n", page.display()))?;
    }
    check(&report, plan.bounds.as_ref())
}

/// Measures change along paths, prints the table, and writes the images, the table in Markdown and the report.
fn motion_command(args: &MeasureArgs, motion: MotionArg, known: &Techniques) -> Result<(), Failure> {
    let [width_px, height_px] = MOTION_SIZE_PX;
    let size = args.size.as_deref().map_or(Ok(Size { width_px, height_px }), str::parse)?;
    let task = MotionTask {
        techniques: chosen(&args.techniques, known)?,
        size_px: [size.width_px, size.height_px],
        settings: settings_file(args.settings.as_deref(), known)?.settings,
        distance: args.shadow_distance.as_deref().map(str::parse).transpose()?,
        moving: match motion {
            MotionArg::Camera => vec![Moving::Camera],
            MotionArg::Sun => vec![Moving::Sun],
            MotionArg::Objects => vec![Moving::Objects],
            MotionArg::All => Moving::ALL.to_vec(),
        },
        frames: MOTION_FRAMES,
        soft_rays: MOTION_RAYS,
    };
    let adapter = args.adapter.as_deref().map_or(Ok(AdapterChoice::default()), str::parse)?;
    let work = work(args, size)?;
    let gpu = Gpu::open(&adapter).map_err(Failure::no_device)?;
    let output = args.output.as_deref().map(Output::new).transpose()?;
    let progress = Progress::if_slow("measuring");
    let mut report = MotionReport {
        version: Report::VERSION,
        adapter: gpu.adapter.name.clone(),
        size_px: task.size_px,
        settings: task.settings.clone(),
        cases: Vec::new(),
    };
    work.each(!args.full, &mut |part, measured_scene| {
        progress.set(&measured_scene.name, part);
        measure_motion(&gpu, measured_scene, &task, &mut |measured: MotionMeasured| {
            if let Some(output) = &output {
                output.write_motion(report.cases.len(), &measured, task.size_px)?;
            }
            report.cases.push(measured.report);
            Ok(())
        })
    })?;
    drop(progress);
    if report.cases.is_empty() {
        let message = "--motion: nothing moves; objects are instances smaller than half of the scene".into();
        return Err(Failure { code: Failure::INPUT, message });
    }
    console::print(&motion_table(&report))?;
    if let Some(output) = output {
        write_text(&output.folder.join("motion.md"), &motion_markdown(&report))?;
        write_text(&output.folder.join("motion.json"), &serde_json::to_string_pretty(&report)?)?;
        let folder = output.move_images()?;
        console::print(&format!("\nwrote {}\n", folder.display()))?;
    }
    Ok(())
}

fn plan(args: &MeasureArgs, known: &Techniques) -> Result<Plan, Failure> {
    let size: Size = match &args.size {
        Some(size) => size.parse()?,
        None if args.quick => "640x360".parse()?,
        None => Size::default(),
    };
    let (soft_rays, flicker_frames) = match (args.quick, args.full) {
        (true, _) => (16, 4),
        (_, true) => (64, 64),
        _ => (32, 16),
    };
    let techniques = chosen(&args.techniques, known)?;
    let task = Task {
        techniques,
        size_px: [size.width_px, size.height_px],
        settings: settings_file(args.settings.as_deref(), known)?.settings,
        variants: variants(args.variants.as_deref(), known)?,
        distance: args.shadow_distance.as_deref().map(str::parse).transpose()?,
        soft_rays,
        flicker_frames,
        flicker_everywhere: args.full,
        images: args.output.is_some(),
    };
    let adapter = args.adapter.as_deref().map_or(Ok(AdapterChoice::default()), str::parse)?;
    let names: Vec<_> = task.techniques.iter().map(Technique::name).collect();
    let bounds = bounds(args.check.as_deref(), &names, &task.variants)?;
    Ok(Plan { task, adapter, work: work(args, size)?, bounds })
}

/// Returns the techniques of `--techniques`; `all` is every technique, and the default one with every modifier.
fn chosen(names: &[String], known: &Techniques) -> Result<Vec<Technique>, OptionError> {
    let mut chosen = Vec::new();
    for name in names {
        if name == "all" {
            chosen.extend(known.kinds().iter().map(|&kind| Technique::from(kind)));
            chosen.extend([Technique::default().with_screen(), Technique::default().with_contact()]);
        } else {
            chosen.push(technique("techniques", name, known)?);
        }
    }
    Ok(chosen)
}

/// Returns the scenes to measure.
pub(super) fn work(args: &MeasureArgs, size: Size) -> Result<Work, Failure> {
    if let Some(file) = &args.cases {
        let set = CaseSet::parse(&read("--cases", file)?, file)?;
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        return Ok(Work::Cases { cases: set.cases, folder });
    }
    let Some(file) = &args.scene else {
        return Ok(Work::Cases { cases: built_in_cases()?.cases, folder: PathBuf::new() });
    };
    let mut scene = commands::load(file, None)?;
    scene.notes.iter().for_each(|note| console::warning(note));
    let sun: SunChoice = args.sun.as_deref().map_or(Ok(SunChoice::default()), str::parse)?;
    if let Some(note) = sun.apply(&mut scene) {
        console::warning(&note);
    }
    let view = |choice: &String| -> Result<(String, Camera), OptionError> {
        let camera = choice.parse::<CameraChoice>()?.resolve(&scene, size.aspect())?;
        Ok((camera.name.clone().unwrap_or_else(|| choice.clone()), camera))
    };
    let mut views = args.camera.iter().map(view).collect::<Result<Vec<_>, _>>()?;
    if views.is_empty() {
        views = automatic_views(&scene, args.views.unwrap_or(AUTOMATIC_VIEWS) as usize)?;
    }
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let measured_scene = MeasuredScene::new(name, scene, views)?;
    if measured_scene.lights.is_empty() {
        let message = format!("{}: the scene has no light that casts shadows; see --sun", file.display());
        return Err(Failure { code: Failure::INPUT, message });
    }
    let views_named = args.views.is_some() || !args.camera.is_empty();
    Ok(Work::Scene { measured_scene: Box::new(measured_scene), views_named })
}

impl Work {
    /// Calls `work` for each scene, with the finished fraction of all scenes. If `quick`, only one light of each scene is
    /// measured, and one view unless the user named them.
    pub(super) fn each(
        self,
        quick: bool,
        work: &mut dyn FnMut(f32, &MeasuredScene) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut one = |part: f32, mut measured_scene: MeasuredScene, light: usize, views_named: bool| {
            if quick {
                let last = measured_scene.lights.len().saturating_sub(1);
                measured_scene.lights = measured_scene.lights.split_off(light.min(last));
                measured_scene.lights.truncate(1);
                if !views_named {
                    measured_scene.views.truncate(1);
                }
            }
            work(part, &measured_scene)
        };
        match self {
            // The first light is the sun of `--sun`.
            Self::Scene { measured_scene, views_named } => one(0.0, *measured_scene, 0, views_named),
            Self::Cases { cases, folder } => {
                let count = cases.len() as f32;
                let mut numbered = cases.iter().enumerate();
                numbered.try_for_each(|(index, case)| {
                    // The second sun of a case, which has a medium elevation in the built-in cases.
                    let light = usize::from(!case.sun_elevations_deg.is_empty());
                    one(index as f32 / count, MeasuredScene::from_case(case, &folder)?, light, false)
                })
            }
        }
    }
}

fn variants(file: Option<&Path>, techniques: &Techniques) -> Result<Vec<Variant>, Failure> {
    let Some(file) = file else { return Ok(Vec::new()) };
    Ok(VariantSet::parse(&read("--variants", file)?, file, techniques)?.variants)
}

fn bounds(
    file: Option<&Path>,
    techniques: &[String],
    variants: &[Variant],
) -> Result<Option<(PathBuf, Bounds)>, Failure> {
    let Some(file) = file else { return Ok(None) };
    let bounds = Bounds::parse(&read("--check", file)?, file)?;
    let is_measured = |bound: &Bound| {
        let (technique, variant) = match bound.technique.split_once(": ") {
            Some((technique, variant)) => (technique, Some(variant)),
            None => (bound.technique.as_str(), None),
        };
        techniques.iter().any(|name| name == technique)
            && variant.is_none_or(|variant| variants.iter().any(|known| known.name == variant))
    };
    match bounds.bounds.iter().find(|bound| !is_measured(bound)) {
        None => Ok(Some((file.to_owned(), bounds))),
        Some(Bound { technique, .. }) => {
            let mut measured = format!("--techniques: {}", techniques.join(", "));
            if !variants.is_empty() {
                let names: Vec<&str> = variants.iter().map(|variant| variant.name.as_str()).collect();
                measured = format!("{measured}; --variants: {}", names.join(", "));
            }
            let message = format!("{}: `{technique}` is not among {measured}", file.display());
            Err(Failure { code: Failure::INPUT, message })
        }
    }
}

fn read(option: &str, file: &Path) -> Result<String, Failure> {
    let failed = |error| Failure {
        code: Failure::INPUT,
        message: format!("{option}: {}: cannot be read: {error}", file.display()),
    };
    std::fs::read_to_string(file).map_err(failed)
}

fn check(report: &Report, bounds: Option<&(PathBuf, Bounds)>) -> Result<(), Failure> {
    let Some((file, bounds)) = bounds else { return Ok(()) };
    let violations = bounds.violations(report);
    if violations.is_empty() {
        let count = bounds.bounds.len();
        return console::print(&format!("\nwithin all {count} bounds of {}\n", file.display()));
    }
    let message = format!("violated bounds of {}: {}", file.display(), violations.join("; "));
    Err(Failure { code: Failure::INPUT, message })
}

/// The output directory. Images are written to a temporary directory in it until everything is measured.
struct Output {
    folder: PathBuf,
    temporary: tempfile::TempDir,
}

impl Output {
    fn new(folder: &Path) -> Result<Self, Failure> {
        let failed = |reason: String| Failure {
            code: Failure::INPUT,
            message: format!("-o {}: {reason}", folder.display()),
        };
        if folder.exists() && !folder.is_dir() {
            return Err(failed("is a file; expected a directory".into()));
        }
        let images = folder.join(IMAGES);
        if images.exists() && !images.is_dir() {
            return Err(failed(format!("{IMAGES} in it is a file; expected a directory")));
        }
        let prepared = std::fs::create_dir_all(folder)
            .and_then(|()| tempfile::Builder::new().prefix(".shadowgraph-").tempdir_in(folder));
        let temporary = prepared.map_err(|error| failed(format!("cannot be written: {error}")))?;
        Ok(Self { folder: folder.to_owned(), temporary })
    }

    /// Writes the images of a case, and returns their final paths.
    fn write_images(
        &self,
        index: usize,
        case: &CaseReport,
        images: &CaseImages,
    ) -> Result<ImageFiles, Failure> {
        let name =
            [&case.scene, &case.light, &case.view, &case.technique].map(|name| file_name(name)).join("-");
        let [width, height] = images.compared.size_px;
        let write = |kind: &str, pixels: Pixels, bytes: &[u8]| {
            let file = format!("{index:03}-{name}-{kind}.png");
            write_png(&self.temporary.path().join(&file), width, height, pixels, bytes)?;
            Ok::<_, Failure>(format!("{IMAGES}/{file}"))
        };
        let grey =
            |values: &[f32]| values.iter().map(|value| (value * 255.0).round() as u8).collect::<Vec<_>>();
        Ok(ImageFiles {
            color: write("image", Pixels::Rgba, &images.color.rgba8)?,
            truth: write("truth", Pixels::Grey, &grey(&images.compared.truth))?,
            visibility: write("visibility", Pixels::Grey, &grey(&images.compared.visibility))?,
            difference: write("difference", Pixels::Rgba, &images.compared.errors_rgba8())?,
        })
    }

    /// Writes the image of a path.
    fn write_motion(
        &self,
        index: usize,
        measured: &MotionMeasured,
        [width, height]: [u32; 2],
    ) -> Result<(), Failure> {
        let case = &measured.report;
        let names = [&case.scene, &case.light, &case.view, &case.technique].map(|name| file_name(name));
        let file = format!("{index:03}-{}-{}.png", names.join("-"), case.moving.name());
        write_png(&self.temporary.path().join(file), width, height, Pixels::Rgba, &measured.image_rgba8)?;
        Ok(())
    }

    /// Moves everything to its final location, and returns the path of the page.
    fn finish(self, report: &Report) -> Result<PathBuf, Failure> {
        let folder = self.move_images()?;
        let file = folder.join("report.html");
        let json = serde_json::to_string_pretty(report)?;
        write_text(&folder.join("report.json"), &json)?;
        write_text(&file, &page(report))?;
        Ok(file)
    }

    /// Moves the images to their final location, and returns the output directory.
    fn move_images(self) -> Result<PathBuf, Failure> {
        let failed = |error: std::io::Error| Failure {
            code: Failure::INPUT,
            message: format!("-o {}: cannot be written: {error}", self.folder.display()),
        };
        let images = self.folder.join(IMAGES);
        std::fs::create_dir_all(&images).map_err(failed)?;
        for entry in std::fs::read_dir(self.temporary.path()).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            std::fs::rename(entry.path(), images.join(entry.file_name())).map_err(failed)?;
        }
        Ok(self.folder)
    }
}

/// Returns a name with only those characters that every file system allows.
fn file_name(name: &str) -> String {
    let kept = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    kept.take(40).collect::<String>().trim_matches('_').to_owned()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use shadowgraph::scene::{Light, LightKind, Scene};

    #[test]
    fn a_quick_measurement_of_a_scene_uses_its_sun() {
        let sun = shadowgraph::options::default_sun();
        let point = LightKind::Point { position_world: glam::DVec3::Y, range: None };
        let mut scene = Scene::default();
        scene.insert_light(Light { kind: point, ..sun.clone() });
        let views = vec![("front".to_owned(), scene.framing_camera(1.0))];
        scene.insert_light(sun);
        let measured_scene = Box::new(MeasuredScene::new("scene", scene, views).unwrap());
        let mut seen = Vec::new();
        let work = Work::Scene { measured_scene, views_named: true };
        let each = work.each(true, &mut |_, measured_scene| {
            seen.extend(measured_scene.lights.iter().map(|light| light.name.clone()));
            Ok(())
        });
        assert!(each.is_ok());
        assert_eq!(seen, ["sun 0"]);
    }

    #[test]
    fn names_of_scenes_are_converted_to_file_names() {
        assert_eq!(file_name("sun 30°"), "sun_30");
        assert_eq!(file_name("../a/b"), "a_b");
        assert_eq!(file_name(&"x".repeat(90)).len(), 40);
    }
}
