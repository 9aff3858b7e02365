//! Conversion of primitives to meshes.

mod morph;
mod skin;

use ::gltf::json;
use json::mesh::{Mode, Primitive, Semantic};
use json::validation::Checked;

use super::accessors::Accessor;
use super::buffers::Buffers;
use super::draco;
use super::error::{ImportError, WithLocation, clean_name, describe};
use super::notes::Notes;
use super::validate::{MAX_INDICES, MAX_VERTICES};
use crate::material::TextureRef;
use crate::mesh::{Mesh, Vertex};

/// Reads primitives, and counts their vertices and indices against the limits of a scene.
pub(super) struct Reader<'a> {
    buffers: &'a Buffers<'a>,
    notes: &'a mut Notes,
    vertices_left: usize,
    indices_left: usize,
    morph_vertices_left: usize,
}

/// The primitive that is being read.
struct Source<'a> {
    primitive: &'a Primitive,
    location: String,
    /// Number of vertices.
    count: usize,
    /// The geometry, if it is compressed.
    draco: Option<draco::Geometry>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(buffers: &'a Buffers<'a>, notes: &'a mut Notes) -> Self {
        let (vertices_left, morph_vertices_left) = (MAX_VERTICES, MAX_VERTICES);
        Self { buffers, notes, vertices_left, indices_left: MAX_INDICES, morph_vertices_left }
    }

    /// Reads a primitive; `None` if there is nothing to draw. `normal_map` is the normal texture of its
    /// material, for which missing tangents are generated.
    ///
    /// # Errors
    /// The location names the invalid attribute.
    pub(super) fn primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        normal_map: Option<&TextureRef>,
    ) -> Result<Option<Mesh>, ImportError> {
        let found = self.buffers.document().meshes.get(mesh);
        let name = found.and_then(|mesh| mesh.name.as_deref());
        let location = format!("{} primitive {primitive}", describe("mesh", mesh, name));
        let Some(primitive) = found.and_then(|mesh| mesh.primitives.get(primitive)) else {
            return Err(ImportError::new(location, "does not exist"));
        };
        let mut source = Source { primitive, location, count: 0, draco: None };
        let Checked::Valid(mode) = primitive.mode else {
            return Err(ImportError::new(source.location, "unknown mode (allowed: 0 to 6)"));
        };
        if triangle_count(mode, 0).is_none() {
            self.notes.add(source.location, "points and lines are not drawn");
            return Ok(None);
        }
        let draco =
            draco::Geometry::read(self.buffers, primitive, self.vertices_left, self.indices_left).transpose();
        source.draco = draco.with_location(|| format!("{} {}", source.location, draco::NAME))?;
        let Some(mut vertices) = self.positions(&mut source)? else { return Ok(None) };
        let indices = self.indices(&source, mode)?;
        if indices.is_empty() {
            self.notes.add(source.location, "it has no triangles and is not drawn");
            return Ok(None);
        }
        self.texture_coordinates(&source, &mut vertices)?;
        self.colors(&source, &mut vertices)?;
        let has_normals = self.normals(&source, &mut vertices)?;
        // glTF says to ignore tangents without normals.
        let has_tangents = has_normals && self.tangents(&source, &mut vertices)?;
        let mut mesh = Mesh::new(clean_name(name), vertices, indices);
        mesh.skin = self.skin(&source, &mesh.vertices)?;
        mesh.morph_targets = self.morph_targets(&source, has_normals, has_tangents)?;
        self.finish(&mut mesh, has_normals, has_tangents, normal_map, &source)?;
        Ok(Some(mesh))
    }

    /// Creates the vertices with their positions.
    fn positions(&mut self, source: &mut Source<'_>) -> Result<Option<Vec<Vertex>>, ImportError> {
        let Some(accessor) = source.accessor(&Semantic::Positions) else {
            self.notes.add(&source.location, "it has no POSITION and is not drawn");
            return Ok(None);
        };
        let location = || source.attribute_location("POSITION", accessor);
        let compressed = self.compressed(source, accessor);
        let positions = compressed.unwrap_or_else(|| self.buffers.accessor(accessor, self.vertices_left));
        let positions =
            positions.and_then(|positions| positions.vectors(3, [0.0; 3])).with_location(location)?;
        if let Some(vertex) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
            let reason = format!("the position of vertex {vertex} is not finite (allowed: finite numbers)");
            return Err(ImportError::new(location(), reason));
        }
        source.count = positions.len();
        self.vertices_left -= positions.len();
        Ok(Some(positions.into_iter().map(|position| Vertex { position, ..Vertex::default() }).collect()))
    }

    /// Reads the indices as a triangle list.
    fn indices(&mut self, source: &Source<'_>, mode: Mode) -> Result<Vec<u32>, ImportError> {
        let accessor = source.primitive.indices.map(|accessor| accessor.value());
        let location = || match accessor {
            Some(accessor) => source.attribute_location("indices", accessor),
            None => source.location.clone(),
        };
        // Compressed geometry is a triangle list.
        let (mode, indices) = match (&source.draco, accessor) {
            (Some(draco), _) => (Mode::Triangles, draco.indices()),
            (None, None) => (mode, (0u32..).take(source.count).collect()),
            (None, Some(accessor)) => {
                let indices = self.buffers.accessor(accessor, self.indices_left);
                (mode, indices.and_then(|indices| indices.indices()).with_location(location)?)
            }
        };
        if let Some(position) = indices.iter().position(|index| *index as usize >= source.count) {
            let index = indices.get(position).copied().unwrap_or_default();
            let reason =
                format!("index {index} at {position} is out of range (allowed: below {})", source.count);
            return Err(ImportError::new(location(), reason));
        }
        let needed = triangle_count(mode, indices.len()).unwrap_or(0).saturating_mul(3);
        match self.indices_left.checked_sub(needed) {
            Some(left) => self.indices_left = left,
            None => {
                return Err(ImportError::new(
                    &source.location,
                    format!("the scene has over {MAX_INDICES} indices"),
                ));
            }
        }
        if mode == Mode::Triangles && !indices.len().is_multiple_of(3) {
            self.notes.add(&source.location, "its index count is not a multiple of 3, the rest is not drawn");
        }
        Ok(triangles(mode, &indices).unwrap_or_default())
    }

    fn texture_coordinates(
        &mut self,
        source: &Source<'_>,
        vertices: &mut [Vertex],
    ) -> Result<(), ImportError> {
        for set in 0..2 {
            let semantic = Semantic::TexCoords(set);
            let Some(values) = self.attribute(source, &semantic, 2, [0.0; 2])? else { continue };
            if values.as_flattened().iter().any(|value| !value.is_finite()) {
                self.notes.add(&source.location, "texture coordinates that are not finite are replaced by 0");
            }
            for (vertex, uv) in vertices.iter_mut().zip(values) {
                let target = if set == 0 { &mut vertex.uv0 } else { &mut vertex.uv1 };
                *target = uv.map(|value| if value.is_finite() { value } else { 0.0 });
            }
        }
        Ok(())
    }

    fn colors(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<(), ImportError> {
        let Some(colors) = self.attribute(source, &Semantic::Colors(0), 3, [1.0; 4])? else { return Ok(()) };
        for (vertex, color) in vertices.iter_mut().zip(colors) {
            // The cast is exact, and turns NaN into 0.
            vertex.color = color.map(|value| (value.clamp(0.0, 1.0) * 65535.0).round() as u16);
        }
        Ok(())
    }

    fn normals(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<bool, ImportError> {
        let Some(normals) = self.attribute(source, &Semantic::Normals, 3, [0.0; 3])? else {
            return Ok(false);
        };
        vertices.iter_mut().zip(normals).for_each(|(vertex, normal)| vertex.normal = normal);
        Ok(true)
    }

    fn tangents(&mut self, source: &Source<'_>, vertices: &mut [Vertex]) -> Result<bool, ImportError> {
        let Some(tangents) = self.attribute(source, &Semantic::Tangents, 4, [0.0; 4])? else {
            return Ok(false);
        };
        vertices.iter_mut().zip(tangents).for_each(|(vertex, tangent)| vertex.tangent = tangent);
        Ok(true)
    }

    /// Generates normals and tangents that are missing or invalid.
    fn finish(
        &mut self,
        mesh: &mut Mesh,
        has_normals: bool,
        has_tangents: bool,
        normal_map: Option<&TextureRef>,
        source: &Source<'_>,
    ) -> Result<(), ImportError> {
        if !has_normals {
            // Flat normals need one vertex per index.
            let more = mesh.indices.len().saturating_sub(mesh.vertices.len());
            let Some(left) = self.vertices_left.checked_sub(more) else {
                return Err(ImportError::new(
                    &source.location,
                    format!("the scene has over {MAX_VERTICES} vertices"),
                ));
            };
            self.vertices_left = left;
            self.take_morph_vertices(source, more.saturating_mul(mesh.morph_targets.len()))?;
            mesh.flat_normals();
        } else if mesh.repair_normals() > 0 {
            self.notes.add(&source.location, "normals that are zero or not finite are recomputed");
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

    /// Reads an attribute, if the primitive has it; it must have one element per vertex.
    fn attribute<const N: usize>(
        &self,
        source: &Source<'_>,
        semantic: &Semantic,
        min: usize,
        fill: [f32; N],
    ) -> Result<Option<Vec<[f32; N]>>, ImportError> {
        let Some(accessor) = source.accessor(semantic) else { return Ok(None) };
        let values = self.vertex_elements(source, accessor).and_then(|accessor| accessor.vectors(min, fill));
        Ok(Some(values.with_location(|| source.attribute_location(&semantic.to_string(), accessor))?))
    }

    /// Returns an accessor that has one element per vertex.
    fn vertex_elements<'s>(&'s self, source: &Source<'_>, accessor: usize) -> Result<Accessor<'s>, String> {
        let compressed = self.compressed(source, accessor).transpose()?;
        let count = match &compressed {
            Some(compressed) => compressed.count() as u64,
            None => self.buffers.accessor_count(accessor)?,
        };
        if count != source.count as u64 {
            return Err(format!(
                "has {count} elements for {} positions (allowed: as many as positions)",
                source.count
            ));
        }
        compressed.map_or_else(|| self.buffers.accessor(accessor, source.count), Ok)
    }

    /// Returns an accessor of the compressed geometry, if it has it.
    fn compressed(&self, source: &Source<'_>, accessor: usize) -> Option<Result<Accessor<'static>, String>> {
        let json = self.buffers.document().accessors.get(accessor)?;
        source.draco.as_ref()?.accessor(accessor, json.normalized)
    }
}

impl Source<'_> {
    /// Returns the accessor of an attribute, if the primitive has it.
    fn accessor(&self, semantic: &Semantic) -> Option<usize> {
        let accessor = self.primitive.attributes.get(&Checked::Valid(semantic.clone()));
        accessor.map(|accessor| accessor.value())
    }

    fn attribute_location(&self, attribute: &str, accessor: usize) -> String {
        format!("{} {attribute} (accessor {accessor})", self.location)
    }
}

/// Turns the indices of a primitive into a triangle list, without triangles that use a vertex twice.
///
/// `None` for points and lines. Indices after the last whole triangle are dropped.
pub(super) fn triangles(mode: Mode, indices: &[u32]) -> Option<Vec<u32>> {
    let mut list = Vec::with_capacity(triangle_count(mode, indices.len())?.saturating_mul(3));
    let mut add = |triangle: [u32; 3]| {
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            list.extend(triangle);
        }
    };
    match (mode, indices) {
        (Mode::Triangles, _) => indices.as_chunks().0.iter().for_each(|triangle| add(*triangle)),
        (Mode::TriangleStrip, _) => {
            for (i, corners) in indices.array_windows::<3>().enumerate() {
                let [a, b, c] = *corners;
                // Every second triangle of a strip is wound the other way round.
                add(if i % 2 == 0 { [a, b, c] } else { [a, c, b] });
            }
        }
        (Mode::TriangleFan, [hub, rim @ ..]) => {
            rim.array_windows().for_each(|[a, b]| add([*a, *b, *hub]));
        }
        _ => {}
    }
    Some(list)
}

/// Returns the number of triangles of a number of indices; `None` for points and lines.
pub(super) fn triangle_count(mode: Mode, indices: usize) -> Option<usize> {
    match mode {
        Mode::Triangles => Some(indices / 3),
        Mode::TriangleStrip | Mode::TriangleFan => Some(indices.saturating_sub(2)),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 3]), Some(vec![0, 1, 2, 1, 3, 2]));
        assert_eq!(triangles(Mode::TriangleFan, &[0, 1, 2, 3]), Some(vec![1, 2, 0, 2, 3, 0]));
    }

    #[test]
    fn incomplete_and_degenerate_triangles_are_dropped() {
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3, 3, 4, 5]), Some(vec![0, 1, 2]));
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 1, 2]), Some(vec![]));
        assert_eq!(triangles(Mode::TriangleFan, &[]), Some(vec![]));
        assert_eq!(triangles(Mode::Points, &[0, 1, 2]), None);
    }
}
