//! A scene's triangles, as they stop light.

use glam::{DVec3, Vec2, Vec3};
use shadowgraph_scene::{AlphaMode, CasterMode, Filter, Instance, Material, Scene, TextureRef, Vertex, Wrap};
use shadowgraph_shadows::rays::{self, AlphaTexture, Cut, Occluder, RayScene};

use shadowgraph_shadows::Error;

/// Blended surfaces stop light where they are more than half opaque, as they do in shadow maps.
const BLEND_CUTOFF: f32 = 0.5;

/// Makes the tree of a scene's triangles, relative to `origin_world`. What is alpha-cut has its holes.
///
/// # Errors
/// More triangles than the tree can number.
pub fn ray_scene(scene: &Scene, origin_world: DVec3) -> Result<RayScene, Error> {
    let mut textures = Textures::default();
    let mut occluders = Vec::new();
    for instance in &scene.instances {
        let (Some(mesh), Some(material)) =
            (scene.meshes.get(instance.mesh), scene.materials.get(instance.material))
        else {
            continue;
        };
        if material.caster_mode() == CasterMode::Off {
            continue;
        }
        let holes = Holes::of(material, scene, &mut textures)?;
        for triangle in mesh.indices.chunks_exact(3) {
            let vertices =
                [triangle[0], triangle[1], triangle[2]].map(|index| mesh.vertices.get(index as usize));
            let [Some(a), Some(b), Some(c)] = vertices else { continue };
            let corners = [a, b, c].map(|vertex| position(instance, vertex, origin_world));
            occluders.push(Occluder { corners, cut: holes.as_ref().map(|holes| holes.cut([a, b, c])) });
        }
    }
    Ok(RayScene::new(&occluders, textures.all)?)
}

fn position(instance: &Instance, vertex: &Vertex, origin_world: DVec3) -> Vec3 {
    let local = DVec3::from(vertex.position.map(f64::from));
    (instance.world_from_local.transform_point3(local) - origin_world).as_vec3()
}

/// Where a material has holes.
struct Holes {
    cutoff: f32,
    alpha: f32,
    texture: Option<(u32, TextureRef)>,
}

impl Holes {
    fn of(material: &Material, scene: &Scene, textures: &mut Textures) -> Result<Option<Self>, Error> {
        if material.caster_mode() == CasterMode::On {
            return Ok(None);
        }
        // A ray meets something or not: what is dithered is cut where more than half of it is left out.
        let cutoff = match material.alpha {
            AlphaMode::Mask { cutoff } if material.caster_mode() == CasterMode::Clip => cutoff,
            _ => BLEND_CUTOFF,
        };
        let texture = match material.base_color_texture {
            Some(used) => textures.get(scene, used)?.map(|index| (index, used)),
            None => None,
        };
        Ok(Some(Self { cutoff, alpha: material.base_color.w, texture }))
    }

    fn cut(&self, vertices: [&Vertex; 3]) -> Cut {
        Cut {
            texture: self.texture.map(|(index, _)| index),
            uv: vertices.map(|vertex| self.texture.map_or(Vec2::ZERO, |(_, used)| uv(vertex, &used))),
            alpha: vertices.map(|vertex| self.alpha * f32::from(vertex.color[3]) / 255.0),
            cutoff: self.cutoff,
        }
    }
}

fn uv(vertex: &Vertex, used: &TextureRef) -> Vec2 {
    let [u, v] = if used.uv_set == 1 { vertex.uv1 } else { vertex.uv0 };
    let [x, y] = used.uv_transform.map(|[a, b, c]| a * u + b * v + c);
    Vec2::new(x, y)
}

/// Alpha textures, each once.
#[derive(Default)]
struct Textures {
    known: Vec<(usize, [rays::Wrap; 2], rays::Filter)>,
    all: Vec<AlphaTexture>,
}

impl Textures {
    fn get(&mut self, scene: &Scene, used: TextureRef) -> Result<Option<u32>, Error> {
        let wrap = [used.sampler.wrap_u, used.sampler.wrap_v].map(|wrap| match wrap {
            Wrap::Repeat => rays::Wrap::Repeat,
            Wrap::MirrorRepeat => rays::Wrap::Mirror,
            Wrap::ClampToEdge => rays::Wrap::Clamp,
        });
        let filter = match used.sampler.mag {
            Filter::Nearest => rays::Filter::Nearest,
            Filter::Linear => rays::Filter::Bilinear,
        };
        let key = (used.image, wrap, filter);
        if let Some(index) = self.known.iter().position(|known| *known == key) {
            return Ok(Some(index as u32));
        }
        let Some(image) = scene.images.get(used.image) else { return Ok(None) };
        let texels = image.rgba8.chunks_exact(4).map(|texel| texel[3]).collect();
        let texture = AlphaTexture::new([image.width, image.height], texels, wrap, filter);
        self.all.push(texture.map_err(shadowgraph_shadows::Error::from)?);
        self.known.push(key);
        Ok(Some(self.all.len() as u32 - 1))
    }
}
