//! Where made-up road users may be: along kerbs, on lanes, at crossings.

use std::f64::consts::TAU;

use glam::DVec2;
use trove_model::{Bounds, Kind, Polygon, Random, RoadKind};

use super::motion::{Motion, On, Place};
use super::parking::in_row;
use super::shares::{Doing, Shares};
use crate::geometry::near::Near;
use crate::geometry::path::Path;
use crate::geometry::segments::SegmentIndex;
use crate::roads::{Lane, LaneUse};
use crate::surroundings::KerbPoint;
use crate::surroundings::Surroundings;

/// People, and vehicles, are put so near to the recording vehicle, metres; behind it half as near.
const PEOPLE_M: f64 = 45.0;
const VEHICLES_M: f64 = 65.0;
/// Spots on lanes lie so far from one another, metres.
const SPOT_M: f64 = 3.0;
/// Who waits for a gap stands so near to a crossing, metres.
const CROSSING_M: f64 = 1.5;
/// A kerb so near to a shop is before it, metres, and so many of those on foot are there.
const SHOP_M: f64 = 9.0;
const SHOPPING: f64 = 0.5;
/// Lanes go on across a junction to one that begins within so many metres, so little aside and turned, radians.
const JUNCTION_M: f64 = 35.0;
const ASIDE_M: f64 = 1.5;
const TURNED_RAD: f64 = 0.35;
/// Animals stand so far from the kerb, beside half of their length, and from each other, metres.
const STRAYING_M: f64 = 2.2;
/// A lane is followed so far, metres.
const FOLLOWED_M: f64 = 400.0;
/// A kerb so far beside a lane is that lane's, and cyclists ride so far within its edge, metres.
const BESIDE_LANE_M: f64 = 2.2;
const FROM_EDGE_M: f64 = 0.6;
/// Between those who ride behind each other, metres.
const BEHIND_M: f64 = 3.2;
/// Between the middles of people side by side, metres.
const BESIDE_M: f64 = 0.75;
/// From a parked car's side to the kerb, and room for those who drive past, metres.
const KERB_GAP_M: f64 = 0.25;
const PASSING_M: f64 = 1.2;

/// Everywhere that road users may be.
pub(super) struct Ways<'a> {
    around: &'a Surroundings<'a>,
    lanes: &'a [Lane],
    /// Positions on lanes, with the lane and how far along it.
    on_lanes: Vec<(DVec2, usize, f64)>,
    /// Positions on kerbs beside sidewalks, with the run and the place in it.
    on_kerbs: Vec<(DVec2, usize, usize)>,
    /// Those of them that are at crossings.
    at_crossings: Vec<(DVec2, usize, usize)>,
    /// Those of them that are before shops.
    at_shops: Vec<(DVec2, usize, usize)>,
    driven: SegmentIndex,
}

impl<'a> Ways<'a> {
    pub(super) fn new(around: &'a Surroundings<'a>) -> Self {
        let lanes = &around.stand.surfaces.lanes;
        let on_lane = |(i, lane): (usize, &Lane)| -> Vec<(DVec2, usize, f64)> {
            let path = Path::new(&lane.line);
            let spots = (path.length_m() / SPOT_M) as usize;
            (0..spots).map(|s| (s as f64 + 0.5) * SPOT_M).map(|s_m| (path.at(s_m).0, i, s_m)).collect()
        };
        let runs = around.kerbs.runs.iter().enumerate();
        let on_kerbs: Vec<(DVec2, usize, usize)> = runs
            .flat_map(|(run, points)| points.iter().enumerate().map(move |(i, point)| (point, run, i)))
            .filter(|(point, ..)| point.sidewalk)
            .map(|(point, run, i)| (point.position, run, i))
            .collect();
        let areas: Vec<&Polygon> = around.place.drive.lane_map.iter().flat_map(|map| &map.crossings).collect();
        let crossings =
            around.place.map.iter().flat_map(|map| &map.roads).filter(|road| road.kind == RoadKind::Crossing);
        let lines = SegmentIndex::new(crossings.map(|road| road.centreline.as_slice()));
        let crosses = |p: DVec2| {
            let near = |area: &&Polygon| area.bounds().is_some_and(|b| b.grown(CROSSING_M).contains(p));
            lines.nearest(p, CROSSING_M).is_some()
                || areas.iter().filter(|area| near(area)).any(|a| a.contains(p) || a.edge_distance_m(p) < CROSSING_M)
        };
        let buildings = around.place.map.iter().flat_map(|map| &map.buildings);
        let shops: Vec<&Polygon> = buildings.filter(|building| building.shop).map(|shop| &shop.footprint).collect();
        let near_shops = Near::new(shops.iter().map(|shop| Some(shop.bounds()?.grown(SHOP_M))));
        let sells = |p: DVec2| {
            let mut near = near_shops.at(Bounds { min: p, max: p });
            near.any(|i| shops[i].edge_distance_m(p) < SHOP_M)
        };
        let of_use = |usage: LaneUse| lanes.iter().filter(move |lane| lane.usage == usage);
        Self {
            around,
            lanes,
            on_lanes: lanes.iter().enumerate().flat_map(on_lane).collect(),
            at_crossings: on_kerbs.iter().filter(|(p, ..)| crosses(*p)).copied().collect(),
            at_shops: on_kerbs.iter().filter(|(p, ..)| sells(*p)).copied().collect(),
            on_kerbs,
            driven: SegmentIndex::new(of_use(LaneUse::Driving).map(|lane| lane.line.as_slice())),
        }
    }

    /// Where people cross.
    pub(super) fn crossings(&self) -> Vec<DVec2> {
        self.at_crossings.iter().map(|spot| spot.0).collect()
    }

    /// Someone, or some together, somewhere in view at a keyframe; empty where the draw found no place.
    pub(super) fn group(&self, doing: Doing, keyframe: usize, shares: &Shares, random: &mut Random) -> Vec<Motion> {
        let group = match doing {
            Doing::Walking => self.walking(keyframe, shares, random),
            Doing::Standing => self.standing(keyframe, shares, random),
            Doing::Waiting => self.waiting(keyframe, shares, random),
            Doing::Cycling | Doing::Motorcycling | Doing::Driving => self.driving(doing, keyframe, shares, random),
            Doing::Parked => self.parked(keyframe, shares, random).map(|motion| vec![motion]),
            Doing::Straying => self.straying(keyframe, shares, random),
        };
        group.unwrap_or_default()
    }

    /// People side by side along the sidewalk.
    fn walking(&self, keyframe: usize, shares: &Shares, random: &mut Random) -> Option<Vec<Motion>> {
        let &(_, run, i) = self.by_foot(keyframe, random)?;
        let (nearest_m, speed_mps) = (random.range(0.7, 2.6), random.range(0.95, 1.6));
        let is_along = random.chance(0.5);
        let together = how_many(&[0.62, 0.27, 0.11], random);
        let mut group = Vec::new();
        for n in 0..together {
            let (kind, size_m) = shares.someone(Doing::Walking, random)?;
            let from_kerb_m = nearest_m + BESIDE_M * f64::from(n);
            let (line, at_m) = walkway(&self.around.kerbs.runs[run], i, from_kerb_m, is_along)?;
            let place = Place::Along(line, at_m + random.range(-0.3, 0.3));
            group.push(Motion { kind, size_m, on: On::Sidewalk, place, speed_mps });
        }
        Some(group)
    }

    /// People who talk with each other, or someone alone.
    fn standing(&self, keyframe: usize, shares: &Shares, random: &mut Random) -> Option<Vec<Motion>> {
        let &(_, run, i) = self.by_foot(keyframe, random)?;
        let kerb = self.around.kerbs.runs[run][i];
        let middle = kerb.position + kerb.outward * random.range(0.7, 2.8);
        let together = how_many(&[0.45, 0.33, 0.15, 0.07], random);
        let (turn, radius_m) = (random.range(0.0, TAU), random.range(0.5, 0.65));
        let mut group = Vec::new();
        for n in 0..together {
            let inward = DVec2::from_angle(turn + TAU * f64::from(n) / f64::from(together) + random.range(-0.2, 0.2));
            let position = if together == 1 { middle } else { middle - inward * radius_m };
            group.push(standing(Doing::Standing, position, inward, shares, random)?);
        }
        Some(group)
    }

    /// People beside each other who look across the road.
    fn waiting(&self, keyframe: usize, shares: &Shares, random: &mut Random) -> Option<Vec<Motion>> {
        let &(_, run, i) = self.in_view(&self.at_crossings, keyframe, PEOPLE_M, random, |spot| spot.0)?;
        let kerb = self.around.kerbs.runs[run][i];
        let first = kerb.position + kerb.outward * random.range(0.55, 0.9);
        let together = how_many(&[0.5, 0.32, 0.18], random);
        let mut group = Vec::new();
        for n in 0..together {
            let position = first + kerb.outward.perp() * BESIDE_M * f64::from(n);
            let looks = DVec2::from_angle(random.range(-0.35, 0.35)).rotate(-kerb.outward);
            group.push(standing(Doing::Waiting, position, looks, shares, random)?);
        }
        Some(group)
    }

    /// Animals near each other, on the sidewalk or the edge of the road.
    fn straying(&self, keyframe: usize, shares: &Shares, random: &mut Random) -> Option<Vec<Motion>> {
        let &(_, run, i) = self.in_view(&self.on_kerbs, keyframe, PEOPLE_M, random, |spot| spot.0)?;
        let KerbPoint { position, outward, .. } = self.around.kerbs.runs[run][i];
        let off_m = random.range(-STRAYING_M, STRAYING_M);
        let on = if off_m < 0.0 { On::Carriageway } else { On::Sidewalk };
        let along = outward.perp();
        let mut group = Vec::new();
        for n in 0..how_many(&[0.7, 0.2, 0.1], random) {
            let (kind, size_m) = shares.someone(Doing::Straying, random)?;
            // Clear of the kerb by half its length, whichever way it looks.
            let from_kerb_m = off_m + off_m.signum() * size_m.x / 2.0;
            let at = position + outward * from_kerb_m + along * STRAYING_M * f64::from(n);
            let place = Place::Spot(at, DVec2::from_angle(random.range(0.0, TAU)));
            group.push(Motion { kind, size_m, on, place, speed_mps: 0.0 });
        }
        Some(group)
    }

    /// Along a lane: bicycles on one of their own, else at its edge where that is the kerb.
    fn driving(&self, doing: Doing, keyframe: usize, shares: &Shares, random: &mut Random) -> Option<Vec<Motion>> {
        let cycles = doing == Doing::Cycling;
        let of_use = |usage: LaneUse| -> Vec<(DVec2, usize, f64)> {
            self.on_lanes.iter().filter(|(_, lane, _)| self.lanes[*lane].usage == usage).copied().collect()
        };
        let reach_m = if cycles { PEOPLE_M } else { VEHICLES_M };
        let own = cycles && random.chance(0.7);
        let own = if own { of_use(LaneUse::Cycling) } else { Vec::new() };
        let own = self.in_view(&own, keyframe, reach_m, random, |spot| spot.0).copied();
        let (at, lane, s_m) = match own {
            Some(own) => own,
            None => *self.in_view(&of_use(LaneUse::Driving), keyframe, reach_m, random, |spot| spot.0)?,
        };
        let Lane { width_m, usage, .. } = self.lanes[lane];
        let aside_m = if cycles && usage == LaneUse::Driving {
            let kerb = *self.around.kerbs.near(at, width_m / 2.0 + BESIDE_LANE_M).first()?;
            let (_, along) = Path::new(&self.lanes[lane].line).at(s_m);
            along.perp_dot(kerb.position - at).signum() * (width_m / 2.0 - FROM_EDGE_M).max(0.0)
        } else {
            random.range(-0.2, 0.2)
        };
        let (middle, before_m) = self.followed(lane);
        let path = Path::new(&middle);
        let line = path.part(0.0, path.length_m(), aside_m);
        let speed_mps = match doing {
            Doing::Cycling => random.range(3.4, 6.4),
            Doing::Motorcycling => random.range(5.0, 12.0),
            _ => random.range(4.5, 12.0),
        };
        let together = if cycles { how_many(&[0.8, 0.2], random) } else { 1 };
        let mut group = Vec::new();
        for n in 0..together {
            let (kind, size_m) = shares.someone(doing, random)?;
            let place = Place::Along(line.clone(), before_m + s_m - BEHIND_M * f64::from(n));
            group.push(Motion { kind, size_m, on: On::Carriageway, place, speed_mps });
        }
        Some(group)
    }

    /// In a row that is meant for it, else at a kerb where others can drive past.
    fn parked(&self, keyframe: usize, shares: &Shares, random: &mut Random) -> Option<Motion> {
        let (kind, size_m) = shares.someone(Doing::Parked, random)?;
        let is_row = |lane: usize| matches!(self.lanes[lane].usage, LaneUse::Parking(_));
        let rows: Vec<(DVec2, usize, f64)> = self.on_lanes.iter().filter(|spot| is_row(spot.1)).copied().collect();
        let row = if random.chance(0.7) { self.in_view(&rows, keyframe, VEHICLES_M, random, |s| s.0) } else { None };
        let (position, looks) = if let Some(&(_, lane, s_m)) = row {
            let lane = &self.lanes[lane];
            let (position, along) = Path::new(&lane.line).at(s_m + random.range(-0.5, 0.5) * SPOT_M);
            (position, in_row(self.around, lane, [position, along], random)?)
        } else {
            let &(_, run, i) = self.in_view(&self.on_kerbs, keyframe, VEHICLES_M, random, |spot| spot.0)?;
            let kerb = self.around.kerbs.runs[run][i];
            let position = kerb.position - kerb.outward * (size_m.y / 2.0 + KERB_GAP_M);
            let room_m = size_m.y / 2.0 + PASSING_M;
            if self.driven.nearest(position, room_m).is_some() || self.driven.nearest(position, 12.0).is_none() {
                return None;
            }
            (position, kerb.traffic)
        };
        Some(Motion::parked(kind, size_m, position, looks, random))
    }

    /// A lane with those before and after it that go straight on, and its own beginning on that line.
    fn followed(&self, lane: usize) -> (Vec<DVec2>, f64) {
        let driven = |i: &usize| self.lanes[*i].usage == self.lanes[lane].usage;
        let ends = |i: usize| {
            let line = &self.lanes[i].line;
            let [first, last] = [(line[0], line[1]), (line[line.len() - 2], line[line.len() - 1])];
            [(first.0, (first.1 - first.0).normalize_or_zero()), (last.1, (last.1 - last.0).normalize_or_zero())]
        };
        let goes_on = |(end, along): (DVec2, DVec2), (start, to): (DVec2, DVec2)| {
            let gap = start - end;
            along.dot(to) > TURNED_RAD.cos()
                && (-0.5..JUNCTION_M).contains(&gap.dot(along))
                && gap.perp_dot(along).abs() < ASIDE_M.min(0.5 + gap.length() * 0.1)
        };
        let (mut line, mut before_m) = (self.lanes[lane].line.clone(), 0.0);
        for ahead in [true, false] {
            let (mut now, mut far_m, mut passed) = (lane, 0.0, vec![lane]);
            while far_m < FOLLOWED_M {
                let joins = |i: &usize| {
                    if ahead { goes_on(ends(now)[1], ends(*i)[0]) } else { goes_on(ends(*i)[1], ends(now)[0]) }
                };
                let gap_m = |i: &usize| {
                    if ahead { ends(now)[1].0.distance(ends(*i)[0].0) } else { ends(*i)[1].0.distance(ends(now)[0].0) }
                };
                let others = (0..self.lanes.len()).filter(|i| driven(i) && !passed.contains(i)).filter(joins);
                let Some(other) = others.min_by(|a, b| gap_m(a).total_cmp(&gap_m(b))) else { break };
                let more = &self.lanes[other].line;
                let more_m = Path::new(more).length_m() + gap_m(&other);
                if ahead {
                    line.extend(more);
                } else {
                    line.splice(0..0, more.iter().copied());
                    before_m += more_m;
                }
                far_m += more_m;
                passed.push(other);
                now = other;
            }
        }
        (line, before_m)
    }

    /// A spot on a kerb for someone on foot: mostly before a shop, if one is in view.
    fn by_foot(&self, keyframe: usize, random: &mut Random) -> Option<&(DVec2, usize, usize)> {
        let shops = if random.chance(SHOPPING) { &self.at_shops[..] } else { &[] };
        let shop = self.in_view(shops, keyframe, PEOPLE_M, random, |spot| spot.0);
        shop.or_else(|| self.in_view(&self.on_kerbs, keyframe, PEOPLE_M, random, |spot| spot.0))
    }

    /// One of the spots that the recording vehicle has in view at a keyframe.
    fn in_view<'s, S>(
        &self,
        spots: &'s [S],
        keyframe: usize,
        reach_m: f64,
        random: &mut Random,
        position: impl Fn(&S) -> DVec2,
    ) -> Option<&'s S> {
        let ego = self.around.place.drive.keyframes[keyframe].world_from_ego;
        let (eye, yaw_rad) = (ego.translation.truncate(), ego.yaw_rad());
        let forward = DVec2::from_angle(yaw_rad);
        let sees = |spot: &&S| {
            let to = position(spot) - eye;
            let reach_m = if to.dot(forward) > 0.0 { reach_m } else { reach_m / 2.0 };
            to.length_squared() < reach_m * reach_m
        };
        let seen: Vec<&S> = spots.iter().filter(sees).collect();
        random.pick(&seen).copied()
    }
}

/// Someone on the spot.
fn standing(doing: Doing, position: DVec2, looks: DVec2, shares: &Shares, random: &mut Random) -> Option<Motion> {
    let (kind, size_m): (Kind, _) = shares.someone(doing, random)?;
    Some(Motion { kind, size_m, on: On::Sidewalk, place: Place::Spot(position, looks), speed_mps: 0.0 })
}

/// How many are together: shares of one, two and so on.
fn how_many(shares: &[f64], random: &mut Random) -> u32 {
    random.weighted(shares.iter().copied()).map_or(1, |more| more as u32 + 1)
}

/// The line that someone walks so far from the kerb, along the run or against it, smoothed, and how far along it the
/// kerb's `i`-th point is; `None` where the kerb ends there.
fn walkway(run: &[KerbPoint], i: usize, from_kerb_m: f64, is_along: bool) -> Option<(Vec<DVec2>, f64)> {
    let beside = |k: usize| run[k].position + run[k].outward * from_kerb_m;
    let smooth = |k: usize| {
        let window = k.saturating_sub(2)..=(k + 2).min(run.len() - 1);
        let count = window.clone().count() as f64;
        window.map(beside).sum::<DVec2>() / count
    };
    // Inside a corner points crowd and run back.
    let onward = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut line: Vec<DVec2> = Vec::new();
        for p in points {
            let is_on = match line.as_slice() {
                [.., a, b] => (*b - *a).dot(p - *b) > 0.0 && b.distance(p) > 0.4,
                [a] => a.distance(p) > 0.4,
                [] => true,
            };
            if is_on {
                line.push(p);
            }
        }
        line
    };
    let reach = (FOLLOWED_M / 4.0) as usize;
    let after = onward(&mut (i..(i + reach).min(run.len())).map(smooth));
    let before = onward(&mut (i.saturating_sub(reach)..=i).rev().map(smooth));
    let length_m = |line: &[DVec2]| line.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    let (ahead, behind) = if is_along { (after, before) } else { (before, after) };
    let at_m = length_m(&behind);
    let line: Vec<DVec2> = behind.into_iter().rev().chain(ahead.into_iter().skip(1)).collect();
    (line.len() > 1).then_some((line, at_m))
}
