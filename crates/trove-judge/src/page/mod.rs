//! Pages of HTML in the looks that all of them share (`web/look.css`), each in a file that needs no other.
//!
//! Whatever text they are given is shown as it is.

mod escape;
mod picture;
pub mod plots;
mod table;

use std::fmt::Write;

pub use escape::escape;
pub use picture::{Figure, Picture};
use plots::Plot;
pub use table::{Cell, Column, Table};

/// The looks of every page.
pub const LOOK: &str = include_str!("../../../../web/look.css");
const REPORT: &str = include_str!("../../../../web/report.css");
const FILTER: &str = include_str!("../../../../web/filter.js");

/// A page that is read from top to bottom, in the making.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    body: String,
    has_section: bool,
    has_search: bool,
}

impl Page {
    /// With a title and nothing below it yet.
    pub fn new(title: &str) -> Self {
        let title = escape(title);
        Self { body: format!("<h1>{title}</h1>\n"), title, has_section: false, has_search: false }
    }

    /// A heading, which what follows is below of.
    pub fn section(&mut self, heading: &str) {
        self.body += if std::mem::replace(&mut self.has_section, true) { "</section>\n" } else { "" };
        let _ = writeln!(self.body, "<section><h2>{}</h2>", escape(heading));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"lead\">{}</p>", escape(text));
    }

    /// What matters most: names, values, and what more there is to say of each.
    pub fn facts<'a>(&mut self, facts: impl IntoIterator<Item = (&'a str, String, String)>) {
        self.body += "<dl class=\"facts\">";
        for (name, value, more) in facts {
            let _ = write!(self.body, "<div><dt>{}</dt><dd>{}</dd>", escape(name), escape(&value));
            if !more.is_empty() {
                let _ = write!(self.body, "<dd>{}</dd>", escape(&more));
            }
            self.body += "</div>";
        }
        self.body += "</dl>\n";
    }

    /// What the classes of a plot's marks stand for.
    pub fn key(&mut self, marks: &[(&str, &str)]) {
        if marks.is_empty() {
            return;
        }
        self.body += "<ul class=\"key\">";
        for (class, name) in marks {
            let _ = write!(self.body, "<li>{}{}</li>", plots::mark(class), escape(name));
        }
        self.body += "</ul>\n";
    }

    /// A plot over the width of the page; one that is wider is moved sideways.
    pub fn plot(&mut self, plot: &Plot) {
        let svg = plot.svg();
        self.body += &if plot.is_fluid() { svg + "\n" } else { wide(&svg, plot.label()) };
    }

    /// Plots beside each other, under their labels.
    pub fn plots(&mut self, plots: &[Plot]) {
        self.body += "<div class=\"plots\">";
        for plot in plots {
            let (label, svg) = (escape(plot.label()), plot.svg());
            let _ = write!(self.body, "<div><p class=\"lead\">{label}</p>{svg}</div>");
        }
        self.body += "</div>\n";
    }

    /// A table; `label` says of what, for those who do not see it.
    pub fn table(&mut self, label: &str, table: &Table) {
        self.body += &wide(&table.html(), label);
    }

    /// Pictures in rows and columns.
    pub fn figures(&mut self, figures: &[Figure]) {
        let size = figures.iter().map(Figure::size).max().unwrap_or("");
        let _ = write!(self.body, "<div class=\"figures{size}\">");
        figures.iter().for_each(|figure| self.body += &figure.html());
        self.body += "</div>\n";
    }

    /// A field that keeps, of the page's rows and of as many figures in their order, those that have the words in it.
    pub fn search(&mut self, label: &str) {
        self.has_search = true;
        let _ = writeln!(
            self.body,
            "<div class=\"search\"><label for=\"search\">{}</label><input id=\"search\" type=\"search\">\
             <output for=\"search\" aria-live=\"polite\"></output></div>",
            escape(label)
        );
    }

    /// All of it.
    pub fn html(self) -> String {
        let Self { title, body, has_section, has_search } = self;
        let end = if has_section { "</section>\n" } else { "" };
        let script = if has_search { format!("<script>{FILTER}</script>\n") } else { String::new() };
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title} – TRoVE</title>\n<style>{LOOK}{REPORT}</style>\n<main>\n{body}{end}</main>\n{script}</html>\n"
        )
    }
}

/// What may be wider than a phone, whose reader moves it sideways, with a finger or with the keys.
fn wide(content: &str, label: &str) -> String {
    format!("<div class=\"wide\" role=\"group\" aria-label=\"{}\" tabindex=\"0\">{content}</div>\n", escape(label))
}

#[cfg(test)]
mod tests;
