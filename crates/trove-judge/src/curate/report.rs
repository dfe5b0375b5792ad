//! One page that shows what a dataset holds and what was chosen; it needs no other file.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{CLASSES, Raster};

use super::frame::{CandidateFrame, SeenObject, entropy};
use super::{Curation, Split};
use crate::JudgeError;
use crate::page::plots::{Bar, BarRow, Bin, Fill, Plot, bar_rows, counts, histogram, map};
use crate::page::{Column, Figure, Page, Picture, Table};
use crate::pictures::{read_labels, read_raster, title};

/// Frames that are shown.
const SHOWN: usize = 60;
/// Width of their pictures, pixels.
const THUMBNAIL_PX: u32 = 200;
/// Edges of the bins of distance, metres, and of size, pixels.
const DISTANCES_M: [f64; 6] = [0.0, 10.0, 20.0, 40.0, 80.0, f64::INFINITY];
const SIZES_PX: [f64; 6] = [0.0, 100.0, 400.0, 1600.0, 6400.0, f64::INFINITY];
/// Bars of shares are logarithmic from a hundred-thousandth to 1.
const DECADES: f64 = 5.0;
const TICKS: [(f64, &str); 6] = [(0.0, "0.001"), (0.2, "0.01"), (0.4, "0.1"), (0.6, "1"), (0.8, "10"), (1.0, "100 %")];

/// The page, as HTML.
///
/// # Errors
/// A frame whose picture can no longer be read.
pub fn report(root: &Path, curation: &Curation) -> Result<String, JudgeError> {
    let Curation { frames, selection, splits, rules } = curation;
    let kept: Vec<&CandidateFrame> = selection.kept.iter().map(|i| &frames[*i]).collect();
    let count = |wanted: Split| splits.iter().filter(|s| **s == wanted).count();
    let mut page = Page::new(&format!("Contents of {}", title(root)));
    page.text(&format!(
        "{} frames; {} kept: {} for training, {} for validation, {} near to both and in neither.",
        frames.len(),
        kept.len(),
        count(Split::Train),
        count(Split::Val),
        count(Split::Gap),
    ));
    page.text(&format!(
        "Dropped: {} with fewer than {} classes, {} near-duplicates, {} that add less.",
        selection.poor,
        rules.min_classes,
        selection.duplicates,
        frames.len() - kept.len() - selection.poor - selection.duplicates,
    ));
    page.text(&format!(
        "Entropy of the classes: {:.2} bits of all frames, {:.2} of those kept.",
        entropy(&curation.shares(false)),
        entropy(&curation.shares(true)),
    ));
    page.section("Pixels by class");
    page.text("Upper bars: all frames; lower bars: those kept. Each line is ten times the previous one.");
    page.plot(&class_bars(&curation.shares(false), &curation.shares(true)));
    page.section("Classes per frame");
    page.text("Number of frames by number of classes; pale: dropped frames.");
    let classes = |f: &CandidateFrame| f.classes() as f64;
    page.plot(&of_frames("Frames by number of classes", curation, (20, 20.0), classes, |i| i.to_string()));
    page.section("Entropy per frame");
    page.text("Bits, from the number under each bar; pale: dropped frames.");
    let bits = |i| format!("{:.2}", i as f64 / 4.0);
    page.plot(&of_frames("Frames by entropy", curation, (16, 4.0), CandidateFrame::entropy, bits));
    page.section("Where the cameras stand");
    page.text("North is up.");
    page.key(&[("train", "training"), ("val", "validation"), ("gap", "between both"), ("rest", "dropped")]);
    page.plots(&places(curation));
    page.section("Objects kept, by distance");
    page.table("Objects kept, by distance", &objects(&kept, &DISTANCES_M, "m", |object| object.range_m.into()));
    page.section("Objects kept, by visible pixels");
    page.table("Objects kept, by visible pixels", &objects(&kept, &SIZES_PX, "px", |object| object.visible_px.into()));
    page.section("Most valuable frames");
    let figure = |(frame, split): (&&CandidateFrame, &Split)| {
        let split = format!("{split:?}").to_lowercase();
        let told = format!("{} classes, {:.2} bits, {split}", frame.classes(), frame.entropy());
        Ok(Figure { pictures: vec![thumbnail(root, frame)?], caption: vec![frame.path.clone(), told] })
    };
    page.figures(&kept.par_iter().zip(splits).take(SHOWN).map(figure).collect::<Result<Vec<_>, JudgeError>>()?);
    Ok(page.html())
}

/// A small picture: of the picture, or of the classes where there is none.
fn thumbnail(root: &Path, frame: &CandidateFrame) -> Result<Picture, JudgeError> {
    let folder = root.join(&frame.path);
    let (pixels, alt) = if frame.has_picture {
        (read_raster(&folder.join("rgb.png"))?, format!("Image of {}", frame.path))
    } else {
        let labels = read_labels(&folder.join("class.png"))?;
        let color = |x: u32, y: u32| CLASSES[usize::from(*labels.at(x, y)).min(19)].rgb;
        (Raster::from_fn(labels.width, labels.height, color), format!("Classes of {}", frame.path))
    };
    Picture::new(&folder, pixels, THUMBNAIL_PX, alt)
}

/// Two bars a class.
fn class_bars(all: &[f64; 20], kept: &[f64; 20]) -> Plot {
    let length = |share: f64| ((share.max(1e-9).log10() + DECADES) / DECADES).clamp(0.0, 1.0);
    let rows = CLASSES.iter().zip(all.iter().zip(kept)).skip(1).map(|(row, (all, kept))| {
        let bar = |share: &f64, fill| Bar { share: length(*share), fill, interval: None };
        BarRow {
            name: row.name.replace('_', " "),
            value: format!("{:.3} → {:.3} %", all * 100.0, kept * 100.0),
            bars: vec![bar(all, Fill::Class("pale")), bar(kept, Fill::Rgb(row.rgb))],
        }
    });
    bar_rows("Share of pixels by class, of all frames and of those kept", &TICKS, &rows.collect::<Vec<_>>())
}

/// How often frames' values fall into each of some bins from 0, of all and of those kept.
fn of_frames(
    label: &str,
    curation: &Curation,
    (bins, high): (usize, f64),
    value: impl Fn(&CandidateFrame) -> f64,
    name: impl Fn(usize) -> String,
) -> Plot {
    let all = counts(curation.frames.iter().map(&value), bins, high);
    let kept = counts(curation.selection.kept.iter().map(|i| value(&curation.frames[*i])), bins, high);
    let bin = |(i, (all, part)): (usize, (usize, usize))| Bin { name: name(i), all, part };
    histogram(label, &all.into_iter().zip(kept).enumerate().map(bin).collect::<Vec<_>>())
}

/// A map of each place with its cameras.
fn places(curation: &Curation) -> Vec<Plot> {
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
    dots.into_iter().map(|(place, dots)| map(place, &dots)).collect()
}

/// A table of the classes that have objects.
fn objects(frames: &[&CandidateFrame], edges: &[f64], unit: &str, of: fn(&SeenObject) -> f64) -> Table {
    let bins = edges.windows(2).map(|pair| (pair[0]..pair[1], pair[1].is_finite()));
    let headings = bins.clone().map(|(bin, ends)| match ends {
        true => Column::numbers(format!("{}–{} {unit}", bin.start, bin.end)),
        false => Column::numbers(format!("from {} {unit}", bin.start)),
    });
    let mut table = Table::new([Column::words("class")].into_iter().chain(headings));
    for row in CLASSES.iter().filter(|row| row.thing) {
        let of_class = |o: &&SeenObject| o.class_id == row.class.id();
        let values: Vec<f64> = frames.iter().flat_map(|f| &f.objects).filter(of_class).map(of).collect();
        if !values.is_empty() {
            let counts = bins.clone().map(|(bin, _)| values.iter().filter(|v| bin.contains(v)).count().to_string());
            table.row([row.name.replace('_', " ")].into_iter().chain(counts).map(Into::into));
        }
    }
    table
}
