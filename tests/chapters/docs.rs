//! The pages in `docs/` and the README cannot drift: what they include, show, name and link to exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::chapters::CHAPTERS;
use rasterbook::figure::picture::difference;
use rasterbook::figure::{Mistake, Variant};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files below a folder that end so.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found = Vec::new();
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|it| it == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The pages: the README and everything in docs/src.
fn pages() -> Vec<PathBuf> {
    let mut pages = files(&root().join("docs/src"), "md");
    pages.push(root().join("README.md"));
    pages
}

/// The pages of a chapter: the one with the name of its program, and those beside it with the same number.
fn pages_of(program: &str) -> String {
    let (number, _) = program.split_once('_').expect("a number");
    let is_of_chapter = |page: &&PathBuf| {
        page.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&format!("{number}_")))
    };
    pages().iter().filter(is_of_chapter).map(|page| read(page)).collect()
}

/// The parts of a text between a beginning and an end.
fn between<'a>(text: &'a str, begin: &'a str, end: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(begin).skip(1).filter_map(move |rest| rest.split_once(end).map(|(part, _)| part))
}

#[test]
fn every_include_has_its_anchor_and_every_anchor_its_page() {
    let sources: Vec<PathBuf> =
        [files(&root().join("lib"), "rs"), files(&root().join("chapters"), "rs")].concat();
    let mut unused: BTreeSet<(PathBuf, String)> = BTreeSet::new();
    for source in &sources {
        let text = read(source);
        for anchor in between(&text, "// ANCHOR: ", "\n") {
            assert!(
                text.contains(&format!("// ANCHOR_END: {anchor}\n")),
                "{}: {anchor} has no end",
                source.display()
            );
            unused.insert((source.clone(), anchor.to_owned()));
        }
    }
    let known = unused.clone();
    for page in pages() {
        let text = read(&page);
        for include in between(&text, "{{#include ", "}}") {
            let (file, anchor) =
                include.split_once(':').unwrap_or_else(|| panic!("{include} names no anchor"));
            let file = page.parent().expect("a folder").join(file);
            let file =
                file.canonicalize().unwrap_or_else(|error| panic!("{}: {include}: {error}", page.display()));
            // Pinned histories are included from the line after their header on.
            if file.parent().is_some_and(|folder| folder.ends_with("tests/histories")) {
                assert!(anchor.starts_with("4:"), "{}: {include} shows the header", page.display());
                continue;
            }
            let key = known
                .iter()
                .find(|(source, name)| name == anchor && source.canonicalize().ok().as_ref() == Some(&file));
            let key = key.unwrap_or_else(|| panic!("{}: no anchor for {include}", page.display()));
            unused.remove(key);
        }
        // Code in pages is included, never pasted.
        for block in between(&text, "```rust", "```") {
            assert!(block.contains("{{#include "), "{}: pasted Rust:{block}", page.display());
        }
    }
    assert!(unused.is_empty(), "anchors that no page includes: {unused:?}");
}

#[test]
fn the_readme_shows_a_history_as_it_is_told() {
    let pinned = read(&root().join("tests/histories/ch05_perspective_correct__affine.snap"));
    // Without the header, and without what is told with -v alone.
    let told = pinned.splitn(4, '\n').nth(3).expect("a history");
    let touched = told.split("\nWhat did not reach").next().expect("its beginning").trim_end();
    assert!(read(&root().join("README.md")).contains(touched), "README.md shows an old history");
}

#[test]
fn every_picture_and_every_link_exists() {
    for page in pages() {
        let text = read(&page);
        let images = between(&text, "src=\"", "\"");
        for target in between(&text, "](", ")").chain(images) {
            let target = target.split(['#', ' ']).next().unwrap_or_default();
            if target.is_empty() || target.starts_with("https://") {
                continue;
            }
            let path = page.parent().expect("a folder").join(target);
            assert!(path.exists(), "{}: {target} does not exist", page.display());
            // A window looks as the desktop has it: no test can draw this one.
            let is_pinned = target.ends_with(".snap.png") || target == "docs/images/window.png";
            assert!(!target.ends_with(".png") || is_pinned, "{target} is no snapshot");
        }
    }
}

#[test]
fn every_program_and_every_variant_has_its_line() {
    let readme = read(&root().join("README.md"));
    let summary = read(&root().join("docs/src/SUMMARY.md"));
    for (chapter, _) in CHAPTERS {
        assert!(readme.contains(&format!("`{}`", chapter.name)), "README: {}", chapter.name);
        assert!(readme.contains(chapter.question), "README: {}", chapter.question);
        assert!(summary.contains(&format!("{}.md", chapter.name)), "SUMMARY: {}", chapter.name);
        let page = pages_of(chapter.name);
        for variant in chapter.variants {
            assert!(page.contains(&format!("`{}`", variant.name)), "{}.md: {}", chapter.name, variant.name);
        }
    }
}

#[test]
fn pages_count_the_pixels_in_which_mistake_and_remedy_differ() {
    for (chapter, _) in CHAPTERS {
        let page = pages_of(chapter.name);
        for variant in chapter.variants {
            let Mistake::RemediedBy(remedy) = variant.mistake else { continue };
            let picture = |variant: &Variant| {
                let subject = variant.subject().expect("assets");
                variant.draw(&variant.options(subject.as_ref()))
            };
            let remedy = chapter.find(remedy).expect("a variant");
            let (_, count) = difference(&picture(variant), &picture(remedy)).expect("of one size");
            let words: Vec<&str> = page.split_whitespace().collect();
            assert!(
                words.contains(&count.to_string().as_str()),
                "{}.md: {} differs in {count} pixels",
                chapter.name,
                variant.name
            );
        }
    }
}

#[test]
fn every_convention_names_a_test_that_exists() {
    let sources: String = [files(&root().join("lib"), "rs"), files(&root().join("tests"), "rs")]
        .concat()
        .iter()
        .map(|path| read(path))
        .collect();
    let page = read(&root().join("docs/src/conventions.md"));
    let mut count = 0;
    for line in page.lines().filter(|line| line.starts_with("| **")) {
        // `name` in `file`
        let parts: Vec<&str> = line.split('`').collect();
        let tests: Vec<&str> =
            parts.windows(2).filter(|pair| pair[1].starts_with(" in ")).map(|pair| pair[0]).collect();
        if line.contains("every test in `tests/snapshots.rs`") {
            continue;
        }
        let existing = tests.iter().filter(|name| sources.contains(&format!("fn {name}("))).count();
        assert!(existing == tests.len() && existing > 0, "a test that does not exist: {line}");
        count += 1;
    }
    assert!(count > 20, "{count} conventions");
}

#[test]
fn commands_name_programs_and_variants_that_exist() {
    let mut count = 0;
    for page in pages() {
        for command in between(&read(&page), "cargo run --bin ", "\n") {
            let command = command.split(['`', '#', '|']).next().unwrap_or_default();
            let mut words = command.split_whitespace();
            let program = words.next().unwrap_or_default();
            let (chapter, _) = CHAPTERS
                .iter()
                .find(|(chapter, _)| chapter.name == program)
                .unwrap_or_else(|| panic!("{}: {command}", page.display()));
            if let Some(variant) = words.find(|word| *word != "--").filter(|word| !word.starts_with('-')) {
                assert!(chapter.find(variant).is_some(), "{}: {command}", page.display());
            }
            count += 1;
        }
    }
    assert!(count > 15, "{count} commands");
}

/// The animations of the README, and what drew them.
const ANIMATIONS: [(&str, &str, &str); 2] = [
    (
        "turntable.gif",
        "ch10_matrices_lighting",
        "turntable --model assets/pawn.obj --texture assets/wood.png --animate --size 128x96",
    ),
    ("pieces.gif", "ch05_perspective_correct", "floor-affine --sweep pieces --compare --size 240x180"),
];

#[test]
fn animations_are_what_the_programs_draw() {
    for (name, program, arguments) in ANIMATIONS {
        let (_, path) = CHAPTERS.iter().find(|(chapter, _)| chapter.name == program).expect("a program");
        let drawn = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let run = std::process::Command::new(path)
            .args(arguments.split(' '))
            .arg("--out")
            .arg(&drawn)
            .current_dir(root())
            .status();
        assert!(run.expect("it starts").success());
        let is_same = fs::read(&drawn).expect("drawn")
            == fs::read(root().join("docs/images").join(name)).expect("there");
        assert!(
            is_same,
            "docs/images/{name} is old: cargo run --bin {program} -- {arguments} --out docs/images/{name}"
        );
    }
}
