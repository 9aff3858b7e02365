//! Contents that passes write, visited pass by pass.

use super::gpu::Gpu;
use crate::{BufferDesc, Contained, Contents, Format, Frame, Graph, Plan, Rect, Subresource, TextureDesc};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

/// Draws a frame and returns what was visited, with the names of pass and resource.
fn visit<'f>(gpu: &'f Gpu, declare: impl Fn(&mut Frame<'f>)) -> (Vec<Contained>, Plan) {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    declare(&mut frame);
    let mut visited = Vec::new();
    let compiled = graph.compile(frame).unwrap();
    let mut keep = |contained| {
        visited.push(contained);
        ControlFlow::Continue(())
    };
    let executed = compiled.execute_visited(&mut graph, &gpu.device, &gpu.queue, &mut keep).unwrap();
    (visited, executed.plan().clone())
}

fn gray(value: f64) -> Contents {
    Contents::clear_color([value; 4])
}

#[test]
fn each_version_is_visited_after_its_pass_with_the_part_that_was_written() {
    for gpu in Gpu::all() {
        let (visited, plan) = visit(&gpu, |frame| {
            let mut image = frame.create_texture("image", TextureDesc::d2(8, 4, Format::R8Unorm));
            frame.render_pass("all").color(&mut image, gray(0.2));
            let tile = Subresource::FULL.rect(Rect::new(2, 1, 3, 2));
            frame.render_pass("tile").subresource(tile).color(&mut image, gray(1.0));
            frame.export_texture(&image);
        });
        let name = |contained: &Contained| (plan.pass(contained.pass.unwrap()).name, contained.version);
        assert_eq!(visited.iter().map(name).collect::<Vec<_>>(), [("all", 1), ("tile", 2)]);
        let bytes: Vec<_> = visited.iter().map(|contained| contained.bytes.clone().unwrap()).collect();
        assert_eq!((bytes[0].len(), bytes[1].len()), (32, 6));
        if gpu.draws {
            assert!(bytes[0].iter().all(|&byte| byte == 51) && bytes[1].iter().all(|&byte| byte == 255));
        }
    }
}

#[test]
fn a_rectangle_of_depth_is_cut_out_of_a_copy_of_all() {
    for gpu in Gpu::all() {
        let (visited, _) = visit(&gpu, |frame| {
            let mut depth =
                frame.create_texture("depth", TextureDesc::d2(8, 4, Format::Depth32Float).layers(2));
            frame
                .render_pass("all")
                .subresource(Subresource::FULL.layer(1))
                .depth(&mut depth, Contents::clear_depth(0.5));
            let tile = Subresource::FULL.layer(1).rect(Rect::new(5, 1, 3, 2));
            frame.render_pass("tile").subresource(tile).depth(&mut depth, Contents::clear_depth(0.25));
            let mut pass = frame.render_pass("kept");
            pass.subresource(Subresource::FULL.layer(1)).depth_read(&depth);
            pass.keep();
        });
        let bytes: Vec<_> = visited.iter().map(|contained| contained.bytes.clone().unwrap()).collect();
        assert_eq!((bytes[0].len(), bytes[1].len()), (8 * 4 * 4, 3 * 2 * 4));
        if gpu.draws {
            assert!(bytes[1].as_chunks().0.iter().all(|&depth| f32::from_le_bytes(depth) == 0.25));
        }
    }
}

#[test]
fn imports_that_passes_read_come_first_and_what_cannot_be_copied_has_a_reason() {
    for gpu in Gpu::all() {
        let own = |usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: Format::R8Unorm,
                usage: usage | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let copied = own(wgpu::TextureUsages::COPY_SRC);
        let bound = own(wgpu::TextureUsages::empty());
        let (visited, plan) = visit(&gpu, |frame| {
            let copied = frame.import_texture("copied", &copied, true);
            let bound = frame.import_texture("bound", &bound, true);
            let mut samples =
                frame.create_texture("samples", TextureDesc::d2(4, 4, Format::R8Unorm).samples(4));
            let mut pass = frame.render_pass("draw");
            let _tokens = [pass.sample(&copied), pass.sample(&bound)];
            pass.color(&mut samples, gray(0.5));
            pass.keep();
        });
        let found: Vec<_> = visited
            .iter()
            .map(|contained| {
                let bytes = contained.bytes.as_ref().map(Vec::len);
                (plan.resource(contained.resource).name, contained.pass.is_some(), bytes.map_err(|_| ()))
            })
            .collect();
        assert_eq!(found, [("copied", false, Ok(16)), ("bound", false, Err(())), ("samples", true, Err(()))]);
    }
}

#[test]
fn mips_and_aspects_are_separate_and_buffers_have_their_range() {
    for gpu in Gpu::all() {
        let (visited, _) = visit(&gpu, |frame| {
            let desc = TextureDesc { mip_levels: 2, ..TextureDesc::d2(4, 4, Format::R8Unorm) };
            let mut mips = frame.create_texture("mips", desc);
            for mip in 0..2 {
                let part = Subresource::FULL.mip(mip);
                frame.render_pass("mip").subresource(part).color(&mut mips, gray(1.0));
            }
            let mut both = frame.create_texture("both", TextureDesc::d2(4, 4, Format::Depth24PlusStencil8));
            let mut pass = frame.render_pass("both");
            pass.depth(&mut both, Contents::clear_depth(0.5));
            pass.keep();
            let uploaded = frame.upload_buffer("uploaded", vec![1, 2, 3, 4, 5, 6, 7, 8]);
            frame.export_buffer(&uploaded);
            frame.export_texture(&mips);
        });
        let mut sizes: Vec<_> =
            visited.iter().map(|contained| contained.bytes.as_ref().map_or(0, Vec::len)).collect();
        sizes.sort_unstable();
        // The depth of 24 bits cannot be copied; the stencil of 4 x 4 texels can.
        assert_eq!(sizes, [0, 4, 8, 16, 16], "{visited:?}");
        let uploaded = visited
            .iter()
            .find(|contained| contained.bytes.as_ref().is_ok_and(|bytes| bytes.len() == 8))
            .unwrap();
        assert_eq!(uploaded.bytes, Ok(vec![1, 2, 3, 4, 5, 6, 7, 8]));
    }
}

#[test]
fn elements_of_an_unordered_buffer_are_sorted() {
    for gpu in Gpu::all() {
        let (visited, _) = visit(&gpu, |frame| {
            let source = frame.upload_buffer("source", vec![4, 1, 0, 0, 3, 2, 0, 0, 3, 1, 0, 0, 2, 9, 9, 9]);
            let mut list = frame.create_buffer("list", BufferDesc::new(16).unordered(4));
            frame.copy_pass("append").buffer(&source, &mut list);
            frame.export_buffer(&list);
        });
        let bytes = visited.last().unwrap().bytes.clone();
        if gpu.draws {
            assert_eq!(bytes, Ok(vec![2, 9, 9, 9, 3, 1, 0, 0, 3, 2, 0, 0, 4, 1, 0, 0]));
        }
    }
}

#[test]
fn passes_after_the_one_where_a_visit_breaks_do_not_run() {
    for gpu in Gpu::all() {
        let runs = AtomicU32::new(0);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut image = frame.create_texture("image", TextureDesc::d2(8, 4, Format::R8Unorm));
        for (name, x, width) in [("first", 0, 4), ("second", 4, 2), ("third", 6, 2)] {
            let mut pass = frame.render_pass(name);
            pass.subresource(Subresource::FULL.rect(Rect::new(x, 0, width, 4))).color(&mut image, gray(0.5));
            pass.body(|_| {
                runs.fetch_add(1, Ordering::Relaxed);
                Ok(())
            });
        }
        frame.export_texture(&image);
        let mut versions = Vec::new();
        let mut visit = |contained: Contained| {
            versions.push(contained.version);
            if contained.version == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        graph
            .compile(frame)
            .unwrap()
            .execute_visited(&mut graph, &gpu.device, &gpu.queue, &mut visit)
            .unwrap();
        assert_eq!((versions, runs.into_inner()), (vec![1, 2], 2));
    }
}
