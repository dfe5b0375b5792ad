//! Training and validation that share no place.

use std::collections::BTreeMap;

use trove_model::Seed;

use super::frame::CandidateFrame;

/// Side of the squares that go to one side whole, metres.
const SQUARE_M: f64 = 150.0;
/// Frames for training that are nearer than this to one for validation are left out, metres.
const GAP_M: f64 = 40.0;

/// Which frame serves for what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// Training.
    Train,
    /// Validation.
    Val,
    /// Neither: too near to the other side, or of the same moment.
    Gap,
}

/// Draws squares of the plane for validation until they hold `val_share` of the frames.
pub fn split(frames: &[&CandidateFrame], val_share: f64, seed: Seed) -> Vec<Split> {
    let square = |frame: &CandidateFrame| {
        let cell = (frame.position_m / SQUARE_M).floor();
        (frame.place.clone(), cell.x as i64, cell.y as i64)
    };
    let mut squares: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (i, frame) in frames.iter().enumerate() {
        squares.entry(square(frame)).or_default().push(i);
    }
    let mut drawn: Vec<(u64, Vec<usize>)> = squares
        .into_iter()
        .map(|((place, x, y), members)| (seed.child(&format!("{place} {x} {y}")).random().bits(), members))
        .collect();
    drawn.sort();
    let mut splits = vec![Split::Train; frames.len()];
    let wanted = (val_share * frames.len() as f64).round() as usize;
    let mut taken = 0;
    for (_, members) in drawn {
        // A square that would overshoot by more than it falls short is left to training.
        if taken + members.len() / 2 < wanted || (taken == 0 && wanted > 0 && members.len() < frames.len()) {
            taken += members.len();
            members.iter().for_each(|i| splits[*i] = Split::Val);
        }
    }
    let val: Vec<&CandidateFrame> = (0..frames.len()).filter(|i| splits[*i] == Split::Val).map(|i| frames[i]).collect();
    for (split, frame) in splits.iter_mut().zip(frames).filter(|(split, _)| **split == Split::Train) {
        let near = |v: &&CandidateFrame| v.place == frame.place && v.position_m.distance(frame.position_m) < GAP_M;
        // Vehicles far apart may see the same things at one moment.
        if val.iter().any(|v| near(v) || v.moment == frame.moment) {
            *split = Split::Gap;
        }
    }
    splits
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn no_place_is_on_both_sides() {
        let frame = |i: usize| CandidateFrame {
            path: i.to_string(),
            variation: 0,
            moment: ("s".into(), i as u32),
            place: if i < 300 { "a".into() } else { "b".into() },
            position_m: DVec2::new(i as f64 * 5.0, 0.0),
            pixels: [1; 20],
            objects: Vec::new(),
            hash: 0,
            has_picture: false,
        };
        let mut frames: Vec<CandidateFrame> = (0..400).map(frame).collect();
        // Every tenth moment is seen by another vehicle too, 500 m ahead.
        let ahead = |i: usize| CandidateFrame { moment: ("s".into(), i as u32), ..frame(i + 100) };
        frames.extend((0..200).step_by(10).map(ahead));
        let frames: Vec<&CandidateFrame> = frames.iter().collect();
        let splits = split(&frames, 0.25, Seed(3));
        let count = |wanted: Split| splits.iter().filter(|s| **s == wanted).count();
        assert!((60..150).contains(&count(Split::Val)), "{}", count(Split::Val));
        assert!(count(Split::Gap) > 0 && count(Split::Train) > 150);
        for (i, a) in frames.iter().enumerate().filter(|(i, _)| splits[*i] == Split::Train) {
            for b in (0..frames.len()).filter(|j| splits[*j] == Split::Val).map(|j| frames[j]) {
                assert!(a.moment != b.moment, "{i}");
                assert!(a.place != b.place || a.position_m.distance(b.position_m) >= GAP_M, "{i}");
            }
        }
        assert_eq!(split(&frames, 0.25, Seed(3)), splits);
        assert!(split(&frames, 0.0, Seed(3)).iter().all(|s| *s == Split::Train));
    }
}
