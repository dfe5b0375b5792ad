//! A small rigid motion of a street map.

use std::f64::consts::TAU;

use glam::DVec2;
use trove_model::{Polygon, StreetMap};

/// A turn about a pivot, then a shift, in World's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Correction {
    pub pivot: DVec2,
    /// Counter-clockwise.
    pub turn_rad: f64,
    pub shift_m: DVec2,
}

impl Correction {
    /// None at all, about a pivot.
    pub(super) fn identity(pivot: DVec2) -> Self {
        Self { pivot, turn_rad: 0.0, shift_m: DVec2::ZERO }
    }

    /// Where a position of the map is after it.
    pub(super) fn apply(&self, p: DVec2) -> DVec2 {
        self.pivot + self.rotate(p - self.pivot) + self.shift_m
    }

    /// What a direction of the map is after it.
    pub(super) fn rotate(&self, direction: DVec2) -> DVec2 {
        DVec2::from_angle(self.turn_rad).rotate(direction)
    }

    /// The position of the map that comes to lie at `p`.
    pub(super) fn undo(&self, p: DVec2) -> DVec2 {
        self.pivot + DVec2::from_angle(-self.turn_rad).rotate(p - self.shift_m - self.pivot)
    }

    /// A copy of a map after it.
    pub(super) fn corrected(&self, map: &StreetMap) -> StreetMap {
        let mut map = map.clone();
        let line = |points: &mut Vec<DVec2>| points.iter_mut().for_each(|p| *p = self.apply(*p));
        let polygon = |polygon: &mut Polygon| {
            line(&mut polygon.exterior);
            polygon.holes.iter_mut().for_each(line);
        };
        let heading = |rad: &mut Option<f64>| *rad = rad.map(|rad| (rad + self.turn_rad).rem_euclid(TAU));
        map.roads.iter_mut().for_each(|road| line(&mut road.centreline));
        map.lines.iter_mut().for_each(|drawn| line(&mut drawn.line));
        map.land.iter_mut().for_each(|land| polygon(&mut land.polygon));
        for building in &mut map.buildings {
            polygon(&mut building.footprint);
            heading(&mut building.roof_direction_rad);
        }
        for thing in &mut map.furniture {
            thing.position = self.apply(thing.position);
            heading(&mut thing.heading_rad);
        }
        map
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undoing_leads_back() {
        let correction = Correction { pivot: DVec2::new(30.0, -7.0), turn_rad: 0.3, shift_m: DVec2::new(2.0, 5.0) };
        let p = DVec2::new(100.0, 40.0);
        assert!((correction.undo(correction.apply(p)) - p).length() < 1e-9);
        assert!((correction.apply(correction.pivot) - correction.pivot - correction.shift_m).length() < 1e-9);
    }
}
