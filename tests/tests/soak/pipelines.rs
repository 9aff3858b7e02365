//! Frames in which pipelines, techniques, sizes, lights and objects change.

use super::{ALONE, FRAME_LIMIT, from_env, is_flat, memory_mib, watch};
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::pipelines::Parameters;
use shadowgraph::shadows::Technique;
use shadowgraph::{Gpu, Pipeline, Registry, RenderConfig, Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;
use shadowgraph_tests::random::Random;
use shadowgraph_tests::shares::in_shares;
use shadowgraph_tests::{edits, skip};

/// The default number of frames.
const FRAMES: u32 = 60;

/// The largest number of frames of one process.
const SHARE: u32 = 120;

/// Returns a pipeline file with some of the optional nodes.
fn pipeline(random: &mut Random) -> String {
    let deferred = random.flip();
    let mut nodes = vec![
        format!("(name: \"view\", kind: \"view\", settings: {{\"jitter\": {}}})", random.flip()),
        "(name: \"geometry\", kind: \"geometry\", inputs: {\"view\": \"view\"})".into(),
        format!(
            "(name: \"shadows\", kind: \"shadows\", inputs: {{\"surfaces\": \"geometry\"}}, settings: {{\"screen_space\": {}}})",
            random.flip()
        ),
    ];
    let mut lit_by = "view";
    for (name, kind, inputs) in [
        ("sky", "sky", "\"view\": \"view\""),
        ("clusters", "clusters", "\"view\": [\"sky\", \"view\"]"),
        ("occlusion", "ssao", "\"view\": [\"clusters\", \"view\"], \"depth\": \"geometry\""),
    ] {
        // An optional node before it, or the view.
        let inputs = inputs.replace("[\"sky\", \"view\"]", &format!("\"{lit_by}\""));
        let inputs = inputs.replace("[\"clusters\", \"view\"]", &format!("\"{lit_by}\""));
        if random.flip() {
            nodes.push(format!("(name: \"{name}\", kind: \"{kind}\", inputs: {{{inputs}}})"));
            lit_by = name;
        }
    }
    let lit = format!("\"view\": \"{lit_by}.view\", \"shadows\": \"shadows\", \"depth\": \"geometry\"");
    if deferred {
        nodes.push(
            "(name: \"gbuffer\", kind: \"gbuffer\", inputs: {\"view\": \"view\", \"depth\": \"geometry\"})"
                .into(),
        );
        nodes.push(format!(
            "(name: \"lit\", kind: \"deferred\", inputs: {{{lit}, \"gbuffer\": \"gbuffer\"}})"
        ));
    } else {
        nodes.push(format!("(name: \"lit\", kind: \"forward\", inputs: {{{lit}}})"));
    }
    let mut light = "lit".to_owned();
    for kind in ["fog", "taa", "bloom"] {
        if !random.flip() {
            continue;
        }
        let more = match kind {
            "taa" => ", \"view\": \"view\", \"depth\": \"geometry\", \"velocity\": \"geometry\"",
            "fog" => ", \"view\": \"view\", \"depth\": \"geometry\", \"shadows\": \"shadows\"",
            _ => "",
        };
        let settings = if kind == "fog" { "\"steps\": 4" } else { "" };
        nodes.push(format!(
            "(name: \"{kind}\", kind: \"{kind}\", inputs: {{\"light\": \"{light}.light\"{more}}}, settings: {{{settings}}})"
        ));
        light = kind.into();
    }
    let mut exposure = "";
    if random.flip() {
        nodes.push(format!(
            "(name: \"exposure\", kind: \"auto_exposure\", inputs: {{\"light\": \"{light}.light\"}})"
        ));
        exposure = ", \"exposure\": \"exposure\"";
    }
    nodes.push(format!(
        "(name: \"tonemap\", kind: \"tonemap\", inputs: {{\"light\": \"{light}.light\"{exposure}}})"
    ));
    let mut output = "tonemap";
    if random.flip() {
        nodes.push("(name: \"smooth\", kind: \"fxaa\", inputs: {\"image\": \"tonemap\"})".into());
        output = "smooth";
    }
    format!("(nodes: [{}], outputs: {{\"image\": \"{output}\"}})", nodes.join(",\n"))
}

/// Renders frames of random pipelines, techniques, sizes and lights. `each` is called when the renderer of some frames was dropped,
/// with the quarter of the frames that has been reached.
fn soak(gpu: &Gpu, frames: u32, mut each: impl FnMut(usize)) {
    let Registry { nodes, techniques } = Registry::built_in();
    let kinds = techniques.kinds().iter().map(|kind| kind.name);
    let names: Vec<&str> = kinds.filter(|name| *name != "raytraced").collect();
    let dir = tempfile::tempdir().unwrap();
    let scene = demo_scene();
    let mut random = Random::new(from_env("SHADOWGRAPH_SOAK_SEED", 0));
    let mut drawn = 0;
    let watched = watch(FRAME_LIMIT);
    while drawn < frames {
        let file = dir.path().join("soak.ron");
        let text = pipeline(&mut random);
        std::fs::write(&file, &text).unwrap();
        let pipeline = Pipeline::load(&file, &nodes, &techniques, &Parameters::default())
            .unwrap_or_else(|error| panic!("{error}\n{text}"));
        let name = names[random.below(names.len() as u64) as usize];
        let technique: Technique = techniques.find(name).unwrap();
        let config = RenderConfig { technique: Some(technique), pipeline, ..RenderConfig::default() };
        let mut own = scene.clone();
        let lights = random.below(scene.lights().len() as u64 + 1) as usize;
        own.set_lights(scene.lights()[..lights].to_vec());
        let camera = scene.cameras[random.below(scene.cameras.len() as u64) as usize].clone();
        watched.send(format!("the renderer of frame {drawn}, {name}\n{text}")).unwrap();
        let mut renderer = Renderer::with_config(gpu, own, &camera, Aov::Color, config).unwrap();
        let mut size_px = [256, 144];
        for _ in 0..8 + random.below(16) {
            if random.below(6) == 0 {
                size_px = [1 + random.below(256) as u32, 1 + random.below(144) as u32];
            }
            let mut options = ViewOptions { camera: camera.clone(), size_px, shadows: Default::default() };
            options.shadows.cascades.map_size_px = 512;
            options.shadows.atlas.map_size_px = 512;
            options.shadows.atlas.cache = random.flip();
            for _ in 0..random.below(4) {
                edits::edit(renderer.scene_mut(), &mut random).unwrap();
            }
            watched.send(format!("frame {drawn}, {name}, {size_px:?} px\n{text}")).unwrap();
            let view = renderer.draw(gpu, &options).unwrap_or_else(|error| panic!("{error}, {name}\n{text}"));
            assert_eq!(view.image.rgba8.len(), (size_px[0] * size_px[1] * 4) as usize);
            drawn += 1;
        }
        drop(renderer);
        gpu.device.poll(shadowgraph::wgpu::PollType::wait_indefinitely()).unwrap();
        each((4 * u64::from(drawn) / u64::from(frames)).min(3) as usize);
    }
}

/// On the noop device, the process's memory is that of this project and wgpu: it must not grow. On a software driver, the device's memory
/// must be freed; that of the process is not checked, as Mesa keeps the code of shaders whose pipelines were destroyed.
#[test]
fn changing_pipelines_sizes_techniques_lights_and_objects_leaks_no_memory() {
    let _alone = ALONE.lock();
    let frames = from_env("SHADOWGRAPH_SOAK", FRAMES);
    if frames > SHARE {
        let test = "pipelines::changing_pipelines_sizes_techniques_lights_and_objects_leaks_no_memory";
        return in_shares(test, frames, SHARE);
    }
    let mut most = [0; 4];
    let note = |quarter: usize| most[quarter] = most[quarter].max(memory_mib().unwrap_or_default());
    soak(&Gpu::noop().unwrap(), frames * 2, note);
    println!("soak: peak memory of the process by quarter of {} frames: {most:?} MiB", frames * 2);
    assert!(is_flat(most, 16), "{most:?} MiB");

    let gpu = match Gpu::open(&AdapterChoice::Cpu) {
        Ok(gpu) => gpu,
        Err(error) => return skip("soak", &error.to_string()),
    };
    let allocated =
        || gpu.device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
    let before = allocated();
    let mut renderers = 0;
    soak(&gpu, frames, |_| {
        let now = allocated();
        // wgpu keeps some buffers of 1 MiB in which it validates indirect draws.
        assert!(now <= before + (8 << 20), "{now} bytes are allocated, {before} were before");
        renderers += 1;
    });
    println!(
        "soak: {frames} frames by {renderers} renderers, after each of which the device had its memory back"
    );
}
