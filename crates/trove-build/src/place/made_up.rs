//! A place without recorded traffic, seen from its own streets.

use std::collections::BTreeMap;

use glam::{DMat3, DQuat, DVec2, DVec3};
use trove_model::{
    Bounds, Camera, Distortion, Drive, DriveOrigin, DrivingSide, Ego, EgoBody, Exposure, Keyframe, Lens, MapProjection,
    Outcome, Polygon, Pose, Report, RigCamera, Road, RoadKind, Seed, StreetMap, Trajectory, World,
};

use crate::error::BuildError;
use crate::geometry::path::{Path, closed};
use crate::geometry::segments::SegmentIndex;

/// At most so many views' positions.
const MAX_VIEWS: usize = 20;
/// They stand at least this far apart, metres.
const SPACING_M: f64 = 30.0;
/// Candidates along the roads, metres.
const STEP_M: f64 = 5.0;
/// Share of the side that is left free along the border, so that views do not look out of the place.
const BORDER: f64 = 0.15;
/// Where no lanes are tagged, the middle of the driven lane is this far from a two-way road's middle, metres.
const LANE_OFFSET_M: f64 = 1.75;
/// Between parked vehicles one drives nearly in the middle.
const QUIET_OFFSET_M: f64 = 0.4;
/// No wall is this near to the middle of a vehicle, metres, nor to points ahead of it up to its front.
const WALL_M: f64 = 1.5;
const LOOKED_AT_M: [f64; 3] = [-1.0, 1.2, 3.4];
/// A view has no wall so near to points farther ahead, metres.
const IN_VIEW_M: f64 = 1.0;
const AHEAD_M: [f64; 6] = [5.0, 7.0, 9.0, 12.0, 15.0, 18.0];
/// And a street on whose line, within this, it looks; no view looks off the end of a road, nor at a dead end so far ahead,
/// metres.
const STREET_M: f64 = 5.0;
const ALONG_M: f64 = 12.0;
const DEAD_END_M: f64 = 25.0;
/// The road that leads up to a bridge rises on this many metres at most.
const RAMP_M: f64 = 95.0;
/// Positions are unrelated, so their times lie too far apart for motion between them, nanoseconds.
const STEP_NS: i64 = 60_000_000_000;

/// A place without a recording.
#[derive(Clone, Copy, Debug)]
pub struct PlacePlan<'a> {
    /// Its name.
    pub name: &'a str,
    /// Where on earth its middle, World's origin, is.
    pub projection: MapProjection,
    /// Side of the square around the origin.
    pub size_m: f64,
    /// The side of the road that views stand on.
    pub driving_side: DrivingSide,
    /// Time of the first keyframe, nanoseconds since 1970 UTC.
    pub time_ns: i64,
}

/// A drive without boxes whose keyframes stand on the map's roads, spaced, with six cameras around the roof.
///
/// # Errors
/// A place in which no road runs.
pub fn place_drive(map: &StreetMap, plan: &PlacePlan<'_>, seed: Seed, report: &Report) -> Result<Drive, BuildError> {
    let PlacePlan { name: place, projection, size_m, driving_side, time_ns } = *plan;
    let inner = Bounds::square(DVec2::ZERO, size_m * (1.0 - 2.0 * BORDER));
    let roads = || map.roads.iter().filter(|r| r.kind.is_for_cars() && !r.tunnel && !r.bridge && r.layer == 0);
    let mut candidates: Vec<Pose<World, Ego>> = roads()
        .flat_map(|road| standpoints(road, driving_side))
        .filter(|pose| inner.contains(pose.translation.truncate()))
        .collect();
    if candidates.is_empty() {
        return Err(BuildError::NoRoads { place: place.into(), size_m });
    }

    // Drawn one after the other; what is too near to one that stands is passed over. Those with a view come first.
    let mut random = seed.child("standpoints").random();
    let walls = Walls::new(map, inner);
    let mut drawn: Vec<Pose<World, Ego>> = Vec::new();
    while !candidates.is_empty() {
        drawn.push(candidates.swap_remove(random.index(candidates.len())));
    }
    let streets = SegmentIndex::new(roads().map(|road| road.centreline.as_slice()));
    let (ramps, dead_ends) = (ramps(map), dead_ends(map));
    let is_on_street = |pose: &Pose<World, Ego>| {
        let ahead = pose.point(DVec3::X * ALONG_M).truncate();
        let ego_from_world = pose.inverse();
        let looks_at = |end: &DVec2| {
            let seen = ego_from_world.point(end.extend(pose.translation.z));
            (0.0..DEAD_END_M).contains(&seen.x) && seen.y.abs() < STREET_M
        };
        streets.nearest(ahead, STREET_M).is_some()
            && ramps.nearest(pose.translation.truncate(), STREET_M).is_none()
            && !dead_ends.iter().any(looks_at)
    };
    let (drawn, off_street): (Vec<_>, Vec<_>) = drawn.into_iter().partition(is_on_street);
    let drawn = if drawn.is_empty() { off_street } else { drawn };
    let (with_room, without): (Vec<_>, Vec<_>) = drawn.into_iter().partition(|pose| walls.leave_room(pose));
    let (with_view, narrow): (Vec<_>, Vec<_>) = with_room.into_iter().partition(|pose| walls.leave_view(pose));
    let has_room = !(with_view.is_empty() && narrow.is_empty());
    let mut stands: Vec<Pose<World, Ego>> = Vec::new();
    for pose in with_view.into_iter().chain(narrow).chain(without.into_iter().filter(|_| !has_room)) {
        let is_apart = |s: &Pose<World, Ego>| s.translation.distance(pose.translation) >= SPACING_M;
        if stands.len() < MAX_VIEWS && stands.iter().all(is_apart) {
            stands.push(pose);
        }
    }
    if stands.len() < MAX_VIEWS {
        report.note(Outcome::Warned, "fewer standpoints than usual fit on the place's roads", stands.len());
    }
    let rig = rig();
    let keyframe = |(i, &world_from_ego): (usize, &Pose<World, Ego>)| {
        let time_ns = time_ns + i as i64 * STEP_NS;
        let exposure = |(camera, c): (usize, &RigCamera)| Exposure {
            camera,
            time_ns,
            world_from_ego,
            lens: c.lens,
            ego_from_camera: c.ego_from_camera,
            token: None,
            file: None,
        };
        Keyframe {
            time_ns,
            token: format!("{place}-{i:03}"),
            world_from_ego,
            exposures: rig.iter().enumerate().map(exposure).collect(),
            boxes: Vec::new(),
            lidar: None,
        }
    };
    Ok(Drive {
        id: place.into(),
        dataset: "place".into(),
        origin: DriveOrigin::MadeUp,
        place: place.into(),
        projection,
        is_georeferenced: true,
        keyframes: stands.iter().enumerate().map(keyframe).collect(),
        path: Trajectory::default(),
        lidars: Vec::new(),
        sweeps: Vec::new(),
        rig,
        ego_body: EgoBody { centre_ego: DVec3::new(1.2, 0.0, 0.78), size_m: DVec3::new(4.08, 1.73, 1.56) },
        tracks: Vec::new(),
        lane_map: None,
        licence: String::new(),
    })
}

/// Roads, as far as they may rise to a bridge: no other road on the ground meets them where it begins.
fn ramps(map: &StreetMap) -> SegmentIndex {
    let cars = map.roads.iter().filter(|r| r.kind.is_for_cars() && !r.tunnel);
    let (raised, level): (Vec<&Road>, Vec<&Road>) = cars.partition(|r| r.bridge || r.layer > 0);
    let (begins, met) = (meetings(&raised), meetings(&level));
    let rises = |p: &DVec2| begins.contains_key(&key(p)) && met[&key(p)] == 1;
    let of_road = |road: &&Road| {
        let path = Path::new(&road.centreline);
        let length_m = path.length_m();
        let ends = [(road.centreline.first(), [0.0, RAMP_M]), (road.centreline.last(), [length_m - RAMP_M, length_m])];
        ends.into_iter()
            .filter(|(end, _)| end.is_some_and(rises))
            .map(|(_, [from_m, to_m])| path.part(from_m, to_m, 0.0))
            .collect::<Vec<_>>()
    };
    let lines: Vec<Vec<DVec2>> = level.iter().flat_map(of_road).collect();
    SegmentIndex::new(lines.iter().map(Vec::as_slice))
}

/// Where roads for cars end without another.
fn dead_ends(map: &StreetMap) -> Vec<DVec2> {
    let cars: Vec<&Road> = map.roads.iter().filter(|r| r.kind.is_for_cars()).collect();
    let met = meetings(&cars);
    let ends = cars.iter().flat_map(|road| [road.centreline.first(), road.centreline.last()]).flatten();
    ends.filter(|p| met[&key(p)] == 1).copied().collect()
}

/// How many vertices of roads lie at each place.
fn meetings(roads: &[&Road]) -> BTreeMap<[u64; 2], usize> {
    let mut met = BTreeMap::new();
    for p in roads.iter().flat_map(|road| &road.centreline) {
        *met.entry(key(p)).or_default() += 1;
    }
    met
}

fn key(p: &DVec2) -> [u64; 2] {
    p.to_array().map(f64::to_bits)
}

/// Houses that a vehicle may not stand in, nor at.
struct Walls<'a> {
    footprints: Vec<(&'a Polygon, Bounds)>,
    index: SegmentIndex,
}

impl<'a> Walls<'a> {
    fn new(map: &'a StreetMap, area: Bounds) -> Self {
        let area = area.grown(SPACING_M);
        let with_bounds = map.buildings.iter().filter_map(|b| Some((&b.footprint, b.footprint.bounds()?)));
        let footprints: Vec<_> = with_bounds.filter(|(_, bounds)| bounds.overlaps(&area)).collect();
        let rings: Vec<Vec<DVec2>> = footprints.iter().flat_map(|(p, _)| p.rings()).map(|ring| closed(ring)).collect();
        Self { footprints, index: SegmentIndex::new(rings.iter().map(Vec::as_slice)) }
    }

    fn leave_room(&self, pose: &Pose<World, Ego>) -> bool {
        self.keep_away(pose, &LOOKED_AT_M, WALL_M)
    }

    fn leave_view(&self, pose: &Pose<World, Ego>) -> bool {
        self.keep_away(pose, &AHEAD_M, IN_VIEW_M)
    }

    fn keep_away(&self, pose: &Pose<World, Ego>, ahead_m: &[f64], reach_m: f64) -> bool {
        ahead_m.iter().all(|&ahead_m| {
            let p = pose.point(DVec3::X * ahead_m).truncate();
            let holds = |(polygon, bounds): &(&Polygon, Bounds)| bounds.contains(p) && polygon.contains(p);
            self.index.nearest(p, reach_m).is_none() && !self.footprints.iter().any(holds)
        })
    }
}

/// Poses along a road in a lane of its own, in both directions where it has both.
fn standpoints(road: &Road, driving_side: DrivingSide) -> Vec<Pose<World, Ego>> {
    let lanes = f64::from(road.lanes.unwrap_or(0).max(1));
    let offset_m = match (road.kind, road.lanes, road.width_m) {
        _ if road.oneway => 0.0,
        (RoadKind::Service, None | Some(0 | 1), _) => 0.0,
        (_, _, Some(width_m)) => width_m / 4.0,
        (RoadKind::Residential | RoadKind::Minor, None | Some(0 | 1), None) => QUIET_OFFSET_M,
        _ => LANE_OFFSET_M * (lanes / 2.0).max(1.0).round(),
    };
    let side = if driving_side.is_left() { 1.0 } else { -1.0 };
    let mut poses = Vec::new();
    for segment in road.centreline.windows(2) {
        let Some(along) = (segment[1] - segment[0]).try_normalize() else { continue };
        let count = (segment[0].distance(segment[1]) / STEP_M).floor() as usize;
        for i in 1..=count {
            let middle = segment[0] + along * (i as f64 * STEP_M - STEP_M / 2.0);
            let directions = if road.oneway { vec![along] } else { vec![along, -along] };
            poses.extend(directions.iter().map(|&forward| {
                let position = middle + forward.perp() * side * offset_m;
                Pose::from_yaw(forward.y.atan2(forward.x), position.extend(0.0))
            }));
        }
    }
    poses
}

/// Six cameras like those of nuScenes' vehicles: 70° wide and 60° apart, 110° wide to the back.
fn rig() -> Vec<RigCamera> {
    const WIDE: (f64, f64) = (1266.0, 1.51);
    const MOUNTS: [(&str, f64, [f64; 2], f64); 6] = [
        ("CAM_BACK", 180.0, [0.03, 0.0], 809.0),
        ("CAM_BACK_LEFT", 110.0, [1.04, 0.48], WIDE.0),
        ("CAM_BACK_RIGHT", -110.0, [1.01, -0.48], WIDE.0),
        ("CAM_FRONT", 0.0, [1.70, 0.02], WIDE.0),
        ("CAM_FRONT_LEFT", 55.0, [1.52, 0.49], WIDE.0),
        ("CAM_FRONT_RIGHT", -55.0, [1.55, -0.49], WIDE.0),
    ];
    let ahead = DQuat::from_mat3(&DMat3::from_cols(-DVec3::Y, -DVec3::Z, DVec3::X));
    let camera = |(name, heading_deg, [x, y], focal_px): (&str, f64, [f64; 2], f64)| RigCamera {
        name: name.into(),
        lens: Lens {
            width_px: 1600,
            height_px: 900,
            fx_px: focal_px,
            fy_px: focal_px,
            cx_px: 800.0,
            cy_px: 450.0,
            distortion: Distortion::None,
        },
        ego_from_camera: Pose::<Ego, Camera>::new(
            DQuat::from_rotation_z(heading_deg.to_radians()) * ahead,
            DVec3::new(x, y, WIDE.1),
        ),
    };
    MOUNTS.map(camera).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Building;

    fn map() -> StreetMap {
        let road = |id: i64, ends: [[f64; 2]; 2]| crate::testing::road(id, RoadKind::Tertiary, &ends);
        StreetMap {
            roads: vec![road(1, [[-300.0, 0.0], [300.0, 0.0]]), road(2, [[0.0, -300.0], [0.0, 300.0]])],
            ..StreetMap::default()
        }
    }

    fn plan(driving_side: DrivingSide) -> PlacePlan<'static> {
        let projection = MapProjection::spherical(60.17, 24.94, DVec2::ZERO);
        PlacePlan { name: "p", projection, size_m: 400.0, driving_side, time_ns: 0 }
    }

    #[test]
    fn views_stand_spaced_in_the_right_lane_within_the_place() {
        for (driving_side, sign) in [(DrivingSide::Right, 1.0), (DrivingSide::Left, -1.0)] {
            let drive = place_drive(&map(), &plan(driving_side), Seed(1), &Report::default()).unwrap();
            assert!(drive.keyframes.len() >= 8);
            for (i, a) in drive.keyframes.iter().enumerate() {
                let position = a.world_from_ego.translation;
                assert!(position.abs().max_element() <= 140.0);
                let own = a.world_from_ego.vector(-DVec3::Y) * sign;
                assert!((position * own.abs()).length() < 2.0 && position.dot(own) > 1.0, "{position}");
                let near = |b: &Keyframe| b.world_from_ego.translation.distance(position) < SPACING_M;
                assert!(!drive.keyframes[i + 1..].iter().any(near));
            }
        }
    }

    #[test]
    fn views_keep_from_walls_unless_there_is_no_room_at_all() {
        let house = |low: [f64; 2], high: [f64; 2]| {
            let corners = [low, [high[0], low[1]], high, [low[0], high[1]]].map(DVec2::from_array);
            Building::new(3, Polygon::simple(corners.to_vec()), None)
        };
        let stands = |house: Building| {
            let map = StreetMap { buildings: vec![house], ..map() };
            let drive = place_drive(&map, &plan(DrivingSide::Right), Seed(1), &Report::default()).unwrap();
            drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect::<Vec<_>>()
        };
        // Before the northern lane of the street along x, up to a metre from the vehicle's middle.
        let beside = stands(house([-300.0, 2.75], [300.0, 12.0]));
        assert!(beside.len() >= 8 && beside.iter().all(|p| p.y.abs() > 14.0 || p.y < 0.0), "{beside:?}");
        assert!(beside.iter().any(|p| (p.y + LANE_OFFSET_M).abs() < 0.01));
        assert!(!stands(house([-300.0, -300.0], [300.0, 300.0])).is_empty());
    }

    #[test]
    fn no_view_looks_off_the_end_of_a_road() {
        let road = crate::testing::road(1, RoadKind::Tertiary, &[[-300.0, 0.0], [60.0, 0.0]]);
        let map = StreetMap { roads: vec![road], ..StreetMap::default() };
        for seed in 0..20 {
            let drive = place_drive(&map, &plan(DrivingSide::Right), Seed(seed), &Report::default()).unwrap();
            for keyframe in &drive.keyframes {
                let pose = keyframe.world_from_ego;
                assert!(pose.vector(DVec3::X).x < 0.0 || pose.translation.x <= 60.0 - DEAD_END_M, "{pose:?}");
            }
        }
    }

    #[test]
    fn no_view_stands_where_a_road_rises_to_a_bridge() {
        let road = |id, ends: [f64; 2]| crate::testing::road(id, RoadKind::Tertiary, &ends.map(|x| [x, 0.0]));
        let bridge = Road { bridge: true, layer: 1, ..road(2, [60.0, 200.0]) };
        let beyond_m = 60.0 - RAMP_M;
        for crossed in [false, true] {
            let mut map = StreetMap { roads: vec![road(1, [-300.0, 60.0]), bridge.clone()], ..StreetMap::default() };
            if crossed {
                map.roads.push(crate::testing::road(3, RoadKind::Tertiary, &[[60.0, 0.0], [60.0, -300.0]]));
            }
            let places = (0..20).flat_map(|seed| {
                let drive = place_drive(&map, &plan(DrivingSide::Right), Seed(seed), &Report::default()).unwrap();
                drive.keyframes.iter().map(|k| k.world_from_ego.translation).collect::<Vec<_>>()
            });
            let on_ramp = places.filter(|p| p.y.abs() < 5.0 && (beyond_m..50.0).contains(&p.x)).count();
            assert_eq!(on_ramp > 0, crossed, "what meets a junction does not rise");
        }
    }

    #[test]
    fn a_place_without_roads_is_an_error() {
        let error = place_drive(&StreetMap::default(), &plan(DrivingSide::Right), Seed(1), &Report::default());
        assert!(matches!(error, Err(BuildError::NoRoads { .. })));
    }
}
