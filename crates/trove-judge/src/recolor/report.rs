//! A page that shows what recolouring did: images before and after, means by class, and histograms.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use trove_model::ClassMap;

use super::histogram::{Histograms, value};
use super::space::Space;
use super::statistics::Statistics;
use super::{Measures, Method, Recoloring, Settings, drawn, ids, in_space, own_classes, own_labels, with_labels};
use crate::JudgeError;
use crate::page::plots::{Plot, curves};
use crate::page::{Cell, Column, Figure, Page, Picture, Table};
use crate::pictures::{each, photographs, read, read_raster, title};

/// Images that are shown, and the width of each, pixels.
const SHOWN: usize = 24;
const WIDTH_PX: u32 = 320;
/// Images of a side that are counted: more would hardly change means or histograms.
const COUNTED: usize = 200;
/// Points of a curve, and the share of the pixels at either end that is left out.
const POINTS: usize = 64;
const LEFT_OUT: f64 = 1e-3;
/// What is of no class in particular.
const WHOLE: u8 = 0;
const SIDES: [(&str, &str); 3] = [("before", "before"), ("target", "target"), ("after", "after")];

/// The page, as HTML, of what [`recolor`](super::recolor) did to the pictures below `source` with the same settings.
///
/// # Errors
/// A picture that can no longer be read, or labels of the target that are missing or do not fit.
pub fn report(source: &Path, target: &Path, settings: &Settings, done: &Recoloring) -> Result<String, JudgeError> {
    let targets = photographs(target)?;
    let mut page = Page::new(&format!("Colours of {}", title(source)));
    let method = match settings.method {
        Method::PerPicture => "mean and deviation of each image",
        Method::Paired => "mean and deviation of each image, towards one image of the target",
        Method::PerSet => "mean and deviation of the whole set",
        Method::HistogramPerClass => "histograms class by class",
    };
    let detail = if settings.detail { ", and sharpness" } else { "" };
    page.text(&format!(
        "{} images, towards the colours of {} in {}: {method}{detail}, with strength {}.",
        done.pictures.len(),
        targets.len(),
        title(target),
        settings.strength
    ));
    let space = settings.space;
    page.section("Colours of all pixels");
    page.text(&format!("Mean ± standard deviation; the patch has the mean colour. {}", told(space)));
    page.text(
        "Sharpness is how strong details of 2 to 4 and of 4 to 8 pixels are beside those of 8 to 16, in lightness.",
    );
    let columns = channels(space).into_iter().chain(["sharpness"]).map(Column::numbers);
    let mut table = Table::new([Column::words("side")].into_iter().chain(columns));
    for ((_, name), Measures { colors, detail }) in SIDES.iter().zip(&done.measures) {
        let (mean, deviation) = (colors.mean(), colors.deviation());
        let cells =
            [0, 1, 2].map(|c| Cell::from(format!("{} ± {}", number(mean[c], space), number(deviation[c], space))));
        let sharpness = detail.sharpness().map(|octaves| octaves.map(|octave| format!("{octave:.2}")).join(", "));
        let sharpness = Cell::from(sharpness.unwrap_or_default());
        table.row([Cell::colored(*name, color(mean, space))].into_iter().chain(cells).chain([sharpness]));
    }
    page.table("Colours of all pixels", &table);

    let classes = match &settings.target_labels {
        Some((_, set)) => Some(set.clone()),
        None => ClassMap::named("trove20"),
    };
    let is_labelled = done.pictures.iter().all(|(_, before)| own_labels(before).is_file());
    let set = classes.as_ref().filter(|_| is_labelled);
    let some = thinned(&done.pictures, COUNTED);
    let before = counted(&some, space, |(_, before)| (before, set.map(|set| Labels::Own(before, set))))?;
    let after = counted(&some, space, |(after, before)| (after, set.map(|set| Labels::Own(before, set))))?;
    let wanted = match (&settings.target_labels, set) {
        (Some((folder, set)), Some(_)) => {
            let pairs = with_labels(target, &targets, folder, set)?;
            counted(&thinned(&pairs, COUNTED), space, |(picture, labels)| (picture, Some(Labels::File(labels))))?
        }
        _ => counted(&thinned(&targets, COUNTED), space, |picture| (picture, None))?,
    };
    let sides = [&before, &wanted, &after];
    if let Some(set) = set {
        by_class(&mut page, set, sides, space);
    }
    page.section("Histograms");
    page.text(&format!("Share of pixels by L*, a* and b* (CIE 1976), of at most {COUNTED} images of each side."));
    page.key(&SIDES);
    page.plots(&[0, 1, 2].map(|channel| plot(channel, sides.map(|side| &side.histograms))));

    page.section("Before and after");
    let pairs =
        if settings.method == Method::Paired { ", and the image of the target that it was drawn towards" } else { "" };
    page.text(&format!("Left before, right after{pairs}."));
    let figure = |(after, before): &(PathBuf, PathBuf)| {
        let below = before.strip_prefix(source).unwrap_or(before);
        let small = |path: &Path, what: &str| {
            Picture::new(path, read_raster(path)?, WIDTH_PX, format!("{} {what}", below.display()))
        };
        let mut pictures = vec![small(before, "before")?, small(after, "after")?];
        if settings.method == Method::Paired {
            pictures.push(small(&targets[drawn(below, targets.len())], "is drawn towards this image")?);
        }
        Ok(Figure { pictures, caption: vec![below.display().to_string()] })
    };
    page.figures(&each(&thinned(&done.pictures, SHOWN), &|_, _| true, figure)?);
    page.section("Target");
    let figure = |path: &PathBuf| {
        let below = path.strip_prefix(target).unwrap_or(path).display().to_string();
        let picture = Picture::new(path, read_raster(path)?, WIDTH_PX, format!("{below} of the target"))?;
        Ok(Figure { pictures: vec![picture], caption: vec![below] })
    };
    page.figures(&each(&thinned(&targets, SHOWN), &|_, _| true, figure)?);
    Ok(page.html())
}

/// As many of them as are wanted, spread evenly.
fn thinned<T: Clone>(all: &[T], most: usize) -> Vec<T> {
    all.iter().step_by(all.len().div_ceil(most).max(1)).cloned().collect()
}

fn channels(space: Space) -> [&'static str; 3] {
    match space {
        Space::Lab => ["L*", "a*", "b*"],
        Space::LAlphaBeta => ["l", "α", "β"],
    }
}

fn told(space: Space) -> &'static str {
    match space {
        Space::Lab => "CIE 1976 L*a*b* under D65.",
        Space::LAlphaBeta => "lαβ of Reinhard et al. 2001.",
    }
}

/// lαβ are logarithms: a tenth is much.
fn number(value: f64, space: Space) -> String {
    let text = match space {
        Space::Lab => format!("{value:.1}"),
        Space::LAlphaBeta => format!("{value:.3}"),
    };
    // Nothing has no sign.
    text.strip_prefix('-').filter(|rest| rest.bytes().all(|b| b"0.".contains(&b))).map(str::to_owned).unwrap_or(text)
}

fn color(mean: [f64; 3], space: Space) -> [u8; 3] {
    space.to_srgb(mean.map(|channel| channel as f32))
}

/// Where a picture's classes are.
enum Labels<'a> {
    /// Beside one of our own pictures, as numbers of a set.
    Own(&'a Path, &'a ClassMap),
    File(&'a Path),
}

/// What is counted of a side.
#[derive(Default)]
struct Colors {
    /// In L\*a\*b\*, of all pixels.
    histograms: Histograms,
    /// In the space that colours are moved in.
    classes: BTreeMap<u8, Statistics>,
    /// Pixels by class.
    pixels: BTreeMap<u8, usize>,
}

/// Counts pictures, those of which classes are known by class too.
fn counted<'a, T: Sync>(
    items: &'a [T],
    space: Space,
    of: impl Fn(&'a T) -> (&'a PathBuf, Option<Labels<'a>>) + Sync,
) -> Result<Colors, JudgeError> {
    let one = |item: &&'a T| {
        let (path, labels) = of(item);
        let picture = read(path)?.into_rgb8();
        let mut found = Colors::default();
        let lab = in_space(&picture, Space::Lab);
        found.histograms.count(&lab, &vec![WHOLE; lab.len()]);
        let classes = match labels {
            Some(Labels::Own(beside, set)) => own_classes(beside, &picture, set)?,
            Some(Labels::File(labels)) => ids(labels, &picture)?,
            None => return Ok(found),
        };
        let mut by_class = BTreeMap::<u8, Vec<[f32; 3]>>::new();
        let pixels = if space == Space::Lab { lab } else { in_space(&picture, space) };
        for (pixel, class) in pixels.into_iter().zip(classes).filter(|(_, class)| *class != Histograms::NONE) {
            by_class.entry(class).or_default().push(pixel);
        }
        found.classes = by_class.iter().map(|(class, pixels)| (*class, Statistics::of(pixels))).collect();
        found.pixels = by_class.into_iter().map(|(class, pixels)| (class, pixels.len())).collect();
        Ok(found)
    };
    let mut all = Colors::default();
    for one in each(&items.iter().collect::<Vec<_>>(), &|_, _| true, one)? {
        all.histograms.join(&one.histograms);
        one.classes.iter().for_each(|(class, statistics)| all.classes.entry(*class).or_default().join(statistics));
        one.pixels.iter().for_each(|(class, pixels)| *all.pixels.entry(*class).or_default() += pixels);
    }
    Ok(all)
}

/// A table of the classes' mean colours, and how far they are from the target's.
fn by_class(page: &mut Page, set: &ClassMap, [before, target, after]: [&Colors; 3], space: Space) {
    let is_labelled = !target.classes.is_empty();
    page.section("Mean colours by class");
    let [l, a, b] = channels(space);
    let distances = if is_labelled { " Distances are between these means and the target's." } else { "" };
    page.text(&format!("{l}, {a}, {b}, of at most {COUNTED} images of each side.{distances}"));
    let mut columns = vec!["pixels, %", "before", "after"];
    columns.extend(is_labelled.then_some(["target", "away before", "away after"]).into_iter().flatten());
    let mut table = Table::new([Column::words("class")].into_iter().chain(columns.into_iter().map(Column::numbers)));
    let all = before.pixels.values().sum::<usize>().max(1);
    for (id, own) in &before.classes {
        let Some(class) = set.class(*id) else { continue };
        let mean = |side: &Colors| side.classes.get(id).map(Statistics::mean);
        let cell = |mean: Option<[f64; 3]>| match mean {
            Some(mean) => Cell::colored(mean.map(|value| number(value, space)).join(", "), color(mean, space)),
            None => Cell::from(""),
        };
        let share = before.pixels[id] as f64 / all as f64 * 100.0;
        let mut cells = vec![
            Cell::colored(class.name.replace('_', " "), class.rgb),
            Cell::from(format!("{share:.2}")),
            cell(Some(own.mean())),
            cell(mean(after)),
        ];
        if is_labelled {
            let away = |side: &Colors| {
                let (mean, wanted) = (mean(side)?, mean(target)?);
                let squares = mean.iter().zip(wanted).map(|(a, b)| (a - b).powi(2));
                Some(number(squares.sum::<f64>().sqrt(), space))
            };
            cells.push(cell(mean(target)));
            cells.extend([before, after].map(|side| Cell::from(away(side).unwrap_or_default())));
        }
        table.row(cells);
    }
    page.table("Mean colours by class", &table);
}

/// Histograms of a channel, over the range that most pixels of some side are in.
fn plot(channel: usize, sides: [&Histograms; 3]) -> Plot {
    let shares = sides.map(|side| side.shares(WHOLE, channel));
    let bins = shares[0].len();
    let end = |shares: &Vec<f64>, from_above: bool| {
        let at = |i: usize| if from_above { bins - 1 - i } else { i };
        let mut below = 0.0;
        let is_left_out = |i: &usize| {
            below += shares[at(*i)];
            below < LEFT_OUT
        };
        at((0..bins).take_while(is_left_out).count().min(bins - 1))
    };
    let low = shares.iter().map(|side| end(side, false)).min().unwrap_or(0);
    let high = shares.iter().map(|side| end(side, true)).max().unwrap_or(bins - 1).max(low);
    let width = (high + 1 - low).div_ceil(POINTS);
    let length = (high + 1 - low).div_ceil(width) * width;
    let low = low.min(bins - length);
    let high = low + length;
    let point = |shares: &Vec<f64>| -> Vec<f64> {
        (low..high).step_by(width).map(|i| shares[i..i + width].iter().sum()).collect()
    };
    let range = [low, high].map(|bin| f64::from(value(channel, bin as f32)));
    let drawn: Vec<_> = SIDES.iter().zip(&shares).map(|((class, _), shares)| (*class, point(shares))).collect();
    curves(channels(Space::Lab)[channel], range, &drawn)
}
