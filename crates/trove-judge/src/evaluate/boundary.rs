//! Boundary IoU (Cheng et al. 2021, Boundary IoU: Improving Object-Centric Image Segmentation Evaluation).

use trove_model::ClassMap;

use super::mean::mean;

/// Width of the band along outlines as a share of the picture's diagonal, as in the paper.
const BAND: f64 = 0.02;

/// Pixels in the bands of both, and in the band of either, by class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Boundary {
    /// By class: both, either.
    counts: Vec<[u64; 2]>,
}

impl Boundary {
    /// Nothing counted yet.
    pub fn new(classes: usize) -> Self {
        Self { counts: vec![[0; 2]; classes] }
    }

    /// Compares the bands inside the outlines of every class; pixels whose truth is ignored belong to no prediction.
    pub fn of(map: &ClassMap, predicted: &[u8], truth: &[u8], width: usize) -> Self {
        let index = map.train_ids();
        let height = truth.len().checked_div(width).unwrap_or(0);
        let diagonal_px = (width as f64).hypot(height as f64);
        let reach = ((BAND * diagonal_px).round() as usize).max(1);
        let truth: Vec<Option<u8>> = truth.iter().map(|t| index[usize::from(*t)]).collect();
        let seen = |(p, t): (&u8, &Option<u8>)| t.and(index[usize::from(*p)]);
        let predicted: Vec<Option<u8>> = predicted.iter().zip(&truth).map(seen).collect();
        let bands = [&predicted, &truth].map(|labels| band(labels, width, reach));
        let mut counts = vec![[0; 2]; map.counted().count()];
        for (p, t) in bands[0].iter().zip(&bands[1]) {
            for class in [p, t].into_iter().flatten() {
                counts[usize::from(*class)][1] += 1;
            }
            if let (Some(p), Some(t)) = (p, t)
                && p == t
            {
                // It was counted for both.
                counts[usize::from(*p)][0] += 1;
                counts[usize::from(*p)][1] -= 1;
            }
        }
        Self { counts }
    }

    /// Adds another's counts.
    pub fn add(&mut self, other: &Self) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(a, b)| (0..2).for_each(|i| a[i] += b[i]));
    }

    /// Boundary IoU of a class; `None` where it has no outline in either.
    pub fn iou(&self, class: usize) -> Option<f64> {
        let [both, either] = self.counts[class];
        (either > 0).then(|| both as f64 / either as f64)
    }

    /// Mean over the classes that have an outline; `None` without any.
    pub fn miou(&self) -> Option<f64> {
        mean((0..self.counts.len()).map(|class| self.iou(class)))
    }
}

/// The labels of pixels that are within `reach` of another label or of the picture's edge (in chessboard distance, as
/// repeated 3 × 3 erosion measures it); `None` elsewhere.
fn band(labels: &[Option<u8>], width: usize, reach: usize) -> Vec<Option<u8>> {
    let side = 2 * reach + 1;
    let mut inside = vec![false; labels.len()];
    // A pixel is deep inside where a square around it is of its label: rows first, where runs are counted ...
    for (row, inside) in labels.chunks(width).zip(inside.chunks_mut(width)) {
        let mut run = 0;
        for x in 0..width {
            run = if x > 0 && row[x] == row[x - 1] { run + 1 } else { 1 };
            if run >= side {
                inside[x - reach] = true;
            }
        }
    }
    // ... then columns of such rows.
    let mut runs = vec![0usize; width];
    let mut deep = vec![false; labels.len()];
    for y in 0..labels.len().checked_div(width).unwrap_or(0) {
        for (x, run) in runs.iter_mut().enumerate() {
            let at = y * width + x;
            let goes_on = *run > 0 && labels[at] == labels[at - width];
            *run = if !inside[at] {
                0
            } else if goes_on {
                *run + 1
            } else {
                1
            };
            if *run >= side {
                deep[at - reach * width] = true;
            }
        }
    }
    labels.iter().zip(deep).map(|(label, deep)| label.filter(|_| !deep)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The band by looking at the square around every pixel.
    fn slow(labels: &[Option<u8>], width: usize, reach: usize) -> Vec<Option<u8>> {
        let (w, h, r) = (width as i64, (labels.len() / width) as i64, reach as i64);
        let alike = |x: i64, y: i64, label: Option<u8>| {
            (0..w).contains(&x) && (0..h).contains(&y) && labels[(y * w + x) as usize] == label
        };
        let pixel = |i: i64| {
            let (x, y, label) = (i % w, i / w, labels[i as usize]);
            let deep = (-r..=r).all(|dy| (-r..=r).all(|dx| alike(x + dx, y + dy, label)));
            label.filter(|_| !deep)
        };
        (0..labels.len() as i64).map(pixel).collect()
    }

    proptest! {
        #[test]
        fn bands_are_those_of_squares(cells in prop::collection::vec(0u8..3, 12), reach in 1usize..3) {
            // Blocks of 5 × 4 pixels, so that there is an inside.
            let labels: Vec<Option<u8>> =
                (0..20 * 12).map(|i| Some(cells[(i / 20 / 4) * 4 + (i % 20) / 5]).filter(|c| *c < 2)).collect();
            prop_assert_eq!(band(&labels, 20, reach), slow(&labels, 20, reach));
        }
    }

    #[test]
    fn the_same_outlines_give_one_and_others_less() {
        let map = ClassMap::named("camvid").unwrap();
        let half = |edge: usize| -> Vec<u8> { (0..200 * 100).map(|i| if i % 200 < edge { 0 } else { 3 }).collect() };
        let same = Boundary::of(&map, &half(100), &half(100), 200);
        assert_eq!((same.iou(0), same.iou(3), same.iou(1)), (Some(1.0), Some(1.0), None));
        let moved = Boundary::of(&map, &half(102), &half(100), 200);
        assert!(moved.iou(0).unwrap() < 0.98);
    }
}
