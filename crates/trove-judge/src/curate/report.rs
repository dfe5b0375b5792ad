//! One page that shows what a dataset holds and what was chosen; it needs no other file.

use std::fmt::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, resize};
use rayon::prelude::*;
use trove_model::CLASSES;

use super::frame::{CandidateFrame, entropy};
use super::{Curation, Split};
use crate::JudgeError;
use crate::pictures::{read, read_labels};

/// Frames that are shown.
const SHOWN: usize = 60;
/// Width of their pictures, pixels.
const THUMBNAIL_PX: u32 = 200;
/// Edges of the bins of distance, metres, and of size, pixels.
const DISTANCES_M: [f64; 6] = [0.0, 10.0, 20.0, 40.0, 80.0, f64::INFINITY];
const SIZES_PX: [f64; 6] = [0.0, 100.0, 400.0, 1600.0, 6400.0, f64::INFINITY];

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:72rem;padding:0 1rem;color:#1c1f24;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}table{border-collapse:collapse}td,th{padding:.15rem .6rem;text-align:right;border-bottom:1px solid #e3e5e9}\
td:first-child,th:first-child{text-align:left}.frames{display:grid;grid-template-columns:repeat(auto-fill,minmax(200px,1fr));gap:.7rem}\
figure{margin:0}figure img{width:100%;display:block}figcaption{font-size:.75rem;color:#555;overflow-wrap:anywhere}svg text{font:12px system-ui,sans-serif;fill:#1c1f24}\
@media(prefers-color-scheme:dark){body{background:#15171a;color:#e3e5e9}svg text{fill:#e3e5e9}td,th{border-color:#33373d}figcaption{color:#a5abb3}}";

/// The page, as HTML.
///
/// # Errors
/// A frame whose picture can no longer be read.
pub fn report(root: &Path, curation: &Curation) -> Result<String, JudgeError> {
    let Curation { frames, selection, splits, rules } = curation;
    let kept: Vec<&CandidateFrame> = selection.kept.iter().map(|i| &frames[*i]).collect();
    let count = |wanted: Split| splits.iter().filter(|s| **s == wanted).count();
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>What {name} holds</title><style>{STYLE}</style><h1>What {name} holds</h1>\
         <p>{all} frames; {kept} kept: {train} for training, {val} for validation, {gap} near to both and in neither.<br>\
         Dropped: {poor} with fewer than {least} classes, {duplicates} near-duplicates, {rest} that add less.<br>\
         Entropy of the classes: {before:.2} bits of all frames, {after:.2} of those kept.</p>",
        name = escape(&root.file_name().unwrap_or_default().to_string_lossy()),
        all = frames.len(),
        kept = kept.len(),
        train = count(Split::Train),
        val = count(Split::Val),
        gap = count(Split::Gap),
        poor = selection.poor,
        least = rules.min_classes,
        duplicates = selection.duplicates,
        rest = frames.len() - kept.len() - selection.poor - selection.duplicates,
        before = entropy(&curation.shares(false)),
        after = entropy(&curation.shares(true)),
    );
    page += "<h2>Pixels by class</h2><p>Upper bars: all frames; lower bars: those kept. The scale is logarithmic.</p>";
    page += &class_bars(&curation.shares(false), &curation.shares(true));
    page += "<h2>Classes a frame</h2>";
    page += &bars(&histogram(frames.iter().map(|f| f.classes() as f64), 20, 20.0), |i| i.to_string());
    page += "<h2>Entropy a frame</h2>";
    page +=
        &bars(&histogram(frames.iter().map(CandidateFrame::entropy), 16, 4.0), |i| format!("{:.2}", i as f64 / 4.0));
    page += "<h2>Objects kept, by distance</h2>";
    page += &objects(&kept, &DISTANCES_M, "m", |object| object.distance_m);
    page += "<h2>Objects kept, by visible pixels</h2>";
    page += &objects(&kept, &SIZES_PX, "px", |object| object.visible_px as f64);
    page += "<h2>The frames that are worth most</h2><div class=\"frames\">";
    let shown: Vec<String> = kept
        .par_iter()
        .zip(splits)
        .take(SHOWN)
        .map(|(frame, split)| {
            let split = format!("{split:?}").to_lowercase();
            let (classes, entropy) = (frame.classes(), frame.entropy());
            Ok(format!(
                "<figure><img loading=\"lazy\" alt=\"\" src=\"data:image/jpeg;base64,{}\"><figcaption>{}<br>{classes} \
                 classes, {entropy:.2} bits, {split}</figcaption></figure>",
                thumbnail(root, frame)?,
                escape(&frame.path),
            ))
        })
        .collect::<Result<_, JudgeError>>()?;
    page += &shown.concat();
    page += "</div></html>\n";
    Ok(page)
}

/// Two bars a class, logarithmic from a hundred-thousandth to 1.
fn class_bars(all: &[f64; 20], kept: &[f64; 20]) -> String {
    const DECADES: f64 = 5.0;
    let length = |share: f64| ((share.max(1e-9).log10() + DECADES) / DECADES).clamp(0.0, 1.0) * 480.0;
    let mut svg = String::from("<svg width=\"760\" height=\"570\" role=\"img\">");
    for (i, row) in CLASSES.iter().enumerate().skip(1) {
        let (y, [r, g, b]) = ((i - 1) * 30, row.rgb);
        let _ = write!(
            svg,
            "<text x=\"0\" y=\"{}\">{}</text><rect x=\"150\" y=\"{}\" width=\"{:.1}\" height=\"10\" fill=\"#8a929c\"/>\
             <rect x=\"150\" y=\"{}\" width=\"{:.1}\" height=\"12\" fill=\"rgb({r},{g},{b})\"/><text x=\"640\" y=\"{}\">{:.3} → {:.3} %</text>",
            y + 18,
            row.name,
            y + 3,
            length(all[i]),
            y + 14,
            length(kept[i]),
            y + 18,
            all[i] * 100.0,
            kept[i] * 100.0,
        );
    }
    svg + "</svg>"
}

/// How often values fall into each of `bins` between 0 and `high`.
fn histogram(values: impl Iterator<Item = f64>, bins: usize, high: f64) -> Vec<usize> {
    let mut counts = vec![0; bins];
    values.for_each(|v| counts[((v / high * bins as f64) as usize).min(bins - 1)] += 1);
    counts
}

fn bars(counts: &[usize], name: impl Fn(usize) -> String) -> String {
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut svg = format!("<svg width=\"{}\" height=\"150\" role=\"img\">", counts.len() * 36);
    for (i, count) in counts.iter().enumerate() {
        let (x, height) = (i * 36, 100 * count / most);
        let _ = write!(
            svg,
            "<rect x=\"{x}\" y=\"{}\" width=\"30\" height=\"{height}\" fill=\"#4f7fb5\"/><text x=\"{x}\" y=\"{}\">{}</text>\
             <text x=\"{x}\" y=\"140\">{}</text>",
            120 - height,
            114 - height,
            if *count > 0 { count.to_string() } else { String::new() },
            name(i),
        );
    }
    svg + "</svg>"
}

/// A table of the classes that have objects.
fn objects(frames: &[&CandidateFrame], edges: &[f64], unit: &str, of: fn(&super::SeenObject) -> f64) -> String {
    let mut table = String::from("<table><tr><th>class</th>");
    for pair in edges.windows(2) {
        let heading =
            if pair[1].is_finite() { format!("{}–{}", pair[0], pair[1]) } else { format!("from {}", pair[0]) };
        let _ = write!(table, "<th>{heading} {unit}</th>");
    }
    for row in CLASSES.iter().filter(|row| row.thing) {
        let values = || frames.iter().flat_map(|f| &f.objects).filter(|o| o.class_id == row.class.id()).map(of);
        if values().next().is_none() {
            continue;
        }
        let _ = write!(table, "<tr><td>{}</td>", row.name);
        for pair in edges.windows(2) {
            let _ = write!(table, "<td>{}</td>", values().filter(|v| (pair[0]..pair[1]).contains(v)).count());
        }
    }
    table + "</table>"
}

/// A small picture as base64 of JPEG: of the picture, or of the classes where there is none.
fn thumbnail(root: &Path, frame: &CandidateFrame) -> Result<String, JudgeError> {
    let folder = root.join(&frame.path);
    let picture = if frame.has_picture {
        read(&folder.join("rgb.png"))?.into_rgb8()
    } else {
        let labels = read_labels(&folder.join("class.png"))?;
        let color = |x: u32, y: u32| CLASSES[usize::from(labels.ids[(y * labels.width + x) as usize]).min(19)].rgb;
        image::RgbImage::from_fn(labels.width, labels.height, |x, y| image::Rgb(color(x, y)))
    };
    let height = (picture.height() * THUMBNAIL_PX / picture.width().max(1)).max(1);
    let small = resize(&picture, THUMBNAIL_PX, height, FilterType::Triangle);
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, 80)
        .encode_image(&small)
        .map_err(|e| JudgeError::unexpected(&folder, "a picture that can be encoded", e.to_string(), "report it"))?;
    Ok(STANDARD.encode(jpeg))
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
