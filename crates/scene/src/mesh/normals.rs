//! Normals for meshes whose normals are missing or invalid.

use glam::{DVec3, Vec3};

use super::{Mesh, MorphDelta, MorphTarget, Vertex, position};

impl Mesh {
    /// Gives every triangle its own three vertices, with the triangle's own normal, also where morph targets displace it.
    ///
    /// glTF requires this for meshes without normals. The mesh then has one vertex per index.
    pub fn flat_normals(&mut self) {
        let mut vertices = Vec::with_capacity(self.indices.len());
        // Most meshes do not deform.
        let deforms = self.skin.is_some() || !self.morph_targets.is_empty();
        let mut sources = Vec::new();
        for indices in self.indices.as_chunks::<3>().0 {
            let Some(corners) = corners(*indices, &self.vertices) else { continue };
            let normal = to_array(face_normal(&corners).unwrap_or(DVec3::Z));
            vertices.extend(corners.map(|corner| Vertex { normal, ..corner }));
            if deforms {
                sources.extend(*indices);
            }
        }
        self.indices = (0u32..).take(vertices.len()).collect();
        self.vertices = vertices;
        self.skin = self.skin.as_ref().map(|skin| skin.select(&sources));
        for target in &mut self.morph_targets {
            let mut deltas = select(target.deltas(), &sources);
            flat_deltas(&self.vertices, &mut deltas);
            *target = MorphTarget::new(deltas);
        }
    }

    /// Gives every vertex the mean normal of its adjacent triangles, weighted by their angles at the vertex.
    pub fn smooth_normals(&mut self) {
        let normals = self.angle_weighted_normals();
        for (vertex, normal) in self.vertices.iter_mut().zip(normals) {
            vertex.normal = normal.to_array();
        }
    }

    /// Normalizes all normals, and replaces those without a direction (zero or not finite) by the mean normal of the
    /// adjacent triangles. Returns the number of replaced ones.
    pub fn repair_normals(&mut self) -> usize {
        let mut invalid = Vec::new();
        for (i, vertex) in self.vertices.iter_mut().enumerate() {
            match unit(Vec3::from(vertex.normal)) {
                Some(normal) => vertex.normal = normal.to_array(),
                None => invalid.push(i),
            }
        }
        if !invalid.is_empty() {
            let normals = self.angle_weighted_normals();
            for i in &invalid {
                if let (Some(vertex), Some(normal)) = (self.vertices.get_mut(*i), normals.get(*i)) {
                    vertex.normal = normal.to_array();
                }
            }
        }
        invalid.len()
    }

    fn angle_weighted_normals(&self) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; self.vertices.len()];
        for indices in self.indices.as_chunks::<3>().0 {
            let Some(corners) = corners(*indices, &self.vertices) else { continue };
            let Some(normal) = face_normal(&corners) else { continue };
            for (index, angle) in indices.iter().zip(angles(&corners)) {
                if let Some(sum) = sums.get_mut(*index as usize) {
                    *sum += (normal * angle).as_vec3();
                }
            }
        }
        sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(Vec3::Z)).collect()
    }
}

/// Returns the elements with these indices.
fn select<T: Copy>(elements: &[T], indices: &[u32]) -> Vec<T> {
    indices.iter().filter_map(|index| elements.get(*index as usize).copied()).collect()
}

/// Sets the change of the normal of each displaced triangle.
fn flat_deltas(vertices: &[Vertex], deltas: &mut [MorphDelta]) {
    for (corners, deltas) in vertices.as_chunks::<3>().0.iter().zip(deltas.as_chunks_mut::<3>().0) {
        let mut displaced = *corners;
        for (corner, delta) in displaced.iter_mut().zip(&*deltas) {
            corner.position = (Vec3::from(corner.position) + Vec3::from(delta.position)).to_array();
        }
        let normal = Vec3::from(corners[0].normal);
        let change = face_normal(&displaced).map_or(Vec3::ZERO, |displaced| displaced.as_vec3() - normal);
        deltas.iter_mut().for_each(|delta| delta.normal = change.to_array());
    }
}

/// Returns the direction of a vector of any length; `None` if it has none.
pub(super) fn unit(vector: Vec3) -> Option<Vec3> {
    vector.as_dvec3().try_normalize().map(|unit| unit.as_vec3())
}

/// Returns the vertices of a triangle; `None` if an index is out of range.
pub(super) fn corners(indices: [u32; 3], vertices: &[Vertex]) -> Option<[Vertex; 3]> {
    let [a, b, c] = indices.map(|index| vertices.get(index as usize).copied());
    Some([a?, b?, c?])
}

/// Returns the angles of a triangle at its corners, radians.
pub(super) fn angles(corners: &[Vertex; 3]) -> [f64; 3] {
    let [a, b, c] = corners.each_ref().map(position);
    let angle = |corner: DVec3, first: DVec3, second: DVec3| {
        let edges = (first - corner).try_normalize().zip((second - corner).try_normalize());
        let Some((first, second)) = edges else {
            return 0.0;
        };
        first.dot(second).clamp(-1.0, 1.0).acos()
    };
    [angle(a, b, c), angle(b, c, a), angle(c, a, b)]
}

/// Returns the unit normal of a triangle; `None` if it has no area.
fn face_normal(corners: &[Vertex; 3]) -> Option<DVec3> {
    // In f64, so that neither tiny nor huge triangles lose their area.
    let [a, b, c] = corners.each_ref().map(position);
    (b - a).cross(c - a).try_normalize()
}

fn to_array(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}
