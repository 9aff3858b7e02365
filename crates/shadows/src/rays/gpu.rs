//! The scene in the buffers of `rays.wgsl`.

use bytemuck::Zeroable;
use shadowgraph_shaders::ModuleSource;

use super::{
    ChannelTexture, Error, RayScene,
    gpu_structs::{NO_MATERIAL, RayMaterial, RayNode, RayTexture, RayTriangle, TINT},
};

const FEWER_TRIANGLES: &str = "remove casters whose shadows are not visible, use coarser meshes, or request a device \
                               with a larger max_storage_buffer_binding_size";
const FEWER_TEXELS: &str = "use smaller textures, or request a device with a larger \
                            max_storage_buffer_binding_size";

/// The buffers of `rays.wgsl`. None is empty: an empty scene has one triangle that no ray hits.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuRayScene {
    /// The nodes of the tree; the first one is the root.
    pub nodes: Vec<RayNode>,
    /// The triangles, in the tree's order.
    pub triangles: Vec<RayTriangle>,
    /// The materials of triangles that let light through.
    pub materials: Vec<RayMaterial>,
    /// The channels of textures.
    pub textures: Vec<RayTexture>,
    /// The texels of all channels, packed four to a word with the first in the lowest byte.
    pub texels: Vec<u32>,
    /// [`RayScene::max_coordinate_m`], from which the shader computes the rays' origins.
    pub max_coordinate_m: f32,
}

impl GpuRayScene {
    /// Creates the contents of the buffers. `max_binding_bytes` is the device's `max_storage_buffer_binding_size`.
    ///
    /// # Errors
    ///
    /// [`Error::TooBig`] if one of the buffers would be larger than that.
    pub fn new(scene: &RayScene, max_binding_bytes: u64) -> Result<Self, Error> {
        let texels: u64 = scene.textures().iter().map(|texture| texture.texels().len() as u64).sum();
        fits::<RayNode>("nodes", scene.bvh().nodes.len(), max_binding_bytes)?;
        fits::<RayTriangle>("triangles", scene.triangles().len(), max_binding_bytes)?;
        fits::<RayMaterial>("materials", scene.materials().len(), max_binding_bytes)?;
        let (bytes, limit) = (texels.next_multiple_of(4), max_binding_bytes.min(u64::from(u32::MAX)));
        if bytes > limit {
            return Err(Error::TooBig { what: "texels", bytes, limit, help: FEWER_TEXELS });
        }
        let mut gpu = Self {
            nodes: nodes(scene),
            triangles: or_one(scene.triangles(), RayTriangle::new([glam::Vec3::ZERO; 3], NO_MATERIAL)),
            materials: or_one(scene.materials(), RayMaterial::zeroed()),
            textures: Vec::new(),
            texels: Vec::new(),
            max_coordinate_m: scene.max_coordinate_m(),
        };
        gpu.pack(scene.textures());
        Ok(gpu)
    }

    /// Returns the replacement of `ray_surfaces.wgsl`: code for kinds of materials that no triangle has is not compiled.
    #[must_use]
    pub fn surfaces(&self) -> ModuleSource {
        let tints = |index: u32| self.materials.get(index as usize).map(|material| material.cutoff == TINT);
        let has = |value| self.triangles.iter().any(|triangle| tints(triangle.material) == Some(value));
        let source = format!(
            "#define_import_path shadowgraph::ray_surfaces\n\
             const CUTOUTS: bool = {};\n\
             const TINTS: bool = {};\n",
            has(false),
            has(true),
        );
        ModuleSource::new("ray_surfaces.wgsl of a scene", source)
    }

    /// Returns the bytes of the buffers, in the order of their bindings: nodes, triangles, materials, channels, texels.
    #[must_use]
    pub fn buffers(&self) -> [&[u8]; 5] {
        [
            bytemuck::cast_slice(&self.nodes),
            bytemuck::cast_slice(&self.triangles),
            bytemuck::cast_slice(&self.materials),
            bytemuck::cast_slice(&self.textures),
            bytemuck::cast_slice(&self.texels),
        ]
    }

    fn pack(&mut self, textures: &[ChannelTexture]) {
        let mut texels = Vec::new();
        for texture in textures {
            let ([width, height], [wrap_u, wrap_v]) = (texture.size_px(), texture.wrap());
            let sampling = wrap_u as u32 | (wrap_v as u32) << 2 | (texture.filter() as u32) << 4;
            let first_texel = texels.len() as u32;
            self.textures.push(RayTexture { first_texel, width, height, sampling });
            texels.extend_from_slice(texture.texels());
        }
        texels.resize(texels.len().next_multiple_of(4).max(4), 0);
        let words = texels.as_chunks::<4>().0.iter();
        self.texels = words.map(|&bytes| u32::from_le_bytes(bytes)).collect();
        self.textures = or_one(&self.textures, RayTexture::zeroed());
    }
}

fn fits<T>(what: &'static str, count: usize, limit: u64) -> Result<(), Error> {
    let bytes = count as u64 * size_of::<T>() as u64;
    if bytes > limit {
        return Err(Error::TooBig { what, bytes, limit, help: FEWER_TRIANGLES });
    }
    Ok(())
}

fn nodes(scene: &RayScene) -> Vec<RayNode> {
    let gpu_node = |node: &obvhs::bvh2::node::Bvh2Node| RayNode {
        lowest: node.aabb().min.into(),
        first: node.first_index,
        highest: node.aabb().max.into(),
        count: node.prim_count,
    };
    let nodes: Vec<RayNode> = scene.bvh().nodes.iter().map(gpu_node).collect();
    or_one(&nodes, RayNode { count: 1, ..RayNode::zeroed() })
}

/// Returns the elements, or `one` if there are none: bindings cannot be empty.
fn or_one<T: Copy>(elements: &[T], one: T) -> Vec<T> {
    if elements.is_empty() { vec![one] } else { elements.to_vec() }
}
