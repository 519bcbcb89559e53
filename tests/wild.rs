//! Models and textures as they come from the wild: each case of the table is drawn like its plain form, pixel by pixel, and
//! what is not drawn is said.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::drawing::{self, draw, stderr};
use base64::Engine;
use rayon::prelude::*;

fn folder(name: &str) -> PathBuf {
    drawing::folder("wild", name)
}

/// Frame 315, by the exact rasterizer.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    draw(folder, &[&["--frame", "315", "--rasterizer", "exact"], arguments].concat())
}

type Files<'a> = &'a [(&'a str, &'a [u8])];

fn write(folder: &Path, files: Files) {
    for (name, content) in files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().expect("in the folder")).expect("made");
        std::fs::write(path, content).expect("written");
    }
}

/// Draws `a.obj` of these files: what was said, and the picture.
fn drawn(name: &str, files: Files, arguments: &[&str]) -> (String, image::RgbImage) {
    let folder = folder(name);
    write(&folder, files);
    let output = run(&folder, &[&["--model", "a.obj"], arguments].concat());
    assert!(output.status.success(), "{name}: {}", stderr(&output));
    (stderr(&output), image::open(folder.join("picture.png")).expect("drawn").to_rgb8())
}

const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
const CORNERS: &str = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const TEXTURED: &str = "f 1/1 2/2 3/3 4/4\n";

/// Four colors: red and green below, blue and yellow above.
fn four() -> Vec<u8> {
    let texels = [[[0, 0, 255], [255, 255, 0]], [[255, 0, 0], [0, 255, 0]]];
    let image = image::RgbImage::from_fn(2, 2, |x, y| image::Rgb(texels[y as usize][x as usize]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("four pixels");
    bytes.into_inner()
}

/// Name, text of an OBJ file, the same in its plain form, and what each line on standard error has in it, in order. `{s}` is
/// a square of four vertices, `{d}` four vertices with a dent.
type Text = (&'static str, &'static str, &'static str, &'static [&'static str]);

const WHOLE: &str = "{s}f 1 2 3 4\n";
const HALF: &str = "{s}f 1 2 3\n";
const DENT: &str = "{d}f 1 2 4\nf 2 3 4";

const TEXTS: &[Text] = &[
    ("byte order mark", "\u{feff}{s}f 1 2 3 4\n", WHOLE, &[]),
    ("carriage returns", "v -1 -1 0\rv 1 -1 0\rv 1 1 0\rv -1 1 0\rf 1 2 3 4\r", WHOLE, &[]),
    ("both ends of lines", "v -1 -1 0\r\nv 1 -1 0\r\nv 1 1 0\r\nv -1 1 0\r\nf 1 2 3 4\r\n", WHOLE, &[]),
    ("tabs and blanks", "  v\t-1  -1 0 \n v 1 -1\t0\nv 1 1 0\nv -1 1 0\n\tf  1 2\t3 4", WHOLE, &[]),
    ("comments after data", "{s}f 1 2 3 4 # front\n# C:\\\n#f 1 2 3\n", WHOLE, &[]),
    ("lines that go on", "v -1 \\\r\n-1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2\\\n 3 4", WHOLE, &[]),
    (
        "more numbers",
        "v -1 -1 0 1\nv 1 -1 0 0.5 1 0\nv 1 1 0 .1 .2 .3 1\nv -1 1 0\nvt 0\nvt 1 1 1\nf 1 2 3 4",
        WHOLE,
        &["a.obj: line 2 and others: 2 vertices have a color"],
    ),
    (
        "a weight",
        "v -1 -1 0 2\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4",
        WHOLE,
        &["line 1: the fourth number"],
    ),
    ("lines and points", "{s}f 1 2 3\nl 1 3 4\np 1\n", HALF, &["line 6 and others: 2 lines and points"]),
    (
        "free form",
        "vp 0 0\ncstype bezier\n{s}surf 0 1 0 1 1 2 3\nend\ns off\nf 1 2 3",
        HALF,
        &["line 7: a free-form"],
    ),
    ("unknown words", "{s}f 1 2 3\nxyzzy 1\n", HALF, &["line 6: 'xyzzy' is not known"]),
    ("faces of two", "{s}f 1 2 3\nf 1 2\n", HALF, &["line 6: a face with fewer than three corners"]),
    ("concave", "{d}f 1 2 3 4", DENT, &[]),
    ("concave from elsewhere", "{d}f 3 4 1 2", DENT, &[]),
    (
        "crossing",
        "{s}vn 0 0 1\nf 1//1 3//1 2//1 4//1\n",
        "{s}vn 0 0 1\nf 1//1 3//1 2//1\nf 1//1 2//1 4//1\n",
        &["line 6: a polygon that crosses itself"],
    ),
    (
        "long normals",
        "{s}vn 0 0 7\nvn 0 0 0.2\nf 1//1 2//2 3//1 4//2",
        "{s}vn 0 0 1\nf 1//1 2//1 3//1 4//1",
        &[],
    ),
    ("two sides", "{s}f 1 2 3 4\nf 4 3 2 1\n", WHOLE, &[]),
    ("relative", "{s}f -4 -3 -2 -1\n", WHOLE, &[]),
    (
        "normals of some",
        "{s}vn 0.6 0 0.8\nf 1//1 2//1 3//1\nf 1 3 4\n",
        "{s}vn 0.6 0 0.8\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n",
        &[],
    ),
    ("no name of a material", "{s}usemtl\nf 1 2 3 4\n", WHOLE, &["line 5: usemtl without a name"]),
    (
        "unknown material",
        "{s}usemtl stone\nf 1 2 3\nusemtl stone\nf 1 3 4\n",
        WHOLE,
        &["a.obj: material 'stone' is in no library"],
    ),
];

/// Name, OBJ text around a square with texture coordinates and one face, text of the library, the library in its plain form
/// (that of [`HEAD`]), and what is told.
type Library = (&'static str, &'static str, &'static str, &'static str, &'static [&'static str]);

const HEAD: &str = "mtllib a.mtl\nusemtl red\n";
const RED: &str = "newmtl red\nKd 1 0 0\n";
const FOUR: &str = "newmtl red\nKd 1 1 1\nmap_Kd four.png\n";

const LIBRARIES: &[Library] = &[
    ("a mark in a library", HEAD, "\u{feff}newmtl red\nKd 1 0 0\n", RED, &[]),
    ("tabs after words", "\tmtllib\ta.mtl\n  usemtl\tred\n", RED, RED, &[]),
    ("comments after names", "mtllib a.mtl # one\nusemtl red # two\n", RED, RED, &[]),
    (
        "two libraries",
        "mtllib b.mtl a.mtl\nusemtl red\n",
        RED,
        RED,
        &["line 1: a material library cannot be used: b.mtl: "],
    ),
    ("a library named often", "mtllib a.mtl\nmtllib a.mtl a.mtl\nusemtl red\n", RED, RED, &[]),
    ("a number sign", "mtllib a.mtl\nusemtl red #1\n", "newmtl red #1\nKd 1 0 0\n", RED, &[]),
    (
        "one number",
        HEAD,
        "newmtl red\nKd 1 0 0\nKs .5\nKe 1 2\nnewmtl b\nKd 0.5\n",
        RED,
        &["a.mtl: only Kd and map_Kd are drawn; left out: Ks, Ke"],
    ),
    ("no color", HEAD, "newmtl red\nKd 1 0 0\nKd x\n", RED, &["a.mtl: line 3: 'Kd x' is no color"]),
    (
        "an empty map",
        HEAD,
        "newmtl red\nKd 1 0 0\nmap_Kd\nillum\nd -halo 0.7\n",
        RED,
        &["a.mtl: line 3: map_Kd without the name", "left out: illum, d"],
    ),
    ("the later of two", HEAD, "newmtl red\nKd 0 0 1\nnewmtl red\nKd 1 0 0\n", RED, &[]),
    ("no transparency", HEAD, "newmtl red\nKd 1 0 0\nd 1\nTr 0\nKs 0 0 0\n", RED, &[]),
    (
        "transparency",
        HEAD,
        "newmtl red\nKd 1 0 0\nd 0.2\n",
        RED,
        &["a.mtl: only Kd and map_Kd are drawn; left out: d"],
    ),
    (
        "no such map",
        HEAD,
        "newmtl red\nKd 1 0 0\nmap_Kd nowhere.png\n",
        RED,
        &["material 'red': its texture cannot be used: nowhere.png: "],
    ),
    ("options", HEAD, "newmtl red\nmap_Kd -s 1 1 1 -o 0 0 0 four.png\n", FOUR, &[]),
    (
        "options that change",
        HEAD,
        "newmtl red\nmap_Kd -clamp on -bm 2 four.png # x\n",
        FOUR,
        &["a.mtl: line 2: options of map_Kd that are not drawn: -clamp on"],
    ),
    ("another separator", HEAD, "newmtl red\nmap_Kd sub\\four.png\n", FOUR, &[]),
    ("a name with blanks", HEAD, "newmtl red\nmap_Kd my four.png\n", FOUR, &[]),
    ("a folder of another machine", HEAD, "newmtl red\nmap_Kd D:\\models\\four.png\n", FOUR, &[]),
    (
        "a tint",
        HEAD,
        "newmtl red\nKd 0 0 0\nmap_Kd four.png\n",
        "newmtl red\nKd 0 0 0\n",
        &["Kd 0 0 0 makes its texture black"],
    ),
];

/// The files of a case: its OBJ text, its library, and the pictures that it may name.
fn drawn_with_pictures(name: &str, obj: &str, mtl: &str) -> (String, image::RgbImage) {
    let four = four();
    let pictures = ["four.png", "sub/four.png", "my four.png"].map(|path| (path, four.as_slice()));
    drawn(name, &[&[("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())], pictures.as_slice()].concat(), &[])
}

/// What is wrong with a case, if anything.
fn fault(name: &str, wild: [&str; 2], plain: [&str; 2], told: &[&str]) -> Option<String> {
    let (said, picture) = drawn_with_pictures(name, wild[0], wild[1]);
    let (_, expected) = drawn_with_pictures(&format!("{name} plain"), plain[0], plain[1]);
    if picture != expected {
        return Some(format!("{name}: another picture; {said}"));
    }
    let lines: Vec<&str> = said.lines().collect();
    let are_told =
        lines.iter().zip(told).all(|(line, told)| line.starts_with("warning: ") && line.contains(told));
    (lines.len() != told.len() || !are_told).then(|| format!("{name}: expected {told:?}, told {said:?}"))
}

#[test]
fn the_wild_is_drawn_like_the_plain() {
    let dent = "v -2 -2 0\nv 0 -1 0\nv 2 -2 0\nv 0 2 0\n";
    let filled = |text: &str| text.replace("{s}", SQUARE).replace("{d}", dent);
    let of_texts = TEXTS.par_iter().filter_map(|&(name, wild, plain, told)| {
        fault(name, [&filled(wild), ""], [&filled(plain), ""], told)
    });
    let whole = |head: &str| format!("{head}{SQUARE}{CORNERS}{TEXTURED}");
    let of_libraries = LIBRARIES.par_iter().filter_map(|&(name, head, wild, plain, told)| {
        fault(name, [&whole(head), wild], [&whole(HEAD), plain], told)
    });
    let faults: Vec<String> = of_texts.chain(of_libraries).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn each_face_has_the_coordinates_that_it_is_given() {
    let library = "newmtl red\nmap_Kd four.png\nnewmtl b\nKd 0 1 1\n";
    let with = |faces: &str| format!("mtllib a.mtl\nusemtl red\n{SQUARE}{CORNERS}{faces}");
    let wild = with("f 1/1 2/2 3/3\nusemtl b\nf 1 3 4\n");
    let plain = with("f 1/1 2/2 3/3\nusemtl b\nf 1/1 3/1 4/1\n");
    assert_eq!(fault("coordinates of some", [&wild, library], [&plain, library], &[]), None);

    let told = "some faces with a texture have no texture coordinates";
    let wild = with("f 1 2 3 4\n");
    assert_eq!(fault("no coordinates", [&wild, FOUR], [&wild, RED], &[told]), None);
}

#[test]
fn a_library_and_its_textures_may_lie_elsewhere() {
    let four = four();
    let obj = format!("mtllib materials\\b.mtl\nusemtl m\n{SQUARE}{CORNERS}{TEXTURED}");
    let mtl = b"newmtl m\nmap_Kd four.png\n".as_slice();
    let beside = |name, place| {
        drawn(name, &[("a.obj", obj.as_bytes()), ("materials/b.mtl", mtl), (place, &four)], &[])
    };
    let library = beside("beside the library", "materials/four.png");
    assert_eq!(library.0, "");
    assert_eq!(library, beside("beside the model", "four.png"));
    let colors: std::collections::BTreeSet<_> = library.1.pixels().map(|pixel| pixel.0).collect();
    assert!(colors.len() >= 5, "four colors and the background");
}

#[test]
fn names_that_are_not_utf_8_stay_different() {
    let obj = [
        b"mtllib a.mtl\nusemtl caf\xe9\n".as_slice(),
        SQUARE.as_bytes(),
        b"f 1 2 3\nusemtl caf\xe8\nf 1 3 4\n",
    ]
    .concat();
    let mtl = b"newmtl caf\xe9\nKd 1 0 0\nnewmtl caf\xe8\nKd 0 1 0\n".as_slice();
    let (said, picture) = drawn("latin 1", &[("a.obj", &obj), ("a.mtl", mtl)], &[]);
    assert_eq!(said, "");
    let count = |channel: usize| {
        picture.pixels().filter(|pixel| pixel[channel] / 2 > pixel[1 - channel].max(40)).count()
    };
    assert!(count(0) > 100 && count(1) > 100, "both colors: {} and {}", count(0), count(1));
}

/// One line with the file, the line and the cause; exit code 1; no picture.
#[test]
fn faults_are_told_with_their_line() {
    for (name, text, cause) in [
        (
            "vt before the first",
            "vt 0 0\nf 1/-9 2/1 3/1\n",
            "line 6: texture coordinate -9 is out of bounds: there are 1",
        ),
        (
            "vt one before the first",
            "vt 0 0\nf 1/-2 2/1 3/1\n",
            "line 6: texture coordinate -2 is out of bounds",
        ),
        ("vn before the first", "vn 0 0 1\nf 1//-9 2//1 3//1\n", "line 6: normal -9 is out of bounds"),
        ("v before the first", "f 1 2 -5\n", "line 5: vertex -5 is out of bounds: there are 4"),
        ("v after the last", "f 1 2 5\n", "line 5: vertex 5 is out of bounds"),
        ("vt after the last", "vt 0 0\nf 1/2 2/1 3/1\n", "line 6: texture coordinate 2 is out of bounds"),
        ("vt without any", "f 1/1 2/1 3/1\n", "line 5: texture coordinate 1 is out of bounds"),
        (
            "vt without any, and a short face",
            "f 1/1 2/1 3/1\nf 1\n",
            "line 5: texture coordinate 1 is out of bounds",
        ),
        ("zero", "f 0 1 2\n", "line 5: vertex 0 is out of bounds"),
        ("zero vn", "vn 0 0 1\nf 1//0 2//1 3//1\n", "line 6: normal 0 is out of bounds"),
        ("far after", "f 1 2 9223372036854775807\n", "line 5: '9223372036854775807' is no index"),
        ("after many lines", "# x\n\n\\\nf 1 2 3\\\n4 x\n", "line 7: 'x' is no index"),
        ("lines alone", "l 1 2 3\n", "has no faces"),
        ("utf 16", "", ""),
    ] {
        let folder = folder(name);
        let text = if name == "utf 16" {
            b"\xff\xfev\0 \0".to_vec()
        } else {
            format!("{SQUARE}{text}").into_bytes()
        };
        write(&folder, &[("a.obj", &text)]);
        let output = run(&folder, &["--model", "a.obj"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{name}: {said}");
        assert!(
            said.starts_with(&format!("error: a.obj: {cause}")) && said.lines().count() == 1,
            "{name}: {said}"
        );
        assert!(!folder.join("picture.png").exists());
    }
}

#[test]
fn nothing_from_a_file_commands_the_terminal() {
    let obj = "mtllib a.mtl \u{1b}[2J.mtl\nusemtl \u{1b}[31mq\n\u{7}\u{9b}1m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl m\nf 1 2 3\n";
    let mtl = "newmtl m\u{202e}\nKd 1 \u{1b}[0m\nmap_Kd \u{1b}[2Jx.png\n\u{1b}]0;t\u{7} 1\nnewmtl m\nmap_Kd \u{8}.png\n";
    let (said, _) = drawn("escapes", &[("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())], &[]);
    assert!(said.contains("\\u{1b}[31mq") && said.lines().count() >= 4, "{said}");
    let folder = folder("escapes in an error");
    write(&folder, &[("a.obj", b"v 0 0 \x1b[31m\n")]);
    let error = stderr(&run(&folder, &["--model", "a.obj"]));
    assert!(error.contains("\\u{1b}[31m"), "{error}");
    assert!((said + &error).chars().all(|c| c == '\n' || !c.is_control() && c != '\u{202e}'));
}

#[test]
fn what_is_said_of_a_long_word_is_short() {
    let long = "x".repeat(20_000);
    let lengthened = |text: &str| text.replace('…', &long);
    let short =
        |said: &str| assert!(!said.is_empty() && said.len() < 6000, "{} bytes: {said:.300}", said.len());
    for face in [
        "f … 1 2",
        "f 1/… 2 3",
        "f 9… 1 2",
        "f 1/1/1/… 1 2",
        "f /1/… 1 2",
        "v 0 0 …",
        "v 0 0 1e…",
        "vn 0 0 … 1",
    ] {
        let folder = folder("a long word in an error");
        let obj = lengthened(&format!("{SQUARE}f 1 2 3\n{face}\n"));
        write(&folder, &[("a.obj", obj.as_bytes())]);
        let output = run(&folder, &["--model", "a.obj"]);
        assert_eq!(output.status.code(), Some(1), "{face}");
        short(&stderr(&output));
    }
    let used = format!("mtllib a.mtl\n{SQUARE}usemtl m\nf 1 2 3\n");
    for (obj, mtl) in [
        ("usemtl …", "newmtl m"),
        ("mtllib ….mtl", "newmtl m"),
        ("…", "newmtl m"),
        ("", "newmtl m\nKd …"),
        ("", "newmtl m\nmap_Kd ….png"),
        ("", "newmtl m\nmap_Kd -… x.png"),
        ("", "newmtl m\nmap_Kd -s … x.png"),
        ("", "newmtl m\n…"),
        ("usemtl …", "newmtl …\nmap_Kd x.png"),
    ] {
        let [obj, mtl] = [&format!("{used}{obj}\nf 1 3 4\n"), mtl].map(lengthened);
        short(&drawn("a long word", &[("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())], &[]).0);
    }
}

#[test]
fn warnings_are_limited() {
    let faces: String = (0..1000).map(|i| format!("usemtl m{i}\nf 1 2 3\n")).collect();
    let (said, _) = drawn("many warnings", &[("a.obj", format!("{SQUARE}{faces}").as_bytes())], &[]);
    assert!(said.lines().count() == 21 && said.ends_with("and 980 more of this kind\n"), "{said}");
}

#[test]
fn the_last_column_begins_anew_by_scanlines_alone() {
    // Its vertices are on whole pixels: columns 16 to 48 of 65, rows 12 to 36 of 49.
    let square = "v -1.6 -1.2 -4\nv 1.6 -1.2 -4\nv 1.6 1.2 -4\nv -1.6 1.2 -4\n";
    let folder = folder("u is 1");
    write(&folder, &[("a.obj", format!("{square}{CORNERS}{TEXTURED}").as_bytes()), ("a.png", &four())]);
    let program = |arguments: &[&str]| {
        let given =
            ["--frame", "315", "--size", "65x49", "--model", "a.obj", "--texture", "a.png", "--as-is"];
        let output = Command::new(env!("CARGO_BIN_EXE_ch10_matrices_lighting"))
            .arg("lit")
            .args(given)
            .args(arguments)
            .current_dir(&folder)
            .output()
            .expect("the program starts");
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8(output.stdout).expect("text")
    };
    let color = |rasterizer: &str, column: u32| {
        program(&["--out", "picture.png", "--rasterizer", rasterizer]);
        let picture = image::open(folder.join("picture.png")).expect("drawn").to_rgb8();
        picture[(column, 48 - 28)].0.map(|channel| channel > 0)
    };
    let [blue, yellow] = [[false, false, true], [true, true, false]];
    assert_eq!([color("scanline", 47), color("scanline", 48)], [yellow, blue], "u is 1 in column 48");
    assert_eq!(color("exact", 47), yellow, "the last column: its center has a smaller u");
    // The pixel says so.
    let history = |column: u32| {
        let pixel = format!("{column},28");
        program(&["--inspect", &pixel, "--rasterizer", "scanline"])
    };
    assert!(history(48).contains("begins anew") && !history(47).contains("begins anew"), "{}", history(48));
}

/// A photograph of 16×8 pixels: red on the left, blue on the right.
const JPEG: &str = "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAAMCAgMCAgMDAwMEAwMEBQgFBQQEBQoHBwYIDAoMDAsKCwsNDhIQDQ4RDgsLEBYQERMUFRUVDA8XGBYUGBIUFRT/2wBDAQMEBAUEBQkFBQkUDQsNFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBT/wAARCAAIABADAREAAhEBAxEB/8QAFQABAQAAAAAAAAAAAAAAAAAABwj/xAAUEAEAAAAAAAAAAAAAAAAAAAAA/8QAFQEBAQAAAAAAAAAAAAAAAAAACQf/xAAUEQEAAAAAAAAAAAAAAAAAAAAA/9oADAMBAAIRAxEAPwCdEMKmAjjB0f/Z";

/// The photograph, as a camera marks it that was held in one of eight ways.
fn photograph(orientation: Option<u8>) -> Vec<u8> {
    let mut bytes = base64::engine::general_purpose::STANDARD.decode(JPEG).expect("base 64");
    if let Some(orientation) = orientation {
        let mut exif = b"\xff\xe1\0\x22Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01".to_vec();
        exif.extend([0, orientation, 0, 0, 0, 0, 0, 0]);
        bytes.splice(2..2, exif);
    }
    bytes
}

#[test]
fn a_photograph_stands_upright() {
    let obj = format!("{SQUARE}{CORNERS}{TEXTURED}");
    // Which side of the square is red.
    let red_side = |orientation| {
        let name = format!("orientation {orientation:?}");
        let files = [("a.obj", obj.as_bytes()), ("a.jpg", &photograph(orientation))];
        let (said, picture) = drawn(&name, &files, &["--texture", "a.jpg"]);
        assert_eq!(said, "");
        let red = picture.enumerate_pixels().filter(|(_, _, pixel)| pixel[0] > 90 && pixel[2] < 60);
        let [mut x, mut y, mut count] = [0.0; 3];
        for (column, row, _) in red {
            [x, y, count] = [x + f64::from(column), y + f64::from(row), count + 1.0];
        }
        let [x, y] = [x / count - 31.5, y / count - 23.5];
        match x.abs() > y.abs() {
            true if x < 0.0 => "left",
            true => "right",
            false if y < 0.0 => "top",
            false => "bottom",
        }
    };
    assert_eq!(red_side(None), "left");
    let sides = [1, 2, 3, 4, 5, 6, 7, 8].map(|orientation| red_side(Some(orientation)));
    assert_eq!(sides, ["left", "right", "right", "left", "top", "top", "bottom", "bottom"]);
}

#[test]
fn what_is_too_large_is_refused_before_it_is_read() {
    let folder = folder("large");
    let sparse = std::fs::File::create(folder.join("a.obj")).expect("made");
    sparse.set_len(3 << 30).expect("a file without contents");
    let refused = |arguments: &[&str], cause: &str| {
        let output = run(&folder, arguments);
        assert!(output.status.code() == Some(1) && stderr(&output).contains(cause), "{}", stderr(&output));
    };
    refused(
        &["--model", "a.obj"],
        "a.obj: has 3221225472 bytes; files of up to 268435456 (256 MiB) are read",
    );
    refused(&["--texture", "a.obj"], "a.obj: has 3221225472 bytes");
    std::fs::remove_file(folder.join("a.obj")).expect("there");

    // Headers that claim 8000×8000 pixels, and zeros. A decoder of photographs makes up what is missing.
    let mut jpeg = photograph(None);
    let frame = jpeg.windows(2).position(|mark| mark == b"\xff\xc0").expect("a frame");
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0x1f, 0x40, 0x1f, 0x40]);
    let tga = |kind| [[0, 0, kind].as_slice(), &[0; 9], &[0x40, 0x1f, 0x40, 0x1f, 24, 0]].concat();
    let bmp =
        [b"BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x40\x1f\0\0\x40\x1f\0\0\x01\0\x18\0".as_slice(), &[0; 24]];
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x1f\x40\0\0\x1f\x40\x08\x02\0\0\0\x89\x93\x3a\xa3\0\0\x1b\0IDAT";
    let headers: [(&str, Vec<u8>, usize); 6] = [
        ("a.tga", tga(2), 41),
        ("runs.tga", tga(10), 900_000),
        ("a.bmp", bmp.concat(), 7_900_000),
        ("a.ppm", b"P6 8000 8000 255\n".to_vec(), 7_900_000),
        ("a.jpg", jpeg, 120_000),
        ("a.png", png.to_vec(), 7_000),
    ];
    for (name, mut bytes, length) in headers {
        bytes.resize(length, 0);
        write(&folder, &[(name, &bytes)]);
        let claim = format!("{name}: claims 8000×8000 pixels, which cannot be in {length} bytes");
        refused(&["--texture", name], &claim);
    }
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_by_name() {
    let folder = folder("pipes");
    let made = Command::new("mkfifo").arg(folder.join("pipe")).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo");
    for path in ["pipe", "/dev/zero"] {
        for option in ["--model", "--texture"] {
            let output = run(&folder, &[option, path]);
            let said = stderr(&output);
            assert_eq!(output.status.code(), Some(1), "{said}");
            assert_eq!(said, format!("error: {path}: is no regular file: a pipe or a device\n"));
        }
        let obj = format!("mtllib {path}\n{SQUARE}usemtl m\nf 1 2 3\nusemtl pipes\nf 1 3 4\n");
        write(&folder, &[("a.obj", obj.as_bytes())]);
        let said = stderr(&run(&folder, &["--model", "a.obj"]));
        assert!(said.contains(&format!("{path}: is no regular file")), "{said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn of_a_file_that_tells_no_size_nothing_is_read() {
    // Such as `/proc/kmsg`, which has no end.
    let said = stderr(&run(&folder("no size"), &["--texture", "/proc/version"]));
    assert_eq!(said, "error: /proc/version: is empty\n");
}

#[cfg(unix)]
#[test]
fn a_path_that_is_no_text_can_be_recognized() {
    use std::os::unix::ffi::OsStrExt;

    let folder = folder("no text");
    let path = std::ffi::OsStr::from_bytes(b"caf\xe9\x1b[31m.obj");
    let told = || {
        let program = env!("CARGO_BIN_EXE_ch10_matrices_lighting");
        let mut command = Command::new(program);
        command.args(["lit", "--size", "64x48", "--out", "picture.png", "--model"]).arg(path);
        stderr(&command.current_dir(&folder).output().expect("it starts"))
    };
    let shown = "caf\\xe9\\u{1b}[31m.obj";
    let missing = told();
    assert!(missing.starts_with(&format!("error: {shown}: ")) && missing.lines().count() == 1, "{missing}");
    let text = format!("mtllib nowhere.mtl\n{SQUARE}f 1 2 3\n");
    std::fs::write(folder.join(path), text).expect("written");
    let warned = told();
    assert!(warned.starts_with(&format!("warning: {shown}: line 1: ")), "{warned}");
}

#[test]
fn textures_are_decoded_once_and_only_if_they_are_used() {
    // Two faces use the same file under two names; a third material, which no face uses, names one that is missing.
    let obj =
        format!("mtllib a.mtl\nusemtl one\n{SQUARE}{CORNERS}f 1/1 2/2 3/3\nusemtl two\nf 1/1 3/3 4/4\n");
    let mtl = b"newmtl one\nmap_Kd a.png\nnewmtl two\nmap_Kd ./a.png\nnewmtl unused\nmap_Kd nowhere.png\n"
        .as_slice();
    // A warning about the file itself comes once.
    let jpeg = photograph(None);
    let (said, _) = drawn("once", &[("a.obj", obj.as_bytes()), ("a.mtl", mtl), ("a.png", &jpeg)], &[]);
    assert_eq!(said, "warning: a.png: is a Jpeg file, whatever its name says\n");
}
