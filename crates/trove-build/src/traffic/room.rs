//! Who is where when: made-up road users keep clear of each other, of recorded ones and of all that stands still.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use trove_model::{Body, Cuboid, Drive, Instance, Kind, Mesh, Pose, World};

use super::motion::{Motion, On};
use crate::assembly::Assembly;
use crate::geometry::plane_raster::bucket;
use crate::place::next;
use crate::placement::ego_cuboid;
use crate::roads::{Footing, RoadSurfaces};
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;

/// Fewer keyframes than this are no visit, where there are more.
pub(super) const FEWEST_KEYFRAMES: usize = 3;
/// Side of a bucket of what stands still, metres.
const BUCKET_M: f64 = 8.0;
/// What begins higher than this is walked and driven under, metres.
const OVERHEAD_M: f64 = 2.3;
/// Half the distance of what holds a fence.
const FENCE_M: f64 = 0.6;
/// Half the width of trunks and poles, metres.
const POLE_M: f64 = 0.25;
/// People keep so far from walls, vehicles from everything, and all from the recording vehicle's ends, metres.
const WALL_M: f64 = 0.3;
const VEHICLE_M: f64 = 0.35;
const EGO_M: f64 = 1.2;
/// Vehicles keep the way of so many seconds ahead and behind.
const HEADWAY_S: f64 = 0.4;

/// A rectangle on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outline {
    pub centre: DVec2,
    /// Its heading, unit.
    pub along: DVec2,
    /// Half of length and width.
    pub half_m: DVec2,
}

impl Outline {
    pub(super) fn of(cuboid: &Cuboid) -> Self {
        let pose = &cuboid.world_from_body;
        let along = DVec2::from_angle(pose.yaw_rad());
        Self { centre: pose.translation.truncate(), along, half_m: cuboid.size_m.truncate() / 2.0 }
    }

    fn grown(&self, ahead_m: f64, aside_m: f64) -> Self {
        Self { half_m: self.half_m + DVec2::new(ahead_m, aside_m), ..*self }
    }

    /// Pose of a box whose middle is so high.
    pub(super) fn world_from_body(&self, z_m: f64) -> Pose<World, Body> {
        Pose::from_yaw(self.along.to_angle(), self.centre.extend(z_m))
    }

    fn corners(&self) -> [DVec2; 4] {
        let (ahead, aside) = (self.along * self.half_m.x, self.along.perp() * self.half_m.y);
        [ahead + aside, aside - ahead, -ahead - aside, ahead - aside].map(|d| self.centre + d)
    }

    /// Whether two share a point: no axis of either parts them.
    pub(super) fn meets(&self, other: &Self) -> bool {
        let apart = other.centre - self.centre;
        let reach_m = self.half_m.length() + other.half_m.length();
        apart.length_squared() <= reach_m * reach_m
            && [self.along, self.along.perp(), other.along, other.along.perp()].into_iter().all(|axis| {
                let half_m =
                    |o: &Self| o.half_m.x * o.along.dot(axis).abs() + o.half_m.y * o.along.perp_dot(axis).abs();
                apart.dot(axis).abs() <= half_m(self) + half_m(other)
            })
    }

    fn buckets(&self) -> impl Iterator<Item = [i64; 2]> + use<> {
        let reach_m = self.half_m.length();
        let (low, high) = (bucket(self.centre - reach_m, BUCKET_M), bucket(self.centre + reach_m, BUCKET_M));
        (low[0]..=high[0]).flat_map(move |x| (low[1]..=high[1]).map(move |y| [x, y]))
    }
}

/// Where someone is, by moment: twice the keyframe's index, and one more for halfway to the next.
pub(super) struct Visit(Vec<(usize, Outline)>);

impl Visit {
    pub(super) fn at_keyframes(&self) -> impl Iterator<Item = (usize, &Outline)> {
        self.0.iter().filter(|(moment, _)| moment % 2 == 0).map(|(moment, outline)| (moment / 2, outline))
    }
}

/// All the room there is.
pub(super) struct Room<'a> {
    drive: &'a Drive,
    surfaces: &'a RoadSurfaces,
    clearance: &'a Clearance<'a>,
    /// What stands still. Only ever looked up, so the order inside does not reach a result.
    standing: HashMap<[i64; 2], Vec<Outline>>,
    /// Who is there at each moment.
    taken: Vec<Vec<Outline>>,
}

impl<'a> Room<'a> {
    pub(super) fn new(
        around: &Surroundings<'a>,
        absent: &BTreeSet<usize>,
        clearance: &'a Clearance<'a>,
        assembly: &Assembly,
    ) -> Self {
        let mut standing: HashMap<[i64; 2], Vec<Outline>> = HashMap::new();
        for outline in assembly.fixed.iter().flat_map(|fixed| obstacles(around, fixed, &assembly.stock.meshes)) {
            for key in outline.buckets() {
                standing.entry(key).or_default().push(outline);
            }
        }
        let drive = around.place.drive;
        let mut taken = vec![Vec::new(); 2 * drive.keyframes.len()];
        for (k, keyframe) in drive.keyframes.iter().enumerate() {
            let ego = Outline::of(&ego_cuboid(drive, keyframe)).grown(EGO_M, EGO_M / 2.0);
            let present = keyframe.boxes.iter().filter(|b| !absent.contains(&b.track));
            taken[2 * k] = present.map(|b| Outline::of(&b.cuboid)).chain([ego]).collect();
        }
        for k in (0..drive.keyframes.len()).filter(|&k| next(drive, k).is_some()) {
            let [now, then] = [k, k + 1].map(|k| &drive.keyframes[k]);
            let between = |a: &Cuboid, b: &Cuboid| {
                let world_from_body = a.world_from_body.interpolate(&b.world_from_body, 0.5);
                Outline::of(&Cuboid { world_from_body, ..*a })
            };
            let ego = between(&ego_cuboid(drive, now), &ego_cuboid(drive, then)).grown(EGO_M, EGO_M / 2.0);
            let present = now.boxes.iter().filter(|b| !absent.contains(&b.track));
            let moving = present.filter_map(|b| Some(between(&b.cuboid, &drive.tracks.get(b.track)?.at(k + 1)?)));
            taken[2 * k + 1] = moving.chain([ego]).collect();
        }
        Self { drive, surfaces: around.stand.surfaces, clearance, standing, taken }
    }

    /// Where someone is at the moments of a run of keyframes, drawn for one of them; `None` where there is no room at one
    /// of them, or nobody comes by at enough of them.
    pub(super) fn visit(&self, motion: &Motion, keyframe: usize, run: &Range<usize>) -> Option<Visit> {
        let seconds =
            |k: usize| (self.drive.keyframes[k].time_ns - self.drive.keyframes[keyframe].time_ns) as f64 * 1e-9;
        let moments = || 2 * run.start..2 * run.end - 1;
        let time_s =
            |m: usize| if m.is_multiple_of(2) { seconds(m / 2) } else { (seconds(m / 2) + seconds(m / 2 + 1)) / 2.0 };
        let poses = motion.poses(moments().map(time_s));
        let outline = |[centre, along]: [DVec2; 2]| Outline { centre, along, half_m: motion.size_m.truncate() / 2.0 };
        let visit: Vec<(usize, Outline)> =
            moments().zip(poses).filter_map(|(m, pose)| Some((m, outline(pose?)))).collect();
        let keyframes = visit.iter().filter(|(m, _)| m % 2 == 0).count();
        let stays = keyframes >= FEWEST_KEYFRAMES.min(run.len()) && visit.iter().any(|(m, _)| *m == 2 * keyframe);
        (stays && visit.iter().all(|(m, o)| self.is_free(motion, *m, o))).then_some(Visit(visit))
    }

    pub(super) fn take(&mut self, visit: &Visit) {
        for (moment, outline) in &visit.0 {
            self.taken[*moment].push(*outline);
        }
    }

    fn is_free(&self, motion: &Motion, moment: usize, outline: &Outline) -> bool {
        let footing = match motion.on {
            On::Sidewalk => Footing::Sidewalk,
            On::Carriageway => Footing::Carriageway,
        };
        let (ahead_m, aside_m) = match motion.on {
            On::Sidewalk => (0.0, 0.0),
            On::Carriageway => (VEHICLE_M + HEADWAY_S * motion.speed_mps, VEHICLE_M),
        };
        let wide = outline.grown(ahead_m, aside_m);
        let is_in_the_way = |other: &Outline| wide.meets(other);
        outline
            .corners()
            .into_iter()
            .chain([outline.centre])
            .all(|p| self.surfaces.footing(p) == footing && self.clearance.building_distance_m(p) > WALL_M)
            && !self.taken[moment].iter().any(is_in_the_way)
            && !outline.buckets().filter_map(|key| self.standing.get(&key)).flatten().any(|other| outline.meets(other))
    }
}

/// What of a thing that stands still is in the way; buildings are asked by their distance.
fn obstacles(around: &Surroundings, instance: &Instance, meshes: &[Arc<Mesh>]) -> Vec<Outline> {
    let Some(object) = instance.object.as_ref().filter(|object| object.kind != Kind::Building) else {
        return Vec::new();
    };
    let around_point =
        |point: DVec3, half_m: f64| Outline { centre: point.truncate(), along: DVec2::X, half_m: DVec2::splat(half_m) };
    let from_mesh = &instance.world_from_mesh;
    if object.kind.is_on_pole() {
        return vec![around_point(from_mesh.transform_point3(DVec3::ZERO), POLE_M)];
    }
    // A long fence is in no box of its own, but all along its line.
    if matches!(object.kind, Kind::Fence | Kind::Wall | Kind::GuardRail) {
        let points = meshes[instance.mesh].positions.iter().map(|p| from_mesh.transform_point3(p.as_dvec3()));
        let cells: BTreeSet<[i64; 2]> = points.map(|p| bucket(p.truncate(), FENCE_M)).collect();
        let middle = |[x, y]: [i64; 2]| (DVec2::new(x as f64, y as f64) + 0.5) * FENCE_M;
        return cells.into_iter().map(|cell| around_point(middle(cell).extend(0.0), FENCE_M)).collect();
    }
    let cuboid = &object.cuboid;
    let centre_world = cuboid.world_from_body.translation;
    let bottom_m = centre_world.z - cuboid.size_m.z / 2.0 - around.stand.surface_m(centre_world.truncate());
    if bottom_m < OVERHEAD_M { vec![Outline::of(cuboid)] } else { Vec::new() }
}
