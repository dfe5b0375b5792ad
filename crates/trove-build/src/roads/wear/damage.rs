//! What years of digging, frost and traffic leave: patches, sealed cracks, erased lines, skid marks, drips of oil.

use glam::DVec2;
use trove_model::{Bounds, Polygon, Random};

use super::stretches::{Look, Region};
use crate::geometry::path::{Path, closed, resampled};
use crate::geometry::plane::{difference, grown, intersection, strip, union};

/// Metres of road for one patch, one sealed crack, one pair of skid marks, one erased line, one drip.
const PATCH_EVERY_M: f64 = 24.0;
const CRACK_EVERY_M: f64 = 9.0;
const SKID_EVERY_M: f64 = 500.0;
const ERASED_EVERY_M: f64 = 140.0;
const DRIP_EVERY_M: f64 = 7.0;
/// A skid mark darkens in so many steps.
const SKID_STEPS: usize = 6;
/// Points of a crack and of a patch's edge are this far apart; saws and shovels leave an edge by so much.
const STEP_M: f64 = 0.35;
const FRAY_M: f64 = 0.005;
/// Of patches that are larger than this fewer are new.
const WIDE_M2: f64 = 10.0;
/// Bitumen and rubber, and a line's ground-off place, as factors on aged asphalt.
const BITUMEN_TONE: f64 = 0.3;
const RUBBER_TONE: f64 = 0.72;
const ERASED_TONE: f64 = 0.82;
const DRIP_TONE: f64 = 0.55;

/// A bus stop stands this near to the middle of its lane; half of the length of its concrete.
const PAD_REACH_M: f64 = 7.0;
const PAD_HALF_M: f64 = 9.0;

/// Some area of another tone.
pub(super) struct Spot {
    pub(super) area: Vec<Polygon>,
    pub(super) look: Look,
    pub(super) tone: f64,
}

/// What lies on a region.
#[derive(Default)]
pub(super) struct Damage {
    /// Patches; no two overlap.
    pub(super) patches: Vec<Spot>,
    /// Thin things on top of them; no two overlap.
    pub(super) traces: Vec<Spot>,
}

/// What has happened to a region; older ones have more of it, and where buses stop there is concrete.
pub(super) fn damage(region: &Region, bus_stops: &[DVec2]) -> Damage {
    let path = Path::new(&region.line);
    let length_m = path.length_m();
    let mut damage = Damage::default();
    if !region.look.is_asphalt() || length_m < 4.0 {
        return damage;
    }
    let mut random = region.seed.child("damage").random();
    let age = if region.look == Look::Fresh { 0.15 } else { random.range(0.3, 1.7) };
    let mut taken: Vec<Bounds> = Vec::new();
    let mut seals: Vec<Polygon> = Vec::new();
    for pad in bus_stops.iter().filter_map(|&stop| pad(region, stop)) {
        let area = intersection(&pad, &region.area);
        let Some(bounds) = Bounds::around(area.iter().flat_map(|p| p.exterior.iter().copied())) else { continue };
        if !taken.iter().any(|b| b.overlaps(&bounds)) {
            taken.push(bounds);
            damage.patches.push(Spot { area, look: Look::Concrete, tone: random.range(0.9, 1.05) });
        }
    }
    for _ in 0..count(length_m / PATCH_EVERY_M * age, &mut random) {
        let outline = frayed(&patch(region, &path, &mut random), &mut random);
        let Some(bounds) = Bounds::around(outline.iter().flat_map(|p| p.exterior.iter().copied())) else { continue };
        if taken.iter().any(|b| b.overlaps(&bounds.grown(0.2))) {
            continue;
        }
        taken.push(bounds);
        if random.chance(0.45) {
            seals.extend(difference(&grown(&outline, 0.03), &grown(&outline, -0.025)));
        }
        let is_wide = outline.iter().map(Polygon::area_m2).sum::<f64>() > WIDE_M2;
        let (look, tone) = if random.chance(if is_wide { 0.3 } else { 0.6 }) {
            (Look::Fresh, random.range(0.95, 1.6))
        } else {
            (Look::Aged, region.tone * random.range(0.78, 1.12))
        };
        damage.patches.push(Spot { area: intersection(&outline, &region.area), look, tone });
    }
    for _ in 0..count(length_m / CRACK_EVERY_M * age, &mut random) {
        seals.extend(strip(&crack(region, &path, &mut random), random.range(0.012, 0.03)));
    }
    let trace = |damage: &mut Damage, outlines: Vec<Polygon>, tone: f64| {
        let before: Vec<Polygon> = damage.traces.iter().flat_map(|t| t.area.iter().cloned()).collect();
        let area = difference(&intersection(&union(&outlines), &region.area), &before);
        if !area.is_empty() {
            damage.traces.push(Spot { area, look: Look::Aged, tone });
        }
    };
    trace(&mut damage, seals, BITUMEN_TONE);
    let drips = (0..count(length_m / DRIP_EVERY_M * age, &mut random)).filter_map(|_| drip(region, &mut random));
    trace(&mut damage, drips.collect(), region.tone * DRIP_TONE);
    for _ in 0..count(length_m / SKID_EVERY_M, &mut random) {
        // Rubber comes off more and more until the car stands.
        for (i, track) in skid(region, &mut random).into_iter().enumerate() {
            let share = (i + 1) as f64 / SKID_STEPS as f64;
            trace(&mut damage, track, region.tone * (1.0 + (RUBBER_TONE - 1.0) * share));
        }
    }
    let erased = (0..count(length_m / ERASED_EVERY_M * age, &mut random)).flat_map(|_| {
        let (s_m, offset_m) = (random.range(0.0, length_m), within(region, 0.5, &mut random));
        strip(&path.part(s_m, s_m + random.range(6.0, 25.0), offset_m), 0.07)
    });
    trace(&mut damage, erased.collect(), region.tone * ERASED_TONE);
    damage
}

/// A whole number with a given mean.
fn count(mean: f64, random: &mut Random) -> usize {
    mean.floor() as usize + usize::from(random.chance(mean.fract()))
}

/// An offset of the line within the region, `margin_m` from its edges.
fn within(region: &Region, margin_m: f64, random: &mut Random) -> f64 {
    let (low, high) = (region.right_m + margin_m, region.left_m - margin_m);
    if low < high { random.range(low, high) } else { (low + high) / 2.0 }
}

/// A rectangle along the road, a trench across it, or a lane laid anew.
fn patch(region: &Region, path: &Path<'_>, random: &mut Random) -> Vec<Polygon> {
    let s_m = random.range(0.5, path.length_m() - 1.0);
    match random.unit() {
        u if u < 0.15 => {
            let (a, b) = (path.beside(s_m, region.left_m + 1.0), path.beside(s_m, region.right_m - 1.0));
            strip(&[a, b], random.range(0.3, 0.7))
        }
        u if u < 0.27 && !region.lanes.is_empty() => {
            let lane = &region.lanes[random.index(region.lanes.len())];
            strip(&Path::new(lane).part(s_m, s_m + random.range(6.0, 22.0), 0.0), random.range(1.2, 1.65))
        }
        _ => {
            let (long_m, half_m) = (random.range(0.8, 5.0), random.range(0.3, 1.0));
            strip(&path.part(s_m, s_m + long_m, within(region, half_m, random)), half_m)
        }
    }
}

/// With edges that no ruler drew.
fn frayed(outline: &[Polygon], random: &mut Random) -> Vec<Polygon> {
    let frayed = |polygon: &Polygon| {
        let mut points = resampled(&closed(&polygon.exterior), STEP_M);
        points.pop();
        let moved = points.iter().map(|p| p + DVec2::new(random.normal(), random.normal()) * FRAY_M);
        Polygon::simple(moved.collect())
    };
    outline.iter().map(frayed).collect()
}

/// The concrete on which buses stand, for a stop beside a lane.
fn pad(region: &Region, stop: DVec2) -> Option<Vec<Polygon>> {
    let near = |lane: &&Vec<DVec2>| lane.iter().map(|p| p.distance(stop)).fold(f64::INFINITY, f64::min);
    let lane = region.lanes.iter().min_by(|a, b| near(a).total_cmp(&near(b)))?;
    let path = Path::new(lane);
    let nearest = (0..lane.len()).min_by(|&a, &b| lane[a].distance(stop).total_cmp(&lane[b].distance(stop)))?;
    let s_m = path.vertex_m(nearest);
    (lane[nearest].distance(stop) < PAD_REACH_M)
        .then(|| strip(&path.part(s_m - PAD_HALF_M, s_m + PAD_HALF_M, 0.0), 1.6))
}

/// A crooked line across the road or along it.
fn crack(region: &Region, path: &Path<'_>, random: &mut Random) -> Vec<DVec2> {
    let (mut s_m, mut offset_m) = (random.range(0.0, path.length_m()), within(region, 0.2, random));
    let along = random.chance(0.45);
    let steps = if along { random.range(8.0, 40.0) } else { random.range(6.0, 24.0) } as usize;
    let side = if offset_m > (region.left_m + region.right_m) / 2.0 { -1.0 } else { 1.0 };
    let mut points = Vec::with_capacity(steps);
    for _ in 0..steps {
        points.push(path.beside(s_m, offset_m));
        let drift_m = 0.12 * random.normal();
        if along {
            (s_m, offset_m) = (s_m + STEP_M, offset_m + 0.5 * drift_m);
        } else {
            (s_m, offset_m) = (s_m + drift_m, offset_m + side * STEP_M);
        }
        if s_m > path.length_m() || !(region.right_m..region.left_m).contains(&offset_m) {
            break;
        }
    }
    points
}

/// A blot in the middle of a lane, most of them where cars wait: towards the lane's end.
fn drip(region: &Region, random: &mut Random) -> Option<Polygon> {
    let lane = region.lanes.get(random.index(region.lanes.len().max(1)))?;
    let path = Path::new(lane);
    let s_m = path.length_m() * (1.0 - random.unit() * random.unit());
    let middle = path.beside(s_m, 0.2 * random.normal());
    let radius_m = random.range(0.03, 0.16);
    let corner = |i: u32| {
        let r = radius_m * random.range(0.7, 1.3);
        middle + DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 9.0) * r
    };
    Some(Polygon::simple((0..9).map(corner).collect()))
}

/// Two tracks of a car that braked hard, in steps along the lane.
fn skid(region: &Region, random: &mut Random) -> Vec<Vec<Polygon>> {
    if region.lanes.is_empty() {
        return Vec::new();
    }
    let path = Path::new(&region.lanes[random.index(region.lanes.len())]);
    let (s_m, long_m, aside_m) = (random.range(0.0, path.length_m()), random.range(5.0, 14.0), random.range(-0.4, 0.4));
    let step_m = long_m / SKID_STEPS as f64;
    let step = |i: usize| {
        let from_m = s_m + i as f64 * step_m;
        [-0.75, 0.75].iter().flat_map(|w| strip(&path.part(from_m, from_m + step_m, aside_m + w), 0.08)).collect()
    };
    (0..SKID_STEPS).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;
    use trove_model::Seed;

    fn region(seed: u64) -> Region {
        let line: Vec<DVec2> = (0..=40).map(|i| DVec2::new(f64::from(i) * 2.0, 0.0)).collect();
        let area = vec![plane::rectangle(Bounds { min: DVec2::new(0.0, -4.0), max: DVec2::new(80.0, 4.0) })];
        let lanes = [2.0, -2.0].map(|y| line.iter().map(|p| *p + DVec2::Y * y).collect()).to_vec();
        Region { area, look: Look::Aged, tone: 1.0, line, left_m: 4.0, right_m: -4.0, lanes, seed: Seed(seed) }
    }

    #[test]
    fn damage_stays_on_its_road_overlaps_nothing_of_its_layer_and_differs_from_stretch_to_stretch() {
        let area_m2 = |area: &[Polygon]| area.iter().map(Polygon::area_m2).sum::<f64>();
        let mut sums = Vec::new();
        for seed in 0..12 {
            let region = region(seed);
            let damage = damage(&region, &[]);
            for layer in [&damage.patches, &damage.traces] {
                let all: Vec<Polygon> = layer.iter().flat_map(|s| s.area.iter().cloned()).collect();
                assert!(area_m2(&difference(&union(&all), &region.area)) < 0.02);
                assert!((area_m2(&union(&all)) - area_m2(&all)).abs() < 0.02, "{seed}");
            }
            sums.push(damage.patches.iter().map(|s| area_m2(&s.area)).sum::<f64>());
        }
        assert!(sums.iter().filter(|s| **s > 1.0).count() > 6, "{sums:?}");
        sums.sort_by(f64::total_cmp);
        assert!(sums[11] > sums[2] + 2.0, "{sums:?}");
    }
}
