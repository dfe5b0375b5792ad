//! Images that show something, and what the labels say.

use trove_model::Raster;

use super::finding::{Check, ENOUGH, Notes};
use super::frame::{DENSE, spread};

/// A darker mean than that is black, a brighter one blown, of 255.
const MEAN: std::ops::RangeInclusive<f64> = 2.0..=250.0;
/// Share of pixels that may be all but white.
const BLOWN: f64 = 0.6;
/// How much more an image changes where classes do than elsewhere: far less than in any photograph with its own labels.
const AT_EDGES: f64 = 1.15;
/// How far labels are moved to see whether they fit better elsewhere, pixels.
const ASIDE_PX: [i64; 3] = [6, 12, 24];
/// How much better they have to fit there.
const BETTER: f64 = 1.05;

/// Looks at an image, and at whether its edges are where those of the classes are.
pub(super) fn check<T: PartialEq>(image: &Raster<[u8; 3]>, class: Option<&Raster<T>>, notes: &mut Notes) {
    notes.look(Check::Image);
    let luma = image.map(|[r, g, b]| (u16::from(*r) * 54 + u16::from(*g) * 183 + u16::from(*b) * 19) / 256);
    let all = luma.data.len().max(1) as f64;
    let mean = luma.data.iter().map(|luma| f64::from(*luma)).sum::<f64>() / all;
    if !MEAN.contains(&mean) {
        let found = if mean < *MEAN.start() { "black" } else { "white" };
        notes.wrong(Check::Image, format!("expected an image that shows something, found one that is {found}"));
        return;
    }
    let blown = image.data.iter().filter(|rgb| rgb.iter().all(|value| *value >= 254)).count() as f64 / all;
    if blown > BLOWN {
        notes
            .wrong(Check::Image, format!("expected an image that shows something, found {:.0} % white", 100.0 * blown));
    }
    let Some(class) = class.filter(|class| (class.width, class.height) == (image.width, image.height)) else { return };
    let change = |x: u32, y: u32| {
        let across = luma.at(x - 1, y).abs_diff(*luma.at(x + 1, y)) + luma.at(x, y - 1).abs_diff(*luma.at(x, y + 1));
        u64::from(across.min(64))
    };
    let (mut edges, mut elsewhere) = (Vec::new(), (0usize, 0u64));
    for [x, y] in spread(image.width, image.height, DENSE) {
        if class.at(x - 1, y) != class.at(x + 1, y) || class.at(x, y - 1) != class.at(x, y + 1) {
            edges.push([x, y]);
        } else {
            elsewhere = (elsewhere.0 + 1, elsewhere.1 + change(x, y));
        }
    }
    if edges.len() < 8 * ENOUGH {
        return;
    }
    // How much the image changes at the classes' edges, moved by some pixels.
    let moved_by = |dx: i64, dy: i64| {
        let inside = |at: i64, size: u32| (1..i64::from(size) - 1).contains(&at).then_some(at as u32);
        let moved = edges.iter().filter_map(|[x, y]| {
            Some((inside(i64::from(*x) + dx, image.width)?, inside(i64::from(*y) + dy, image.height)?))
        });
        let (count, sum) = moved.fold((0usize, 0), |(count, sum), (x, y)| (count + 1, sum + change(x, y)));
        sum as f64 / count.max(1) as f64
    };
    let others = elsewhere.1 as f64 / elsewhere.0.max(1) as f64;
    let here = moved_by(0, 0);
    if here < AT_EDGES * others {
        let what =
            format!("expected edges where the labels have them, found {:.2} times the change there", here / others);
        notes.found(Check::Image, 1.0, what, Vec::new());
        return;
    }
    let ways = ASIDE_PX.into_iter().flat_map(|by| [(by, 0), (-by, 0), (0, by), (0, -by)]);
    let best = ways.map(|(dx, dy)| (moved_by(dx, dy), dx, dy)).max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((there, dx, dy)) = best.filter(|(there, ..)| *there > BETTER * here) {
        let what = format!(
            "expected edges where the labels have them, found {:.2} times as many ({dx}, {dy}) px aside",
            there / here
        );
        notes.found(Check::Image, 1.0, what, Vec::new());
    }
}
