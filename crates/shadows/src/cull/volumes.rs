//! The volumes that a caster must intersect to darken anything visible.

use glam::DVec3;
use shadowgraph_scene::ConvexVolume;

use super::receivers::ReceiverHull;
use super::supporting_planes::SupportingPlanes;

/// The sine of the angle to a parallel light below which an edge counts as a point, through which no plane is built.
const ALONG_LIGHT: f64 = 1e-6;

/// The sine of the angle to a light at a position below which an edge counts as a point.
const TOWARDS_POSITION: f64 = 1e-9;

impl ReceiverHull {
    /// Returns the volume outside which a caster cannot darken anything visible, for a light at infinity: the points
    /// whose shadows, cast along the light, hit the hull.
    ///
    /// `to_light` is the direction towards the light. Every plane is moved outward by `pad_m` (metres, at least 0): points
    /// nearer than that to the volume are inside too.
    ///
    /// It is bounded by the faces that point away from the light, and at the sides by planes through the hull's
    /// silhouette as seen from the light. A zero direction returns the whole space.
    #[must_use]
    pub fn swept_towards(&self, to_light: DVec3, pad_m: f64) -> ConvexVolume {
        let Some(to_light) = to_light.try_normalize() else { return ConvexVolume::default() };
        let mut planes = SupportingPlanes::new(self.corners(), pad_m);
        // Points inside stay inside on the way to the light.
        for face in self.faces().iter().filter(|face| face.normal.dot(to_light) >= 0.0) {
            planes.push(face.normal);
        }
        for [from, to] in self.edges() {
            let across = (to - from).cross(to_light);
            if across.length() > ALONG_LIGHT * (to - from).length() {
                // Orthogonalized against the light once more: an error here would grow with the distance.
                planes.push_if_outside(across.reject_from_normalized(to_light).normalize(), from);
            }
        }
        planes.into_volume()
    }

    /// Returns the volume outside which a caster cannot be between a light at a position and anything visible: the
    /// convex hull of this hull and the light.
    ///
    /// Every plane is moved outward by `pad_m` (metres, at least 0). A light inside returns the hull itself, a position
    /// that is not finite the whole space.
    #[must_use]
    pub fn hull_with(&self, light_position_world: DVec3, pad_m: f64) -> ConvexVolume {
        let light = light_position_world;
        let mut points = [light; 9];
        points[..8].copy_from_slice(self.corners());
        let mut planes = SupportingPlanes::new(&points, pad_m);
        // Faces that the light is in front of are moved out to it: nothing behind the light casts a shadow.
        for face in self.faces() {
            planes.push(face.normal);
        }
        for [from, to] in self.edges() {
            let (from, to) = (from - light, to - light);
            let across = from.cross(to);
            if across.length() > TOWARDS_POSITION * from.length() * to.length() {
                planes.push_if_outside(across.normalize(), light);
            }
        }
        planes.into_volume()
    }
}

#[cfg(test)]
mod tests;
