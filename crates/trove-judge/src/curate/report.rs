//! One page that shows what a dataset holds and what was chosen; it needs no other file.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, resize};
use rayon::prelude::*;
use trove_model::CLASSES;

use super::frame::{CandidateFrame, entropy};
use super::plots::{bars, class_bars, escape, histogram, objects, places};
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

const STYLE: &str = ":root{color-scheme:light dark}body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:72rem;padding:0 1rem;color:#1c1f24;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}table{border-collapse:collapse}td,th{padding:.15rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid #e3e5e9}\
td:first-child,th:first-child{text-align:left}.frames{display:grid;grid-template-columns:repeat(auto-fill,minmax(160px,1fr));gap:.7rem}\
figure{margin:0}figure img{width:100%;display:block}figcaption{font-size:.75rem;color:#555;overflow-wrap:anywhere}.wide{overflow-x:auto}svg{display:block}svg text{font:12px system-ui,sans-serif;fill:#1c1f24}\
.train{color:#2f6fb5;fill:#2f6fb5}.val{color:#d9822b;fill:#d9822b}.gap{color:#a05cb0;fill:#a05cb0}.rest{color:#b4bac2;fill:#b4bac2}\
.maps{display:flex;flex-wrap:wrap;gap:1.5rem}.bar{fill:#2f6fb5}rect[fill]{stroke:currentColor;stroke-opacity:.4}.pale{fill:#c3cfdd}.line{stroke:#d5d9df}.frame{fill:none;stroke:#d5d9df}\
@media(prefers-color-scheme:dark){body{background:#15171a;color:#e3e5e9}svg text{fill:#e3e5e9}td,th{border-color:#33373d}.pale{fill:#3d4c5f}.line,.frame{stroke:#3a3f46}figcaption{color:#a5abb3}}";

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
         <title>Contents of {name}</title><style>{STYLE}</style><h1>Contents of {name}</h1>\
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
    page += "<h2>Pixels by class</h2><p>Upper bars: all frames; lower bars: those kept. Each line is ten times the previous one.</p>";
    page += &wide(&class_bars(&curation.shares(false), &curation.shares(true)));
    page += "<h2>Classes per frame</h2><p>Number of frames by number of classes; pale: dropped frames.</p>";
    let classes = |f: &CandidateFrame| f.classes() as f64;
    let [all, chosen] = [histogram(frames, 20, 20.0, classes), histogram(kept.iter().copied(), 20, 20.0, classes)];
    page += &wide(&bars(&all, &chosen, |i| i.to_string()));
    page += "<h2>Entropy per frame</h2><p>Bits, from the number under each bar; pale: dropped frames.</p>";
    let bits = CandidateFrame::entropy;
    let [all, chosen] = [histogram(frames, 16, 4.0, bits), histogram(kept.iter().copied(), 16, 4.0, bits)];
    page += &wide(&bars(&all, &chosen, |i| format!("{:.2}", i as f64 / 4.0)));
    page += "<h2>Where the cameras stand</h2><p>North is up. \
             <span class=\"train\">●</span> training <span class=\"val\">●</span> validation \
             <span class=\"gap\">●</span> between both <span class=\"rest\">●</span> dropped</p>";
    page += &places(curation);
    page += "<h2>Objects kept, by distance</h2>";
    page += &wide(&objects(&kept, &DISTANCES_M, "m", |object| object.range_m.into()));
    page += "<h2>Objects kept, by visible pixels</h2>";
    page += &wide(&objects(&kept, &SIZES_PX, "px", |object| object.visible_px.into()));
    page += "<h2>Most valuable frames</h2><div class=\"frames\">";
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

/// What may be wider than a phone, whose reader moves it sideways, with a finger or with the keys.
fn wide(content: &str) -> String {
    format!("<div class=\"wide\" tabindex=\"0\">{content}</div>")
}

/// A small picture as base64 of JPEG: of the picture, or of the classes where there is none.
fn thumbnail(root: &Path, frame: &CandidateFrame) -> Result<String, JudgeError> {
    let folder = root.join(&frame.path);
    let picture = if frame.has_picture {
        read(&folder.join("rgb.png"))?.into_rgb8()
    } else {
        let labels = read_labels(&folder.join("class.png"))?;
        let color = |x: u32, y: u32| CLASSES[usize::from(*labels.at(x, y)).min(19)].rgb;
        image::RgbImage::from_fn(labels.width, labels.height, |x, y| image::Rgb(color(x, y)))
    };
    let height = (picture.height() * THUMBNAIL_PX / picture.width().max(1)).max(1);
    let small = resize(&picture, THUMBNAIL_PX, height, FilterType::Triangle);
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, 80)
        .encode_image(&small)
        .map_err(|e| JudgeError::unexpected(&folder, "an image that can be encoded", e.to_string(), "report it"))?;
    Ok(STANDARD.encode(jpeg))
}
