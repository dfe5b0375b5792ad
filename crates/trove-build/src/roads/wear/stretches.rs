//! The road's surface, stretch by stretch: what it is made of, how old it is, and what wheels have left on it.

use glam::DVec2;
use trove_model::{Bounds, Drive, Polygon, RoadSurface, Seed, SurfaceKind};

use super::tone::Tone;
use crate::geometry::path::{Path, shifted};
use crate::geometry::plane::{difference, intersection, strip, union};
use crate::geometry::segments::SegmentIndex;
use crate::roads::cross_section::Use;
use crate::roads::layout::Layout;
use crate::roads::markings::long_axis;
use crate::roads::network::{Stretch, resampled};

/// Wheels run this far beside a lane's middle; their track reaches this much to both sides.
const WHEEL_M: f64 = 0.85;
const TRACK_HALF_M: f64 = 0.45;
/// What a wheel track and the drip of oil between two reflect, as a factor.
const TRACK_TONE: f64 = 0.83;
const OIL_TONE: f64 = 0.9;
/// Surfaces change at most this often along a road.
const LONGEST_M: f64 = 90.0;
/// Recorded lanes that turn more than this, or are shorter, belong to a junction.
const TURN_RAD: f64 = 0.35;
const SHORTEST_M: f64 = 12.0;
/// Share of the stretches that were laid anew of late.
const FRESH_SHARE: f64 = 0.14;
/// Lanes go on this far into the junctions at their ends, where the dataset has no lanes.
const BEYOND_M: f64 = 18.0;
/// Length of a cast slab.
const SLAB_M: f64 = 5.0;

/// What a road is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Look {
    Aged,
    Fresh,
    Concrete,
    Setts,
    Stones,
    Gravel,
    Soil,
}

impl Look {
    /// Kind of surface, and words in its id.
    pub(super) fn surface(self) -> (SurfaceKind, &'static [&'static str]) {
        match self {
            Self::Aged => (SurfaceKind::Asphalt, &["worn"]),
            Self::Fresh => (SurfaceKind::Asphalt, &["new"]),
            Self::Concrete => (SurfaceKind::Concrete, &["plain"]),
            Self::Setts => (SurfaceKind::Paving, &["setts"]),
            Self::Stones => (SurfaceKind::Paving, &["herringbone"]),
            Self::Gravel => (SurfaceKind::Gravel, &[]),
            Self::Soil => (SurfaceKind::Soil, &[]),
        }
    }

    /// Of what a map says; `None` for asphalt, whose age it does not say.
    fn mapped(surface: RoadSurface) -> Option<Self> {
        Some(match surface {
            RoadSurface::Asphalt => return None,
            RoadSurface::Concrete => Self::Concrete,
            RoadSurface::Setts => Self::Setts,
            RoadSurface::PavingStones => Self::Stones,
            RoadSurface::Gravel => Self::Gravel,
            RoadSurface::Earth => Self::Soil,
        })
    }

    pub(super) fn is_asphalt(self) -> bool {
        matches!(self, Self::Aged | Self::Fresh)
    }
}

/// A piece of road of one surface.
pub(super) struct Region {
    pub(super) area: Vec<Polygon>,
    pub(super) look: Look,
    /// Factor on what its surface reflects.
    pub(super) tone: f64,
    /// Along the road, and what lies to its left and right, metres.
    pub(super) line: Vec<DVec2>,
    pub(super) left_m: f64,
    pub(super) right_m: f64,
    /// Middles of its lanes.
    pub(super) lanes: Vec<Vec<DVec2>>,
    pub(super) seed: Seed,
}

/// A stretch of road before it is cut out of the carriageway.
struct Strip {
    outline: Vec<Polygon>,
    line: Vec<DVec2>,
    edges_m: [f64; 2],
    lanes: Vec<Vec<DVec2>>,
    tagged: Option<Look>,
    /// A street is laid in one go.
    street: Option<String>,
    number: u64,
}

/// Cuts the carriageway near the driven path into stretches that do not overlap; what is left belongs to none.
pub(super) fn regions(
    drive: &Drive,
    layout: &Layout<'_>,
    inner: &[Polygon],
    concrete_share: f64,
    tone: Tone,
    seed: Seed,
) -> Vec<Region> {
    let mut left = inner.to_vec();
    let mut regions = Vec::new();
    let Some(reach) = Bounds::around(inner.iter().flat_map(|p| p.exterior.iter().copied())) else { return regions };
    for strip in recorded(drive).into_iter().chain(mapped(layout, reach)) {
        let near = |p: &Polygon| p.bounds().is_some_and(|b| b.overlaps(&reach));
        if !strip.outline.iter().any(near) {
            continue;
        }
        let area = intersection(&left, &strip.outline);
        if area.is_empty() {
            continue;
        }
        left = difference(&left, &area);
        let laid = strip.street.map_or(seed.nth(strip.number), |street| seed.child(&street));
        let seed = seed.nth(strip.number);
        let mut random = seed.random();
        let middle = strip.line[strip.line.len() / 2];
        let drawn = match laid.child("laid").random().unit() {
            u if u < concrete_share => Look::Concrete,
            u if u < concrete_share + FRESH_SHARE => Look::Fresh,
            _ => Look::Aged,
        };
        regions.push(Region {
            area,
            look: strip.tagged.unwrap_or(drawn),
            // Neighbours are of about the same age.
            tone: 1.0 + 0.14 * tone.at(middle, 70.0) + random.range(-0.1, 0.1),
            line: strip.line,
            left_m: strip.edges_m[0],
            right_m: strip.edges_m[1],
            lanes: strip.lanes,
            seed,
        });
    }
    regions
}

/// The recorded lanes that go straight on, then how they go on into junctions; lanes within junctions overlap and are
/// none.
fn recorded(drive: &Drive) -> Vec<Strip> {
    let mut strips = straight_lanes(drive);
    let beyond: Vec<Strip> = strips.iter().flat_map(|s| [beyond(s, false), beyond(s, true)]).collect();
    strips.extend(beyond);
    strips
}

/// How a lane would go on behind one of its ends.
fn beyond(lane: &Strip, at_end: bool) -> Strip {
    let path = Path::new(&lane.line);
    let (from, along) = path.at(if at_end { path.length_m() } else { 0.0 });
    let far = from + along * if at_end { BEYOND_M } else { -BEYOND_M };
    let line = resampled(&if at_end { [from, far] } else { [far, from] });
    let number = lane.number ^ 1 << (40 + u32::from(at_end));
    Strip {
        outline: strip(&line, lane.edges_m[0]),
        lanes: vec![line.clone()],
        line,
        edges_m: lane.edges_m,
        tagged: None,
        street: None,
        number,
    }
}

fn straight_lanes(drive: &Drive) -> Vec<Strip> {
    let lanes = drive.lane_map.iter().flat_map(|m| &m.lanes).enumerate();
    lanes
        .filter_map(|(i, lane)| {
            let known = (lane.centreline.len() > 1).then(|| lane.centreline.clone());
            let line = resampled(&known.or_else(|| middle(&lane.polygon))?);
            let path = Path::new(&line);
            let turned_rad = path.at(0.0).1.angle_to(path.at(path.length_m()).1).abs();
            if turned_rad > TURN_RAD || path.length_m() < SHORTEST_M {
                return None;
            }
            let half_m = (lane.polygon.area_m2() / path.length_m() / 2.0).clamp(1.2, 3.0);
            Some(Strip {
                outline: union(std::slice::from_ref(&lane.polygon)),
                lanes: vec![line.clone()],
                line,
                edges_m: [half_m, -half_m],
                tagged: None,
                street: None,
                number: i as u64,
            })
        })
        .collect()
}

/// The middle of a lane that is long and straight; it may run against the traffic.
fn middle(lane: &Polygon) -> Option<Vec<DVec2>> {
    let (middle, along, half) = long_axis(lane)?;
    let straight = lane.area_m2() > 0.7 * 4.0 * half.x * half.y && half.x > 3.0 * half.y;
    straight.then(|| vec![middle - along * half.x, middle + along * half.x])
}

/// The map's roads, cut into pieces; lesser ones end at greater ones.
fn mapped(layout: &Layout<'_>, reach: Bounds) -> Vec<Strip> {
    let mut strips = Vec::new();
    let near = |s: &&Stretch<'_>| Bounds::around(s.line.iter().copied()).is_some_and(|b| b.overlaps(&reach));
    let mut stretches: Vec<_> = layout.stretches.iter().filter(near).filter(|s| s.line.len() > 1).collect();
    stretches.sort_by_key(|s| s.road.kind);
    for stretch in stretches {
        let path = Path::new(&stretch.line);
        let pieces = (path.length_m() / LONGEST_M).ceil().max(1.0);
        for i in 0..pieces as usize {
            let at = |k: usize| k as f64 / pieces * path.length_m();
            let line = path.part(at(i), at(i + 1), 0.0);
            if line.len() < 2 {
                continue;
            }
            let half_m = stretch.width_m / 2.0;
            let drives = stretch.section.bands.iter().filter(|b| matches!(b.usage, Use::Forward | Use::Backward));
            strips.push(Strip {
                outline: strip(&line, half_m + 0.5),
                lanes: drives.map(|b| shifted(&line, (b.left_m + b.right_m) / 2.0)).collect(),
                line,
                edges_m: [half_m, -half_m],
                tagged: stretch.road.surface.and_then(Look::mapped),
                street: stretch.road.name.clone(),
                number: (stretch.road.id as u64) << 8 ^ i as u64,
            });
        }
    }
    strips
}

/// Parts of a region in which the tone changes evenly, cut along the edges and middles of the wheels' tracks.
pub(super) fn tracked(region: &Region) -> Vec<Vec<Polygon>> {
    if !(region.look.is_asphalt() || region.look == Look::Concrete) {
        return vec![region.area.clone()];
    }
    if region.look == Look::Concrete {
        return slabs(region);
    }
    let knots = [-WHEEL_M - TRACK_HALF_M, -WHEEL_M, -WHEEL_M + TRACK_HALF_M, 0.0];
    let knots: Vec<f64> = knots.into_iter().chain(knots[..3].iter().rev().map(|k| -k)).collect();
    let mut between: [Vec<Polygon>; 2] = Default::default();
    for lane in &region.lanes {
        for (i, pair) in knots.windows(2).enumerate() {
            let mut ring = shifted(lane, pair[0]);
            ring.extend(shifted(lane, pair[1]).into_iter().rev());
            between[i % 2].push(Polygon::simple(ring).oriented());
        }
    }
    // Neighbours share an edge, and would be one area if they were cut together.
    let [even, odd] = between.map(|strips| union(&strips));
    let odd = difference(&odd, &even);
    let rest = difference(&difference(&region.area, &even), &odd);
    vec![intersection(&region.area, &even), intersection(&region.area, &odd), rest]
}

fn slabs(region: &Region) -> Vec<Vec<Polygon>> {
    let path = Path::new(&region.line);
    let count = (path.length_m() / SLAB_M).ceil() as usize;
    let slab = |i: usize| {
        let line = path.part(i as f64 * SLAB_M, (i + 1) as f64 * SLAB_M, 0.0);
        intersection(&region.area, &strip(&line, region.left_m.max(-region.right_m) + 1.0))
    };
    (0..count).map(slab).collect()
}

/// Joints of a concrete road: across it, and between its lanes.
pub(super) fn joints(region: &Region) -> Vec<Polygon> {
    const HALF_M: f64 = 0.007;
    if region.look != Look::Concrete {
        return Vec::new();
    }
    let path = Path::new(&region.line);
    let count = (path.length_m() / SLAB_M) as usize;
    let across = (1..=count).flat_map(|i| {
        let s_m = i as f64 * SLAB_M;
        strip(&[path.beside(s_m, region.left_m + 1.0), path.beside(s_m, region.right_m - 1.0)], HALF_M)
    });
    let between = region.lanes.windows(2).flat_map(|w| {
        let middle: Vec<DVec2> = w[0].iter().zip(&w[1]).map(|(a, b)| (*a + *b) / 2.0).collect();
        strip(&middle, HALF_M)
    });
    intersection(&union(&across.chain(between).collect::<Vec<_>>()), &region.area)
}

/// The tone that wheels leave at a point.
pub(super) fn track_tone(lanes: &SegmentIndex, tone: Tone, p: DVec2) -> f64 {
    let Some(lane) = lanes.nearest(p, WHEEL_M + TRACK_HALF_M) else { return 1.0 };
    let d = lane.distance_m;
    let worn = 0.6 + 0.4 * tone.at(p, 13.0);
    let (from, share) = if d < WHEEL_M - TRACK_HALF_M {
        (OIL_TONE, 1.0 - d / (WHEEL_M - TRACK_HALF_M))
    } else {
        (TRACK_TONE, 1.0 - ((d - WHEEL_M).abs() / TRACK_HALF_M).min(1.0))
    };
    1.0 + (from - 1.0) * share * worn
}
