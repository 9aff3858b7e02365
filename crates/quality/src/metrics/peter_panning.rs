//! How far shadows begin from what casts them (peter-panning).

use glam::{DVec2, Vec3};
use serde::{Deserialize, Serialize};

use super::surface::parted;
use super::{Samples, Summary};

/// A blocker nearer than this, metres, or than a shadow texel is one that the receiver touches.
pub const CONTACT_M: f32 = 0.05;

/// Lights nearer to the normal than this sine cast a shadow that has no direction.
const STEEP: f32 = 0.1;

/// How far from contacts the first shadowed pixel is, along the way that the light goes on the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PeterPanning {
    /// Centimetres, over all contacts. 0 where the contact itself is dark.
    pub cm: Summary,
    /// Shadow texels at the contact, over the contacts where their size is known.
    pub texels: Summary,
    /// At how many contacts there was no shadowed pixel before the true shadow or the surface ended. They
    /// count with the way up to there.
    pub lost: usize,
}

/// Measures the peter_panning.
///
/// A *contact* is a receiver that is truly dark, by a blocker nearer than [`CONTACT_M`] or a shadow texel,
/// whichever is more, and that has a 4-neighbour on the light's side which shows another piece of surface (a
/// silhouette or crease between) or is no receiver. On the light's side: the step to it on screen has a
/// positive product with the step that goes towards the light along the surface. Surfaces within 6 degrees of
/// facing the light have no such step.
///
/// From the contact we walk away from the light, pixel by pixel. Each step is the one whose way in the world,
/// by the positions of neighbours on the same surface, follows the light's direction projected on the
/// contact's tangent plane; it is one pixel along the picture's axis that it is closer to. The walk ends at
/// the first pixel with visibility below 1/2. It is *lost* if it leaves the picture or the surface (counting
/// up to the last pixel on it), or comes to one that is truly lit or no receiver (counting up to that one).
/// What counts is the way in the world along the projected direction, centre to centre, so less than a pixel
/// is not samples.
#[must_use]
pub fn peter_panning(samples: &Samples<'_>) -> PeterPanning {
    let (mut cm, mut texels, mut lost) = (Vec::new(), Vec::new(), 0);
    for contact in samples.receivers().filter_map(|pixel| Contact::at(samples, pixel)) {
        let walk = contact.walk(samples);
        cm.push(walk.length_m * 100.0);
        let texel_m = samples.images.texel_m[contact.pixel];
        if texel_m > 0.0 {
            texels.push(walk.length_m / texel_m);
        }
        lost += usize::from(walk.lost);
    }
    PeterPanning { cm: Summary::of(&cm), texels: Summary::of(&texels), lost }
}

/// A pixel where a receiver touches what shadows it.
struct Contact {
    pixel: usize,
    /// Away from the light along the surface, unit length.
    away: Vec3,
    /// The step on screen that goes there, pixels.
    step: DVec2,
}

struct Walk {
    length_m: f32,
    lost: bool,
}

impl Contact {
    fn at(samples: &Samples<'_>, pixel: usize) -> Option<Self> {
        let images = &samples.images;
        let touches = images.blocker_distances_m[pixel] < CONTACT_M.max(images.texel_m[pixel]);
        if !touches || !samples.is_truly_dark(pixel) {
            return None;
        }
        let (normal, towards_light) = (images.geometric_normals[pixel], samples.towards_light(pixel));
        let along = towards_light - normal * normal.dot(towards_light);
        if along.length() < STEEP {
            return None;
        }
        let away = -along.normalize_or_zero();
        let step = step_along(samples, pixel, away)?;
        let beside_caster = [[1, 0], [-1, 0], [0, 1], [0, -1]].into_iter().any(|[right, down]| {
            let to_light = DVec2::new(right as f64, down as f64).dot(-step) > 0.0;
            let next = samples.beside(pixel, [right, down]);
            to_light && next.is_some_and(|next| !samples.is_receiver(next) || parted(samples, pixel, next))
        });
        beside_caster.then_some(Self { pixel, away, step })
    }

    fn walk(&self, samples: &Samples<'_>) -> Walk {
        let positions = samples.images.positions;
        let (mut here, mut step, mut length_m) = (self.pixel, self.step, 0.0);
        let mut offset = DVec2::ZERO;
        for _ in 0..samples.width + samples.height {
            if samples.is_dark(here) {
                return Walk { length_m, lost: false };
            }
            step = step_along(samples, here, self.away).unwrap_or(step);
            offset += step;
            let rounded = [offset.x.round() as isize, offset.y.round() as isize];
            let next = samples.beside(self.pixel, rounded).filter(|&next| !parted(samples, here, next));
            let Some(next) = next else { break };
            length_m = (positions[next] - positions[self.pixel]).dot(self.away).max(0.0);
            if !samples.is_receiver(next) || !samples.is_truly_dark(next) {
                break;
            }
            here = next;
        }
        Walk { length_m, lost: true }
    }
}

/// The step on screen, 1 along its longer axis, whose way in the world is nearest to a direction along the
/// surface. `None` if there are no neighbours on the same surface to tell.
fn step_along(samples: &Samples<'_>, pixel: usize, direction: Vec3) -> Option<DVec2> {
    let right = way(samples, pixel, [1, 0])?.as_dvec3();
    let down = way(samples, pixel, [0, 1])?.as_dvec3();
    let direction = direction.as_dvec3();
    let (rr, rd, dd) = (right.dot(right), right.dot(down), down.dot(down));
    let (r, d) = (right.dot(direction), down.dot(direction));
    let determinant = rr * dd - rd * rd;
    let step = DVec2::new(dd * r - rd * d, rr * d - rd * r);
    let longest = step.abs().max_element();
    (determinant > 1e-10 * rr * dd && longest > 0.0).then(|| step / longest)
}

/// The way in the world of one pixel along an axis, metres, by the neighbours on the same surface.
fn way(samples: &Samples<'_>, pixel: usize, [right, down]: [isize; 2]) -> Option<Vec3> {
    let on_surface = |step| {
        let next = samples.beside(pixel, step).filter(|&next| !parted(samples, pixel, next))?;
        Some(samples.images.positions[next] - samples.images.positions[pixel])
    };
    match (on_surface([right, down]), on_surface([-right, -down])) {
        (Some(ahead), Some(behind)) => Some((ahead - behind) * 0.5),
        (Some(ahead), None) => Some(ahead),
        (None, Some(behind)) => Some(-behind),
        (None, None) => None,
    }
}
