//! The scene that rays are traced through, and its edits.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec3, Vec3};
use obvhs::aabb::Aabb;
use slotmap::SlotMap;

use super::gpu_structs::{RayInstance, RayNode, RaySurface, RayTriangle};
use super::instance::{Instance, Placement};
use super::instance_tree::InstanceTree;
use super::keys::{RayInstanceKey, RayMeshKey, RaySurfacesKey, RayTextureKey};
use super::mesh::Mesh;
use super::pool::Pool;
use super::{ChannelTexture, Error, Surface};

/// Largest number of nodes, triangles and so on: the highest bit of a node's index marks instances, and texels have indices of 32 bits.
const LIMIT: u32 = 1 << 30;

/// Meshes, their instances, and trees over both (see the [module](super)). It can be traced between any two edits.
pub struct RayScene {
    origin_world: DVec3,
    pub(super) nodes: Pool<RayNode>,
    pub(super) triangles: Pool<RayTriangle>,
    pub(super) surfaces: Pool<RaySurface>,
    pub(super) instances: Pool<RayInstance>,
    /// Textures, as words of four bytes.
    pub(super) words: Pool<[u8; 4]>,
    tree: InstanceTree,
    meshes: SlotMap<RayMeshKey, Mesh>,
    sets: SlotMap<RaySurfacesKey, SurfaceSet>,
    textures: SlotMap<RayTextureKey, Texture>,
    placed: SlotMap<RayInstanceKey, Placed>,
    /// How far each instance reaches (the bits of a positive number, which are ordered as it is), and its key.
    reaches: BTreeSet<(u32, RayInstanceKey)>,
}

struct SurfaceSet {
    range: std::ops::Range<u32>,
    textures: BTreeSet<RayTextureKey>,
    cutouts: bool,
    tints: bool,
    users: usize,
}

struct Texture {
    range: std::ops::Range<u32>,
    channels: usize,
    users: usize,
}

struct Placed {
    instance: Instance,
    /// Its index among the instances of the buffers.
    index: u32,
    reach_m: f32,
}

impl Default for RayScene {
    fn default() -> Self {
        Self::new(DVec3::ZERO)
    }
}

impl RayScene {
    /// Creates an empty scene, which blocks nothing. Rays are relative to `origin_world`.
    #[must_use]
    pub fn new(origin_world: DVec3) -> Self {
        let mut nodes = Pool::new(LIMIT);
        Self {
            origin_world,
            tree: InstanceTree::new(&mut nodes),
            nodes,
            triangles: Pool::new(LIMIT),
            surfaces: Pool::new(LIMIT),
            instances: Pool::new(LIMIT),
            words: Pool::new(LIMIT),
            meshes: SlotMap::with_key(),
            sets: SlotMap::with_key(),
            textures: SlotMap::with_key(),
            placed: SlotMap::with_key(),
            reaches: BTreeSet::new(),
        }
    }

    /// Returns the point that rays are relative to.
    #[must_use]
    pub fn origin_world(&self) -> DVec3 {
        self.origin_world
    }

    /// Moves the point that rays are relative to. Only transforms change.
    ///
    /// # Errors
    ///
    /// [`Error::TooMany`], as all edits.
    pub fn set_origin(&mut self, origin_world: DVec3) -> Result<(), Error> {
        if self.origin_world == origin_world {
            return Ok(());
        }
        self.origin_world = origin_world;
        let keys: Vec<_> = self.placed.keys().collect();
        keys.into_iter().try_for_each(|key| self.place(key))
    }

    /// Adds a mesh by the corners of its triangles, which block light from both sides. Triangles without area, with corners that are not
    /// finite or have coordinates above 1e9 are never hit.
    ///
    /// # Errors
    ///
    /// [`Error::TooMany`] if the scene has more than about 2^29 triangles then.
    pub fn insert_mesh(&mut self, corners: &[[Vec3; 3]]) -> Result<RayMeshKey, Error> {
        let mesh = Mesh::build(corners, &mut self.nodes, &mut self.triangles)?;
        Ok(self.meshes.insert(mesh))
    }

    /// Replaces the triangles of a mesh. For a pose of the same triangles its tree is refitted, unless it has degraded; otherwise it is built
    /// again.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`]; [`Error::Surfaces`] if an instance has surfaces for another number of triangles; [`Error::TooMany`].
    pub fn replace_mesh(&mut self, key: RayMeshKey, corners: &[[Vec3; 3]]) -> Result<(), Error> {
        let mesh = self.meshes.get(key).ok_or(Error::Stale { what: "mesh" })?;
        if !mesh.refit(corners, &mut self.nodes, &mut self.triangles) {
            for user in &mesh.users {
                self.check(corners.len(), self.placed[*user].instance.surfaces)?;
            }
            let built = Mesh::build(corners, &mut self.nodes, &mut self.triangles)?;
            let mesh = &mut self.meshes[key];
            mesh.free(&mut self.nodes, &mut self.triangles);
            let users = std::mem::take(&mut mesh.users);
            *mesh = built;
            mesh.users = users;
        }
        let users = self.meshes[key].users.clone();
        users.into_iter().try_for_each(|user| self.place(user))
    }

    /// Removes a mesh.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`]; [`Error::InUse`] while it has instances.
    pub fn remove_mesh(&mut self, key: RayMeshKey) -> Result<(), Error> {
        let mesh = self.meshes.get(key).ok_or(Error::Stale { what: "mesh" })?;
        not_in_use("mesh", mesh.users.len())?;
        mesh.free(&mut self.nodes, &mut self.triangles);
        self.meshes.remove(key);
        Ok(())
    }

    /// Adds a texture: one channel for cutouts (alpha), or four for tints (alpha and linear red, green and blue).
    ///
    /// # Errors
    ///
    /// [`Error::TooMany`] if the scene has more than 2^30 words of texels then.
    pub fn insert_texture(&mut self, channels: &[ChannelTexture]) -> Result<RayTextureKey, Error> {
        let texels: usize = channels.iter().map(|channel| channel.texels().len()).sum();
        let words = channels.len() * 4 + texels.div_ceil(4);
        let full = || Error::TooMany { count: words };
        let range = self.words.insert(&vec![[0; 4]; words]).ok_or_else(full)?;
        let mut first_texel = (range.start + channels.len() as u32 * 4) * 4;
        let (mut bytes, mut all) = (Vec::with_capacity(words * 4), Vec::with_capacity(texels + 3));
        for channel in channels {
            let header = channel.header(first_texel);
            bytes.extend(
                [header.first_texel, header.width, header.height, header.sampling].map(u32::to_le_bytes),
            );
            all.extend_from_slice(channel.texels());
            first_texel += channel.texels().len() as u32;
        }
        all.resize(texels.next_multiple_of(4), 0);
        bytes.extend_from_slice(all.as_chunks().0);
        self.words.write(range.start, &bytes);
        Ok(self.textures.insert(Texture { range, channels: channels.len(), users: 0 }))
    }

    /// Removes a texture.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`]; [`Error::InUse`] while surfaces have it.
    pub fn remove_texture(&mut self, key: RayTextureKey) -> Result<(), Error> {
        let texture = self.textures.get(key).ok_or(Error::Stale { what: "texture" })?;
        not_in_use("texture", texture.users)?;
        self.words.remove(texture.range.clone());
        self.textures.remove(key);
        Ok(())
    }

    /// Adds the surfaces of a mesh's triangles, one each, in the order in which the triangles were given. Rays pass through surfaces that are
    /// not [valid](Surface::is_valid).
    ///
    /// # Errors
    ///
    /// [`Error::Stale`] and [`Error::Channels`] for their textures; [`Error::TooMany`].
    pub fn insert_surfaces(&mut self, surfaces: &[Surface]) -> Result<RaySurfacesKey, Error> {
        let mut textures = BTreeSet::new();
        let mut packed = |surface: &Surface| {
            let mut first = None;
            if let Some((key, needed)) = surface.texture() {
                let texture = self.textures.get(key).ok_or(Error::Stale { what: "texture" })?;
                if texture.channels < needed {
                    return Err(Error::Channels { needed, count: texture.channels });
                }
                textures.insert(key);
                first = Some(texture.range.start);
            }
            Ok(RaySurface::new(surface, first))
        };
        let packed = surfaces.iter().map(&mut packed).collect::<Result<Vec<_>, _>>()?;
        let range = self.surfaces.insert(&packed).ok_or(Error::TooMany { count: packed.len() })?;
        textures.iter().for_each(|&key| self.textures[key].users += 1);
        let cutouts = surfaces.iter().any(|surface| matches!(surface, Surface::Cutout(_)));
        let tints = surfaces.iter().any(|surface| matches!(surface, Surface::Tint(_)));
        Ok(self.sets.insert(SurfaceSet { range, textures, cutouts, tints, users: 0 }))
    }

    /// Removes surfaces.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`]; [`Error::InUse`] while instances have them.
    pub fn remove_surfaces(&mut self, key: RaySurfacesKey) -> Result<(), Error> {
        let set = self.sets.get(key).ok_or(Error::Stale { what: "set of surfaces" })?;
        not_in_use("set of surfaces", set.users)?;
        self.surfaces.remove(set.range.clone());
        set.textures.iter().for_each(|&texture| self.textures[texture].users -= 1);
        self.sets.remove(key);
        Ok(())
    }

    /// Adds an instance of a mesh. It is not hit while its transform is not finite, or while it reaches farther than 1e9 m from the origin.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`] for its mesh or surfaces; [`Error::Surfaces`] if there are not as many as triangles; [`Error::TooMany`].
    pub fn insert_instance(&mut self, instance: Instance) -> Result<RayInstanceKey, Error> {
        let mesh = self.meshes.get(instance.mesh).ok_or(Error::Stale { what: "mesh" })?;
        self.check(mesh.given, instance.surfaces)?;
        let full = Error::TooMany { count: self.placed.len() };
        let index = self.instances.insert(&[RayInstance::default()]).ok_or(full)?.start;
        let key = self.placed.insert(Placed { instance, index, reach_m: 0.0 });
        self.meshes[instance.mesh].users.push(key);
        if let Some(surfaces) = instance.surfaces {
            self.sets[surfaces].users += 1;
        }
        self.place(key)?;
        Ok(key)
    }

    /// Moves an instance. The tree over the instances is refitted.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`].
    pub fn set_transform(&mut self, key: RayInstanceKey, world_from_mesh: DAffine3) -> Result<(), Error> {
        let placed = self.placed.get_mut(key).ok_or(Error::Stale { what: "instance" })?;
        placed.instance.world_from_mesh = world_from_mesh;
        self.place(key)
    }

    /// Removes an instance; its mesh and its surfaces stay.
    ///
    /// # Errors
    ///
    /// [`Error::Stale`].
    pub fn remove_instance(&mut self, key: RayInstanceKey) -> Result<(), Error> {
        let Placed { instance, index, reach_m } =
            self.placed.remove(key).ok_or(Error::Stale { what: "instance" })?;
        self.tree.set(&mut self.nodes, index, None)?;
        self.instances.remove(index..index + 1);
        self.reaches.remove(&(reach_m.to_bits(), key));
        self.meshes[instance.mesh].users.retain(|user| *user != key);
        if let Some(surfaces) = instance.surfaces {
            self.sets[surfaces].users -= 1;
        }
        Ok(())
    }

    /// Rebuilds the tree over the instances if edits have degraded it, and returns whether they had. Call it once for all edits of a frame;
    /// [`GpuRayScene::update`](super::GpuRayScene::update) does.
    ///
    /// # Errors
    ///
    /// [`Error::TooMany`].
    pub fn rebuild_if_degraded(&mut self) -> Result<bool, Error> {
        self.tree.rebuild_if_degraded(&mut self.nodes)
    }

    /// Builds the tree over the instances again: better than what insertions make.
    ///
    /// # Errors
    ///
    /// [`Error::TooMany`].
    pub fn rebuild(&mut self) -> Result<(), Error> {
        self.tree.rebuild(&mut self.nodes)
    }

    /// Returns an upper bound of the coordinates of all corners, and of the terms that they are sums of (an offset and products of a matrix
    /// and a vector), metres.
    #[must_use]
    pub fn max_coordinate_m(&self) -> f32 {
        self.reaches.last().map_or(0.0, |(bits, _)| f32::from_bits(*bits))
    }

    /// Returns the kinds of surfaces, besides opaque ones.
    pub(crate) fn surface_kinds(&self) -> SurfaceKinds {
        let used = || self.sets.values().filter(|set| set.users > 0);
        SurfaceKinds { cutouts: used().any(|set| set.cutouts), tints: used().any(|set| set.tints) }
    }

    /// Returns the instance with an index among those of the buffers.
    pub(super) fn instance_at(&self, index: u32) -> Option<RayInstanceKey> {
        self.placed.iter().find(|(_, placed)| placed.index == index).map(|(key, _)| key)
    }

    /// Returns all instances that can be hit, and the triangles of their meshes.
    pub(crate) fn all(&self) -> impl Iterator<Item = (&RayInstance, &[RayTriangle])> {
        let reached = self.placed.iter().filter(|(key, placed)| self.is_reached(*key, placed));
        reached.filter_map(|(_, placed)| {
            let instance = self.instances.elements().get(placed.index as usize)?;
            Some((instance, self.triangles.slice(self.meshes.get(placed.instance.mesh)?.triangles.clone())))
        })
    }

    fn is_reached(&self, key: RayInstanceKey, placed: &Placed) -> bool {
        self.reaches.contains(&(placed.reach_m.to_bits(), key))
    }

    /// Checks the number of surfaces of an instance whose mesh has this many triangles.
    fn check(&self, triangles: usize, surfaces: Option<RaySurfacesKey>) -> Result<(), Error> {
        let Some(key) = surfaces else { return Ok(()) };
        let set = self.sets.get(key).ok_or(Error::Stale { what: "set of surfaces" })?;
        let count = set.range.len();
        if count == triangles { Ok(()) } else { Err(Error::Surfaces { count, triangles }) }
    }

    /// Recomputes what the shader reads of an instance, and its box.
    fn place(&mut self, key: RayInstanceKey) -> Result<(), Error> {
        let placed = &mut self.placed[key];
        let mesh = &self.meshes[placed.instance.mesh];
        let root = self.nodes.get(mesh.nodes.start);
        let local = if mesh.nodes.is_empty() { Aabb::empty() } else { root.bounds() };
        let transform = &placed.instance.world_from_mesh;
        let mut placement = Placement::new(transform, self.origin_world, mesh.nodes.start, &local);
        if let Some(set) = placed.instance.surfaces.and_then(|surfaces| self.sets.get(surfaces)) {
            placement.packed.first_surface = set.range.start;
        }
        self.instances.set(placed.index, placement.packed);
        self.reaches.remove(&(placed.reach_m.to_bits(), key));
        placed.reach_m = placement.reach_m;
        if placement.bounds.is_some() {
            self.reaches.insert((placed.reach_m.to_bits(), key));
        }
        self.tree.set(&mut self.nodes, placed.index, placement.bounds)
    }
}

/// The kinds of surfaces of a scene, besides opaque ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SurfaceKinds {
    pub(crate) cutouts: bool,
    pub(crate) tints: bool,
}

fn not_in_use(what: &'static str, users: usize) -> Result<(), Error> {
    if users == 0 { Ok(()) } else { Err(Error::InUse { what, users }) }
}
