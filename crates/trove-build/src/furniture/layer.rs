//! Lays pieces of the library along lines, draped over the ground: an object a straight stretch.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec2, Mat3, Vec3};
use trove_model::{Asset, Kind, Material, Mesh, Outcome, Report, Road, Seed, StreetMap};

use super::yard::Yard;
use crate::geometry::plane_raster::bucket;
use crate::geometry::segments::SegmentIndex;
use crate::pieces::Piece;
use crate::surroundings::Room;

/// One object is at most this long, metres.
const OBJECT_M: f64 = 40.0;
/// Beyond this from the driven path a coarser piece will do, metres, and beyond that none is made up.
const NEAR_M: f64 = 60.0;
const SEEN_M: f64 = 220.0;
/// A fence is open where a path or road crosses it, metres to each side of the middle.
const GAP_M: f64 = 1.1;
/// A kerb's road is at most this far from it, metres.
pub(super) const ROAD_REACH_M: f64 = 16.0;
/// Tag of a coarser piece, whose other tags are those of the piece that it stands for.
const FAR: &str = "far";
/// Pieces are let into the ground, which is not as straight as they are, metres.
const SUNK_M: f64 = 0.04;
/// Vertices nearer than this to a straight line are left out, metres.
const STRAIGHT_M: f64 = 0.06;
/// Lines this near to each other are one, metres.
const LAID_M: f64 = 0.25;
/// Room is looked for at places this far apart, metres.
const SAMPLE_M: f64 = 0.4;
/// Side of the buckets of what has been laid, metres.
const BUCKET_M: f64 = 8.0;

/// What is to stand along a line.
pub(super) struct Run<'l> {
    pub kind: Kind,
    /// What the piece is tagged with.
    pub tags: &'l [&'l str],
    pub line: &'l [DVec2],
    /// Height over the model's own.
    pub scale: f64,
    /// How wide it looks to a camera, metres: what is made up keeps away from those. None where the map has it.
    pub in_sight_m: Option<f64>,
}

/// What has been laid along lines so far.
pub(super) struct Layer<'y, 'a, 'b, 'c> {
    pub yard: &'y mut Yard<'a, 'b, 'c>,
    /// Everything that is driven or walked on.
    ways: SegmentIndex,
    path: SegmentIndex,
    pieces: Vec<Piece>,
    /// Pieces of lines by place.
    laid: BTreeMap<[i64; 2], Vec<[DVec2; 2]>>,
    /// How many lines came so far: each is painted alike from end to end.
    runs: u64,
    seed: Seed,
}

impl<'y, 'a, 'b, 'c> Layer<'y, 'a, 'b, 'c> {
    pub(super) fn new(yard: &'y mut Yard<'a, 'b, 'c>, map: &StreetMap, seed: Seed) -> Self {
        let ways: Vec<&Road> = map.roads.iter().filter(|r| !r.tunnel).collect();
        let path = yard.around.place.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate());
        let path: Vec<DVec2> = path.collect();
        Self {
            yard,
            ways: SegmentIndex::new(ways.iter().map(|r| r.centreline.as_slice())),
            path: SegmentIndex::new([path.as_slice()]),
            pieces: Vec::new(),
            laid: BTreeMap::new(),
            runs: 0,
            seed,
        }
    }

    /// The line the way round that has the nearest carriageway on its right.
    pub(super) fn traffic_on_the_right(&self, mut line: Vec<DVec2>) -> Vec<DVec2> {
        let middle = line[line.len() / 2];
        let before = line[(line.len() / 2).saturating_sub(1)];
        let kerb = self.yard.around.kerbs.near(middle, ROAD_REACH_M).first().copied();
        if kerb.is_some_and(|k| (middle - before).perp_dot(-k.outward) > 0.0) {
            line.reverse();
        }
        line
    }

    /// One object a straight stretch.
    pub(super) fn lay(&mut self, run: &Run<'_>, report: &Report) {
        self.runs += 1;
        let library = self.yard.library;
        let Some(near) = library.tagged(run.kind, run.tags).find(|a| !a.tags.has(FAR)) else {
            let what = "line without an asset to build it from";
            return report.note(Outcome::Dropped, what, run.tags.join("/"));
        };
        let is_like_near = |a: &&Asset| near.tags.iter().all(|tag| a.tags.has(tag));
        let far = library.tagged(run.kind, &[FAR]).find(is_like_near).unwrap_or(near);
        let half_m = near.size_m.y / 2.0;
        for [from, to] in apart(&simplified(run.line), half_m) {
            let count = (from.distance(to) / near.size_m.x).round().max(1.0);
            let (mut object, mut object_m) = (Object::default(), 0.0);
            for i in 0..count as usize {
                let [a, b] = [i, i + 1].map(|k| from.lerp(to, k as f64 / count));
                let asset = if self.path.nearest(a, NEAR_M).is_some() { near } else { far };
                let goes_on = object_m < OBJECT_M && object.asset.is_none_or(|o: &Asset| o.id == asset.id);
                let free = self.is_free(a, b, run.in_sight_m);
                if !free || !goes_on {
                    self.finish(&mut object, run.kind);
                    object_m = 0.0;
                }
                if !free {
                    continue;
                }
                let ends = [a, b].map(|p| p.extend(self.yard.around.stand.surface_m(p) - SUNK_M));
                let origin = *object.origin.get_or_insert(ends[0]);
                object.asset = Some(asset);
                append(&mut object.mesh, asset, ends.map(|p| (p - origin).as_vec3()), run.scale as f32);
                object_m += a.distance(b);
                self.laid.entry(bucket((a + b) / 2.0, BUCKET_M)).or_default().push([a, b]);
            }
            self.finish(&mut object, run.kind);
        }
    }

    /// Off the carriageway, out of buildings, clear of what was recorded, of ways that cross, of cameras and of what has
    /// been laid.
    fn is_free(&self, a: DVec2, b: DVec2, in_sight_m: Option<f64>) -> bool {
        let room = Room { road_m: 0.0, buildings_m: 0.15, recorded_m: 0.35, radius_m: 0.1 };
        let along = (b - a).normalize_or_zero();
        let crossed = |p: DVec2| self.ways.nearest(p, GAP_M).is_some_and(|n| n.along.dot(along).abs() < 0.8);
        let out_of_sight =
            |p: DVec2| in_sight_m.is_none_or(|width_m| !self.yard.in_sight(p, width_m) && self.is_seen(p));
        let free = |p: DVec2| {
            self.yard.around.place.bounds.contains(p)
                && self.yard.clearance.is_free(p, &room)
                && !crossed(p)
                && out_of_sight(p)
        };
        samples(a, b).all(free) && !self.is_laid((a + b) / 2.0)
    }

    /// Whether a position is near enough to the driven path to make something up there.
    pub(super) fn is_seen(&self, p: DVec2) -> bool {
        self.path.nearest(p, SEEN_M).is_some()
    }

    /// Whether a piece lies at a position already: maps draw a fence on a wall with the same nodes.
    fn is_laid(&self, p: DVec2) -> bool {
        let [x, y] = bucket(p, BUCKET_M);
        let near = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let mut pieces = near.filter_map(|key| self.laid.get(&key)).flatten();
        pieces.any(|[a, b]| {
            let t = ((p - *a).dot(*b - *a) / (*b - *a).length_squared().max(1e-9)).clamp(0.0, 1.0);
            a.lerp(*b, t).distance(p) < LAID_M
        })
    }

    /// Keeps what comes later off the lines.
    pub(super) fn take(self) -> Vec<Piece> {
        for [a, b] in self.laid.values().flatten() {
            samples(*a, *b).for_each(|p| self.yard.clearance.take(p, LAID_M));
        }
        self.pieces
    }

    fn finish(&mut self, object: &mut Object<'a>, kind: Kind) {
        let Object { asset: Some(asset), origin: Some(origin), mesh } = std::mem::take(object) else { return };
        let mut random = self.seed.child("paint").nth(self.runs).random();
        let mut paint: Option<Vec3> = None;
        let materials = asset.slots.iter().map(|slot| {
            // All parts of a fence that are painted are painted alike.
            let drawn = paint.filter(|p| slot.paints.contains(p)).or_else(|| random.pick(&slot.paints).copied());
            paint = paint.or(drawn);
            Material { base_color: drawn.unwrap_or(slot.material.base_color), ..slot.material.clone() }
        });
        self.pieces.push(Piece {
            materials: materials.collect(),
            mesh: Arc::new(mesh),
            world_from_mesh: DAffine3::from_translation(origin),
            class: asset.class,
            kind: Some(kind),
            asset: Some(asset.id.clone()),
        });
    }
}

/// Part of a line that is one object.
#[derive(Default)]
struct Object<'a> {
    asset: Option<&'a Asset>,
    origin: Option<glam::DVec3>,
    mesh: Mesh,
}

/// Adds a piece between two places, stretched to fill it and sheared to the slope.
fn append(mesh: &mut Mesh, asset: &Asset, [a, b]: [Vec3; 2], scale: f32) {
    let piece = &asset.mesh;
    let length_m = asset.size_m.x as f32;
    let along = (b - a).truncate().normalize_or(glam::Vec2::X);
    let turn = Mat3::from_cols(along.extend(0.0), along.perp().extend(0.0), Vec3::Z);
    let base = mesh.positions.len() as u32;
    mesh.positions.extend(piece.positions.iter().map(|p| {
        let across = turn.y_axis * p.y;
        a.lerp(b, p.x / length_m + 0.5) + across + Vec3::Z * (p.z * scale)
    }));
    mesh.normals.extend(piece.normals.iter().map(|n| turn * *n));
    mesh.uvs.extend(&piece.uvs);
    mesh.triangles.extend(piece.triangles.iter().map(|t| t.map(|i| i + base)));
    mesh.slots.extend((0..piece.triangles.len()).map(|t| piece.slot(t)));
}

fn samples(a: DVec2, b: DVec2) -> impl Iterator<Item = DVec2> {
    let steps = (a.distance(b) / SAMPLE_M).ceil().max(1.0) as usize;
    (0..=steps).map(move |i| a.lerp(b, i as f64 / steps as f64))
}

/// The straight stretches of a line of some half width, none of them in another: at a bend one fills the corner and the
/// next begins beside it, and both of the line's ends stop short of what they may meet.
fn apart(line: &[DVec2], half_m: f64) -> Vec<[DVec2; 2]> {
    let along = |i: usize| (line[i + 1] - line[i]).normalize_or_zero();
    let last = line.len().saturating_sub(2);
    let bend = |i: usize| along(i).perp_dot(along(i + 1)).abs() * half_m;
    let mut stretches = Vec::new();
    for i in 0..line.len().saturating_sub(1) {
        let cut_m = if i == 0 { half_m } else { bend(i - 1) };
        let reach_m = if i == last { -half_m } else { bend(i) };
        let stretch = [line[i] + along(i) * cut_m, line[i + 1] + along(i) * reach_m];
        if line[i].distance(line[i + 1]) > cut_m - reach_m + 0.2 {
            stretches.push(stretch);
        }
    }
    stretches
}

/// The line without vertices that hardly bend it, and without steps of no length.
fn simplified(line: &[DVec2]) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::new();
    for (i, &p) in line.iter().enumerate() {
        if kept.last().is_some_and(|last| last.distance(p) < 0.05) {
            continue;
        }
        while kept.len() > 1 {
            let [a, b] = [kept[kept.len() - 2], kept[kept.len() - 1]];
            let off_m = (p - a).normalize_or_zero().perp_dot(b - a).abs();
            let first = line[..i].iter().rposition(|q| *q == a).unwrap_or(0);
            let straight =
                line[first..i].iter().all(|q| (p - a).normalize_or_zero().perp_dot(*q - a).abs() < STRAIGHT_M);
            if off_m >= STRAIGHT_M || !straight || (p - b).dot(b - a) < 0.0 {
                break;
            }
            kept.pop();
        }
        kept.push(p);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_piece_reaches_from_end_to_end_and_follows_the_slope() {
        let asset = testing::asset("fence/a", Kind::Fence, [2.0, 0.1, 1.5]);
        let mut mesh = Mesh::default();
        append(&mut mesh, &asset, [Vec3::ZERO, Vec3::new(0.0, 3.0, 1.0)], 2.0);
        let (low, high) = mesh.bounds().unwrap();
        assert!((low - Vec3::new(-0.05, 0.0, 0.0)).length() < 1e-5, "{low}");
        assert!((high - Vec3::new(0.05, 3.0, 4.0)).length() < 1e-5, "{high}");
    }

    #[test]
    fn a_straight_line_of_many_vertices_is_one_step_and_a_bend_stays() {
        let line: Vec<DVec2> = (0..9).map(|i| DVec2::new(f64::from(i), 0.01 * f64::from(i % 2))).collect();
        assert_eq!(simplified(&line), [line[0], line[8]]);
        let bent = [[0.0, 0.0], [2.0, 0.0], [4.0, 1.0]].map(DVec2::from_array);
        assert_eq!(simplified(&bent), bent);
    }

    #[test]
    fn stretches_of_a_wall_share_no_corner() {
        let line = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]].map(DVec2::from_array);
        let found = apart(&line, 0.2);
        assert_eq!(found.len(), 2);
        let near = |p: DVec2, x: f64, y: f64| p.distance(DVec2::new(x, y)) < 1e-9;
        assert!(near(found[0][0], 0.2, 0.0) && near(found[0][1], 4.2, 0.0), "{found:?}");
        assert!(near(found[1][0], 4.0, 0.2) && near(found[1][1], 4.0, 2.8), "{found:?}");
    }
}
