//! Models and textures from the wild: what is wrong with one is said in a line, with the file's name, and nothing is
//! written; what is merely odd is a warning.

#[path = "support/drawing.rs"]
mod drawing;
mod wild;

use std::path::{Path, PathBuf};
use std::process::Command;

use drawing::{draw, stderr};

fn folder(name: &str) -> PathBuf {
    drawing::folder("files", name)
}

/// One line that names the file and the cause, exit code 1, no picture.
fn refused(name: &str, option: &str, file: &str, content: &[u8], cause: &str) {
    let folder = folder(name);
    std::fs::write(folder.join(file), content).expect("written");
    let output = draw(&folder, &[option, file]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{name}: {told}");
    assert!(told.starts_with(&format!("error: {file}: ")) && told.contains(cause), "{name}: {told}");
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(output.stdout.is_empty() && !folder.join("picture.png").exists());
}

/// The picture is drawn; what is said on stderr is given back.
fn accepted(name: &str, files: &[(&str, &[u8])], arguments: &[&str]) -> String {
    let folder = folder(name);
    for (file, content) in files {
        std::fs::write(folder.join(file), content).expect("written");
    }
    let output = draw(&folder, arguments);
    assert!(output.status.success(), "{name}: {}", stderr(&output));
    assert!(folder.join("picture.png").is_file());
    stderr(&output)
}

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

/// A small picture in some format.
fn picture(format: image::ImageFormat) -> Vec<u8> {
    let image = image::RgbImage::from_fn(16, 16, |x, y| image::Rgb([x as u8 * 16, y as u8 * 16, 99]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("a small picture");
    bytes.into_inner()
}

#[test]
fn bad_models() {
    refused("empty", "--model", "a.obj", b"", "no faces");
    refused("binary", "--model", "a.obj", &[0x89, b'P', b'N', b'G', 0, 1, 2, 3, 0xff], "not text");
    refused("no_obj", "--model", "a.obj", b"<html><body>404</body></html>\n", "no faces");
    refused("out_of_range", "--model", "a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "out of bounds");
    refused(
        "far_out_of_range",
        "--model",
        "a.obj",
        b"v 0 0 0\nf 1 4000000000 18446744073709551615\n",
        "is no index",
    );
    refused("nan", "--model", "a.obj", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number");
    refused("infinite", "--model", "a.obj", b"v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number");
    refused("one_vertex", "--model", "a.obj", b"v 0 0 0\nf 1\n", "no faces");
    refused("index_zero", "--model", "a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "out of bounds");
    refused("words", "--model", "a.obj", b"v one two three\n", "line 1: 'one' is no number");
}

#[test]
fn missing_files_and_folders() {
    let folder = folder("missing");
    std::fs::create_dir(folder.join("folder.obj")).expect("made");
    std::fs::create_dir(folder.join("folder.png")).expect("made");
    for arguments in [
        ["--model", "nowhere.obj"],
        ["--model", "folder.obj"],
        ["--texture", "nowhere.png"],
        ["--texture", "folder.png"],
    ] {
        let output = draw(&folder, &arguments);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{told}");
        assert!(
            told.starts_with(&format!("error: {}: ", arguments[1])) && told.lines().count() == 1,
            "{told}"
        );
        assert!(!folder.join("picture.png").exists());
    }
}

#[test]
fn large_faces_and_long_lines() {
    let corners: String =
        (0..10_000).map(|i| format!("v {} {} 0\n", (i % 100) as f64 / 50.0, i / 100)).collect();
    let face: String = (1..=10_000).map(|i| format!(" {i}")).collect();
    let told = accepted(
        "face_of_10000",
        &[("a.obj", format!("{corners}f{face}\n").as_bytes())],
        &["--model", "a.obj"],
    );
    assert!(told.contains("line 10001: a polygon that crosses itself"), "{told}");
    let long = format!("# {}\n{TRIANGLE}", "long ".repeat(2_000_000));
    assert_eq!(accepted("line_of_10_mb", &[("a.obj", long.as_bytes())], &["--model", "a.obj"]), "");
}

#[test]
fn materials() {
    let text = format!("mtllib colors.mtl\nusemtl red\n{TRIANGLE}");
    let told = accepted("missing_library", &[("a.obj", text.as_bytes())], &["--model", "a.obj"]);
    assert!(told.starts_with("warning: a.obj: ") && told.contains("material library"), "{told}");

    let plain = b"newmtl red\nKd 1 0 0\n";
    assert_eq!(
        accepted("color", &[("a.obj", text.as_bytes()), ("colors.mtl", plain)], &["--model", "a.obj"]),
        ""
    );
    let drawn = image::open(Path::new(env!("CARGO_TARGET_TMPDIR")).join("files/color/picture.png"))
        .expect("drawn")
        .to_rgb8();
    assert!(
        drawn.pixels().any(|pixel| pixel[0] > 40 && pixel[1] == 0 && pixel[2] == 0),
        "Kd colors the triangle"
    );
    assert!(drawn.pixels().all(|pixel| pixel[1] == 0));

    let textured = b"newmtl red\nKd 1 0 0\nmap_Kd picture_of_it.png\n";
    let told = accepted(
        "missing_map",
        &[("a.obj", text.as_bytes()), ("colors.mtl", textured)],
        &["--model", "a.obj"],
    );
    assert!(told.starts_with("warning: ") && told.contains("picture_of_it.png"), "{told}");
    let png = picture(image::ImageFormat::Png);
    let files =
        [("a.obj", text.as_bytes()), ("colors.mtl", textured.as_slice()), ("picture_of_it.png", &png)];
    let told = accepted("map", &files, &["--model", "a.obj"]);
    assert!(told.contains("no texture coordinates") && told.lines().count() == 1, "{told}");
}

#[test]
fn bad_textures() {
    refused("no_bytes", "--texture", "a.png", b"", "empty");
    let png = picture(image::ImageFormat::Png);
    refused("truncated", "--texture", "a.png", &png[..png.len() / 2], "end of file");
    refused("text", "--texture", "a.png", b"this is no picture", "signature");
    refused("unknown", "--texture", "a.xyz", b"this is no picture", "no image that can be read here");
    // A header that claims 100,000 × 100,000 pixels: 30 GB.
    let mut huge = png;
    huge[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0]);
    let checksum = crc32(&huge[12..29]);
    huge[29..33].copy_from_slice(&checksum.to_be_bytes());
    refused("huge", "--texture", "a.png", &huge, "exceeds limit");
}

#[test]
fn a_texture_at_which_its_decoder_panics() {
    // One pixel of eight bits, the first color of a palette; its row, which begins with the number of a filter, in a block
    // that is not compressed.
    let header = [0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0];
    let row = [0x78, 1, 1, 2, 0, 0xfd, 0xff, 0, 0, 0, 2, 0, 1];
    let png = |palette: &[u8]| {
        let chunks = [chunk(b"IHDR", &header), chunk(b"PLTE", palette), chunk(b"IDAT", &row)];
        [b"\x89PNG\r\n\x1a\n".to_vec(), chunks.concat(), chunk(b"IEND", b"")].concat()
    };
    accepted("palette", &[("a.png", &png(&[200; 3]))], &["--texture", "a.png"]);
    // No whole number of colors; 257 of them; both.
    for count in [4, 771, 776] {
        let name = format!("palette_of_{count}");
        refused(&name, "--texture", "a.png", &png(&vec![200; count]), "its decoder failed: ");
    }
}

/// A chunk of a PNG file.
fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let (length, content) = ((data.len() as u32).to_be_bytes(), [kind, data].concat());
    [&length, content.as_slice(), &crc32(&content).to_be_bytes()].concat()
}

/// The checksum of PNG chunks, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(
            crc ^ u32::from(byte),
            |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 },
        )
    })
}

#[test]
fn every_format_and_a_wrong_name() {
    // Photographs are in `tests/wild.rs`.
    use image::ImageFormat::{Bmp, Png, Tga};
    for (format, name) in [(Png, "a.png"), (Bmp, "a.bmp"), (Tga, "a.tga")] {
        assert_eq!(accepted(name, &[(name, &picture(format))], &["--texture", name]), "");
    }
    let told = accepted("bmp_called_png", &[("a.png", &picture(Bmp))], &["--texture", "a.png"]);
    assert!(told.starts_with("warning: a.png: is a Bmp file"), "{told}");
}

#[cfg(unix)]
#[test]
fn no_link_is_followed_on_the_way_to_a_picture() {
    let folder = folder("links");
    std::fs::write(folder.join("victim"), "precious").expect("written");
    // The name that was once taken for what is not yet whole; the program has the number of the shell that becomes it.
    let program = env!("CARGO_BIN_EXE_ch10_matrices_lighting");
    let line = format!("ln -s victim .rasterbook.$$.part; exec {program} lit --size 64x48 --out a.png");
    let output = Command::new("sh").args(["-c", &line]).current_dir(&folder).output().expect("a shell");
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(folder.join("victim")).expect("there"), "precious");
    let count = || std::fs::read_dir(&folder).expect("the folder").count();
    assert_eq!(count(), 3, "the link, its target, a picture");
    // What cannot take its place is gone again.
    std::fs::create_dir(folder.join("b.png")).expect("made");
    let picture = rasterbook::Framebuffer::new(2, 2);
    let error = picture.save(folder.join("b.png")).expect_err("a folder is there");
    assert!(error.to_string().contains("b.png: "), "{error}");
    assert_eq!(count(), 4, "and a folder");
}

#[test]
fn only_where_a_model_is_drawn() {
    let folder = folder("no_model");
    let output = Command::new(env!("CARGO_BIN_EXE_ch10_matrices_lighting"))
        .args(["pivot", "--model", "a.obj"])
        .current_dir(&folder)
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).starts_with("error: 'pivot' draws no model"), "{}", stderr(&output));
    let folder = folder.as_path();
    let output = draw(folder, &["--as-is"]);
    assert_eq!(output.status.code(), Some(2), "as it is, but which model?");
}

#[test]
fn faces_and_missing_coordinates() {
    // A pyramid, seen with smooth and with flat normals.
    let pyramid = "v -1 -1 1\nv 1 -1 1\nv 1 -1 -1\nv -1 -1 -1\nv 0 1 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\n";
    let colors = |name: &str, arguments: &[&str]| {
        accepted(name, &[("a.obj", pyramid.as_bytes())], arguments);
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("files").join(name).join("picture.png");
        let picture = image::open(file).expect("drawn").to_rgb8();
        picture.pixels().map(|pixel| pixel.0).collect::<std::collections::BTreeSet<_>>().len()
    };
    let smooth = colors("smooth", &["--model", "a.obj"]);
    let flat = colors("flat", &["--model", "a.obj", "--flat"]);
    assert!(flat <= 5 && smooth > 20, "{flat} and {smooth} colors");

    let png = picture(image::ImageFormat::Png);
    let told = accepted(
        "no_uvs",
        &[("a.obj", pyramid.as_bytes()), ("a.png", &png)],
        &["--model", "a.obj", "--texture", "a.png"],
    );
    assert!(told.contains("has no texture coordinates"), "{told}");
}

#[test]
fn as_is_leaves_a_model_where_it_is() {
    let triangle = "v 10 10 -4\nv 11 10 -4\nv 10 11 -4\nf 1 2 3\n".as_bytes();
    let lit = |name, arguments: &[&str]| {
        accepted(name, &[("a.obj", triangle)], arguments);
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("files").join(name).join("picture.png");
        image::open(file).expect("drawn").to_rgb8().pixels().filter(|pixel| pixel.0 != [0; 3]).count()
    };
    assert!(lit("fitted", &["--model", "a.obj"]) > 50);
    assert_eq!(lit("as_is", &["--model", "a.obj", "--as-is"]), 0, "far out of sight");
}
