//! How someone who was made up moves: steadily along a line, or not at all.

use glam::{DVec2, DVec3};
use trove_model::{Kind, Random};

use crate::geometry::path::Path;

/// Where the axles of a vehicle are, as shares of its length from its middle: its heading is theirs.
const AXLES: f64 = 0.3;

/// Someone's way.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub kind: Kind,
    /// Length, width, height.
    pub size_m: DVec3,
    /// What may be under it.
    pub on: On,
    pub place: Place,
    pub speed_mps: f64,
}

/// What is walked or driven on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum On {
    Sidewalk,
    Carriageway,
}

/// Where someone is.
#[derive(Clone, Debug)]
pub(super) enum Place {
    /// At one position, looking in a direction (unit).
    Spot(DVec2, DVec2),
    /// On a line, so far along it at the keyframe for which it was drawn.
    Along(Vec<DVec2>, f64),
}

impl Motion {
    /// A vehicle that nobody is in; nobody parks quite straight.
    pub(super) fn parked(kind: Kind, size_m: DVec3, position: DVec2, looks: DVec2, random: &mut Random) -> Self {
        let looks = DVec2::from_angle(random.range(-0.02, 0.02)).rotate(looks);
        Self { kind, size_m, on: On::Carriageway, place: Place::Spot(position, looks), speed_mps: 0.0 }
    }

    /// Position and heading (unit) at some seconds after the keyframe for which it was drawn; `None` where the line does
    /// not reach.
    pub(super) fn poses(&self, times_s: impl Iterator<Item = f64>) -> Vec<Option<[DVec2; 2]>> {
        let (line, at_m) = match &self.place {
            Place::Spot(position, looks) => return times_s.map(|_| Some([*position, *looks])).collect(),
            Place::Along(line, at_m) => (line, *at_m),
        };
        let (path, axle_m) = (Path::new(line), AXLES * self.size_m.x);
        let pose = |time_s: f64| {
            let middle_m = at_m + self.speed_mps * time_s;
            let reach_m = self.size_m.x / 2.0;
            if middle_m < reach_m || middle_m > path.length_m() - reach_m {
                return None;
            }
            let [front, back] = [middle_m + axle_m, middle_m - axle_m].map(|s_m| path.at(s_m).0);
            Some([(front + back) / 2.0, (front - back).try_normalize()?])
        };
        times_s.map(pose).collect()
    }
}
