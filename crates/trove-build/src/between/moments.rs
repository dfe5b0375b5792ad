//! Which moments of a drive there are.

use trove_model::Drive;

use super::times::seconds;

/// A drive and the moments at which it can be seen: its keyframes, and perhaps moments between them.
#[derive(Clone, Debug)]
pub struct Timeline {
    /// The drive as it was recorded.
    pub recorded: Drive,
    /// `None`: its keyframes are all there is.
    between: Option<Between>,
}

#[derive(Clone, Debug)]
struct Between {
    drive: Drive,
    keyframes: Vec<Option<usize>>,
}

/// The moments at which a place is seen.
#[derive(Clone, Copy, Debug)]
pub struct Moments<'a> {
    /// Its keyframes are the moments, in the order of time; without LiDAR where it is not the recorded one.
    pub drive: &'a Drive,
    /// The index of the recorded keyframe that each of them is; `None`: all of them are, in their order.
    keyframes: Option<&'a [Option<usize>]>,
}

impl Timeline {
    /// The keyframes alone.
    pub fn of_keyframes(recorded: Drive) -> Self {
        Self { recorded, between: None }
    }

    /// With a drive whose keyframes are all moments, and the index of the recorded keyframe that each of them is.
    pub(super) fn new(recorded: Drive, drive: Drive, keyframes: Vec<Option<usize>>) -> Self {
        Self { recorded, between: Some(Between { drive, keyframes }) }
    }

    /// All of its moments.
    pub fn moments(&self) -> Moments<'_> {
        match &self.between {
            Some(Between { drive, keyframes }) => Moments { drive, keyframes: Some(keyframes) },
            None => Moments::of_keyframes(&self.recorded),
        }
    }
}

impl<'a> Moments<'a> {
    /// The keyframes of a drive.
    pub fn of_keyframes(drive: &'a Drive) -> Self {
        Self { drive, keyframes: None }
    }

    /// The index of the recorded keyframe that a moment is; `None` between keyframes.
    pub fn keyframe(&self, moment: usize) -> Option<usize> {
        self.keyframes.map_or(Some(moment), |keyframes| keyframes.get(moment).copied().flatten())
    }

    /// When a moment is, seconds since the first.
    pub(crate) fn time_s(&self, moment: usize) -> f64 {
        let keyframes = &self.drive.keyframes;
        keyframes.get(moment).map_or(0.0, |k| seconds(k.time_ns, keyframes[0].time_ns))
    }

    /// Whether there are others than keyframes.
    pub(crate) fn are_between(&self) -> bool {
        self.keyframes.is_some()
    }

    /// The moment that a recorded keyframe is.
    pub(crate) fn of_keyframe(&self, keyframe: usize) -> usize {
        let Some(keyframes) = self.keyframes else { return keyframe };
        keyframes.iter().position(|k| *k == Some(keyframe)).unwrap_or(keyframes.len())
    }

    /// Of some recorded keyframes, in their order: their moments, and all those between two that follow one another in the
    /// recording.
    pub fn chosen(&self, keyframes: &[usize]) -> Vec<usize> {
        let mut chosen = Vec::new();
        for (i, &keyframe) in keyframes.iter().enumerate() {
            let first = self.of_keyframe(keyframe);
            let goes_on = keyframes.get(i + 1) == Some(&(keyframe + 1));
            let end = if goes_on { self.of_keyframe(keyframe + 1) } else { first + 1 };
            chosen.extend(first..end);
        }
        chosen
    }
}
