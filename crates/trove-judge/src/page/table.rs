//! Tables with a heading for every row and column.

use std::fmt::Write;

use super::escape::escape;

/// A column's heading.
#[derive(Clone, Debug)]
pub struct Column {
    name: String,
    is_words: bool,
}

impl Column {
    /// Of numbers, which end below each other.
    pub fn numbers(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_words: false }
    }

    /// Of text, which begins below each other and may take several lines.
    pub fn words(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_words: true }
    }
}

/// A cell's text, with a colour that it tells of, and what more there is to say of it.
#[derive(Clone, Debug)]
pub struct Cell {
    text: String,
    rgb: Option<[u8; 3]>,
    more: Option<String>,
}

impl Cell {
    /// With a patch of a colour (sRGB) before it.
    pub fn colored(text: impl Into<String>, rgb: [u8; 3]) -> Self {
        Self { text: text.into(), rgb: Some(rgb), more: None }
    }

    /// With a line in small letters below it.
    pub fn with_more(text: impl Into<String>, more: impl Into<String>) -> Self {
        Self { text: text.into(), rgb: None, more: Some(more.into()) }
    }

    fn html(&self) -> String {
        let patch = self.rgb.map(|[r, g, b]| format!("<i class=\"swatch\" style=\"background:rgb({r},{g},{b})\"></i>"));
        let more = self.more.as_ref().map(|more| format!("<small>{}</small>", escape(more)));
        patch.unwrap_or_default() + &escape(&self.text) + &more.unwrap_or_default()
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self { text: text.into(), rgb: None, more: None }
    }
}

/// A table; the first cell of a row is its heading.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Column>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// Without rows yet.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self { columns: columns.into_iter().collect(), rows: Vec::new() }
    }

    /// Appends a row with a cell for each column.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Whether it has no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    pub(super) fn html(&self) -> String {
        let class = |column: &Column| if column.is_words { " class=\"words\"" } else { "" };
        let mut html = String::from("<table><thead><tr>");
        for column in &self.columns {
            let _ = write!(html, "<th scope=\"col\"{}>{}</th>", class(column), escape(&column.name));
        }
        html += "</tr></thead><tbody>";
        for row in &self.rows {
            html += "<tr>";
            for (i, (cell, column)) in row.iter().zip(&self.columns).enumerate() {
                let _ = match i {
                    0 => write!(html, "<th scope=\"row\">{}</th>", cell.html()),
                    _ => write!(html, "<td{}>{}</td>", class(column), cell.html()),
                };
            }
            html += "</tr>";
        }
        html + "</tbody></table>"
    }
}
