//! What is committed in `assets/` is what the generator writes. `UPDATE_ASSETS=1 cargo test --test library assets` writes it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use rasterbook::figure::assets::{generate, model, texture};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets")
}

/// Texts are compared as they are, pictures by their pixels: encoders change.
fn is_same(name: &str, committed: &[u8], generated: &[u8]) -> bool {
    if name.ends_with(".png") {
        let pixels = |bytes| image::load_from_memory(bytes).ok().map(|image| image.to_rgb8());
        pixels(committed).is_some() && pixels(committed) == pixels(generated)
    } else {
        committed == generated
    }
}

#[test]
fn assets_are_what_the_generator_writes() {
    let mut outdated = Vec::new();
    for (name, bytes) in generate() {
        let path = folder().join(name);
        let committed = std::fs::read(&path).unwrap_or_default();
        if is_same(name, &committed, &bytes) {
            continue;
        }
        if std::env::var_os("UPDATE_ASSETS").is_some() {
            std::fs::write(path, bytes).expect("assets/ can be written");
        } else {
            outdated.push(name);
        }
    }
    assert!(
        outdated.is_empty(),
        "{outdated:?} differ from what the generator writes: UPDATE_ASSETS=1 cargo test --test library assets"
    );
}

#[test]
fn nothing_else_is_there_and_each_has_its_line() {
    let page = std::fs::read_to_string(folder().join("README.md")).expect("assets/README.md");
    let mut wanted: BTreeSet<String> = generate().into_iter().map(|(name, _)| name.to_owned()).collect();
    for name in &wanted {
        assert!(page.contains(&format!("`{name}`")), "{name} is not in assets/README.md");
    }
    wanted.insert("README.md".to_owned());
    let there: BTreeSet<String> = std::fs::read_dir(folder())
        .expect("assets/")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    assert_eq!(there, wanted);
}

#[test]
fn the_programs_carry_them() {
    for (name, triangles) in [("cube.obj", 12), ("sphere.obj", 5120), ("pawn.obj", 4800)] {
        assert_eq!(model(name).expect(name).triangle_count(), triangles, "{name}");
    }
    for (name, side) in [("letters.png", 256), ("numbers.png", 512), ("bricks.png", 128), ("wood.png", 128)] {
        let texture = texture(name).expect(name);
        assert_eq!((texture.width(), texture.height()), (side, side), "{name}");
    }
    assert!(model("teapot.obj").is_err());
}
