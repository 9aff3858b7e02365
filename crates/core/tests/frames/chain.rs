//! A chain with fan-in: each pass draws one triangle, and samples the result of the previous pass and up to two earlier
//! textures.

use shadowgraph_core::{
    Contents, Format, Frame, Pass, Rendering, Texture, TextureDesc, TextureToken, TextureUsages,
};

/// Maximum number of textures that a pass samples.
pub(crate) const FAN_IN: usize = 3;

/// Maximum distance in passes between drawing and sampling a texture.
const WINDOW: usize = 8;

pub(crate) const FORMAT: Format = Format::Rgba8Unorm;

/// The first texture is imported and only sampled; the second is imported too and holds the result.
pub(crate) const SOURCE: usize = 0;
pub(crate) const RESULT: usize = 1;

/// A chain as plain data. Textures are numbered in the order in which they are declared.
pub(crate) struct Chain {
    pub(crate) textures: Vec<String>,
    pub(crate) passes: Vec<ChainPass>,
}

pub(crate) struct ChainPass {
    pub(crate) name: String,
    pub(crate) target: usize,
    /// Whether the target is cleared first; otherwise it is preserved.
    pub(crate) clears: bool,
    /// Sampled textures, at least one and at most [`FAN_IN`].
    pub(crate) samples: Vec<usize>,
}

pub(crate) fn desc() -> TextureDesc {
    TextureDesc::d2(1280, 720, FORMAT)
}

impl Chain {
    /// Creates a chain of `length` passes, always the same one.
    pub(crate) fn new(length: usize) -> Self {
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        let mut chain = Self { textures: vec!["source".into(), "result".into()], passes: Vec::new() };
        let mut recent = vec![SOURCE];
        for index in 0..length {
            let samples = pick(&recent, &mut random);
            let unused: Vec<usize> = recent
                .iter()
                .copied()
                .filter(|texture| *texture != SOURCE && !samples.contains(texture))
                .collect();
            let last = index + 1 == length;
            let over = !last && !unused.is_empty() && random.below(4) == 0;
            let target = match over {
                _ if last => RESULT,
                true => unused[random.below(unused.len())],
                false => chain.textures.len(),
            };
            if target == chain.textures.len() {
                chain.textures.push(format!("texture {target}"));
            }
            chain.passes.push(ChainPass { name: format!("pass {index}"), target, clears: !over, samples });
            recent.retain(|&texture| texture != target);
            recent.push(target);
            if recent.len() > WINDOW {
                recent.remove(0);
            }
        }
        chain
    }

    /// Declares the chain's frame and gives each pass with its tokens to `draw`. `red` is part of every clear value.
    /// `handles` is scratch memory.
    pub(crate) fn declare<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        handles: &mut Vec<Texture>,
        red: f64,
        import: impl Fn(&mut Frame<'f>, usize) -> Texture,
        mut draw: impl FnMut(Pass<'_, 'f, Rendering>, usize, Tokens),
    ) {
        let clear = Contents::clear_color([red, 0.0, 0.0, 1.0]);
        handles.clear();
        handles.extend([SOURCE, RESULT].map(|texture| import(frame, texture)));
        for (index, declared) in self.passes.iter().enumerate() {
            if declared.target == handles.len() {
                handles.push(frame.create_texture(&self.textures[declared.target], desc()));
            }
            let mut pass = frame.render_pass(&declared.name);
            let mut tokens = [pass.sample(&handles[declared.samples[0]]); FAN_IN];
            for (token, &texture) in tokens.iter_mut().zip(&declared.samples).skip(1) {
                *token = pass.sample(&handles[texture]);
            }
            pass.color(
                &mut handles[declared.target],
                if declared.clears { clear } else { Contents::Preserve },
            );
            draw(pass, index, tokens);
        }
    }

    /// Declares the caller's textures without a device.
    pub(crate) fn import<'f>(&'f self, frame: &mut Frame<'f>, texture: usize) -> Texture {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
        frame.declare_import_texture(&self.textures[texture], desc(), usage, texture == SOURCE)
    }
}

/// Textures that a pass samples; missing ones are replaced by the first.
pub(crate) type Tokens = [TextureToken; FAN_IN];

/// The texture drawn last, and up to two others.
fn pick(recent: &[usize], random: &mut Random) -> Vec<usize> {
    let mut picked: Vec<usize> = recent.last().copied().into_iter().collect();
    for _ in 0..random.below(FAN_IN) {
        let texture = recent[random.below(recent.len())];
        if !picked.contains(&texture) {
            picked.push(texture);
        }
    }
    picked
}

/// A linear congruential generator: frames must be the same on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }
}
