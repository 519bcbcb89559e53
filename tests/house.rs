//! What `lib.rs` promises, the imports keep: a room imports only rooms that stand above it, and no files import each other
//! in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module of the library: its path, such as `exact::edge`; that of the crate is empty.
type Module = Vec<String>;

fn library() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("lib")
}

/// All modules with their sources, without comments and without their tests.
fn modules() -> BTreeMap<Module, String> {
    fn collect(folder: &Path, module: &Module, found: &mut BTreeMap<Module, String>) {
        for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path())
        {
            let stem = entry.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
            let inner: Module = module.iter().cloned().chain([stem.clone()]).collect();
            if entry.is_dir() {
                collect(&entry, &inner, found);
            } else {
                let source = std::fs::read_to_string(&entry).expect("a source");
                let is_root = stem == "mod" || stem == "lib";
                found.insert(if is_root { module.clone() } else { inner }, code_of(&source));
            }
        }
    }
    let mut found = BTreeMap::new();
    collect(&library(), &Module::new(), &mut found);
    found
}

fn code_of(source: &str) -> String {
    let is_test = |line: &&str| line.starts_with("#[cfg(test)]") || line.starts_with("#[cfg(all(test");
    let lines = source.lines().take_while(|line| !is_test(line));
    lines.filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

/// The rooms, in the order of their declarations in `lib.rs`.
fn rooms(modules: &BTreeMap<Module, String>) -> Vec<String> {
    let declared = modules[&Module::new()].lines().filter_map(|line| {
        line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';').map(str::to_owned)
    });
    declared.collect()
}

/// What `lib.rs` exports under a shorter name: the room of each.
fn exports(modules: &BTreeMap<Module, String>) -> BTreeMap<String, String> {
    let lines = modules[&Module::new()].lines().filter_map(|line| line.strip_prefix("pub use "));
    let mut exports = BTreeMap::new();
    for (room, names) in lines.filter_map(|line| line.trim_end_matches(';').split_once("::")) {
        for name in names.trim_matches(['{', '}']).split(',') {
            exports.insert(name.trim().to_owned(), room.to_owned());
        }
    }
    exports
}

/// The paths that a piece of code names after `prefix`, with groups such as `{a, b::c}` taken apart.
fn paths_after(code: &str, prefix: &str) -> Vec<Module> {
    fn expand(text: &str, before: &Module, found: &mut Vec<Module>) {
        let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
        let (name, rest) = text.split_at(end);
        let mut path = before.clone();
        if !name.is_empty() {
            path.push(name.to_owned());
        }
        match rest.strip_prefix("::").unwrap_or(rest) {
            group if group.starts_with('{') => {
                // Every name that follows a brace or a comma at this depth.
                let mut depth = 0;
                for (i, c) in group.char_indices() {
                    if c == '{' || c == ',' {
                        depth += i32::from(c == '{');
                        if depth == 1 {
                            expand(group[i + 1..].trim_start(), &path, found);
                        }
                    } else if c == '}' {
                        depth -= 1;
                        if depth == 0 {
                            break;
                        }
                    }
                }
            }
            next if rest.starts_with("::") => expand(next, &path, found),
            _ => found.push(path),
        }
    }
    let mut found = Vec::new();
    for (at, _) in code.match_indices(prefix) {
        let is_word =
            code[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':');
        if !is_word {
            expand(&code[at + prefix.len()..], &Module::new(), &mut found);
        }
    }
    found
}

/// For each module the modules that it imports.
fn imports(modules: &BTreeMap<Module, String>) -> BTreeMap<Module, BTreeSet<Module>> {
    let exports = exports(modules);
    let resolve = |path: Module| -> Option<Module> {
        let path = match path.first().and_then(|first| exports.get(first)) {
            Some(room) => vec![room.clone()],
            None => path,
        };
        (1..=path.len()).rev().map(|length| path[..length].to_vec()).find(|path| modules.contains_key(path))
    };
    let of = |(module, code): (&Module, &String)| {
        let mut paths = paths_after(code, "crate::");
        let parent = module.len().saturating_sub(1);
        let of_parent = paths_after(code, "super::").into_iter();
        paths.extend(of_parent.map(|path| module[..parent].iter().cloned().chain(path).collect()));
        // A folder's own modules by their bare names, as in `use edge::Coverage;`.
        let children =
            modules.keys().filter(|child| child.len() == module.len() + 1 && child.starts_with(module));
        for child in children {
            let name = child.last().expect("a name");
            if !paths_after(code, &format!("use {name}::")).is_empty() {
                paths.push(child.clone());
            }
        }
        let imported = paths.into_iter().filter_map(resolve).filter(|imported| imported != module);
        (module.clone(), imported.collect())
    };
    modules.iter().filter(|(module, _)| !module.is_empty()).map(of).collect()
}

#[test]
fn paths_are_taken_apart() {
    let code = "use crate::a::{B, c::{D, E}, f};\nuse crate::Color;\nlet x = crate::g::h(crate::i::J);";
    let found: Vec<String> = paths_after(code, "crate::").iter().map(|path| path.join("::")).collect();
    assert_eq!(found, ["a::B", "a::c::D", "a::c::E", "a::f", "Color", "g::h", "i::J"]);
}

#[test]
fn a_room_imports_only_rooms_above_it() {
    let modules = modules();
    let rooms = rooms(&modules);
    let level = |module: &Module| rooms.iter().position(|room| *room == module[0]).expect("a room of lib.rs");
    let mut wrong = Vec::new();
    let mut count = 0;
    for (module, imported) in imports(&modules) {
        count += imported.len();
        for other in imported.iter().filter(|other| level(other) > level(&module)) {
            wrong.push(format!(
                "{} imports {}, which is explained later",
                module.join("::"),
                other.join("::")
            ));
        }
    }
    assert!(count > 200, "only {count} imports were found: does this test still read them?");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut left = imports(&modules());
    // Take away files that import none of those left, until all are gone.
    loop {
        let free: Vec<Module> = left
            .iter()
            .filter(|(_, imported)| imported.iter().all(|other| !left.contains_key(other)))
            .map(|(module, _)| module.clone())
            .collect();
        if free.is_empty() {
            break;
        }
        for module in free {
            left.remove(&module);
        }
    }
    let names: Vec<String> = left.keys().map(|module| module.join("::")).collect();
    assert!(names.is_empty(), "in a circle, or above one: {names:?}");
}

/// The table on the front page: for each room the chapter in which its readers meet it, as a number that does not fall.
fn front_page() -> Vec<(u32, String)> {
    let source = std::fs::read_to_string(library().join("lib.rs")).expect("lib.rs");
    let rows = source.lines().filter_map(|line| line.strip_prefix("//!   ")).filter_map(|line| {
        let mut words = line.split_whitespace();
        let chapter = match words.next()? {
            "more" => 100,
            "…" => 101,
            label => label.strip_prefix("ch")?.parse().ok()?,
        };
        Some((chapter, words.next()?.to_owned()))
    });
    rows.collect()
}

#[test]
fn the_chapters_of_the_front_page_are_those_of_the_rooms() {
    let table = front_page();
    assert!(table.is_sorted_by_key(|(chapter, _)| *chapter), "{table:?}");
    for (chapter, room) in table.iter().filter(|(chapter, _)| *chapter < 100) {
        let file = library().join(room).with_extension("rs");
        let file = if file.exists() { file } else { library().join(room).join("mod.rs") };
        let source = std::fs::read_to_string(&file).expect("a source");
        let first = source.lines().next().expect("a headline");
        let label = first.trim_start_matches("//! Chapters ").trim_start_matches("//! Chapter ");
        let number = label.split(|c: char| !c.is_ascii_digit()).next().expect("a number");
        assert_eq!(number.parse(), Ok(*chapter), "{room} begins with {first:?}");
    }
}

#[test]
fn the_front_page_lists_the_rooms_in_their_order() {
    let listed: Vec<String> = front_page().into_iter().map(|(_, room)| room).collect();
    // Those that no chapter speaks of are not in the list.
    const SMALL: [&str; 2] = ["observer", "plane"];
    let rooms: Vec<String> =
        rooms(&modules()).into_iter().filter(|room| !SMALL.contains(&room.as_str())).collect();
    assert_eq!(listed, rooms);
}

/// Cargo is told which programs of tests there are: a file that none of them has would never be compiled.
#[test]
fn every_file_of_tests_belongs_to_a_program() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| std::fs::read_to_string(root.join(file)).expect("a source");
    let (manifest, programs) = (read("Cargo.toml"), read("tests/library.rs") + &read("tests/files.rs"));
    for file in root.join("tests").read_dir().expect("a folder").map(|entry| entry.expect("an entry").path())
    {
        let stem = file.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let is_program = manifest.contains(&format!("[[test]]\nname = \"{stem}\"\n"));
        let is_known = is_program || programs.contains(&format!("\nmod {stem};\n"));
        assert!(is_known || file.extension().is_none_or(|extension| extension != "rs"), "{}", file.display());
    }
}
