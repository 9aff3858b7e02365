//! Meshes and rays for the tests.

use glam::{DAffine3, Vec2, Vec3};
use shadowgraph_shadows::rays::{
    ChannelTexture, Cutout, Error, Filter, Instance, Ray, RayScene, RayTextureKey, ReceiverPoint, Surface,
    Wrap,
};

/// A triangle and its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Occluder {
    pub(crate) corners: [Vec3; 3],
    pub(crate) surface: Surface,
}

impl Occluder {
    pub(crate) fn opaque(corners: [Vec3; 3]) -> Self {
        Self { corners, surface: Surface::Opaque }
    }
}

/// Adds triangles as a mesh with one instance where they are.
pub(crate) fn insert(scene: &mut RayScene, occluders: &[Occluder]) -> Result<(), Error> {
    let corners: Vec<_> = occluders.iter().map(|occluder| occluder.corners).collect();
    let surfaces: Vec<_> = occluders.iter().map(|occluder| occluder.surface).collect();
    let mesh = scene.insert_mesh(&corners)?;
    let surfaces = Some(scene.insert_surfaces(&surfaces)?);
    scene.insert_instance(Instance { mesh, surfaces, world_from_mesh: DAffine3::IDENTITY }).map(drop)
}

/// Returns two triangles, from `corner` along `u` and `v`.
pub(crate) fn quad(corner: Vec3, u: Vec3, v: Vec3) -> Vec<Occluder> {
    let across = corner + u + v;
    [[corner, corner + u, across], [corner, across, corner + v]].map(Occluder::opaque).to_vec()
}

/// Returns a horizontal square around (0, `height`, 0).
pub(crate) fn level_square(height: f32, half: f32) -> Vec<Occluder> {
    quad(Vec3::new(-half, height, -half), Vec3::X * 2.0 * half, Vec3::Z * 2.0 * half)
}

/// Returns the same with an alpha test, the texture stretched once over it: u along x, v along z.
pub(crate) fn cutout_square(
    height: f32,
    half: f32,
    texture: Option<RayTextureKey>,
    alpha: f32,
) -> Vec<Occluder> {
    let uv = |p: Vec3| Vec2::new(p.x + half, p.z + half) / (2.0 * half);
    let with_cutout = |o: Occluder| {
        let cutout = Cutout { texture, uv: o.corners.map(uv), alpha: [alpha; 3], cutoff: 0.5 };
        Occluder { surface: Surface::Cutout(cutout), ..o }
    };
    level_square(height, half).into_iter().map(with_cutout).collect()
}

pub(crate) fn texture(size_px: [u32; 2], texels: &[u8], wrap: Wrap, filter: Filter) -> ChannelTexture {
    ChannelTexture::new(size_px, texels.to_vec(), [wrap; 2], filter).unwrap()
}

pub(crate) fn scene(occluders: &[Occluder]) -> RayScene {
    let mut scene = RayScene::default();
    insert(&mut scene, occluders).unwrap();
    scene
}

pub(crate) fn ray(origin: Vec3, to: Vec3) -> Ray {
    Ray::new(origin, (to - origin).normalize(), 0.0, f32::INFINITY)
}

/// Returns a receiver on a horizontal floor, seen from above.
pub(crate) fn on_floor(position: Vec3) -> ReceiverPoint {
    ReceiverPoint { position, geometric_normal: Vec3::Y, view_distance_m: 10.0 }
}

/// Returns the triangles of a sphere of radius 1: an icosahedron, subdivided `times` times.
pub(crate) fn sphere(times: u32) -> Vec<[Vec3; 3]> {
    let g = (1.0 + 5f32.sqrt()) / 2.0;
    let corners: Vec<Vec3> = [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)]
        .into_iter()
        .flat_map(|(a, b)| [Vec3::new(a, b, 0.0), Vec3::new(0.0, a, b), Vec3::new(b, 0.0, a)])
        .collect();
    let near = |a: Vec3, b: Vec3| a != b && a.distance(b) < 2.1;
    let mut triangles = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        for (j, &b) in corners.iter().enumerate().skip(i) {
            let third = |&&c: &&Vec3| near(a, b) && near(b, c) && near(a, c);
            triangles.extend(corners.iter().skip(j).filter(third).map(|&c| [a, b, c].map(Vec3::normalize)));
        }
    }
    for _ in 0..times {
        let four = |[a, b, c]: [Vec3; 3]| {
            let [d, e, f] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(four).collect();
    }
    triangles
}
