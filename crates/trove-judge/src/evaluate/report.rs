//! A page that shows what predictions are worth, what was taken for what, and the images that came out worst.

use std::path::Path;

use rayon::prelude::*;
use trove_model::{ClassMap, Raster};

use super::confusion::Confusion;
use super::{Estimate, Evaluation, JudgedPicture};
use crate::numbering::read_as;
use crate::page::plots::{Bar, BarRow, Bin, Fill, HeatCell, bar_rows, counts, heat_map, histogram};
use crate::page::{Cell, Column, Figure, Page, Picture, Table};
use crate::pictures::{OURS, name, read_raster, title};
use crate::{JudgeError, Numbering};

/// Images that are shown, and the width of each of their pictures, pixels.
const SHOWN: usize = 12;
const WIDTH_PX: u32 = 360;
/// Confusions that are listed.
const LISTED: usize = 12;
/// Numbers in more cells than so many by so many cannot be told apart.
const MOST_NUMBERED: usize = 40;
const TICKS: [(f64, &str); 5] = [(0.0, "0"), (0.25, "25"), (0.5, "50"), (0.75, "75"), (1.0, "100 %")];
/// What is wrong, and what does not count, in pictures of differences.
const WRONG: [u8; 3] = [255, 0, 255];
const IGNORED: [u8; 3] = [40, 40, 40];

/// The page, as HTML; `predicted` is what was judged.
///
/// # Errors
/// A picture of the worst that can no longer be read.
pub fn report(predicted: &Path, found: &Evaluation) -> Result<String, JudgeError> {
    let mut page = Page::new(&format!("Evaluation of {}", title(predicted)));
    let side = |side: &Numbering| format!("{} ({})", side.map.name, side.why);
    page.text(&format!(
        "{} images, judged in the classes of {}. Ids of the predictions: {}; of the ground truth: {}.",
        found.pictures,
        found.classes.name,
        side(&found.predicted),
        side(&found.truth)
    ));
    if found.unused > 0 {
        page.text(&format!("{} predictions have no ground truth and were left out.", found.unused));
    }
    let scores = [
        ("Mean IoU", &found.miou),
        ("Pixel accuracy", &found.accuracy),
        ("Mean boundary IoU", &found.boundary_miou),
        ("Panoptic quality", &found.pq),
    ];
    let fact = |(name, score): (&'static str, &Option<Estimate>)| {
        score.as_ref().map(|score| (name, format!("{} %", percent(score.value)), interval(score)))
    };
    page.facts(scores.into_iter().filter_map(fact));
    page.text("Intervals hold 95 % of sets of as many images, drawn from these.");
    by_class(&mut page, found);
    confusion(&mut page, found);
    page.section("Images by mean IoU");
    page.text("Number of images, by percent of mean IoU over the classes in each, from the number under each bar.");
    let mious = counts(found.singly.iter().filter_map(|picture| picture.miou), 10, 1.0);
    let bin = |(i, count): (usize, usize)| Bin { name: (i * 10).to_string(), all: count, part: count };
    page.plot(&histogram("Images by mean IoU", &mious.into_iter().enumerate().map(bin).collect::<Vec<_>>()));
    worst(&mut page, found)?;
    Ok(page.html())
}

fn percent(share: f64) -> String {
    format!("{:.2}", share * 100.0)
}

fn interval(Estimate { interval: [low, high], .. }: &Estimate) -> String {
    format!("{:.1} to {:.1}", low * 100.0, high * 100.0)
}

/// Bars of IoU, and a table of everything that is known of each class.
fn by_class(page: &mut Page, found: &Evaluation) {
    let (boundary, panoptic) = (found.boundary_miou.is_some(), found.pq.is_some());
    page.section("Classes");
    page.text("IoU, in the class's colour; lines are 95 % intervals.");
    let marks = [boundary.then_some(("bar", "boundary IoU")), panoptic.then_some(("val", "panoptic quality"))];
    page.key(&marks.into_iter().flatten().collect::<Vec<_>>());
    let of_class = |(i, class): (usize, &trove_model::MappedClass)| {
        let iou = found.iou[i]?;
        let bar = |score: &Option<Estimate>, fill| {
            score.map(|score| Bar { share: score.value, fill, interval: Some(score.interval) })
        };
        let scores = [
            bar(&Some(iou), Fill::Rgb(class.rgb)),
            bar(&found.boundary_iou[i], Fill::Class("bar")),
            bar(&found.class_pq[i], Fill::Class("val")),
        ];
        Some(BarRow {
            name: class.name.replace('_', " "),
            value: format!("{} % ({})", percent(iou.value), interval(&iou)),
            bars: scores.into_iter().flatten().collect(),
        })
    };
    let rows: Vec<BarRow> = found.classes.counted().enumerate().filter_map(of_class).collect();
    page.plot(&bar_rows("IoU by class", &TICKS, &rows));
    let mut columns = vec!["pixels, %", "IoU", "95 %"];
    columns.extend(boundary.then_some(["boundary IoU", "95 %"]).into_iter().flatten());
    columns.extend(panoptic.then_some(["PQ", "95 %", "SQ", "RQ"]).into_iter().flatten());
    let mut table = Table::new([Column::words("class")].into_iter().chain(columns.into_iter().map(Column::numbers)));
    let pixels = |class: usize| found.counts.confusion.pixels(class);
    let all = (0..found.iou.len()).map(pixels).sum::<u64>().max(1);
    let both = |score: &Option<Estimate>| {
        score.as_ref().map_or([String::new(), String::new()], |score| [percent(score.value), interval(score)])
    };
    for (i, class) in found.classes.counted().enumerate().filter(|(i, _)| found.iou[*i].is_some()) {
        let mut cells = vec![percent(pixels(i) as f64 / all as f64)];
        cells.extend(both(&found.iou[i]));
        if boundary {
            cells.extend(both(&found.boundary_iou[i]));
        }
        if panoptic {
            cells.extend(both(&found.class_pq[i]));
            let quality = found.counts.panoptic.quality(i);
            cells.extend(quality.map_or([String::new(), String::new()], |q| [percent(q.sq), percent(q.rq)]));
        }
        let name = Cell::colored(class.name.replace('_', " "), class.rgb);
        table.row([name].into_iter().chain(cells.into_iter().map(Into::into)));
    }
    page.table("Scores by class", &table);
}

/// A heat map of what was taken for what, and the confusions that cost most pixels.
fn confusion(page: &mut Page, found: &Evaluation) {
    let counted = &found.counts.confusion;
    let ignored = found.iou.len();
    let names: Vec<String> = found.classes.counted().map(|class| class.name.replace('_', " ")).collect();
    let name = |class: usize| names.get(class).map_or("ignored", String::as_str);
    let there: Vec<usize> = (0..ignored).filter(|class| found.iou[*class].is_some()).collect();
    let true_ones: Vec<usize> = there.iter().copied().filter(|class| counted.pixels(*class) > 0).collect();
    let is_ignored = true_ones.iter().any(|class| counted.count(*class, ignored) > 0);
    let predicted: Vec<usize> = there.iter().copied().chain(is_ignored.then_some(ignored)).collect();
    let share = |truth: usize, taken: usize| counted.count(truth, taken) as f64 / counted.pixels(truth).max(1) as f64;
    let is_numbered = predicted.len() <= MOST_NUMBERED;
    let cell = |row: usize, column: usize| {
        let (truth, taken) = (true_ones[row], predicted[column]);
        let (share, pixels) = (share(truth, taken), counted.count(truth, taken));
        (pixels > 0).then(|| HeatCell {
            share,
            text: if is_numbered && share >= 0.005 { format!("{:.0}", share * 100.0) } else { String::new() },
            more: format!("{} taken for {}: {} %, {pixels} pixels", name(truth), name(taken), percent(share)),
        })
    };
    page.section("Confusion");
    page.text("Percent of a class's pixels (row) that were taken for each class (column).");
    let [rows, columns] = [&true_ones, &predicted].map(|of| of.iter().map(|class| name(*class)).collect::<Vec<_>>());
    page.plot(&heat_map("Confusion matrix: rows are the ground truth, columns the prediction", &rows, &columns, cell));
    let pairs = true_ones.iter().flat_map(|truth| predicted.iter().map(move |taken| (*truth, *taken)));
    let mut wrong: Vec<(u64, usize, usize)> = pairs
        .filter(|(truth, taken)| truth != taken)
        .map(|(truth, taken)| (counted.count(truth, taken), truth, taken))
        .filter(|(pixels, ..)| *pixels > 0)
        .collect();
    let all: u64 = wrong.iter().map(|(pixels, ..)| pixels).sum();
    wrong.sort_by_key(|(pixels, truth, taken)| (std::cmp::Reverse(*pixels), *truth, *taken));
    let mut table = Table::new(
        [Column::words("class"), Column::words("taken for")]
            .into_iter()
            .chain(["pixels", "% of the class", "% of all errors"].map(Column::numbers)),
    );
    for (pixels, truth, taken) in wrong.into_iter().take(LISTED) {
        let shares = [share(truth, taken), pixels as f64 / all as f64].map(percent);
        let cells = [name(truth).to_owned(), name(taken).to_owned(), pixels.to_string()];
        table.row(cells.into_iter().chain(shares).map(Into::into));
    }
    if !table.is_empty() {
        page.text("The confusions that cost most pixels:");
        page.table("Largest confusions", &table);
    }
}

/// The images with the lowest mean IoU: prediction, truth and where they differ.
fn worst(page: &mut Page, found: &Evaluation) -> Result<(), JudgeError> {
    let mut order: Vec<(f64, &JudgedPicture)> =
        found.singly.iter().filter_map(|picture| Some((picture.miou?, picture))).collect();
    order.sort_by(|(a, one), (b, other)| a.total_cmp(b).then_with(|| one.name.cmp(&other.name)));
    order.truncate(SHOWN);
    page.section("Worst images");
    page.text(
        "By mean IoU over the classes in each: prediction, ground truth, where they differ (magenta; grey does not count), \
         and the image where it lies beside its labels.",
    );
    let figures = order.par_iter().map(|(miou, picture)| figure(found, picture, *miou));
    page.figures(&figures.collect::<Result<Vec<_>, _>>()?);
    Ok(())
}

fn figure(found: &Evaluation, judged: &JudgedPicture, miou: f64) -> Result<Figure, JudgeError> {
    let map = &found.classes;
    let read = |path: &Path, side: &Numbering| {
        // They were read in these numbers before.
        let numbers = side.map.in_map(map).unwrap_or([map.unlabelled; 256]);
        Ok::<_, JudgeError>(read_as(path, &side.map, map, &numbers)?.labels)
    };
    let (predicted, truth) = (read(&judged.predicted, &found.predicted)?, read(&judged.truth, &found.truth)?);
    let train_ids = map.train_ids();
    let color = |id: u8| map.class(id).filter(|class| class.train_id.is_some()).map_or(IGNORED, |class| class.rgb);
    let differ = Raster::from_fn(truth.width, truth.height, |x, y| {
        let (p, t) = (train_ids[usize::from(*predicted.at(x, y))], *truth.at(x, y));
        match train_ids[usize::from(t)] {
            None => IGNORED,
            t_id if t_id != p => WRONG,
            _ => color(t).map(|value| value / 2),
        }
    });
    let small =
        |pixels, what: &str| Picture::new(&judged.truth, pixels, WIDTH_PX, format!("{what} of {}", judged.name));
    let mut pictures = vec![
        small(predicted.map(|id| color(*id)), "Prediction")?,
        small(truth.map(|id| color(*id)), "Ground truth")?,
        small(differ, "Differences")?,
    ];
    let beside = judged.truth.with_file_name("rgb.png");
    if name(&judged.truth) == OURS && beside.is_file() {
        pictures.push(small(read_raster(&beside)?, "Image")?);
    }
    let mut caption = vec![judged.name.clone(), scores(miou, judged.accuracy)];
    caption.extend(largest(map, &Confusion::of(map, &predicted.data, &truth.data)));
    Ok(Figure { pictures, caption })
}

fn scores(miou: f64, accuracy: Option<f64>) -> String {
    let accuracy = accuracy.map(|share| format!(", pixel accuracy {} %", percent(share)));
    format!("mean IoU {} %{}", percent(miou), accuracy.unwrap_or_default())
}

/// The confusion that costs an image most pixels, in words; `None` where all are right.
fn largest(map: &ClassMap, counted: &Confusion) -> Option<String> {
    let names: Vec<String> = map.counted().map(|class| class.name.replace('_', " ")).collect();
    let pairs = (0..names.len()).flat_map(|truth| (0..=names.len()).map(move |taken| (truth, taken)));
    let wrong = pairs.filter(|(truth, taken)| truth != taken).map(|(t, p)| (counted.count(t, p), t, p));
    let (pixels, truth, taken) = wrong.max_by_key(|(pixels, ..)| *pixels).filter(|(pixels, ..)| *pixels > 0)?;
    let all: u64 = (0..names.len()).map(|class| counted.pixels(class)).sum();
    let taken = names.get(taken).map_or("an ignored id", String::as_str);
    Some(format!("{} % of it is {} taken for {taken}", percent(pixels as f64 / all as f64), names[truth]))
}
