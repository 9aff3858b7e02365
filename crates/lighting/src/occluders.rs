//! The depth pyramid that instances are tested against.

use shadowgraph_core::{Buffer, BufferDesc, ComputeShader, Contents, Frame, Texture};

use crate::error::Error;
use crate::shader::module;

/// The shaders.
const FILE: &str = "occluders_build.wgsl";
/// Pixels of a workgroup, in x and y: those of a texel of the coarsest level that `fine_levels` builds.
const TILE_PX: u32 = 64;

/// Builds a depth pyramid: levels in which each texel is the farthest depth of the texels below it, so that what lies behind a texel is
/// hidden in its whole area (Greene, Kass and Miller, "Hierarchical Z-Buffer Visibility", 1993). It is a buffer, so that two compute
/// passes build all levels and threads can read different levels; [`DepthPyramid`](crate::post::DepthPyramid) is a texture to sample.
pub struct OccluderPyramid {
    fine_levels: ComputeShader,
    coarse_levels: ComputeShader,
}

impl OccluderPyramid {
    /// The finest level: `FINEST` of `occluders.wgsl`. Its texels have 4 by 4 pixels.
    pub const FINEST: u32 = 2;

    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let module = module(device, FILE, &[])?;
        let shader = |entry: &'static str| ComputeShader::module(entry, &module).entry_point(entry);
        Ok(Self { fine_levels: shader("fine_levels"), coarse_levels: shader("coarse_levels") })
    }

    /// Adds the passes, and returns the pyramid: an `f32` for each [texel](Self::texel_index). `depth` is reversed and has one sample per
    /// pixel.
    pub fn add_to(&self, frame: &mut Frame<'_>, depth: &Texture) -> Buffer {
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let bytes = u64::from(Self::texel_count([size.width, size.height])) * size_of::<f32>() as u64;
        let mut pyramid = frame.create_buffer("depth pyramid", BufferDesc::new(bytes));
        let tiles = [size.width.div_ceil(TILE_PX), size.height.div_ceil(TILE_PX), 1];
        let pass = frame.compute("fine levels", &self.fine_levels).sample(depth);
        pass.storage_mut(&mut pyramid, Contents::Overwrite).dispatch(tiles);
        if tiles != [1; 3] {
            let pass = frame.compute("coarse levels", &self.coarse_levels).sample(depth);
            pass.storage_mut(&mut pyramid, Contents::Preserve).dispatch([1; 3]);
        }
        pyramid
    }

    /// Returns the index of a texel, which is what the WGSL function `shadowgraph::occluders::texel_index` returns. A level from
    /// [`FINEST`](Self::FINEST) to [`top_level`](Self::top_level) has `size_px / 2^level` texels, rounded up.
    pub fn texel_index(size_px: [u32; 2], level: u32, [x, y]: [u32; 2]) -> u32 {
        let widths = [Self::FINEST, Self::FINEST + 1].map(|level| size_px[0].div_ceil(1 << level));
        let pitch = widths[0] + widths[1];
        if level <= Self::FINEST {
            return y * pitch + x;
        }
        let height = size_px[1].next_power_of_two();
        let row = (height >> Self::FINEST) - (height >> (level - 1)) + level - Self::FINEST - 1;
        (row + y) * pitch + widths[0] + x
    }

    /// Returns the level that is one texel.
    pub fn top_level(size_px: [u32; 2]) -> u32 {
        let longest = size_px[0].max(size_px[1]).max(1);
        (u32::BITS - (longest - 1).leading_zeros()).max(Self::FINEST)
    }

    /// Returns the number of texels, with gaps between levels.
    fn texel_count(size_px: [u32; 2]) -> u32 {
        let height = size_px[1].next_power_of_two();
        let rows = (height >> Self::FINEST) + Self::top_level(size_px) - Self::FINEST + 1;
        Self::texel_index(size_px, Self::FINEST, [0, rows])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_have_an_index_of_their_own() {
        for size_px in
            [[1, 1], [3, 2], [1, 5], [5, 3], [64, 64], [65, 1], [1, 300], [129, 7], [320, 180], [200, 257]]
        {
            let mut used = vec![false; OccluderPyramid::texel_count(size_px) as usize];
            for level in OccluderPyramid::FINEST..=OccluderPyramid::top_level(size_px) {
                let [width, height] = size_px.map(|px: u32| px.div_ceil(1 << level));
                for texel in (0..width * height).map(|texel| [texel % width, texel / width]) {
                    let index = OccluderPyramid::texel_index(size_px, level, texel);
                    let was_used = std::mem::replace(&mut used[index as usize], true);
                    assert!(!was_used, "{size_px:?}, level {level}, texel {texel:?}");
                }
            }
        }
    }
}
