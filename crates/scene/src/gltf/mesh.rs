//! The geometry of primitives.

use ::gltf::json;
use json::mesh::{Mode, Primitive, Semantic};
use json::validation::Checked;

use super::buffers::Buffers;
use super::fault::{At, Fault, clean_name, fault, place};
use super::notes::Notes;
use super::triangles::{triangle_count, triangles};
use super::validate::{MAX_INDICES, MAX_VERTICES};
use crate::{Mesh, TextureRef, Vertex};

/// Reads primitives, and keeps count of what they need together.
pub(super) struct Reader<'a> {
    buffers: &'a Buffers<'a>,
    notes: &'a mut Notes,
    vertices_left: usize,
    indices_left: usize,
}

/// A primitive that is being read.
struct Source<'a> {
    primitive: &'a Primitive,
    place: String,
    /// How many vertices it has.
    count: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(buffers: &'a Buffers<'a>, notes: &'a mut Notes) -> Self {
        Self { buffers, notes, vertices_left: MAX_VERTICES, indices_left: MAX_INDICES }
    }

    /// Reads a primitive; `None` if there is nothing to draw. `normal_map` is the normal texture of its
    /// material, which missing tangents are made for.
    ///
    /// # Errors
    /// Names the attribute that is wrong.
    pub(super) fn primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        normal_map: Option<&TextureRef>,
    ) -> Result<Option<Mesh>, Fault> {
        let found = self.buffers.document().meshes.get(mesh);
        let name = found.and_then(|mesh| mesh.name.as_deref());
        let place = format!("{} primitive {primitive}", place("mesh", mesh, name));
        let Some(primitive) = found.and_then(|mesh| mesh.primitives.get(primitive)) else {
            return Err(fault(place, "does not exist"));
        };
        let mut source = Source { primitive, place, count: 0 };
        let Checked::Valid(mode) = primitive.mode else {
            return Err(fault(source.place, "unknown mode (allowed: 0 to 6)"));
        };
        if triangle_count(mode, 0).is_none() {
            self.notes.add(source.place, "points and lines are not drawn");
            return Ok(None);
        }
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            self.notes.add(&source.place, "morph targets are not drawn, the mesh is drawn at rest");
        }
        let Some(mut vertices) = self.positions(&mut source)? else { return Ok(None) };
        let indices = self.indices(&source, mode)?;
        if indices.is_empty() {
            self.notes.add(source.place, "it has no triangles and is not drawn");
            return Ok(None);
        }
        self.texture_coordinates(&source, &mut vertices)?;
        self.colors(&source, &mut vertices)?;
        let has_normals = self.normals(&source, &mut vertices)?;
        // Tangents without normals are to be ignored.
        let has_tangents = has_normals && self.tangents(&source, &mut vertices)?;
        let mut mesh = Mesh::new(clean_name(name), vertices, indices);
        self.finish(&mut mesh, has_normals, has_tangents, normal_map, &source)?;
        Ok(Some(mesh))
    }

    /// Makes the vertices, with their positions.
    fn positions(&mut self, source: &mut Source<'_>) -> Result<Option<Vec<Vertex>>, Fault> {
        let Some(accessor) = source.accessor(&Semantic::Positions) else {
            self.notes.add(&source.place, "it has no POSITION and is not drawn");
            return Ok(None);
        };
        let there = || source.at("POSITION", accessor);
        let positions = self.buffers.vectors(accessor, 3, [0.0; 3], self.vertices_left).at(there)?;
        if let Some(vertex) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
            let reason = format!("the position of vertex {vertex} is not finite (allowed: finite numbers)");
            return Err(fault(there(), reason));
        }
        source.count = positions.len();
        self.vertices_left -= positions.len();
        Ok(Some(positions.into_iter().map(|position| Vertex { position, ..Vertex::default() }).collect()))
    }

    /// Reads the indices as a triangle list.
    fn indices(&mut self, source: &Source<'_>, mode: Mode) -> Result<Vec<u32>, Fault> {
        let indices = match source.primitive.indices.map(|accessor| accessor.value()) {
            None => (0u32..).take(source.count).collect(),
            Some(accessor) => {
                let there = || source.at("indices", accessor);
                let indices = self.buffers.indices(accessor, self.indices_left).at(there)?;
                if let Some(at) = indices.iter().position(|index| *index as usize >= source.count) {
                    let index = indices.get(at).copied().unwrap_or_default();
                    let reason =
                        format!("index {index} at {at} is out of range (allowed: below {})", source.count);
                    return Err(fault(there(), reason));
                }
                indices
            }
        };
        let needed = triangle_count(mode, indices.len()).unwrap_or(0).saturating_mul(3);
        match self.indices_left.checked_sub(needed) {
            Some(left) => self.indices_left = left,
            None => return Err(fault(&source.place, format!("the scene has over {MAX_INDICES} indices"))),
        }
        if mode == Mode::Triangles && !indices.len().is_multiple_of(3) {
            self.notes.add(&source.place, "its indices are not whole triangles, the rest is not drawn");
        }
        Ok(triangles(mode, &indices).unwrap_or_default())
    }

    fn texture_coordinates(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<(), Fault> {
        for set in 0..2 {
            let semantic = Semantic::TexCoords(set);
            let Some(values) = self.attribute(source, &semantic, 2, [0.0; 2])? else { continue };
            if values.as_flattened().iter().any(|value| !value.is_finite()) {
                self.notes.add(&source.place, "texture coordinates that are not finite are taken as 0");
            }
            for (vertex, uv) in vertices.iter_mut().zip(values) {
                let target = if set == 0 { &mut vertex.uv0 } else { &mut vertex.uv1 };
                *target = uv.map(|value| if value.is_finite() { value } else { 0.0 });
            }
        }
        Ok(())
    }

    fn colors(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<(), Fault> {
        let Some(colors) = self.attribute(source, &Semantic::Colors(0), 3, [1.0; 4])? else { return Ok(()) };
        for (vertex, color) in vertices.iter_mut().zip(colors) {
            // The cast is exact, and takes what is not a number as 0.
            vertex.color = color.map(|value| (value.clamp(0.0, 1.0) * 255.0).round() as u8);
        }
        Ok(())
    }

    fn normals(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<bool, Fault> {
        let Some(normals) = self.attribute(source, &Semantic::Normals, 3, [0.0; 3])? else {
            return Ok(false);
        };
        vertices.iter_mut().zip(normals).for_each(|(vertex, normal)| vertex.normal = normal);
        Ok(true)
    }

    fn tangents(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<bool, Fault> {
        let Some(tangents) = self.attribute(source, &Semantic::Tangents, 4, [0.0; 4])? else {
            return Ok(false);
        };
        vertices.iter_mut().zip(tangents).for_each(|(vertex, tangent)| vertex.tangent = tangent);
        Ok(true)
    }

    /// Makes the normals and tangents that are missing or broken.
    fn finish(
        &mut self,
        mesh: &mut Mesh,
        has_normals: bool,
        has_tangents: bool,
        normal_map: Option<&TextureRef>,
        source: &Source<'_>,
    ) -> Result<(), Fault> {
        if !has_normals {
            // Flat normals need a vertex per index.
            let more = mesh.indices.len().saturating_sub(mesh.vertices.len());
            let Some(left) = self.vertices_left.checked_sub(more) else {
                return Err(fault(&source.place, format!("the scene has over {MAX_VERTICES} vertices")));
            };
            self.vertices_left = left;
            mesh.flat_normals();
        } else if mesh.repair_normals() > 0 {
            self.notes.add(&source.place, "normals that are zero or not finite are computed anew");
        }
        match (has_tangents, normal_map) {
            (true, map) => {
                let (uv_set, uv_transform) =
                    map.map_or((0, TextureRef::UV_IDENTITY), |map| (map.uv_set, map.uv_transform));
                mesh.repair_tangents(uv_set, &uv_transform);
            }
            (false, Some(map)) => mesh.generate_tangents(map.uv_set, &map.uv_transform),
            (false, None) => mesh.arbitrary_tangents(),
        }
        Ok(())
    }

    /// Reads an attribute that there must be one of for each vertex, if the primitive has it.
    fn attribute<const N: usize>(
        &self,
        source: &Source<'_>,
        semantic: &Semantic,
        least: usize,
        fill: [f32; N],
    ) -> Result<Option<Vec<[f32; N]>>, Fault> {
        let Some(accessor) = source.accessor(semantic) else { return Ok(None) };
        let there = || source.at(&semantic.to_string(), accessor);
        let count = self.buffers.accessor_count(accessor).at(there)?;
        if count != source.count as u64 {
            let reason = format!("has {count} elements for {} positions (allowed: as many)", source.count);
            return Err(fault(there(), reason));
        }
        Ok(Some(self.buffers.vectors(accessor, least, fill, source.count).at(there)?))
    }
}

impl Source<'_> {
    /// Returns the accessor of an attribute, if the primitive has it.
    fn accessor(&self, semantic: &Semantic) -> Option<usize> {
        let accessor = self.primitive.attributes.get(&Checked::Valid(semantic.clone()));
        accessor.map(|accessor| accessor.value())
    }

    fn at(&self, attribute: &str, accessor: usize) -> String {
        format!("{} {attribute} (accessor {accessor})", self.place)
    }
}
