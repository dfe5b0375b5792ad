//! Which frames to keep: no near-duplicates, enough classes each, and together all classes often.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::frame::{CandidateFrame, seen};

/// What a choice has to hold to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Frames to keep; fewer where fewer pass.
    pub count: usize,
    /// For each of our classes the one that it counts as, from 0 on; `None` is worth nothing.
    pub classes: [Option<u8>; 20],
    /// What each of those is worth, none below 0.
    pub weights: [f64; 20],
    /// Classes that a frame has to show at least: the paper's 6 to 8.
    pub min_classes: usize,
    /// Frames whose hashes differ in at most so many of 64 bits are near-duplicates.
    pub duplicate_bits: u32,
}

impl Rules {
    /// Shares of a frame's pixels by the class that they count as.
    fn shares(&self, frame: &CandidateFrame) -> [f64; 20] {
        let mut shares = [0.0; 20];
        for (class, share) in self.classes.iter().zip(frame.shares()) {
            if let Some(class) = class {
                shares[usize::from(*class)] += share;
            }
        }
        shares
    }
}

/// What became of the frames.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Indices of those kept, in the order in which they were chosen: the first are the most worth.
    pub kept: Vec<usize>,
    /// Dropped for too few classes.
    pub poor: usize,
    /// Dropped as near-duplicates of kept ones.
    pub duplicates: usize,
}

/// A frame with the gain that it had when it was last looked at.
struct Gain(f64, usize);

impl PartialEq for Gain {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Gain {}
impl PartialOrd for Gain {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Gain {
    fn cmp(&self, other: &Self) -> Ordering {
        // Of equal gains the earlier frame.
        self.0.total_cmp(&other.0).then(other.1.cmp(&self.1))
    }
}

/// Chooses greedily by what a frame adds to Σ weight · √(pixels of a class), which is worth the more the rarer the class
/// is among those kept. Gains only ever fall, so the best is found lazily (Minoux 1978), and the greedy choice is within
/// 1 − 1/e of the best one (Nemhauser, Wolsey and Fisher 1978).
pub fn select(frames: &[CandidateFrame], rules: &Rules) -> Selection {
    let mut selection = Selection::default();
    let mut sums = [0.0f64; 20];
    let gain = |sums: &[f64; 20], shares: &[f64; 20]| -> f64 {
        (0..20).map(|c| rules.weights[c] * ((sums[c] + shares[c]).sqrt() - sums[c].sqrt())).sum()
    };
    let mut queue = BinaryHeap::new();
    for (i, frame) in frames.iter().enumerate() {
        let shares = rules.shares(frame);
        if seen(&shares) < rules.min_classes {
            selection.poor += 1;
        } else {
            queue.push(Gain(gain(&sums, &shares), i));
        }
    }
    while selection.kept.len() < rules.count {
        let Some(Gain(_, i)) = queue.pop() else { break };
        let shares = rules.shares(&frames[i]);
        let now = gain(&sums, &shares);
        if queue.peek().is_some_and(|best| best.0 > now) {
            queue.push(Gain(now, i));
            continue;
        }
        let is_duplicate = |k: &usize| {
            let (kept, new) = (&frames[*k], &frames[i]);
            // What variations differ in hardly shows in labels.
            let comparable = kept.has_picture && new.has_picture
                || !kept.has_picture && !new.has_picture && kept.variation == new.variation;
            comparable && (kept.hash ^ new.hash).count_ones() <= rules.duplicate_bits
        };
        if selection.kept.iter().any(is_duplicate) {
            selection.duplicates += 1;
            continue;
        }
        sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
        selection.kept.push(i);
    }
    selection
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use trove_model::ClassMap;

    fn frame(i: u64, pixels: &[(usize, u64)]) -> CandidateFrame {
        let mut all = [0; 20];
        pixels.iter().for_each(|(class, n)| all[*class] = *n);
        CandidateFrame {
            path: i.to_string(),
            variation: 0,
            moment: ("s".into(), i as u32),
            place: String::new(),
            position_m: DVec2::ZERO,
            pixels: all,
            objects: Vec::new(),
            hash: i.wrapping_mul(0x9e37_79b9_7f4a_7c15),
            has_picture: true,
        }
    }

    #[test]
    fn rare_classes_come_first_and_poor_frames_and_duplicates_not_at_all() {
        let mut frames: Vec<CandidateFrame> = (1..30).map(|i| frame(i, &[(1, 500), (9, 500)])).collect();
        frames.push(frame(40, &[(1, 450), (9, 450), (16, 100)]));
        frames.push(frame(41, &[(1, 1000)]));
        frames.push(CandidateFrame { hash: frames[29].hash ^ 3, ..frame(42, &[(1, 460), (9, 450), (16, 90)]) });
        let classes = ClassMap::named("trove20").unwrap().train_ids_of_ours();
        let rules = Rules { count: 31, classes, weights: [1.0; 20], min_classes: 2, duplicate_bits: 3 };
        let found = select(&frames, &rules);
        assert_eq!(found.kept[0], 29);
        assert_eq!((found.kept.len(), found.poor, found.duplicates), (30, 1, 1));
        assert_eq!(select(&frames, &Rules { count: 5, ..rules }).kept, found.kept[..5]);
        // CamVid does not know motorcyclists.
        let classes = ClassMap::named("camvid").unwrap().train_ids_of_ours();
        let camvid = select(&frames, &Rules { classes, ..rules });
        assert_ne!(camvid.kept[0], 29);
        // Nor does one that is worth nothing come first.
        let mut weights = rules.weights;
        weights[usize::from(rules.classes[16].unwrap())] = 0.0;
        assert_ne!(select(&frames, &Rules { weights, ..rules }).kept[0], 29);
        // Labels alone of another variation are no duplicate.
        frames.iter_mut().for_each(|frame| frame.has_picture = false);
        frames[31].variation = 1;
        assert_eq!(select(&frames, &rules).duplicates, 0);
    }
}
