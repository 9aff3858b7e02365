use glam::{Vec2, Vec3};
use proptest::prelude::*;
use shadowgraph_shadows::rays::{
    AlphaTexture, Cut, Filter, GpuRayScene, NO_CUT, NO_TEXTURE, Occluder, Ray, RayAlphaTexture, RayNode,
    RayScene, TriangleHit, Wrap,
};

/// `ray_blocked` of `rays.wgsl`, line by line.
fn blocked(gpu: &GpuRayScene, origin: Vec3, direction: Vec3, ray: &Ray) -> bool {
    let inverse = direction.to_array().map(|d| 1.0 / if d.abs() < 1e-20 { 1e-20 } else { d }).into();
    let root = gpu.nodes[0];
    if enters(root, origin, inverse) >= f32::MAX {
        return false;
    }
    if root.count > 0 {
        return leaf_blocks(gpu, root, ray);
    }
    let (mut stack, mut height, mut pair) = ([0u32; 64], 0, root.first);
    loop {
        let [node, other] = [gpu.nodes[pair as usize], gpu.nodes[pair as usize + 1]];
        let hit = |node: RayNode| enters(node, origin, inverse) < f32::MAX;
        let mut next = 0;
        for node in [node, other].into_iter().filter(|&node| hit(node)) {
            if node.count > 0 {
                if leaf_blocks(gpu, node, ray) {
                    return true;
                }
            } else if next == 0 {
                next = node.first;
            } else {
                stack[height] = node.first;
                height += 1;
            }
        }
        if next == 0 {
            if height == 0 {
                return false;
            }
            height -= 1;
            next = stack[height];
        }
        pair = next;
    }
}

fn enters(node: RayNode, origin: Vec3, inverse: Vec3) -> f32 {
    let (a, b) = ((node.lowest - origin) * inverse, (node.highest - origin) * inverse);
    let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
    if leaves >= enters && leaves >= 0.0 { enters } else { f32::MAX }
}

fn leaf_blocks(gpu: &GpuRayScene, node: RayNode, ray: &Ray) -> bool {
    let triangles = &gpu.triangles[node.first as usize..(node.first + node.count) as usize];
    let blocks = |hit: TriangleHit, cut: u32| cut == NO_CUT || !is_hole(gpu, cut, hit.weights);
    triangles.iter().any(|triangle| ray.hit(triangle.corners()).is_some_and(|hit| blocks(hit, triangle.cut)))
}

fn is_hole(gpu: &GpuRayScene, cut: u32, weights: Vec3) -> bool {
    let cut = gpu.cuts[cut as usize];
    let mut alpha = cut.alpha.x * weights.x + cut.alpha.y * weights.y + cut.alpha.z * weights.z;
    if cut.texture != NO_TEXTURE {
        let uv = cut.uv_a * weights.x + cut.uv_b * weights.y + cut.uv_c * weights.z;
        alpha *= unpacked(gpu, gpu.alpha_textures[cut.texture as usize]).alpha(uv);
    }
    alpha < cut.cutoff
}

/// The texture that the packed words stand for.
fn unpacked(gpu: &GpuRayScene, image: RayAlphaTexture) -> AlphaTexture {
    let texel = |index: u32| (gpu.alpha_texels[index as usize / 4] >> (8 * (index % 4))) as u8;
    let texels = (0..image.width * image.height).map(|i| texel(image.first_texel + i)).collect();
    let wrap = |bits: u32| [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][(bits & 3) as usize];
    let filter = if image.sampling & 16 == 0 { Filter::Nearest } else { Filter::Bilinear };
    let wraps = [wrap(image.sampling), wrap(image.sampling >> 2)];
    AlphaTexture::new([image.width, image.height], texels, wraps, filter).unwrap()
}

fn vector() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1f32..1.0).prop_map(Vec3::from)
}

fn textures() -> impl Strategy<Value = Vec<AlphaTexture>> {
    let wrap = || prop::sample::select(vec![Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]);
    let filter = prop::sample::select(vec![Filter::Nearest, Filter::Bilinear]);
    let one = (prop::collection::vec(any::<u8>(), 15), 0usize..3, wrap(), wrap(), filter).prop_map(
        |(texels, shape, u, v, filter)| {
            let size = [[3, 5], [5, 3], [1, 15]][shape];
            AlphaTexture::new(size, texels, [u, v], filter).unwrap()
        },
    );
    prop::collection::vec(one, 3)
}

fn occluder() -> impl Strategy<Value = Occluder> {
    let uv = prop::array::uniform3(prop::array::uniform2(-3f32..3.0).prop_map(Vec2::from));
    let cut = (prop::option::weighted(0.8, 0u32..3), uv, prop::array::uniform3(0.3f32..1.5))
        .prop_map(|(texture, uv, alpha)| Cut { texture, uv, alpha, cutoff: 0.5 });
    (vector(), prop::array::uniform3(vector()), prop::option::of(cut)).prop_map(|(center, corners, cut)| {
        Occluder { corners: corners.map(|corner| center * 10.0 + corner * 3.0), cut }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn the_tree_the_flat_tree_and_all_triangles_one_by_one_agree(
        occluders in prop::collection::vec(occluder(), 0..80),
        textures in textures(),
        rays in prop::collection::vec((vector(), vector()), 50),
    ) {
        let scene = RayScene::new(&occluders, textures).unwrap();
        let gpu = GpuRayScene::new(&scene, 1 << 27).unwrap();
        for (origin, direction) in rays {
            let (origin, direction) = (origin * 15.0, direction.normalize_or(Vec3::Y));
            let ray = Ray::new(origin, direction, 0.0, f32::INFINITY);
            let truth = scene.blocked_by_any_of_all(&ray);
            prop_assert_eq!(scene.blocked(&ray), truth);
            prop_assert_eq!(scene.nearest(&ray), scene.nearest_of_all(&ray));
            prop_assert_eq!(blocked(&gpu, origin, direction, &ray), truth);
        }
    }
}

#[test]
fn the_buffers_of_an_empty_scene_block_nothing_and_none_is_empty() {
    let gpu = GpuRayScene::new(&RayScene::new(&[], Vec::new()).unwrap(), 1 << 27).unwrap();
    let ray = Ray::new(Vec3::Y, Vec3::NEG_Y, 0.0, f32::INFINITY);
    assert!(!blocked(&gpu, Vec3::Y, Vec3::NEG_Y, &ray));
    assert_eq!(gpu.buffers().map(<[u8]>::len), [32, 48, 48, 16, 4]);
}
