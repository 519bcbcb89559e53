//! OBJ text from the wild, made plain: what the parser reads is what the file means.
//!
//! The parser knows `v`, `vt`, `vn` and `f` in their simplest form. This room reads each statement once, leaves out what
//! is not drawn, gives the rest on, one statement at a time, and keeps the number of its line for errors. Which objects,
//! materials and libraries there are it keeps itself: in the plain text an object is a number.
//!
//! ```text
//!   usemtl red            ┐                     o 0
//!   v 0 0 0 0.5 0.5 0.5   │                     v 0 0 0
//!   v 1 0 0 # right       ├─ PlainText ──►      v 1 0 0      and: object 0 is of material 'red';
//!   f 1 2 \               │                     f 1 2 3           one vertex has a color that is not drawn
//!     3                   ┘
//! ```

use std::collections::HashMap;
use std::io::{BufRead, Error, Read, Result as IoResult};

use super::statements::{Statements, keyword, readable, short, without_comment, words};
use crate::files::Warnings;

/// How large a model may be: so many vertices, texture coordinates, normals and corners of faces together. An object, the
/// name of a material and the name of a library need more memory, and count as [`LARGE`] of them.
pub(super) const MAX_ELEMENTS: u32 = 1 << 23;
const LARGE: u32 = 32;

/// The most bytes of names after one `mtllib`.
const MAX_NAMES: usize = 1 << 16;

/// What the corners of a face have beside a position. A face of which one corner lacks something has it in none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Given {
    pub(super) uvs: bool,
    pub(super) normals: bool,
}

/// Faces that follow one another and are alike: the parser makes one mesh of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Object {
    /// How many `o` and `g` stand before it.
    pub(super) number: u32,
    /// Its material's place in [`Found::materials`].
    pub(super) material: Option<usize>,
    pub(super) given: Given,
}

/// How often something stands in a file, and in which line first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Count {
    count: u32,
    first: u32,
}

impl Count {
    pub(super) fn add(&mut self, line: u32) {
        if self.count == 0 {
            self.first = line;
        }
        self.count += 1;
    }

    /// The warning, if there is one: the first line, and `one`, or how many `many`.
    pub(super) fn warning(self, one: &str, many: &str) -> Option<String> {
        match self.count {
            0 => None,
            1 => Some(format!("line {}: {one}", self.first)),
            count => Some(format!("line {} and others: {count} {many}", self.first)),
        }
    }
}

/// What a file has beside the plain text.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// In the order in which the parser makes them.
    pub(super) objects: Vec<Object>,
    /// The names of materials that are used, each once.
    pub(super) materials: Vec<Vec<u8>>,
    /// What stands after each `mtllib`, and in which line.
    pub(super) libraries: Vec<(u32, Vec<u8>)>,
    /// The lines of the faces with more than three corners, in their order.
    pub(super) polygon_lines: Vec<u32>,
    lines_and_points: Count,
    free_form: Count,
    short_faces: Count,
    colors: Count,
    weights: Count,
    nameless: Count,
    unknown: Count,
    first_unknown: Vec<u8>,
}

impl Found {
    /// What is left out.
    pub(super) fn warnings(&self) -> Warnings {
        let unknown = readable(&self.first_unknown);
        let all = [
            self.lines_and_points.warning("a line or point is left out", "lines and points are left out"),
            self.free_form.warning(
                "a free-form curve or surface is left out",
                "free-form curves and surfaces are left out",
            ),
            self.short_faces.warning(
                "a face with fewer than three corners is left out",
                "faces with fewer than three corners are left out",
            ),
            self.colors
                .warning("the color of a vertex is not drawn", "vertices have a color, which is not drawn"),
            self.weights.warning(
                "the fourth number of a vertex, its weight in curves, is not used",
                "vertices have a fourth number, their weight in curves, which is not used",
            ),
            self.nameless.warning("usemtl without a name: gray", "usemtl without a name: gray"),
            self.unknown.warning(
                &format!("'{unknown}' is not known here, and left out"),
                &format!("statements are not known here, and left out; the first is '{unknown}'"),
            ),
        ];
        all.into_iter().flatten().collect()
    }
}

/// The three lists that faces point into.
#[derive(Clone, Copy)]
enum List {
    Positions,
    Uvs,
    Normals,
}

impl List {
    const ALL: [Self; 3] = [Self::Positions, Self::Uvs, Self::Normals];
    const NAMES: [[&'static str; 2]; 3] =
        [["vertex", "vertices"], ["texture coordinate", "texture coordinates"], ["normal", "normals"]];
}

/// An index whose element is still to come, and the line of its face.
#[derive(Clone, Copy, Debug, Default)]
struct Ahead {
    index: i64,
    line: u32,
}

/// An OBJ file as a reader of plain text. `progress` receives how many bytes of how many have been read; it is no type
/// parameter, so that this room and the parser are compiled once.
pub(super) struct PlainText<'a> {
    statements: Statements<'a>,
    total: usize,
    progress: &'a mut dyn FnMut(u64, u64),
    /// How many bytes were reported to `progress`.
    reported: usize,
    /// The plain text of one statement, and how much of it has been read.
    plain: Vec<u8>,
    read: usize,
    line: u32,
    fault: Option<String>,
    counts: [i64; 3],
    /// How many of [`MAX_ELEMENTS`] are left.
    left: u32,
    /// The highest index of each list that stands before its element. An element may follow its face, as long as the
    /// object lasts.
    ahead: [Ahead; 3],
    object: u32,
    material: Option<usize>,
    known_materials: HashMap<Vec<u8>, usize>,
    found: Found,
}

impl<'a> PlainText<'a> {
    pub(super) fn new(text: &'a [u8], progress: &'a mut dyn FnMut(u64, u64)) -> Self {
        Self {
            statements: Statements::new(text),
            total: text.len(),
            progress,
            reported: 0,
            plain: Vec::new(),
            read: 0,
            line: 0,
            fault: None,
            counts: [0; 3],
            left: MAX_ELEMENTS,
            ahead: [Ahead::default(); 3],
            object: 0,
            material: None,
            known_materials: HashMap::new(),
            found: Found::default(),
        }
    }

    /// What was found; or, if the parser gave up, in which line and why.
    pub(super) fn finish<T>(self, parsed: Result<T, tobj::LoadError>) -> Result<(T, Found), String> {
        match (self.fault, parsed) {
            (Some(fault), _) => Err(format!("line {}: {fault}", self.line)),
            (None, Ok(parsed)) => Ok((parsed, self.found)),
            (None, Err(error)) => Err(format!("line {}: {error}", self.line)),
        }
    }

    /// Makes the next plain text, if there is one.
    fn advance(&mut self) -> Result<(), String> {
        self.plain.clear();
        self.read = 0;
        while self.plain.is_empty() {
            let Some((line, statement)) = self.statements.next() else {
                return self.check_ahead(self.ahead);
            };
            self.line = line;
            self.take(&statement)?;
        }
        let done = self.total - self.statements.bytes_left();
        if done - self.reported >= 1 << 16 || done == self.total {
            self.reported = done;
            (self.progress)(done as u64, self.total as u64);
        }
        Ok(())
    }

    fn take(&mut self, statement: &[u8]) -> Result<(), String> {
        let (word, rest) = keyword(statement);
        match word {
            b"v" => self.position(without_comment(rest)),
            b"vt" => self.element(List::Uvs, b"vt", without_comment(rest)),
            b"vn" => self.element(List::Normals, b"vn", without_comment(rest)),
            b"f" | b"fo" => self.face(without_comment(rest)),
            b"usemtl" => self.use_material(rest),
            b"mtllib" if rest.len() > MAX_NAMES => Err("the names after mtllib are too long".to_owned()),
            b"mtllib" => {
                self.found.libraries.push((self.line, rest.to_vec()));
                self.spend(LARGE)
            }
            _ => {
                self.take_rare(word);
                Ok(())
            }
        }
    }

    /// Takes elements from those that are left.
    fn spend(&mut self, elements: u32) -> Result<(), String> {
        let left = self.left.checked_sub(elements);
        self.left =
            left.ok_or_else(|| format!("the model is too large: more than {MAX_ELEMENTS} elements"))?;
        Ok(())
    }

    /// What is neither drawn nor a name.
    fn take_rare(&mut self, word: &[u8]) {
        match word {
            b"o" | b"g" => self.object = self.object.saturating_add(1),
            b"l" | b"p" => self.found.lines_and_points.add(self.line),
            b"curv" | b"curv2" | b"surf" => self.found.free_form.add(self.line),
            // What belongs to free-form elements, and what says how something is to be shown.
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"parm" | b"trim" | b"hole" | b"scrv"
            | b"sp" | b"end" | b"con" | b"ctech" | b"stech" | b"s" | b"mg" | b"lod" | b"bevel"
            | b"c_interp" | b"d_interp" | b"shadow_obj" | b"trace_obj" | b"usemap" | b"maplib" => {}
            _ => {
                if self.found.first_unknown.is_empty() {
                    self.found.first_unknown = word[..word.len().min(40)].to_vec();
                }
                self.found.unknown.add(self.line);
            }
        }
    }

    fn use_material(&mut self, name: &[u8]) -> Result<(), String> {
        self.material = self.known_materials.get(name).copied();
        if name.is_empty() {
            self.found.nameless.add(self.line);
        } else if self.material.is_none() {
            let next = self.found.materials.len();
            self.found.materials.push(name.to_vec());
            self.known_materials.insert(name.to_vec(), next);
            self.material = Some(next);
            self.spend(LARGE)?;
        }
        Ok(())
    }

    /// `v x y z`, then perhaps a weight, or a color, or more.
    fn position(&mut self, numbers: &[u8]) -> Result<(), String> {
        self.element(List::Positions, b"v", numbers)?;
        let mut more = words(numbers).skip(3);
        match (more.next(), more.next()) {
            (None, _) => {}
            (Some(weight), None) => {
                check_number(weight)?;
                if readable(weight).parse() != Ok(1.0) {
                    self.found.weights.add(self.line);
                }
            }
            (Some(red), Some(green)) => {
                [red, green].into_iter().chain(more).try_for_each(check_number)?;
                self.found.colors.add(self.line);
            }
        }
        Ok(())
    }

    /// An element of a list: its first numbers, as many as it has coordinates. A texture coordinate may have one alone.
    fn element(&mut self, list: List, word: &[u8], numbers: &[u8]) -> Result<(), String> {
        self.plain.extend_from_slice(word);
        let wanted = if let List::Uvs = list { 2 } else { 3 };
        let mut count = 0;
        for number in words(numbers).take(wanted) {
            check_number(number)?;
            self.plain.push(b' ');
            self.plain.extend_from_slice(number);
            count += 1;
        }
        if let (List::Uvs, 1) = (list, count) {
            self.plain.extend_from_slice(b" 0");
        } else if count < wanted {
            let word = readable(word);
            return Err(format!("'{word}' has {count} numbers, and needs {wanted}"));
        }
        self.plain.push(b'\n');
        self.counts[list as usize] += 1;
        self.spend(1)
    }

    fn face(&mut self, corners: &[u8]) -> Result<(), String> {
        let mut common = Given { uvs: true, normals: true };
        let mut any = Given { uvs: false, normals: false };
        let mut count = 0_u32;
        // No file that is read has more corners than this can count.
        let earlier = std::mem::take(&mut self.ahead);
        for corner in words(corners) {
            let given = self.check_corner(corner)?;
            common = Given { uvs: common.uvs && given.uvs, normals: common.normals && given.normals };
            any = Given { uvs: any.uvs || given.uvs, normals: any.normals || given.normals };
            count += 1;
        }
        if count < 3 {
            // What it names need not come; what faces before it named must.
            self.ahead = earlier;
            self.found.short_faces.add(self.line);
            return Ok(());
        }
        self.spend(count)?;
        self.begin_object(common, earlier)?;
        self.plain.push(b'f');
        if any == common {
            self.plain.push(b' ');
            self.plain.extend_from_slice(corners);
        } else {
            for corner in words(corners) {
                self.plain.push(b' ');
                self.plain.extend_from_slice(&with_less(corner, common));
            }
        }
        self.plain.push(b'\n');
        if count > 3 {
            self.found.polygon_lines.push(self.line);
        }
        Ok(())
    }

    /// A new object, if this face is not like the one before; `earlier` is what those before named ahead.
    fn begin_object(&mut self, given: Given, earlier: [Ahead; 3]) -> Result<(), String> {
        let object = Object { number: self.object, material: self.material, given };
        if self.found.objects.last() == Some(&object) {
            let last = |list: usize| if self.ahead[list].index > earlier[list].index { self.ahead } else { earlier }[list];
            self.ahead = [last(0), last(1), last(2)];
            return Ok(());
        }
        // The parser resolves the faces of the object that ends here.
        self.check_ahead(earlier)?;
        self.plain.extend_from_slice(format!("o {}\n", self.found.objects.len()).as_bytes());
        self.found.objects.push(object);
        self.spend(LARGE)
    }

    /// Whether the elements that faces named before they were there have come.
    fn check_ahead(&mut self, ahead: [Ahead; 3]) -> Result<(), String> {
        for (list, Ahead { index, line }) in List::ALL.into_iter().zip(ahead) {
            if index > self.counts[list as usize] {
                self.line = line;
                return Err(self.out_of_bounds(list, index));
            }
        }
        Ok(())
    }

    fn out_of_bounds(&self, list: List, index: i64) -> String {
        let (count, [one, many]) = (self.counts[list as usize], List::NAMES[list as usize]);
        if index == 0 {
            return format!("{one} 0 is out of bounds: counting begins at 1");
        }
        format!("{one} {index} is out of bounds: there are {count} {many} here")
    }

    /// Checks the indices of a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[inline]
    fn check_corner(&mut self, corner: &[u8]) -> Result<Given, String> {
        let mut has = [false; 3];
        let mut rest = corner;
        for list in List::ALL {
            let index;
            (index, rest) = index_of(rest).ok_or_else(|| format!("'{}' is no index", short(corner)))?;
            if let Some(index) = index {
                has[list as usize] = true;
                self.check_index(list, index)?;
            }
            match rest {
                [] => break,
                [_, after @ ..] => rest = after,
            }
        }
        match has {
            _ if !rest.is_empty() => Err(format!("'{}' has more than three indices", short(corner))),
            [true, uvs, normals] => Ok(Given { uvs, normals }),
            _ => Err(format!("'{}' names no vertex", short(corner))),
        }
    }

    #[inline]
    fn check_index(&mut self, list: List, index: i64) -> Result<(), String> {
        let count = self.counts[list as usize];
        if index == 0 || -index > count {
            return Err(self.out_of_bounds(list, index));
        }
        let ahead = &mut self.ahead[list as usize];
        if index > count && index > ahead.index {
            *ahead = Ahead { index, line: self.line };
        }
        Ok(())
    }
}

/// The whole number before a `/` or the end, if there is one, and what follows it; nothing if there is something else, or a
/// number that no file can have so many lines for.
#[inline]
fn index_of(text: &[u8]) -> Option<(Option<i64>, &[u8])> {
    let (is_negative, signed) = match text {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, text),
    };
    let mut value = 0;
    let mut length = 0;
    for &byte in signed {
        match byte {
            b'0'..=b'9' if length < 18 => value = value * 10 + i64::from(byte - b'0'),
            b'/' => break,
            _ => return None,
        }
        length += 1;
    }
    let is_sign_alone = length == 0 && signed.len() < text.len();
    let number = (length > 0).then_some(if is_negative { -value } else { value });
    (!is_sign_alone).then_some((number, &signed[length..]))
}

/// Whether this can be a finite number. Whether it is one, the parser sees.
#[inline]
fn check_number(word: &[u8]) -> Result<(), String> {
    let mut is_plain = word.len() < 100;
    for &byte in word {
        match byte {
            b'0'..=b'9' | b'.' | b'-' | b'+' => {}
            // An exponent may lead anywhere, and so may 'nan' and 'inf'.
            _ => is_plain = false,
        }
    }
    if is_plain {
        return Ok(());
    }
    let text = readable(&word[..word.len().min(400)]);
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(()),
        Ok(_) => Err(format!("{} is not a finite number", short(word))),
        Err(_) => Err(format!("'{}' is no number", short(word))),
    }
}

/// A corner with only those indices that all corners of its face have.
fn with_less(corner: &[u8], common: Given) -> Vec<u8> {
    let mut indices = corner.split(|&byte| byte == b'/');
    let mut next = || indices.next().unwrap_or_default();
    let [position, uv, normal] = [next(), next(), next()];
    let mut plain = position.to_vec();
    if common.uvs || common.normals {
        plain.push(b'/');
    }
    if common.uvs {
        plain.extend_from_slice(uv);
    }
    if common.normals {
        plain.push(b'/');
        plain.extend_from_slice(normal);
    }
    plain
}

impl Read for PlainText<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> IoResult<usize> {
        let available = self.fill_buf()?;
        let count = available.len().min(buffer.len());
        buffer[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}

/// One statement at a time, so that where the parser stops is where the fault is.
impl BufRead for PlainText<'_> {
    fn fill_buf(&mut self) -> IoResult<&[u8]> {
        if self.read == self.plain.len()
            && let Err(fault) = self.advance()
        {
            self.fault = Some(fault.clone());
            return Err(Error::other(fault));
        }
        Ok(&self.plain[self.read..])
    }

    fn consume(&mut self, count: usize) {
        self.read += count;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(text: &str) -> Result<(String, Found), String> {
        plain_within(text, MAX_ELEMENTS)
    }

    fn plain_within(text: &str, left: u32) -> Result<(String, Found), String> {
        let mut progress = |_, _| {};
        let mut reader = PlainText { left, ..PlainText::new(text.as_bytes(), &mut progress) };
        let mut plain = String::new();
        let read = reader.read_to_string(&mut plain).map_err(|_| tobj::LoadError::ReadError);
        reader.finish(read).map(|(_, found)| (plain, found))
    }

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    #[test]
    fn what_is_plain_stays() {
        let text = format!("{CORNERS}o 0\nf 1 2 3\n");
        assert_eq!(plain(&text).expect("plain").0, text);
        assert_eq!(
            plain("v -1e0 +.5 1.\nvt 0.5\nvt 1 2 3\n").expect("plain").0,
            "v -1e0 +.5 1.\nvt 0.5 0\nvt 1 2\n"
        );
    }

    #[test]
    fn what_a_face_gives() {
        let text =
            format!("{CORNERS}vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/1 2//1 3/1\nf 1//1 2/1/1 3//-1\n");
        let (text, found) = plain(&text).expect("three faces");
        let faces = "o 0\nf 1/1/1 2/1/1 3/1/1\no 1\nf 1 2 3\no 2\nf 1//1 2//1 3//-1\n";
        assert!(text.ends_with(faces), "{text}");
        let given: Vec<_> =
            found.objects.iter().map(|object| (object.given.uvs, object.given.normals)).collect();
        assert_eq!(given, [(true, true), (false, false), (false, true)]);
        for one_has_it in ["f 1/1 2 3", "f 1//1 2 3"] {
            let text = format!("{CORNERS}vt 0 0\nvn 0 0 1\n{one_has_it}\n");
            assert!(plain(&text).expect("a face").0.ends_with("f 1 2 3\n"), "{one_has_it}");
        }
    }

    #[test]
    fn faults_have_the_line_of_the_file() {
        let fault = |text: &str| plain(text).expect_err(text);
        let with = |statement: &str| {
            fault(&format!("\u{feff}# x\r\n{CORNERS}vt 0 0\nvn 0 0 1\n{statement}\n{CORNERS}"))
        };
        for (statement, cause) in [
            ("f 1 2 0", "vertex 0 is out of bounds"),
            ("f 1 2 -4", "vertex -4 is out of bounds"),
            ("f 1/1 2/1 3/-2", "texture coordinate -2 is out of bounds: there are 1"),
            ("f 1/0 2/1 3/1", "texture coordinate 0"),
            ("f 1//1 2//1 3//2", "normal 2 is out of bounds"),
            ("f 1/9223372036854775807 2/1 3/1", "is no index"),
            ("f 1/1/1/1 2 3", "more than three indices"),
            ("f /1 2 3", "names no vertex"),
            ("f 1,2,3 1 2", "is no index"),
            ("f 1 2 -", "'-' is no index"),
            ("f 1 2 123", "vertex 123 is out of bounds"),
            ("v 1 2", "'v' has 2 numbers, and needs 3"),
            ("vt", "'vt' has 0 numbers"),
            ("vn 0 0 inf", "inf is not a finite number"),
            ("v 1 2 1e999", "1e999 is not a finite number"),
            ("v 1,5 2 3", "'1,5' is no number"),
        ] {
            let fault = with(statement);
            assert!(fault.starts_with("line 7: ") && fault.contains(cause), "{statement}: {fault}");
        }
        let followed_by_a_short_one = fault(&format!("{CORNERS}f 1/1 2/1 3/1\nf 1\n"));
        assert!(followed_by_a_short_one.starts_with("line 4: texture coordinate 1 is out of bounds"));
        assert!(plain(&format!("{CORNERS}f 1 2 3\nf 9 9\n")).is_ok(), "a short face is left out");
        assert!(fault("f 1 2 4\nv 0 0 0\nv 0 0 0\nv 0 0 0\n").starts_with("line 1: vertex 4"));
        assert!(plain("f 1 2 3\nv 0 0 0\nv 0 0 0\nv 0 0 0\n").is_ok(), "vertices may follow their face");
        for (faces, first) in [
            ("f 1 2 5\nf 1 2 5\n", "line 1: vertex 5"),
            ("f 1 2 5\nf 1 2 6\n", "line 2: vertex 6"),
            ("f 1 2 6\nf 1 2 5\n", "line 1: vertex 6"),
            ("f 5 4 1\n", "line 1: vertex 5"),
        ] {
            let told = fault(&format!("{faces}{CORNERS}v 0 0 0\n"));
            assert!(told.starts_with(first), "{faces}: {told}");
        }
    }

    #[test]
    fn a_model_has_a_largest_size() {
        let left = |text: &str, needed: u32| {
            assert!(plain_within(text, needed).is_ok(), "{needed}");
            let fault = plain_within(text, needed - 1).expect_err("too large");
            assert!(fault.contains("more than 8388608 elements"), "{fault}");
        };
        left(&format!("{CORNERS}f 1 2 3 1 2 3\n"), 3 + LARGE + 6);
        left("vt 0\nvn 0 0 1\n", 2);
        left(&format!("{CORNERS}f 1 2 3\ng\nf 1 2 3\n"), 3 + 2 * (LARGE + 3));
        left("usemtl a\nusemtl b\nusemtl a\nmtllib c\n", 3 * LARGE);
        assert!(plain(&format!("mtllib {}", "a".repeat(MAX_NAMES))).is_ok());
        let names = format!("mtllib{}", " a".repeat(MAX_NAMES));
        assert!(plain(&names).expect_err("too long").starts_with("line 1: the names after mtllib"));
    }

    #[test]
    fn progress_is_told_at_every_64_kib_and_at_the_end() {
        let text = "v 0 0 0\n".repeat((1 << 14) + 1);
        let mut told = Vec::new();
        let mut progress = |done, total| told.push((done, total));
        PlainText::new(text.as_bytes(), &mut progress).read_to_string(&mut String::new()).expect("plain");
        let total = (1 << 17) + 8;
        assert_eq!(told, [1 << 16, 1 << 17, total].map(|done| (done, total)));
    }

    #[test]
    fn what_is_left_out_is_counted() {
        let text = format!(
            "{CORNERS}l 1 2 3\np 1\nsurf 0 1 0 1 1 2 3\nf 1 2\nv 0 0 0 1 1 1\nv 0 0 0 0.5\nv 0 0 0 1\nzzz\nusemtl\nf 1 2 3\n"
        );
        let warnings = plain(&text).expect("a triangle").1.warnings();
        assert_eq!(warnings.len(), 7, "{warnings:?}");
        assert_eq!(warnings[0], "line 4 and others: 2 lines and points are left out");
        assert!(warnings[4].starts_with("line 9: the fourth number"), "1 is the weight without curves");
        assert_eq!(warnings[6], "line 11: 'zzz' is not known here, and left out");
        let shown = plain(&format!("{CORNERS}s 1\nlod 2\nf +1 +2 +3\n")).expect("a triangle").1;
        assert_eq!(shown.warnings(), [""; 0], "how it is shown elsewhere");
    }
}
