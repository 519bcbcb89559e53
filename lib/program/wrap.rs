//! Help and lists, wrapped to the width of the terminal.

use console::Term;

/// Wider lines are hard to read; help has this width too where nobody looks.
pub(super) const WIDEST: usize = 100;
/// A second column narrower than this goes below the first one, so far from the left.
const NARROWEST: usize = 24;
const BELOW: usize = 8;

/// How wide lines may be; `None` if standard output is no terminal.
pub(super) fn terminal_width() -> Option<usize> {
    let (_, columns) = Term::stdout().size_checked()?;
    Some(usize::from(columns).min(WIDEST))
}

/// Wraps each line; of one that has two columns, two spaces or more between them, the second is wrapped.
pub(super) fn wrap_columns(text: &str, width: usize) -> String {
    let line = |line: &str| {
        let (first, second) = line.split_at(second_column(line));
        let indent = first.chars().count();
        if first.trim().is_empty() || indent + NARROWEST <= width {
            return format!("{first}{}\n", wrap(second, indent, width));
        }
        format!("{}\n{:BELOW$}{}\n", first.trim_end(), "", wrap(second, BELOW, width))
    };
    text.lines().map(line).collect()
}

/// Where the second column of a line begins, in bytes; where its text begins if it has only one.
fn second_column(line: &str) -> usize {
    let text_from = |start: usize| line.len() - line[start..].trim_start().len();
    let first = text_from(0);
    line[first..].find("  ").map_or(first, |gap| text_from(first + gap))
}

/// Breaks a text that begins at the column `indent` at its spaces; the lines that follow begin there too. A word wider than
/// that stays whole.
fn wrap(text: &str, indent: usize, width: usize) -> String {
    let mut wrapped = String::new();
    let mut column = indent;
    for word in text.split(' ') {
        let length = word.chars().count();
        if column > indent && column + 1 + length > width {
            wrapped += &format!("\n{:indent$}", "");
            column = indent;
        } else if column > indent {
            wrapped.push(' ');
            column += 1;
        }
        wrapped += word;
        column += length;
    }
    wrapped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_go_to_the_next_line() {
        assert_eq!(wrap("one two three", 0, 7), "one two\nthree");
        assert_eq!(wrap("one two three", 0, 6), "one\ntwo\nthree", "the space takes part");
        assert_eq!(wrap("one two three", 2, 7), "one\n  two\n  three", "the indent takes part");
        assert_eq!(wrap("longer than that", 3, 5), "longer\n   than\n   that");
        assert_eq!(wrap("ω ω ω", 0, 3), "ω ω\nω", "characters are counted, not bytes");
        assert_eq!(wrap("", 4, 3), "");
    }

    #[test]
    fn the_second_column_stays_a_column() {
        let list = "Variants:\n  flat  all in one color, from below\n\n  a longer name  x\n";
        assert_eq!(wrap_columns(list, 100), list, "what fits stays as it is");
        assert_eq!(
            wrap_columns(list, 32),
            "Variants:\n  flat  all in one color, from\n        below\n\n  a longer name\n        x\n",
        );
        assert_eq!(
            wrap_columns("  --out <PATH>         A file or a folder", 20),
            "  --out <PATH>\n        A file or a\n        folder\n"
        );
        assert_eq!(wrap_columns("  no second column", 12), "  no second\n  column\n");
    }
}
