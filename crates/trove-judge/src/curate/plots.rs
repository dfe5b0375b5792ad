//! The page's plots, as SVG, and its tables.

use std::collections::BTreeMap;
use std::fmt::Write;

use glam::DVec2;
use trove_model::CLASSES;

use super::frame::{CandidateFrame, SeenObject};
use super::{Curation, Split};

/// Length of the longest bar of a class, and side of a map, pixels.
const LENGTH_PX: f64 = 480.0;
const MAP_PX: f64 = 320.0;

/// Two bars a class, logarithmic from a hundred-thousandth to 1.
pub(super) fn class_bars(all: &[f64; 20], kept: &[f64; 20]) -> String {
    const DECADES: f64 = 5.0;
    let length = |share: f64| ((share.max(1e-9).log10() + DECADES) / DECADES).clamp(0.0, 1.0) * LENGTH_PX;
    let mut svg = String::from("<svg width=\"800\" height=\"600\" viewBox=\"0 0 800 600\" role=\"img\">");
    for (i, label) in ["0.001 %", "0.01 %", "0.1 %", "1 %", "10 %", "100 %"].into_iter().enumerate() {
        let x = 140.0 + LENGTH_PX * i as f64 / DECADES;
        let _ = write!(
            svg,
            "<line class=\"line\" x1=\"{x}\" x2=\"{x}\" y1=\"0\" y2=\"574\"/>\
             <text x=\"{x}\" y=\"590\" text-anchor=\"middle\">{label}</text>"
        );
    }
    for (i, row) in CLASSES.iter().enumerate().skip(1) {
        let (y, [r, g, b]) = ((i - 1) * 30, row.rgb);
        let _ = write!(
            svg,
            "<text x=\"130\" y=\"{}\" text-anchor=\"end\">{}</text>\
             <rect class=\"pale\" x=\"140\" y=\"{}\" width=\"{:.1}\" height=\"9\"/>\
             <rect x=\"140\" y=\"{}\" width=\"{:.1}\" height=\"12\" fill=\"rgb({r},{g},{b})\"/>\
             <text x=\"660\" y=\"{}\">{:.3} → {:.3} %</text>",
            y + 19,
            row.name.replace('_', " "),
            y + 4,
            length(all[i]),
            y + 14,
            length(kept[i]),
            y + 19,
            all[i] * 100.0,
            kept[i] * 100.0,
        );
    }
    svg + "</svg>"
}

/// How often frames' values fall into each of `bins` between 0 and `high`.
pub(super) fn histogram<'a>(
    frames: impl IntoIterator<Item = &'a CandidateFrame>,
    bins: usize,
    high: f64,
    value: impl Fn(&CandidateFrame) -> f64,
) -> Vec<usize> {
    let mut counts = vec![0; bins];
    frames.into_iter().for_each(|f| counts[((value(f) / high * bins as f64) as usize).min(bins - 1)] += 1);
    counts
}

/// Bars of all, with the part that was kept in front.
pub(super) fn bars(all: &[usize], kept: &[usize], name: impl Fn(usize) -> String) -> String {
    let most = all.iter().copied().max().unwrap_or(0).max(1);
    let width = all.len() * 40;
    let mut svg = format!("<svg width=\"{width}\" height=\"150\" viewBox=\"0 0 {width} 150\" role=\"img\">");
    for (i, (all, kept)) in all.iter().zip(kept).enumerate() {
        let (x, middle) = (i * 40, i * 40 + 17);
        for (class, count) in [("pale", all), ("bar", kept)] {
            let height = 100.0 * *count as f64 / most as f64;
            let y = 122.0 - height;
            let _ = write!(svg, "<rect class=\"{class}\" x=\"{x}\" y=\"{y:.1}\" width=\"34\" height=\"{height:.1}\"/>");
        }
        let (top, count) = (117 - 100 * all / most, if *all > 0 { all.to_string() } else { String::new() });
        let _ = write!(
            svg,
            "<text x=\"{middle}\" y=\"{top}\" text-anchor=\"middle\">{count}</text>\
             <text x=\"{middle}\" y=\"140\" text-anchor=\"middle\">{}</text>",
            name(i)
        );
    }
    svg + "</svg>"
}

/// A map of each place with its cameras.
pub(super) fn places(curation: &Curation) -> String {
    let Curation { frames, selection, splits, .. } = curation;
    // Dropped frames first, so that kept ones are not hidden.
    let mut dots: BTreeMap<&str, Vec<(&str, DVec2)>> = BTreeMap::new();
    for frame in frames {
        dots.entry(&frame.place).or_default().push(("rest", frame.position_m));
    }
    for (i, split) in selection.kept.iter().zip(splits) {
        let class = match split {
            Split::Train => "train",
            Split::Val => "val",
            Split::Gap => "gap",
        };
        dots.entry(&frames[*i].place).or_default().push((class, frames[*i].position_m));
    }
    let mut maps = String::from("<div class=\"maps\">");
    for (place, dots) in dots {
        let low = dots.iter().fold(DVec2::INFINITY, |low, (_, at)| low.min(*at));
        let high = dots.iter().fold(DVec2::NEG_INFINITY, |high, (_, at)| high.max(*at));
        let side_m = (high - low).max_element().max(10.0) * 1.1;
        let corner = (low + high - side_m) / 2.0;
        let _ = write!(
            maps,
            "<div>{} ({side_m:.0} m wide)<br><svg width=\"{MAP_PX}\" height=\"{MAP_PX}\" viewBox=\"0 0 {MAP_PX} {MAP_PX}\" \
             role=\"img\"><rect class=\"frame\" width=\"{MAP_PX}\" height=\"{MAP_PX}\"/>",
            escape(place)
        );
        for (class, at) in dots {
            let at = (at - corner) / side_m * MAP_PX;
            let _ = write!(maps, "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\"/>", at.x, MAP_PX - at.y);
        }
        maps += "</svg></div>";
    }
    maps + "</div>"
}

/// A table of the classes that have objects.
pub(super) fn objects(frames: &[&CandidateFrame], edges: &[f64], unit: &str, of: fn(&SeenObject) -> f64) -> String {
    let mut table = String::from("<table><tr><th>class</th>");
    for pair in edges.windows(2) {
        let heading =
            if pair[1].is_finite() { format!("{}–{}", pair[0], pair[1]) } else { format!("from {}", pair[0]) };
        let _ = write!(table, "<th>{heading} {unit}</th>");
    }
    table += "</tr>";
    for row in CLASSES.iter().filter(|row| row.thing) {
        let values = || frames.iter().flat_map(|f| &f.objects).filter(|o| o.class_id == row.class.id()).map(of);
        if values().next().is_none() {
            continue;
        }
        let _ = write!(table, "<tr><td>{}</td>", row.name.replace('_', " "));
        for pair in edges.windows(2) {
            let _ = write!(table, "<td>{}</td>", values().filter(|v| (pair[0]..pair[1]).contains(v)).count());
        }
        table += "</tr>";
    }
    table + "</table>"
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
