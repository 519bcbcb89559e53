//! Material libraries (MTL) from the wild, and the textures that they name.
//!
//! As with OBJ text, each statement is read once and made plain; one that cannot be used costs its line, not the library.
//! The color of a material (`Kd`) tints its texture (`map_Kd`): both are factors of what is seen.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::MAX_WARNINGS;
use super::statements::{Statements, keyword, name_without_comment, readable, short, without_comment, words};
use super::text::Count;
use crate::color::Color;
use crate::files::{
    FileError, MAX_FILE_BYTES, MAX_TEXELS, Warnings, load_texture_within, read_file_within, shown_path,
};
use crate::texture::Texture;

/// The most libraries of a model, and the most materials of a library, that are read.
const MAX_LIBRARIES: usize = 256;
const MAX_MATERIALS: usize = 1 << 16;

/// A material of a library.
struct Material {
    name: Vec<u8>,
    /// The library, by its place.
    library: usize,
    line: u32,
    color: Option<[f64; 3]>,
    map: Option<Vec<u8>>,
    /// Statements that are not drawn, and how often they stand there.
    not_drawn: Vec<Vec<u8>>,
}

/// The materials of a model.
pub(super) struct Materials {
    /// The OBJ file.
    model: PathBuf,
    libraries: Vec<PathBuf>,
    list: Vec<Material>,
    by_name: HashMap<Vec<u8>, usize>,
    pictures: Pictures,
}

impl Materials {
    /// Reads the libraries that the `mtllib` statements of the OBJ file `model` name, each once.
    pub(super) fn load(model: &Path, statements: &[(u32, Vec<u8>)], warnings: &mut Warnings) -> Self {
        Self::load_within(model, statements, MAX_FILE_BYTES, warnings)
    }

    /// The same, if all libraries together have no more than `left` bytes; those for which it does not last are left out.
    fn load_within(
        model: &Path,
        statements: &[(u32, Vec<u8>)],
        mut left: u64,
        warnings: &mut Warnings,
    ) -> Self {
        let (libraries, list, by_name) = (Vec::new(), Vec::new(), HashMap::new());
        let mut materials =
            Self { model: model.to_owned(), libraries, list, by_name, pictures: Pictures::default() };
        let mut known = HashSet::new();
        for (line, names) in statements {
            if known.len() >= MAX_LIBRARIES {
                warnings.push(format!("{}: line {line}: more libraries than are read", shown_path(model)));
                break;
            }
            if names.is_empty() {
                warnings.push(format!("{}: line {line}: mtllib without a name", shown_path(model)));
            }
            for path in library_names(folder_of(model), names).into_iter().take(MAX_LIBRARIES) {
                // The same file under another name is the same file.
                if !known.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
                    continue;
                }
                match read_file_within(&path, left) {
                    Ok(text) => {
                        left -= text.len() as u64;
                        materials.add_library(&path, &text, warnings);
                    }
                    Err(error) => {
                        let place = format!("{}: line {line}", shown_path(model));
                        warnings.push(format!("{place}: a material library cannot be used: {error}"));
                    }
                }
            }
        }
        materials
    }

    /// Takes the materials of a library. Of two with the same name the later one is used.
    fn add_library(&mut self, path: &Path, text: &[u8], warnings: &mut Warnings) {
        let library = self.libraries.len();
        self.libraries.push(path.to_owned());
        let mut plain = PlainLibrary::new(library);
        for (line, statement) in Statements::new(text) {
            plain.take(line, &statement);
        }
        let of_this = |warning: String| format!("{}: {warning}", shown_path(path));
        let (materials, more) = plain.finish();
        warnings.extend(more.into_iter().map(of_this));
        for material in materials {
            let short = name_without_comment(&material.name).to_vec();
            let place = self.list.len();
            self.by_name.entry(short).or_insert(place);
            self.by_name.insert(material.name.clone(), place);
            self.list.push(material);
        }
    }

    /// The texture of each material that is used, by its name; none where it is not known.
    pub(super) fn textures(&mut self, used: &[Vec<u8>], warnings: &mut Warnings) -> Vec<Option<Texture>> {
        let find = |name: &Vec<u8>| {
            self.by_name.get(name).or_else(|| self.by_name.get(name_without_comment(name))).copied()
        };
        let found: Vec<Option<usize>> = used.iter().map(find).collect();
        for (name, _) in used.iter().zip(&found).filter(|(_, place)| place.is_none()) {
            let name = short(name);
            warnings.push(format!(
                "{}: material '{name}' is in no library: drawn in gray",
                shown_path(&self.model)
            ));
        }
        self.warn_of_what_is_not_drawn(found.iter().flatten(), warnings);
        let mut made = HashMap::new();
        let mut of_material = |place: usize| -> Option<Texture> {
            made.entry(place).or_insert_with(|| self.texture(place, warnings)).clone()
        };
        found.into_iter().map(|place| place.and_then(&mut of_material)).collect()
    }

    /// One line for each library whose materials have more than is drawn here.
    fn warn_of_what_is_not_drawn<'a>(&self, used: impl Iterator<Item = &'a usize>, warnings: &mut Warnings) {
        let mut words = BTreeMap::<usize, Vec<String>>::new();
        for material in used.map(|&place| &self.list[place]) {
            let of_library = words.entry(material.library).or_default();
            for word in &material.not_drawn {
                let word = readable(word);
                if of_library.len() < 12 && !of_library.contains(&word) {
                    of_library.push(word);
                }
            }
        }
        for (library, words) in words.into_iter().filter(|(_, words)| !words.is_empty()) {
            let path = shown_path(&self.libraries[library]);
            warnings.push(format!("{path}: only Kd and map_Kd are drawn; left out: {}", words.join(", ")));
        }
    }

    /// The picture that a material names, tinted with its color; or one texel of its color.
    fn texture(&mut self, place: usize, warnings: &mut Warnings) -> Option<Texture> {
        let material = &self.list[place];
        let plain = material.color.map(|color| {
            Texture::new(1, 1, vec![Color::truncated(color.map(|channel| channel * 255.0 + 0.5))])
        });
        let Some(name) = &material.map else { return plain };
        let library = &self.libraries[material.library];
        let folders = [folder_of(library), folder_of(&self.model)];
        let who =
            format!("{}: line {}: material '{}'", shown_path(library), material.line, short(&material.name));
        match self.pictures.load(&find_picture(folders, name), warnings) {
            Ok(picture) => match material.color.unwrap_or([1.0; 3]) {
                [1.0, 1.0, 1.0] => Some(picture),
                color => {
                    if color == [0.0; 3] {
                        warnings.push(format!("{who}: Kd 0 0 0 makes its texture black"));
                    }
                    Some(self.pictures.tinted(&picture, color).unwrap_or_else(|reason| {
                        warnings.push(format!("{who}: its texture is not tinted by Kd: {reason}"));
                        picture
                    }))
                }
            },
            Err(error) => {
                warnings.push(format!("{who}: its texture cannot be used: {error}"));
                plain
            }
        }
    }
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// The pictures of a model, each decoded once.
#[derive(Default)]
struct Pictures {
    decoded: HashMap<PathBuf, Result<Texture, FileError>>,
    texels: u64,
}

impl Pictures {
    fn load(&mut self, path: &Path, warnings: &mut Warnings) -> Result<Texture, FileError> {
        // The same file under another name is the same file.
        let key = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if let Some(known) = self.decoded.get(&key) {
            return known.clone();
        }
        let loaded = load_texture_within(path, MAX_TEXELS - self.texels).map(|(texture, more)| {
            warnings.extend(more);
            self.texels += texels(&texture);
            texture
        });
        self.decoded.insert(key, loaded.clone());
        loaded
    }

    /// A copy, each texel times a color.
    fn tinted(&mut self, picture: &Texture, color: [f64; 3]) -> Result<Texture, String> {
        let count = texels(picture);
        if count > MAX_TEXELS - self.texels {
            return Err(format!("all textures of a model may have {MAX_TEXELS} pixels"));
        }
        self.texels += count;
        let [width, height] = [picture.width(), picture.height()].map(|side| side as usize);
        let tint = |texel: [f64; 3]| {
            Color::truncated(std::array::from_fn::<f64, 3, _>(|k| {
                (texel[k] * color[k]).clamp(0.0, 255.0) + 0.5
            }))
        };
        let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let texels = places.map(|(column, row)| tint(picture.texel(column, row))).collect();
        Ok(Texture::new(picture.width(), picture.height(), texels))
    }
}

fn texels(picture: &Texture) -> u64 {
    u64::from(picture.width()) * u64::from(picture.height())
}

/// The paths that a name may stand for: `\` separates folders, as `/` does; a name that is not UTF-8 is what it is, or else
/// Latin 1.
fn paths_of(name: &[u8]) -> Vec<PathBuf> {
    let name: Vec<u8> = name.iter().map(|&byte| if byte == b'\\' { b'/' } else { byte }).collect();
    let mut paths = Vec::new();
    #[cfg(unix)]
    if std::str::from_utf8(&name).is_err() {
        use std::os::unix::ffi::OsStrExt;
        paths.push(PathBuf::from(std::ffi::OsStr::from_bytes(&name)));
    }
    paths.push(readable(&name).into());
    paths
}

fn unquoted(name: &[u8]) -> &[u8] {
    name.strip_prefix(b"\"").and_then(|name| name.strip_suffix(b"\"")).unwrap_or(name)
}

/// The file in a folder that a name stands for, if it is there.
fn existing(folder: &Path, name: &[u8]) -> Option<PathBuf> {
    paths_of(unquoted(name)).into_iter().map(|path| folder.join(path)).find(|path| path.exists())
}

/// The files that one `mtllib` names: all of it if there is such a file, for names may have blanks; else as many as there
/// are words that end in `.mtl`; else each word.
fn library_names(folder: &Path, names: &[u8]) -> Vec<PathBuf> {
    if let Some(path) = existing(folder, names) {
        return vec![path];
    }
    let names = name_without_comment(names);
    let is_end = |word: &[u8]| {
        let word = unquoted(word);
        word.len() >= 4 && word[word.len() - 4..].eq_ignore_ascii_case(b".mtl")
    };
    let mut split: Vec<Vec<u8>> = Vec::new();
    let mut goes_on = false;
    let any_end = words(names).any(is_end);
    for word in words(names) {
        match split.last_mut() {
            Some(last) if goes_on => {
                last.push(b' ');
                last.extend_from_slice(word);
            }
            _ => split.push(word.to_vec()),
        }
        goes_on = any_end && !is_end(word);
    }
    let path = |name: Vec<u8>| {
        let first = || folder.join(paths_of(unquoted(&name)).remove(0));
        existing(folder, &name).unwrap_or_else(first)
    };
    split.into_iter().map(path).collect()
}

/// The file of a picture: beside the library, else beside the model; if it is in neither place, by its last name alone, for
/// its folder may be that of another machine. What is nowhere is missed beside the library.
fn find_picture(folders: [&Path; 2], name: &[u8]) -> PathBuf {
    let last_of = |name: &[u8]| {
        let start = name.iter().rposition(|&byte| byte == b'/' || byte == b'\\').map_or(0, |at| at + 1);
        name[start..].to_vec()
    };
    let short = name_without_comment(name);
    for name in [name, short, &last_of(unquoted(short))] {
        if let Some(path) =
            folders.iter().filter(|_| !name.is_empty()).find_map(|folder| existing(folder, name))
        {
            return path;
        }
    }
    folders[0].join(paths_of(unquoted(short)).remove(0))
}

/// A library as plain text: materials and pictures are numbers.
struct PlainLibrary {
    library: usize,
    plain: String,
    materials: Vec<Material>,
    maps: Vec<Vec<u8>>,
    warnings: Warnings,
    orphans: Count,
    is_full: bool,
}

impl PlainLibrary {
    fn new(library: usize) -> Self {
        let (plain, materials, maps, warnings) = Default::default();
        Self { library, plain, materials, maps, warnings, orphans: Count::default(), is_full: false }
    }

    fn take(&mut self, line: u32, statement: &[u8]) {
        let (word, rest) = keyword(statement);
        if self.is_full {
            return;
        }
        if word == b"newmtl" {
            return self.begin(line, rest);
        }
        if self.materials.is_empty() {
            return self.orphans.add(line);
        }
        let done = if word.eq_ignore_ascii_case(b"Kd") {
            self.color(without_comment(rest))
        } else if word.eq_ignore_ascii_case(b"map_Kd") {
            self.map(line, rest)
        } else {
            self.other(word, without_comment(rest));
            Ok(())
        };
        if let Err(cause) = done {
            self.warn(line, &format!("{cause}: left out"));
        }
    }

    fn warn(&mut self, line: u32, warning: &str) {
        // There may be one for each line of a large file.
        if self.warnings.len() < 2 * MAX_WARNINGS {
            self.warnings.push(format!("line {line}: {warning}"));
        }
    }

    fn begin(&mut self, line: u32, name: &[u8]) {
        if self.materials.len() == MAX_MATERIALS {
            self.is_full = true;
            return self.warn(line, &format!("more than {MAX_MATERIALS} materials: the others are left out"));
        }
        if name.is_empty() {
            self.warn(line, "newmtl without a name: it cannot be used");
        }
        self.plain += &format!("newmtl {}\n", self.materials.len());
        let (name, library, not_drawn) = (name.to_vec(), self.library, Vec::new());
        self.materials.push(Material { name, library, line, color: None, map: None, not_drawn });
    }

    /// `Kd r g b`; g and b may be left out, and are as r then.
    fn color(&mut self, numbers: &[u8]) -> Result<(), String> {
        let channels: Option<Vec<f64>> = words(numbers).map(|word| readable(word).parse().ok()).collect();
        let channels = channels.filter(|channels| channels.iter().all(|channel: &f64| channel.is_finite()));
        let Some([red, rest @ ..]) = channels.as_deref() else {
            return Err(format!("'Kd {}' is no color that is known here", short(numbers)));
        };
        let green = rest.first().unwrap_or(red);
        let blue = rest.get(1).unwrap_or(red);
        self.plain += &format!("Kd {red:e} {green:e} {blue:e}\n");
        Ok(())
    }

    /// `map_Kd options name`.
    fn map(&mut self, line: u32, rest: &[u8]) -> Result<(), String> {
        let (options, name) = options_and_name(rest);
        let changes: Vec<String> =
            options.into_iter().filter(|option| !option.is_neutral()).map(|o| o.show()).collect();
        if !changes.is_empty() {
            let options = short(changes.join(", ").as_bytes());
            self.warn(line, &format!("options of map_Kd that are not drawn: {options}"));
        }
        if name.is_empty() || name.starts_with(b"#") {
            return Err("map_Kd without the name of a file".to_owned());
        }
        self.plain += &format!("map_Kd {}\n", self.maps.len());
        self.maps.push(name.to_vec());
        Ok(())
    }

    /// What is not drawn, unless it says that there is nothing to draw.
    fn other(&mut self, word: &[u8], values: &[u8]) {
        let are_all = |value: f64| {
            let mut numbers = words(values).map(|word| readable(word).parse());
            words(values).next().is_some() && numbers.all(|number| number == Ok(value))
        };
        let is_neutral = match word {
            b"d" => are_all(1.0),
            b"Tr" | b"Ke" | b"Ks" | b"Ka" => are_all(0.0),
            _ => false,
        };
        let word = word[..word.len().min(40)].to_vec();
        if let Some(material) = self.materials.last_mut()
            && !is_neutral
            && material.not_drawn.len() < 40
            && !material.not_drawn.contains(&word)
        {
            material.not_drawn.push(word);
        }
    }

    /// What the parser reads in the plain text.
    fn finish(mut self) -> (Vec<Material>, Warnings) {
        match tobj::load_mtl_buf(&mut self.plain.as_bytes()) {
            Ok((parsed, _)) => {
                for (material, parsed) in self.materials.iter_mut().zip(parsed) {
                    material.color = parsed.diffuse;
                    let map = parsed.diffuse_texture.and_then(|number| number.parse::<usize>().ok());
                    material.map = map.and_then(|number| self.maps.get(number).cloned());
                }
            }
            Err(error) => self.warnings.push(format!("its materials cannot be used: {error}")),
        }
        let orphans = self.orphans.warning(
            "a statement before the first newmtl is left out",
            "statements before the first newmtl are left out",
        );
        self.warnings.extend(orphans);
        (self.materials, self.warnings)
    }
}

/// An option of a map, and its values.
struct MapOption<'a> {
    word: &'a [u8],
    values: Vec<&'a [u8]>,
}

impl MapOption<'_> {
    /// Whether the picture is the same without it.
    fn is_neutral(&self) -> bool {
        let are_all = |value: f64| self.values.iter().all(|word| readable(word).parse() == Ok(value));
        match self.word {
            b"-s" => are_all(1.0),
            b"-o" | b"-t" | b"-boost" => are_all(0.0),
            b"-mm" => {
                let numbers: Vec<_> = self.values.iter().map(|word| readable(word).parse()).collect();
                numbers == [Ok(0.0), Ok(1.0)]
            }
            b"-clamp" | b"-cc" => self.values == [b"off"],
            // How the picture is filtered, and what concerns other maps than those of colors.
            b"-blendu" | b"-blendv" | b"-texres" | b"-bm" | b"-imfchan" | b"-type" => true,
            _ => false,
        }
    }

    fn show(&self) -> String {
        std::iter::once(&self.word)
            .chain(&self.values)
            .map(|word| readable(word))
            .collect::<Vec<_>>()
            .join(" ")
    }
}

/// The options of a map, and the name that stands after them; it may have blanks.
fn options_and_name(mut rest: &[u8]) -> (Vec<MapOption<'_>>, &[u8]) {
    let mut options = Vec::new();
    loop {
        let (word, mut after) = keyword(rest);
        let (most, are_numbers) = match word {
            b"-o" | b"-s" | b"-t" => (3, true),
            b"-mm" => (2, true),
            b"-bm" | b"-boost" | b"-texres" => (1, true),
            b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan" | b"-type" => (1, false),
            _ => return (options, rest),
        };
        let mut values = Vec::new();
        while values.len() < most {
            let (value, next) = keyword(after);
            // Of numbers some may be missing; the name comes last in any case.
            let is_number = || !next.is_empty() && readable(value).parse::<f64>().is_ok();
            if value.is_empty() || are_numbers && !is_number() {
                break;
            }
            values.push(value);
            after = next;
        }
        options.push(MapOption { word, values });
        rest = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::scratch::Folder;

    fn library(text: &str) -> (Vec<Material>, Warnings) {
        let mut plain = PlainLibrary::new(0);
        Statements::new(text.as_bytes()).for_each(|(line, statement)| plain.take(line, &statement));
        plain.finish()
    }

    /// An image file of two pixels.
    fn picture() -> Vec<u8> {
        let image = image::RgbImage::from_raw(2, 1, vec![10, 20, 30, 200, 100, 50]).expect("two pixels");
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).expect("written");
        bytes.into_inner()
    }

    #[test]
    fn a_color_tints_its_picture() {
        let text = b"newmtl color\nKd 1 .5 0\nnewmtl picture\nmap_Kd a.png\n\
            newmtl both\nKd 0.5 1 0\nmap_Kd a.png\nnewmtl dark\nKd 0.5\nmap_Kd a.png\n";
        let folder = Folder::new("tint", &[("a.png", &picture()), ("a.mtl", text)]);
        let mut warnings = Warnings::new();
        let mut materials =
            Materials::load(&folder.0.join("a.obj"), &[(1, b"a.mtl".to_vec())], &mut warnings);
        let names = [b"color".as_slice(), b"picture", b"both", b"dark", b"neither"].map(<[u8]>::to_vec);
        let textures = materials.textures(&names, &mut warnings);
        let texels = |texture: &Texture| {
            (0..texture.width() as usize).map(|column| texture.texel(column, 0)).collect::<Vec<_>>()
        };
        assert_eq!(
            textures.iter().map(|texture| texture.as_ref().map(texels)).collect::<Vec<_>>(),
            [
                Some(vec![[255.0, 128.0, 0.0]]),
                Some(vec![[10.0, 20.0, 30.0], [200.0, 100.0, 50.0]]),
                Some(vec![[5.0, 20.0, 0.0], [100.0, 100.0, 0.0]]),
                Some(vec![[5.0, 10.0, 15.0], [100.0, 50.0, 25.0]]),
                None
            ]
        );
        assert!(warnings.len() == 1 && warnings[0].contains("'neither' is in no library"), "{warnings:?}");
        assert_eq!(materials.pictures.texels, 2 + 2 + 2, "decoded once, and two copies");
    }

    #[test]
    fn textures_have_a_largest_size_together() {
        let folder = Folder::new("texels", &[("a.png", &picture())]);
        let path = folder.0.join("a.png");
        let left = |texels| Pictures { texels: MAX_TEXELS - texels, ..Pictures::default() };
        let two = left(2).load(&path, &mut Warnings::new()).expect("as many as are left");
        let refused = left(1).load(&path, &mut Warnings::new()).expect_err("too many").to_string();
        assert!(refused.contains("of which 1 are left"), "{refused}");
        assert!(left(2).tinted(&two, [0.5; 3]).is_ok());
        let refused = left(1).tinted(&two, [0.5; 3]).expect_err("too many");
        assert_eq!(refused, format!("all textures of a model may have {MAX_TEXELS} pixels"));
        assert_eq!(texels(&Texture::new(2, 3, vec![Color::BLACK; 6])), 6);
    }

    #[test]
    fn libraries_have_a_largest_size_together() {
        let texts = [b"newmtl a\n".as_slice(), b"newmtl b\n"];
        let folder = Folder::new("libraries", &[("a.mtl", texts[0]), ("b.mtl", texts[1])]);
        let (model, of_both) = (folder.0.join("a.obj"), texts.concat().len() as u64);
        let within = |left, names: &[u8]| {
            let mut warnings = Warnings::new();
            let materials = Materials::load_within(&model, &[(1, names.to_vec())], left, &mut warnings);
            (materials.list.len(), warnings.len())
        };
        assert_eq!(within(of_both, b"a.mtl b.mtl"), (2, 0));
        assert_eq!(within(of_both - 1, b"a.mtl b.mtl"), (1, 1), "the second is left out");
        let by_another_name = format!("../{}/a.mtl", folder.0.file_name().expect("one").display());
        for again in ["a.mtl", "b.mtl a.mtl", &by_another_name] {
            let names = format!("a.mtl b.mtl {again}");
            assert_eq!(within(of_both, names.as_bytes()), (2, 0), "each is read once: {names}");
        }
    }

    #[test]
    fn where_files_are_looked_for() {
        let files: [(&str, &[u8]); 4] =
            [("lib/a.png", b""), ("obj/a.png", b""), ("obj/sub/b.png", b""), ("lib/my a.mtl", b"")];
        let folder = Folder::new("places", &files);
        let [library, model] = ["lib", "obj"].map(|name| folder.0.join(name));
        let found = |name: &[u8]| find_picture([&library, &model], name);
        assert_eq!(found(b"a.png"), library.join("a.png"), "beside the library first");
        assert_eq!(found(b"sub\\b.png # stone"), model.join("sub/b.png"));
        assert_eq!(found(b"\"C:\\my textures/a.png\""), library.join("a.png"), "of another machine");
        assert_eq!(found(b"sub/c.png"), library.join("sub/c.png"), "nowhere");
        assert_eq!(library_names(&library, b"my a.mtl"), [library.join("my a.mtl")]);
    }

    #[test]
    fn what_is_not_drawn_is_said_once() {
        let text = "newmtl a\nd 1\nTr 0\nKe 0 0 0\nKs 0\nd 0.5\nKs 0 0 1\nTr\nillum 2\nillum 3\n";
        assert_eq!(library(text).0[0].not_drawn, [b"d".as_slice(), b"Ks", b"Tr", b"illum"]);
        let nothing = library("newmtl a\nd 1\nTr 0\nKe 0 0 0\nKs 0 0 0\nKa 0\n");
        assert!(nothing.0[0].not_drawn.is_empty(), "opaque, and without light of its own or highlights");
        let words = |count: u32| (0..count).map(|i| format!("w{i} 1\n")).collect::<String>();
        let material = |text: String| library(&format!("newmtl a\n{text}")).0.remove(0);
        assert_eq!(material(words(50)).not_drawn.len(), 40);
        let told = |text: String| {
            let (list, by_name) = (vec![material(text)], HashMap::new());
            let (model, libraries) = ("a.obj".into(), vec!["a.mtl".into()]);
            let materials = Materials { model, libraries, list, by_name, pictures: Pictures::default() };
            let mut warnings = Warnings::new();
            materials.warn_of_what_is_not_drawn([0, 0].iter(), &mut warnings);
            warnings
        };
        assert_eq!(told(words(2)), ["a.mtl: only Kd and map_Kd are drawn; left out: w0, w1"]);
        assert!(told(words(13))[0].ends_with(" w10, w11"), "twelve at most");
        assert!(told(words(0)).is_empty());
    }

    #[test]
    fn colors_with_fewer_numbers() {
        let color = |text: &str| library(&format!("newmtl a\n{text}\n")).0[0].color;
        assert_eq!(color("Kd 0.5"), Some([0.5; 3]));
        assert_eq!(color("Kd 0.5 1"), Some([0.5, 1.0, 0.5]));
        assert_eq!(color("\tkd\t1 .25 0 # red"), Some([1.0, 0.25, 0.0]));
        assert_eq!(color("Ka 1\nKs 1 1\nKe"), None);
    }

    #[test]
    fn a_bad_line_costs_that_line() {
        for bad in
            ["Kd", "Kd red", "Kd nan 0 0", "Kd spectral a.rfl", "map_Kd", "map_Kd -clamp off", "map_Kd # x"]
        {
            let (materials, warnings) = library(&format!("newmtl a\nKd 1 0 0\n{bad}\nnewmtl b\nKd 0 1 0\n"));
            assert_eq!(materials[0].color, Some([1.0, 0.0, 0.0]), "{bad}");
            assert_eq!(materials[1].color, Some([0.0, 1.0, 0.0]), "{bad}");
            assert!(warnings.len() == 1 && warnings[0].starts_with("line 3: "), "{bad}: {warnings:?}");
        }
        let (_, warnings) = library("Kd 1 1 1\nnewmtl\nd 1\nTr 0\nillum\n");
        assert_eq!(warnings.len(), 2, "{warnings:?}");
    }

    #[test]
    fn a_library_has_a_largest_size() {
        let (materials, warnings) = library(&"newmtl a\nKd\n".repeat(MAX_MATERIALS + 2));
        assert_eq!((materials.len(), warnings.len()), (MAX_MATERIALS, 2 * MAX_WARNINGS));
        let (materials, warnings) = library(&"newmtl a\n".repeat(MAX_MATERIALS + 2));
        assert_eq!((materials.len(), warnings.len()), (MAX_MATERIALS, 1));
    }

    #[test]
    fn a_model_has_so_many_libraries_and_each_has_a_name() {
        let statements: Vec<(u32, Vec<u8>)> =
            (1..=300).map(|line| (line, format!("nowhere{line}.mtl").into_bytes())).collect();
        let mut warnings = Warnings::default();
        Materials::load(Path::new("a.obj"), &statements, &mut warnings);
        assert_eq!(warnings.len(), MAX_LIBRARIES + 1, "each that is missing, and that there are more");
        assert_eq!(warnings.last().expect("some"), "a.obj: line 257: more libraries than are read");
        let mut warnings = Warnings::default();
        Materials::load(Path::new("a.obj"), &[(7, vec![])], &mut warnings);
        assert_eq!(warnings[0], "a.obj: line 7: mtllib without a name");
    }

    #[test]
    fn options_before_a_name() {
        for (text, name, neutral) in [
            ("a b.png", "a b.png", true),
            ("-s 1 1 1 -o 0 0 0 a b.png", "a b.png", true),
            ("-s 2 2 a.png", "a.png", false),
            ("-clamp on a.png", "a.png", false),
            ("-bm 0.5 -mm 0 1 2.png", "2.png", true),
            ("-mm 0 2 2.png", "2.png", false),
            ("-unknown.png", "-unknown.png", true),
            ("-s 1", "1", true),
            ("-clamp", "", false),
            ("-o 0 1 a.png", "a.png", false),
            ("-boost 0 -t 0 -cc off -blendu off -texres 512 -imfchan r a.png", "a.png", true),
        ] {
            let (options, found) = options_and_name(text.as_bytes());
            assert_eq!(readable(found), name, "{text}");
            assert_eq!(options.iter().all(MapOption::is_neutral), neutral, "{text}");
        }
        let (_, warnings) = library("newmtl a\nmap_Kd -s 1 1 -o 0 1 -clamp on a.png\n");
        assert_eq!(warnings, ["line 2: options of map_Kd that are not drawn: -o 0 1, -clamp on"]);
    }

    #[test]
    fn names_of_libraries() {
        let names = |text: &[u8]| library_names("there".as_ref(), text);
        let paths =
            |names: &[&str]| names.iter().map(|name| Path::new("there").join(name)).collect::<Vec<_>>();
        assert_eq!(names(b"a.mtl"), paths(&["a.mtl"]));
        assert_eq!(names(b"a.mtl my b.MTL  # both"), paths(&["a.mtl", "my b.MTL"]));
        assert_eq!(names(b"my stone.mtl wood.mtl"), paths(&["my stone.mtl", "wood.mtl"]));
        assert_eq!(names(b"a b"), paths(&["a", "b"]));
        assert_eq!(names(b"sub\\\"a.mtl\""), paths(&["sub/\"a.mtl\""]));
        assert_ne!(names(b"\xe9.mtl"), names(b"\xe8.mtl"));
        assert_eq!(names(b""), paths(&[]));
    }
}
