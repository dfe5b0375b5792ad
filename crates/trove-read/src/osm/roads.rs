//! Roads with all that their tags tell.

use std::mem::swap;

use glam::DVec2;
use trove_model::{CrossingMarking, Report, Road, RoadKind, SidewalkSides, Turns};

use super::meaning::{implied_layer, in_tunnel, stated_layer};
use super::raw::Tags;
use super::sides;
use super::tagged::Tagged;
use super::values::{decimal, length_m, speed_kmh};
use super::vocabulary::{CROSSINGS, ROAD_SURFACES};

/// No road has more lanes.
const MAX_LANES: f64 = 20.0;

/// A way that is driven or walked on; `centreline` runs as the way does. `on_left` says how the country drives.
pub(super) fn road(
    id: i64,
    kind: RoadKind,
    centreline: Vec<DVec2>,
    tags: &Tags,
    on_left: bool,
    report: &Report,
) -> Road {
    let owner = format!("way {id}");
    let tagged = Tagged { tags, owner: &owner, report };
    let against = matches!(tags.get("oneway"), "-1" | "reverse");
    let roundabout = matches!(tags.get("junction"), "roundabout" | "circular");
    let oneway = match tags.get("oneway") {
        "yes" | "true" | "1" => true,
        "" => roundabout || tags.get("highway") == "motorway",
        _ => against,
    };
    let mut turns = [tagged.parsed(&["turn:lanes:forward"], turns), tagged.parsed(&["turn:lanes:backward"], turns)];
    if oneway {
        let driven = &mut turns[usize::from(against)];
        *driven = driven.take().or_else(|| tagged.parsed(&["turn:lanes"], self::turns));
    } else if !tags.get("turn:lanes").is_empty() {
        tagged.refuse("turn:lanes of a road with two directions", tags.get("turn:lanes"));
    }
    let [turns_forward, turns_backward] = turns.map(Option::unwrap_or_default);
    let (lanes, lanes_backward) = lanes(&tagged, oneway, turns_forward.len() + turns_backward.len());
    let road = Road {
        lanes,
        lanes_backward,
        turns_forward,
        turns_backward,
        width_m: tagged.number(&["width:carriageway", "width", "est_width"], length_m, 0.3..=100.0),
        oneway,
        sidewalk: sides::sidewalk(&tagged),
        parking: sides::parking(&tagged),
        // On a path of their own bicycles have no side.
        cycleway: if kind.is_for_cars() {
            sides::cycleway(&tagged, oneway, on_left != against)
        } else {
            Default::default()
        },
        layer: tagged.parsed(&["layer"], stated_layer).unwrap_or_else(|| implied_layer(tags)),
        bridge: tags.has("bridge"),
        tunnel: in_tunnel(tags),
        surface: tagged.word(&["surface"], &ROAD_SURFACES),
        name: Some(tags.get("name").to_owned()).filter(|name| !name.is_empty()),
        roundabout,
        link: tags.get("highway").ends_with("_link"),
        steps: tags.get("highway") == "steps",
        lit: tagged.parsed(&["lit"], lit),
        speed_limit_kmh: tagged
            .parsed(&["maxspeed", "maxspeed:forward", "maxspeed:backward", "zone:maxspeed"], speed_kmh)
            .flatten(),
        crossing: crossing_marking(&tagged),
        ..Road::new(id, kind, centreline)
    };
    if against { reversed(road) } else { road }
}

/// All lanes and those that run against the way, as far as tags tell: by number, by direction, or by their arrows.
fn lanes(tagged: &Tagged, oneway: bool, with_arrows: usize) -> (Option<u32>, Option<u32>) {
    let count = |key: &str, least: f64| tagged.number(&[key], decimal, least..=MAX_LANES).map(|n| n.round() as u32);
    let (forward, backward) = (count("lanes:forward", 0.0), count("lanes:backward", 0.0));
    let of_both = forward.zip(backward).map(|(forward, backward)| forward + backward).filter(|&all| all > 0);
    let of_arrows = (oneway && with_arrows > 0).then_some(with_arrows as u32);
    let all = count("lanes", 1.0).or(of_both).or(of_arrows);
    if oneway {
        return (all, Some(0));
    }
    let rest = || all.zip(forward).and_then(|(all, forward)| all.checked_sub(forward));
    (all, backward.or_else(rest).filter(|&backward| all.is_none_or(|all| backward <= all)))
}

/// Where the lanes of one direction lead (`left|through|through;right`).
fn turns(text: &str) -> Option<Vec<Turns>> {
    let lane = |text: &str| {
        text.split(';').try_fold(Turns::default(), |turns, turn| {
            Some(match turn.trim() {
                "left" | "slight_left" | "sharp_left" => Turns { left: true, ..turns },
                "through" => Turns { through: true, ..turns },
                "right" | "slight_right" | "sharp_right" => Turns { right: true, ..turns },
                "reverse" => Turns { reverse: true, ..turns },
                // Marked with nothing, or with an arrow of another kind.
                "" | "none" | "merge_to_left" | "merge_to_right" => turns,
                _ => return None,
            })
        })
    };
    let lanes: Option<Vec<Turns>> = text.split('|').map(lane).collect();
    lanes.filter(|lanes| lanes.len() as f64 <= MAX_LANES)
}

fn lit(text: &str) -> Option<bool> {
    match text {
        "yes" | "24/7" | "automatic" | "limited" | "interval" | "sunset-sunrise" | "dusk-dawn" | "good" | "street" => {
            Some(true)
        }
        "no" | "disused" | "none" => Some(false),
        _ => None,
    }
}

/// How a crossing is marked: what is painted, before that something is.
pub(super) fn crossing_marking(tagged: &Tagged) -> Option<CrossingMarking> {
    let said = tagged.words(&["crossing:markings", "crossing_ref", "crossing"], &CROSSINGS);
    said.iter().find(|&&marking| marking != CrossingMarking::Usual).or(said.first()).copied()
}

/// The same road, drawn the other way.
fn reversed(mut road: Road) -> Road {
    road.centreline.reverse();
    road.sidewalk = SidewalkSides { left: road.sidewalk.right, right: road.sidewalk.left };
    swap(&mut road.parking.left, &mut road.parking.right);
    swap(&mut road.cycleway.left, &mut road.cycleway.right);
    swap(&mut road.turns_forward, &mut road.turns_backward);
    road
}
