//! Lamps, signals, signs and what else stands along a street: where the map has them, and by rule where it does not.

mod along;
mod mapped;
mod signals;

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use trove_model::{Asset, AssetLibrary, Kind, Outcome, Report, Seed};

use crate::clearance::{Clearance, Room};
use crate::kerbs::KerbPoint;
use crate::scenery::Scenery;
use crate::surroundings::Surroundings;

/// Poles stand this far behind the kerb, metres.
const OFF_KERB_M: f64 = 0.55;

/// An asset whose foot is this far from the middle of its width reaches to one side, metres.
const ONE_SIDED_M: f64 = 1.0;

/// A piece of furniture that is wanted somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wish {
    kind: Kind,
    /// Where its foot stands.
    position: DVec2,
    /// Where its front looks, or its arm reaches.
    yaw_rad: f64,
    /// To the road that it belongs to, unit; `None` where there is none near.
    road: Option<DVec2>,
}

impl Wish {
    /// At a kerb, looking the way that things of its kind do.
    fn at_kerb(kind: Kind, kerb: &KerbPoint) -> Self {
        let position = kerb.position + kerb.outward * OFF_KERB_M;
        Self { kind, position, yaw_rad: facing(kind, kerb), road: Some(-kerb.outward) }
    }
}

impl Wish {
    /// Whether an asset with its foot there reaches over the road, where it reaches to one side at all.
    fn suits(&self, foot: DVec2) -> bool {
        let arm_world = DVec2::from_angle(self.yaw_rad).rotate(DVec2::new(0.0, -foot.y));
        foot.y.abs() < ONE_SIDED_M || self.road.is_some_and(|road| road.dot(arm_world) > 0.0)
    }
}

/// Signs and signals look at the traffic that comes, racks lie along the kerb, everything else looks at the road.
fn facing(kind: Kind, kerb: &KerbPoint) -> f64 {
    let look = match kind {
        Kind::TrafficSign | Kind::TrafficSignal => -kerb.traffic,
        Kind::BicycleRack => kerb.traffic,
        _ => -kerb.outward,
    };
    look.y.atan2(look.x)
}

/// Places furniture in the order: mapped, signals at junctions, by rule along the kerbs.
pub(crate) fn furniture<'a>(
    around: &Surroundings,
    library: &'a AssetLibrary,
    clearance: &mut Clearance,
    seed: Seed,
    report: &Report,
) -> Vec<Scenery<'a>> {
    let mut shop = Shop { library, feet: BTreeMap::new(), clearance, around, seed, placed: Vec::new() };
    for wish in mapped::wishes(around, report) {
        shop.place(&wish, report);
    }
    for wish in signals::wishes(around) {
        shop.place(&wish, report);
    }
    along::furnish(around, &mut shop, seed.child("along"), report);
    report.measure("furniture.placed", shop.placed.len() as f64);
    shop.placed
}

/// Places what is wanted where there is room for it.
struct Shop<'a, 'b, 'c> {
    library: &'a AssetLibrary,
    /// Where an asset's foot is, from the middle of its box.
    feet: BTreeMap<&'a str, DVec2>,
    clearance: &'b mut Clearance<'c>,
    around: &'b Surroundings<'b>,
    seed: Seed,
    placed: Vec<Scenery<'a>>,
}

impl<'a> Shop<'a, '_, '_> {
    /// Whether it found room.
    fn place(&mut self, wish: &Wish, report: &Report) -> bool {
        let room = room(wish.kind);
        if !self.around.bounds.contains(wish.position) || !self.clearance.is_free(wish.position, &room) {
            return false;
        }
        let seed = self.seed.child("piece").nth(self.placed.len() as u64);
        let library = self.library;
        let models: Vec<(&'a Asset, DVec2)> =
            library.of_kind(wish.kind).map(|a| (a, self.foot(a))).filter(|(_, foot)| wish.suits(*foot)).collect();
        // A street's lamps are alike: the model is drawn for a large square.
        let square = (wish.position / 150.0).floor();
        let alike = self.seed.child("model").nth(square.x as i64 as u64).nth(square.y as i64 as u64);
        let draw = if wish.kind == Kind::TrafficSign { seed } else { alike };
        let Some((asset, foot)) = draw.child(wish.kind.class().row().name).random().pick(&models).copied() else {
            let example = format!("at {:.0}", wish.position);
            report.note(Outcome::Dropped, &format!("furniture without an asset of kind {:?}", wish.kind), example);
            return false;
        };
        self.clearance.take(wish.position, room.radius_m);
        let middle = wish.position - DVec2::from_angle(wish.yaw_rad).rotate(foot);
        let surface_m = self.around.stand.surface_m(wish.position);
        self.placed.push(Scenery {
            asset,
            foot_world: middle.extend(surface_m),
            yaw_rad: wish.yaw_rad,
            scale: DVec3::ONE,
            seed,
        });
        true
    }

    fn foot(&mut self, asset: &'a Asset) -> DVec2 {
        *self.feet.entry(&asset.id).or_insert_with(|| foot(asset))
    }

    /// Distance to the nearest piece of a kind that stands already, metres.
    fn distance_m(&self, kind: Kind, p: DVec2) -> f64 {
        let same = self.placed.iter().filter(|s| s.asset.kind == kind);
        same.map(|s| s.foot_world.truncate().distance(p)).fold(f64::INFINITY, f64::min)
    }
}

fn room(kind: Kind) -> Room {
    let radius_m = match kind {
        Kind::Shelter => 2.0,
        Kind::Bench | Kind::BicycleRack => 0.9,
        _ => 0.35,
    };
    let buildings_m = if kind == Kind::Bench { 0.6 } else { 0.4 };
    Room { road_m: if kind == Kind::Shelter { 0.8 } else { 0.0 }, buildings_m, recorded_m: 0.35 + radius_m, radius_m }
}

/// The middle of what touches the ground: a lamp's pole is not under the middle of its arm.
fn foot(asset: &Asset) -> DVec2 {
    const TOUCHES_M: f32 = 0.15;
    let low: Vec<DVec2> =
        asset.mesh.positions.iter().filter(|p| p.z < TOUCHES_M).map(|p| p.truncate().as_dvec2()).collect();
    let bounds = trove_model::Bounds::around(low);
    bounds.map_or(DVec2::ZERO, |b| b.centre())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arm_reaches_over_the_road_or_is_not_taken() {
        // A pole with its arm towards −y, as in right-hand traffic: the foot is left of the box's middle.
        let arm_to_the_right = DVec2::new(0.0, 2.7);
        let kerb = |outward: DVec2| KerbPoint { position: DVec2::ZERO, outward, traffic: DVec2::X, sidewalk: true };
        // Traffic drives east. South of it the kerb is on its right, and the signal looks west.
        let right_hand = Wish::at_kerb(Kind::TrafficSignal, &kerb(-DVec2::Y));
        let left_hand = Wish::at_kerb(Kind::TrafficSignal, &kerb(DVec2::Y));
        assert!((right_hand.yaw_rad.abs() - std::f64::consts::PI).abs() < 1e-9);
        assert!(!right_hand.suits(-arm_to_the_right) && left_hand.suits(-arm_to_the_right));
        assert!(right_hand.suits(arm_to_the_right) && !left_hand.suits(arm_to_the_right));
        assert!(left_hand.suits(DVec2::ZERO));
    }
}
