//! A history as data, as text for people, and as JSON for programs.

use std::fmt::{self, Write as _};

use crate::color::Color;
use crate::rect::Pixel;

/// Something that is reported: one source for both forms.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    Whole(i64),
    Yes(bool),
    Text(String),
    Color(Color),
    Numbers(Vec<f64>),
    /// Rows of numbers with a name each; a hole where a row has no number.
    Table {
        columns: Vec<String>,
        rows: Vec<(String, Vec<Option<f64>>)>,
    },
    /// For programs alone: for people it stands in a table.
    Group(Vec<Field>),
    Groups(Vec<Vec<Field>>),
    List(Vec<String>),
}

/// A value with its name for programs (`key`) and for people (`label`; without one it is for programs alone).
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) key: &'static str,
    pub(super) label: &'static str,
    pub(super) value: Value,
}

/// A field for both.
pub(super) const fn field(key: &'static str, label: &'static str, value: Value) -> Field {
    Field { key, label, value }
}

/// A field for programs alone.
pub(super) const fn hidden(key: &'static str, value: Value) -> Field {
    Field { key, label: "", value }
}

/// One thing that happened.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) kind: &'static str,
    pub(super) title: String,
    pub(super) fields: Vec<Field>,
    /// What happened each time that it met the pixel.
    pub(super) hits: Vec<Vec<Field>>,
}

impl Entry {
    pub(super) const fn new(kind: &'static str, title: String) -> Self {
        Self { kind, title, fields: Vec::new(), hits: Vec::new() }
    }
}

/// All that happened at a pixel. As text it is for people: 80 columns, rounded numbers.
#[derive(Clone, Debug)]
pub struct History {
    pub(super) program: &'static str,
    pub(super) variant: &'static str,
    pub(super) frame: Option<u32>,
    /// Knobs that do not stand at their defaults, as NAME=VALUE.
    pub(super) knobs: Vec<String>,
    /// The pixel, y up.
    pub(super) pixel: Pixel,
    /// Its row in the image file, 0 on top.
    pub(super) row: i32,
    pub(super) entries: Vec<Entry>,
    /// What did not touch the pixel, and why.
    pub(super) others: Vec<Entry>,
    /// The color that stands in the picture.
    pub(super) color: Color,
    /// The color that the last of the entries has left.
    pub(super) last_color: Color,
}

/// A number, rounded for people: about five digits that count.
fn rounded(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 {
        "0".to_owned()
    } else if !number.is_finite() {
        number.to_string()
    } else if !(1e-4..1e7).contains(&size) {
        format!("{number:.3e}")
    } else {
        // 101.9999999999995 is cut to 101, and must not look like 102.
        let below = number.round() - number;
        if below > 0.0 && below < 1e-9 * size && number >= 1.0 {
            return format!("{}-{below:.0e}", number.round());
        }
        let decimals = if size >= 1000.0 { 2 } else { 4 };
        format!("{number:.decimals$}")
    }
}

/// A number in a cell of a table: with fewer digits where they find no room.
fn fitting(number: f64, width: usize) -> String {
    let text = rounded(number);
    if text.len() < width { text } else { format!("{number:.1}") }
}

impl fmt::Display for History {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, y) = self.pixel;
        let frame = self.frame.map_or_else(String::new, |frame| format!(", frame {frame}"));
        let knobs: String = self.knobs.iter().map(|knob| format!(" {knob}")).collect();
        writeln!(f, "{} {}{knobs}{frame}", self.program, self.variant)?;
        writeln!(f, "pixel ({x}, {y}), y up; row {} of the image file", self.row)?;
        for entry in &self.entries {
            write_entry(f, entry)?;
        }
        if !self.others.is_empty() {
            writeln!(f, "\nWhat did not reach this pixel")?;
        }
        for entry in &self.others {
            write_wrapped(f, "  ", 4, &entry.title)?;
        }
        write!(f, "\nIn the picture: {:?}", self.color)
    }
}

/// A paragraph of at most 80 columns, which begins with `first`; its other lines are indented by `indent`.
fn write_wrapped(f: &mut fmt::Formatter<'_>, first: &str, indent: usize, text: &str) -> fmt::Result {
    let mut line = first.to_owned();
    for (i, word) in text.split(' ').enumerate() {
        if line.chars().count() + 1 + word.chars().count() > 80 {
            writeln!(f, "{}", line.trim_end())?;
            line = " ".repeat(indent);
        } else if i > 0 {
            line += " ";
        }
        line += word;
    }
    writeln!(f, "{line}")
}

/// Marks the row of a table that went into the picture.
pub(super) const USED: &str = " ←";

/// The width of the names at the left.
const NAMES: usize = 16;

fn write_entry(f: &mut fmt::Formatter<'_>, entry: &Entry) -> fmt::Result {
    writeln!(f)?;
    write_wrapped(f, "  ", 4, &entry.title)?;
    let fields = entry.fields.iter().chain(entry.hits.iter().flatten());
    for Field { label, value, .. } in fields.filter(|field| !field.label.is_empty()) {
        let lines = match value {
            Value::Number(number) => vec![rounded(*number)],
            Value::Whole(number) => vec![number.to_string()],
            Value::Yes(answer) => vec![if *answer { "yes" } else { "no" }.to_owned()],
            Value::Text(text) => vec![text.clone()],
            Value::Color(color) => vec![format!("{color:?}")],
            Value::Numbers(numbers) => {
                vec![numbers.iter().map(|number| rounded(*number)).collect::<Vec<_>>().join("  ")]
            }
            Value::List(lines) => lines.clone(),
            Value::Group(_) | Value::Groups(_) => continue,
            Value::Table { columns, rows } => {
                write_table(f, label, columns, rows)?;
                continue;
            }
        };
        for (i, line) in lines.iter().enumerate() {
            let label = if i == 0 { label } else { "" };
            write_wrapped(f, &format!("    {label:NAMES$}"), NAMES + 4, line)?;
        }
    }
    Ok(())
}

fn write_table(
    f: &mut fmt::Formatter<'_>,
    label: &str,
    columns: &[String],
    rows: &[(String, Vec<Option<f64>>)],
) -> fmt::Result {
    let width = (60 / columns.len().max(1)).min(12);
    let line = |name: &str, cells: &mut dyn Iterator<Item = String>| {
        let cells: String = cells.map(|cell| format!("{cell:>width$}")).collect();
        format!("    {name:NAMES$}{cells}").trim_end().to_owned()
    };
    writeln!(f, "{}", line(label, &mut columns.iter().cloned()))?;
    for (name, cells) in rows {
        let mut cells =
            cells.iter().map(|cell| cell.map_or_else(String::new, |number| fitting(number, width)));
        writeln!(f, "{}", line(&format!("  {name}"), &mut cells))?;
    }
    Ok(())
}

impl History {
    /// The color that stands in the picture.
    #[must_use]
    pub const fn color(&self) -> Color {
        self.color
    }

    /// The color that the last of the events has left. It is that of the picture, unless the program has shown another
    /// buffer afterwards, or drawn a line between enlarged pixels.
    #[must_use]
    pub const fn last_color(&self) -> Color {
        self.last_color
    }

    /// The same without what did not reach the pixel.
    #[must_use]
    pub fn without_misses(self) -> Self {
        Self { others: Vec::new(), ..self }
    }

    /// The history as JSON: one object. Numbers have full precision; what is not finite is `null`.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut json = String::new();
        let entries = |entries: &[Entry]| {
            let lines: String = entries.iter().map(|entry| format!("\n    {},", entry_json(entry))).collect();
            if lines.is_empty() { lines } else { format!("{}\n  ", lines.trim_end_matches(',')) }
        };
        let frame = self.frame.map_or_else(|| "null".to_owned(), |frame| frame.to_string());
        let _ = write!(
            json,
            "{{\n  \"program\": {},\n  \"variant\": {},\n  \"frame\": {frame},\n  \"knobs\": [{}],\n  \"pixel\": [{}, {}],\n  \
             \"row\": {},\n  \"events\": [{}],\n  \"others\": [{}],\n  \"color\": {}\n}}",
            text_json(self.program),
            text_json(self.variant),
            self.knobs.iter().map(|knob| text_json(knob)).collect::<Vec<_>>().join(", "),
            self.pixel.0,
            self.pixel.1,
            self.row,
            entries(&self.entries),
            entries(&self.others),
            value_json(&Value::Color(self.color)),
        );
        json
    }
}

fn entry_json(entry: &Entry) -> String {
    let mut fields = vec![
        hidden("kind", Value::Text(entry.kind.to_owned())),
        hidden("title", Value::Text(entry.title.clone())),
    ];
    let named =
        |fields: &[Field]| fields.iter().filter(|field| !field.key.is_empty()).cloned().collect::<Vec<_>>();
    fields.extend(named(&entry.fields));
    if !entry.hits.is_empty() {
        fields.push(hidden("hits", Value::Groups(entry.hits.iter().map(|hit| named(hit)).collect())));
    }
    value_json(&Value::Group(fields))
}

fn value_json(value: &Value) -> String {
    let list =
        |items: &mut dyn Iterator<Item = String>| format!("[{}]", items.collect::<Vec<_>>().join(", "));
    match value {
        Value::Number(number) => number_json(*number),
        Value::Whole(number) => number.to_string(),
        Value::Yes(answer) => answer.to_string(),
        Value::Text(text) => text_json(text),
        Value::Color(color) => list(&mut color.channels().iter().map(u8::to_string)),
        Value::Numbers(numbers) => list(&mut numbers.iter().map(|number| number_json(*number))),
        Value::List(lines) => list(&mut lines.iter().map(|line| text_json(line))),
        Value::Group(fields) => {
            let field = |field: &Field| format!("{}: {}", text_json(field.key), value_json(&field.value));
            format!("{{{}}}", fields.iter().map(field).collect::<Vec<_>>().join(", "))
        }
        Value::Groups(groups) => {
            list(&mut groups.iter().map(|group| value_json(&Value::Group(group.clone()))))
        }
        Value::Table { columns, rows } => {
            let cell = |(column, cell): (&String, &Option<f64>)| {
                cell.map(|number| format!("{}: {}", text_json(column), number_json(number)))
            };
            let row = |(name, cells): &(String, Vec<Option<f64>>)| {
                let cells: Vec<String> = columns.iter().zip(cells).filter_map(cell).collect();
                // Which row was used is said by a field of its own.
                format!("{}: {{{}}}", text_json(name.trim_end_matches(USED)), cells.join(", "))
            };
            format!("{{{}}}", rows.iter().map(row).collect::<Vec<_>>().join(", "))
        }
    }
}

fn number_json(number: f64) -> String {
    if number.is_finite() { format!("{number:?}") } else { "null".to_owned() }
}

/// A text as JSON, in quotation marks.
pub(crate) fn text_json(text: &str) -> String {
    let mut json = String::from('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => json.extend(['\\', character]),
            '\n' => json.push_str("\\n"),
            '\0'..' ' => json.push_str(&format!("\\u{:04x}", u32::from(character))),
            _ => json.push(character),
        }
    }
    json.push('"');
    json
}

/// A table with a name for each column but the first.
pub(super) fn table(columns: &[&str], rows: Vec<(String, Vec<Option<f64>>)>) -> Value {
    Value::Table { columns: columns.iter().map(|&column| column.to_owned()).collect(), rows }
}

/// The names of values: V1, V2, …
pub(super) fn value_names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("V{i}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_as_many_digits_as_can_be_read() {
        for (number, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.5, "1.5000"),
            (-999.999_94, "-999.9999"),
            (1000.0, "1000.00"),
            (9_999_999.0, "9999999.00"),
            (1e7, "1.000e7"),
            (-1e-4, "-0.0001"),
            (9.9e-5, "9.900e-5"),
            (f64::NEG_INFINITY, "-inf"),
            // What is cut to a whole number must not look like the next one.
            (101.999_999_999_999_5, "102-5e-13"),
            (0.999_999_999_999_5, "1.0000"),
            (101.999_99, "102.0000"),
            (4_999.999_999, "5000-1e-6"),
        ] {
            assert_eq!(rounded(number), text);
        }
        assert_eq!([fitting(1.5, 7), fitting(1.5, 6)], ["1.5000", "1.5"], "with a blank before it");
    }

    #[test]
    fn the_columns_of_wide_tables_are_narrower() {
        struct Wide(usize);
        impl fmt::Display for Wide {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let columns = value_names(self.0);
                write_table(f, "", &columns, &[("A".to_owned(), vec![Some(1.5); self.0])])
            }
        }
        let longest = |columns| Wide(columns).to_string().lines().map(str::len).max();
        assert_eq!([1, 5, 6, 10].map(longest), [32, 80, 80, 80].map(Some));
        assert!(Wide(10).to_string().ends_with(&format!("{}\n", "   1.5".repeat(10))));
    }

    #[test]
    fn long_lines_are_wrapped_between_words() {
        struct Wrapped(String);
        impl fmt::Display for Wrapped {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write_wrapped(f, "  ", 4, &self.0)
            }
        }
        let text = Wrapped(["ab"; 40].join(" ")).to_string();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines, [format!("  {}", ["ab"; 26].join(" ")), format!("    {}", ["ab"; 14].join(" "))]);
    }

    #[test]
    fn any_text_is_json() {
        let text = "a \"quoted\" \\ path,\ta bell \u{7} and\nλ";
        let read: serde_json::Value = serde_json::from_str(&text_json(text)).expect("JSON");
        assert_eq!(read, text);
        assert_eq!(text_json("\n\t"), r#""\n\u0009""#, "the usual short form");
    }
}
