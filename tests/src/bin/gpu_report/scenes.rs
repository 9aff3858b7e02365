//! Every technique on the demo scene, the city and files.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::pipelines::Pipeline;
use shadowgraph::scene::{Scene, gltf};
use shadowgraph::shadows::{ShadowSettings, Technique};
use shadowgraph::{Gpu, Registry, RenderConfig, Renderer, ViewOptions};
use shadowgraph_quality::bench::{Stats, WholeFrame, pass_times, whole_frames};
use shadowgraph_samples::city::city;
use shadowgraph_samples::demo::demo_scene;

use crate::data::{SceneData, TechniqueData};
use crate::work::Work;

/// A scene to measure.
pub(crate) struct Source {
    pub(crate) name: String,
    scene: Scene,
}

/// Returns the scenes to measure, a city among them.
///
/// # Errors
/// A file that cannot be loaded.
pub(crate) fn sources(work: &Work) -> Result<Vec<Source>, String> {
    let instances = work.city;
    let mut city = city(instances, 1).ok_or("the city is out of range")?;
    let lights: Vec<_> = city.lights().iter().take(work.city_lights).cloned().collect();
    city.set_lights(lights);
    let mut sources = vec![
        Source { name: "demo".to_owned(), scene: demo_scene() },
        Source { name: format!("city:{instances}"), scene: city },
    ];
    for file in files()? {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        sources.push(Source { name, scene: gltf::load(&file).map_err(|error| error.to_string())? });
    }
    Ok(sources)
}

/// Returns every technique, and the default one with each modifier, with a bare pipeline; and the default pipeline.
fn configurations() -> Vec<(Technique, Pipeline)> {
    let techniques = Registry::built_in().techniques;
    let kinds = techniques.kinds().iter().map(|&kind| Technique::from(kind));
    let modified = [Technique::default().with_screen(), Technique::default().with_contact()];
    let bare = kinds.chain(modified).map(|technique| (technique, Pipeline::minimal_lit()));
    bare.chain([(Technique::default(), Pipeline::forward())]).collect()
}

impl Source {
    /// Measures every technique with a bare pipeline, and the default pipeline with the default technique.
    ///
    /// # Errors
    /// A failure of the GPU.
    pub(crate) fn measure(self, gpu: &Gpu, work: &Work) -> Result<SceneData, String> {
        let Work { size_px, frames, traced_triangles, .. } = *work;
        let Self { name, scene } = self;
        let triangles = |key| scene.mesh(key).map_or(0, |mesh| mesh.indices.len() / 3);
        let mut data = SceneData {
            name,
            instances: scene.instances().len(),
            triangles: scene.instances().map(|(_, instance)| triangles(instance.mesh)).sum(),
            lights: scene.lights().len(),
            techniques: Vec::new(),
            left_out: Vec::new(),
        };
        let options = view(&scene, size_px);
        for (technique, pipeline) in configurations() {
            if technique.name() == "raytraced" && data.triangles > traced_triangles {
                data.left_out.push(format!("raytraced: more than {traced_triangles} triangles"));
                continue;
            }
            let measured = measure_technique(gpu, &scene, &options, (technique, pipeline), frames);
            data.techniques.push(measured.map_err(|error| error.to_string())?);
        }
        Ok(data)
    }
}

/// Returns the view of the scene's first camera, or of one that frames it.
fn view(scene: &Scene, size_px: [u32; 2]) -> ViewOptions {
    let aspect = f64::from(size_px[0]) / f64::from(size_px[1]);
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(aspect));
    let options = ViewOptions { camera, size_px, shadows: ShadowSettings::default() };
    options.with_shadow_distance(ShadowDistance::Auto, scene)
}

fn measure_technique(
    gpu: &Gpu,
    scene: &Scene,
    options: &ViewOptions,
    (technique, pipeline): (Technique, Pipeline),
    frames: u32,
) -> Result<TechniqueData, shadowgraph_quality::Error> {
    let start = Instant::now();
    let (technique_name, pipeline_name) = (technique.name(), pipeline.name().to_owned());
    let config = RenderConfig { technique: Some(technique), ..RenderConfig::from(pipeline) };
    let mut renderer = Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, config)?;
    let whole = whole_frames(gpu, &mut renderer, options, frames)?;
    let passes = pass_times(gpu, &mut renderer, options, frames)?;
    let ms = |time: fn(&WholeFrame) -> Duration| {
        Stats::from_samples(whole.iter().map(|frame| time(frame).as_secs_f64() * 1e3))
    };
    println!("  {technique_name}, {pipeline_name}: {:.1} s", start.elapsed().as_secs_f64());
    Ok(TechniqueData {
        technique: technique_name,
        pipeline: pipeline_name,
        frame_ms: ms(|frame| frame.wall),
        thread_ms: ms(|frame| frame.thread),
        passes,
    })
}

/// Returns the files of the directory `scenes` next to this program, in the order of their names.
fn files() -> Result<Vec<PathBuf>, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let Ok(entries) = std::fs::read_dir(program.with_file_name("scenes")) else { return Ok(Vec::new()) };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|is| is == "glb" || is == "gltf")).collect();
    files.sort();
    Ok(files)
}
