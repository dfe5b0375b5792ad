//! The sheet as a page of HTML.

use std::path::Path;

use anyhow::Result;
use trove_judge::page::{Column, Figure, Page, Picture, Table};
use trove_model::Raster;

use super::studio::Subject;

/// A page with a picture and a row of every subject, which a field searches.
pub(super) fn html(drawn: Vec<(Subject, Raster<[u8; 3]>)>) -> Result<String> {
    let mut page = Page::new("Models and materials");
    let models = drawn.iter().filter(|(subject, _)| matches!(subject, Subject::Model(_))).count();
    page.text(&format!("{models} models and {} materials. Sizes are length × width × height.", drawn.len() - models));
    page.search("Words of an id, class, kind, tag or licence");
    let mut table = Table::new([
        Column::words("id"),
        Column::words("class"),
        Column::words("kind"),
        Column::numbers("size, m"),
        Column::words("tags"),
        Column::words("licence"),
    ]);
    let mut figures = Vec::new();
    for (subject, picture) in drawn {
        let id = subject.id();
        let (class, kind, size_m, tags, licence) = match subject {
            Subject::Model(a) => {
                (a.class.row().name, a.kind.name(), a.size_m.to_array().to_vec(), &a.tags, a.licence.as_str())
            }
            Subject::Sample(s) => ("", s.kind.name(), s.size_m.map(f64::from).to_vec(), &s.tags, ""),
        };
        let size_m: Vec<String> = size_m.into_iter().map(|side| format!("{side:.2}")).collect();
        let tags: Vec<&str> = tags.iter().collect();
        let row =
            [id, &class.replace('_', " "), &kind.replace('_', " "), &size_m.join(" × "), &tags.join(", "), licence];
        table.row(row.map(Into::into));
        let width = picture.width;
        figures.push(Figure {
            pictures: vec![Picture::new(Path::new(id), picture, width, id)?],
            caption: vec![id.to_owned()],
        });
    }
    page.figures(&figures);
    page.section("Details");
    page.table("Models and materials", &table);
    Ok(page.html())
}
