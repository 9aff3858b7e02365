//! Layouts of tiles.

use glam::DVec3;
use shadowgraph_shadows::{MAX_ATLAS_TILES, ShadowFilter, TileLayout, even_tiles, smallest_atlas_tile_px};

const SIZES_PX: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];

fn layouts() -> impl Iterator<Item = (usize, TileLayout)> {
    SIZES_PX.into_iter().flat_map(|size| (1..=64).map(move |count| (count, even_tiles(count, size))))
}

#[test]
fn tiles_are_inside_the_map_and_do_not_overlap() {
    for (count, layout) in layouts() {
        assert_eq!(layout.tiles.len(), count);
        for (i, tile) in layout.tiles.iter().enumerate() {
            assert!(tile.x + tile.width <= layout.size_px[0] && tile.y + tile.height <= layout.size_px[1]);
            assert_eq!((tile.width, tile.height), (layout.tile_px, layout.tile_px));
            assert!(layout.tiles[..i].iter().all(|other| !other.overlaps(tile)), "{layout:?}");
        }
    }
}

#[test]
fn the_border_is_as_wide_as_the_filters_radius() {
    for (filter, (_, layout)) in ShadowFilter::ALL.into_iter().flat_map(|f| layouts().map(move |l| (f, l))) {
        for tile in &layout.tiles {
            let (min, max) = tile.inner_uv(layout.size_px, filter.taps());
            let size = glam::Vec2::new(layout.size_px[0] as f32, layout.size_px[1] as f32);
            let (min, max) = (min * size, max * size);
            let radius = filter.kernel_radius_texels() - 1e-2;
            assert!(min.x - radius >= tile.x as f32 && min.y - radius >= tile.y as f32);
            assert!(max.x + radius <= (tile.x + tile.width) as f32);
            assert!(max.y + radius <= (tile.y + tile.height) as f32);
            assert!(min.cmplt(max).all());
        }
    }
}

#[test]
fn a_map_is_split_one_two_three_or_four_times_by_count() {
    for (count, per_row) in [(1, 1), (2, 2), (4, 2), (5, 3), (9, 3), (10, 4), (16, 4)] {
        assert_eq!(even_tiles(count, 2048).tile_px, 2048 / per_row, "{count}");
    }
    assert_eq!(even_tiles(MAX_ATLAS_TILES, 2048).tile_px, smallest_atlas_tile_px(2048));
    assert_eq!(even_tiles(1, 2048).size_px, [2048, 2048]);
}

#[test]
fn unused_rows_are_omitted() {
    assert_eq!(even_tiles(1, 4096).size_px, [4096, 4096]);
    assert_eq!(even_tiles(2, 4096).size_px, [4096, 2048]);
    assert_eq!(even_tiles(3, 4096).size_px, [4096, 4096]);
    assert_eq!(even_tiles(2, 2048).size_px, [2048, 1024]);
    assert_eq!(even_tiles(12, 2048).size_px, [2048, 1536]);
}

#[test]
fn more_tiles_than_fit_are_not_laid_out() {
    assert_eq!(even_tiles(65, 1024).tiles.len(), 64);
}

#[test]
fn clip_space_of_a_tile_is_its_pixels_with_y_down() {
    for (_, layout) in layouts() {
        for tile in &layout.tiles {
            let map_from_clip = tile.map_from_clip(layout.size_px);
            let size = DVec3::new(f64::from(layout.size_px[0]), f64::from(layout.size_px[1]), 1.0);
            let top_left = map_from_clip.project_point3(DVec3::new(-1.0, 1.0, 0.25)) * size;
            let bottom_right = map_from_clip.project_point3(DVec3::new(1.0, -1.0, 0.25)) * size;
            let corner = DVec3::new(f64::from(tile.x), f64::from(tile.y), 0.25);
            assert!((top_left - corner).abs().max_element() < 1e-9);
            let across = DVec3::new(f64::from(tile.width), f64::from(tile.height), 0.0);
            assert!((bottom_right - corner - across).abs().max_element() < 1e-9);
        }
    }
}
