use std::path::Path;

use glam::dvec2;
use trove_model::Raster;

use super::plots::{Bar, BarRow, Bin, Fill, HeatCell, bar_rows, counts, curves, heat_map, histogram, map};
use super::*;

const NAME: &str = r#"<b>"a" & 'c'"#;
const SHOWN: &str = "&lt;b&gt;&quot;a&quot; &amp; 'c'";

/// What stands between `before` and the next `"`, wherever `before` is.
fn values<'a>(html: &'a str, before: &str) -> Vec<&'a str> {
    html.split(before).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

fn drawn(plot: &Plot) -> String {
    let mut page = Page::new("plot");
    page.plot(plot);
    page.html().split("<h1>").nth(1).unwrap().to_owned()
}

#[test]
fn text_is_shown_as_it_is_wherever_it_stands() {
    let mut page = Page::new(NAME);
    page.text(NAME);
    page.facts([(NAME, NAME.to_owned(), NAME.to_owned())]);
    page.section(NAME);
    page.key(&[("bar", NAME)]);
    page.search(NAME);
    let mut table = Table::new([Column::words(NAME), Column::numbers(NAME)]);
    table.row([Cell::from(NAME), Cell::colored(NAME, [1, 2, 3])]);
    page.table(NAME, &table);
    let pixels = Raster::filled(4, 2, [200, 100, 50]);
    let picture = Picture::new(Path::new("a"), pixels, 8, NAME).unwrap();
    page.figures(&[Figure { pictures: vec![picture], caption: vec![NAME.into()] }]);
    let bar = Bar { share: 0.5, fill: Fill::Class("bar"), interval: None };
    page.plot(&bar_rows(NAME, &[(0.0, NAME)], &[BarRow { name: NAME.into(), value: NAME.into(), bars: vec![bar] }]));
    page.plot(&histogram(NAME, &[Bin { name: NAME.into(), all: 1, part: 1 }]));
    page.plots(&[curves(NAME, [0.0, 1.0], &[("after", vec![1.0])]), map(NAME, &[("bar", dvec2(0.0, 0.0))])]);
    page.plot(&heat_map(NAME, &[NAME], &[NAME], |_, _| {
        Some(HeatCell { share: 1.0, text: NAME.into(), more: NAME.into() })
    }));
    let html = page.html();
    assert!(!html.contains("<b>") && !html.contains("\"a\""), "{html}");
    // Title and heading, text, facts, heading, key, field, table and figure, and the plots.
    assert_eq!(html.matches(SHOWN).count(), 2 + 1 + 3 + 1 + 1 + 1 + 5 + 2 + 4 + 3 + 4 + 6, "{html}");
}

#[test]
fn a_page_says_its_language_and_title_and_what_stands_in_rows_and_columns() {
    let mut page = Page::new("Scores");
    page.section("First");
    let mut table = Table::new([Column::words("class"), Column::numbers("IoU")]);
    table.row(["road", "0.5"].map(Cell::from));
    page.table("IoU", &table);
    page.section("Second");
    let html = page.html();
    assert!(html.starts_with("<!doctype html>\n<html lang=\"en\">") && html.contains("<title>Scores – TRoVE</title>"));
    assert!(html.contains("<th scope=\"col\">IoU</th>") && html.contains("<th scope=\"row\">road</th><td>0.5</td>"));
    assert_eq!((html.matches("<section>").count(), html.matches("</section>").count()), (2, 2));
    // Nothing is fetched, and what is not searched needs no script.
    assert!(!html.contains("http") && !html.contains("<script") && !html.contains("url("), "{html}");
}

#[test]
fn pictures_are_as_wide_as_asked_for_and_as_high_as_their_shape_and_jpeg_allow() {
    let size = |width: u32, height: u32| {
        let picture = Picture::new(Path::new("a"), Raster::filled(width, height, [9; 3]), 40, "a").unwrap();
        let html = Figure { pictures: vec![picture], caption: vec![] }.html();
        (values(&html, " width=\"")[0].to_owned(), values(&html, " height=\"")[0].to_owned())
    };
    assert_eq!(size(400, 225), ("40".into(), "22".into()));
    assert_eq!(size(4, 2), ("40".into(), "20".into()));
    assert_eq!(size(100_000, 1), ("40".into(), "1".into()));
    assert_eq!(size(1, 40_000), ("40".into(), "65535".into()));
}

#[test]
fn bars_and_whiskers_are_as_long_as_their_shares() {
    let bar = |share, interval| Bar { share, fill: Fill::Rgb([1, 2, 3]), interval };
    let row = |bars| BarRow { name: "road".into(), value: "50 %".into(), bars };
    let rows = [row(vec![bar(0.5, Some([0.25, 0.75])), bar(1.5, None)]), row(vec![])];
    let svg = drawn(&bar_rows("IoU", &[(0.0, "0"), (1.0, "100 %")], &rows));
    assert_eq!(values(&svg, "fill=\"rgb(1,2,3)\" y=\"18\" width=\""), ["50.00%"]);
    // What is longer than the room ends where it does.
    assert_eq!(values(&svg, "fill=\"rgb(1,2,3)\" y=\"28\" width=\""), ["100.00%"]);
    assert_eq!(values(&svg, "class=\"whisker\" x1=\""), ["25.00%"]);
    assert_eq!(svg.matches(">50 %<").count(), 2);
    assert!(svg.contains("role=\"img\" aria-label=\"IoU\""), "{svg}");
}

#[test]
fn values_fall_into_the_bin_that_begins_at_or_below_them() {
    assert_eq!(counts([0.0, 0.09, 0.1, 0.95, 1.0, 7.0], 10, 1.0), [2, 1, 0, 0, 0, 0, 0, 0, 0, 3]);
    let bin = |all, part| Bin { name: String::new(), all, part };
    let svg = drawn(&histogram("frames", &[bin(4, 1), bin(0, 0), bin(2, 2)]));
    let heights = |class: &str| {
        let mark = format!("class=\"{class}\"");
        let bars = svg.split(&mark).skip(1);
        bars.map(|bar| values(bar, " height=\"")[0].to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(heights("pale"), ["100.0", "0.0", "50.0"]);
    assert_eq!(heights("bar"), ["25.0", "0.0", "50.0"]);
}

#[test]
fn the_highest_point_of_curves_is_at_the_top_and_nothing_is_at_the_bottom() {
    let svg = drawn(&curves("L*", [0.0, 100.0], &[("before", vec![0.0, 0.5]), ("after", vec![0.25, 0.0])]));
    assert_eq!(values(&svg, "curve before\" points=\""), ["80.0,122.0 240.0,4.0"]);
    assert_eq!(values(&svg, "curve after\" points=\""), ["80.0,63.0 240.0,122.0"]);
    assert!(svg.contains(">0</text>") && svg.contains(">50</text>") && svg.contains(">100</text>"));
}

#[test]
fn on_maps_east_is_right_and_north_is_up() {
    let svg = drawn(&map("town", &[("train", dvec2(0.0, 0.0)), ("val", dvec2(100.0, 50.0))]));
    assert!(svg.contains("aria-label=\"town (110 m wide)\""), "{svg}");
    let at = |class: &str| -> [f64; 2] {
        let dot = svg.split(&format!("<circle class=\"{class}\"")).nth(1).unwrap();
        [" cx=\"", " cy=\""].map(|axis| values(dot, axis)[0].parse().unwrap())
    };
    let ([left, low], [right, high]) = (at("train"), at("val"));
    assert!((right - left - 320.0 / 1.1).abs() < 0.2 && (low - high - 160.0 / 1.1).abs() < 0.2, "{svg}");
}

#[test]
fn cells_stand_in_their_row_and_column_with_ink_that_can_be_read() {
    let share = [[0.2, 0.7], [0.9, 0.0]];
    let cell = |i: usize, j: usize| {
        let text = format!("{:.0}", share[i][j] * 100.0);
        (share[i][j] > 0.0).then(|| HeatCell { share: share[i][j], text, more: String::new() })
    };
    let svg = drawn(&heat_map("confusion", &["road", "car"], &["a", "b"], cell));
    assert_eq!(values(&svg, "fill-opacity=\""), ["0.200", "0.700", "0.900"]);
    assert_eq!(values(&svg, "<text class=\""), ["on-low", "on-middle", "on-high"]);
    let cells: Vec<&str> = svg.split("<rect class=\"cell\"").skip(1).collect();
    let at = |i: usize| [" x=\"", " y=\""].map(|axis| values(cells[i], axis)[0].parse::<u32>().unwrap());
    let [left, top] = at(0);
    assert_eq!((at(1), at(2)), ([left + 30, top], [left, top + 30]));
    // A frame around every cell, also where there is nothing.
    assert_eq!(svg.matches("class=\"frame\"").count(), 4);
}
