//! Peter-panning: the distance between a contact and the beginning of its shadow.

use glam::{DVec2, Vec3};
use serde::{Deserialize, Serialize};

use super::samples::{Samples, is_disconnected};
use super::visibility::Summary;

/// A receiver touches a blocker that is nearer than this, metres, or than a shadow texel.
pub const CONTACT_M: f32 = 0.05;

/// Minimum sine of the angle between light and normal: a steeper light has no direction along the surface.
const STEEP: f32 = 0.1;

/// Distance from contacts to the first shadowed pixel along the projected light direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PeterPanning {
    /// Distance in centimetres, over all contacts. 0 where the contact itself is dark.
    pub cm: Summary,
    /// Distance in shadow texels, over the contacts where the size of a texel is known.
    pub texels: Summary,
    /// Number of contacts with no shadowed pixel before the reference shadow or the surface ends. They count with
    /// the distance up to there.
    #[serde(rename = "lost")]
    pub missing: usize,
}

/// Measures peter-panning.
///
/// A *contact* is a receiver that should be dark, by a blocker nearer than [`CONTACT_M`] or a shadow texel,
/// whichever is larger, and that has a 4-neighbour on the light's side that is disconnected from it (by a
/// silhouette or crease) or not a receiver. On the light's side: the step to it on screen has a
/// positive product with the step that goes towards the light along the surface. Surfaces within 6 degrees of
/// facing the light have no such step.
///
/// From the contact we walk away from the light, pixel by pixel. Each step is the one whose way in the world,
/// by the positions of neighbours on the same surface, follows the light's direction projected on the
/// contact's tangent plane; it is one pixel along the image's axis that it is closer to. The walk ends at
/// the first pixel with visibility below 1/2. It is *missing* if it leaves the image or the surface (counting
/// up to the last pixel on it), or reaches one that should be lit or is not a receiver (counting up to that one).
/// What counts is the way in the world along the projected direction, centre to centre, so less than a pixel
/// is not detected.
#[must_use]
pub fn peter_panning(samples: &Samples<'_>) -> PeterPanning {
    let (mut cm, mut texels, mut missing) = (Vec::new(), Vec::new(), 0);
    for contact in samples.receivers().filter_map(|pixel| Contact::find(samples, pixel)) {
        let walk = contact.walk(samples);
        cm.push(walk.length_m * 100.0);
        let texel_m = samples.images.texel_m[contact.pixel];
        if texel_m > 0.0 {
            texels.push(walk.length_m / texel_m);
        }
        missing += usize::from(walk.missing);
    }
    PeterPanning { cm: Summary::new(&cm), texels: Summary::new(&texels), missing }
}

/// A pixel where a receiver touches its blocker.
struct Contact {
    pixel: usize,
    /// Away from the light along the surface, unit length.
    away: Vec3,
    /// The step on screen in this direction, pixels.
    step: DVec2,
}

struct Walk {
    length_m: f32,
    missing: bool,
}

impl Contact {
    fn find(samples: &Samples<'_>, pixel: usize) -> Option<Self> {
        let images = &samples.images;
        let touches = images.blocker_distances_m[pixel] < CONTACT_M.max(images.texel_m[pixel]);
        if !touches || !samples.should_be_dark(pixel) {
            return None;
        }
        let (normal, towards_light) = (images.geometric_normals[pixel], samples.towards_light(pixel));
        let along = towards_light - normal * normal.dot(towards_light);
        if along.length() < STEEP {
            return None;
        }
        let away = -along.normalize_or_zero();
        let step = step_along(samples, pixel, away)?;
        let touches_caster = [[1, 0], [-1, 0], [0, 1], [0, -1]].into_iter().any(|[right, down]| {
            let to_light = DVec2::new(right as f64, down as f64).dot(-step) > 0.0;
            let next = samples.neighbour(pixel, [right, down]);
            to_light
                && next
                    .is_some_and(|next| !samples.is_receiver(next) || is_disconnected(samples, pixel, next))
        });
        touches_caster.then_some(Self { pixel, away, step })
    }

    fn walk(&self, samples: &Samples<'_>) -> Walk {
        let positions = samples.images.positions;
        let (mut here, mut step, mut length_m) = (self.pixel, self.step, 0.0);
        let mut offset = DVec2::ZERO;
        for _ in 0..samples.width + samples.height {
            if samples.is_dark(here) {
                return Walk { length_m, missing: false };
            }
            step = step_along(samples, here, self.away).unwrap_or(step);
            offset += step;
            let rounded = [offset.x.round() as isize, offset.y.round() as isize];
            let next =
                samples.neighbour(self.pixel, rounded).filter(|&next| !is_disconnected(samples, here, next));
            let Some(next) = next else { break };
            length_m = (positions[next] - positions[self.pixel]).dot(self.away).max(0.0);
            if !samples.is_receiver(next) || !samples.should_be_dark(next) {
                break;
            }
            here = next;
        }
        Walk { length_m, missing: true }
    }
}

/// The step on screen, 1 along its longer axis, whose way in the world is nearest to a direction along the
/// surface. `None` if there are no neighbours on the same surface.
fn step_along(samples: &Samples<'_>, pixel: usize, direction: Vec3) -> Option<DVec2> {
    let right = pixel_vector(samples, pixel, [1, 0])?.as_dvec3();
    let down = pixel_vector(samples, pixel, [0, 1])?.as_dvec3();
    let direction = direction.as_dvec3();
    let (rr, rd, dd) = (right.dot(right), right.dot(down), down.dot(down));
    let (r, d) = (right.dot(direction), down.dot(direction));
    let determinant = rr * dd - rd * rd;
    let step = DVec2::new(dd * r - rd * d, rr * d - rd * r);
    let longest = step.abs().max_element();
    (determinant > 1e-10 * rr * dd && longest > 0.0).then(|| step / longest)
}

/// The way in the world of one pixel along an axis, metres, by the neighbours on the same surface.
fn pixel_vector(samples: &Samples<'_>, pixel: usize, [right, down]: [isize; 2]) -> Option<Vec3> {
    let on_surface = |step| {
        let next = samples.neighbour(pixel, step).filter(|&next| !is_disconnected(samples, pixel, next))?;
        Some(samples.images.positions[next] - samples.images.positions[pixel])
    };
    match (on_surface([right, down]), on_surface([-right, -down])) {
        (Some(ahead), Some(behind)) => Some((ahead - behind) * 0.5),
        (Some(ahead), None) => Some(ahead),
        (None, Some(behind)) => Some(-behind),
        (None, None) => None,
    }
}
