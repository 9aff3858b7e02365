//! Post-processing after the lit pass.

use crate::stage::{add_mesh, box_mesh, camera, floor_mesh, gpu, material};
use glam::DVec3;
use shadowgraph::core::{Format, Frame, FullscreenShader, Graph, Subresource, TextureDesc};
use shadowgraph::lighting::post::DepthPyramid;
use shadowgraph::options::Aov;
use shadowgraph::pipelines::Parameters;
use shadowgraph::scene::Scene;
use shadowgraph::{Gpu, Pipeline, Registry, RenderConfig, RenderedImage, Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;

/// Returns `forward` with more nodes; `output` is the node whose output is the image.
fn pipeline(view: &str, lit: &str, more: &str, output: &str) -> Pipeline {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("post.ron");
    let text = format!(
        "(nodes: [
            (name: \"view\", kind: \"view\", settings: {{{view}}}),
            (name: \"geometry\", kind: \"geometry\", inputs: {{\"view\": \"view\"}}),
            (name: \"shadows\", kind: \"shadows\", inputs: {{\"surfaces\": \"geometry\"}}),
            (name: \"lighting\", kind: \"forward\", inputs: {{{lit}, \"shadows\": \"shadows\", \"depth\": \"geometry\"}}),
            {more}
        ], outputs: {{\"image\": \"{output}\"}})"
    );
    std::fs::write(&file, text).unwrap();
    let Registry { nodes, techniques } = Registry::built_in();
    Pipeline::load(&file, &nodes, &techniques, &Parameters::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

const VIEW: &str = "\"view\": \"view\"";

fn draw(gpu: &Gpu, pipeline: &Pipeline, aov: Aov, size_px: [u32; 2], frames: u32) -> RenderedImage {
    draw_scene(gpu, demo_scene(), pipeline, (aov, size_px, frames))
}

/// Draws the last of some frames from the first camera of a scene.
fn draw_scene(
    gpu: &Gpu,
    scene: Scene,
    pipeline: &Pipeline,
    (aov, size_px, frames): (Aov, [u32; 2], u32),
) -> RenderedImage {
    let options = ViewOptions { camera: scene.cameras[0].clone(), size_px, shadows: Default::default() };
    let mut renderer = Renderer::with_config(gpu, scene, &options.camera, aov, pipeline.clone()).unwrap();
    let mut image = renderer.draw(gpu, &options).unwrap().image;
    for _ in 1..frames {
        image = renderer.draw(gpu, &options).unwrap().image;
    }
    image
}

fn mean(image: &RenderedImage) -> f64 {
    let values = image.rgba8.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
    values.map(|&value| f64::from(value)).sum::<f64>() / (image.rgba8.len() / 4 * 3) as f64
}

/// Returns the difference between an image and one of four times its width and height, scaled down: root mean square of 255.
fn error(image: &RenderedImage, large: &RenderedImage) -> f64 {
    let [width, height] = image.size_px;
    let mut sum = 0.0;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let own = image.pixel(x, y).unwrap();
        for (channel, value) in own.iter().enumerate().take(3) {
            let of = |at: u32| f64::from(large.pixel(4 * x + at % 4, 4 * y + at / 4).unwrap()[channel]);
            let smooth = (0..16).map(of).sum::<f64>() / 16.0;
            sum += (f64::from(*value) - smooth).powi(2);
        }
    }
    (sum / f64::from(width * height * 3)).sqrt()
}

#[test]
fn anti_aliasing_brings_edges_nearer_to_an_image_of_many_samples() {
    let Some(gpu) = gpu() else { return };
    let tonemap =
        |light: &str| format!("(name: \"tonemap\", kind: \"tonemap\", inputs: {{\"light\": \"{light}\"}}),");
    let plain = pipeline("", VIEW, &tonemap("lighting"), "tonemap");
    let smooth = "(name: \"smooth\", kind: \"fxaa\", inputs: {\"image\": \"tonemap\"})";
    let fxaa = pipeline("", VIEW, &(tonemap("lighting") + smooth), "smooth");
    let taa = |velocity: &str| {
        let mixed = format!(
            "(name: \"mixed\", kind: \"taa\", \
              inputs: {{\"view\": \"view\", \"depth\": \"geometry\", \"light\": \"lighting\"{velocity}}}),"
        );
        pipeline("\"jitter\": true", VIEW, &(mixed + &tonemap("mixed")), "tonemap")
    };
    let (taa, taa_velocity) = (taa(""), taa(", \"velocity\": \"geometry\""));
    let large = draw(gpu, &plain, Aov::Color, [640, 360], 1);
    let of = |pipeline: &Pipeline, frames| error(&draw(gpu, pipeline, Aov::Color, [160, 90], frames), &large);
    let (without, with_fxaa, with_taa) = (of(&plain, 1), of(&fxaa, 1), of(&taa, 16));
    let with_velocity = of(&taa_velocity, 16);
    println!(
        "root mean square: none {without:.2}, fxaa {with_fxaa:.2}, taa {with_taa:.2}, with velocity {with_velocity:.2}"
    );
    assert!(with_fxaa < 0.97 * without && with_taa < 0.75 * without, "{without}, {with_fxaa}, {with_taa}");
    // Nothing moves, so nothing was hidden: motion vectors cost no smoothness.
    assert!(with_velocity < 1.02 * with_taa, "{with_velocity} and {with_taa}");
    // The first frame has no history: it is the rendered image.
    assert!(of(&taa, 1) < 1.3 * without);
}

/// Returns the path of a pipeline of all nodes.
fn everything() -> String {
    shadowgraph_tests::repository().join("docs/everything.ron").display().to_string()
}

#[test]
fn render_writes_the_last_of_the_requested_frames() {
    let Some(_gpu) = gpu() else { return };
    let dir = tempfile::tempdir().unwrap();
    let render = |frames: &str, taa: &str| {
        let (file, pipeline) = (dir.path().join("p.png"), everything());
        let mut command = std::process::Command::new(shadowgraph_tests::program().unwrap());
        command.args([
            "render",
            "--size",
            "160x90",
            "--pipeline",
            &pipeline,
            "--set",
            taa,
            "--animation",
            "none",
            "--frames",
            frames,
        ]);
        let output = command.arg("-o").arg(&file).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read(file).unwrap()
    };
    assert_ne!(render("1", "taa=true"), render("3", "taa=true"));
    assert_eq!(render("1", "taa=false"), render("3", "taa=false"));
}

#[test]
fn render_writes_each_frame_to_a_file_with_a_number_and_the_same_frames_every_time() {
    let Some(_gpu) = gpu() else { return };
    let dir = tempfile::tempdir().unwrap();
    let render = |name: &str, pipeline: &[&str]| {
        let mut command = std::process::Command::new(shadowgraph_tests::program().unwrap());
        let options = ["render", "--size", "96x54", "--technique", "pcss", "--frames", "3", "--fps", "30"];
        command.args(options).args(pipeline).arg("-o").arg(dir.path().join(name)).output().unwrap()
    };
    let frames = |folder: &str| {
        let file = |number: u32| std::fs::read(dir.path().join(format!("{folder}/{number:03}.png"))).unwrap();
        [0, 1, 2].map(file)
    };
    let everything = everything();
    for folder in ["a", "b"] {
        let output = render(&format!("{folder}/%03d.png"), &["--pipeline", &everything, "--set", "taa=true"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stdout).contains("3 frames, 0.10 s, 96x54"));
    }
    let [first, second, third] = frames("a");
    assert!(first != second && second != third);
    assert_eq!([first, second, third], frames("b"));
    let output = render("%3d.png", &[]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), message.lines().count()), (Some(1), 1), "{message}");
}

#[test]
fn bloom_spreads_light_and_conserves_energy() {
    let Some(gpu) = gpu() else { return };
    let bloom = |strength: f32| {
        let more = format!(
            "(name: \"bloom\", kind: \"bloom\", inputs: {{\"light\": \"lighting\"}}, settings: {{\"strength\": {strength:.2}}}),
             (name: \"tonemap\", kind: \"tonemap\", inputs: {{\"light\": \"bloom\"}})"
        );
        draw(gpu, &pipeline("", VIEW, &more, "tonemap"), Aov::Color, [160, 90], 1)
    };
    let (none, some, all) = (bloom(0.0), bloom(0.2), bloom(1.0));
    let plain = draw(gpu, &Pipeline::minimal_lit(), Aov::Color, [160, 90], 1);
    assert!(none == plain && some != plain);
    assert!((mean(&some) / mean(&plain) - 1.0).abs() < 0.05, "{} and {}", mean(&some), mean(&plain));
    // Only spread light: neighbours hardly differ.
    let rough = |image: &RenderedImage| {
        let pairs = image.rgba8.chunks_exact(4).zip(image.rgba8.chunks_exact(4).skip(1));
        pairs.map(|(a, b)| u64::from(a[1].abs_diff(b[1]))).sum::<u64>()
    };
    assert!(rough(&all) * 4 < rough(&plain), "{} and {}", rough(&all), rough(&plain));
}

#[test]
fn corners_are_occluded_and_open_ground_is_not() {
    let Some(gpu) = gpu() else { return };
    let more = "(name: \"occlusion\", kind: \"ssao\", inputs: {\"view\": \"view\", \"depth\": \"geometry\"}),
                (name: \"tonemap\", kind: \"tonemap\", inputs: {\"light\": \"lighting\"})";
    let pipeline = pipeline("", "\"view\": \"occlusion\"", more, "tonemap");
    let occlusion = draw(gpu, &pipeline, Aov::Texture("occlusion".into()), [640, 360], 1);
    let at = |x, y| occlusion.pixel(x, y).unwrap()[0];
    // Tiles in the open and the sky; below the sphere and between steps.
    assert!(at(200, 330) > 240 && at(250, 20) == 255, "{} and {}", at(200, 330), at(250, 20));
    let darkest = (320..356).map(|x| (264..274).map(|y| at(x, y)).min().unwrap()).min().unwrap();
    assert!(darkest < 170, "{darkest}");
    // It darkens, and only ambient light.
    let (with, without) = (
        draw(gpu, &pipeline, Aov::Color, [160, 90], 1),
        draw(gpu, &Pipeline::minimal_lit(), Aov::Color, [160, 90], 1),
    );
    let brighter = with.rgba8.iter().zip(&without.rgba8).filter(|(a, b)| a > b).count();
    assert!(brighter == 0 && mean(&with) < mean(&without) && mean(&with) > 0.8 * mean(&without));
}

#[test]
fn occlusion_along_a_wall_has_no_pattern() {
    let Some(gpu) = gpu() else { return };
    let mut scene = Scene::default();
    scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(20.0), DVec3::ZERO);
    add_mesh(&mut scene, box_mesh(DVec3::new(-20.0, 0.0, -1.0), DVec3::new(20.0, 8.0, 0.0)), DVec3::ZERO);
    scene.cameras.push(camera(DVec3::new(0.0, 1.5, 4.0), DVec3::new(0.0, 0.3, 0.0)));
    let more = "(name: \"occlusion\", kind: \"ssao\", inputs: {\"view\": \"view\", \"depth\": \"geometry\"}),
                (name: \"tonemap\", kind: \"tonemap\", inputs: {\"light\": \"lighting\"})";
    let pipeline = pipeline("", "\"view\": \"occlusion\"", more, "tonemap");
    let image = draw_scene(gpu, scene, &pipeline, (Aov::Texture("occlusion".into()), [320, 180], 1));
    // The wall faces the camera, so a row of pixels has nearly the same occlusion.
    let row = |y| -> Vec<u8> { (60..260).map(|x| image.pixel(x, y).unwrap()[0]).collect() };
    let steps = |row: Vec<u8>| row.windows(2).map(|pair| pair[0].abs_diff(pair[1])).max().unwrap();
    let roughest = (10..170).map(|y| steps(row(y))).max().unwrap();
    let darkest = (10..170).flat_map(row).min().unwrap();
    println!("neighbours differ by at most {roughest} of 255; the darkest is {darkest}");
    assert!(roughest <= 2 && darkest < 225, "{roughest}, {darkest}");
}

#[test]
fn the_sky_is_brighter_at_the_horizon_and_lights_what_is_in_shadow() {
    let Some(gpu) = gpu() else { return };
    let more = "(name: \"sky\", kind: \"sky\", inputs: {\"view\": \"view\"}),
                (name: \"tonemap\", kind: \"tonemap\", inputs: {\"light\": \"lighting\"})";
    let with = draw(gpu, &pipeline("", "\"view\": \"sky\"", more, "tonemap"), Aov::Color, [320, 180], 1);
    let without = draw(gpu, &Pipeline::minimal_lit(), Aov::Color, [320, 180], 1);
    let (high, low) = (with.pixel(30, 4).unwrap(), with.pixel(30, 44).unwrap());
    assert!(low[1] > high[1], "{low:?} and {high:?}");
    // The sun's light is the same, and the light in shadow that of the sky and the ground.
    let lower = |image: &RenderedImage| image.rgba8[4 * 320 * 100..].to_vec();
    let (with, without) = (lower(&with), lower(&without));
    let differ = with.iter().zip(&without).filter(|(a, b)| a.abs_diff(**b) > 4).count();
    assert!(differ as f64 > 0.2 * with.len() as f64, "{differ} of {}", with.len());
}

#[test]
fn fog_is_darker_inside_shadows() {
    let Some(gpu) = gpu() else { return };
    let fog = |technique: &str, settings: &str| {
        let more = format!(
            "(name: \"fog\", kind: \"fog\", settings: {{{settings}}}, inputs: {{\"view\": \"view\", \"shadows\": \"shadows\", \
                \"depth\": \"geometry\", \"light\": \"lighting\"}}),
             (name: \"tonemap\", kind: \"tonemap\", inputs: {{\"light\": \"fog\"}})"
        );
        let technique = Some(Registry::built_in().techniques.find(technique).unwrap());
        let config = RenderConfig {
            technique,
            pipeline: pipeline("", VIEW, &more, "tonemap"),
            ..RenderConfig::default()
        };
        let scene = demo_scene();
        let options =
            ViewOptions { camera: scene.cameras[0].clone(), size_px: [160, 90], shadows: Default::default() };
        let mut renderer = Renderer::with_config(gpu, scene, &options.camera, Aov::Color, config).unwrap();
        renderer.draw(gpu, &options).unwrap().image
    };
    let plain = draw(gpu, &Pipeline::minimal_lit(), Aov::Color, [160, 90], 1);
    assert!(fog("pcf", "\"density\": 0.0") == plain, "fog of density zero changes nothing");
    let thin = "\"density\": 0.03, \"falloff\": 0.0, \"height_m\": 100.0, \"steps\": 48";
    let (with, without) = (fog("pcf", thin), fog("none", thin));
    // Above the walls there is only fog, with the towers' shadows in it.
    let sky =
        |image: &RenderedImage| image.rgba8[..160 * 20 * 4].chunks_exact(4).map(|p| p[1]).collect::<Vec<_>>();
    let (with, without) = (sky(&with), sky(&without));
    let darker = with.iter().zip(&without).filter(|(a, b)| a < b).count();
    let brighter = with.iter().zip(&without).filter(|(a, b)| **a > **b + 1).count();
    assert!(darker > 40 && brighter == 0, "{darker} darker, {brighter} brighter");
}

#[test]
fn each_level_of_the_depth_pyramid_has_the_farthest_depth_below_it() {
    let Some(gpu) = gpu() else { return };
    let slope = FullscreenShader::wgsl(
        "slope",
        "@fragment fn slope(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
            return (floor(at.x) * 3.0 + floor(at.y) * 7.0 + 1.0) / 64.0;
        }",
    );
    let pyramid = DepthPyramid::new(&gpu.device).unwrap();
    let mut graph = Graph::new();
    let mut frame: Frame<'_> = graph.frame();
    let mut depth = frame.create_texture("depth", TextureDesc::d2(5, 3, Format::Depth32Float));
    frame.fullscreen("slope", &slope).draw_depth(&mut depth);
    let levels = pyramid.add_to(&mut frame, &depth);
    let requests: Vec<_> =
        (0..3).map(|level| frame.read_back_texture(&levels, Subresource::FULL.mip(level))).collect();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame).unwrap().execute(&mut graph, &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let read: Vec<Vec<f32>> = requests
        .into_iter()
        .map(|request| {
            let bytes = executed.read_back(request).unwrap().wait(&gpu.device).unwrap();
            bytes.chunks_exact(4).map(|texel| f32::from_le_bytes(texel.try_into().unwrap()) * 64.0).collect()
        })
        .collect();
    let of = |x: u32, y: u32| (x * 3 + y * 7 + 1) as f32;
    assert_eq!(read[0], (0..3).flat_map(|y| (0..5).map(move |x| of(x, y))).collect::<Vec<_>>());
    // 2x1: columns 0 and 1; then 2, 3 and the remaining column.
    assert_eq!(read[1], [of(0, 0), of(2, 0)]);
    assert_eq!(read[2], [of(0, 0)]);
}
