//! The page for browsers, in Chromium on SwiftShader.

mod server;

use crate::browser::{self, Page};
use crate::drivers;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use image::RgbaImage;
use serde_json::json;
use server::{Files, serve};
use shadowgraph::shadows::{RAYTRACED, Techniques};
use shadowgraph_tests::{animated, copies, features, program, repository, shared, skip};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Width and height of the compared images, pixels.
const SIZE_PX: [u32; 2] = [256, 144];
/// Those of images that take a software driver seconds.
const SMALL_PX: [u32; 2] = [128, 72];
/// Pixels of which a channel differs by more are counted.
const DIFFERENCE: u8 = 8;
/// The part of the pixels that may.
const MAX_DIFFERENT: f64 = 1e-3;
/// Modifiers that are compared besides the techniques.
const MODIFIED: [&str; 2] = ["pcf+contact", "pcf+screen"];

/// Real scenes that are compared.
const REAL_SCENES: [&str; 3] = ["CesiumMilkTruck.glb", "kaykit_dungeon_hall.glb", "retroufo.glb"];

/// A page with a canvas that draws only on request.
const CANVAS: &str = r#"<!doctype html>
<canvas width="256" height="144"></canvas>
<script type="module">
  import init, { Model, Viewer } from "./shadowgraph_web.js";
  await init();
  const viewer = await Viewer.create(document.querySelector("canvas"));
  const image = async () => {
    viewer.draw(0);
    const pixels = await viewer.pixels();
    let text = "";
    for (let start = 0; start < pixels.length; start += 32768) {
      text += String.fromCharCode(...pixels.subarray(start, start + 32768));
    }
    const error = viewer.takeError();
    if (error) throw new Error(error);
    return btoa(text);
  };
  Object.assign(globalThis, { Model, viewer, image });
</script>
"#;

/// Returns the directory of the page that `cargo xtask test` builds before the tests.
fn built() -> Option<PathBuf> {
    let built = std::env::var_os("SHADOWGRAPH_WEB").map(PathBuf::from);
    if built.is_none() {
        skip(
            "web",
            "the page is not built: `cargo xtask test` builds it, and names its directory in SHADOWGRAPH_WEB",
        );
    }
    built.filter(|_| browser::installed().is_some())
}

/// Opens a page of a server with these files besides those of the built page.
fn open(path: &str, files: impl IntoIterator<Item = (&'static str, Vec<u8>)>) -> Option<Page> {
    let memory: HashMap<_, _> = files.into_iter().map(|(path, bytes)| (path.to_owned(), bytes)).collect();
    let address = serve(Files { directory: built()?, memory });
    Page::open_with_webgpu(&format!("{address}/{path}"))
}

/// Opens the page with a canvas.
fn open_canvas(files: impl IntoIterator<Item = (&'static str, Vec<u8>)>) -> Option<Page> {
    let canvas = ("canvas.html", CANVAS.as_bytes().to_vec());
    let mut page = open("canvas.html", files.into_iter().chain([canvas]))?;
    page.until("globalThis.image");
    Some(page)
}

/// Returns the image that the page shows.
fn image(page: &mut Page, [width, height]: [u32; 2]) -> RgbaImage {
    page.value(&format!("viewer.resize({width}, {height})"));
    let text = page.value("image()");
    let bytes = BASE64_STANDARD.decode(text.as_str().unwrap()).unwrap();
    RgbaImage::from_raw(width, height, bytes).unwrap()
}

/// Renders with the program `shadowgraph`, on the driver that Chromium brings along.
fn render(arguments: &[&str], [width, height]: [u32; 2], folder: &Path, file: &str) {
    let mut command = Command::new(program().unwrap());
    command.args(["render", "--size", &format!("{width}x{height}"), "-o"]).arg(folder.join(file));
    let output = command.args(arguments).env("VK_DRIVER_FILES", drivers::manifest(folder)).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Returns the image of the program.
fn native(folder: &Path, arguments: &[&str], size_px: [u32; 2]) -> RgbaImage {
    render(arguments, size_px, folder, "native.png");
    image::open(folder.join("native.png")).unwrap().to_rgba8()
}

/// Checks that an image of the page is that of the program, but for few pixels.
fn assert_same(name: &str, web: &RgbaImage, native: &RgbaImage) {
    let pixels = web.pixels().zip(native.pixels());
    let differs = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).take(3).any(|(a, b)| a.abs_diff(b) > DIFFERENCE)
    };
    let [count, all] = [pixels.filter(differs).count(), web.pixels().len()];
    println!("{name}: {count} of {all} pixels differ");
    let lit = web.pixels().filter(|pixel| pixel.0[..3] != [0; 3]).count();
    assert!(lit > all / 2, "{name}: {lit} of {all} pixels are not black");
    assert!(count as f64 <= all as f64 * MAX_DIFFERENT, "{name}: {count} of {all} pixels differ");
}

fn has_swiftshader() -> bool {
    let is_installed = Path::new(drivers::SWIFTSHADER).exists();
    if !is_installed {
        skip("drivers", "SwiftShader is not installed");
    }
    is_installed
}

#[test]
fn every_technique_draws_the_image_of_the_program() {
    if !has_swiftshader() {
        return;
    }
    let Some(mut page) = open_canvas([]) else { return };
    let folder = tempfile::tempdir().unwrap();
    let techniques = Techniques::built_in();
    let names: Vec<_> = techniques.kinds().iter().map(|kind| kind.name).chain(MODIFIED).collect();
    let size_px = |name: &str| if name == RAYTRACED.name { SMALL_PX } else { SIZE_PX };
    std::thread::scope(|scope| {
        // Both mostly compile shaders, on one thread each.
        let natives = scope.spawn(|| {
            let of = |name: &&str| native(folder.path(), &["--technique", name], size_px(name));
            names.iter().map(of).collect::<Vec<_>>()
        });
        let mut of = |name: &&str| {
            page.value(&format!("viewer.technique = {}", json!(name)));
            image(&mut page, size_px(name))
        };
        let images: Vec<_> = names.iter().map(&mut of).collect();
        for (name, (web, native)) in names.iter().zip(images.iter().zip(&natives.join().unwrap())) {
            assert_same(name, web, native);
        }
    });
    page.close();
}

#[test]
fn files_of_the_web_draw_the_images_of_the_program() {
    if !has_swiftshader() {
        return;
    }
    let mut scenes = vec![
        ("vase.glb", (features::PLAIN.file)().glb()),
        ("column.glb", (animated::SKINNED.file)().glb()),
        ("boxes.glb", copies::copies(300).glb()),
    ];
    match shared("scenes") {
        Some(real) => scenes.extend(REAL_SCENES.map(|name| (name, std::fs::read(real.join(name)).unwrap()))),
        None => skip("scenes", "the collection of real scenes is missing (SHADOWGRAPH_SHARED)"),
    }
    let Some(mut page) = open_canvas(scenes.clone()) else { return };
    let folder = tempfile::tempdir().unwrap();
    page.value("globalThis.parts = []");
    for (name, bytes) in scenes {
        page.value(&format!(
            "Model.fetch({}, (part, name) => parts.push([part, name])).then(model => viewer.show(model))",
            json!(name)
        ));
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let native = native(folder.path(), &[file.to_str().unwrap()], SIZE_PX);
        assert_same(name, &image(&mut page, SIZE_PX), &native);
    }
    assert_eq!(page.value("parts.every(([part]) => part >= 0 && part <= 1) && parts[0][1]"), "vase.glb");
    let missing = page.value("Model.fetch('none.glb').then(() => 'loaded', error => error.message)");
    assert!(missing.as_str().unwrap().contains("none.glb: the server answers 404"), "{missing}");
    page.close_after("none.glb");
}

/// Frames that are measured, after one that compiles the shaders.
const FRAMES: u32 = 6;

/// Returns the median time of a frame of the page, milliseconds.
fn web_frame_ms(page: &mut Page) -> f64 {
    let measure = format!(
        "(async () => {{ const times = []; \
         for (let frame = 0; frame <= {FRAMES}; frame++) {{ \
           const begun = performance.now(); viewer.draw(frame / 10000); await viewer.finished(); times.push(performance.now() - begun); \
         }} return times.slice(1).sort((a, b) => a - b)[{FRAMES} / 2]; }})()"
    );
    page.value(&measure).as_f64().unwrap()
}

/// Returns the mean time of a frame of the program after the first one, milliseconds, from the times at which images are written.
fn native_frame_ms(folder: &Path) -> f64 {
    render(&["--fps", "10000", "--frames", &(1 + FRAMES).to_string()], SIZE_PX, folder, "%04d.png");
    let written = |frame: u32| folder.join(format!("{frame:04}.png")).metadata().unwrap().modified().unwrap();
    written(FRAMES).duration_since(written(0)).unwrap().as_secs_f64() * 1e3 / f64::from(FRAMES)
}

/// Other tests run at the same time, so the limit is high: alone, the page needs at most 1.3 times as long.
#[test]
fn a_frame_takes_little_longer_than_in_the_program() {
    if !has_swiftshader() {
        return;
    }
    let Some(mut page) = open_canvas([]) else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut ratio = || {
        let (web_ms, native_ms) = (web_frame_ms(&mut page), native_frame_ms(folder.path()));
        println!("{web_ms:.0} ms in the page, {native_ms:.0} ms in the program: {:.2}", web_ms / native_ms);
        web_ms / native_ms
    };
    let ratios = [ratio(), ratio()];
    assert!(ratios[0].min(ratios[1]) < 2.0, "{ratios:?}");
    page.close();
}

#[test]
fn the_page_has_a_control_for_everything() {
    let Some(mut page) = open("index.html?model=none.glb", []) else { return };
    page.until("globalThis.viewer && document.getElementById('status').textContent.includes('none.glb: the server answers 404')");
    // A small image, which stands still.
    page.value(
        "document.getElementById('stage').style.width = '256px'; document.getElementById('play').click()",
    );
    // A file that is no glTF.
    let drop = |name: &str, text: &str| {
        format!(
            "(() => {{ const all = new DataTransfer(); all.items.add(new File([{}], {})); \
             dispatchEvent(new DragEvent('drop', {{ dataTransfer: all, cancelable: true }})); }})()",
            json!(text),
            json!(name)
        )
    };
    page.value(&drop("cat.png", "a drawing of a cat"));
    page.until("document.getElementById('status').textContent.includes('cat.png: file: is not glTF')");
    // The next choice takes its error away.
    page.value("document.getElementById('demo').click()");
    assert_eq!(page.value("document.getElementById('status').textContent"), "");
    // And one that is.
    page.value(&drop("empty.gltf", r#"{"asset": {"version": "2.0"}, "scenes": [{}]}"#));
    page.until(
        "document.getElementById('status').textContent === '' && !document.getElementById('notes').hidden",
    );
    // Errors of pipelines are shown at their line.
    page.value(
        "document.querySelector('[data-tab=pipeline]').click(); \
         document.getElementById('text').value = '(\\n  nodes: [],\\n  nonsense: 1,\\n)'; \
         document.getElementById('apply').click()",
    );
    page.until("document.querySelector('#lines mark')?.textContent === '3'");
    assert!(
        page.value("document.getElementById('pipeline-error').textContent")
            .as_str()
            .unwrap()
            .contains("nonsense")
    );
    // The text stays while another pipeline is looked at.
    page.value(
        "globalThis.list = document.getElementById('pipelines'); list.value = 'deferred'; list.onchange()",
    );
    assert_eq!(
        page.value("viewer.pipeline + document.getElementById('pipeline-error').textContent"),
        "deferred"
    );
    page.value("list.value = ''; list.onchange()");
    assert!(
        page.value(
            "document.getElementById('text').value.includes('nonsense') && viewer.pipeline === 'deferred'"
        ) == true
    );
    // Every setting has a field; a value out of range is refused with the range.
    page.value("document.querySelector('[data-tab=settings]').click()");
    assert!(page.value("document.querySelectorAll('#fields .field').length").as_u64().unwrap() > 60);
    let set = |name: &str, value: &str| {
        format!(
            "(() => {{ const field = document.getElementById('setting-{name}'); field.value = {}; field.onchange(); \
             return field.parentElement.querySelector('.error').textContent; }})()",
            json!(value)
        )
    };
    let refused = page.value(&set("cascades-count", "9"));
    assert!(refused.as_str().unwrap().contains("0 to 8"), "{refused}");
    // It stays where it is, and does not spoil others.
    assert_eq!(page.value(&set("distance_m", "20")), "");
    assert_eq!(page.value(&set("distance_m", "")), "");
    assert_eq!(page.value(&set("cascades-count", "2")), "");
    // One that another one made invalid is accepted once that has changed.
    assert_eq!(page.value(&set("techniques-evsm-blur_texels", "4")), "");
    assert_ne!(page.value(&set("techniques-evsm-downscale", "4")), "");
    assert_eq!(page.value(&set("techniques-evsm-blur_texels", "1")), "");
    assert_eq!(
        page.value(
            "[...document.querySelectorAll('#fields .error')].map(({ textContent }) => textContent).join('')"
        ),
        ""
    );
    // Settings are found by their path.
    page.value("globalThis.filter = document.getElementById('filter'); filter.value = 'cascades.map_size'; filter.oninput()");
    assert_eq!(page.value("[...document.querySelectorAll('.field:not([hidden]) label')].map(({ htmlFor }) => htmlFor).join()"), "setting-cascades-map_size_px");
    // A modifier.
    page.value(
        "(() => { const select = document.getElementById('modifier'); select.value = '+contact'; select.onchange(); })()",
    );
    assert_eq!(page.value("viewer.technique"), "pcf+contact");
    // The times of passes, and the graph.
    page.value("document.querySelector('[data-tab=passes]').click()");
    page.until("document.getElementById('times').rows.length > 5");
    page.value("document.querySelector('[data-tab=graph]').click()");
    page.until(
        "document.getElementById('frame').src.startsWith('blob:') && viewer.graphPage().includes('tonemap')",
    );
    // A comparison.
    page.value(
        "(() => { const select = document.getElementById('compared'); select.value = 'none'; select.onchange(); })()",
    );
    page.until("!document.getElementById('split').hidden && document.getElementById('right-name').textContent === 'none'");
    assert!(page.value("viewer.takeError() ?? ''") == "");
    page.close_after("none.glb");
}

#[test]
fn a_page_that_loses_its_device_opens_another_one() {
    let Some(mut page) = open("index.html", []) else { return };
    page.until("globalThis.viewer && document.getElementById('status').textContent === ''");
    page.value("document.getElementById('stage').style.width = '256px'");
    page.value(
        "globalThis.recovered = 0; const recover = viewer.recover.bind(viewer); \
         viewer.recover = () => recover().then(() => { recovered++; })",
    );
    let drawn = "viewer.pixels().then(pixels => pixels.some((value, index) => index % 4 < 3 && value > 32))";
    page.value("viewer.release()");
    page.until("recovered === 1 && document.getElementById('status').textContent === ''");
    assert_eq!(page.value(drawn), true);
    page.crash_gpu();
    page.until("recovered === 2 && document.getElementById('status').textContent === ''");
    assert_eq!(page.value(drawn), true);
    page.close_after("A valid external Instance reference no longer exists.");
}

#[test]
fn a_browser_without_webgpu_is_an_error_of_one_line() {
    let Some(directory) = built() else { return };
    let address = serve(Files { directory, memory: HashMap::new() });
    let Some(mut page) = Page::open(&format!("{address}/index.html")) else { return };
    page.until("document.getElementById('status').textContent.includes('this browser has no WebGPU')");
    page.close_after("No available adapters.");
}

#[test]
fn the_page_of_the_documents_works() {
    let text = std::fs::read_to_string(repository().join("docs/web.md")).unwrap();
    let example = text.split("```html\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    assert!(example.lines().count() <= 30, "{} lines", example.lines().count());
    // The test needs the viewer, which is a constant of the module.
    let shown = "viewer.technique = \"pcss+contact\";";
    assert!(example.contains(shown));
    let example = example.replace(shown, &format!("{shown} globalThis.viewer = viewer;"));
    let scene = (features::PLAIN.file)().glb();
    let Some(mut page) = open("own.html", [("own.html", example.into_bytes()), ("scene.glb", scene)]) else {
        return;
    };
    page.until(
        "globalThis.viewer && document.getElementById('status').textContent === '' && viewer.graphPage()",
    );
    assert_eq!(page.value("viewer.takeError() ?? ''"), "");
    page.close();
}
