//! Furniture that the map has, moved out of the carriageway.

use std::f64::consts::FRAC_PI_4;

use glam::DVec2;
use trove_model::{Furniture, FurnitureKind, Kind, LampMount, MappedSign, Outcome, Report};

use super::junctions::kerb_side;
use super::yard::{Source, Wish, Yard, facing, words};
use crate::roads::Footing;
use crate::surroundings::KerbPoint;

/// Things drawn on the road are moved to a kerb within this, metres.
const KERB_REACH_M: f64 = 15.0;
/// What is drawn nearer than this to the road, a distance that is known to 0.35, may stand half on its kerb, and is moved
/// behind it, metres.
const EDGE_M: f64 = 0.6;
/// Things drawn beside the road look at a kerb within this, metres.
const LOOK_REACH_M: f64 = 25.0;

/// What is mapped within the place; traffic signals are drawn on the road's line and have rules of their own.
pub(super) fn place(yard: &mut Yard<'_, '_, '_>, report: &Report) {
    let around = yard.around;
    let furniture =
        around.place.map.iter().flat_map(|m| &m.furniture).filter(|f| around.place.bounds.contains(f.position));
    for thing in furniture {
        let wanted = models(thing, yard, report);
        for (kind, tags) in &wanted {
            let tags: Vec<&str> = tags.iter().map(String::as_str).collect();
            let placed = stand(thing, *kind, &tags, yard, report);
            if !placed {
                let what = format!("mapped {:?} without room or kerb", thing.kind);
                report.note(Outcome::Dropped, &what, format_args!("osm {}", thing.id));
            }
        }
    }
}

/// Puts a thing where it is drawn, or beside the road that it is drawn on.
fn stand(thing: &Furniture, kind: Kind, tags: &[&str], yard: &mut Yard<'_, '_, '_>, report: &Report) -> bool {
    let around = yard.around;
    let p = thing.position;
    let kerbs = around.kerbs.near(p, LOOK_REACH_M);
    let side = |k: &KerbPoint| kerb_side(k.traffic, yard.locale.driving_side.is_left());
    let is_sign = matches!(kind, Kind::TrafficSign | Kind::TrafficSignal);
    // A sign on the road's line stands where those whom it faces drive.
    let seen = thing.heading_rad.map(|yaw_rad| -DVec2::from_angle(yaw_rad)).filter(|_| is_sign);
    let fits = |k: &&KerbPoint| {
        k.position.distance(p) < KERB_REACH_M
            && seen.is_none_or(|s| s.dot(k.traffic) > 0.7 && k.outward.dot(side(k)) > 0.7)
    };
    let at_kerb = kerbs.iter().find(fits).copied();
    let look = |k: Option<KerbPoint>| thing.heading_rad.or(k.map(|k| facing(kind, &k))).unwrap_or(0.0);
    let wish = |position, yaw_rad| Wish { kind, tags, position, yaw_rad, source: Source::Mapped };
    let is_on_road = around.stand.surfaces.footing(p) == Footing::Carriageway;
    if is_on_road || yard.clearance.road_distance_m(p) < EDGE_M {
        match at_kerb {
            Some(kerb) => return yard.place_at_kerb(kind, tags, &kerb, Source::Mapped, report),
            None if is_on_road => return false,
            None => return yard.place(&wish(off_edge(p, yard), look(None)), report),
        }
    }
    let as_drawn = wish(p, look(kerbs.first().copied()));
    yard.place(&as_drawn, report)
        || at_kerb.is_some_and(|kerb| yard.place_at_kerb(kind, tags, &kerb, Source::Mapped, report))
}

/// The place beside one at the edge of a road that is farthest from the road.
fn off_edge(p: DVec2, yard: &Yard<'_, '_, '_>) -> DVec2 {
    let beside = (0..8).map(|i| p + DVec2::from_angle(f64::from(i) * FRAC_PI_4) * EDGE_M);
    let road_m = |p: &DVec2| yard.clearance.road_distance_m(*p);
    beside.max_by(|a, b| road_m(a).total_cmp(&road_m(b))).unwrap_or(p)
}

/// What stands for a thing; a bus stop is a sign and, where there is room, a shelter.
fn models(thing: &Furniture, yard: &Yard<'_, '_, '_>, report: &Report) -> Vec<(Kind, Vec<String>)> {
    let locale = yard.locale;
    let one = |kind: Kind, tags: &[&str]| vec![(kind, owned(tags))];
    match thing.kind {
        FurnitureKind::StreetLamp => {
            lamp(thing.lamp()).map(|make| one(Kind::StreetLamp, &["lamp", make])).unwrap_or_default()
        }
        FurnitureKind::StopSign => one(Kind::TrafficSign, &locale.signs.tags("stop")),
        FurnitureKind::GiveWaySign => one(Kind::TrafficSign, &locale.signs.tags("give-way")),
        FurnitureKind::TrafficSign => {
            let tags = thing.sign().and_then(|said| sign(said, yard));
            if tags.is_none() {
                let what = "mapped sign without a model in the library";
                report.note(Outcome::Dropped, what, format_args!("osm {}", thing.id));
            }
            tags.map(|tags| vec![(Kind::TrafficSign, tags)]).unwrap_or_default()
        }
        FurnitureKind::Bench => one(Kind::Bench, &["bench"]),
        FurnitureKind::PicnicTable => one(Kind::StreetFurniture, &["picnic-table"]),
        FurnitureKind::Bin => one(Kind::Bin, &["bin"]),
        FurnitureKind::Hydrant => one(Kind::Hydrant, &["hydrant"]),
        FurnitureKind::Bollard => one(Kind::Bollard, &["bollard"]),
        FurnitureKind::BusStop => {
            [one(Kind::TrafficSign, &words(&locale.signs.bus_stop)), one(Kind::Shelter, &["shelter"])].concat()
        }
        FurnitureKind::BicycleParking => one(Kind::BicycleRack, &["bicycle-rack"]),
        FurnitureKind::Mailbox => one(Kind::StreetFurniture, &words(&locale.street.mailbox)),
        FurnitureKind::StreetCabinet => one(Kind::StreetFurniture, &["cabinet"]),
        FurnitureKind::Telephone => one(Kind::StreetFurniture, &["telephone"]),
        FurnitureKind::AdvertisingColumn => one(Kind::StreetFurniture, &["advertising"]),
        FurnitureKind::Flagpole => one(Kind::StreetFurniture, &["flagpole"]),
        // Poles come with their wires, signals with their junctions, the rest with the ground and the green.
        FurnitureKind::UtilityPole
        | FurnitureKind::TrafficSignal
        | FurnitureKind::Crossing
        | FurnitureKind::Tree
        | FurnitureKind::Shrub
        | FurnitureKind::Fountain
        | FurnitureKind::Manhole => Vec::new(),
    }
}

/// What stands for a lamp; `None` for what hangs on walls and wires or lies in the ground.
fn lamp(mount: Option<LampMount>) -> Option<&'static str> {
    match mount {
        Some(LampMount::Wall | LampMount::Wires | LampMount::Ground) => None,
        Some(LampMount::StraightMast) => Some("post-top"),
        Some(LampMount::BentMast) => Some("curved"),
        None => Some("straight"),
    }
}

fn owned(tags: &[&str]) -> Vec<String> {
    tags.iter().map(|&tag| tag.to_owned()).collect()
}

/// The tags of a sign; `None` where the library has none that says the same.
fn sign(said: MappedSign, yard: &Yard<'_, '_, '_>) -> Option<Vec<String>> {
    let signs = &yard.locale.signs;
    let tags = match said {
        MappedSign::Stop => signs.tags("stop"),
        MappedSign::GiveWay => signs.tags("give-way"),
        MappedSign::OneWay => ["sign", "vienna", "one-way"],
        MappedSign::NoEntry => signs.tags("no-entry"),
        MappedSign::NoStopping => ["sign", "vienna", "no-stopping"],
        MappedSign::NoParking => ["sign", "vienna", "no-parking"],
        MappedSign::Parking => ["sign", "vienna", "parking"],
        MappedSign::PedestrianCrossing => ["sign", "vienna", "crossing"],
        MappedSign::Danger => ["sign", "vienna", "warning"],
        MappedSign::SpeedLimit { limit_kmh } => {
            let limit = signs.speed_limit(limit_kmh);
            let tags = signs.tags(&limit);
            return yard.has(Kind::TrafficSign, &tags).then(|| owned(&tags));
        }
        MappedSign::Other => return None,
    };
    Some(owned(&tags))
}
