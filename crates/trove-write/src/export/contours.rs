//! From pixels to the outlines of what they show.

use trove_model::Raster;

/// Pixels of one value that touch each other, corners included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Component {
    /// The value.
    pub value: u32,
    /// How many pixels.
    pub pixels: u32,
    /// Centres of the pixels along its outer edge, column and row, clockwise; those on a straight line are left out.
    pub outline: Vec<[u32; 2]>,
}

/// The eight neighbours, clockwise from the left one.
const NEIGHBOURS: [[i64; 2]; 8] = [[-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0], [1, 1], [0, 1], [-1, 1]];

/// Pixels of one value beside each other in a row.
struct Run {
    value: u32,
    y: u32,
    /// First column, and the one after the last.
    x: [u32; 2],
    /// An earlier run of the same component, or itself.
    parent: usize,
}

/// The components of an image in the order of their first pixels; values of 0 have none, nor have components of fewer than
/// `least_px` pixels.
pub(crate) fn components(values: &Raster<u32>, least_px: u32) -> Vec<Component> {
    let mut runs = runs(values);
    let mut pixels = vec![0; runs.len()];
    for i in 0..runs.len() {
        // Parents come before their children.
        runs[i].parent = runs[runs[i].parent].parent;
        pixels[runs[i].parent] += runs[i].x[1] - runs[i].x[0];
    }
    let firsts = runs.iter().enumerate().filter(|(i, run)| run.parent == *i && pixels[*i] >= least_px);
    let component = |(i, run): (usize, &Run)| {
        let outline = outline(values, [run.x[0].into(), run.y.into()]);
        Component { value: run.value, pixels: pixels[i], outline }
    };
    firsts.map(component).collect()
}

/// The runs of an image in reading order, joined with those above that they touch.
fn runs(values: &Raster<u32>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut above = 0..0;
    for (y, row) in (0..).zip(values.data.chunks(values.width.max(1) as usize)) {
        let begin = runs.len();
        let mut x = 0;
        while x < row.len() {
            let (value, first) = (row[x], x);
            while x < row.len() && row[x] == value {
                x += 1;
            }
            if value != 0 {
                let parent = runs.len();
                runs.push(Run { value, y, x: [first as u32, x as u32], parent });
            }
        }
        let mut first = above.start;
        for i in begin..runs.len() {
            let [x0, x1] = runs[i].x;
            // Corners touch too.
            while first < above.end && runs[first].x[1] < x0 {
                first += 1;
            }
            let mut other = first;
            while other < above.end && runs[other].x[0] <= x1 {
                if runs[other].value == runs[i].value {
                    let (a, b) = (root(&mut runs, other), root(&mut runs, i));
                    runs[a.max(b)].parent = a.min(b);
                }
                other += 1;
            }
        }
        above = begin..runs.len();
    }
    runs
}

/// The first run of a component; the way there becomes shorter.
fn root(runs: &mut [Run], mut i: usize) -> usize {
    while runs[i].parent != i {
        runs[i].parent = runs[runs[i].parent].parent;
        i = runs[i].parent;
    }
    i
}

/// Follows the outer edge from a component's first pixel by Moore's neighbourhood, until the first step would be repeated
/// (Jacob's criterion).
fn outline(values: &Raster<u32>, first: [i64; 2]) -> Vec<[u32; 2]> {
    let value = *values.at(first[0] as u32, first[1] as u32);
    let belongs = |[x, y]: [i64; 2]| {
        let is_inside = x >= 0 && y >= 0 && x < i64::from(values.width) && y < i64::from(values.height);
        is_inside && *values.at(x as u32, y as u32) == value
    };
    // The next pixel clockwise around `at`, seen from the neighbour that lies outside, and the way there.
    let next = |at: [i64; 2], outside: usize| {
        (1..=8).map(|turn| (outside + turn) % 8).find_map(|way| {
            let to = [at[0] + NEIGHBOURS[way][0], at[1] + NEIGHBOURS[way][1]];
            belongs(to).then_some((to, way))
        })
    };
    let Some((mut at, mut way)) = next(first, 0) else { return vec![[first[0] as u32, first[1] as u32]] };
    let first_step = (at, way);
    let mut edge = vec![(first, usize::MAX)];
    loop {
        edge.push((at, way));
        // What was looked at before the step lies outside: seen from the new pixel it is a quarter turn or more back.
        let outside = if way.is_multiple_of(2) { (way + 6) % 8 } else { (way + 5) % 8 };
        let Some(step) = next(at, outside) else { break };
        if at == first && step == first_step {
            break;
        }
        (at, way) = step;
    }
    // A pixel where the way goes straight on is between its neighbours.
    let straight = |i: usize| edge.get(i + 1).is_some_and(|(_, next)| *next == edge[i].1);
    let corners = (0..edge.len()).filter(|i| !straight(*i)).map(|i| edge[i].0.map(|c| c as u32));
    let mut corners: Vec<[u32; 2]> = corners.collect();
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&str]) -> Vec<Component> {
        let values = Raster::from_fn(rows[0].len() as u32, rows.len() as u32, |x, y| {
            u32::from(rows[y as usize].as_bytes()[x as usize] - b'0')
        });
        components(&values, 1)
    }

    #[test]
    fn outlines_go_around_the_pixels_of_one_value() {
        let found = of(&["00000", "01110", "01110", "00002"]);
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(found[0], Component { value: 1, pixels: 6, outline: vec![[1, 1], [3, 1], [3, 2], [1, 2]] });
        assert_eq!(found[1], Component { value: 2, pixels: 1, outline: vec![[4, 3]] });
        // Arms one pixel wide are walked along and back; corners that touch belong together.
        let found = of(&["1010", "0100", "1010"]);
        assert_eq!((found.len(), found[0].pixels), (1, 5));
        let mut ends = found[0].outline.clone();
        ends.sort_unstable();
        ends.dedup();
        assert_eq!(ends, [[0, 0], [0, 2], [1, 1], [2, 0], [2, 2]]);
        assert_eq!(of(&["111", "101", "111"])[0].outline, [[0, 0], [2, 0], [2, 2], [0, 2]], "holes are not followed");
    }

    #[test]
    fn painting_the_outlines_from_the_largest_to_the_smallest_gives_the_picture_back() {
        // Blots of three values, from a small generator of numbers.
        let mut state = 7u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 16
        };
        let mut values = Raster::filled(80, 60, 0u32);
        for _ in 0..60 {
            let (x, y, r, value) = (random() % 80, random() % 60, 2 + random() % 9, 1 + random() % 3);
            for (px, py) in (0..60_u32).flat_map(|py| (0..80_u32).map(move |px| (px, py))) {
                if px.abs_diff(x).pow(2) + py.abs_diff(y).pow(2) < r * r {
                    *values.at_mut(px, py) = value;
                }
            }
        }
        // The empty pixels are a value too, so that holes are painted.
        let values = values.map(|v| v + 1);
        let mut found = components(&values, 1);
        let filled = |c: &Component| inside(&c.outline, 80, 60);
        found.sort_by_key(|c| std::cmp::Reverse(filled(c).iter().filter(|p| **p).count()));
        let mut painted = vec![0; 80 * 60];
        for component in &found {
            for (pixel, is_in) in painted.iter_mut().zip(filled(component)) {
                if is_in {
                    *pixel = component.value;
                }
            }
        }
        let wrong = painted.iter().zip(&values.data).filter(|(a, b)| a != b).count();
        assert!(wrong * 200 < painted.len(), "{wrong} of {}", painted.len());
    }

    /// Pixels whose centres lie in a polygon or on its edge.
    fn inside(outline: &[[u32; 2]], width: u32, height: u32) -> Vec<bool> {
        let corners: Vec<[f64; 2]> = outline.iter().map(|c| c.map(f64::from)).collect();
        let edges = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
        let pixel = |x: f64, y: f64| {
            let on = edges().any(|(a, b)| {
                let cross = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
                let within = |v: f64, i: usize| v >= a[i].min(b[i]) && v <= a[i].max(b[i]);
                cross == 0.0 && within(x, 0) && within(y, 1)
            });
            let crossings = edges()
                .filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]));
            on || crossings.count() % 2 == 1
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x.into(), y.into())).collect()
    }
}
