//! Where a caster must be to darken anything visible.

use glam::DVec3;
use shadowgraph_scene::ConvexVolume;

use super::ReceiverHull;
use super::supports::Supports;

/// The sine of the angle to a parallel light below which an edge shows as a point: no plane goes through it.
const ALONG_LIGHT: f64 = 1e-6;

/// The same for an edge and a light at a place.
const TOWARDS_PLACE: f64 = 1e-9;

impl ReceiverHull {
    /// Returns the space outside which a caster is behind or beside everything visible, for a light from infinitely
    /// far: the points whose shadows, cast along the light, meet the hull.
    ///
    /// `to_light` is the way towards the light. Every plane is moved out by `pad_m` (metres, at least 0): what lies
    /// nearer than that to the space is inside too.
    ///
    /// It is what the faces that look towards the light leave open, closed at the sides by planes through the
    /// hull's outline as the light sees it. A direction without length gives all of space.
    #[must_use]
    pub fn swept_towards(&self, to_light: DVec3, pad_m: f64) -> ConvexVolume {
        let Some(to_light) = to_light.try_normalize() else { return ConvexVolume::default() };
        let mut planes = Supports::new(self.corners(), pad_m);
        // Who is inside stays inside on the way to the light.
        for face in self.faces().iter().filter(|face| face.normal.dot(to_light) >= 0.0) {
            planes.push(face.normal);
        }
        for [from, to] in self.edges() {
            let across = (to - from).cross(to_light);
            if across.length() > ALONG_LIGHT * (to - from).length() {
                // Once more upright on the light: an error here would grow with the distance.
                planes.push_if_outside(across.reject_from_normalized(to_light).normalize(), from);
            }
        }
        planes.into_volume()
    }

    /// Returns the space outside which a caster cannot stand between a light at a place and anything visible: the
    /// convex hull of this one and the light.
    ///
    /// Every plane is moved out by `pad_m` (metres, at least 0). A light inside gives the hull itself, a position
    /// that is not finite all of space.
    #[must_use]
    pub fn hull_with(&self, light_position_world: DVec3, pad_m: f64) -> ConvexVolume {
        let light = light_position_world;
        let mut points = [light; 9];
        points[..8].copy_from_slice(self.corners());
        let mut planes = Supports::new(&points, pad_m);
        // Faces that the light looks at are moved out to it: behind it there is nothing to cast a shadow.
        for face in self.faces() {
            planes.push(face.normal);
        }
        for [from, to] in self.edges() {
            let (from, to) = (from - light, to - light);
            let across = from.cross(to);
            if across.length() > TOWARDS_PLACE * from.length() * to.length() {
                planes.push_if_outside(across.normalize(), light);
            }
        }
        planes.into_volume()
    }
}

#[cfg(test)]
mod tests;
