//! A scene's triangles, for rays.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, Vec2, Vec3, Vec4};
use shadowgraph_scene::{
    AlphaMode, CasterMode, Changes, Filter, Image, ImageKey, InstanceKey, Material, MaterialKey, Mesh,
    MeshKey, MeshPose, Scene, TextureRef, Vertex, Wrap, linear_from_srgb,
};
use shadowgraph_shadows::Error;
use shadowgraph_shadows::rays::{
    self, ChannelTexture, Cutout, GpuRayScene, Instance, RayInstanceKey, RayMeshKey, RayScene,
    RaySurfacesKey, RayTextureKey, Surface, Tint,
};

use crate::gpu::Gpu;

/// The alpha cutoff of dithered surfaces.
const DITHER_CUTOFF: f32 = 0.5;

/// A [`RayScene`] that follows a scene: a mesh is shared by its instances, a mesh's surfaces by those with the same material. Alpha-tested
/// surfaces have their holes, translucent surfaces their colours. A deformed instance has a mesh of its pose. Instances that cast no shadow
/// are not in it.
pub struct SceneRays {
    rays: RayScene,
    meshes: BTreeMap<MeshKey, RayMeshKey>,
    surfaces: BTreeMap<(MeshKey, MaterialKey), Shared<RaySurfacesKey>>,
    textures: BTreeMap<TextureKey, Shared<RayTextureKey>>,
    instances: BTreeMap<InstanceKey, Placed>,
}

/// A part of the ray scene with several users.
struct Shared<K> {
    key: K,
    users: u32,
    /// The texture that it uses.
    texture: Option<TextureKey>,
}

/// An instance of the ray scene.
struct Placed {
    key: RayInstanceKey,
    mesh: MeshKey,
    material: MaterialKey,
    has_surfaces: bool,
    /// Its own mesh and the pose of it, if it is deformed.
    posed: Option<(RayMeshKey, MeshPose)>,
}

/// An image, how it is sampled, and the number of channels.
type TextureKey = (ImageKey, [rays::Wrap; 2], rays::Filter, usize);

impl SceneRays {
    /// Builds the trees over a scene's meshes and instances. Rays are relative to `origin_world`.
    ///
    /// # Errors
    /// For more triangles or texels than can be numbered.
    pub fn new(scene: &Scene, origin_world: DVec3) -> Result<Self, Error> {
        let mut built = Self {
            rays: RayScene::new(origin_world),
            meshes: BTreeMap::new(),
            surfaces: BTreeMap::new(),
            textures: BTreeMap::new(),
            instances: BTreeMap::new(),
        };
        built.update(scene, &Changes::insert_all(scene))?;
        built.rays.rebuild()?;
        Ok(built)
    }

    /// Returns the trees.
    #[must_use]
    pub fn rays(&self) -> &RayScene {
        &self.rays
    }

    /// Returns the instance of the scene that is an instance of the trees.
    #[must_use]
    pub fn instance(&self, key: RayInstanceKey) -> Option<InstanceKey> {
        self.instances.iter().find(|(_, placed)| placed.key == key).map(|(instance, _)| *instance)
    }

    /// Moves the point that rays are relative to.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn set_origin(&mut self, origin_world: DVec3) -> Result<(), Error> {
        Ok(self.rays.set_origin(origin_world)?)
    }

    /// Follows edits of the scene. A moved instance costs a refit of the boxes above it, another pose a refit of the tree of its mesh.
    ///
    /// # Errors
    /// As [`new`](Self::new); the edits can be followed again then.
    pub fn update(&mut self, scene: &Scene, changes: &Changes) -> Result<(), Error> {
        let mut edited: BTreeSet<InstanceKey> = changes.instances.iter().copied().collect();
        if !(changes.meshes.is_empty() && changes.materials.is_empty() && changes.images.is_empty()) {
            edited.extend(self.release_users(scene, changes)?);
        }
        for mesh in &changes.meshes {
            if let (Some(&key), Some(mesh)) = (self.meshes.get(mesh), scene.mesh(*mesh)) {
                self.rays.replace_mesh(key, &corners(mesh, &mesh.vertices))?;
            }
        }
        for key in edited {
            self.follow(scene, key)?;
        }
        for mesh in changes.meshes.iter().filter(|mesh| scene.mesh(**mesh).is_none()) {
            if let Some(key) = self.meshes.remove(mesh) {
                self.rays.remove_mesh(key)?;
            }
        }
        Ok(())
    }

    /// Removes the instances whose surfaces or pose depend on edited meshes, materials or images, and returns all that may have to be
    /// placed again.
    fn release_users(&mut self, scene: &Scene, changes: &Changes) -> Result<Vec<InstanceKey>, Error> {
        let images: BTreeSet<_> = changes.images.iter().collect();
        let meshes: BTreeSet<_> = changes.meshes.iter().collect();
        let is_drawn = |material: &Material| {
            material.base_color_texture.is_some_and(|texture| images.contains(&texture.image))
        };
        let mut materials: BTreeSet<_> = changes.materials.iter().copied().collect();
        materials.extend(scene.materials().filter(|(_, material)| is_drawn(material)).map(|(key, _)| key));
        let stale = |placed: &Placed| {
            let is_copied = placed.has_surfaces || placed.posed.is_some();
            materials.contains(&placed.material) || is_copied && meshes.contains(&placed.mesh)
        };
        let stale: Vec<_> =
            self.instances.iter().filter(|(_, placed)| stale(placed)).map(|(key, _)| *key).collect();
        stale.into_iter().try_for_each(|key| self.remove(key))?;
        let users = scene
            .instances()
            .filter(|(_, user)| meshes.contains(&user.mesh) || materials.contains(&user.material));
        Ok(users.map(|(key, _)| key).collect())
    }

    /// Inserts, moves or removes an instance.
    fn follow(&mut self, scene: &Scene, key: InstanceKey) -> Result<(), Error> {
        let casting = scene.instance(key).and_then(|instance| {
            let (mesh, material) = (scene.mesh(instance.mesh)?, scene.material(instance.material)?);
            (instance.caster_mode(material) != CasterMode::Off).then_some((instance, mesh, material))
        });
        let Some((instance, mesh, material)) = casting else { return self.remove(key) };
        let world_from_mesh = instance.world_from_local;
        let same =
            |placed: &&mut Placed| (placed.mesh, placed.material) == (instance.mesh, instance.material);
        if let Some(placed) = self.instances.get_mut(&key).filter(same) {
            match (&mut placed.posed, &instance.pose) {
                (Some((posed, known)), Some(pose)) => {
                    if known != pose {
                        self.rays.replace_mesh(*posed, &posed_corners(mesh, pose))?;
                        known.clone_from(pose);
                    }
                    return Ok(self.rays.set_transform(placed.key, world_from_mesh)?);
                }
                (None, None) => return Ok(self.rays.set_transform(placed.key, world_from_mesh)?),
                _ => {}
            }
        }
        self.remove(key)?;
        let posed = match &instance.pose {
            Some(pose) => Some((self.rays.insert_mesh(&posed_corners(mesh, pose))?, pose.clone())),
            None => None,
        };
        let own_mesh = posed.as_ref().map(|(mesh, _)| *mesh);
        let ray_mesh = match own_mesh.or(self.meshes.get(&instance.mesh).copied()) {
            Some(known) => known,
            None => self.rays.insert_mesh(&corners(mesh, &mesh.vertices))?,
        };
        if posed.is_none() {
            self.meshes.insert(instance.mesh, ray_mesh);
        }
        let surfaces = self.surfaces(scene, (instance.mesh, mesh), (instance.material, material))?;
        let placed = Placed {
            key: self.rays.insert_instance(Instance { mesh: ray_mesh, surfaces, world_from_mesh })?,
            mesh: instance.mesh,
            material: instance.material,
            has_surfaces: surfaces.is_some(),
            posed,
        };
        self.instances.insert(key, placed);
        Ok(())
    }

    /// Returns the surfaces of a mesh with a material, for one more user; `None` if no light passes.
    fn surfaces(
        &mut self,
        scene: &Scene,
        (mesh_key, mesh): (MeshKey, &Mesh),
        (material_key, material): (MaterialKey, &Material),
    ) -> Result<Option<RaySurfacesKey>, Error> {
        if let Some(known) = self.surfaces.get_mut(&(mesh_key, material_key)) {
            known.users += 1;
            return Ok(Some(known.key));
        }
        let Some(cutoff) = cutoff(material) else { return Ok(None) };
        let texture = material.base_color_texture.and_then(|used| Some((used, scene.image(used.image)?)));
        let texture = match texture {
            Some((used, image)) => Some((self.texture(&used, image, cutoff.is_none())?, used)),
            None => None,
        };
        let surfaces: Vec<Surface> = triangles(mesh, &mesh.vertices)
            .map(|vertices| surface(vertices, material, cutoff, texture.map(|((_, key), used)| (key, used))))
            .collect();
        let key = self.rays.insert_surfaces(&surfaces)?;
        let shared = Shared { key, users: 1, texture: texture.map(|((key, _), _)| key) };
        self.surfaces.insert((mesh_key, material_key), shared);
        Ok(Some(key))
    }

    /// Returns a texture, for one more user: alpha, and for a tint red, green and blue.
    fn texture(
        &mut self,
        used: &TextureRef,
        image: &Image,
        tints: bool,
    ) -> Result<(TextureKey, RayTextureKey), Error> {
        let wrap = [used.sampler.wrap_u, used.sampler.wrap_v].map(|wrap| match wrap {
            Wrap::Repeat => rays::Wrap::Repeat,
            Wrap::MirrorRepeat => rays::Wrap::Mirror,
            Wrap::ClampToEdge => rays::Wrap::Clamp,
        });
        let filter = match used.sampler.mag {
            Filter::Nearest => rays::Filter::Nearest,
            Filter::Linear => rays::Filter::Bilinear,
        };
        let channels: &[usize] = if tints { &[3, 0, 1, 2] } else { &[3] };
        let key = (used.image, wrap, filter, channels.len());
        if let Some(known) = self.textures.get_mut(&key) {
            known.users += 1;
            return Ok((key, known.key));
        }
        let channel = |&channel: &usize| {
            let texels = image.rgba8.chunks_exact(4).map(|texel| match channel {
                3 => texel[3],
                _ => (linear_from_srgb(texel[channel]) * 255.0).round() as u8,
            });
            ChannelTexture::new([image.width, image.height], texels.collect(), wrap, filter)
        };
        let channels = channels.iter().map(channel).collect::<Result<Vec<_>, _>>()?;
        let texture = self.rays.insert_texture(&channels)?;
        self.textures.insert(key, Shared { key: texture, users: 1, texture: None });
        Ok((key, texture))
    }

    /// Removes an instance, if there is one, with what it alone used of surfaces and textures.
    fn remove(&mut self, key: InstanceKey) -> Result<(), Error> {
        let Some(placed) = self.instances.remove(&key) else { return Ok(()) };
        self.rays.remove_instance(placed.key)?;
        if let Some((posed, _)) = placed.posed {
            self.rays.remove_mesh(posed)?;
        }
        let key = (placed.mesh, placed.material);
        let Some(surfaces) = self.surfaces.get_mut(&key).filter(|_| placed.has_surfaces) else {
            return Ok(());
        };
        surfaces.users -= 1;
        if surfaces.users > 0 {
            return Ok(());
        }
        let (surfaces, texture) = (surfaces.key, surfaces.texture);
        self.surfaces.remove(&key);
        self.rays.remove_surfaces(surfaces)?;
        let Some((key, texture)) = texture.and_then(|key| Some((key, self.textures.get_mut(&key)?))) else {
            return Ok(());
        };
        texture.users -= 1;
        if texture.users == 0 {
            let texture = texture.key;
            self.textures.remove(&key);
            self.rays.remove_texture(texture)?;
        }
        Ok(())
    }
}

/// [`SceneRays`] and their copy on the GPU.
pub(crate) struct UploadedRays {
    rays: SceneRays,
    gpu: GpuRayScene,
}

impl UploadedRays {
    /// Uploads a scene.
    pub(crate) fn new(gpu: &Gpu, scene: &Scene, origin_world: DVec3) -> Result<Self, Error> {
        let rays = SceneRays::new(scene, origin_world)?;
        let mut uploaded = Self { rays, gpu: GpuRayScene::new(&gpu.device) };
        uploaded.update(gpu, scene, &Changes::default(), origin_world)?;
        Ok(uploaded)
    }

    /// Follows edits of the scene and the origin, and uploads what has changed. Returns the number of bytes.
    pub(crate) fn update(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        changes: &Changes,
        origin_world: DVec3,
    ) -> Result<u64, Error> {
        self.rays.update(scene, changes)?;
        self.rays.set_origin(origin_world)?;
        Ok(self.gpu.update(&gpu.queue, &mut self.rays.rays)?)
    }

    /// Returns the copy on the GPU.
    pub(crate) fn gpu(&self) -> &GpuRayScene {
        &self.gpu
    }
}

/// Returns the triangles of a mesh whose indices are valid. `vertices` are its own, in any pose.
fn triangles<'m>(mesh: &'m Mesh, vertices: &'m [Vertex]) -> impl Iterator<Item = [&'m Vertex; 3]> {
    mesh.indices.chunks_exact(3).filter_map(|triangle| {
        let vertex = |index: u32| vertices.get(index as usize);
        Some([vertex(triangle[0])?, vertex(triangle[1])?, vertex(triangle[2])?])
    })
}

fn corners(mesh: &Mesh, vertices: &[Vertex]) -> Vec<[Vec3; 3]> {
    triangles(mesh, vertices).map(|vertices| vertices.map(|vertex| vertex.position.into())).collect()
}

fn posed_corners(mesh: &Mesh, pose: &MeshPose) -> Vec<[Vec3; 3]> {
    corners(mesh, &mesh.posed_vertices(pose))
}

/// Returns the alpha below which a material has holes, `None` in it if it colours light, and `None` if no light passes.
#[expect(clippy::option_option, reason = "no light, some light with and without holes")]
fn cutoff(material: &Material) -> Option<Option<f32>> {
    match material.caster_mode() {
        CasterMode::On | CasterMode::Off => None,
        CasterMode::Tint => Some(None),
        CasterMode::Clip => Some(Some(material.caster_cutoff())),
        // A ray hits or misses: dithered surfaces have holes where more than half of the pixels are discarded.
        CasterMode::Dither => Some(Some(DITHER_CUTOFF)),
    }
}

/// Returns the surface of a triangle.
fn surface(
    vertices: [&Vertex; 3],
    material: &Material,
    cutoff: Option<f32>,
    used: Option<(RayTextureKey, TextureRef)>,
) -> Surface {
    let texture = used.map(|(key, _)| key);
    let uv = vertices.map(|vertex| used.map_or(Vec2::ZERO, |(_, used)| uv(vertex, &used)));
    let color = vertices
        .map(|vertex| material.base_color * Vec4::from(vertex.color.map(f32::from)) / f32::from(u16::MAX));
    match cutoff {
        Some(cutoff) => Surface::Cutout(Cutout { texture, uv, alpha: color.map(|color| color.w), cutoff }),
        None => Surface::Tint(Tint { texture, uv, color, transmits: material.alpha == AlphaMode::Transmit }),
    }
}

fn uv(vertex: &Vertex, used: &TextureRef) -> Vec2 {
    let [u, v] = if used.uv_set == 1 { vertex.uv1 } else { vertex.uv0 };
    let [x, y] = used.uv_transform.map(|[a, b, c]| a * u + b * v + c);
    Vec2::new(x, y)
}
