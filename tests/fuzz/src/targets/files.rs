//! Bytes as files.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use rasterbook::files::{FileError, decode_texture};
use rasterbook::model::{Model, NormalStyle};
use rasterbook::texture::AddressMode;

/// Between the text of a model and that of its materials.
const BETWEEN: u8 = 0xFF;

/// OBJ text, and behind a byte of ones the text of its material library.
pub(crate) fn model(data: &[u8]) {
    let mut texts = data.splitn(2, |byte| *byte == BETWEEN);
    let text = texts.next().unwrap_or_default();
    let path = folder().join("model.obj");
    let library = path.with_extension("mtl");
    if let Some(materials) = texts.next() {
        std::fs::write(&library, materials).expect("a folder to write into");
    }
    let style = if data.len().is_multiple_of(2) { NormalStyle::Smooth } else { NormalStyle::Flat };
    match Model::parse(text, &path, style) {
        Ok((model, warnings)) => {
            assert!(warnings.iter().all(|warning| is_printable(warning)), "{warnings:?}");
            check_model(&model);
        }
        Err(error) => check_error(&error, "model.obj"),
    }
}

fn check_model(model: &Model) {
    assert!(model.triangle_count() > 0);
    for vertex in model.parts.iter().flat_map(|part| part.mesh.vertices()) {
        assert!(vertex.position.is_finite() && vertex.normal.is_finite(), "{vertex:?}");
        assert!((vertex.normal.length() - 1.0).abs() < 1e-6, "{vertex:?}");
        assert!(vertex.uv.iter().all(|c| c.is_finite()), "{vertex:?}");
    }
    let (low, high) = model.bounds();
    assert!(low.cmple(high).all(), "{low} {high}");
}

/// TGA files have no mark inside: only the name tells them. Of all others the content is asked first.
const IMAGE: &str = "image.tga";

/// The bytes of an image.
pub(crate) fn image(data: &[u8]) {
    match decode_texture(data, Path::new(IMAGE)) {
        Ok((texture, _)) => {
            let last = texture.nearest([1.0, 1.0], AddressMode::Clamp);
            assert!(last.iter().all(|channel| (0.0..=255.0_f64).contains(channel)));
        }
        Err(error) => check_error(&error, IMAGE),
    }
}

/// Errors name the file, and say something that a terminal can show.
fn check_error(error: &FileError, name: &str) {
    let text = error.to_string();
    assert!(text.contains(name) && is_printable(&text), "{text:?}");
}

fn is_printable(text: &str) -> bool {
    !text.is_empty() && !text.contains(|c: char| c.is_control())
}

/// A folder of this process, where a model names its materials.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        // Tests have a folder in target/.
        let folder = option_env!("CARGO_TARGET_TMPDIR").map_or_else(std::env::temp_dir, PathBuf::from);
        let folder = folder.join(format!("rasterbook-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder for temporary files");
        folder
    })
}
