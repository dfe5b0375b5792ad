//! What lies along both sides of a road: sidewalks, parked cars, cycle lanes.

use trove_model::{Cycleway, Parking, ParkingOrientation, Sides, SidewalkSides};

use super::tagged::Tagged;

/// A sidewalk that is a way of its own (`separate`) is not the road's: it would be there twice.
pub(super) fn sidewalk(tagged: &Tagged) -> SidewalkSides {
    let plain = tagged.parsed(&["sidewalk"], |value| {
        Some(match value {
            "both" | "yes" => [true, true],
            "left" => [true, false],
            "right" => [false, true],
            "no" | "none" | "separate" => [false, false],
            _ => return None,
        })
    });
    let side = |key: &str| {
        tagged.parsed(&[key, "sidewalk:both"], |value| match value {
            "yes" => Some(true),
            "no" | "none" | "separate" => Some(false),
            _ => None,
        })
    };
    SidewalkSides {
        left: side("sidewalk:left").or(plain.map(|[left, _]| left)),
        right: side("sidewalk:right").or(plain.map(|[_, right]| right)),
    }
}

/// Parked cars by today's tags (`parking:left=lane`), else by those of before 2022 (`parking:lane:left=parallel`).
pub(super) fn parking(tagged: &Tagged) -> Sides<Option<Parking>> {
    let side = |side| parking_today(tagged, side).or_else(|| parking_before(tagged, side));
    Sides { left: side("left"), right: side("right") }
}

fn parking_today(tagged: &Tagged, side: &str) -> Option<Parking> {
    let of_side = format!("parking:{side}:orientation");
    let orientation = tagged.parsed(&[&of_side, "parking:both:orientation"], orientation);
    let orientation = orientation.unwrap_or(ParkingOrientation::Parallel);
    tagged.parsed(&[&format!("parking:{side}"), "parking:both"], |value| {
        Some(match value {
            "lane" | "yes" | "on_street" | "shoulder" => Parking::Lane(orientation),
            "street_side" | "lay_by" => Parking::Bays(orientation),
            "on_kerb" | "half_on_kerb" => Parking::Kerb(orientation),
            // Bays that are areas of their own would be there twice.
            "no" | "none" | "separate" => Parking::No,
            _ => return None,
        })
    })
}

fn parking_before(tagged: &Tagged, side: &str) -> Option<Parking> {
    tagged.parsed(&[&format!("parking:lane:{side}"), "parking:lane:both"], |value| {
        if matches!(value, "no" | "none" | "no_parking" | "no_stopping" | "no_standing" | "fire_lane" | "separate") {
            return Some(Parking::No);
        }
        if matches!(value, "yes" | "marked") {
            return Some(Parking::Lane(ParkingOrientation::Parallel));
        }
        let orientation = orientation(value)?;
        let keys = [format!("parking:lane:{side}:{value}"), format!("parking:lane:both:{value}")];
        Some(match tagged.tags.first(&keys.each_ref().map(String::as_str)) {
            "lay_by" | "street_side" => Parking::Bays(orientation),
            "on_kerb" | "half_on_kerb" => Parking::Kerb(orientation),
            _ => Parking::Lane(orientation),
        })
    })
}

fn orientation(text: &str) -> Option<ParkingOrientation> {
    match text {
        "parallel" => Some(ParkingOrientation::Parallel),
        "diagonal" => Some(ParkingOrientation::Diagonal),
        "perpendicular" => Some(ParkingOrientation::Perpendicular),
        _ => None,
    }
}

/// Cycle lanes. Without a side, a one-way street has its lane at the kerb that its traffic keeps to, and a lane against
/// the traffic at the other.
pub(super) fn cycleway(tagged: &Tagged, oneway: bool, kerb_on_left: bool) -> Sides<Option<Cycleway>> {
    let plain = tagged.tags.get("cycleway");
    let side = |key: &str, at_kerb: bool| {
        if !tagged.tags.first(&[key, "cycleway:both"]).is_empty() {
            return tagged.parsed(&[key, "cycleway:both"], kind);
        }
        let applies = !oneway || plain.starts_with("opposite") != at_kerb;
        if applies { tagged.parsed(&["cycleway"], kind) } else { None }
    };
    Sides { left: side("cycleway:left", kerb_on_left), right: side("cycleway:right", !kerb_on_left) }
}

fn kind(text: &str) -> Option<Cycleway> {
    Some(match text {
        "lane" | "opposite_lane" | "buffered_lane" => Cycleway::Lane,
        "track" | "opposite_track" => Cycleway::Track,
        "shared_lane" | "share_busway" | "opposite_share_busway" | "shared" | "shoulder" => Cycleway::Shared,
        // A path that is a way of its own would be there twice.
        "no" | "none" | "opposite" | "separate" | "crossing" => Cycleway::No,
        _ => return None,
    })
}
