//! OpenLane's lane lines in three dimensions: a JSON file a picture, beside the picture.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use serde_json::{Value, json};
use trove_format::{FrameTable, LanesFile};
use trove_model::{MarkPattern, Paint, Raster};

use super::dataset::Dataset;
use super::geometry::{affine, camera_from_world};
use super::kitti::note_distortion;
use super::plan::{Plan, PlannedFrame};
use super::unit::Unit;
use crate::frame_table::matrix;
use crate::{WriteError, jpeg};

/// `images/<split>/<sequence>/<frame>.jpg` and `lane3d_1000/<split>/<sequence>/<frame>.json`.
pub(super) struct OpenLane;

const JPEG_QUALITY: u8 = 95;
/// Lines are told this far ahead of the camera, and no nearer, metres.
const AHEAD_M: f64 = 100.0;
const NEAREST_M: f64 = 1.0;
/// From one point of a line to the next, at most, metres.
const STEP_M: f64 = 0.5;
/// A line of fewer points in the picture is none.
const FEWEST: usize = 2;
/// OpenLane's numbers of kerbs on the left and right of who looks along them.
const LEFT_KERB: u8 = 20;
const RIGHT_KERB: u8 = 21;
/// A surface hides a point if it is nearer by this share of the point's depth and this much, metres.
const NEARER_SHARE: f64 = 0.02;
const NEARER_M: f64 = 0.1;
/// The lines to the left and right of the vehicle are looked for so far ahead of it, metres.
const BESIDE_M: std::ops::Range<f64> = 0.0..30.0;
/// The form's names of the splits.
const SPLITS: [(&str, &str); 2] = [("train", "training"), ("val", "validation")];

impl Dataset for OpenLane {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for planned in frames.iter().map(|i| &plan.frames[*i]) {
            let frame = plan.open(planned)?;
            note_distortion(&frame.table, unit);
            let split = SPLITS.iter().find(|(ours, _)| *ours == planned.split).map_or("training", |(_, theirs)| theirs);
            let path = format!("{split}/{}", name(planned));
            let rgb = frame.rgb()?;
            let picture = format!("images/{path}.jpg");
            unit.write(&picture, &jpeg::packed(&picture, rgb.width, rgb.height, &rgb.data, JPEG_QUALITY)?)?;
            let lanes = LanesFile::read(&plan.variation(planned))?;
            let labels = labels(&frame.table, &lanes, &frame.depth_m()?, &format!("{path}.jpg"));
            unit.write(&format!("lane3d_1000/{path}.json"), labels.to_string().as_bytes())?;
        }
        Ok(())
    }
}

/// Sequence and frame: a segment is one camera's frames of a variation of a drive.
fn name(frame: &PlannedFrame) -> String {
    let PlannedFrame { scene, variation, keyframe, view, .. } = frame;
    format!("segment-{scene}_v{variation:02}_{view}/{keyframe:03}")
}

fn labels(table: &FrameTable, lanes: &LanesFile, depth_m: &Raster<f32>, file: &str) -> Value {
    let world_from_ego = table.world_from_ego.as_ref().map_or(DAffine3::IDENTITY, affine);
    let camera = Camera { camera_from_world: camera_from_world(table), intrinsics: table.intrinsics, depth_m };
    let lines = lanes.lines.iter().flat_map(|line| {
        let pattern = |back: bool| if back { seen_back(line.pattern) } else { line.pattern };
        let category = move |back: bool| category(line.paint, pattern(back));
        seen(&line.points_m, &camera).into_iter().map(move |part| (line.id, category(part.is_reversed), part))
    });
    let kerbs = lanes.kerbs.iter().flat_map(|kerb| {
        // The carriageway is on the left of its points.
        let category = |back: bool| if back { LEFT_KERB } else { RIGHT_KERB };
        seen(&kerb.points_m, &camera).into_iter().map(move |part| (kerb.id, category(part.is_reversed), part))
    });
    let seen: Vec<(u32, u8, Seen)> = lines.chain(kerbs).collect();
    let sides: Vec<Option<f64>> = seen.iter().map(|(.., part)| beside_m(part, &world_from_ego.inverse())).collect();
    let row = |((id, category, part), side): (&(u32, u8, Seen), &Option<f64>)| {
        row(*id, *category, part, attribute(*side, &sides))
    };
    let rows: Vec<Value> = seen.iter().zip(&sides).map(row).collect();
    let world_from_forward = affine(&table.world_from_camera) * camera_from_forward();
    json!({
        "extrinsic": matrix(world_from_ego.inverse() * world_from_forward),
        "intrinsic": table.intrinsics,
        "pose": matrix(world_from_ego),
        "file_path": file,
        "lane_lines": rows,
    })
}

/// What looks at lines.
struct Camera<'a> {
    camera_from_world: DAffine3,
    intrinsics: [[f64; 3]; 3],
    depth_m: &'a Raster<f32>,
}

/// A part of a line or kerb that lies in the picture and goes away from the camera all the way.
struct Seen {
    /// Whether it is told the other way round in `lanes.json`.
    is_reversed: bool,
    /// World, from the nearest to the farthest.
    points: Vec<DVec3>,
    /// In the camera's axes as Waymo and OpenLane have them.
    xyz: Vec<DVec3>,
    uv: Vec<DVec2>,
    visible: Vec<bool>,
}

/// The parts of a line that lie in the picture, hidden or not.
fn seen(points_m: &[[f64; 3]], camera: &Camera<'_>) -> Vec<Seen> {
    let Camera { camera_from_world, intrinsics, depth_m } = camera;
    let forward_from_camera = camera_from_forward().inverse();
    let [[fx, _, cx], [_, fy, cy], _] = *intrinsics;
    let size = DVec2::new(depth_m.width.into(), depth_m.height.into());
    let points = dense(&points_m.iter().map(|&p| DVec3::from_array(p)).collect::<Vec<_>>());
    let looked = points.into_iter().map(|world| {
        let camera = camera_from_world.transform_point3(world);
        let uv = DVec2::new(fx * camera.x / camera.z + cx, fy * camera.y / camera.z + cy);
        let inside = (uv.cmpge(DVec2::ZERO) & uv.cmplt(size)).all();
        (world, camera, uv, (NEAREST_M..AHEAD_M).contains(&camera.z) && inside)
    });
    let looked: Vec<_> = looked.collect();
    let runs = looked.chunk_by(|a, b| a.3 == b.3).filter(|run| run[0].3 && run.len() >= FEWEST);
    let part = |run: &[Looked]| {
        let mut run = run.to_vec();
        let is_reversed = run[0].1.z > run[run.len() - 1].1.z;
        if is_reversed {
            run.reverse();
        }
        Seen {
            is_reversed,
            points: run.iter().map(|(world, ..)| *world).collect(),
            xyz: run.iter().map(|(_, camera, ..)| forward_from_camera.transform_point3(*camera)).collect(),
            uv: run.iter().map(|(_, _, uv, _)| *uv).collect(),
            visible: run.iter().map(|(_, camera, uv, _)| is_visible(depth_m, *uv, camera.z)).collect(),
        }
    };
    runs.flat_map(one_way).map(part).collect()
}

/// A point in World and in Camera, its pixel, and whether that is in the picture.
type Looked = (DVec3, DVec3, DVec2, bool);

/// The parts of a run that only go away or only come nearer: kerbs bend around corners.
fn one_way(run: &[Looked]) -> Vec<&[Looked]> {
    let (mut parts, mut from) = (Vec::new(), 0);
    for i in 2..run.len() {
        if (run[i].1.z - run[i - 1].1.z) * (run[i - 1].1.z - run[from].1.z) < 0.0 {
            parts.push(&run[from..i]);
            from = i - 1;
        }
    }
    parts.push(&run[from..]);
    parts
}

/// A pattern as it is seen along the line the other way.
fn seen_back(pattern: MarkPattern) -> MarkPattern {
    match pattern {
        MarkPattern::SolidDashed => MarkPattern::DashedSolid,
        MarkPattern::DashedSolid => MarkPattern::SolidDashed,
        same => same,
    }
}

/// The same line with points near enough to each other.
fn dense(points: &[DVec3]) -> Vec<DVec3> {
    let mut all: Vec<DVec3> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let steps = (pair[0].distance(pair[1]) / STEP_M).ceil().max(1.0) as u32;
        all.extend((1..=steps).map(|i| pair[0].lerp(pair[1], f64::from(i) / f64::from(steps))));
    }
    all
}

/// Whether a pixel around a point shows something as far away as it: roads are seen at a slant.
fn is_visible(depth_m: &Raster<f32>, uv: DVec2, z: f64) -> bool {
    let (x, y) = (uv.x as u32, uv.y as u32);
    let around = |at: u32, limit: u32| at.saturating_sub(1)..=(at + 1).min(limit - 1);
    around(y, depth_m.height)
        .flat_map(|y| around(x, depth_m.width).map(move |x| (x, y)))
        .any(|(x, y)| f64::from(*depth_m.at(x, y)) > z * (1.0 - NEARER_SHARE) - NEARER_M)
}

fn row(id: u32, category: u8, seen: &Seen, attribute: u8) -> Value {
    let axis = |axis: usize| seen.xyz.iter().map(|p| rounded(p[axis])).collect::<Vec<_>>();
    let pixels = |axis: usize| seen.uv.iter().map(|p| rounded(p[axis])).collect::<Vec<_>>();
    json!({
        "category": category,
        "visibility": seen.visible.iter().map(|&visible| f64::from(u8::from(visible))).collect::<Vec<_>>(),
        "uv": [pixels(0), pixels(1)],
        "xyz": [axis(0), axis(1), axis(2)],
        "attribute": attribute,
        "track_id": id,
    })
}

fn rounded(number: f64) -> f64 {
    (number * 1e4).round() / 1e4
}

/// OpenLane's number of a line; 0 is its unknown.
fn category(paint: Paint, pattern: MarkPattern) -> u8 {
    let first = match paint {
        Paint::White => 1,
        Paint::Yellow => 7,
        Paint::Red => return 0,
    };
    first
        + match pattern {
            MarkPattern::Dashed => 0,
            MarkPattern::Solid => 1,
            MarkPattern::DoubleDashed => 2,
            MarkPattern::DoubleSolid => 3,
            MarkPattern::DashedSolid => 4,
            MarkPattern::SolidDashed => 5,
        }
}

/// How far to the left of the vehicle a line runs beside and ahead of it, metres; `None` where it does not.
fn beside_m(seen: &Seen, ego_from_world: &DAffine3) -> Option<f64> {
    let own = seen.points.iter().map(|p| ego_from_world.transform_point3(*p));
    let ahead = own.filter(|p| BESIDE_M.contains(&p.x));
    ahead.min_by(|a, b| a.x.total_cmp(&b.x)).map(|p| p.y)
}

/// 2 and 3 for the lines next to the vehicle's left and right, 1 and 4 for those beyond, 0 for all others.
fn attribute(side_m: Option<f64>, all: &[Option<f64>]) -> u8 {
    let Some(side_m) = side_m else { return 0 };
    let between = all.iter().flatten().filter(|other| other.signum() == side_m.signum() && other.abs() < side_m.abs());
    match (side_m > 0.0, between.count()) {
        (true, 0) => 2,
        (true, 1) => 1,
        (false, 0) => 3,
        (false, 1) => 4,
        _ => 0,
    }
}

/// From a camera whose x looks forward, y left and z up.
fn camera_from_forward() -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_cols(DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_openlanes() {
        for (paint, pattern, expected) in [
            (Paint::White, MarkPattern::Dashed, 1),
            (Paint::White, MarkPattern::DoubleSolid, 4),
            (Paint::White, MarkPattern::DashedSolid, 5),
            (Paint::Yellow, MarkPattern::Solid, 8),
            (Paint::Yellow, MarkPattern::SolidDashed, 12),
            (Paint::Red, MarkPattern::Solid, 0),
        ] {
            assert_eq!(category(paint, pattern), expected);
        }
        let sides = [Some(1.7), Some(-1.8), Some(5.2), None, Some(-5.3), Some(8.7)];
        assert_eq!(sides.map(|side| attribute(side, &sides)), [2, 3, 1, 0, 4, 0]);
    }

    #[test]
    fn a_line_ahead_is_where_the_pinhole_shows_it_and_hidden_behind_what_is_nearer() {
        // Camera at 1.5 m above World's origin, looking along x; a line on the ground 2 m to its left.
        let rotation = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
        let world_from_camera = DAffine3::from_mat3_translation(rotation, DVec3::Z * 1.5);
        let camera_from_world = world_from_camera.inverse();
        let intrinsics = [[100.0, 0.0, 100.0], [0.0, 100.0, 50.0], [0.0, 0.0, 1.0]];
        let mut depth_m = Raster::filled(200, 100, 1e3);
        let line = [[30.0, 2.0, 0.0], [-5.0, 2.0, 0.0]];
        let parts = seen(&line, &Camera { camera_from_world, intrinsics, depth_m: &depth_m });
        assert_eq!(parts.len(), 1);
        let part = &parts[0];
        assert!(part.visible.iter().all(|visible| *visible));
        for (xyz, uv) in part.xyz.iter().zip(&part.uv) {
            assert!((xyz.y - 2.0).abs() < 1e-9 && (xyz.z + 1.5).abs() < 1e-9);
            let expected = DVec2::new(100.0 - 100.0 * 2.0 / xyz.x, 50.0 + 100.0 * 1.5 / xyz.x);
            assert!(uv.distance(expected) < 1e-9);
        }
        assert!(part.xyz.is_sorted_by(|a, b| a.x < b.x) && (part.xyz.last().unwrap().x - 30.0).abs() < 1e-9);
        // A corner goes away, and comes back.
        let bent = seen(
            &[[10.0, 2.0, 0.0], [20.0, 2.0, 0.0], [20.0, -2.0, 0.0], [12.0, -2.0, 0.0]],
            &Camera { camera_from_world, intrinsics, depth_m: &depth_m },
        );
        assert_eq!(bent.iter().map(|part| part.is_reversed).collect::<Vec<_>>(), [false, true]);
        depth_m.data.fill(10.0);
        let hidden = &seen(&line, &Camera { camera_from_world, intrinsics, depth_m: &depth_m })[0];
        assert!(hidden.xyz.iter().zip(&hidden.visible).all(|(xyz, visible)| *visible == (xyz.x < 10.3)));
    }
}
