//! Panoptic quality (Kirillov et al. 2019, Panoptic Segmentation).

use std::collections::BTreeMap;

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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panoptic {
    classes: BTreeMap<usize, Sums>,
}

impl Panoptic {
    /// Matches the segments of one picture: two match where they overlap by more than half of their union. Pixels whose
    /// truth is ignored belong to no prediction.
    pub(super) fn of(predicted: &[Segment], truth: &[Segment]) -> Self {
        let mut shared: BTreeMap<(u32, u32), u64> = BTreeMap::new();
        let (mut of_predicted, mut of_truth) = (BTreeMap::<u32, u64>::new(), BTreeMap::<u32, u64>::new());
        // Neighbouring pixels mostly are of the same pair: runs are counted at once.
        let mut pixels = predicted.iter().zip(truth).peekable();
        while let Some(pair) = pixels.next() {
            let mut run = 1;
            while pixels.next_if_eq(&pair).is_some() {
                run += 1;
            }
            let (p, Some(t)) = pair else { continue };
            *of_truth.entry(*t).or_default() += run;
            if let Some(p) = p {
                *of_predicted.entry(*p).or_default() += run;
                *shared.entry((*p, *t)).or_default() += run;
            }
        }
        let mut classes: BTreeMap<usize, Sums> = BTreeMap::new();
        for (&(p, t), &both) in &shared {
            let union = of_predicted[&p] + of_truth[&t] - both;
            if p >> 16 == t >> 16 && 2 * both > union {
                let sums = classes.entry((t >> 16) as usize).or_default();
                sums.iou += both as f64 / union as f64;
                sums.matched += 1;
            }
        }
        let count = |segments: &BTreeMap<u32, u64>, class: usize| {
            segments.keys().filter(|segment| (**segment >> 16) as usize == class).count() as u64
        };
        let there = of_truth.keys().chain(of_predicted.keys()).map(|segment| (segment >> 16) as usize);
        for class in there.collect::<std::collections::BTreeSet<_>>() {
            let sums = classes.entry(class).or_default();
            sums.missed = count(&of_truth, class) - sums.matched;
            sums.invented = count(&of_predicted, class) - sums.matched;
        }
        Self { classes }
    }

    /// Adds another's sums.
    pub fn add(&mut self, other: &Self) {
        for (class, sums) in &other.classes {
            let own = self.classes.entry(*class).or_default();
            own.iou += sums.iou;
            own.matched += sums.matched;
            own.missed += sums.missed;
            own.invented += sums.invented;
        }
    }

    /// Panoptic, segmentation and recognition quality of a class (by its place in the set); `None` where it is in neither.
    pub fn quality(&self, class: usize) -> Option<[f64; 3]> {
        let sums = self.classes.get(&class)?;
        let recognition = sums.matched as f64 / (sums.matched as f64 + 0.5 * (sums.missed + sums.invented) as f64);
        let segmentation = if sums.matched > 0 { sums.iou / sums.matched as f64 } else { 0.0 };
        recognition.is_finite().then_some([segmentation * recognition, segmentation, recognition])
    }

    /// Mean panoptic quality of the classes that are there; `None` without any.
    pub fn mean(&self) -> Option<f64> {
        let all: Vec<f64> = self.classes.keys().filter_map(|class| Some(self.quality(*class)?[0])).collect();
        (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_match_by_more_than_half_and_others_are_missed_or_invented() {
        let segment = |class: u32, object: u32| Some(class << 16 | object);
        // Two cars (8): one of four pixels found in three, one of two missed; sky (0) of three with one pixel too many.
        let (first, second, sky) = (segment(8, 1), segment(8, 2), segment(0, 0));
        let truth = [first, first, first, first, second, second, sky, sky, sky, None];
        let predicted = [segment(8, 7), segment(8, 7), segment(8, 7), sky, segment(8, 9), sky, sky, sky, sky, sky];
        let panoptic = Panoptic::of(&predicted, &truth);
        // Cars: one match with IoU 3/4; car 2 and prediction 9 share 1 of 2, which is not more than half.
        assert_eq!(panoptic.quality(8), Some([0.75 * 0.5, 0.75, 0.5]));
        assert_eq!(panoptic.quality(0), Some([0.6, 0.6, 1.0]));
        assert_eq!(panoptic.quality(3), None);
        assert_eq!(panoptic.mean(), Some((0.375 + 0.6) / 2.0));
    }
}
