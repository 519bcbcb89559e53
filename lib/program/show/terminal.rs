//! What a terminal can show: found out from the environment, since no answer need be awaited for that.
//!
//! A terminal could be asked as well, but one that does not know the question is silent or writes it on the screen. So
//! only terminals that are known by their variables get pictures, and the option can name the way for all others.

use crate::program::failure::Failure;

/// What `--show` was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::program) enum Asked {
    /// The best that the terminal is known to understand.
    Auto,
    /// Characters.
    Blocks,
    /// Kitty's graphics protocol.
    Kitty,
    /// The inline images of iTerm2.
    Iterm,
    /// Sixels.
    Sixel,
}

impl Asked {
    /// All of them.
    pub(in crate::program) const ALL: [Self; 5] =
        [Self::Auto, Self::Blocks, Self::Kitty, Self::Iterm, Self::Sixel];

    /// As it is called on the command line.
    pub(in crate::program) const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Blocks => "blocks",
            Self::Kitty => "kitty",
            Self::Iterm => "iterm",
            Self::Sixel => "sixel",
        }
    }
}

/// How a picture is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum How {
    /// In characters.
    Blocks(Colors),
    /// As a PNG, by kitty's graphics protocol.
    Kitty,
    /// As a PNG, as an inline image of iTerm2.
    Iterm,
    /// As sixels: columns of six pixels.
    Sixel,
}

/// The colors of characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colors {
    /// 24 bits.
    All,
    /// 256: a cube of 6 × 6 × 6, and grays.
    Cube,
    /// None: characters of different density.
    None,
}

/// What standard output is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Output {
    /// A file or a pipe.
    File,
    /// A terminal, which the environment describes.
    Terminal,
    /// A console of Windows that understands escape sequences; they all have 24-bit color.
    Console,
}

/// How pictures are shown, and what to say of it.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Choice {
    pub(super) how: How,
    pub(super) note: Option<String>,
}

impl From<How> for Choice {
    fn from(how: How) -> Self {
        Self { how, note: None }
    }
}

const ALL_COLORS: How = How::Blocks(Colors::All);

/// Terminals with 24-bit color: a variable, how its value begins, and how it takes pictures. The first that fits counts:
/// `TERM` before the others, which programs hand on that start another terminal.
const KNOWN: [(&str, &str, How); 16] = [
    ("TERM", "xterm-kitty", How::Kitty),
    ("TERM", "xterm-ghostty", How::Kitty),
    ("TERM", "wezterm", How::Iterm),
    ("TERM", "foot", How::Sixel),
    ("TERM", "mlterm", How::Sixel),
    ("TERM", "contour", How::Sixel),
    ("TERM", "alacritty", ALL_COLORS),
    ("TERM_PROGRAM", "iTerm", How::Iterm),
    ("TERM_PROGRAM", "WezTerm", How::Iterm),
    ("TERM_PROGRAM", "ghostty", How::Kitty),
    ("TERM_PROGRAM", "mintty", How::Iterm),
    ("TERM_PROGRAM", "vscode", ALL_COLORS),
    ("LC_TERMINAL", "iTerm2", How::Iterm),
    ("KITTY_WINDOW_ID", "", How::Kitty),
    ("WT_SESSION", "", ALL_COLORS),
    ("KONSOLE_VERSION", "", ALL_COLORS),
];

/// How `TERM` begins where there are 16 colors or fewer, whatever else the environment says.
const POOR: [&str; 8] = ["dumb", "linux", "vt", "ansi", "cons25", "sun", "xterm-mono", "xterm-16color"];

/// How a picture is shown, if it can be.
pub(super) fn choose(
    asked: Asked,
    output: Output,
    lookup: impl Fn(&str) -> Option<String>,
) -> Result<Choice, Failure> {
    match asked {
        Asked::Auto | Asked::Kitty | Asked::Iterm | Asked::Sixel if output == Output::File => {
            Err(Failure::Usage(
                "standard output is not a terminal: --show=blocks prints the picture nevertheless, in \
                 characters with 24-bit color; --out FILE writes it into a file"
                    .to_owned(),
            ))
        }
        Asked::Kitty => Ok(How::Kitty.into()),
        Asked::Iterm => Ok(How::Iterm.into()),
        Asked::Sixel => Ok(How::Sixel.into()),
        Asked::Auto | Asked::Blocks => Ok(match found(output, &lookup) {
            // Only its colors count.
            Choice { how: How::Kitty | How::Iterm | How::Sixel, .. } if asked == Asked::Blocks => {
                ALL_COLORS.into()
            }
            choice => choice,
        }),
    }
}

/// What the environment says.
fn found(output: Output, lookup: &impl Fn(&str) -> Option<String>) -> Choice {
    let value = |name: &str| lookup(name).filter(|value| !value.is_empty());
    let shades = |reason: &str, remedy: &str| Choice {
        how: How::Blocks(Colors::None),
        note: Some(format!("note: shades in place of colors, since {reason}; {remedy}")),
    };
    if value("NO_COLOR").is_some() {
        return shades("NO_COLOR is set", "unset it for colors");
    }
    if output == Output::File {
        return ALL_COLORS.into();
    }
    let term = value("TERM").unwrap_or_default();
    let is_rich = matches!(value("COLORTERM").as_deref(), Some("truecolor" | "24bit"));
    let remedy = "COLORTERM=truecolor says that the terminal has colors, if it has";
    if POOR.iter().any(|name| term.starts_with(name)) {
        return shades(
            &format!("TERM={term} has few colors"),
            "another terminal shows them, or a file: --out FILE",
        );
    }
    // Inside another terminal, pictures get lost. Tmux takes all colors and shows those that there are.
    let is_tmux = value("TMUX").is_some() || term.starts_with("tmux");
    let is_screen = !is_tmux && (value("STY").is_some() || term.starts_with("screen"));
    if !is_tmux && !is_screen {
        let is_it = |name: &str, start: &str| value(name).is_some_and(|value| value.starts_with(start));
        if let Some(&(.., how)) = KNOWN.iter().find(|(name, start, _)| is_it(name, start)) {
            return how.into();
        }
    }
    if output == Output::Console || is_tmux || term.contains("direct") || (is_rich && !is_screen) {
        return ALL_COLORS.into();
    }
    if term.contains("256color") {
        return How::Blocks(Colors::Cube).into();
    }
    match term.as_str() {
        _ if is_rich => ALL_COLORS.into(),
        "" => shades("TERM is not set", remedy),
        term => shades(&format!("TERM={term} has few colors"), remedy),
    }
}

/// How many columns a file has.
pub(super) fn columns_of(lookup: impl Fn(&str) -> Option<String>) -> u32 {
    let given = lookup("COLUMNS").and_then(|columns| columns.trim().parse().ok());
    given.filter(|columns| (1..=1000).contains(columns)).unwrap_or(80)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lookup<'a>(variables: &'a [(&str, &str)]) -> impl Fn(&str) -> Option<String> + 'a {
        |name| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned())
    }

    #[test]
    fn terminals_and_what_they_show() {
        const CUBE: How = How::Blocks(Colors::Cube);
        const SHADES: How = How::Blocks(Colors::None);
        let rich = ("COLORTERM", "truecolor");
        for (variables, expected) in [
            (&[("TERM", "xterm-kitty")][..], How::Kitty),
            (&[("TERM", "xterm-256color"), ("KITTY_WINDOW_ID", "1"), rich], How::Kitty),
            (&[("TERM", "alacritty"), ("KITTY_WINDOW_ID", "1")], ALL_COLORS),
            (&[("TERM", "xterm-ghostty"), ("TERM_PROGRAM", "ghostty")], How::Kitty),
            (&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "ghostty")], How::Kitty),
            (&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "iTerm.app"), rich], How::Iterm),
            (&[("TERM", "xterm-256color"), ("LC_TERMINAL", "iTerm2")], How::Iterm),
            (&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "WezTerm")], How::Iterm),
            (&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "vscode")], ALL_COLORS),
            (&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "Apple_Terminal")], CUBE),
            (&[("TERM", "foot"), rich], How::Sixel),
            (&[("TERM", "mlterm-256color")], How::Sixel),
            (&[("TERM", "xterm-256color"), rich], ALL_COLORS),
            (&[("TERM", "xterm"), ("COLORTERM", "24bit")], ALL_COLORS),
            (&[("TERM", "xterm-direct")], ALL_COLORS),
            (&[("TERM", "xterm-256color")], CUBE),
            (&[("TERM", "xterm-256color"), ("COLORTERM", "yes"), ("NO_COLOR", "")], CUBE),
            (&[("TERM", "xterm-256color"), ("WT_SESSION", "x")], ALL_COLORS),
            // Inside another one.
            (&[("TERM", "tmux-256color"), ("TMUX", "x"), ("KITTY_WINDOW_ID", "1")], ALL_COLORS),
            (&[("TERM", "tmux-256color"), rich], ALL_COLORS),
            (&[("TERM", "screen"), ("TMUX", "x")], ALL_COLORS),
            (&[("TERM", "screen.xterm-256color"), ("STY", "x"), ("TERM_PROGRAM", "WezTerm"), rich], CUBE),
            (&[("TERM", "screen"), rich], ALL_COLORS),
            (&[("TERM", "screen"), ("STY", "x")], SHADES),
            // Few colors.
            (&[], SHADES),
            (&[("TERM", "")], SHADES),
            (&[("TERM", "xterm")], SHADES),
            (&[("TERM", "linux"), rich], SHADES),
            (&[("TERM", "dumb"), ("KITTY_WINDOW_ID", "1")], SHADES),
            (&[("TERM", "vt100")], SHADES),
            (&[("TERM", "xterm-kitty"), ("NO_COLOR", "1")], SHADES),
        ] {
            let found = choose(Asked::Auto, Output::Terminal, lookup(variables)).expect("a terminal");
            assert_eq!(found.how, expected, "{variables:?}");
            assert_eq!(found.note.is_some(), expected == SHADES, "{variables:?}");
        }
    }

    #[test]
    fn what_was_asked_for() {
        let kitty = [("TERM", "xterm-kitty")];
        let how = |asked| choose(asked, Output::Terminal, lookup(&kitty)).expect("a terminal").how;
        assert_eq!(Asked::ALL.map(how), [How::Kitty, ALL_COLORS, How::Kitty, How::Iterm, How::Sixel]);
        let console = choose(Asked::Auto, Output::Console, lookup(&[])).map(|choice| choice.how);
        assert_eq!(console, Ok(ALL_COLORS), "Windows has no TERM");
        let note = |variables| {
            let choice = choose(Asked::Blocks, Output::Terminal, lookup(variables)).expect("a terminal");
            choice.note.unwrap_or_default()
        };
        assert_eq!(
            note(&[("NO_COLOR", "1")]),
            "note: shades in place of colors, since NO_COLOR is set; unset it for colors"
        );
        assert!(note(&[("TERM", "xterm")]).contains("TERM=xterm has few colors; COLORTERM=truecolor says"));
        assert!(note(&[]).contains("TERM is not set"));
    }

    #[test]
    fn a_file_gets_blocks_only_if_it_is_asked_for() {
        let nothing = lookup(&[("TERM", "dumb")]);
        assert_eq!(choose(Asked::Blocks, Output::File, &nothing), Ok(ALL_COLORS.into()));
        let without = choose(Asked::Blocks, Output::File, lookup(&[("NO_COLOR", "1")])).expect("a file");
        assert_eq!(without.how, How::Blocks(Colors::None));
        for asked in Asked::ALL.into_iter().filter(|&asked| asked != Asked::Blocks) {
            assert!(matches!(choose(asked, Output::File, &nothing), Err(Failure::Usage(_))), "{asked:?}");
        }
        for (columns, expected) in [("100", 100), ("0", 80), ("-3", 80), ("x", 80), ("99999999999", 80)] {
            assert_eq!(columns_of(lookup(&[("COLUMNS", columns)])), expected);
        }
        assert_eq!(columns_of(lookup(&[])), 80);
    }
}
