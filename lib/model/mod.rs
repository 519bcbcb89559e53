//! Chapter 11: models from files.
//!
//! Where the data flow begins for a picture of something: a Wavefront OBJ file becomes meshes.
//!
//! ```text
//!   OBJ file ─► plain text ─► parser ─► polygons ─► triangles, normals ─► parts
//!   MTL files ─────────────────────────► textures, tinted ─────────────────┘
//! ```
//!
//! What is read, what is left out and what is warned of is on the page of chapter 10.
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

mod materials;
mod normals;
mod parts;
mod statements;
mod text;
mod triangulate;

use std::path::Path;
use std::sync::Arc;

use crate::files::{FileError, Warnings, read_file, shown, shown_path};
use crate::mesh::Mesh;
use crate::texture::Texture;
use glam::DVec3;

use self::materials::Materials;
use self::parts::Parts;
use self::text::PlainText;

/// A corner of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelVertex {
    /// Model space, left-handed.
    pub position: DVec3,
    /// The direction that is perpendicular to the surface; of length 1.
    pub normal: DVec3,
    /// Texture coordinates, (0, 0) at the picture's lower left.
    pub uv: [f64; 2],
}

/// The triangles of a model that share a material.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its triangles.
    pub mesh: Mesh<ModelVertex>,
    /// The texture that its material names (`map_Kd`), tinted by its color (`Kd`); or one texel of that color.
    pub texture: Option<Texture>,
}

/// A model, as it comes from a file.
#[derive(Clone, Debug)]
pub struct Model {
    /// All its objects and groups. Copies of a model share them.
    pub parts: Arc<[Part]>,
}

/// How normals are made where a file has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalStyle {
    /// At a shared position the mean of the faces around it, in whichever object of the file, each as much as its angle
    /// there: a smooth surface.
    #[default]
    Smooth,
    /// Those of the faces: edges show. Normals in the file are not used.
    Flat,
}

impl Model {
    /// Reads an OBJ file, and the material libraries and textures that it names.
    ///
    /// `progress` receives how many bytes of how many have been read.
    ///
    /// # Errors
    /// If the file cannot be read, is no OBJ file, has no triangles, or has coordinates that are not finite. What is
    /// wrong with a material library or its textures is a warning only.
    pub fn load(
        path: &Path,
        style: NormalStyle,
        mut progress: impl FnMut(u64, u64),
    ) -> Result<(Self, Warnings), FileError> {
        let bytes = read_file(path)?;
        Self::parse_with_progress(&bytes, path, style, &mut progress)
    }

    /// Reads the text of an OBJ file; `path` says where it stands, for the files that it names and for errors.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn parse(bytes: &[u8], path: &Path, style: NormalStyle) -> Result<(Self, Warnings), FileError> {
        Self::parse_with_progress(bytes, path, style, &mut |_, _| {})
    }

    fn parse_with_progress(
        bytes: &[u8],
        path: &Path,
        style: NormalStyle,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(Self, Warnings), FileError> {
        let failure = |cause: String| FileError::new(path, cause);
        check_text(bytes).map_err(failure)?;
        let mut text = PlainText::new(bytes, progress);
        // Nothing but faces comes as far as the parser, which has nothing to leave out.
        let options = tobj::LoadOptions::default();
        let parsed = tobj::load_obj_buf(&mut text, &options, |_| Err(tobj::LoadError::OpenFileFailed));
        let ((models, _), found) = text.finish(parsed).map_err(failure)?;
        if found.objects.is_empty() {
            return Err(failure("has no faces; is it an OBJ file?".to_owned()));
        }

        let of_this = |warning: String| format!("{}: {warning}", shown_path(path));
        let mut warnings: Warnings = found.warnings().into_iter().map(of_this).collect();
        let mut materials = Materials::load(path, &found.libraries, &mut warnings);
        let textures = materials.textures(&found.materials, &mut warnings);
        let mut parts = Parts::new(&models, &found, style);
        for (model, object) in models.iter().zip(&found.objects) {
            let texture = object.material.and_then(|material| textures.get(material).cloned().flatten());
            parts.add(&model.mesh, *object, texture);
        }
        let (parts, more) = parts.finish().map_err(failure)?;
        warnings.extend(more.into_iter().map(of_this));
        Ok((Self { parts: parts.into() }, limited(warnings)))
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

    /// The middle of its bounding box, and how far its farthest vertex is from there.
    #[must_use]
    pub fn bounding_sphere(&self) -> (DVec3, f64) {
        let (low, high) = self.bounds();
        // Halves first: the sum of two finite coordinates may not be finite.
        let middle = low / 2.0 + high / 2.0;
        let positions = self.parts.iter().flat_map(|part| part.mesh.vertices()).map(|vertex| vertex.position);
        // In two steps, since squares of large coordinates may not be finite either.
        let largest = (high / 2.0 - low / 2.0).max_element();
        (middle, largest * positions.map(|p| ((p - middle) / largest).length()).fold(0.0, f64::max))
    }

    /// The same model, moved and scaled so that the middle of its bounding box comes to `center`, and its farthest vertex
    /// to the distance `radius` from there.
    #[must_use]
    pub fn fitted(mut self, center: DVec3, radius: f64) -> Self {
        let (middle, size) = self.bounding_sphere();
        let scaled = |offset: DVec3| if size > 0.0 { offset / size * radius } else { offset };
        for part in Arc::make_mut(&mut self.parts) {
            part.mesh = part
                .mesh
                .map(|vertex| ModelVertex { position: center + scaled(vertex.position - middle), ..*vertex });
        }
        self
    }
}

/// Refuses what is no text of bytes.
fn check_text(bytes: &[u8]) -> Result<(), String> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err("is UTF-16 text; OBJ files are read as UTF-8 or ASCII".to_owned());
    }
    if bytes.contains(&0) {
        return Err("is not text, so it is no OBJ file".to_owned());
    }
    Ok(())
}

/// The most warnings that one model gives.
const MAX_WARNINGS: usize = 20;

/// Warnings as they can be shown: names in them come from files. Of very many, how many more there are.
fn limited(mut warnings: Warnings) -> Warnings {
    let more = warnings.len().saturating_sub(MAX_WARNINGS);
    if more > 0 {
        warnings.truncate(MAX_WARNINGS);
        warnings.push(format!("and {more} more of this kind"));
    }
    warnings.iter().map(|warning| shown(warning)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

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
    fn each_face_has_what_it_is_given() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 5 0 0\nvn 0 0 0\nvt 0.25 0.75\nf 1/1/1 2/1/1 3/1/1\nf 2 4 3\n";
        let (model, warnings) = parse(text).expect("two faces");
        assert!(warnings.is_empty(), "{warnings:?}");
        let vertices = model.parts[0].mesh.vertices();
        let of = |vertices: &[ModelVertex]| vertices.iter().map(|v| (v.normal, v.uv)).collect::<Vec<_>>();
        assert_eq!(of(&vertices[..3]), [(DVec3::X, [0.25, 0.75]); 3], "of length 1");
        assert_eq!(of(&vertices[3..]), [(DVec3::NEG_Z, [0.0, 0.0]); 3], "computed");
        let (model, _) = parse(&text.replace("/1/1", "//2")).expect("two faces");
        assert!(
            model.parts[0].mesh.vertices().iter().all(|v| v.normal == DVec3::NEG_Z),
            "0 0 0 is no direction"
        );
    }

    #[test]
    fn corners_that_are_the_same_are_one_vertex() {
        // The parser makes two meshes of this; the last face has the corners of the second one again.
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0\nvn 0 0 1\nvn 1 0 0\n\
            f 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1//2 2//2 3//2\nf 1//1 2//1 3//1\n";
        let (model, _) = parse(text).expect("four faces");
        assert_eq!((model.parts.len(), model.parts[0].mesh.vertices().len()), (1, 9));
    }

    #[test]
    fn normals_that_are_rounded_stay() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.5774 0.8165\nf 1//1 2//1 3//1\n";
        let (model, _) = parse(text).expect("a triangle");
        assert_eq!(model.parts[0].mesh.vertices()[0].normal, dvec3(0.0, 0.5774, -0.8165));
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
        refused("v 0 0\n", "line 1: 'v' has 2 numbers");
        refused("v 0 0 0 \nv 0 0 1-2\n", "line 2: position");
        refused("v 0 0 0\nf 1\n", "has no faces");
        let binary = Model::parse(&[0x7f, b'E', b'L', b'F', 0, 1, 2], "a.obj".as_ref(), NormalStyle::Smooth);
        assert!(binary.expect_err("binary").to_string().contains("is not text"));
        for mark in [b"\xff\xfe", b"\xfe\xff"] {
            let told = Model::parse(mark, "a.obj".as_ref(), NormalStyle::Smooth).expect_err("UTF-16");
            assert!(told.to_string().contains("is UTF-16 text"), "{told}");
        }
    }

    #[test]
    fn a_polygon_that_cannot_be_cut_is_named_by_its_line() {
        let corners = "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\n";
        let (_, warnings) = parse(&format!("{corners}f 1 2 3\nf 1 3 2 4\nf 1 2 3 4\n")).expect("three faces");
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].starts_with("folder/test.obj: line 7: a polygon that crosses itself"),
            "{warnings:?}"
        );
    }

    #[test]
    fn a_file_is_read_with_progress() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/cube.obj"));
        let mut last = None;
        let (model, _) =
            Model::load(path, NormalStyle::Smooth, |done, total| last = Some((done, total))).expect("a cube");
        assert_eq!(model.triangle_count(), 12);
        let size = path.metadata().expect("a file").len();
        assert_eq!(last, Some((size, size)));
    }

    #[test]
    fn texture_coordinates_that_are_all_the_same_are_none() {
        let has = |uv: &str| {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt {uv}\nf 1/1 2/1 3/2\n");
            parse(&text).expect("a triangle").0.has_texture_coordinates()
        };
        assert!(has("0.5 0") && !has("0 0"));
    }

    #[test]
    fn of_many_warnings_it_is_said_how_many_more_there_are() {
        let some = |count: usize| limited(vec!["odd\n".to_owned(); count]);
        assert_eq!(some(MAX_WARNINGS), vec!["odd\\n"; MAX_WARNINGS]);
        assert_eq!(some(MAX_WARNINGS + 3).pop().as_deref(), Some("and 3 more of this kind"));
        assert_eq!(some(MAX_WARNINGS + 3).len(), MAX_WARNINGS + 1);
    }

    #[test]
    fn oddities_that_are_accepted() {
        let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
        let (_, warnings) =
            parse(&format!("mtllib nowhere.mtl\nusemtl stone\n{square}")).expect("a triangle");
        assert_eq!(warnings.len(), 2);
        assert!(warnings[0].contains("material library") && warnings[1].contains("'stone'"), "{warnings:?}");
        let latin_1 = [b"# caf\xe9 \xff\n".as_slice(), square.as_bytes()].concat();
        assert!(Model::parse(&latin_1, "a.obj".as_ref(), NormalStyle::Smooth).is_ok());
        let long = format!("# {}\n{square}", "x".repeat(10_000_000));
        assert!(parse(&long).is_ok(), "a line of 10 MB");
    }

    #[test]
    fn fitting_into_a_sphere() {
        let (model, _) = parse("v 10 0 0\nv 16 0 0\nv 10 8 -2\nf 1 2 3\n").expect("a triangle");
        assert_eq!(model.bounds(), (dvec3(10.0, 0.0, 0.0), dvec3(16.0, 8.0, 2.0)));
        let (middle, size) = model.bounding_sphere();
        assert_eq!(middle, dvec3(13.0, 4.0, 1.0));
        assert!((size - dvec3(3.0, 4.0, 1.0).length()).abs() < 1e-12);
        // Around the origin, and a small one beside it.
        for (corners, size) in [
            ("v -1 -1 0\nv 1 -1 0\nv 0 1 0\n", 2.0_f64.sqrt()),
            ("v 1.5 1.5 -1.5\nv 2 1.5 -1.5\nv 1.5 2 -2\n", 0.25 * 3.0_f64.sqrt()),
        ] {
            let (model, _) = parse(&format!("{corners}f 1 2 3\n")).expect("a triangle");
            assert!((model.bounding_sphere().1 - size).abs() < 1e-12, "{corners}");
        }
        let (center, radius) = (dvec3(0.0, 0.0, 4.0), 2.0);
        let fitted = model.fitted(center, radius);
        let first = fitted.parts[0].mesh.vertices()[0].position;
        let expected = center - dvec3(3.0, 4.0, 1.0).normalize() * radius;
        assert!(first.abs_diff_eq(expected, 1e-12), "{first}");
        let (point, _) = parse("v 1 1 1\nf 1 1 1\n").expect("a point, three times");
        assert!(point.fitted(DVec3::ZERO, 1.0).bounds().0.is_finite());
        let (huge, _) = parse("v 1e308 0 0\nv -1e308 0 0\nv 0 1e308 0\nf 1 2 3\n").expect("a large triangle");
        assert!(huge.bounding_sphere().1.is_finite());
        assert!(huge.fitted(DVec3::ZERO, 1.0).bounds().1.is_finite());
        let (tiny, _) = parse("v 1e-310 0 0\nv 0 0 0\nv 0 1e-310 0\nf 1 2 3\n").expect("a tiny triangle");
        assert!(tiny.fitted(DVec3::ZERO, 1.0).bounds().1.is_finite());
    }
}
