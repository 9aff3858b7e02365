//! Passes on subresources of textures: tiles, mips, layers and slices.

use super::gpu::{Gpu, NUMBERS, number, square};
use crate::{Bind, Contents, Error, Extent, Graph, Rect, Subresource, TextureDesc};

const CLEAR: Contents = Contents::Clear(crate::ClearValue::Color([0.0; 4]));

fn cleared(number: u32) -> Contents {
    Contents::clear_color([f64::from(number), 0.0, 0.0, 0.0])
}

#[test]
fn a_tile_has_the_viewport_and_scissor_of_its_rectangle() {
    for gpu in Gpu::all() {
        let draw = gpu.draw("place", NUMBERS);
        // Alone, and merged with a pass that was in another tile before it.
        for merge in [false, true] {
            let mut graph = Graph::new();
            let mut frame = graph.frame();
            frame.set_options(crate::Options { merge, ..Default::default() });
            let mut atlas = frame.create_texture("atlas", square(16));
            frame.render_pass("clear").color(&mut atlas, cleared(9999));
            for tile in [Rect::new(0, 8, 4, 4), Rect::new(8, 2, 8, 4)] {
                let mut pass = frame.render_pass("tile");
                pass.subresource(Subresource::FULL.rect(tile)).color(&mut atlas, Contents::Overwrite);
                let draw = &draw;
                pass.body(move |ctx| {
                    draw.record_without_bindings(ctx);
                    Ok(())
                });
            }
            let atlas = frame.export_texture(&atlas);
            let executed = gpu.run(&mut graph, frame);
            assert_eq!(executed.plan().steps().len(), if merge { 1 } else { 3 });
            if !gpu.draws {
                continue;
            }
            let texels = gpu.texels(executed.texture(atlas).unwrap(), 0, 0);
            let at = |x: usize, y: usize| texels[y * 16 + x];
            // Centres of texels in a tile of 4 are at 2, 6, 10 and 14 sixteenths.
            assert_eq!([at(0, 8), at(3, 8), at(0, 11), at(3, 11)], [202, 214, 1402, 1414]);
            assert_eq!([at(8, 2), at(15, 2), at(8, 5), at(15, 5)], [201, 215, 1401, 1415]);
            assert_eq!(texels.iter().filter(|&&texel| texel == 9999).count(), 256 - 16 - 32, "nothing else");
        }
    }
}

#[test]
fn only_a_tile_is_cleared_and_its_neighbours_are_kept() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        for frame_number in 0..3 {
            let mut frame = graph.frame();
            let mut atlas = frame.create_texture("atlas", square(16));
            frame.render_pass("first").color(&mut atlas, cleared(1));
            let tiles = [Rect::new(0, 0, 8, 8), Rect::new(5, 9, 3, 7), Rect::new(4, 4, 8, 8)];
            for (index, tile) in tiles.into_iter().enumerate() {
                let mut pass = frame.render_pass("tile");
                pass.subresource(Subresource::FULL.rect(tile))
                    .color(&mut atlas, cleared(index as u32 + 2 + frame_number));
            }
            let atlas = frame.export_texture(&atlas);
            let executed = gpu.run(&mut graph, frame);
            if !gpu.draws {
                continue;
            }
            let texels = gpu.texels(executed.texture(atlas).unwrap(), 0, 0);
            let inside = |tile: &Rect, x, y| {
                (tile.x..tile.x + tile.width).contains(&x) && (tile.y..tile.y + tile.height).contains(&y)
            };
            for (texel, at) in texels.iter().zip(0u32..) {
                let last = tiles.iter().rposition(|tile| inside(tile, at % 16, at / 16));
                let expected = last.map_or(1, |index| index as u32 + 2 + frame_number);
                assert_eq!(*texel, expected, "texel {at}");
            }
        }
    }
}

#[test]
fn single_mips_and_layers_are_drawn_into_and_bound() {
    for gpu in Gpu::all() {
        let (fill, load) = (gpu.draw("number", NUMBERS), gpu.draw("loaded", NUMBERS));
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let desc = TextureDesc { mip_levels: 2, ..square(8).layers(3) };
        let mut texture = frame.create_texture("texture", desc);
        for layer in 0..3 {
            let block = frame.uniform(&number(10 * layer));
            let mut pass = frame.render_pass("fill");
            pass.subresource(Subresource::FULL.mip(0).layer(layer)).color(&mut texture, Contents::Overwrite);
            let fill = &fill;
            pass.body(move |ctx| fill.record(ctx, &[Bind::Uniform(block)]));
            let mut pass = frame.render_pass("down");
            let from = pass.subresource(Subresource::FULL.mip(0).layer(layer)).sample(&texture);
            pass.subresource(Subresource::FULL.mip(1).layer(layer)).color(&mut texture, Contents::Overwrite);
            let load = &load;
            pass.body(move |ctx| load.record(ctx, &[Bind::Texture(from)]));
        }
        let texture = frame.export_texture(&texture);
        let executed = gpu.run(&mut graph, frame);
        if !gpu.draws {
            continue;
        }
        let texture = executed.texture(texture).unwrap();
        for layer in 0..3 {
            assert_eq!(gpu.texels(texture, 0, layer), [10 * layer; 64]);
            assert_eq!(gpu.texels(texture, 1, layer), [10 * layer + 1; 16]);
        }
    }
}

/// Describes a volume whose slices are cleared by separate passes.
fn volume(mips: u32) -> TextureDesc {
    TextureDesc {
        size: Extent { width: 8, height: 8, depth_or_array_layers: 4 },
        dimension: wgpu::TextureDimension::D3,
        mip_levels: mips,
        ..square(8)
    }
}

#[test]
fn slices_of_a_volume_are_attachments() {
    for gpu in Gpu::all() {
        let fill = gpu.draw("number", NUMBERS);
        let mut graph = Graph::new();
        for mip in [0, 1] {
            let mut frame = graph.frame();
            let mut volume = frame.create_texture("volume", volume(mip + 1));
            for mip in 0..=mip {
                for slice in 0..4 >> mip {
                    let block = frame.uniform(&number(7 + slice + 10 * mip));
                    let mut pass = frame.render_pass("slice");
                    let part = Subresource::FULL.mip(mip).layer(slice);
                    pass.subresource(part).color(&mut volume, Contents::Overwrite);
                    let fill = &fill;
                    pass.body(move |ctx| fill.record(ctx, &[Bind::Uniform(block)]));
                }
            }
            let volume = frame.export_texture(&volume);
            let executed = gpu.run(&mut graph, frame);
            for slice in 0..4 >> mip {
                let texels = gpu.texels(executed.texture(volume).unwrap(), mip, slice);
                assert!(texels.iter().all(|&t| t == 7 + slice + 10 * mip), "mip {mip}, {slice}: {texels:?}");
            }
        }
    }
}

#[test]
fn two_slices_of_a_volume_are_drawn_into_at_once() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut volume = frame.create_texture("volume", volume(1));
        for first in [0, 2] {
            let mut pass = frame.render_pass("slices");
            for slice in [first, first + 1] {
                pass.subresource(Subresource::FULL.layer(slice)).color(&mut volume, cleared(slice));
            }
        }
        let volume = frame.export_texture(&volume);
        let executed = gpu.run(&mut graph, frame);
        for slice in 0..4 {
            let texels = gpu.texels(executed.texture(volume).unwrap(), 0, slice);
            assert!(texels.iter().all(|&texel| texel == slice), "{slice}: {texels:?}");
        }
    }
}

#[test]
fn discarding_an_unread_slice_keeps_the_others() {
    // wgpu does not track slices: discarding one discards them all.
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut volume = frame.create_texture("volume", volume(1));
        frame.render_pass("read").subresource(Subresource::FULL.layer(0)).color(&mut volume, cleared(5));
        let mut pass = frame.render_pass("unread");
        pass.subresource(Subresource::FULL.layer(1)).color(&mut volume, cleared(6));
        pass.keep();
        let mut copy = frame.create_texture("copy", square(8));
        frame.copy_pass("copy").texture_region(
            &volume,
            Subresource::FULL.layer(0),
            &mut copy,
            Subresource::FULL,
        );
        let copy = frame.export_texture(&copy);
        let executed = gpu.run(&mut graph, frame);
        gpu.assert_filled(executed.texture(copy).unwrap(), 5);
    }
}

#[test]
fn a_slice_is_not_drawn_into_while_another_is_sampled() {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut volume = frame.create_texture("volume", volume(1));
    frame.render_pass("clear").subresource(Subresource::FULL.layer(0)).color(&mut volume, CLEAR);
    let mut pass = frame.render_pass("both");
    pass.subresource(Subresource::FULL.layer(0)).sample(&volume);
    pass.subresource(Subresource::FULL.layer(1)).color(&mut volume, CLEAR);
    pass.keep();
    let error = graph.compile(frame).err().unwrap();
    assert!(matches!(&error, Error::Conflict { pass, .. } if pass.path() == "both"), "{error}");
}

#[test]
fn storage_textures_are_bound_by_subresource() {
    // The noop device checks that the view has a single mip and layer, as storage textures must.
    let gpu = Gpu::noop();
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: NUMBERS,
                view_dimension: wgpu::TextureViewDimension::D2,
            },
            count: None,
        }],
    });
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut texture = frame.create_texture("texture", TextureDesc { mip_levels: 2, ..square(8).layers(2) });
    let part = Subresource::FULL.mip(1).layer(1);
    let mut pass = frame.compute_pass("write");
    let token = pass.subresource(part).storage_texture_mut(&mut texture, Contents::Overwrite);
    pass.keep();
    pass.body(|ctx| ctx.bind_group(&layout, &[Bind::Texture(token)]).map(|_| ()));
    gpu.run(&mut graph, frame);
}

#[test]
fn a_pass_without_a_body_clears() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut color = frame.create_texture("color", square(8));
        frame.render_pass("clear").color(&mut color, CLEAR);
        frame.render_pass("again").color(&mut color, cleared(8));
        let color = frame.export_texture(&color);
        let executed = gpu.run(&mut graph, frame);
        gpu.assert_filled(executed.texture(color).unwrap(), 8);
    }
}
