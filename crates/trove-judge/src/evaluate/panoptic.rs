//! Panoptic quality (Kirillov et al. 2019, Panoptic Segmentation).

use std::collections::BTreeMap;

use trove_model::ClassMap;

use super::mean::mean;

/// A segment's number: class in the upper half, object in the lower; `None` for ignored pixels.
pub(super) type Segment = Option<u32>;

/// Sums of a class's matches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    iou: f64,
    matched: u64,
    missed: u64,
    invented: u64,
}

/// Panoptic quality by class.
#[derive(Clone, Debug, PartialEq)]
pub struct Panoptic {
    classes: Vec<Sums>,
}

/// What the segments of a class are worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Panoptic quality: the product of the other two.
    pub pq: f64,
    /// Segmentation quality: mean IoU of those matched.
    pub sq: f64,
    /// Recognition quality: F1 score of the matching.
    pub rq: f64,
}

impl Panoptic {
    /// Nothing counted yet.
    pub fn new(classes: usize) -> Self {
        Self { classes: vec![Sums::default(); classes] }
    }

    /// Matches the segments of one picture: two of a class match where they overlap by more than half of their union,
    /// ignored pixels left out. True objects without a number are a crowd, which need not be found. Predictions that
    /// lie for more than half on ignored pixels or a crowd of their class are not counted.
    pub(super) fn of(map: &ClassMap, predicted: &[Segment], truth: &[Segment]) -> Self {
        let mut shared: BTreeMap<(Segment, Segment), u64> = BTreeMap::new();
        let (mut of_predicted, mut of_truth) = (BTreeMap::<u32, u64>::new(), BTreeMap::<u32, u64>::new());
        // Neighbouring pixels mostly are of the same pair: runs are counted at once.
        let mut pixels = predicted.iter().zip(truth).peekable();
        while let Some(pair) = pixels.next() {
            let mut run = 1;
            while pixels.next_if_eq(&pair).is_some() {
                run += 1;
            }
            *shared.entry((*pair.1, *pair.0)).or_default() += run;
            pair.0.iter().for_each(|p| *of_predicted.entry(*p).or_default() += run);
            pair.1.iter().for_each(|t| *of_truth.entry(*t).or_default() += run);
        }
        let overlap = |t: Segment, p: u32| shared.get(&(t, Some(p))).copied().unwrap_or(0);
        let class = |segment: u32| (segment >> 16) as usize;
        let things: Vec<bool> = map.counted().map(|class| class.thing).collect();
        let crowd = |segment: u32| things[class(segment)] && segment & 0xffff == 0;
        let mut found = Self::new(map.counted().count());
        for (&pair, &both) in &shared {
            let (Some(t), Some(p)) = pair else { continue };
            if class(t) != class(p) || crowd(t) {
                continue;
            }
            // A segment that has a match overlaps no other by so much.
            let (Some(predicted), Some(truth)) = (of_predicted.get(&p), of_truth.get(&t)) else { continue };
            let union = predicted + truth - both - overlap(None, p);
            if 2 * both > union {
                found.classes[class(t)].iou += both as f64 / union as f64;
                found.classes[class(t)].matched += 1;
                of_predicted.remove(&p);
                of_truth.remove(&t);
            }
        }
        // What is left has no match.
        of_truth.keys().filter(|t| !crowd(**t)).for_each(|t| found.classes[class(*t)].missed += 1);
        for (p, area) in of_predicted {
            let crowded = if things[class(p)] { overlap(Some(p >> 16 << 16), p) } else { 0 };
            if 2 * (overlap(None, p) + crowded) <= area {
                found.classes[class(p)].invented += 1;
            }
        }
        found
    }

    /// Adds another's sums.
    pub fn add(&mut self, other: &Self) {
        for (own, sums) in self.classes.iter_mut().zip(&other.classes) {
            own.iou += sums.iou;
            own.matched += sums.matched;
            own.missed += sums.missed;
            own.invented += sums.invented;
        }
    }

    /// Quality of a class (by its place in the set); `None` where it is neither there nor predicted.
    pub fn quality(&self, class: usize) -> Option<Quality> {
        let Sums { iou, matched, missed, invented } = self.classes[class];
        let all = matched as f64 + 0.5 * invented as f64 + 0.5 * missed as f64;
        let sq = if matched > 0 { iou / matched as f64 } else { 0.0 };
        (all > 0.0).then(|| Quality { pq: iou / all, sq, rq: matched as f64 / all })
    }

    /// Mean panoptic quality of the classes that are there or predicted; `None` without any.
    pub fn mean(&self) -> Option<f64> {
        mean((0..self.classes.len()).map(|class| Some(self.quality(class)?.pq)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(class: u32, object: u32) -> Segment {
        Some(class << 16 | object)
    }

    fn quality(predicted: &[Segment], truth: &[Segment], class: usize) -> Option<[f64; 3]> {
        let map = ClassMap::named("camvid").unwrap();
        Panoptic::of(&map, predicted, truth).quality(class).map(|q| [q.pq, q.sq, q.rq])
    }

    #[test]
    fn segments_match_by_more_than_half_and_others_are_missed_or_invented() {
        // Two cars (8): one of four pixels found in three, one of two missed; sky (0) of three with one pixel too many.
        let (first, second, sky) = (segment(8, 1), segment(8, 2), segment(0, 0));
        let truth = [first, first, first, first, second, second, sky, sky, sky, None];
        let predicted = [segment(8, 7), segment(8, 7), segment(8, 7), sky, segment(8, 9), sky, sky, sky, sky, sky];
        // Cars: one match with IoU 3/4; car 2 and prediction 9 share 1 of 2, which is not more than half.
        assert_eq!(quality(&predicted, &truth, 8), Some([0.75 * 0.5, 0.75, 0.5]));
        assert_eq!(quality(&predicted, &truth, 0), Some([0.6, 0.6, 1.0]));
        assert_eq!(quality(&predicted, &truth, 3), None);
    }

    #[test]
    fn a_segment_that_covers_two_matches_one_of_them() {
        // A prediction of both cars, and one car that is predicted as two.
        let [first, second] = [1, 2].map(|object| segment(8, object));
        assert_eq!(quality(&[first; 4], &[first, first, first, second], 8), Some([0.75 / 1.5, 0.75, 1.0 / 1.5]));
        assert_eq!(quality(&[first, first, first, second], &[first; 4], 8), Some([0.75 / 1.5, 0.75, 1.0 / 1.5]));
    }

    #[test]
    fn what_lies_on_ignored_pixels_or_a_crowd_counts_neither_way() {
        let (car, crowd) = (segment(8, 1), segment(8, 0));
        // A prediction with two of its three pixels on what is ignored, and one with all on a crowd.
        let truth = [None, None, segment(0, 0), crowd, crowd, car, car];
        let predicted = [segment(8, 3), segment(8, 3), segment(8, 3), segment(8, 4), segment(8, 4), car, car];
        assert_eq!(quality(&predicted, &truth, 8), Some([1.0; 3]));
        // Half is not more than half.
        assert_eq!(quality(&predicted[1..], &truth[1..], 8), Some([2.0 / 3.0, 1.0, 2.0 / 3.0]));
    }
}
