//! Which classes were taken for which.

use trove_model::ClassMap;

use super::mean::mean;

/// Counts of pixels by what they are (rows) and what they were taken for (columns); the last column holds predictions
/// that are ignored numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confusion {
    /// Number of classes.
    classes: usize,
    /// `classes` rows of `classes + 1`.
    counts: Vec<u64>,
}

impl Confusion {
    /// Nothing counted yet.
    pub fn new(classes: usize) -> Self {
        Self { classes, counts: vec![0; classes * (classes + 1)] }
    }

    /// Counts pixel by pixel; pixels whose truth is ignored are left out, as cityscapesScripts does.
    pub fn of(map: &ClassMap, predicted: &[u8], truth: &[u8]) -> Self {
        // A table of all pairs of numbers first: a pixel then costs one look-up.
        let mut pairs = vec![0u32; 256 * 256];
        for (&p, &t) in predicted.iter().zip(truth) {
            pairs[usize::from(t) << 8 | usize::from(p)] += 1;
        }
        let (index, mut confusion) = (map.train_ids(), Self::new(map.counted().count()));
        for (pair, count) in pairs.into_iter().enumerate().filter(|(_, count)| *count > 0) {
            if let Some(t) = index[pair >> 8] {
                let p = index[pair & 255].map_or(confusion.classes, usize::from);
                confusion.counts[usize::from(t) * (confusion.classes + 1) + p] += u64::from(count);
            }
        }
        confusion
    }

    /// Adds another's counts.
    pub fn add(&mut self, other: &Self) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(a, b)| *a += b);
    }

    /// How many pixels of one class were taken for another; `predicted` equal to the number of classes means ignored.
    pub fn count(&self, truth: usize, predicted: usize) -> u64 {
        self.counts[truth * (self.classes + 1) + predicted]
    }

    /// Pixels of a class.
    pub fn pixels(&self, truth: usize) -> u64 {
        (0..=self.classes).map(|p| self.count(truth, p)).sum()
    }

    /// Intersection over union of a class; `None` where it is neither there nor predicted.
    pub fn iou(&self, class: usize) -> Option<f64> {
        let both = self.count(class, class);
        let predicted: u64 = (0..self.classes).map(|t| self.count(t, class)).sum();
        let union = self.pixels(class) + predicted - both;
        (union > 0).then(|| both as f64 / union as f64)
    }

    /// Mean IoU over the classes that are there or predicted; `None` without any.
    pub fn miou(&self) -> Option<f64> {
        mean((0..self.classes).map(|class| self.iou(class)))
    }

    /// Share of pixels that were predicted rightly; `None` without any.
    pub fn accuracy(&self) -> Option<f64> {
        let all: u64 = (0..self.classes).map(|t| self.pixels(t)).sum();
        let right: u64 = (0..self.classes).map(|c| self.count(c, c)).sum();
        (all > 0).then(|| right as f64 / all as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ious_are_those_of_a_picture_counted_by_hand() {
        let map = ClassMap::named("camvid").unwrap();
        // Of four sky pixels (0) one is called road (3), one is called unlabelled (11); of two road pixels one sky.
        let truth = [0, 0, 0, 0, 3, 3, 11, 200];
        let predicted = [0, 0, 3, 11, 3, 0, 0, 0];
        let confusion = Confusion::of(&map, &predicted, &truth);
        assert_eq!(
            (confusion.count(0, 0), confusion.count(0, 3), confusion.count(0, 11), confusion.count(3, 0)),
            (2, 1, 1, 1)
        );
        assert_eq!(confusion.iou(0), Some(2.0 / 5.0));
        assert_eq!(confusion.iou(3), Some(1.0 / 3.0));
        assert_eq!(confusion.iou(1), None);
        assert_eq!(confusion.miou(), Some((2.0 / 5.0 + 1.0 / 3.0) / 2.0));
        assert_eq!(confusion.accuracy(), Some(0.5));
        assert_eq!(Confusion::new(11).miou(), None);
    }
}
