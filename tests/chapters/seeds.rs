//! The targets of fuzzing, as plain tests: what was found and kept as a corpus, and bytes from a fixed seed.

use std::path::Path;
use std::process::Command;

use crate::arguments;
use crate::chapters::CHAPTERS;
use crate::fuzz;
use rasterbook::figure::Chapter;

/// Bytes that are the same in every run: xorshift, G. Marsaglia, 2003.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn bytes(&mut self, most: u64) -> Vec<u8> {
        let count = self.next() % most;
        (0..count).map(|_| (self.next() >> 32) as u8).collect()
    }
}

/// The corpus of a target as it is; each with some bytes changed; and so many random ones.
fn play(name: &str, rounds: usize, most: u64, target: impl Fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(name);
    let mut paths: Vec<_> =
        std::fs::read_dir(&folder).expect("a corpus").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    let random = &mut Random(0x9E37_79B9_7F4A_7C15);
    for path in paths {
        let bytes = std::fs::read(&path).expect("a file");
        target(&bytes);
        for _ in 0..rounds / 16 {
            let mut changed = bytes.clone();
            for _ in 0..=random.next() % 4 {
                let place = random.next() as usize % changed.len().max(1);
                if let Some(byte) = changed.get_mut(place) {
                    *byte = random.next() as u8;
                }
            }
            target(&changed);
        }
    }
    for _ in 0..rounds {
        target(&random.bytes(most));
    }
}

fn chapters() -> Vec<&'static Chapter> {
    CHAPTERS.iter().map(|(chapter, _)| *chapter).collect()
}

#[test]
fn models() {
    play("model", 200, 300, fuzz::model);
}

#[test]
fn images() {
    play("image", 200, 300, fuzz::image);
}

#[test]
fn scenes() {
    play("scene", 300, 400, fuzz::scene);
}

#[test]
fn polygons() {
    play("polygon", 2000, 300, fuzz::polygon);
}

#[test]
fn histories() {
    let chapters = chapters();
    play("history", 48, 200, |data| fuzz::history(&chapters, data));
}

#[test]
fn command_lines() {
    // What the programs say goes past the output that a test keeps, so another process plays them.
    let itself = std::env::current_exe().expect("a path");
    let played = Command::new(itself).args(["--exact", "seeds::command_lines_aloud", "--ignored"]).output();
    let played = played.expect("it starts");
    let said = [played.stdout, played.stderr].map(|said| String::from_utf8_lossy(&said).into_owned());
    let end = said.each_ref().map(|said| said.lines().rev().take(20).collect::<Vec<_>>());
    assert!(played.status.success() && said[0].contains("1 passed"), "the last lines, backwards: {end:#?}");
    // Lists, help and refusals were among them, and no character of an argument moved a cursor.
    for part in ["\"variants\":", "Usage: cargo run", "has no variant", "unexpected argument"] {
        assert!(said.iter().any(|said| said.contains(part)), "nobody said {part}");
    }
    let is_odd = |c: char| c.is_control() && !c.is_whitespace();
    assert!(!said.iter().any(|said| said.contains(is_odd)), "what is said has control characters");
}

#[test]
#[ignore = "talks much: `command_lines` plays it"]
fn command_lines_aloud() {
    let chapters = chapters();
    play("arguments", 800, 60, |data| arguments::arguments(&chapters, data));
}
