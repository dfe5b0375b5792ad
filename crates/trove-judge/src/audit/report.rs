//! A page that shows what was checked, and what is wrong and where.

use std::path::Path;

use trove_model::Raster;

use super::finding::{Audit, Check, Finding};
use super::form::LabelForm;
use super::worst::{picture, worst_in_turn};
use crate::JudgeError;
use crate::page::{Cell, Column, Figure, Page, Picture, Table};
use crate::pictures::title;

/// Findings that are shown, and the width of their pictures, pixels.
const SHOWN: usize = 24;
const WIDTH_PX: u32 = 480;
/// What is shown of an image at least, so that the surroundings can be recognised, pixels.
const LEAST_PX: [u32; 2] = [320, 200];

/// The page, as HTML, about the dataset at `root`.
///
/// # Errors
/// A picture that JPEG cannot hold.
pub fn report(root: &Path, form: LabelForm, audit: &Audit) -> Result<String, JudgeError> {
    let mut page = Page::new(&format!("Labels of {}", title(root)));
    let count: usize = audit.tallies.values().map(|tally| tally.findings).sum();
    let made = audit.tallies.len();
    page.facts([
        ("Findings", count.to_string(), if audit.is_sound() { "no fault found".into() } else { String::new() }),
        ("Frames", audit.frames.to_string(), form.name().to_owned()),
        ("Checks", made.to_string(), format!("of {}; the others had nothing to look at", Check::ALL.len())),
    ]);
    page.section("Checks");
    page.text("A check looks at frames, tables or sequences.");
    let mut table = Table::new([Column::words("check"), Column::numbers("looked at"), Column::numbers("findings")]);
    for check in Check::ALL {
        let tally = audit.tallies.get(&check);
        let cell = |of: Option<usize>| of.map_or("–".to_owned(), |count| count.to_string());
        let counts = [cell(tally.map(|tally| tally.looked_at)), cell(tally.map(|tally| tally.findings))];
        table.row([Cell::with_more(check.name(), check.rule())].into_iter().chain(counts.map(Cell::from)));
    }
    page.table("Checks", &table);
    if audit.is_sound() {
        return Ok(page.html());
    }
    let mut figures = Vec::new();
    for finding in worst_in_turn(audit) {
        if figures.len() == SHOWN {
            break;
        }
        // A damaged image cannot be shown.
        let Ok(Some(whole)) = picture(root, finding) else { continue };
        let (cut, where_) = around(&whole, &finding.pixels);
        let alt = format!("{} in {}", finding.check.name(), finding.place);
        let image = finding.image.clone().unwrap_or_default();
        figures.push(Figure {
            pictures: vec![Picture::new(&root.join(&image), cut, WIDTH_PX, alt)?],
            caption: vec![format!("{}: {}", finding.check.name(), finding.what), format!("{image}{where_}")],
        });
    }
    if !figures.is_empty() {
        page.section("The worst");
        page.text("Of each check in turn: the image around what is wrong, darkened, with what is wrong in magenta.");
        page.figures(&figures);
    }
    page.section("Findings");
    page.text(&format!("The worst of each check first, at most {} of each.", Audit::MOST));
    let found = Column::words("what was expected and found, and where");
    let mut table = Table::new([Column::words("check"), found, Column::numbers("wrong, %")]);
    for Finding { check, place, what, severity, .. } in &audit.findings {
        let wrong = format!("{:.1}", severity * 100.0);
        table.row([check.name().into(), Cell::with_more(what, place), wrong.into()]);
    }
    page.table("Findings", &table);
    Ok(page.html())
}

/// The part of an image that has some pixels, with what is around them, and where in it that is, in words. All of it where
/// there are no pixels.
fn around(whole: &Raster<[u8; 3]>, pixels: &[[u32; 2]]) -> (Raster<[u8; 3]>, String) {
    if pixels.is_empty() {
        return (whole.clone(), String::new());
    }
    let size = [whole.width, whole.height];
    let [(left, width), (top, height)] = [0, 1].map(|axis| {
        let low = pixels.iter().map(|pixel| pixel[axis]).min().unwrap_or(0);
        let high = pixels.iter().map(|pixel| pixel[axis]).max().unwrap_or(0);
        let length = ((high - low + 1) * 3 / 2).max(LEAST_PX[axis]).min(size[axis]);
        let start = ((low + high) / 2).saturating_sub(length / 2).min(size[axis] - length);
        (start, length)
    });
    let cut = Raster::from_fn(width, height, |x, y| *whole.at(left + x, top + y));
    (cut, format!(", columns {left} to {}, rows {top} to {}", left + width - 1, top + height - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_of_an_image_has_what_is_wrong_and_its_surroundings() {
        let whole = Raster::from_fn(1600, 900, |x, y| [(x / 8) as u8, (y / 8) as u8, 0]);
        let (cut, told) = around(&whole, &[[10, 890], [20, 880]]);
        assert_eq!(((cut.width, cut.height), told.as_str()), ((320, 200), ", columns 0 to 319, rows 700 to 899"));
        assert_eq!(cut.at(8, 190), whole.at(8, 890));
        let (cut, told) = around(&whole, &[[100, 300], [899, 500]]);
        assert_eq!(((cut.width, cut.height), told.as_str()), ((1200, 301), ", columns 0 to 1199, rows 250 to 550"));
        assert_eq!(around(&whole, &[]).0.width, 1600);
    }
}
