//! Virtual KITTI 2: pictures, depth, labels and flow by camera, and tables of poses and boxes as text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::LazyLock;

use glam::{DAffine3, DMat3, DVec3, EulerRot};
use trove_format::{FrameTable, ObjectRow};
use trove_model::{Kind, Raster, State};

use super::dataset::{Dataset, Finished};
use super::geometry::{affine, camera_from_body, camera_from_world};
use super::kitti::{note_distortion, wrapped};
use super::plan::{Plan, PlannedFrame};
use super::unit::Unit;
use crate::{StoredFrame, WriteError, jpeg, png_file};

/// `Scene<number>/v<variation>/frames/<what>/Camera_<number>/*` and text files beside `frames`.
pub(super) struct VirtualKitti2;

/// Of the set's own pictures, as far as their bytes tell.
const JPEG_QUALITY: u8 = 95;
/// Centimetres in 16 bits.
const FAR: u16 = u16::MAX;
/// Ids in 8 bits, of which 0 is none.
const LAST_TRACK: usize = 254;

const EXTRINSIC: &str = "frame cameraID r1,1 r1,2 r1,3 t1 r2,1 r2,2 r2,3 t2 r3,1 r3,2 r3,3 t3 0 0 0 1\n";
const INTRINSIC: &str = "frame cameraID K[0,0] K[1,1] K[0,2] K[1,2]\n";
const BOXES: &str =
    "frame cameraID trackID left right top bottom number_pixels truncation_ratio occupancy_ratio isMoving\n";
const POSES: &str = "frame cameraID trackID alpha width height length world_space_X world_space_Y world_space_Z \
                     rotation_world_space_y rotation_world_space_x rotation_world_space_z camera_space_X camera_space_Y \
                     camera_space_Z rotation_camera_space_y rotation_camera_space_x rotation_camera_space_z\n";

/// A category of the set's.
struct Category {
    name: &'static str,
    rgb: [u8; 3],
}

/// Categories by the names of our classes and kinds.
static CATEGORIES: LazyLock<BTreeMap<&str, Category>> = LazyLock::new(|| {
    let row = |line: &'static str| {
        let &[class, name, r, g, b] = line.split('\t').collect::<Vec<_>>().as_slice() else {
            panic!("virtual_kitti.tsv: expected five columns, found {line:?}")
        };
        let rgb = [r, g, b].map(|v| v.parse().unwrap_or_else(|_| panic!("virtual_kitti.tsv: no colour in {line:?}")));
        (class, Category { name, rgb })
    };
    include_str!("virtual_kitti.tsv").lines().skip(1).map(row).collect()
});

impl Dataset for VirtualKitti2 {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.grouped(|frame| (frame.split.clone(), frame.scene.clone(), frame.variation))
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let first = &plan.frames[frames[0]];
        let folder = format!("Scene{:02}/v{:02}", scene_number(plan, first), first.variation);
        let cameras: BTreeSet<&str> = frames.iter().map(|i| plan.frames[*i].view.as_str()).collect();
        let keyframes: BTreeSet<u32> = frames.iter().map(|i| plan.frames[*i].keyframe).collect();
        let tracks = tracks(plan, frames)?;
        let mut texts = Texts::new(&tracks);
        for &number in frames {
            let planned = &plan.frames[number];
            let frame = plan.open(planned)?;
            note_distortion(&frame.table, unit);
            // Frames are numbered by moments, alike in all cameras.
            let index = keyframes.range(..planned.keyframe).count();
            let camera = cameras.range(..planned.view.as_str()).count();
            let place = |what: &str, name: &str, ending: &str| {
                format!("{folder}/frames/{what}/Camera_{camera}/{name}_{index:05}.{ending}")
            };
            pictures(&frame, &tracks, &place, unit)?;
            texts.look(index, camera, &frame.table, &tracks);
        }
        texts.write(&folder, unit)?;
        let views: Vec<String> = cameras.iter().enumerate().map(|(i, view)| format!("Camera_{i} {view}\n")).collect();
        unit.write(&format!("{folder}/cameras.txt"), views.concat().as_bytes())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        unit.stream("scenes.txt", |file| {
            let mut last = 0;
            for frame in &finished.plan.frames {
                let number = scene_number(finished.plan, frame);
                if number != last {
                    writeln!(file, "Scene{number:02} {} {}", frame.scene, frame.split)?;
                    last = number;
                }
            }
            Ok(())
        })
    }
}

/// Number of a drive on one side of the split, from 1.
fn scene_number(plan: &Plan, frame: &PlannedFrame) -> usize {
    let of = |frame: &PlannedFrame| (frame.split.clone(), frame.scene.clone());
    let place = plan.frames.partition_point(|other| of(other) <= of(frame));
    plan.frames[..place].chunk_by(|a, b| of(a) == of(b)).count()
}

/// The set's number of each road user, from 0, and what it is.
fn tracks(plan: &Plan, frames: &[usize]) -> Result<BTreeMap<u32, (Kind, String)>, WriteError> {
    let mut tracks = BTreeMap::new();
    for &number in frames {
        for object in plan.open(&plan.frames[number])?.table.objects.into_iter().filter(is_tracked) {
            tracks.entry(object.id).or_insert((object.kind, object.asset));
        }
    }
    Ok(tracks)
}

/// Whether the set would follow it: cars, vans, trucks and buses.
fn is_tracked(object: &ObjectRow) -> bool {
    object.origin != trove_format::ObjectOrigin::Scenery && object.kind.is_car()
}

fn pictures(
    frame: &StoredFrame,
    tracks: &BTreeMap<u32, (Kind, String)>,
    place: &dyn Fn(&str, &str, &str) -> String,
    unit: &mut Unit<'_>,
) -> Result<(), WriteError> {
    let rgb = frame.rgb()?;
    let (width, height) = (rgb.width, rgb.height);
    let path = place("rgb", "rgb", "jpg");
    unit.write(&path, &jpeg::packed(&path, width, height, &rgb.data, JPEG_QUALITY)?)?;

    let mut clipped = 0;
    let centimetres = |depth_m: &f32| {
        let value = (f64::from(*depth_m) * 100.0).round();
        clipped += u64::from(depth_m.is_finite() && !(0.0..f64::from(FAR)).contains(&value));
        value.clamp(0.0, f64::from(FAR)) as u16
    };
    let depth: Vec<u16> = frame.depth_m()?.data.iter().map(centimetres).collect();
    unit.clip("depths behind the camera or beyond 655.34 m, written as the nearest that fits", clipped);
    let path = place("depth", "depth", "png");
    unit.write(&path, &png_file::grey16(&path, width, height, &depth)?)?;

    let (class, instance) = (frame.class()?, frame.instance()?);
    let kinds: BTreeMap<u32, Kind> = frame.table.objects.iter().map(|object| (object.id, object.kind)).collect();
    let color = |class: &trove_model::Class, id: u16| {
        let kind = kinds.get(&u32::from(id)).and_then(|kind| CATEGORIES.get(kind.name()));
        kind.filter(|_| class.row().name == "traffic_sign")
            .or_else(|| CATEGORIES.get(class.row().name))
            .map_or([0; 3], |c| c.rgb)
    };
    let colors: Vec<[u8; 3]> = class.data.iter().zip(&instance.data).map(|(class, id)| color(class, *id)).collect();
    let path = place("classSegmentation", "classgt", "png");
    unit.write(&path, &png_file::labels_rgb(&path, width, height, &colors)?)?;

    let numbers: BTreeMap<u32, usize> = tracks.keys().copied().zip(0..).collect();
    let mut lost = 0;
    let ids = instance.data.iter().map(|id| match numbers.get(&u32::from(*id)) {
        Some(number) if *number <= LAST_TRACK => *number as u8 + 1,
        Some(_) => {
            lost += 1;
            0
        }
        None => 0,
    });
    let ids: Vec<u8> = ids.collect();
    unit.clip("pixels of road users beyond the 255th of a scene, which 8 bits cannot number", lost);
    let path = place("instanceSegmentation", "instancegt", "png");
    unit.write(&path, &png_file::grey(&path, width, height, &ids)?)?;

    for (flow, what, name) in
        [(frame.flow_forward()?, "forwardFlow", "flow"), (frame.flow_backward()?, "backwardFlow", "backwardFlow")]
    {
        let path = place(what, name, "png");
        let (encoded, clipped) = encoded_flow(&flow);
        unit.clip("flows longer than the picture, written as not valid", clipped);
        unit.write(&path, &png_file::rgb16(&path, width, height, &encoded)?)?;
    }
    Ok(())
}

/// Red and green span twice the picture's width and height, blue says whether there is a flow; and how many do not fit.
fn encoded_flow(flow: &Raster<[f32; 2]>) -> (Vec<[u16; 3]>, u64) {
    let mut clipped = 0;
    let most = [flow.width, flow.height].map(|side| f64::from(side.max(2) - 1));
    let encode = |uv: &[f32; 2]| {
        let shares = [0, 1].map(|i| f64::from(uv[i]) / most[i]);
        if shares.iter().any(|share| share.is_nan()) {
            return [0; 3];
        }
        if shares.iter().any(|share| share.abs() > 1.0) {
            clipped += 1;
            return [0; 3];
        }
        let [r, g] = shares.map(|share| ((share + 1.0) / 2.0 * f64::from(u16::MAX)).round() as u16);
        [r, g, u16::MAX]
    };
    (flow.data.iter().map(encode).collect(), clipped)
}

/// The text files of a variation.
struct Texts {
    extrinsic: String,
    intrinsic: String,
    info: String,
    boxes: String,
    poses: String,
}

impl Texts {
    fn new(tracks: &BTreeMap<u32, (Kind, String)>) -> Self {
        let mut info = "trackID label model color\n".to_owned();
        for (number, (kind, asset)) in tracks.values().enumerate() {
            let label = CATEGORIES.get(kind.class().row().name).map_or("Misc", |category| category.name);
            let _ = writeln!(info, "{number} {label} {} -", if asset.is_empty() { "-" } else { asset });
        }
        let [extrinsic, intrinsic, boxes, poses] = [EXTRINSIC, INTRINSIC, BOXES, POSES].map(str::to_owned);
        Self { extrinsic, intrinsic, info, boxes, poses }
    }

    fn look(&mut self, index: usize, camera: usize, table: &FrameTable, tracks: &BTreeMap<u32, (Kind, String)>) {
        // Strings take everything.
        let camera_from_plane = camera_from_world(table) * plane_from_world().inverse();
        let _ = write!(self.extrinsic, "{index} {camera}");
        for row in 0..3 {
            let [x, y, z] = camera_from_plane.matrix3.row(row).to_array();
            let _ = write!(self.extrinsic, " {x} {y} {z} {}", camera_from_plane.translation[row]);
        }
        self.extrinsic.push_str(" 0 0 0 1\n");
        let k = &table.intrinsics;
        let _ = writeln!(self.intrinsic, "{index} {camera} {} {} {} {}", k[0][0], k[1][1], k[0][2], k[1][2]);
        for object in table.objects.iter().filter(|object| is_tracked(object)) {
            let Some(number) = tracks.keys().position(|id| *id == object.id) else { continue };
            let Some([left, top, right, bottom]) = object.visible_box else { continue };
            let moves = object.states.contains(&State::Moving);
            let _ = writeln!(
                self.boxes,
                "{index} {camera} {number} {left} {right} {top} {bottom} {} {} {} {}",
                object.visible_px,
                object.truncation,
                1.0 - object.occlusion,
                if moves { "True" } else { "False" }
            );
            let camera_from_body = camera_from_body(table, object);
            let in_plane = Placed::of(&(plane_from_world() * affine(&object.world_from_body)), object);
            let in_camera = Placed::of(&camera_from_body, object);
            let alpha = wrapped(in_camera.angles[0] - in_camera.foot.x.atan2(in_camera.foot.z));
            let [length, width, height] = object.size_m;
            let _ = writeln!(
                self.poses,
                "{index} {camera} {number} {alpha} {width} {height} {length} {in_plane} {in_camera}"
            );
        }
    }

    fn write(&self, folder: &str, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let mut colors = "Category r g b\n".to_owned();
        let categories: BTreeMap<&str, [u8; 3]> = CATEGORIES.values().map(|c| (c.name, c.rgb)).collect();
        for (name, [r, g, b]) in categories {
            let _ = writeln!(colors, "{name} {r} {g} {b}");
        }
        let files = [
            ("colors", &colors),
            ("extrinsic", &self.extrinsic),
            ("intrinsic", &self.intrinsic),
            ("info", &self.info),
            ("bbox", &self.boxes),
            ("pose", &self.poses),
        ];
        files.into_iter().try_for_each(|(name, text)| unit.write(&format!("{folder}/{name}.txt"), text.as_bytes()))
    }
}

/// From World to the axes that the set has everywhere: x right (east), y down, z forward (north).
fn plane_from_world() -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y))
}

/// The middle of a box's lower side, and its rotations about y, x and z: at 0 it faces along x.
struct Placed {
    foot: DVec3,
    angles: [f64; 3],
}

impl Placed {
    fn of(frame_from_body: &DAffine3, object: &ObjectRow) -> Self {
        let foot = frame_from_body.transform_point3(DVec3::new(0.0, 0.0, -object.size_m[2] / 2.0));
        let axis = |body: DVec3| frame_from_body.transform_vector3(body);
        let (y, x, z) = DMat3::from_cols(axis(DVec3::X), axis(DVec3::NEG_Z), axis(DVec3::Y)).to_euler(EulerRot::YXZ);
        Self { foot, angles: [y, x, z] }
    }
}

impl std::fmt::Display for Placed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { foot, angles: [y, x, z] } = self;
        write!(f, "{} {} {} {y} {x} {z}", foot.x, foot.y, foot.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flow_comes_back_as_the_set_decodes_it() {
        let flow =
            Raster { width: 101, height: 51, data: vec![[12.5, -7.25], [f32::NAN; 2], [100.5, 0.0], [-100.0, 50.0]] };
        let (encoded, clipped) = encoded_flow(&flow);
        assert_eq!(clipped, 1);
        let decoded =
            |[r, g, _]: [u16; 3]| [(r, 100.0), (g, 50.0)].map(|(v, most)| (2.0 * f64::from(v) / 65535.0 - 1.0) * most);
        let close = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.002);
        assert!(close(decoded(encoded[0]), [12.5, -7.25]) && close(decoded(encoded[3]), [-100.0, 50.0]));
        assert_eq!((encoded[0][2], encoded[1][2], encoded[2][2]), (u16::MAX, 0, 0));
    }

    #[test]
    fn every_class_has_a_category() {
        for row in trove_model::CLASSES.iter() {
            assert!(CATEGORIES.contains_key(row.name), "{}", row.name);
        }
    }

    #[test]
    fn the_sets_axes_are_right_handed_with_y_down() {
        let plane = plane_from_world();
        assert_eq!(plane.transform_vector3(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(1.0, -3.0, 2.0));
        assert!((plane.matrix3.determinant() - 1.0).abs() < 1e-12);
    }
}
