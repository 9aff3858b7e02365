//! Seams between cascades, and the cost of shadows.

use super::comparator::texels;
use super::metrics::{RECEIVER_N_DOT_L, Summary, seam};
use super::report::Cost;
use super::texels::NO_VIEW;
use super::{Points, Probe, Query, Reference};
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// Maximum distance to a pixel of the next cascade at which a pixel is at the border, pixels.
const BORDER_PX: usize = 2;

/// Evaluates a technique twice at the surfaces of a view, once with the next coarser cascade, and compares the results along
/// the borders of cascades. Returns `None` where there is no such border, and what one frame cost.
///
/// # Errors
/// Settings out of range, or a failure of the GPU.
pub fn measure_seam(
    gpu: &Gpu,
    renderer: &Renderer,
    probe: &Probe,
    options: &ViewOptions,
    reference: &Reference,
    light: usize,
) -> Result<(Option<Summary>, Cost), Error> {
    let points = Points::new(gpu, &reference.surfaces);
    let evaluate = |coarser| {
        let query = Query { light: light as u32, coarser };
        probe.evaluate(gpu, renderer, options, &points, query)
    };
    // On some drivers the first evaluation compiles shaders, so the times are those of the second.
    let (own, coarser) = (evaluate(false)?, evaluate(true)?);
    // The views of the reference belong to other settings if variants are compared.
    let origin_world = renderer.casters().scene.origin_world();
    let views = texels(renderer, options, &reference.surfaces, light, origin_world)?.views;
    let is_border = |pixel: &usize| is_border(reference, &views, *pixel);
    let border: Vec<usize> = (0..own.visibility.len()).filter(is_border).collect();
    let at = |values: &[f32]| border.iter().map(|&pixel| values[pixel]).collect::<Vec<_>>();
    let difference = seam(&at(&own.visibility), &at(&coarser.visibility))?;
    Ok(((difference.count > 0).then_some(difference), coarser.cost))
}

/// Returns whether a pixel is a receiver near one that uses a coarser cascade.
fn is_border(reference: &Reference, views: &[u32], pixel: usize) -> bool {
    let [width, height] = reference.surfaces.size_px.map(|side| side as usize);
    let own = views[pixel];
    let counts = reference.surfaces.is_drawn(pixel) && reference.truth.n_dot_l[pixel] > RECEIVER_N_DOT_L;
    if !counts || own == NO_VIEW {
        return false;
    }
    let around = |at: usize, end: usize| at.saturating_sub(BORDER_PX)..(at + BORDER_PX + 1).min(end);
    let (x, y) = (pixel % width, pixel / width);
    around(y, height)
        .any(|y| around(x, width).map(|x| views[y * width + x]).any(|other| other != NO_VIEW && other > own))
}
