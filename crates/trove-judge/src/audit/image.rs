//! Images that show something, and what the labels say.

use trove_model::Raster;

use super::finding::{Check, ENOUGH, Notes};
use super::frame::grid;

/// A darker mean than that is black, a brighter one blown, of 255.
const MEAN: std::ops::RangeInclusive<f64> = 2.0..=250.0;
/// Share of pixels that may be all but white.
const BLOWN: f64 = 0.6;
/// How much more an image changes where classes do than elsewhere: far less than in any photograph with its own labels.
const AT_EDGES: f64 = 1.15;

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
        notes.wrong(Check::Image, format!("expected an image that shows something, found {:.0} % white", 100.0 * blown));
    }
    let Some(class) = class.filter(|class| (class.width, class.height) == (image.width, image.height)) else { return };
    let (mut at_edges, mut elsewhere) = ((0usize, 0u64), (0usize, 0u64));
    for [x, y] in grid(image.width, image.height, 1) {
        let change = luma.at(x - 1, y).abs_diff(*luma.at(x + 1, y)) + luma.at(x, y - 1).abs_diff(*luma.at(x, y + 1));
        let is_edge = class.at(x - 1, y) != class.at(x + 1, y) || class.at(x, y - 1) != class.at(x, y + 1);
        let (count, sum) = if is_edge { &mut at_edges } else { &mut elsewhere };
        *count += 1;
        *sum += u64::from(change.min(64));
    }
    let mean = |(count, sum): (usize, u64)| sum as f64 / count.max(1) as f64;
    let (edges, others) = (mean(at_edges), mean(elsewhere));
    if at_edges.0 >= 20 * ENOUGH && edges < AT_EDGES * others {
        let what = format!("expected edges where the labels have them, found {:.2} times the change there", edges / others);
        notes.found(Check::Image, 1.0, what, Vec::new());
    }
}
