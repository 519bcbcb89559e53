//! Tables of words and numbers.

use std::fmt;

/// Which row something belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    /// Rows of one group stand together.
    pub(crate) group: String,
    pub(crate) name: String,
}

/// A table that grows: rows come as they are needed.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<(Row, Vec<String>)>,
    pub(crate) notes: Vec<String>,
}

impl Table {
    pub(crate) fn new(title: &str, columns: &[String]) -> Self {
        Self { title: title.to_owned(), columns: columns.to_vec(), rows: vec![], notes: vec![] }
    }

    /// Writes into the cell of a row and a column. A new row comes after the others of its group.
    pub(crate) fn put(&mut self, row: Row, column: &str, text: String) {
        let Some(column) = self.columns.iter().position(|name| name == column) else { return };
        let place = self.rows.iter().position(|(there, _)| *there == row).unwrap_or_else(|| {
            let last_of_group = self.rows.iter().rposition(|(there, _)| there.group == row.group);
            let place = last_of_group.map_or(self.rows.len(), |last| last + 1);
            self.rows.insert(place, (row, vec![String::new(); self.columns.len()]));
            place
        });
        self.rows[place].1[column] = text;
    }

    /// The lines of the table: a group's name, or a row's name and its cells.
    pub(crate) fn lines(&self) -> Vec<(bool, &str, &[String])> {
        let mut lines = vec![];
        let mut group = "";
        for (row, cells) in &self.rows {
            if row.group != group {
                group = &row.group;
                lines.push((true, group, &[][..]));
            }
            lines.push((false, row.name.as_str(), &cells[..]));
        }
        lines
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n{:24}", self.title, "")?;
        for column in &self.columns {
            write!(f, "{column:>18}")?;
        }
        for (is_group, name, cells) in self.lines() {
            let indent = if is_group { "" } else { "  " };
            write!(f, "\n{:24}", format!("{indent}{name}"))?;
            for cell in cells {
                write!(f, "{cell:>18}")?;
            }
        }
        writeln!(f)?;
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        Ok(())
    }
}
