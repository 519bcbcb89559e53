//! The lines of OBJ and MTL files, whatever wrote them: each statement once, with the number of its first line.
//!
//! A line ends with LF, CR LF or CR. A `\` at its end joins it with the next one, except in a comment. A byte order
//! mark before the first line is no part of it.

use std::borrow::Cow;

/// The statements of a file in their order, without those that are empty or comments.
pub(super) struct Statements<'a> {
    rest: &'a [u8],
    line: u32,
}

/// A statement, trimmed, and the line in which it begins, counted from 1.
pub(super) type Statement<'a> = (u32, Cow<'a, [u8]>);

impl<'a> Statements<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { rest: text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text), line: 0 }
    }

    /// How many bytes are still to be read.
    pub(super) fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    /// One line as it stands, without its end.
    #[inline]
    fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.line = self.line.saturating_add(1);
        let end = self.rest.iter().position(|&byte| byte == b'\n' || byte == b'\r');
        let Some(end) = end else { return Some(std::mem::take(&mut self.rest)) };
        let line = &self.rest[..end];
        let has_two = self.rest[end] == b'\r' && self.rest.get(end + 1) == Some(&b'\n');
        self.rest = &self.rest[end + 1 + usize::from(has_two)..];
        Some(line)
    }

    /// What a line that ends with `\` goes on with, until one does not.
    fn joined(&mut self, first: &[u8]) -> Vec<u8> {
        let mut statement = first.to_vec();
        while let Some(line) = self.next_line() {
            statement.push(b' ');
            match line.trim_ascii_end().strip_suffix(b"\\") {
                Some(more) => statement.extend_from_slice(more),
                None => {
                    statement.extend_from_slice(line);
                    break;
                }
            }
        }
        statement
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    #[inline]
    fn next(&mut self) -> Option<Statement<'a>> {
        loop {
            let line = self.next_line()?.trim_ascii();
            let number = self.line;
            match (line.first(), line.strip_suffix(b"\\")) {
                (None | Some(b'#'), _) => {}
                (_, None) => return Some((number, Cow::Borrowed(line))),
                (_, Some(begun)) => {
                    let joined = self.joined(begun).trim_ascii().to_vec();
                    if !joined.is_empty() {
                        return Some((number, Cow::Owned(joined)));
                    }
                }
            }
        }
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

/// The words of a statement.
#[inline]
pub(super) fn words(statement: &[u8]) -> impl Iterator<Item = &[u8]> {
    statement.split(|&byte| is_blank(byte)).filter(|word| !word.is_empty())
}

/// The first word of a statement, and what stands after it.
#[inline]
pub(super) fn keyword(statement: &[u8]) -> (&[u8], &[u8]) {
    let end = statement.iter().position(|&byte| is_blank(byte)).unwrap_or(statement.len());
    (&statement[..end], statement[end..].trim_ascii())
}

/// Numbers without the comment that may follow them.
#[inline]
pub(super) fn without_comment(data: &[u8]) -> &[u8] {
    data.iter().position(|&byte| byte == b'#').map_or(data, |end| data[..end].trim_ascii_end())
}

/// A name without the comment that may follow it: a `#` within a name is a part of it, one after a blank may be.
pub(super) fn name_without_comment(name: &[u8]) -> &[u8] {
    let comment = name.windows(2).position(|two| is_blank(two[0]) && two[1] == b'#');
    comment.map_or(name, |end| name[..end].trim_ascii_end())
}

/// A name as it can be shown: names that are not UTF-8 are read as Latin 1, so that no two become the same.
pub(super) fn readable(name: &[u8]) -> String {
    match std::str::from_utf8(name) {
        Ok(name) => name.to_owned(),
        Err(_) => name.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// What of a file's words a message shows: no more than their beginning, for they can have any length.
pub(super) fn short(words: &[u8]) -> String {
    const MOST: usize = 100;
    let text = readable(words);
    match text.char_indices().nth(MOST) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &[u8]) -> Vec<(u32, String)> {
        Statements::new(text).map(|(line, statement)| (line, readable(&statement))).collect()
    }

    #[test]
    fn every_end_of_a_line() {
        let expected = [(1, "a".to_owned()), (2, "b".to_owned()), (4, "c".to_owned())];
        for text in ["a\nb\n\nc", "a\rb\r\rc\r", "a\r\nb\r\n\r\nc\r\n", "\u{feff}a\n \tb \n#x\n  c"] {
            assert_eq!(all(text.as_bytes()), expected, "{text:?}");
        }
    }

    #[test]
    fn lines_that_go_on() {
        assert_eq!(all(b"f 1 2\\\n3 \\ \r\n4\nv"), [(1, "f 1 2 3  4".to_owned()), (4, "v".to_owned())]);
        assert_eq!(all(b"# C:\\\nv 1"), [(2, "v 1".to_owned())], "a comment does not go on");
        assert_eq!(all(b"\\\n\\\n\nv"), [(4, "v".to_owned())]);
        assert_eq!(all(b"a \\"), [(1, "a".to_owned())]);
    }

    #[test]
    fn names_and_comments() {
        assert_eq!(name_without_comment(b"red # the first"), b"red");
        assert_eq!(name_without_comment(b"red#1"), b"red#1");
        assert_eq!(without_comment(b"1 2 3# x"), b"1 2 3");
        assert_eq!(keyword(b"usemtl\t my stone"), (b"usemtl".as_slice(), b"my stone".as_slice()));
        assert_ne!(readable(b"caf\xe9"), readable(b"caf\xe8"));
        assert_eq!(short("é".repeat(100).as_bytes()), "é".repeat(100));
        assert_eq!(short("é".repeat(101).as_bytes()), format!("{}…", "é".repeat(100)));
    }
}
