//! Cameras: transform, reversed-depth projection, frustum.

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};
use serde::{Deserialize, Serialize};

use crate::bounds::{Aabb, ConvexVolume, Plane};

mod check;

pub use check::CameraError;

/// A camera. It looks along its -Z, +Y up, +X to the right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// The name in the file, if it has one.
    pub name: Option<String>,
    /// The transform of the camera. Rigid: a rotation and a translation, no scale.
    pub world_from_view: DAffine3,
    /// The projection.
    pub projection: Projection,
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Projection {
    /// A perspective projection.
    Perspective {
        /// The full vertical field of view, radians, above 0 and below π.
        fov_y: f64,
        /// The near plane, metres, above 0.
        near: f64,
        /// The far plane, metres, above `near`; `None`: infinitely far.
        far: Option<f64>,
    },
    /// An orthographic projection.
    ///
    /// If the aspect ratio of the image differs from `half_width : half_height`, the view is extended to the sides or
    /// above and below, so that nothing is stretched or cropped.
    Orthographic {
        /// Half of the least visible width, metres, above 0.
        half_width: f64,
        /// Half of the least visible height, metres, above 0.
        half_height: f64,
        /// The near plane, metres.
        near: f64,
        /// The far plane, metres, above `near`.
        far: f64,
    },
}

impl Camera {
    /// Moves the camera to a node, whose scale is ignored. Where the node has no direction, because its scale is 0, the camera keeps
    /// its own.
    pub fn follow(&mut self, world_from_node: &DAffine3) {
        self.world_from_view = Self::world_from_view_at_node(world_from_node)
            .unwrap_or(DAffine3 { translation: world_from_node.translation, ..self.world_from_view });
    }

    /// Returns the transform of a camera at a node, without its scale; `None` if the node has no direction.
    pub(crate) fn world_from_view_at_node(world_from_node: &DAffine3) -> Option<DAffine3> {
        let back = world_from_node.matrix3.z_axis.try_normalize()?;
        let right = world_from_node.matrix3.y_axis.cross(back).try_normalize()?;
        let rotation = DMat3::from_cols(right, back.cross(right), back);
        Some(DAffine3::from_mat3_translation(rotation, world_from_node.translation))
    }

    /// Creates a camera at `eye` that looks at `target` with `up` upwards in the image.
    ///
    /// If the direction is undefined (`eye` equals `target`, or `up` lies along the view) an arbitrary one is chosen.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_scene::{Camera, Projection};
    /// let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: None };
    /// let camera = Camera::look_at(DVec3::new(0.0, 2.0, 5.0), DVec3::ZERO, DVec3::Y, projection);
    /// assert_eq!(camera.position_world(), DVec3::new(0.0, 2.0, 5.0));
    /// assert!(camera.forward_world().z < 0.0);
    /// ```
    #[must_use]
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, projection: Projection) -> Self {
        let back = (eye - target).try_normalize().unwrap_or(DVec3::Z);
        let right = [up, DVec3::Y, DVec3::Z]
            .into_iter()
            .find_map(|up| up.cross(back).try_normalize())
            .unwrap_or_else(|| back.any_orthonormal_vector());
        let rotation = DMat3::from_cols(right, back.cross(right), back);
        Self { name: None, world_from_view: DAffine3::from_mat3_translation(rotation, eye), projection }
    }

    /// Creates a camera that frames `bounds` from the front, the right and above.
    ///
    /// It has a vertical field of view of 45 degrees and is as near as possible with every corner of the box in an
    /// image of the aspect ratio `aspect` (width over height). The near and far planes follow from the size of the
    /// box. Empty bounds are replaced by a box of 1 m around the origin.
    #[must_use]
    pub fn framing(bounds: &Aabb, aspect: f64) -> Self {
        Self::framing_points(bounds.corners(), bounds, aspect)
    }

    /// Creates a camera like [`framing`](Self::framing), but as near as possible with every one of some points in the image, all of
    /// them within `bounds`.
    #[must_use]
    pub fn framing_points(points: impl IntoIterator<Item = DVec3>, bounds: &Aabb, aspect: f64) -> Self {
        let fov_y = 45f64.to_radians();
        if bounds.is_empty() {
            let bounds = Aabb { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) };
            return Self::framing(&bounds, aspect);
        }
        let center = bounds.center();
        // A single point needs some distance too, relative to its coordinates.
        let radius = bounds.radius().max(1e-3).max(center.abs().max_element() * 1e-6);
        let (azimuth, elevation) = (35f64.to_radians(), 28f64.to_radians());
        let to_eye =
            DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
        let near = radius * 0.002;
        let aim = Self::look_at(
            center + to_eye * radius,
            center,
            DVec3::Y,
            Projection::Perspective { fov_y, near, far: None },
        );
        let fit = fit(points, center, &aim, fov_y, aspect, radius);
        let eye = center + aim.world_from_view.transform_vector3(fit.eye_from_center);
        // Beyond the points are their shadows on the ground.
        let far = (fit.farthest + FAR_RADII * radius).max(near * 2.0);
        let near = near.max(fit.nearest * 0.5);
        Self {
            world_from_view: DAffine3::from_mat3_translation(aim.world_from_view.matrix3, eye),
            projection: Projection::Perspective { fov_y, near, far: Some(far) },
            ..aim
        }
    }

    /// Returns the position of the camera, metres.
    #[must_use]
    pub fn position_world(&self) -> DVec3 {
        self.world_from_view.translation
    }

    /// Returns the view direction, unit length.
    #[must_use]
    pub fn forward_world(&self) -> DVec3 {
        -self.world_from_view.matrix3.z_axis
    }

    /// Returns the matrix from absolute world space to view space.
    #[must_use]
    pub fn view_from_world(&self) -> DMat4 {
        DMat4::from(self.world_from_view.inverse())
    }

    /// Returns the reversed-depth projection: x and y -1 to 1 with y up, z 1 at the near plane and 0 at
    /// the far plane or infinitely far.
    ///
    /// `aspect` is the image's width over its height, above 0.
    #[must_use]
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        match self.projection {
            Projection::Perspective { fov_y, near, far } => {
                let scale_y = 1.0 / (fov_y * 0.5).tan();
                let (z, offset) = match far {
                    Some(far) => (near / (far - near), near * far / (far - near)),
                    None => (0.0, near),
                };
                DMat4::from_cols(
                    DVec4::X * (scale_y / aspect),
                    DVec4::Y * scale_y,
                    DVec4::new(0.0, 0.0, z, -1.0),
                    DVec4::Z * offset,
                )
            }
            Projection::Orthographic { near, far, .. } => {
                let half = self.half_size(aspect, near);
                let scale_z = 1.0 / (far - near);
                DMat4::from_cols(
                    DVec4::X / half.x,
                    DVec4::Y / half.y,
                    DVec4::Z * scale_z,
                    DVec4::new(0.0, 0.0, far * scale_z, 1.0),
                )
            }
        }
    }

    /// Returns the view frustum in absolute world space: four side planes, near, and far if it is finite.
    #[must_use]
    pub fn frustum(&self, aspect: f64) -> ConvexVolume {
        let sides = match self.projection {
            Projection::Perspective { .. } => {
                let half = self.half_size(aspect, 1.0);
                [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(x, y)| {
                    let slope: f64 = if y == 0.0 { half.x } else { half.y };
                    (DVec3::ZERO, DVec3::new(x, y, -slope).normalize())
                })
            }
            Projection::Orthographic { near, .. } => {
                let half = self.half_size(aspect, near);
                [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y]
                    .map(|inward| (-inward * half.extend(0.0), inward))
            }
        };
        let near = (DVec3::NEG_Z * self.near(), DVec3::NEG_Z);
        let far = self.far().map(|far| (DVec3::NEG_Z * far, DVec3::Z));
        let planes = sides.into_iter().chain([near]).chain(far).map(|(point, normal)| {
            Plane::through(
                self.world_from_view.transform_point3(point),
                self.world_from_view.transform_vector3(normal),
            )
        });
        ConvexVolume { planes: planes.collect() }
    }

    /// Returns the corners of the frustum slice between the distances `near` and `far`, in view space.
    ///
    /// Bit 0 of the index selects x, bit 1 y (set: positive), bit 2 the distance (set: `far`).
    #[must_use]
    pub fn slice_corners_view(&self, aspect: f64, near: f64, far: f64) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let distance = if i & 4 == 0 { near } else { far };
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            let half = self.half_size(aspect, distance);
            DVec3::new(half.x * sign(1), half.y * sign(2), -distance)
        })
    }

    /// Returns the distance of the near plane, metres.
    #[must_use]
    pub fn near(&self) -> f64 {
        match self.projection {
            Projection::Perspective { near, .. } | Projection::Orthographic { near, .. } => near,
        }
    }

    /// Returns the distance of the far plane, metres; `None`: infinitely far.
    #[must_use]
    pub fn far(&self) -> Option<f64> {
        match self.projection {
            Projection::Perspective { far, .. } => far,
            Projection::Orthographic { far, .. } => Some(far),
        }
    }

    /// Moves the far plane of a perspective camera; `None`: infinitely far. An orthographic camera keeps its own.
    pub fn set_far(&mut self, distance: Option<f64>) {
        if let Projection::Perspective { far, .. } = &mut self.projection {
            *far = distance;
        }
    }

    /// Returns half of the visible width and height at a distance, metres.
    fn half_size(&self, aspect: f64, distance: f64) -> DVec2 {
        match self.projection {
            Projection::Perspective { fov_y, .. } => {
                let half_height = (fov_y * 0.5).tan() * distance;
                DVec2::new(half_height * aspect, half_height)
            }
            Projection::Orthographic { half_width, half_height, .. } => {
                DVec2::new(half_width.max(half_height * aspect), half_height.max(half_width / aspect))
            }
        }
    }
}

/// The distance of the far plane behind the points that a camera frames, in their radii.
const FAR_RADII: f64 = 6.0;

/// The eye position that frames some points, and their depth range from there.
struct Fit {
    /// The eye relative to the centre, in the axes of the camera, metres.
    eye_from_center: DVec3,
    /// The distances of the nearest and the farthest point along the view, metres.
    nearest: f64,
    farthest: f64,
}

/// Finds the nearest eye that sees every point, shifted sideways so that they are centred.
fn fit(
    points: impl IntoIterator<Item = DVec3>,
    center: DVec3,
    aim: &Camera,
    fov_y: f64,
    aspect: f64,
    radius: f64,
) -> Fit {
    const MARGIN: f64 = 1.06;
    let tan_y = (fov_y * 0.5).tan() / MARGIN;
    let tan = DVec2::new(tan_y * aspect, tan_y);
    let to_view = aim.world_from_view.matrix3.transpose();
    // Along an axis the edges of the frustum are lines of slope ±tan. The eye lies where the tangent to the points
    // from above meets the tangent from below.
    let [mut right, mut left, mut above, mut below] = [f64::MIN; 4];
    let (mut highest_z, mut lowest_z) = (f64::MIN, f64::MAX);
    for point in points {
        let point = to_view * (point - center);
        right = right.max(point.x + tan.x * point.z);
        left = left.max(tan.x * point.z - point.x);
        above = above.max(point.y + tan.y * point.z);
        below = below.max(tan.y * point.z - point.y);
        (highest_z, lowest_z) = (highest_z.max(point.z), lowest_z.min(point.z));
    }
    let eye = |positive: f64, negative: f64, tan: f64| {
        ((positive - negative) * 0.5, (positive + negative) * 0.5 / tan)
    };
    let (x, distance_x) = eye(right, left, tan.x);
    let (y, distance_y) = eye(above, below, tan.y);
    let distance = distance_x.max(distance_y).max(highest_z + radius * 0.1);
    Fit {
        eye_from_center: DVec3::new(x, y, distance),
        nearest: distance - highest_z,
        farthest: distance - lowest_z,
    }
}

#[cfg(test)]
mod tests;
