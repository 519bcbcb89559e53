//! Chapter 11: models from files.
//!
//! Where the data flow begins for a picture of something: a Wavefront OBJ file becomes meshes.
//!
//! Polygons become fans of triangles from their first corner, which is right for convex ones.
//!
//! # Handedness
//!
//! OBJ files are right-handed, camera space here is left-handed: z of positions and normals changes its sign, once,
//! here. On the screen nothing is mirrored by that: the camera that looked along −z now looks along +z, and triangles
//! that ran counter-clockwise still do.
//!
//! ```
//! use rasterbook::model::{Model, NormalStyle};
//!
//! let text = b"v 0 0 -4\nv 1 0 -4\nv 1 1 -4\nv 0 1 -4\nf 1 2 3 4\n";
//! let (model, warnings) = Model::parse(text, "square.obj".as_ref(), NormalStyle::Smooth)?;
//! assert!(warnings.is_empty());
//! assert_eq!(model.triangle_count(), 2);
//! assert_eq!(model.parts[0].mesh.vertices()[0].position.z, 4.0);
//! # Ok::<(), rasterbook::files::FileError>(())
//! ```

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Cursor, Read};
use std::path::Path;

use crate::color::Color;
use crate::files::{FileError, Warnings, load_texture, read_file};
use crate::mesh::Mesh;
use crate::normals::{SmoothNormals, face_normal};
use crate::texture::Texture;
use glam::{DVec3, dvec3};

/// A corner of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelVertex {
    /// Model space, left-handed.
    pub position: DVec3,
    /// The direction that stands upright on the surface; of length 1 if it was computed, as in the file if not.
    pub normal: DVec3,
    /// Texture coordinates, (0, 0) at the picture's lower left.
    pub uv: [f64; 2],
}

/// The triangles of a model that share a material.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its triangles.
    pub mesh: Mesh<ModelVertex>,
    /// The texture that its material names (`map_Kd`), or one texel of its color (`Kd`).
    pub texture: Option<Texture>,
}

/// A model, as it comes from a file.
#[derive(Clone, Debug)]
pub struct Model {
    /// All its objects and groups.
    pub parts: Vec<Part>,
}

/// How normals are made where a file has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalStyle {
    /// At a shared position the mean of the faces around it, in whichever object of the file, larger faces counting
    /// more: a smooth surface.
    #[default]
    Smooth,
    /// Those of the faces: edges show. Normals in the file are not used.
    Flat,
}

impl Model {
    /// Reads an OBJ file, and the material libraries and textures that it names.
    ///
    /// `progress` is told how many bytes of how many have been read.
    ///
    /// # Errors
    /// If the file cannot be read, is no OBJ file, has no triangles, or has coordinates that are not finite. What is
    /// wrong with a material library or its textures is a warning only.
    pub fn load(
        path: &Path,
        style: NormalStyle,
        progress: impl FnMut(u64, u64),
    ) -> Result<(Self, Warnings), FileError> {
        let bytes = read_file(path)?;
        Self::parse_with_progress(&bytes, path, style, progress)
    }

    /// Reads the text of an OBJ file; `path` says where it stands, for the files that it names and for errors.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn parse(bytes: &[u8], path: &Path, style: NormalStyle) -> Result<(Self, Warnings), FileError> {
        Self::parse_with_progress(bytes, path, style, |_, _| {})
    }

    fn parse_with_progress(
        bytes: &[u8],
        path: &Path,
        style: NormalStyle,
        progress: impl FnMut(u64, u64),
    ) -> Result<(Self, Warnings), FileError> {
        if bytes.contains(&0) {
            return Err(FileError::new(path, "is not text, so it is no OBJ file"));
        }
        // Comments and names in files from the wild come in all encodings.
        let text = String::from_utf8_lossy(bytes);
        let total = text.len() as u64;
        let counting = Counting { inner: Cursor::new(text.as_bytes()), read: 0, total, progress };
        let options = tobj::LoadOptions {
            triangulate: true,
            ignore_points: true,
            ignore_lines: true,
            ..tobj::LoadOptions::default()
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let (models, materials) =
            tobj::load_obj_buf(&mut BufReader::with_capacity(1 << 16, counting), &options, |library| {
                let mut library = BufReader::new(
                    File::open(folder.join(library)).map_err(|_| tobj::LoadError::OpenFileFailed)?,
                );
                let mut bytes = Vec::new();
                library.read_to_end(&mut bytes).map_err(|_| tobj::LoadError::ReadError)?;
                tobj::load_mtl_buf(&mut String::from_utf8_lossy(&bytes).as_bytes())
            })
            .map_err(|error| FileError::new(path, format!("is no valid OBJ file: {error}")))?;

        let mut warnings = Warnings::new();
        let materials = materials.unwrap_or_else(|error| {
            warnings.push(format!("{}: its material library cannot be used: {error}", path.display()));
            Vec::new()
        });
        let textures = Textures::load(&materials, folder, &mut warnings);
        let given = Given::of_faces(&text);
        warnings.extend(given.warnings(path));
        let smooth = smooth_normals(models.iter().map(|model| &model.mesh));
        let mut parts = Vec::new();
        for model in models.iter().filter(|model| !model.mesh.indices.is_empty()) {
            let mesh =
                part_mesh(&model.mesh, given, style, &smooth).map_err(|cause| FileError::new(path, cause))?;
            let texture = model.mesh.material_id.and_then(|id| textures.0.get(id).cloned().flatten());
            parts.push(Part { mesh, texture });
        }
        if parts.is_empty() {
            return Err(FileError::new(path, "has no faces; is it an OBJ file?"));
        }
        Ok((Self { parts }, warnings))
    }

    /// Whether its corners have texture coordinates that differ; without them a texture shows one texel alone.
    #[must_use]
    pub fn has_texture_coordinates(&self) -> bool {
        self.parts.iter().flat_map(|part| part.mesh.vertices()).any(|vertex| vertex.uv != [0.0, 0.0])
    }

    /// How many triangles it has.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.mesh.triangle_count()).sum()
    }

    /// The smallest and the largest coordinates of its vertices.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let positions = self.parts.iter().flat_map(|part| part.mesh.vertices()).map(|vertex| vertex.position);
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        positions.fold(nothing, |(low, high), position| (low.min(position), high.max(position)))
    }

    /// The same model, moved and scaled so that the middle of its bounding box comes to `center`, and its farthest vertex
    /// to the distance `radius` from there.
    #[must_use]
    pub fn fitted(mut self, center: DVec3, radius: f64) -> Self {
        let (low, high) = self.bounds();
        // Halves first: the sum of two finite coordinates may not be finite.
        let middle = low / 2.0 + high / 2.0;
        let positions = self.parts.iter().flat_map(|part| part.mesh.vertices()).map(|vertex| vertex.position);
        // In two steps, since squares of large coordinates may not be finite either.
        let largest = (high / 2.0 - low / 2.0).max_element();
        let size = largest * positions.map(|p| ((p - middle) / largest).length()).fold(0.0, f64::max);
        let scaled = |offset: DVec3| if size > 0.0 { offset / size * radius } else { offset };
        for part in &mut self.parts {
            part.mesh = part
                .mesh
                .map(|vertex| ModelVertex { position: center + scaled(vertex.position - middle), ..*vertex });
        }
        self
    }
}

/// A reader that tells how far it has come.
struct Counting<R, F> {
    inner: R,
    read: u64,
    total: u64,
    progress: F,
}

impl<R: Read, F: FnMut(u64, u64)> Read for Counting<R, F> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.read += count as u64;
        (self.progress)(self.read, self.total);
        Ok(count)
    }
}

/// What the faces of a file say of their corners. Where only some of them do, it is taken as if none did: a parser that
/// has no number for a corner takes another one's.
#[derive(Clone, Copy)]
struct Given {
    normals: bool,
    uvs: bool,
    some_normals: bool,
    some_uvs: bool,
}

impl Given {
    fn of_faces(text: &str) -> Self {
        let mut given = Self { normals: true, uvs: true, some_normals: false, some_uvs: false };
        let faces =
            text.lines().filter_map(|line| line.trim_start().strip_prefix("f ").or(line.strip_prefix("f\t")));
        for corner in faces.flat_map(str::split_whitespace) {
            let mut numbers = corner.split('/').skip(1);
            let [has_uv, has_normal] =
                [(); 2].map(|()| numbers.next().is_some_and(|number| !number.is_empty()));
            given.normals &= has_normal;
            given.uvs &= has_uv;
            given.some_normals |= has_normal;
            given.some_uvs |= has_uv;
        }
        given
    }

    fn warnings(self, path: &Path) -> Warnings {
        let mut warnings = Warnings::new();
        for (some, all, what) in [
            (self.some_normals, self.normals, "normals: they are computed for all"),
            (self.some_uvs, self.uvs, "texture coordinates: none are used"),
        ] {
            if some && !all {
                warnings.push(format!("{}: only some of its faces have {what}", path.display()));
            }
        }
        warnings
    }
}

/// The positions of an object, right-handed → left-handed.
fn positions_of(mesh: &tobj::Mesh) -> Vec<DVec3> {
    mesh.positions.chunks_exact(3).map(left_handed).collect()
}

fn left_handed(v: &[f64]) -> DVec3 {
    dvec3(v[0], v[1], -v[2])
}

/// The triangles of one object: a vertex for each combination of position, normal and texture coordinates that occurs.
fn part_mesh(
    mesh: &tobj::Mesh,
    given: Given,
    style: NormalStyle,
    smooth: &SmoothNormals,
) -> Result<Mesh<ModelVertex>, String> {
    let (positions, faces) = (positions_of(mesh), mesh.indices.as_chunks().0);
    let normals: Vec<DVec3> = mesh.normals.chunks_exact(3).map(left_handed).collect();
    if let Some(bad) = positions.iter().chain(&normals).find(|v| !v.is_finite()) {
        return Err(format!("has a coordinate that is not a finite number: {} {} {}", bad.x, bad.y, -bad.z));
    }
    if mesh.texcoords.iter().any(|coordinate| !coordinate.is_finite()) {
        return Err("has a texture coordinate that is not a finite number".to_owned());
    }

    let has_normals =
        given.normals && style == NormalStyle::Smooth && mesh.normal_indices.len() == mesh.indices.len();
    let has_uvs = given.uvs && mesh.texcoord_indices.len() == mesh.indices.len();
    let mut vertices = Vec::new();
    let mut known = HashMap::new();
    let mut indices = Vec::with_capacity(mesh.indices.len());
    for (corner, &position) in mesh.indices.iter().enumerate() {
        let face = corner / 3;
        let uv = if has_uvs { mesh.texcoord_indices[corner] as usize } else { 0 };
        // A smooth normal belongs to its position, a flat one to its face.
        let normal = match style {
            _ if has_normals => mesh.normal_indices[corner] as usize,
            NormalStyle::Flat => face,
            NormalStyle::Smooth => 0,
        };
        let index = *known.entry((position, normal, uv)).or_insert_with(|| {
            let position = positions[position as usize];
            vertices.push(ModelVertex {
                position,
                normal: match style {
                    _ if has_normals => normals[normal],
                    NormalStyle::Flat => face_normal(corners(&faces[face], &positions)),
                    NormalStyle::Smooth => smooth.at(position),
                },
                uv: if has_uvs { [mesh.texcoords[2 * uv], mesh.texcoords[2 * uv + 1]] } else { [0.0, 0.0] },
            });
            (vertices.len() - 1) as u32
        });
        indices.push(index);
    }
    Mesh::indexed(vertices, indices).map_err(|error| error.to_string())
}

/// The normals that the faces of all objects make where they meet.
fn smooth_normals<'a>(meshes: impl Iterator<Item = &'a tobj::Mesh>) -> SmoothNormals {
    let mut normals = SmoothNormals::default();
    for mesh in meshes {
        let positions = positions_of(mesh);
        for face in mesh.indices.as_chunks().0 {
            normals.add(corners(face, &positions));
        }
    }
    normals
}

/// Where the corners of a face are.
fn corners(face: &[u32; 3], positions: &[DVec3]) -> [DVec3; 3] {
    face.map(|corner| positions[corner as usize])
}

/// The textures of materials, in their order.
struct Textures(Vec<Option<Texture>>);

impl Textures {
    fn load(materials: &[tobj::Material], folder: &Path, warnings: &mut Warnings) -> Self {
        let texture_of = |material: &tobj::Material| {
            let plain = material.diffuse.map(|color| {
                let color = Color::truncated(color.map(|channel| channel * 255.0 + 0.5));
                Texture::new(1, 1, vec![color])
            });
            let Some(name) = &material.diffuse_texture else { return plain };
            match load_texture(&folder.join(name)) {
                Ok((texture, more)) => {
                    warnings.extend(more);
                    Some(texture)
                }
                Err(error) => {
                    warnings
                        .push(format!("the texture of material '{}' cannot be used: {error}", material.name));
                    plain
                }
            }
        };
        Self(materials.iter().map(texture_of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<(Model, Warnings), FileError> {
        Model::parse(text.as_bytes(), "folder/test.obj".as_ref(), NormalStyle::Smooth)
    }

    fn refused(text: &str, reason: &str) {
        let error = parse(text).expect_err(text).to_string();
        assert!(error.starts_with("folder/test.obj: ") && error.contains(reason), "{error}");
    }

    #[test]
    fn handedness_and_winding() {
        // Seen from +z, as OBJ files are, this triangle runs counter-clockwise and faces us.
        let (model, _) = parse("v 0 0 -4\nv 1 0 -4\nv 0 1 -4\nf 1 2 3\n").expect("a triangle");
        let [a, b, c] =
            model.parts[0].mesh.triangles().next().expect("one").map(|i| model.parts[0].mesh.vertices()[i]);
        assert_eq!(a.position, dvec3(0.0, 0.0, 4.0));
        let seen = [a, b, c].map(|vertex| vertex.position.truncate());
        assert!(crate::area::twice_signed_area(seen[0], seen[1], seen[2]) > 0.0, "still counter-clockwise");
        assert_eq!(a.normal, dvec3(0.0, 0.0, -1.0), "towards us");
    }

    #[test]
    fn polygons_groups_and_negative_indices() {
        let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
        assert_eq!(parse(&format!("{square}f 1 2 3 4\n")).expect("a square").0.triangle_count(), 2);
        assert_eq!(parse(&format!("{square}f -4 -3 -2 -1\n")).expect("a square").0.triangle_count(), 2);
        let two = format!("o first\n{square}f 1 2 3\no second\nf 1 3 4\ng third\nf 2 3 4\n");
        let (model, _) = parse(&two).expect("three objects");
        assert_eq!((model.parts.len(), model.triangle_count()), (3, 3));
        // Points and lines are left out.
        assert_eq!(parse(&format!("{square}f 1\nf 1 2\nf 1 2 3\n")).expect("one face").0.triangle_count(), 1);
        let many: String = (0..10_000).map(|i| format!("v {} {} 0\n", i % 100, i / 100)).collect();
        let face: String = (1..=10_000).map(|i| format!(" {i}")).collect();
        assert_eq!(parse(&format!("{many}f{face}\n")).expect("one large face").0.triangle_count(), 9998);
    }

    #[test]
    fn normals_are_made_where_there_are_none() {
        // Two faces of a roof that share the ridge.
        let roof = "v -1 0 0\nv 0 1 0\nv 0 1 -1\nv 1 0 0\nf 1 2 3\nf 4 3 2\n";
        let normals = |style| {
            let (model, _) = Model::parse(roof.as_bytes(), "roof.obj".as_ref(), style).expect("a roof");
            let vertices = model.parts[0].mesh.vertices().to_vec();
            vertices
                .into_iter()
                .filter(|vertex| vertex.position.x == 0.0)
                .map(|vertex| vertex.normal)
                .collect::<Vec<_>>()
        };
        let smooth = normals(NormalStyle::Smooth);
        assert_eq!(smooth.len(), 2, "the ridge is shared");
        assert!(smooth.iter().all(|n| n.abs_diff_eq(dvec3(0.0, n.y, 0.0), 1e-12)), "{smooth:?}");
        let flat = normals(NormalStyle::Flat);
        assert_eq!(flat.len(), 4, "each face has its own");
        assert!(flat.iter().all(|n| (n.x.abs() - n.y.abs()).abs() < 1e-12), "{flat:?}");
    }

    #[test]
    fn objects_share_their_smooth_normals() {
        let roof = "v -1 0 0\nv 0 1 0\nv 0 1 -1\nv 1 0 0\ng left\nf 1 2 3\ng right\nf 4 3 2\n";
        let (model, _) = parse(roof).expect("a roof of two groups");
        let ridge = model
            .parts
            .iter()
            .flat_map(|part| part.mesh.vertices())
            .filter(|vertex| vertex.position.x == 0.0);
        assert!(ridge.clone().count() == 4 && ridge.clone().all(|vertex| vertex.normal.x.abs() < 1e-12));
    }

    #[test]
    fn normals_of_some_faces_are_not_used() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\nf 2 4 3\n";
        let (model, warnings) = parse(text).expect("two faces");
        assert!(
            warnings.len() == 1 && warnings[0].contains("only some of its faces have normals"),
            "{warnings:?}"
        );
        let normals = model.parts[0].mesh.vertices().iter().map(|vertex| vertex.normal);
        assert!(normals.into_iter().all(|normal| normal == dvec3(0.0, 0.0, -1.0)));
    }

    #[test]
    fn what_is_no_model_is_refused() {
        refused("", "has no faces");
        refused("v 0 0 0\nv 1 0 0\n", "has no faces");
        refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "out of bounds");
        refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", "out of bounds");
        refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/7 2/7 3/7\n", "out of bounds");
        refused("v 0 0 0\nv NaN 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number");
        refused("v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number");
        refused("v 0 0\n", "position");
        refused("v 0 0 0\nf 1\n", "has no faces");
        let binary = Model::parse(&[0x7f, b'E', b'L', b'F', 0, 1, 2], "a.obj".as_ref(), NormalStyle::Smooth);
        assert!(binary.expect_err("binary").to_string().contains("is not text"));
    }

    #[test]
    fn oddities_that_are_accepted() {
        let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
        let (_, warnings) =
            parse(&format!("mtllib nowhere.mtl\nusemtl stone\n{square}")).expect("a triangle");
        assert_eq!(warnings.len(), 1);
        assert!(warnings[0].contains("material library"), "{warnings:?}");
        let latin_1 = [b"# caf\xe9 \xff\n".as_slice(), square.as_bytes()].concat();
        assert!(Model::parse(&latin_1, "a.obj".as_ref(), NormalStyle::Smooth).is_ok());
        let long = format!("# {}\n{square}", "x".repeat(10_000_000));
        assert!(parse(&long).is_ok(), "a line of 10 MB");
    }

    #[test]
    fn fitting_into_a_sphere() {
        let (model, _) = parse("v 10 0 0\nv 16 0 0\nv 10 8 -2\nf 1 2 3\n").expect("a triangle");
        let fitted = model.fitted(dvec3(0.0, 0.0, 4.0), 1.0);
        let distances = fitted.parts[0]
            .mesh
            .vertices()
            .iter()
            .map(|vertex| vertex.position.distance(dvec3(0.0, 0.0, 4.0)));
        assert!((distances.fold(0.0, f64::max) - 1.0).abs() < 1e-12);
        let (point, _) = parse("v 1 1 1\nf 1 1 1\n").expect("a point, three times");
        assert!(point.fitted(DVec3::ZERO, 1.0).bounds().0.is_finite());
        let (huge, _) = parse("v 1e308 0 0\nv -1e308 0 0\nv 0 1e308 0\nf 1 2 3\n").expect("a large triangle");
        assert!(huge.fitted(DVec3::ZERO, 1.0).bounds().1.is_finite());
        let (tiny, _) = parse("v 1e-310 0 0\nv 0 0 0\nv 0 1e-310 0\nf 1 2 3\n").expect("a tiny triangle");
        assert!(tiny.fitted(DVec3::ZERO, 1.0).bounds().1.is_finite());
    }
}
