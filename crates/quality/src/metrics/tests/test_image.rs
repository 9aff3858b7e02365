//! Images made by intersecting camera rays with a floor and a box, with their analytic truth.

use glam::{DVec2, DVec3, Vec3};

use crate::metrics::*;

/// A camera without roll unless `up` says so.
pub(super) struct Camera {
    pub(super) eye: DVec3,
    pub(super) target: DVec3,
    pub(super) up: DVec3,
    pub(super) fov_y: f64,
}

/// Corners of the box in images with a box: 1 m wide, on the floor.
pub(super) const BOX: [DVec3; 2] = [DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 1.0, 0.5)];

/// Camera that looks straight down, far enough to the side that the box's shaded sides are visible, turned so that they are
/// not along rows or columns.
pub(super) fn above() -> Camera {
    let eye = DVec3::new(1.5, 6.0, 2.0);
    Camera { eye, target: DVec3::new(1.5, 0.0, 2.0), up: DVec3::new(0.3, 0.0, -1.0), fov_y: 0.8 }
}

/// Camera at eye height, 10 degrees down on average; the floor fills the image.
pub(super) fn grazing() -> Camera {
    let eye = DVec3::new(2.0, 1.3, 6.0);
    Camera { eye, target: DVec3::new(0.4, 0.15, 0.0), up: DVec3::Y, fov_y: 0.3 }
}

/// Direction to the sun: behind the box as seen from the cameras, 30 degrees high.
pub(super) fn sun() -> DVec3 {
    DVec3::new(-0.6, 0.577, -0.8).normalize()
}

pub(super) struct TestImage {
    pub(super) size: [usize; 2],
    pub(super) pixel_m_at_1m: f32,
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) depths_m: Vec<f32>,
    /// 0 nothing, 1 floor, 2 and above the faces of the box.
    pub(super) faces: Vec<u8>,
    pub(super) n_dot_l: Vec<f32>,
    pub(super) visibility: Vec<f32>,
    pub(super) truth: Vec<f32>,
    pub(super) soft_truth: Option<Vec<f32>>,
    pub(super) blockers_m: Vec<f32>,
    pub(super) texel_px: Vec<f32>,
    pub(super) texel_m: Vec<f32>,
    towards_light: Vec3,
}

impl TestImage {
    /// A floor up to `floor_m` from the origin, with [`BOX`] or without. Visibility is the truth.
    pub(super) fn new([width, height]: [usize; 2], camera: &Camera, floor_m: f64, with_box: bool) -> Self {
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let pixel = 2.0 * (camera.fov_y / 2.0).tan() / height as f64;
        let n = width * height;
        let mut image = Self {
            size: [width, height],
            pixel_m_at_1m: pixel as f32,
            positions: vec![Vec3::ZERO; n],
            normals: vec![Vec3::ZERO; n],
            depths_m: vec![0.0; n],
            faces: vec![0; n],
            n_dot_l: vec![0.0; n],
            visibility: vec![],
            truth: vec![1.0; n],
            soft_truth: None,
            blockers_m: vec![f32::INFINITY; n],
            texel_px: vec![0.0; n],
            texel_m: vec![0.05; n],
            towards_light: sun().as_vec3(),
        };
        for at in 0..n {
            let center = DVec2::new(width as f64, height as f64) / 2.0;
            let place = (DVec2::new((at % width) as f64, (at / width) as f64) + 0.5 - center) * pixel;
            let ray = forward + right * place.x - right.cross(forward) * place.y;
            image.hit(at, camera.eye, ray, floor_m, with_box);
        }
        image.visibility = image.truth.clone();
        image
    }

    fn hit(&mut self, at: usize, eye: DVec3, ray: DVec3, floor_m: f64, with_box: bool) {
        let floor = Some(-eye.y / ray.y).filter(|&t| t > 0.0 && (eye + ray * t).length() < floor_m);
        let hit = with_box.then(|| enter_box(eye, ray)).flatten();
        let (t, normal, face) = match (hit, floor) {
            (Some((t, normal, face)), _) => (t, normal, face),
            (None, Some(t)) => (t, DVec3::Y, 1),
            (None, None) => return,
        };
        let position = eye + ray * t;
        self.positions[at] = position.as_vec3();
        self.normals[at] = normal.as_vec3();
        self.depths_m[at] = t as f32;
        self.faces[at] = face;
        self.n_dot_l[at] = normal.dot(sun()) as f32;
        let blocked = with_box.then(|| enter_box(position + normal * 1e-4, sun())).flatten();
        if let Some((distance_m, ..)) = blocked {
            self.truth[at] = 0.0;
            self.blockers_m[at] = distance_m as f32;
        }
    }

    /// Sets the hard truth, and the visibility to it, by the pixel.
    pub(super) fn with_truth(mut self, lit: impl Fn(usize, usize) -> bool) -> Self {
        self.truth = self.by_pixel(|x, y| f32::from(u8::from(lit(x, y))));
        self.visibility = self.truth.clone();
        self
    }

    /// Returns a image of what a function gives for each pixel.
    pub(super) fn by_pixel(&self, value: impl Fn(usize, usize) -> f32) -> Vec<f32> {
        (0..self.truth.len()).map(|at| value(at % self.size[0], at / self.size[0])).collect()
    }

    pub(super) fn images(&self) -> Images<'_> {
        Images {
            size_px: self.size.map(|side| side as u32),
            pixel_m_at_1m: self.pixel_m_at_1m,
            positions: &self.positions,
            geometric_normals: &self.normals,
            view_depths_m: &self.depths_m,
            n_dot_l: &self.n_dot_l,
            visibility: &self.visibility,
            truth: &self.truth,
            soft_truth: self.soft_truth.as_deref(),
            blocker_distances_m: &self.blockers_m,
            texel_px: &self.texel_px,
            texel_m: &self.texel_m,
            towards_light: TowardsLight::Uniform(self.towards_light),
        }
    }

    pub(super) fn seen(&self) -> Samples<'_> {
        Samples::new(self.images()).unwrap()
    }

    pub(super) fn all(&self) -> All {
        let samples = self.seen();
        let band = band(&samples);
        All {
            misclassified: misclassified(&samples, &band),
            mean_error: mean_error(&samples, &band),
            missing_contacts: missing_contacts(&samples),
            peter_panning: peter_panning(&samples),
            edges: edge_error(&samples),
        }
    }
}

/// Every metric of a image.
#[derive(Debug)]
pub(super) struct All {
    pub(super) misclassified: Misclassified,
    pub(super) mean_error: MeanError,
    pub(super) missing_contacts: MissingContacts,
    pub(super) peter_panning: PeterPanning,
    pub(super) edges: Option<EdgeError>,
}

/// Point where a ray enters the box from outside: distance along the ray, the face's normal, its number.
fn enter_box(origin: DVec3, ray: DVec3) -> Option<(f64, DVec3, u8)> {
    let (a, b) = ((BOX[0] - origin) / ray, (BOX[1] - origin) / ray);
    let (enter, leave) = (a.min(b), a.max(b));
    let t = enter.max_element();
    let axis = [enter.x, enter.y, enter.z].iter().position(|&side| side == t)?;
    let normal = -DVec3::AXES[axis] * ray[axis].signum();
    (t > 0.0 && t < leave.min_element()).then_some((t, normal, 2 + axis as u8))
}

/// Whether the box shadows a point of the floor: off the box itself, in the true shadow.
pub(super) fn box_shadows(point: DVec3) -> bool {
    let under = point.x > BOX[0].x && point.x < BOX[1].x && point.z > BOX[0].z && point.z < BOX[1].z;
    !under && enter_box(point.with_y(1e-4), sun()).is_some()
}
