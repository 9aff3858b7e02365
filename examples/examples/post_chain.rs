//! A chain of passes over a picture, one line each: a blur across, one down, and a mix.
//!
//! `cargo run -p shadowgraph-examples --example post_chain` writes out/post_chain.png.

use shadowgraph::Gpu;
use shadowgraph::core::{Format, Frame, FullscreenShader, Graph, Part, Texture, TextureDesc};
use shadowgraph::options::AdapterChoice;
use shadowgraph::output::{Pixels, write_png};

const SIZE_PX: [u32; 2] = [320, 180];

const LAMPS: &str = "
    @fragment
    fn lamps(@location(0) uv: vec2f) -> @location(0) vec4f {
        let cell = fract(uv * vec2f(8.0, 4.5)) - 0.5;
        let lamp = smoothstep(0.18, 0.14, length(cell));
        let color = 0.5 + 0.5 * cos(6.28 * (uv.x + uv.y + vec3f(0.0, 0.33, 0.67)));
        return vec4f(color * lamp * 3.0 + 0.02, 1.0);
    }";

const BLUR: &str = "
    @group(0) @binding(0) var source: texture_2d<f32>;
    @group(0) @binding(1) var<uniform> along: vec2i;

    @fragment
    fn blur(@builtin(position) position: vec4f) -> @location(0) vec4f {
        let last = vec2i(textureDimensions(source)) - 1;
        var sum = vec4f(0.0);
        for (var i = -12; i <= 12; i++) {
            let weight = exp(-f32(i * i) / 60.0);
            let texel = clamp(vec2i(position.xy) + along * i, vec2i(0), last);
            sum += vec4f(textureLoad(source, texel, 0).rgb, 1.0) * weight;
        }
        return vec4f(sum.rgb / sum.a, 1.0);
    }";

const MIX: &str = "
    @group(0) @binding(0) var sharp: texture_2d<f32>;
    @group(0) @binding(1) var soft: texture_2d<f32>;

    @fragment
    fn join(@builtin(position) position: vec4f) -> @location(0) vec4f {
        let texel = vec2u(position.xy);
        let light = textureLoad(sharp, texel, 0).rgb * 0.6 + textureLoad(soft, texel, 0).rgb * 0.8;
        return vec4f(light / (light + 1.0), 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let [lamps, blur, join] = [("lamps", LAMPS), ("blur", BLUR), ("join", MIX)]
        .map(|(name, text)| FullscreenShader::wgsl(name, text));
    let [width, height] = SIZE_PX;
    let texture = |frame: &mut Frame<'_>, name: &str, format| -> Texture {
        frame.create_texture(name, TextureDesc::d2(width, height, format))
    };
    let along = |x: i32, y: i32| [x, y].map(i32::to_le_bytes).concat();

    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut sharp = texture(&mut frame, "sharp", Format::Rgba16Float);
    frame.fullscreen("lamps", &lamps).draw(&mut sharp);
    let mut across = texture(&mut frame, "across", Format::Rgba16Float);
    frame.fullscreen("across", &blur).sample(&sharp).uniform(&along(1, 0)[..]).draw(&mut across);
    let mut soft = texture(&mut frame, "soft", Format::Rgba16Float);
    frame.fullscreen("down", &blur).sample(&across).uniform(&along(0, 1)[..]).draw(&mut soft);
    let mut picture = texture(&mut frame, "picture", Format::Rgba8UnormSrgb);
    frame.fullscreen("join", &join).sample(&sharp).sample(&soft).draw(&mut picture);
    let texels = frame.read_back_texture(&picture, Part::WHOLE);

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
    let texels = executed.read_back(texels).ok_or("nothing was read")?;
    gpu.queue.submit([encoder.finish()]);
    let bytes = texels.wait(&gpu.device)?;
    Ok(write_png("out/post_chain.png".as_ref(), width, height, Pixels::Rgba, &bytes)?)
}
