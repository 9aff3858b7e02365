//! A chain of passes, one line each: a horizontal blur, a vertical one, and a mix.
//!
//! `cargo run -p shadowgraph-examples --example post_chain` writes out/post_chain.png.

use shadowgraph::Gpu;
use shadowgraph::core::{Format, FullscreenShader, Graph, TextureDesc};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::process::ExitCode;

const LIGHTS: &str = "
    @fragment
    fn lights(@location(0) uv: vec2f) -> @location(0) vec4f {
        let cell = fract(uv * vec2f(8.0, 4.5)) - 0.5;
        let disc = smoothstep(0.18, 0.14, length(cell));
        let color = 0.5 + 0.5 * cos(6.28 * (uv.x + uv.y + vec3f(0.0, 0.33, 0.67)));
        return vec4f(color * disc * 3.0 + 0.02, 1.0);
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

struct Chain {
    graph: Graph,
    shaders: [FullscreenShader; 3],
}

impl Example for Chain {
    const NAME: &'static str = "post_chain";
    const SIZE_PX: [u32; 2] = [320, 180];

    fn new(_gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        let shaders = [("lights", LIGHTS), ("blur", BLUR), ("join", MIX)]
            .map(|(name, text)| FullscreenShader::wgsl(name, text));
        Ok(Self { graph: Graph::new(), shaders })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, .. }: Canvas<'_>) -> Result<(), Failure> {
        let [lights, blur, join] = &self.shaders;
        let desc = TextureDesc::d2(target.width(), target.height(), Format::Rgba16Float);
        let along = |x: i32, y: i32| [x, y].map(i32::to_le_bytes).concat();

        let mut frame = self.graph.frame();
        let mut sharp = frame.create_texture("sharp", desc);
        frame.fullscreen("lights", lights).draw(&mut sharp);
        let mut across = frame.create_texture("across", desc);
        frame.fullscreen("across", blur).sample(&sharp).uniform(&along(1, 0)[..]).draw(&mut across);
        let mut soft = frame.create_texture("soft", desc);
        frame.fullscreen("down", blur).sample(&across).uniform(&along(0, 1)[..]).draw(&mut soft);
        let mut image = frame.import_texture("image", target, false);
        frame.fullscreen("join", join).sample(&sharp).sample(&soft).draw(&mut image);
        self.graph.compile(frame)?.execute(&mut self.graph, &gpu.device, encoder)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Chain>()
}
