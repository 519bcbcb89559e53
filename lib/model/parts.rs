//! From the meshes of the parser to triangles with normals: polygons are cut, and each corner gets what it needs.

use glam::{DVec3, dvec3};

use super::normals::{SmoothNormals, area_vector, direction, face_normal};
use super::text::{Count, Found, Object};
use super::triangulate::{MAX_WORK, triangulate};
use super::{ModelVertex, NormalStyle, Part};
use crate::files::Warnings;
use crate::mesh::Mesh;
use crate::texture::Texture;

/// How far the length of a normal in a file may be from 1: three decimals of its coordinates.
const ROUNDING: f64 = 1e-3;

/// So many vertices at one position are searched for one that is the same.
const MAX_SEARCHED: usize = 32;

/// The parts of a model, as they are made.
pub(super) struct Parts {
    parts: Vec<Part>,
    /// The part that is being made: whose it is, its texture, vertices and indices.
    current: Option<(Object, Option<Texture>)>,
    vertices: Vec<ModelVertex>,
    indices: Vec<u32>,
    error: Option<String>,

    style: NormalStyle,
    smooth: Option<SmoothNormals>,
    /// How many faces there were before.
    face: usize,
    work: u64,
    polygon_lines: std::vec::IntoIter<u32>,
    odd_polygons: Count,
    /// Whether faces without texture coordinates have a texture of more than one texel.
    has_bare: bool,
}

impl Parts {
    /// `models` are all that there will be: smooth normals need them beforehand.
    pub(super) fn new(models: &[tobj::Model], found: &Found, style: NormalStyle) -> Self {
        let are_given = found.objects.iter().all(|object| object.given.normals);
        let has_gaps = || models.iter().any(|model| model.mesh.normals.as_chunks().0.contains(&[0.0; 3]));
        let needs_smooth = style == NormalStyle::Smooth && (!are_given || has_gaps());
        Self {
            parts: Vec::new(),
            current: None,
            vertices: Vec::new(),
            indices: Vec::new(),
            error: None,
            style,
            smooth: needs_smooth.then(|| smooth_normals(models)),
            face: 0,
            work: MAX_WORK,
            polygon_lines: found.polygon_lines.clone().into_iter(),
            odd_polygons: Count::default(),
            has_bare: false,
        }
    }

    /// Adds the faces of a mesh to the part before if they are of the same object and material, else to a new one.
    pub(super) fn add(&mut self, mesh: &tobj::Mesh, object: Object, texture: Option<Texture>) {
        let whose = |object: &Object| (object.number, object.material);
        if self.current.as_ref().is_some_and(|(current, _)| whose(current) != whose(&object)) {
            self.end_part();
        }
        if !object.given.uvs && texture.as_ref().is_some_and(|texture| texture.width() * texture.height() > 1)
        {
            self.has_bare = true;
        }
        self.current = Some((object, texture));
        let source = Source::new(mesh, object);
        let mut known = Known::new(source.positions.len());
        let (mut start, mut triangles, mut corners) = (0, Vec::new(), Vec::new());
        for count in arities(mesh) {
            corners.clear();
            corners.extend(mesh.indices[start..start + count].iter().map(|&i| source.positions[i as usize]));
            let normal = if self.style == NormalStyle::Flat { face_normal(&corners) } else { DVec3::ZERO };
            let face = Face { start, number: self.face, normal };
            self.cut(&corners, &mut triangles);
            for corner in triangles.iter().flatten() {
                let vertex = self.vertex(&source, face, *corner);
                let position = mesh.indices[start + corner] as usize;
                let index = known.index(position, vertex, &mut self.vertices);
                self.indices.push(index);
            }
            start += count;
            self.face += 1;
        }
    }

    /// The triangles of a polygon; one that cannot be cut rightly is counted.
    fn cut(&mut self, corners: &[DVec3], triangles: &mut Vec<[usize; 3]>) {
        if corners.len() == 3 {
            triangles.clear();
            triangles.push([0, 1, 2]);
            return;
        }
        let line = self.polygon_lines.next().unwrap_or(0);
        if !triangulate(corners, area_vector(corners), &mut self.work, triangles) {
            self.odd_polygons.add(line);
        }
    }

    fn vertex(&self, source: &Source, face: Face, corner: usize) -> ModelVertex {
        let at = face.start + corner;
        let place = source.mesh.indices[at] as usize;
        let given = || source.normals.get(*source.mesh.normal_indices.get(at)? as usize).copied().flatten();
        let normal = match (self.style, &self.smooth) {
            (NormalStyle::Flat, _) => face.normal,
            (NormalStyle::Smooth, None) => given().unwrap_or(DVec3::NEG_Z),
            (NormalStyle::Smooth, Some(smooth)) => given().unwrap_or_else(|| smooth.at(face.number, corner)),
        };
        let uv = if source.has_uvs {
            let uv = source.mesh.texcoord_indices[at] as usize;
            [source.mesh.texcoords[2 * uv], source.mesh.texcoords[2 * uv + 1]]
        } else {
            [0.0, 0.0]
        };
        ModelVertex { position: source.positions[place], normal, uv }
    }

    fn end_part(&mut self) {
        let Some((_, texture)) = self.current.take() else { return };
        let (vertices, indices) = (std::mem::take(&mut self.vertices), std::mem::take(&mut self.indices));
        match Mesh::indexed(vertices, indices) {
            Ok(mesh) => self.parts.push(Part { mesh, texture }),
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// The parts, and what is odd about them.
    pub(super) fn finish(mut self) -> Result<(Vec<Part>, Warnings), String> {
        self.end_part();
        if let Some(error) = self.error {
            return Err(error);
        }
        let odd = self.odd_polygons.warning(
            "a polygon that crosses itself, has no area or takes too long is cut as if it were convex",
            "polygons that cross themselves, have no area or take too long are cut as if they were convex",
        );
        let mut warnings: Warnings = odd.into_iter().collect();
        if self.has_bare {
            warnings.push(
                "some faces with a texture have no texture coordinates: one texel covers them".to_owned(),
            );
        }
        Ok((self.parts, warnings))
    }
}

/// One face of a mesh: where its corners begin, its number in the model, and its normal if that is wanted.
#[derive(Clone, Copy)]
struct Face {
    start: usize,
    number: usize,
    normal: DVec3,
}

/// A mesh of the parser, in left-handed space.
struct Source<'a> {
    mesh: &'a tobj::Mesh,
    positions: Vec<DVec3>,
    normals: Vec<Option<DVec3>>,
    has_uvs: bool,
}

impl<'a> Source<'a> {
    fn new(mesh: &'a tobj::Mesh, object: Object) -> Self {
        let positions = positions_of(mesh);
        // Where a face gives none, the parser takes another one's.
        let normals = if object.given.normals { normals_of(mesh) } else { Vec::new() };
        Self { mesh, positions, normals, has_uvs: object.given.uvs }
    }
}

/// Right-handed → left-handed.
fn left_handed(&[x, y, z]: &[f64; 3]) -> DVec3 {
    dvec3(x, y, -z)
}

fn positions_of(mesh: &tobj::Mesh) -> Vec<DVec3> {
    mesh.positions.as_chunks().0.iter().map(left_handed).collect()
}

/// The normals of a mesh with length 1. One whose length is 1 but for the rounding of its decimals is left as it is: what the
/// file says is better than what could be made of it. One without a direction is none.
fn normals_of(mesh: &tobj::Mesh) -> Vec<Option<DVec3>> {
    let unit = |normal: DVec3| {
        if (normal.length() - 1.0).abs() <= ROUNDING { Some(normal) } else { direction(normal) }
    };
    mesh.normals.as_chunks().0.iter().map(left_handed).map(unit).collect()
}

/// How many corners each face has.
fn arities(mesh: &tobj::Mesh) -> impl Iterator<Item = usize> {
    let triangles = if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { 0 };
    mesh.face_arities.iter().map(|&count| count as usize).chain(std::iter::repeat_n(3, triangles))
}

/// The normals that the faces of all objects make where they meet.
fn smooth_normals(models: &[tobj::Model]) -> SmoothNormals {
    let mut normals = SmoothNormals::default();
    let mut face = Vec::new();
    for model in models {
        let numbers: Vec<u32> = positions_of(&model.mesh).into_iter().map(|p| normals.number(p)).collect();
        let mut start = 0;
        for count in arities(&model.mesh) {
            face.clear();
            face.extend(model.mesh.indices[start..start + count].iter().map(|&i| numbers[i as usize]));
            normals.add(&face);
            start += count;
        }
    }
    normals.find_pairs();
    normals
}

/// The vertices that were made at each position of a mesh: a chain from the last one back.
struct Known {
    last: Vec<u32>,
    before: Vec<u32>,
    /// How many vertices the part had before this mesh.
    offset: Option<usize>,
}

const NONE: u32 = u32::MAX;

impl Known {
    fn new(positions: usize) -> Self {
        Self { last: vec![NONE; positions], before: Vec::new(), offset: None }
    }

    /// The index of a vertex; it is made if there is none like it.
    #[inline]
    fn index(&mut self, position: usize, vertex: ModelVertex, vertices: &mut Vec<ModelVertex>) -> u32 {
        let offset = *self.offset.get_or_insert(vertices.len());
        let mut at = self.last[position];
        for _ in 0..MAX_SEARCHED {
            if at == NONE {
                break;
            }
            if vertices[at as usize] == vertex {
                return at;
            }
            at = self.before[at as usize - offset];
        }
        let index = vertices.len() as u32;
        vertices.push(vertex);
        self.before.push(self.last[position]);
        self.last[position] = index;
        index
    }
}

#[cfg(test)]
mod tests {
    use super::super::text::Given;
    use super::*;
    use crate::color::Color;

    #[test]
    fn a_texture_of_several_texels_needs_coordinates() {
        let triangle = tobj::Mesh {
            positions: vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            texcoords: vec![0.5, 0.5],
            indices: vec![0, 1, 2],
            texcoord_indices: vec![0; 3],
            ..tobj::Mesh::default()
        };
        let warnings = |uvs, [width, height]: [u32; 2]| {
            let mut parts = Parts::new(&[], &Found::default(), NormalStyle::Flat);
            let object = Object { number: 0, material: None, given: Given { uvs, normals: false } };
            let texture = Texture::new(width, height, vec![Color::RED; (width * height) as usize]);
            parts.add(&triangle, object, Some(texture));
            parts.finish().expect("a triangle").1.len()
        };
        assert_eq!([[2, 1], [1, 2], [1, 1]].map(|size| warnings(false, size)), [1, 1, 0]);
        assert_eq!(warnings(true, [2, 1]), 0);
    }
}
