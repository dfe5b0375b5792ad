//! Furniture that the map has, moved out of the carriageway.

use trove_model::{FurnitureKind, Kind, Outcome, Report};

use super::{OFF_KERB_M, Wish, facing};
use crate::roads::Footing;
use crate::surroundings::Surroundings;

/// Things drawn on the road are moved to a kerb within this, metres.
const KERB_REACH_M: f64 = 15.0;

/// What is mapped within the place; traffic signals are drawn on the road's line and have rules of their own.
pub(super) fn wishes(around: &Surroundings, report: &Report) -> Vec<Wish> {
    let mut wishes = Vec::new();
    let furniture = around.map.iter().flat_map(|m| &m.furniture).filter(|f| around.bounds.contains(f.position));
    for thing in furniture {
        let Some(kind) = kind(thing.kind) else { continue };
        let on_road = around.stand.surfaces.footing(thing.position) == Footing::Carriageway;
        let kerb = around.kerbs.near(thing.position, KERB_REACH_M).first().copied();
        let position = match (on_road, kerb) {
            (false, _) => thing.position,
            (true, Some(kerb)) => kerb.position + kerb.outward * OFF_KERB_M,
            (true, None) => {
                report.note(
                    Outcome::Dropped,
                    "furniture on the road without a kerb near it",
                    format!("osm {}", thing.id),
                );
                continue;
            }
        };
        let yaw_rad = thing.heading_rad.or(kerb.map(|k| facing(kind, &k))).unwrap_or(0.0);
        let road = kerb.map(|k| -k.outward);
        wishes.push(Wish { kind, position, yaw_rad, road });
    }
    wishes
}

fn kind(mapped: FurnitureKind) -> Option<Kind> {
    match mapped {
        FurnitureKind::StreetLamp => Some(Kind::StreetLamp),
        FurnitureKind::TrafficSign | FurnitureKind::StopSign | FurnitureKind::GiveWaySign => Some(Kind::TrafficSign),
        FurnitureKind::Bench => Some(Kind::Bench),
        FurnitureKind::Bin => Some(Kind::Bin),
        FurnitureKind::Hydrant => Some(Kind::Hydrant),
        FurnitureKind::Bollard => Some(Kind::Bollard),
        FurnitureKind::BusStop => Some(Kind::Shelter),
        FurnitureKind::UtilityPole => Some(Kind::UtilityPole),
        FurnitureKind::BicycleParking => Some(Kind::BicycleRack),
        _ => None,
    }
}
