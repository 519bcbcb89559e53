//! The command line that all programs share: what is written, what is said, and with which exit code.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::chapters::CHAPTERS;
use rasterbook::figure::{Chapter, Mistake, Variant};
use rasterbook::program::PROGRAMS;
use rasterbook::{Color, Framebuffer};

/// An empty folder of its own for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command_line").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder in target");
    folder
}

fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_ch05_perspective_correct");
    Command::new(program).args(arguments).current_dir(folder).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn files(folder: &Path) -> Vec<String> {
    let entries =
        std::fs::read_dir(folder).map(|entries| entries.filter_map(Result::ok).collect()).unwrap_or(vec![]);
    let mut names: Vec<String> =
        entries.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Runs the program in an empty folder and expects a refusal: the exit code, a reason on stderr, and nothing written.
fn refused(name: &str, arguments: &[&str], code: i32, reason: &str) {
    let folder = folder(name);
    let output = run_in(&folder, arguments);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    assert!(stderr.starts_with("error: ") && stderr.contains(reason), "{arguments:?}: {stderr}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(files(&folder).is_empty(), "{arguments:?} left {:?}", files(&folder));
}

#[test]
fn a_model_without_a_variant_is_drawn_by_the_first_that_can() {
    let folder = folder("own_model");
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join("cube.obj");
    let model = model.to_str().expect("UTF-8");
    // The leads of both draw none.
    let programs = [
        (env!("CARGO_BIN_EXE_ch02_triangles"), "facets"),
        (env!("CARGO_BIN_EXE_ch10_matrices_lighting"), "turntable"),
    ];
    for (program, variant) in programs {
        let output =
            Command::new(program).args(["--model", model]).current_dir(&folder).output().expect("it starts");
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(text(&output.stdout).ends_with(&format!("{variant}.png\n")), "{}", text(&output.stdout));
    }
    let output = run_in(&folder, &["--model", model]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("'floor' draws no model"), "{}", text(&output.stderr));
}

#[test]
fn who_draws_models_is_told_to_those_who_ask_the_wrong_one() {
    let folder = folder("no_model");
    let (early, triangles, last) = (
        env!("CARGO_BIN_EXE_ch05_perspective_correct"),
        env!("CARGO_BIN_EXE_ch02_triangles"),
        env!("CARGO_BIN_EXE_ch10_matrices_lighting"),
    );
    for (program, arguments, expected) in [
        (
            early,
            &["affine", "--flat"][..],
            "error: 'affine' draws no model: --model, --as-is and --flat mean nothing to it\n\
             Models are drawn by other programs: ch02_dda_lines, ch02_triangles, ch10_matrices_lighting\n",
        ),
        (triangles, &["split", "--model", "x.obj", "--as-is"], "nothing to it\nModels are drawn by facets\n"),
        (
            triangles,
            &["facets", "--texture", "x.png"],
            "error: 'facets' draws no texture: --texture means nothing to it\n\
             Textures are drawn by other programs: ch10_matrices_lighting\n",
        ),
        (last, &["spikes", "--compare", "rotation", "--flat"], "error: 'rotation' draws no model"),
        (last, &["rotation", "--model", "x.obj"], "\nModels are drawn by turntable, lit, "),
        (last, &["--all", "--flat"], "\nModels are drawn by turntable, lit, "),
    ] {
        let output = Command::new(program).args(arguments).current_dir(&folder).output().expect("it starts");
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains(expected), "{arguments:?}: {stderr}");
    }
    assert!(files(&folder).is_empty(), "left {:?}", files(&folder));
}

#[test]
fn one_command_one_picture() {
    let folder = folder("lead");
    let output = run_in(&folder, &[]);
    assert!(output.status.success());
    let path = Path::new("out").join("ch05_perspective_correct").join("floor.png");
    assert_eq!(text(&output.stdout), format!("{}\n", path.display()));
    assert!(output.stderr.is_empty());
    assert_eq!(image::image_dimensions(folder.join(path)).expect("a picture"), (640, 480));
}

#[test]
fn all_variants_and_their_list() {
    for &(chapter, program) in CHAPTERS {
        let folder = folder(chapter.name);
        let run = |arguments: &[&str]| {
            let output = Command::new(program)
                .args(arguments)
                .current_dir(&folder)
                .output()
                .expect("the program starts");
            assert!(output.status.success());
            text(&output.stdout)
        };
        let mut expected: Vec<String> =
            chapter.variants.iter().map(|variant| format!("{}.png", variant.name)).collect();
        // Small, for it is the names that matter, and animations are among them.
        let paths = run(&["--all", "--size", "64x48", "--out", "x"]);
        assert_eq!(paths.lines().count(), expected.len(), "a path per line");
        expected.sort();
        assert_eq!(files(&folder.join("x")), expected);

        let list = run(&["--list"]);
        assert_eq!(list.lines().count(), chapter.variants.len(), "a line per variant");
        for (line, variant) in list.lines().zip(chapter.variants) {
            assert_eq!(line.split_whitespace().next(), Some(variant.name));
            assert!(line.contains(variant.look));
        }
        assert_list(chapter, &run(&["--list", "--format", "json"]));
    }
}

/// The list for programs says what the chapter's table says.
fn assert_list(chapter: &Chapter, list: &str) {
    let list: serde_json::Value = serde_json::from_str(list).expect("JSON");
    assert_eq!(list["program"], chapter.name);
    assert_eq!(list["variants"].as_array().map(Vec::len), Some(chapter.variants.len()));
    for (said, variant) in list["variants"].as_array().into_iter().flatten().zip(chapter.variants) {
        assert_eq!([&said["name"], &said["look"]], [variant.name, variant.look]);
        assert_eq!(said["size"], serde_json::json!([variant.size.0, variant.size.1]));
        assert_eq!(said["animation"]["frames"].as_u64(), variant.animation.map(|it| it.frames.into()));
        let (is_mistake, remedy) = match variant.mistake {
            Mistake::No => (false, None),
            Mistake::RemediedBy(remedy) => (true, Some(remedy)),
            Mistake::WithoutRemedy => (true, None),
        };
        assert_eq!((said["mistake"].as_bool(), said["remedy"].as_str()), (Some(is_mistake), remedy));
        let knobs = said["knobs"].as_array().expect("a list").iter().map(|knob| knob["name"].as_str());
        assert!(knobs.eq(variant.knobs.iter().map(|knob| Some(knob.name))), "{said}");
    }
}

#[test]
fn out_names_a_file_or_a_folder() {
    let folder = folder("out");
    for (path, written) in [
        ("a.png", "a.png"),
        ("new/b.bmp", "new/b.bmp"),
        ("c.TGA", "c.TGA"),
        ("d.ppm", "d.ppm"),
        ("e", "e/affine.png"),
        ("f.1/", "f.1/affine.png"),
    ] {
        let output = run_in(&folder, &["affine", "--out", path]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(folder.join(written).is_file(), "{path}");
        assert_eq!(Path::new(text(&output.stdout).trim_end()), Path::new(written));
    }
    // A second run takes the place of the first, and nothing else is left.
    assert!(run_in(&folder, &["correct", "--out", "a.png"]).status.success());
    assert_eq!(files(&folder), ["a.png", "c.TGA", "d.ppm", "e", "f.1", "new"]);
}

#[test]
fn it_is_said_which_pictures_the_size_does_not_scale() {
    let folder = folder("size");
    let run = |arguments: &[&str]| {
        let program = env!("CARGO_BIN_EXE_ch01_pixels");
        Command::new(program).args(arguments).current_dir(&folder).output().expect("the program starts")
    };
    for (variant, size, is_said) in [
        ("pixel", "250x240", true),
        ("pixel", "640x480", false),
        ("digit", "250x240", false),
        ("digit", "1x1", false),
    ] {
        let output = run(&[variant, "--size", size, "--out", "a.png"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let picture = image::open(folder.join("a.png")).expect("written").to_rgb8();
        assert_eq!(format!("{}x{}", picture.width(), picture.height()), size);
        let said = "'pixel' is drawn in pixels: the size only crops it or leaves a border black\n";
        assert_eq!(text(&output.stderr), if is_said { said } else { "" }, "{variant} {size}");
    }
    let (help, list) = (text(&run(&["--help"]).stdout), text(&run(&["--list"]).stdout));
    assert!(help.contains("scenes scale to fit, but not pixel\n"), "{help}");
    let marked: Vec<&str> = list.lines().filter(|line| line.contains("[in pixels")).collect();
    assert!(marked.len() == 1 && marked[0].trim_start().starts_with("pixel "), "{list}");
}

#[test]
fn zoom_and_compare() {
    let folder = folder("compare");
    let output = run_in(&folder, &["affine", "--compare"]);
    assert!(output.status.success());
    let stderr = text(&output.stderr);
    assert!(stderr.ends_with(" of 307200 pixels differ\n") && !stderr.starts_with("0 "), "{stderr}");
    let path = folder.join("out/ch05_perspective_correct/affine--correct.png");
    assert_eq!(image::image_dimensions(path).expect("written"), (640 * 3 + 8, 480));

    let output =
        run_in(&folder, &["reciprocal", "--compare", "correct", "--zoom", "10@5,5", "--out", "b.png"]);
    let shown = "shown: columns 0 to 127 and rows 0 to 95, y up, each pixel as 10×10";
    assert_eq!(text(&output.stderr), format!("0 of 307200 pixels differ\n{shown}\n"));
    // Each panel has its own frame.
    assert_eq!(
        image::image_dimensions(folder.join("b.png")).expect("written"),
        ((30 + 1280 + 4) * 3 + 8, 26 + 960 + 4)
    );
}

#[test]
fn animations() {
    let folder = folder("animation");
    let run = |arguments: &[&str]| {
        let program = env!("CARGO_BIN_EXE_ch09_pipeline");
        Command::new(program).args(arguments).current_dir(&folder).output().expect("the program starts")
    };
    assert!(run(&["double-buffer", "--frame", "100", "--out", "x"]).status.success());
    assert!(folder.join("x/double-buffer@100.png").is_file());
    for name in ["a.gif", "a.png"] {
        let output = run(&["double-buffer", "--animate", "--size", "16x12", "--out", name]);
        assert_eq!(text(&output.stdout), format!("{name}\n"), "{}", text(&output.stderr));
        assert!(output.stderr.is_empty(), "no progress bar where nobody looks");
    }
    let gif = std::fs::File::open(folder.join("a.gif")).expect("written");
    let mut decoder = gif::Decoder::new(gif).expect("a GIF file");
    let mut frames = 0;
    while let Some(frame) = decoder.next_frame_info().expect("whole") {
        assert_eq!(frame.delay, 5, "20 frames a second");
        frames += 1;
    }
    assert_eq!(frames, 500);
    let png = std::io::BufReader::new(std::fs::File::open(folder.join("a.png")).expect("written"));
    let reader = png::Decoder::new(png).read_info().expect("a PNG file");
    assert_eq!(reader.info().animation_control.map(|control| control.num_frames), Some(500));

    for (arguments, reason) in [
        (&["double-buffer", "--frame", "500"][..], "frames are 0 to 499"),
        (&["vbo", "--frame", "0"], "'vbo' is one picture"),
        (&["vbo", "--animate"], "cannot be animated"),
        (&["double-buffer", "--animate", "--out", "b.bmp"], ".gif or a .png"),
        (&["double-buffer", "--out", "b.gif"], "give --animate"),
        (&["double-buffer", "--animate", "--frame", "3"], "--frame"),
        (&["--all", "--animate"], "--animate"),
    ] {
        let output = run(arguments);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.starts_with("error: ") && stderr.contains(reason), "{arguments:?}: {stderr}");
    }
    assert_eq!(files(&folder), ["a.gif", "a.png", "x"]);
}

#[test]
fn the_history_of_a_pixel() {
    let folder = folder("inspect");
    let output = run_in(&folder, &["affine", "--inspect", "60,120"]);
    assert!(output.status.success() && output.stderr.is_empty());
    let told = text(&output.stdout);
    assert!(told.contains("affine ←") && told.ends_with("In the picture: (0, 255, 0)\n"), "{told}");
    assert!(!told.contains("What did not reach"), "only with -v");
    let more = text(&run_in(&folder, &["affine", "--inspect", "60,120", "-v"]).stdout);
    assert!(more.contains("triangle 2: its row 120"), "{more}");
    let output = run_in(&folder, &["affine", "--inspect", "60,120", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&json["variant"], &json["color"]), (&"affine".into(), &serde_json::json!([0, 255, 0])));
    assert!(files(&folder).is_empty(), "nothing is written");
}

#[test]
fn steps_and_overdraw() {
    let folder = folder("steps");
    let output = run_in(&folder, &["affine", "--steps", "--size", "320x240", "--out", "a.png"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let png = std::io::BufReader::new(std::fs::File::open(folder.join("a.png")).expect("written"));
    let frames = png::Decoder::new(png).read_info().expect("a PNG file").info().animation_control;
    assert!(frames.is_some_and(|control| (100..300).contains(&control.num_frames)), "row by row: {frames:?}");

    let output = run_in(&folder, &["affine", "--overdraw"]);
    let legend = text(&output.stderr);
    assert!(legend.starts_with("How often") && legend.contains("2: yellow (475 pixels)"), "{legend}");
    let size = |name: &str| {
        image::image_dimensions(folder.join("out/ch05_perspective_correct").join(name)).expect("written")
    };
    assert_eq!(size("affine-overdraw.png"), (640, 480 + 22), "with a legend");
    assert!(
        run_in(&folder, &["affine", "--overdraw", "--zoom", "2@5,5", "--size", "80x60"]).status.success()
    );
    assert_eq!(size("affine-zoom2-at-5-5-overdraw.png").1, 120 + 30 + 38, "below what is enlarged");
}

#[test]
fn a_choice_of_rasterizers() {
    let folder = folder("rasterizer");
    let run = |arguments: &[&str]| {
        let program = env!("CARGO_BIN_EXE_ch09_pipeline");
        Command::new(program).args(arguments).current_dir(&folder).output().expect("the program starts")
    };
    for name in ["scanline", "exact"] {
        let output = run(&["vbo", "--rasterizer", name, "--out", "x"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(folder.join(format!("x/vbo-{name}.png")).is_file());
    }
    assert!(run(&["vbo", "--rasterizer", "edge", "--out", "x"]).status.success(), "as it was once called");
    let output = run(&["vbo", "--rasterizer", "edges"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("scanline, exact"));
    // In the exact picture no pixel is written twice.
    let seams = text(&run(&["indexed", "--overdraw", "--rasterizer", "scanline"]).stderr);
    let none = text(&run(&["indexed", "--overdraw", "--rasterizer", "exact"]).stderr);
    assert!(!seams.contains("2: yellow (0 pixels)") && !seams.is_empty(), "{seams}");
    assert!(none.contains("3: orange (0 pixels)"), "{none}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    refused("rasterizer_early", &["affine", "--rasterizer", "exact"], 2, "does not use the pipeline");
    refused("inspect_outside", &["--inspect", "640,0"], 2, "outside the picture of 640×480");
    refused("inspect_negative", &["--inspect", "-1,5"], 2, "outside");
    refused("inspect_words", &["--inspect", "here"], 2, "expected X,Y");
    refused("inspect_all", &["--all", "--inspect", "1,1"], 2, "--inspect");
    refused("format_alone", &["--format", "json"], 2, "--inspect");
    refused("steps_and_overdraw", &["--steps", "--overdraw"], 2, "--overdraw");
    refused("steps_bmp", &["--steps", "--out", "a.bmp"], 2, ".gif or a .png");
    refused(
        "variant",
        &["afine"],
        2,
        "no variant 'afine'; did you mean 'affine'?\nIt has: floor, correct, affine",
    );
    refused("variant_elsewhere", &["tearing"], 2, "ch09_pipeline has it");
    refused("option", &["--sise", "4x4"], 2, "--sise");
    refused("two", &["affine", "correct"], 2, "correct");
    refused(
        "frame_negative",
        &["--frame", "-1"],
        2,
        "'-1' for '--frame <N>': expected a whole number from 0 on",
    );
    refused("frame_word", &["--frame", "x"], 2, "'x' for '--frame <N>': expected a whole number from 0 on");
    refused("frame_huge", &["--frame", "99999999999"], 2, "no animation has so many frames");
    refused("frame_missing", &["--frame"], 2, "counted from 0");
    refused("size_negative", &["--size", "-1x5"], 2, "'-1x5' for '--size <WxH>': expected WIDTHxHEIGHT");
    refused("zoom_negative", &["--zoom", "-2"], 2, "must be a whole number from 1 to 64");
    refused("inspect_half", &["--inspect", "1"], 2, "'1' for '--inspect <X,Y>': expected X,Y");
    refused("out_forgotten", &["--out", "--all"], 2, "'--all' for '--out <PATH>': expected a path");
    refused("size", &["--size", "640"], 2, "640x480");
    refused("zero", &["--size", "0x5"], 2, "1 to 16384");
    refused("huge", &["--size", "16384x16384"], 2, "more than");
    refused("zoom", &["--zoom", "8@9"], 2, "8@9");
    refused("zoom_outside", &["--zoom", "8@640,0"], 2, "outside the picture of 640×480");
    refused("all_in_one", &["--all", "--out", "x.png"], 2, "folder");
    refused("all_and_one", &["affine", "--all"], 2, "--all");
    refused("all_compared", &["--all", "--compare"], 2, "--compare");
    refused("no_remedy", &["correct", "--compare"], 2, "no remedy");
    refused("unknown_other", &["affine", "--compare", "right"], 2, "no variant 'right'");
    refused("too_wide", &["affine", "--compare", "--size", "6000x10"], 2, "too wide");
    refused("format", &["--out", "x.jpg"], 2, ".png .bmp .tga .ppm");
    refused("no_format", &["--out", "x.txt"], 2, "'.txt' is no picture format that is written");
    refused("show_nowhere", &["--show"], 2, "--show=blocks prints the picture nevertheless");
    refused("show_kitty_nowhere", &["affine", "--show=kitty"], 2, "standard output is not a terminal");
    refused("show_how", &["--show=ascii"], 2, "auto, blocks, kitty, iterm, sixel");
    refused("show_all", &["--all", "--show=blocks"], 2, "--show");
    refused("show_and_out", &["--show=blocks", "--out", "a.png"], 2, "--out");
    refused("show_steps", &["--show=blocks", "--steps"], 2, "--steps");
    refused("show_inspect", &["--show=blocks", "--inspect", "1,1"], 2, "--inspect");
    refused("show_animate", &["--show=blocks", "--animate"], 2, "--animate");
    refused("list_and_more", &["--all", "--list"], 2, "--list");
}

#[test]
fn a_list_of_one_variant_is_its_line() {
    let list = text(&run_in(&folder("list_of_one"), &["affine", "--list"]).stdout);
    assert!(list.starts_with("  affine  ") && list.lines().count() == 1, "{list}");
    assert!(text(&run_in(&folder("list"), &["--list"]).stdout).contains(list[8..].trim()), "{list}");
}

#[cfg(unix)]
#[test]
fn a_path_is_printed_as_it_is_and_told_so_that_it_can_be_read() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let folder = folder("no_text");
    let run = |path: &[u8], more: &[&str]| {
        let program = env!("CARGO_BIN_EXE_ch05_perspective_correct");
        let path = OsStr::from_bytes(path);
        let mut command = Command::new(program);
        command.args(["--size", "16x12", "--out"]).arg(path).args(more).current_dir(&folder);
        command.output().expect("it starts")
    };
    // A program that reads the path finds the file.
    let output = run(b"caf\xe9.png", &[]);
    assert_eq!(output.stdout, b"caf\xe9.png\n");
    assert!(folder.join(OsStr::from_bytes(b"caf\xe9.png")).is_file());
    for (path, more, told) in [
        (b"caf\xe9.png/a.png".as_slice(), &[][..], "error: cannot write caf\\xe9.png: "),
        (b"caf\x1b[31m.xyz", &[], "error: cannot write caf\\u{1b}[31m.xyz: '.xyz' is no picture format"),
        (b"a.\xe9", &[], "error: cannot write a.\\xe9: "),
        (b"caf\xe9.gif", &[], "error: caf\\xe9.gif is for an animation"),
        (b"caf\xe9.bmp", &["--steps"], "error: caf\\xe9.bmp: an animation is"),
        (b"a.png", &["no\x1b[31m"], "error: ch05_perspective_correct has no variant 'no\\u{1b}[31m'"),
        (b"a.png", &["--zoom", "\x1b[31mx"], "error: invalid value '\\u{1b}[31mx' for '--zoom"),
    ] {
        let output = run(path, more);
        let stderr = text(&output.stderr);
        assert!(!output.status.success() && stderr.starts_with(told), "{stderr:?}");
        assert!(stderr.chars().all(|c| c == '\n' || !c.is_control()), "{stderr:?}");
    }
    assert_eq!(files(&folder).len(), 1);
}

#[test]
fn where_no_thread_can_be_started_one_draws_alone() {
    let folder = folder("no_threads");
    let run = |program: &str, arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).args(["--size", "64x48", "--out", "x/"]).current_dir(&folder);
        // No machine has room for such a stack.
        command.env("RUST_MIN_STACK", (1_u64 << 60).to_string()).output().expect("it starts")
    };
    for (program, arguments) in [
        (env!("CARGO_BIN_EXE_ch10_matrices_lighting"), &["turntable", "--rasterizer", "tiled"][..]),
        (env!("CARGO_BIN_EXE_ch10_matrices_lighting"), &["--sweep", "elevation", "turntable"]),
        (env!("CARGO_BIN_EXE_ch05_perspective_correct"), &["affine", "--steps"]),
    ] {
        let output = run(program, arguments);
        assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
    }
    assert_eq!(files(&folder.join("x")).len(), 3);
}

#[test]
fn more_threads_than_a_machine_can_have_are_not_started() {
    let folder = folder("threads");
    let mut command = Command::new(env!("CARGO_BIN_EXE_ch10_matrices_lighting"));
    command.args(["turntable", "--rasterizer", "tiled", "--size", "64x48", "--out", "a.png"]);
    let output = command.env("RAYON_NUM_THREADS", "100000").current_dir(&folder).output().expect("it starts");
    assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[test]
fn steps_that_do_not_fit_are_refused_with_a_size_that_does() {
    let reason =
        "'affine' has more steps than are kept (33554432 writes): 4096x4096 pixels would fit (--size)";
    refused("steps_too_large", &["affine", "--steps", "--size", "8192x8192"], 2, reason);
}

/// What is counted needs no memory for each time; what does not fit is not drawn.
#[cfg(target_os = "linux")]
#[test]
fn no_memory_is_taken_in_vain() {
    let folder = folder("memory");
    let program = env!("CARGO_BIN_EXE_ch05_perspective_correct");
    let run = |arguments: &str| {
        let line = format!("ulimit -v 200000; exec {program} {arguments} --out a.png");
        let mut command = Command::new("sh");
        command.args(["-c", &line]).env("RAYON_NUM_THREADS", "1").current_dir(&folder);
        command.output().expect("it starts")
    };
    let output = run("floor --overdraw --size 1280x960");
    assert!(output.status.success(), "{}", text(&output.stderr));
    // One picture would have 268 MB: it is not drawn in vain.
    for arguments in ["affine --compare --size 8192x8192", "affine --compare --size 8192x8192 --zoom 1"] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
        assert!(
            text(&output.stderr).contains("three such pictures are too wide"),
            "{}",
            text(&output.stderr)
        );
    }
}

#[test]
fn what_cannot_be_written_is_an_error_and_leaves_nothing() {
    let folder = folder("unwritable");
    std::fs::write(folder.join("file"), "in the way").expect("written");
    std::fs::create_dir(folder.join("folder.png")).expect("made");
    for path in ["file/a.png", "file"] {
        let output = run_in(&folder, &["--out", path]);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{path}: {stderr}");
        assert!(
            stderr.starts_with("error: cannot ") && stderr.contains(path.split('/').next().expect("a part")),
            "{stderr}"
        );
        assert_eq!(stderr.lines().count(), 1);
    }
    assert_eq!(files(&folder), ["file", "folder.png"]);
    assert_eq!(std::fs::read_to_string(folder.join("file")).expect("still there"), "in the way");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_replaced_by_a_picture() {
    use std::os::unix::fs::FileTypeExt;
    let folder = folder("pipe");
    let made = Command::new("mkfifo").arg(folder.join("a.png")).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo");
    let output = run_in(&folder, &["--out", "a.png"]);
    let said = "error: cannot write a.png: is no regular file: a pipe or a device\n";
    assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(1), said));
    assert!(folder.join("a.png").metadata().expect("still there").file_type().is_fifo());
    assert_eq!(files(&folder), ["a.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_is_an_error() {
    for option in ["--version", "--help", "--list"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a device");
        let program = env!("CARGO_BIN_EXE_ch05_perspective_correct");
        let output = Command::new(program).arg(option).stdout(full).output().expect("it starts");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{option}: {said}");
        assert!(said.starts_with("error: cannot write to standard output: "), "{option}: {said}");
    }
}

#[test]
fn the_name_of_a_picture_is_short_whatever_a_knob_is() {
    let folder = folder("names");
    let output = last(&folder, &["turntable", "--size", "8x6", "--eye=1e-300,1e-300", "--out", "x/"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(files(&folder.join("x")), ["turntable-azimuth-1e-300-elevation-1e-300.png"]);
}

#[test]
fn help_reads_well() {
    let output = run_in(&folder("help"), &["--help"]);
    assert!(output.status.success());
    let help = text(&output.stdout);
    for word in [
        "Why does a texture bend",
        "cargo run --bin ch05_perspective_correct",
        "--zoom",
        "--compare",
        "floor-affine",
    ] {
        assert!(help.contains(word), "{word} is missing in:\n{help}");
    }
    // No terminal: 100 columns. The second lines of the options and of the variants begin where their first ones do.
    assert!(help.lines().all(|line| line.chars().count() <= 100), "{help}");
    let second_lines = [
        "\n                    out/ch05_perspective_correct]",
        "\n  ch07_clipping, ch08_cvv, ch09_pipeline, ch10_matrices_lighting\n",
    ];
    for second in second_lines {
        assert!(help.contains(second), "{second:?} is missing in:\n{help}");
    }
}

#[test]
fn a_closed_pipe_ends_it_quietly() {
    let folder = folder("pipe");
    let mut child = Command::new(env!("CARGO_BIN_EXE_ch05_perspective_correct"))
        .args(["--all"])
        .current_dir(&folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(text(&output.stderr), "");
    assert!(output.status.success());
}

#[test]
fn flat_normals_without_a_model_of_ones_own() {
    let folder = folder("flat");
    for arguments in [&["lit", "--out", "smooth.png"][..], &["lit", "--flat", "--out", "flat.png"]] {
        let program = env!("CARGO_BIN_EXE_ch10_matrices_lighting");
        let output = Command::new(program).args(arguments).current_dir(&folder).output().expect("it starts");
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    let [smooth, flat] =
        ["smooth.png", "flat.png"].map(|name| image::open(folder.join(name)).expect("written").to_rgb8());
    assert!(smooth != flat, "every edge shows");
}

#[test]
fn every_program_knows_the_others() {
    let known: Vec<_> = PROGRAMS.iter().map(|program| (program.name, program.question)).collect();
    let expected: Vec<_> = CHAPTERS.iter().map(|(chapter, _)| (chapter.name, chapter.question)).collect();
    assert_eq!(known, expected);
    for (program, (chapter, _)) in PROGRAMS.iter().zip(CHAPTERS) {
        let names: Vec<_> = chapter.variants.iter().map(|variant| variant.name).collect();
        assert_eq!(program.variants, names, "{}", program.name);
        assert_eq!(program.has_model, chapter.variants.iter().any(Variant::has_model), "{}", program.name);
        assert_eq!(
            program.has_texture,
            chapter.variants.iter().any(Variant::has_texture),
            "{}",
            program.name
        );
    }
}

#[test]
fn a_version_and_standard_output() {
    let folder = folder("stdout");
    let output = run_in(&folder, &["--version"]);
    let version = concat!("ch05_perspective_correct ", env!("CARGO_PKG_VERSION"), "\n");
    assert_eq!(text(&output.stdout), version);
    let output = run_in(&folder, &["affine", "--out", "-", "--size", "40x30"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let picture = image::load_from_memory(&output.stdout).expect("a picture on standard output");
    assert_eq!((picture.width(), picture.height()), (40, 30));
    assert!(files(&folder).is_empty(), "nothing is written");
}

#[test]
fn a_picture_in_characters() {
    let folder = folder("show");
    let run = |arguments: &[&str], variables: &[(&str, &str)]| {
        let output = Command::new(env!("CARGO_BIN_EXE_ch05_perspective_correct"))
            .args(arguments)
            .env_remove("NO_COLOR")
            .env_remove("COLUMNS")
            .envs(variables.iter().copied())
            .current_dir(&folder)
            .output()
            .expect("the program starts");
        assert!(output.status.success(), "{}", text(&output.stderr));
        (text(&output.stdout), text(&output.stderr))
    };
    let (shown, said) = run(&["affine", "--show=blocks", "--size", "200x3"], &[("COLUMNS", "100")]);
    assert_eq!((shown.lines().count(), shown.matches('▀').count()), (1, 100), "{shown}");
    assert!(shown.starts_with("\x1b[38;2;") && shown.ends_with("▀\x1b[0m\n"), "{shown}");
    assert_eq!(said, "affine: 200×3\n");
    let (shown, _) = run(&["affine", "--show=blocks"], &[]);
    assert_eq!((shown.lines().count(), shown.matches('▀').count()), (30, 30 * 80));
    let (shown, said) = run(&["affine", "--show=blocks", "--compare"], &[("NO_COLOR", "1")]);
    assert!(!shown.contains('\x1b') && shown.contains('░'), "{shown}");
    assert!(said.starts_with("affine--correct: 1928×480\nnote: shades in place of colors"), "{said}");
    assert!(files(&folder).is_empty(), "nothing is written");
}

#[test]
fn pixels_of_a_zoomed_picture_are_found_again() {
    let folder = folder("zoomed");
    let output = run_in(&folder, &["affine", "--zoom", "16@60,120"]);
    assert_eq!(text(&output.stdout).trim_end(), "out/ch05_perspective_correct/affine-zoom16-at-60-120.png");
    assert_eq!(
        text(&output.stderr).trim_end(),
        "shown: columns 20 to 99 and rows 90 to 149, y up, each pixel as 16×16"
    );
    // The numbers in its frame say the same: the long tick of column 60 points at the pixel.
    let zoomed = image::open(folder.join("out/ch05_perspective_correct/affine-zoom16-at-60-120.png"));
    let zoomed = zoomed.expect("written").to_rgb8();
    let (left, below) = (zoomed.width() - 4 - 80 * 16, zoomed.height() - 1 - 18);
    let is_ink = |x: u32| zoomed.get_pixel(x, below).0 == [215; 3];
    let ticks: Vec<u32> =
        (left..zoomed.width()).filter(|&x| is_ink(x)).map(|x| 20 + (x - left) / 16).collect();
    assert!(ticks.contains(&60) && ticks.iter().all(|column| column % 5 == 0), "{ticks:?}");
}

/// The program of chapter 10, in a folder.
fn last(folder: &Path, arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_ch10_matrices_lighting");
    Command::new(program).args(arguments).current_dir(folder).output().expect("it starts")
}

#[test]
fn knobs_are_set_swept_and_listed() {
    let folder = folder("knobs");
    let listed = text(&last(&folder, &["turntable", "--knobs"]).stdout);
    assert!(listed.contains("  azimuth = 35   (a number, -180 to 180 °)\n"), "{listed}");
    let none = text(&run_in(&folder, &["facing", "--knobs"]).stdout);
    assert_eq!(none, "'facing' has no knobs\n");

    // Every way to say the same draws the same; what is set stands in the name.
    let small = ["turntable", "--size", "64x48"];
    let drawn = |more: &[&str], name: &str| {
        let output = last(&folder, &[&small[..], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let path = format!("out/ch10_matrices_lighting/{name}.png");
        assert_eq!(text(&output.stdout).trim_end(), path);
        std::fs::read(folder.join(path)).expect("written")
    };
    let own = drawn(&[], "turntable");
    let set = drawn(&["--set", "azimuth=-60", "--set", "elevation=10"], "turntable-azimuth--60-elevation-10");
    let eye = drawn(&["--eye", "-60,10"], "turntable-azimuth--60-elevation-10");
    assert!(own != set && set == eye);
    assert!(own != drawn(&["--light", "80,0"], "turntable-light-azimuth-80-light-elevation-0"));
    assert!(own != drawn(&["--background", "#ff0000"], "turntable-background-ff0000"));

    let sweep =
        last(&folder, &["turntable", "--size", "16x12", "--sweep", "elevation", "--out", "sweep.png"]);
    assert!(sweep.status.success(), "{}", text(&sweep.stderr));
    let bytes = std::fs::read(folder.join("sweep.png")).expect("written");
    let frames = bytes.windows(4).filter(|chunk| chunk == b"fcTL").count();
    assert_eq!(frames, 60);
}

#[test]
fn knobs_that_there_are_not_are_refused_with_those_that_there_are() {
    let folder = folder("no_knobs");
    let cases: [(&[&str], &str); 8] = [
        (&["turntable", "--set", "tilt=1"], "there is no knob 'tilt'\nKnobs of 'turntable'"),
        (&["turntable", "--set", "elevation=90"], "'elevation' cannot be '90': it is a number, -89 to 89 °"),
        (&["turntable", "--set", "elevation"], "expected NAME=VALUE"),
        (&["turntable", "--background", "red"], "'background' cannot be 'red': it is a color, RRGGBB"),
        (&["turntable", "--sweep", "background"], "it has no range to be swept"),
        (&["turntable", "--sweep", "tilt"], "there is no knob 'tilt'"),
        (&["rotation", "--eye", "1,2"], "'rotation': there is no knob 'azimuth'"),
        (&["--all", "--set", "azimuth=1"], "cannot be used with"),
    ];
    for (arguments, reason) in cases {
        let output = last(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(reason), "{arguments:?}: {}", text(&output.stderr));
    }
    assert!(files(&folder).is_empty());
}

#[test]
fn what_does_not_fit_the_variant_is_refused() {
    let folder = folder("unfit");
    let cases: [(&[&str], &str); 3] = [
        (&["turntable", "--model", "a.obj", "--as-is"], "--as-is means nothing to it"),
        (&["still-life", "--compare", "lit"], "'still-life' and 'lit' differ in size: give --size"),
        (&["lit", "--compare", "flat", "--size", "8000x30"], "three such pictures are too wide"),
    ];
    for (arguments, reason) in cases {
        let output = last(&folder, arguments);
        let said = text(&output.stderr);
        assert!(output.status.code() == Some(2) && said.contains(reason), "{arguments:?}: {said}");
    }
    assert!(files(&folder).is_empty());
}

#[test]
fn a_model_that_is_not_seen_is_told_of() {
    let folder = folder("unseen");
    let model = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("written");
    model("away.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n");
    model("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    let told = |variant: &str, name: &str| {
        let arguments = [variant, "--frame", "0", "--size", "64x48", "--model", name, "--out", "x.png"];
        let output = last(&folder, &arguments);
        assert!(output.status.success());
        text(&output.stderr)
    };
    assert!(told("lit", "away.obj").starts_with("nothing of away.obj is visible: its faces turn away"));
    assert!(told("lit", "line.obj").starts_with("nothing of line.obj is visible: its faces have no area"));
    assert_eq!(told("turntable", "away.obj"), "", "it draws both sides");
}

fn empty(folder: &Path) {
    let _ = std::fs::remove_dir_all(folder);
    std::fs::create_dir_all(folder).expect("a folder");
}

/// What a run gave: its exit code, what it printed, and the files that it wrote.
fn outcome(folder: &Path, arguments: &[&str]) -> (Option<i32>, Vec<u8>, Vec<Vec<u8>>) {
    empty(folder);
    let output = run_in(folder, arguments);
    let written: Vec<Vec<u8>> =
        written_below(folder).iter().map(|path| std::fs::read(path).expect("there")).collect();
    (output.status.code(), output.stdout, written)
}

fn written_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut found: Vec<PathBuf> =
        entries.flat_map(|path| if path.is_dir() { written_below(&path) } else { vec![path] }).collect();
    found.sort();
    found
}

/// Whether one of these options is among some, each of which is followed by its value.
fn is_any(options: &[&[&str]], names: &[&str]) -> bool {
    options.iter().any(|option| names.contains(&option[0]))
}

/// A small picture of a variant by these options, where both may be said.
fn small<'a>(options: &[&[&'a str]], variant: &'a str, size: &'a str) -> Vec<&'a str> {
    let mut arguments: Vec<&str> = options.concat();
    if !is_any(options, &["--all", "--list"]) {
        arguments.insert(0, variant);
    }
    if !is_any(options, &["--size", "--list", "--knobs"]) {
        arguments.extend(["--size", size]);
    }
    arguments
}

#[test]
fn of_two_options_both_are_used_or_the_pair_is_refused() {
    const OPTIONS: &[&[&str]] = &[
        &["--set", "tilt=60"],
        &["--size", "24x18"],
        &["--zoom", "2"],
        &["--compare"],
        &["--sweep", "tilt"],
        &["--steps"],
        &["--overdraw"],
        &["--inspect", "0,0"],
        &["--verbose"],
        &["--format", "json"],
        &["--out", "elsewhere/"],
        &["--show=blocks"],
        &["--knobs"],
        &["--list"],
        &["--all"],
        &["--window"],
    ];
    let folder = folder("pairs");
    let run = |options: &[&[&str]]| outcome(&folder, &small(options, "affine", "16x12"));
    let single: Vec<_> = OPTIONS.iter().map(|option| run(&[option])).collect();
    let mut accepted = 0;
    for (i, first) in OPTIONS.iter().enumerate() {
        for (j, second) in OPTIONS.iter().enumerate().skip(i + 1) {
            let both = run(&[first, second]);
            if both.0 == Some(0) {
                accepted += 1;
                assert!(both != single[i], "{second:?} is ignored beside {first:?}");
                assert!(both != single[j], "{first:?} is ignored beside {second:?}");
            } else {
                assert_eq!((both.0, both.2.len()), (Some(2), 0), "{first:?} {second:?}");
            }
        }
    }
    assert!(accepted > 30, "{accepted} pairs are accepted");
}

/// An exit code; files, each with its folder; and what was printed, if there are none.
type Outcome = (Option<i32>, Vec<(PathBuf, Vec<u8>)>, Vec<u8>);

/// What a run of the last chapter's program gave, and what it said.
fn told_outcome(folder: &Path, arguments: &[&str]) -> (Outcome, String) {
    empty(folder);
    let output = last(folder, arguments);
    // Not their names, in which what is given stands in any case.
    let read = |path: PathBuf| (path.with_file_name(""), std::fs::read(&path).expect("there"));
    let written: Vec<_> = written_below(folder).into_iter().map(read).collect();
    let printed = if written.is_empty() { output.stdout } else { Vec::new() };
    ((output.status.code(), written, printed), text(&output.stderr))
}

/// The options of models, animations and the pipeline, and then all others.
const OF_MODELS: &[&[&str]] = &[
    &["--animate"],
    &["--frame", "40"],
    &["--model", "../given/tip.obj"],
    &["--texture", "../given/dots.png"],
    &["--as-is"],
    &["--flat"],
    &["--eye", "10,20"],
    &["--light", "60,10"],
    &["--background", "203040"],
    &["--rasterizer", "scanline"],
    &["--set", "azimuth=70"],
    &["--size", "12x9"],
    &["--zoom", "2"],
    &["--compare", "turntable"],
    &["--sweep", "azimuth"],
    &["--steps"],
    &["--overdraw"],
    &["--inspect", "4,3"],
    &["--verbose"],
    &["--format", "json"],
    &["--out", "elsewhere/"],
    &["--show=blocks"],
    &["--knobs"],
    &["--list"],
    &["--all"],
    &["--window"],
];
/// So many of them are new here: with the others alone the pairs are those of the test above.
const NEW: usize = 10;

/// A run with some options of a pair, which says by itself what variant and what model can have both.
fn run_of_pair(folder: &Path, pair: [&[&str]; 2], options: &[&[&str]]) -> (Outcome, String) {
    let variant = if is_any(&pair, &["--as-is"]) { "exact" } else { "turntable" };
    let mut arguments = small(options, variant, "8x6");
    if !is_any(&pair, &["--model"]) && !is_any(options, &["--all", "--list", "--knobs"]) {
        arguments.extend(OF_MODELS[2]);
    }
    told_outcome(folder, &arguments)
}

#[test]
fn beside_an_option_of_models_or_animations_any_other_is_used_or_refused() {
    let (folder, given) = (folder("pairs_of_models"), folder("given"));
    // A tip towards us, smaller than the view and not in its middle.
    let tip = "v -1 -1 -4\nv 1 -1 -4\nv 0 1 -4\nv 0.2 0 -3\nvt 0 0\nvt 4 0\nvt 2 4\nvt 2 2\n\
               f 1/1 3/3 2/2\nf 1/1 2/2 4/4\nf 2/2 3/3 4/4\nf 3/3 1/1 4/4\n";
    std::fs::write(given.join("tip.obj"), tip).expect("written");
    let mut dots = Framebuffer::new(4, 4);
    [(0, 0), (1, 2), (3, 1)].iter().for_each(|&(x, y)| dots.set(x, y, Color::RED));
    dots.save(given.join("dots.png")).expect("written");

    let mut known = BTreeMap::new();
    let mut accepted = 0;
    for (i, &first) in OF_MODELS.iter().enumerate().take(NEW) {
        for &second in &OF_MODELS[i + 1..] {
            let pair = [first, second];
            let (both, said) = run_of_pair(&folder, pair, &pair);
            if both.0 == Some(0) {
                accepted += 1;
                let base = ["--as-is", "--model"].map(|name| is_any(&pair, &[name]));
                for (option, other) in [(first, second), (second, first)] {
                    let alone = || run_of_pair(&folder, pair, &[option]).0;
                    let single = known.entry((base, option)).or_insert_with(alone);
                    assert!(both != *single, "{other:?} is ignored beside {option:?}");
                }
            } else {
                assert_eq!((both.0, both.1.len()), (Some(2), 0), "{pair:?}: {said}");
                let is_named = |option: &&[&str]| option.iter().any(|word| said.contains(word));
                assert!(pair.iter().any(is_named), "{pair:?}: {said}");
            }
        }
    }
    assert!(accepted > 100, "{accepted} pairs are accepted");
}
