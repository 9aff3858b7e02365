use glam::{Vec2, Vec3, Vec4};
use proptest::prelude::*;
use shadowgraph_shadows::rays::{
    ChannelTexture, Cutout, Filter, GpuRayScene, NO_MATERIAL, NO_TEXTURE, Occluder, Ray, RayNode, RayScene,
    RayTexture, Surface, TINT, Tint, Wrap,
};

/// The function `ray_passed` of `rays.wgsl`, line by line.
fn transmittance(gpu: &GpuRayScene, origin: Vec3, direction: Vec3, ray: &Ray) -> Vec3 {
    let inverse = direction.to_array().map(|d| 1.0 / if d.abs() < 1e-20 { 1e-20 } else { d }).into();
    let root = gpu.nodes[0];
    let mut transmittance = Vec3::ONE;
    if entry_distance(root, origin, inverse) >= f32::MAX {
        return transmittance;
    }
    if root.count > 0 {
        let is_occluded = hits_any(gpu, root, ray, &mut transmittance);
        return if is_occluded { Vec3::ZERO } else { transmittance };
    }
    let (mut stack, mut height, mut pair) = ([0u32; 64], 0, root.first);
    loop {
        let [node, other] = [gpu.nodes[pair as usize], gpu.nodes[pair as usize + 1]];
        let hit = |node: RayNode| entry_distance(node, origin, inverse) < f32::MAX;
        let mut next = 0;
        for node in [node, other].into_iter().filter(|&node| hit(node)) {
            if node.count > 0 {
                if hits_any(gpu, node, ray, &mut transmittance) {
                    return Vec3::ZERO;
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
                return transmittance;
            }
            height -= 1;
            next = stack[height];
        }
        pair = next;
    }
}

fn entry_distance(node: RayNode, origin: Vec3, inverse: Vec3) -> f32 {
    let (a, b) = ((node.lowest - origin) * inverse, (node.highest - origin) * inverse);
    let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
    if leaves >= enters && leaves >= 0.0 { enters } else { f32::MAX }
}

fn hits_any(gpu: &GpuRayScene, node: RayNode, ray: &Ray, transmittance: &mut Vec3) -> bool {
    let triangles = &gpu.triangles[node.first as usize..(node.first + node.count) as usize];
    triangles.iter().any(|triangle| {
        ray.hit(triangle.corners())
            .is_some_and(|hit| is_opaque(gpu, triangle.material, hit.weights, transmittance))
    })
}

fn is_opaque(gpu: &GpuRayScene, index: u32, weights: Vec3, transmittance: &mut Vec3) -> bool {
    if index == NO_MATERIAL {
        return true;
    }
    let material = gpu.materials[index as usize];
    let uv = material.uv_a * weights.x + material.uv_b * weights.y + material.uv_c * weights.z;
    let channel = |channel| match material.texture {
        NO_TEXTURE => 1.0,
        texture => unpacked(gpu, gpu.textures[(texture + channel) as usize]).value(uv),
    };
    let factor = material.alpha.x * weights.x + material.alpha.y * weights.y + material.alpha.z * weights.z;
    let alpha = factor * channel(0);
    if material.cutoff != TINT {
        return alpha >= material.cutoff;
    }
    let channel_of = |color: u32, shift: u32| (color >> shift & 255) as f32 / 255.0;
    let corner = |color| Vec3::new(channel_of(color, 0), channel_of(color, 8), channel_of(color, 16));
    let [a, b, c] = material.color.map(corner);
    let color =
        (a * weights.x + b * weights.y + c * weights.z) * Vec3::new(channel(1), channel(2), channel(3));
    let alpha = alpha.clamp(0.0, 1.0);
    *transmittance *= (1.0 - alpha) * Vec3::ONE.lerp(color, alpha * (2.0 - alpha));
    false
}

/// Returns the texture of the packed words.
fn unpacked(gpu: &GpuRayScene, image: RayTexture) -> ChannelTexture {
    let texel = |index: u32| (gpu.texels[index as usize / 4] >> (8 * (index % 4))) as u8;
    let texels = (0..image.width * image.height).map(|i| texel(image.first_texel + i)).collect();
    let wrap = |bits: u32| [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][(bits & 3) as usize];
    let filter = if image.sampling & 16 == 0 { Filter::Nearest } else { Filter::Bilinear };
    let wraps = [wrap(image.sampling), wrap(image.sampling >> 2)];
    ChannelTexture::new([image.width, image.height], texels, wraps, filter).unwrap()
}

fn vector() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1f32..1.0).prop_map(Vec3::from)
}

fn textures() -> impl Strategy<Value = Vec<ChannelTexture>> {
    let wrap = || prop::sample::select(vec![Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]);
    let filter = prop::sample::select(vec![Filter::Nearest, Filter::Bilinear]);
    let one = (prop::collection::vec(any::<u8>(), 15), 0usize..3, wrap(), wrap(), filter).prop_map(
        |(texels, shape, u, v, filter)| {
            let size = [[3, 5], [5, 3], [1, 15]][shape];
            ChannelTexture::new(size, texels, [u, v], filter).unwrap()
        },
    );
    prop::collection::vec(one, 5)
}

fn occluder() -> impl Strategy<Value = Occluder> {
    (vector(), prop::array::uniform3(vector()), surface()).prop_map(|(center, corners, surface)| Occluder {
        corners: corners.map(|corner| center * 10.0 + corner * 3.0),
        surface,
    })
}

fn surface() -> impl Strategy<Value = Surface> {
    let uv = || prop::array::uniform3(prop::array::uniform2(-3f32..3.0).prop_map(Vec2::from));
    let texture = || prop::option::weighted(0.8, 0u32..2);
    let cutout = (texture(), uv(), prop::array::uniform3(0.3f32..1.5))
        .prop_map(|(texture, uv, alpha)| Surface::Cutout(Cutout { texture, uv, alpha, cutoff: 0.5 }));
    let color = prop::array::uniform3(prop::array::uniform4(0f32..1.0).prop_map(Vec4::from));
    let tint =
        (texture(), uv(), color).prop_map(|(texture, uv, color)| Surface::Tint(Tint { texture, uv, color }));
    prop_oneof![Just(Surface::Opaque), cutout, tint]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn the_tree_the_gpu_tree_and_brute_force_agree(
        occluders in prop::collection::vec(occluder(), 0..80),
        textures in textures(),
        rays in prop::collection::vec((vector(), vector()), 50),
    ) {
        let scene = RayScene::new(&occluders, textures).unwrap();
        let gpu = GpuRayScene::new(&scene, 1 << 27).unwrap();
        for (origin, direction) in rays {
            let (origin, direction) = (origin * 15.0, direction.normalize_or(Vec3::Y));
            let ray = Ray::new(origin, direction, 0.0, f32::INFINITY);
            let expected = scene.is_occluded_brute_force(&ray);
            prop_assert_eq!(scene.is_occluded(&ray), expected);
            prop_assert_eq!(scene.nearest_distance(&ray), scene.nearest_distance_brute_force(&ray));
            let all = scene.transmittance_brute_force(&ray);
            prop_assert_eq!(all == Vec3::ZERO, expected);
            // Products in another order.
            prop_assert!(scene.transmittance(&ray).abs_diff_eq(all, 1e-6));
            prop_assert!(transmittance(&gpu, origin, direction, &ray).abs_diff_eq(all, 1e-6));
        }
    }
}

#[test]
fn the_buffers_of_an_empty_scene_block_nothing_and_none_is_empty() {
    let gpu = GpuRayScene::new(&RayScene::new(&[], Vec::new()).unwrap(), 1 << 27).unwrap();
    let ray = Ray::new(Vec3::Y, Vec3::NEG_Y, 0.0, f32::INFINITY);
    assert_eq!(transmittance(&gpu, Vec3::Y, Vec3::NEG_Y, &ray), Vec3::ONE);
    assert_eq!(gpu.buffers().map(<[u8]>::len), [32, 48, 64, 16, 4]);
}
