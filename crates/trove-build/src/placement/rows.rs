//! Barriers and cones stand in rows, and a row is of one make.

use glam::{DVec2, DVec3};
use trove_model::{Kind, Track};

/// Neighbours in a row are at most this far apart, metres.
const APART_M: f64 = 4.0;

/// For every track the first of its row: itself where it stands alone or is nothing that stands in rows.
pub(super) fn rows(tracks: &[Track]) -> Vec<usize> {
    let place = |track: &Track| -> Option<DVec2> {
        let position_world: DVec3 = track.boxes.first()?.1.world_from_body.translation;
        (stands_in_rows(track.kind) && position_world.is_finite()).then(|| position_world.truncate())
    };
    let places: Vec<Option<DVec2>> = tracks.iter().map(place).collect();
    let mut first: Vec<usize> = (0..tracks.len()).collect();
    for b in 0..tracks.len() {
        for a in 0..b {
            let (Some(p), Some(q)) = (places[a], places[b]) else { continue };
            if tracks[a].kind == tracks[b].kind && p.distance(q) <= APART_M {
                let (a, b) = (root(&first, a), root(&first, b));
                first[a.max(b)] = a.min(b);
            }
        }
    }
    (0..tracks.len()).map(|i| root(&first, i)).collect()
}

fn stands_in_rows(kind: Kind) -> bool {
    matches!(kind, Kind::Barrier | Kind::TrafficCone)
}

/// The first track of the row that a track belongs to.
fn root(first: &[usize], mut i: usize) -> usize {
    while first[i] != i {
        i = first[i];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_chain_of_barriers_is_one_row_and_a_far_one_is_another() {
        let model = testing::drive().tracks[0].clone();
        let at = |x: f64, kind: Kind| {
            let mut track = Track { kind, ..model.clone() };
            for (_, cuboid) in &mut track.boxes {
                cuboid.world_from_body.translation = DVec3::new(x, 0.0, 0.0);
            }
            track
        };
        let barriers = [0.0, 6.0, 3.0, 20.0].map(|x| at(x, Kind::Barrier));
        let tracks = [barriers.as_slice(), &[at(0.0, Kind::Car), at(1.0, Kind::Car)]].concat();
        assert_eq!(rows(&tracks), [0, 0, 0, 3, 4, 5]);
    }
}
