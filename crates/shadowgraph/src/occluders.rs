//! A scene's triangles as occluders of rays.

use std::borrow::Cow;

use glam::{DVec3, Vec2, Vec3, Vec4};
use shadowgraph_scene::{
    AlphaMode, CasterMode, Filter, ImageKey, Instance, Material, Scene, TextureRef, Vertex, Wrap,
    linear_from_srgb,
};
use shadowgraph_shadows::Error;
use shadowgraph_shadows::rays::{self, ChannelTexture, Cutout, Occluder, RayScene, Surface, Tint};

/// The alpha cutoff of dithered surfaces.
const DITHER_CUTOFF: f32 = 0.5;

/// Creates the acceleration structure of a scene's triangles, relative to `origin_world`. Alpha-tested surfaces have their holes,
/// translucent surfaces their colours.
///
/// # Errors
/// For more triangles than the acceleration structure can index.
pub fn ray_scene(scene: &Scene, origin_world: DVec3) -> Result<RayScene, Error> {
    let mut textures = Textures::default();
    let mut occluders = Vec::new();
    for (_, instance) in scene.instances() {
        let (Some(mesh), Some(material)) = (scene.mesh(instance.mesh), scene.material(instance.material))
        else {
            continue;
        };
        if instance.caster_mode(material) == CasterMode::Off {
            continue;
        }
        let occluder_material = OccluderMaterial::new(material, scene, &mut textures)?;
        let vertices = match &instance.pose {
            Some(pose) => Cow::Owned(mesh.posed_vertices(pose)),
            None => Cow::Borrowed(&mesh.vertices),
        };
        for triangle in mesh.indices.chunks_exact(3) {
            let vertices = [triangle[0], triangle[1], triangle[2]].map(|index| vertices.get(index as usize));
            let [Some(a), Some(b), Some(c)] = vertices else { continue };
            let corners = [a, b, c].map(|vertex| position(instance, vertex, origin_world));
            let surface =
                occluder_material.as_ref().map_or(Surface::Opaque, |material| material.surface([a, b, c]));
            occluders.push(Occluder { corners, surface });
        }
    }
    Ok(RayScene::new(&occluders, textures.all)?)
}

fn position(instance: &Instance, vertex: &Vertex, origin_world: DVec3) -> Vec3 {
    let local = DVec3::from(vertex.position.map(f64::from));
    (instance.world_from_local.transform_point3(local) - origin_world).as_vec3()
}

/// The properties of a material that its triangles need.
struct OccluderMaterial {
    /// The alpha below which there are holes; `None` for a surface that colours light.
    cutoff: Option<f32>,
    color: Vec4,
    texture: Option<(u32, TextureRef)>,
}

impl OccluderMaterial {
    /// Returns `None` if no light passes.
    fn new(material: &Material, scene: &Scene, textures: &mut Textures) -> Result<Option<Self>, Error> {
        let cutoff = match (material.caster_mode(), material.alpha) {
            (CasterMode::On | CasterMode::Off, _) => return Ok(None),
            (CasterMode::Tint, _) => None,
            (CasterMode::Clip, AlphaMode::Mask { cutoff }) => Some(cutoff),
            // A ray hits or misses: dithered surfaces have holes where more than half of the pixels are discarded.
            (CasterMode::Clip | CasterMode::Dither, _) => Some(DITHER_CUTOFF),
        };
        let channels: &[usize] = if cutoff.is_none() { &[3, 0, 1, 2] } else { &[3] };
        let texture = match material.base_color_texture {
            Some(used) => textures.get(scene, used, channels)?.map(|index| (index, used)),
            None => None,
        };
        Ok(Some(Self { cutoff, color: material.base_color, texture }))
    }

    fn surface(&self, vertices: [&Vertex; 3]) -> Surface {
        let texture = self.texture.map(|(index, _)| index);
        let uv = vertices.map(|vertex| self.texture.map_or(Vec2::ZERO, |(_, used)| uv(vertex, &used)));
        let color = vertices.map(|vertex| self.color * Vec4::from(vertex.color.map(f32::from)) / 255.0);
        match self.cutoff {
            Some(cutoff) => {
                Surface::Cutout(Cutout { texture, uv, alpha: color.map(|color| color.w), cutoff })
            }
            None => Surface::Tint(Tint { texture, uv, color }),
        }
    }
}

fn uv(vertex: &Vertex, used: &TextureRef) -> Vec2 {
    let [u, v] = if used.uv_set == 1 { vertex.uv1 } else { vertex.uv0 };
    let [x, y] = used.uv_transform.map(|[a, b, c]| a * u + b * v + c);
    Vec2::new(x, y)
}

/// Channels of textures, without duplicates.
#[derive(Default)]
struct Textures {
    known: Vec<(TextureKey, u32)>,
    all: Vec<ChannelTexture>,
}

/// An image, how it is sampled, and the number of channels.
type TextureKey = (ImageKey, [rays::Wrap; 2], rays::Filter, usize);

impl Textures {
    /// Returns the index of the first channel of a texture; `None` if the image does not exist.
    fn get(&mut self, scene: &Scene, used: TextureRef, channels: &[usize]) -> Result<Option<u32>, Error> {
        let wrap = [used.sampler.wrap_u, used.sampler.wrap_v].map(|wrap| match wrap {
            Wrap::Repeat => rays::Wrap::Repeat,
            Wrap::MirrorRepeat => rays::Wrap::Mirror,
            Wrap::ClampToEdge => rays::Wrap::Clamp,
        });
        let filter = match used.sampler.mag {
            Filter::Nearest => rays::Filter::Nearest,
            Filter::Linear => rays::Filter::Bilinear,
        };
        let key = (used.image, wrap, filter, channels.len());
        if let Some((_, index)) = self.known.iter().find(|(known, _)| *known == key) {
            return Ok(Some(*index));
        }
        let Some(image) = scene.image(used.image) else { return Ok(None) };
        let first = self.all.len() as u32;
        for &channel in channels {
            let texels = image.rgba8.chunks_exact(4).map(|texel| match channel {
                3 => texel[3],
                _ => (linear_from_srgb(texel[channel]) * 255.0).round() as u8,
            });
            let texture = ChannelTexture::new([image.width, image.height], texels.collect(), wrap, filter);
            self.all.push(texture.map_err(shadowgraph_shadows::Error::from)?);
        }
        self.known.push((key, first));
        Ok(Some(first))
    }
}
