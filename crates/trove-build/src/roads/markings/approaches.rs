//! Where traffic waits for a junction: stop lines, give ways, arrows, boxes.

use glam::DVec2;
use trove_model::{
    Dash, FurnitureKind, GiveWayLine, MarkingCustoms, MinorRoad, Outcome, Polygon, Report, RoadKind, Seed, StreetMap,
    Turns,
};

use super::crossings::Crossing;
use super::legs::{Junction, Leg};
use super::symbols::{arrow, laid, triangles, word};
use crate::geometry::plane::{intersection, rectangle, strip};
use crate::roads::cross_section::Use;

/// Signals stand this near to their junction, signs this near to where they hold.
const SIGNAL_M: f64 = 30.0;
const SIGN_M: f64 = 18.0;
/// A crossing further than this before the junction is not the junction's.
const CROSSING_REACH_M: f64 = 14.0;
/// The first arrows end this far before the stop line; more follow at this distance.
const ARROW_GAP_M: f64 = 3.0;
const ARROW_PERIOD_M: f64 = 24.0;
/// Arrows stand in the last so many metres.
const ARROW_REACH_M: f64 = 60.0;
/// Depth of a box for motorcycles.
const MOTORCYCLE_BOX_M: f64 = 4.0;
/// Lines of a box junction's hatching, and their distance.
const HATCH_M: f64 = 0.12;
const HATCH_PERIOD_M: f64 = 1.6;

/// What stands at the roads and says who waits.
pub(super) struct Control {
    signals: Vec<DVec2>,
    stops: Vec<DVec2>,
    give_ways: Vec<DVec2>,
}

impl Control {
    pub(super) fn new(map: Option<&StreetMap>) -> Self {
        let of_kind = |kind: FurnitureKind| {
            map.iter().flat_map(|m| &m.furniture).filter(|f| f.kind == kind).map(|f| f.position).collect()
        };
        Self {
            signals: of_kind(FurnitureKind::TrafficSignal),
            stops: of_kind(FurnitureKind::StopSign),
            give_ways: of_kind(FurnitureKind::GiveWaySign),
        }
    }

    pub(super) fn is_signalised(&self, at: DVec2) -> bool {
        self.signals.iter().any(|p| p.distance(at) < SIGNAL_M)
    }

    pub(super) fn stops(&self, at: DVec2) -> bool {
        self.stops.iter().any(|p| p.distance(at) < SIGN_M)
    }

    fn gives_way(&self, at: DVec2) -> bool {
        self.give_ways.iter().any(|p| p.distance(at) < SIGN_M)
    }
}

/// What is painted where the lanes of one direction reach the end of a leg; all white.
pub(super) fn approach(
    leg: &Leg<'_>,
    usage: Use,
    control: &Control,
    crossings: &[Crossing],
    customs: &MarkingCustoms,
    seed: Seed,
    report: &Report,
) -> Vec<Polygon> {
    let forward = usage == Use::Forward;
    let Some(junction) = leg.ends[usize::from(forward)] else { return Vec::new() };
    let lanes = leg.lanes(usage);
    let (Some(&(mut left_m, _)), Some(&(_, mut right_m))) = (lanes.first(), lanes.last()) else { return Vec::new() };
    if left_m < right_m {
        let outer = lanes.iter().flat_map(|l| [l.0, l.1]);
        (left_m, right_m) = outer.fold((f64::MIN, f64::MAX), |(l, r), x| (l.max(x), r.min(x)));
    }
    // Lengths are measured back from the junction, directions are the traffic's.
    let s_m = |before_m: f64| if forward { leg.to_m - before_m } else { leg.from_m + before_m };
    let place = |before_m: f64, offset_m: f64| leg.path.beside(s_m(before_m), offset_m);
    let along = |before_m: f64| leg.path.at(s_m(before_m)).1 * if forward { 1.0 } else { -1.0 };
    let middle_m = (left_m + right_m) / 2.0;

    let steps = (CROSSING_REACH_M.min(leg.length_m()) / 0.25) as usize;
    let near: Vec<&Crossing> = crossings.iter().filter(|c| c.is_near(place(0.0, middle_m))).collect();
    let crossed = |i: &usize| {
        let p = place(*i as f64 * 0.25, middle_m);
        near.iter().any(|c| c.area.iter().any(|a| a.contains(p)))
    };
    let stop_m = (0..steps).rfind(crossed).map_or(0.6, |i| i as f64 * 0.25 + customs.setback_m);
    if stop_m > leg.length_m() - 2.0 {
        return Vec::new();
    }
    let bar = |before_m: f64, depth_m: f64| {
        let (at, ahead) = (place(before_m, middle_m), along(before_m));
        let half = ahead.perp() * (left_m - right_m) / 2.0;
        strip(&[at - half, at + half], depth_m / 2.0)
    };

    let at = place(stop_m, middle_m);
    let minor = junction.is_minor(leg.road().kind, along(0.0)) && leg.road().kind < RoadKind::Service;
    let signalised = control.is_signalised(junction.position);
    let gives_way = control.gives_way(at);
    let stops = signalised || control.stops(at) || (minor && !gives_way && customs.minor == MinorRoad::Stop);
    if minor && !signalised && !gives_way && !control.stops(at) && customs.minor != MinorRoad::Unmarked {
        let what = "priority at a junction, from the classes of its roads";
        report.note(Outcome::Guessed, what, format_args!("osm way {}", leg.road().id));
    }
    let mut paint = Vec::new();
    let mut wait_m = stop_m;
    if stops {
        paint.extend(bar(stop_m + customs.stop_line_m / 2.0, customs.stop_line_m));
        if signalised && customs.motorcycle_box && leg.road().kind <= RoadKind::Tertiary {
            wait_m += MOTORCYCLE_BOX_M;
            paint.extend(bar(wait_m, 0.12));
        }
        if !signalised && customs.words && seed.child("word").random().chance(0.5) && leg.length_m() > 20.0 {
            for (a_m, b_m) in &lanes {
                let before_m = wait_m + 4.0;
                paint.extend(laid(&word("STOP"), place(before_m, (a_m + b_m) / 2.0), along(before_m)));
            }
        }
    } else if gives_way || (minor && customs.minor == MinorRoad::GiveWay) {
        paint.extend(give_way(customs, at, along(stop_m), left_m - right_m));
    }

    let tagged = if forward { &leg.road().turns_forward } else { &leg.road().turns_backward };
    let turns: Vec<Turns> = if tagged.len() == lanes.len() {
        tagged.clone()
    } else if lanes.len() > 1 && (signalised || leg.road().kind <= RoadKind::Secondary) {
        let what = "lane directions at a junction, from its roads";
        report.note(Outcome::Guessed, what, format_args!("osm way {}", leg.road().id));
        shared_out(junction.turns(along(0.0)), lanes.len())
    } else {
        Vec::new()
    };
    for (&(a_m, b_m), &turns) in lanes.iter().zip(&turns) {
        let symbol = arrow(turns, customs.arrow_m);
        let mut before_m = wait_m + ARROW_GAP_M + customs.arrow_m;
        let mut first = true;
        while !symbol.is_empty() && before_m < ARROW_REACH_M.min(leg.length_m() - 3.0) {
            paint.extend(laid(&symbol, place(before_m, (a_m + b_m) / 2.0), along(before_m)));
            let alone = turns.through as u8 + turns.left as u8 + turns.right as u8 == 1;
            if first && customs.words && alone && !turns.through && customs.arrow_m < 3.5 && before_m > 6.0 {
                let word_m = before_m + 4.5;
                paint.extend(laid(&word("ONLY"), place(word_m, (a_m + b_m) / 2.0), along(word_m)));
            }
            first = false;
            before_m += ARROW_PERIOD_M;
        }
    }
    paint
}

/// Where each of some lanes leads, from left to right, if together they lead to `turns`.
pub(super) fn shared_out(turns: Turns, lanes: usize) -> Vec<Turns> {
    if !(turns.left || turns.right) {
        return Vec::new();
    }
    (0..lanes)
        .map(|i| {
            let (first, last) = (i == 0, i + 1 == lanes);
            let left = turns.left && first;
            let right = turns.right && last;
            // The outer lanes of many lead round the corner alone.
            let through = turns.through && !((left && lanes > 2) || (right && lanes > 3));
            let lost = !(left || right || through);
            Turns {
                left: left || (lost && turns.left && 2 * i < lanes),
                through,
                right: right || (lost && !(turns.left && 2 * i < lanes)),
                reverse: false,
            }
        })
        .collect()
}

fn give_way(customs: &MarkingCustoms, at: DVec2, along: DVec2, width_m: f64) -> Vec<Polygon> {
    let half = along.perp() * width_m / 2.0;
    let row = |back_m: f64, dash: Dash, half_m: f64| -> Vec<Polygon> {
        let middle = at - along * back_m;
        super::lines::dashes(&[middle - half, middle + half], dash).iter().flat_map(|d| strip(d, half_m)).collect()
    };
    match customs.give_way {
        GiveWayLine::Triangles => laid(&triangles(-width_m / 2.0, width_m / 2.0), at - along * 0.8, along),
        GiveWayLine::Bars => row(0.25, Dash { dash_m: 0.5, gap_m: 0.25 }, 0.25),
        GiveWayLine::DoubleBars => {
            let dash = Dash { dash_m: 0.6, gap_m: 0.3 };
            [row(0.1, dash, 0.1), row(0.5, dash, 0.1)].concat()
        }
    }
}

/// Hatching over the middle of a junction that must be kept clear.
pub(super) fn box_junction(junction: &Junction) -> Vec<Polygon> {
    let Some((half_m, axis)) = junction.square().filter(|(half_m, _)| (3.0..=9.0).contains(half_m)) else {
        return Vec::new();
    };
    let square = rectangle(trove_model::Bounds::square(DVec2::ZERO, 2.0 * half_m));
    let rim = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r], [-r, -r]].map(DVec2::from_array);
    let mut lines = strip(&rim(half_m - HATCH_M / 2.0), HATCH_M / 2.0);
    let count = (2.0 * half_m / HATCH_PERIOD_M).ceil() as i32;
    for i in -count..=count {
        let c = f64::from(i) * HATCH_PERIOD_M;
        for sign in [-1.0, 1.0] {
            let reach = 3.0 * half_m;
            lines.extend(strip(
                &[DVec2::new(-reach, c - sign * reach), DVec2::new(reach, c + sign * reach)],
                HATCH_M / 2.0,
            ));
        }
    }
    let hatched = intersection(&crate::geometry::plane::union(&lines), &[square]);
    laid(&hatched, junction.position, axis)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(turns: &[Turns]) -> Vec<String> {
        let name = |t: &Turns| {
            [(t.left, "l"), (t.through, "t"), (t.right, "r")].iter().filter(|x| x.0).map(|x| x.1).collect::<String>()
        };
        turns.iter().map(name).collect()
    }

    #[test]
    fn turns_are_shared_out_among_lanes_from_the_outside_in() {
        let all = Turns { left: true, through: true, right: true, reverse: false };
        assert_eq!(names(&shared_out(all, 2)), ["lt", "tr"]);
        assert_eq!(names(&shared_out(all, 3)), ["l", "t", "tr"]);
        assert_eq!(names(&shared_out(all, 4)), ["l", "t", "t", "r"]);
        let ends = Turns { through: false, ..all };
        assert_eq!(names(&shared_out(ends, 2)), ["l", "r"]);
        assert_eq!(names(&shared_out(ends, 3)), ["l", "l", "r"]);
        assert!(shared_out(Turns { through: true, ..Turns::default() }, 2).is_empty());
    }
}
