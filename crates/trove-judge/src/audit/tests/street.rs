//! A street in closed form: a road, a house and a moving car under the sky, two cameras at two moments, and a LiDAR.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use serde_json::json;
use trove_format::{FrameTable, SweepTable};
use trove_model::{Class, Distortion, InPatches, InstanceId, Lens, LidarPoint, Occlusion, Patches, Raster, Role};

use super::super::{FrameReader, LabelledFrame, LabelledSweep};

const WIDTH: u32 = 240;
const HEIGHT: u32 = 160;
pub(super) const CAR: u16 = 1;
pub(super) const HOUSE: u16 = 7;
const MOMENTS: usize = 2;

/// A box that stands along the axes of World.
#[derive(Clone, Copy)]
struct Solid {
    id: u16,
    class: Class,
    middle: DVec3,
    size: DVec3,
}

/// Who stands where at a moment.
fn solids(moment: usize) -> [Solid; 2] {
    let car = DVec3::new(12.0 + moment as f64, -1.5, 0.75);
    let house = DVec3::new(30.0, 9.0, 4.0);
    [
        Solid { id: CAR, class: Class::Car, middle: car, size: DVec3::new(4.0, 1.8, 1.5) },
        Solid { id: HOUSE, class: Class::Building, middle: house, size: DVec3::new(10.0, 8.0, 8.0) },
    ]
}

/// What a ray meets.
struct Hit {
    id: u16,
    class: Class,
    point: DVec3,
    normal: DVec3,
}

fn meet(moment: usize, origin: DVec3, direction: DVec3) -> Option<Hit> {
    let mut nearest = (f64::INFINITY, None);
    if direction.z < 0.0 {
        let t = -origin.z / direction.z;
        nearest = (t, Some(Hit { id: 0, class: Class::Road, point: origin + direction * t, normal: DVec3::Z }));
    }
    for Solid { id, class, middle, size } in solids(moment) {
        let (mut near, mut far, mut axis) = (f64::NEG_INFINITY, f64::INFINITY, 0);
        for i in 0..3 {
            let a = (middle[i] - size[i] / 2.0 - origin[i]) / direction[i];
            let b = (middle[i] + size[i] / 2.0 - origin[i]) / direction[i];
            if a.min(b) > near {
                (near, axis) = (a.min(b), i);
            }
            far = far.min(a.max(b));
        }
        if near < far && near > 0.0 && near < nearest.0 {
            let mut normal = DVec3::ZERO;
            normal[axis] = -direction[axis].signum();
            nearest = (near, Some(Hit { id, class, point: origin + direction * near, normal }));
        }
    }
    nearest.1
}

fn lens() -> Lens {
    let (cx_px, cy_px) = (f64::from(WIDTH) / 2.0, f64::from(HEIGHT) / 2.0);
    let distortion = Distortion::None;
    Lens { width_px: WIDTH, height_px: HEIGHT, fx_px: 200.0, fy_px: 200.0, cx_px, cy_px, distortion }
}

/// The cameras look along x and a little down, the second a little to the left.
fn camera(view: usize, moment: usize) -> DAffine3 {
    let turn = DMat3::from_rotation_z(0.2 * view as f64) * DMat3::from_rotation_y(0.1);
    let axes = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
    let place = DVec3::new(0.8 * moment as f64, 0.4 * view as f64, 1.6);
    DAffine3 { matrix3: turn * axes, translation: place }
}

fn rows(pose: DAffine3) -> [[f64; 4]; 4] {
    let [x, y, z] = [0, 1, 2].map(|i| {
        let row = pose.matrix3.row(i);
        [row.x, row.y, row.z, pose.translation[i]]
    });
    [x, y, z, [0.0, 0.0, 0.0, 1.0]]
}

pub(super) fn whole<T>(raster: Raster<T>) -> InPatches<T> {
    InPatches { raster, patches: Patches::ALL }
}

fn one_number((class, id): (&Class, &u16)) -> u32 {
    65_536 * u32::from(class.id()) + u32::from(*id)
}

/// A frame with every image, by rays through the pixels' centres.
fn frame(view: usize, moment: usize) -> LabelledFrame {
    let (lens, pose) = (lens(), camera(view, moment));
    let hit = Raster::from_fn(WIDTH, HEIGHT, |x, y| {
        let direction = lens.unproject(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).unwrap();
        meet(moment, pose.translation, pose.transform_vector3(direction))
    });
    let camera_from_world = pose.inverse();
    let neighbour = [moment.checked_add(1).filter(|next| *next < MOMENTS), moment.checked_sub(1)];
    // Where the same point of the same thing is at the other moment, and whether something is before it.
    let follow = |x: u32, y: u32, to: usize| -> Option<(DVec2, bool)> {
        let hit = hit.at(x, y).as_ref();
        let other = camera(view, to);
        let (there, point) = match hit {
            Some(hit) => {
                let moved = solids(to).into_iter().zip(solids(moment)).find(|(s, _)| s.id == hit.id);
                let point = hit.point + moved.map_or(DVec3::ZERO, |(then, now)| then.middle - now.middle);
                (other.inverse().transform_point3(point), Some(point))
            }
            None => {
                let direction = lens.unproject(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).unwrap();
                (other.inverse().transform_vector3(pose.transform_vector3(direction)), None)
            }
        };
        let pixel = lens.project(there)?;
        let towards = other.transform_vector3(there.normalize());
        let met = meet(to, other.translation, towards);
        let is_seen = match (point, met) {
            (Some(point), Some(met)) => {
                met.point.distance(other.translation) > point.distance(other.translation) - 1e-3
            }
            (None, met) => met.is_none(),
            (Some(_), None) => true,
        };
        Some((pixel, is_seen && lens.contains(pixel)))
    };
    let flow = neighbour.map(|to| {
        let of = |x, y| match to.and_then(|to| follow(x, y, to)) {
            Some((end, _)) => {
                let flow = end - DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                [flow.x as f32, flow.y as f32]
            }
            None => [f32::NAN; 2],
        };
        Some(whole(Raster::from_fn(WIDTH, HEIGHT, of)))
    });
    let occluded = neighbour.map(|to| {
        let of = |x, y| match to.and_then(|to| follow(x, y, to)) {
            Some((_, true)) => Occlusion::Seen,
            Some((_, false)) => Occlusion::Hidden,
            None => Occlusion::Undefined,
        };
        Some(Raster::from_fn(WIDTH, HEIGHT, of))
    });
    let class = hit.map(|hit| hit.as_ref().map_or(Class::Sky, |hit| hit.class));
    let instance = hit.map(|hit| hit.as_ref().map_or(0, |hit| hit.id));
    let rgb = class.map(|class| class.row().rgb);
    let depth_of = |hit: &Hit| camera_from_world.transform_point3(hit.point).z as f32;
    let depth_m = hit.map(|hit| hit.as_ref().map_or(f32::INFINITY, depth_of));
    let normal_of = |hit: &Hit| camera_from_world.transform_vector3(hit.normal).as_vec3().to_array();
    let normal = hit.map(|hit| hit.as_ref().map_or([0.0; 3], normal_of));
    let panoptic = Raster { data: class.data.iter().zip(&instance.data).map(one_number).collect(), ..class.map(|_| 0) };
    // The house has a board.
    let board = |hit: &Hit| (hit.id == HOUSE && (2.5..3.0).contains(&hit.point.z)).then_some(Role::ShopSign);
    let part = hit.map(|hit| hit.as_ref().and_then(board));
    let range_m = hit.map(|hit| hit.as_ref().map_or(f32::INFINITY, |h| h.point.distance(pose.translation) as f32));
    let normal_world = hit.map(|hit| hit.as_ref().map_or([0.0; 3], |hit| hit.normal.as_vec3().to_array()));
    let object_coordinates = hit.map(|hit| {
        let inside = hit.as_ref().and_then(|hit| {
            let solid = solids(moment).into_iter().find(|solid| solid.id == hit.id)?;
            Some(((hit.point - solid.middle) / solid.size + 0.5).as_vec3().to_array())
        });
        inside.unwrap_or([f32::NAN; 3])
    });
    let scene_flow = neighbour.map(|to| {
        let moved = |hit: &Option<Hit>| match (to, hit) {
            (Some(to), Some(hit)) => {
                let moved = solids(to).into_iter().zip(solids(moment)).find(|(solid, _)| solid.id == hit.id);
                moved.map_or(DVec3::ZERO, |(then, now)| then.middle - now.middle).as_vec3().to_array()
            }
            _ => [f32::NAN; 3],
        };
        Some(whole(hit.map(moved)))
    });
    let objects: Vec<_> = solids(moment).iter().filter_map(|solid| row(solid, &instance, pose)).collect();
    let name = ["ego.A", "ego.B"][view];
    let quaternion = glam::DQuat::from_mat3(&pose.matrix3);
    let table = json!({
        "scene": "street", "dataset": "made", "keyframe": moment, "keyframe_time_ns": moment as i64 * 500_000_000,
        "view": name, "time_ns": 0, "width_px": WIDTH, "height_px": HEIGHT,
        "intrinsics": [[lens.fx_px, 0.0, lens.cx_px], [0.0, lens.fy_px, lens.cy_px], [0.0, 0.0, 1.0]],
        "lens_model": "pinhole", "world_from_camera": rows(pose),
        "world_from_camera_rotation_wxyz": [quaternion.w, quaternion.x, quaternion.y, quaternion.z],
        "world_from_camera_translation_m": pose.translation.to_array(),
        "world_from_camera_next": neighbour[0].map(|to| rows(camera(view, to))),
        "world_from_camera_previous": neighbour[1].map(|to| rows(camera(view, to))),
        "world_from_ego": null, "carrier": null,
        "projection": { "origin_lat_deg": 0.0, "origin_lon_deg": 0.0, "anchor_m": [0.0, 0.0] },
        "exposure_ev": 0.0, "spp": 1, "denoised": false, "seed": 0, "objects": objects,
    });
    LabelledFrame {
        place: format!("street/v00/k{moment:03}/{name}"),
        table: serde_json::from_value(table).unwrap(),
        rgb: Some(rgb),
        class: Some(class),
        instance: Some(instance),
        depth_m: Some(depth_m),
        normal: Some(whole(normal)),
        flow,
        occluded,
        panoptic: Some(panoptic),
        part: Some(part),
        range_m: Some(whole(range_m)),
        normal_world: Some(whole(normal_world)),
        object_coordinates: Some(whole(object_coordinates)),
        scene_flow,
        damage: Vec::new(),
    }
}

fn row(solid: &Solid, instance: &Raster<u16>, pose: DAffine3) -> Option<serde_json::Value> {
    let (mut count, mut around) = (0, [u32::MAX, u32::MAX, 0, 0]);
    for (i, _) in instance.data.iter().enumerate().filter(|(_, id)| **id == solid.id) {
        let (x, y) = (i as u32 % WIDTH, i as u32 / WIDTH);
        count += 1;
        around = [around[0].min(x), around[1].min(y), around[2].max(x), around[3].max(y)];
    }
    let is_car = solid.id == CAR;
    (count > 0).then(|| {
        json!({
            "id": solid.id, "class": solid.class.row().name, "class_id": solid.class.id(),
            "kind": if is_car { "car" } else { "building" },
            "origin": if is_car { "recorded" } else { "scenery" }, "track_token": if is_car { "track" } else { "" },
            "world_from_body": rows(DAffine3::from_translation(solid.middle)), "size_m": solid.size.to_array(),
            "velocity_mps": null, "visible_px": count, "amodal_px": count, "visible_box": around, "amodal_box": around,
            "truncation": 0.0, "occlusion": 0.0, "range_m": pose.translation.distance(solid.middle),
        })
    })
}

/// Rays in all directions from above the cameras.
fn sweep(moment: usize) -> LabelledSweep {
    let pose = DAffine3::from_translation(camera(0, moment).translation + DVec3::new(0.0, 0.0, 0.3));
    let mut points = Vec::new();
    for (ring, elevation) in (-20..5).enumerate() {
        for azimuth in -60..60 {
            let (yaw, pitch) = (f64::from(azimuth).to_radians() / 2.0, f64::from(elevation).to_radians());
            let direction = DVec3::new(yaw.cos() * pitch.cos(), yaw.sin() * pitch.cos(), pitch.sin());
            let Some(hit) = meet(moment, pose.translation, direction) else { continue };
            points.push(LidarPoint {
                position_m: hit.point - pose.translation,
                intensity: 9,
                ring: ring as u16,
                number: 0,
                time_s: 0.0,
                class: hit.class,
                instance: InstanceId(u32::from(hit.id)),
            });
        }
    }
    let count = |solid: &Solid| points.iter().filter(|p| p.instance.0 == u32::from(solid.id)).count();
    let met = solids(moment);
    let objects = met.iter().filter(|solid| count(solid) > 0).map(|solid| {
        let is_car = solid.id == CAR;
        json!({
            "id": solid.id, "class": solid.class.row().name, "kind": if is_car { "car" } else { "building" },
            "origin": if is_car { "recorded" } else { "scenery" }, "world_from_body": rows(DAffine3::from_translation(solid.middle)),
            "size_m": solid.size.to_array(), "points": count(solid),
        })
    });
    let table = json!({
        "scene": "street", "dataset": "made", "keyframe": moment, "keyframe_time_ns": moment as i64 * 500_000_000,
        "view": "ego.LIDAR", "time_ns": 0, "begins_s": 0.0, "sweep_s": 0.0, "lidar": "made",
        "elevations_deg": (-20..5).map(f64::from).collect::<Vec<_>>(), "columns": 120, "returns": "strongest",
        "points": points.len(), "world_from_lidar": rows(pose), "world_from_ego": null, "carrier": null,
        "projection": { "origin_lat_deg": 0.0, "origin_lon_deg": 0.0, "anchor_m": [0.0, 0.0] }, "seed": 0,
        "objects": objects.collect::<Vec<_>>(),
    });
    let table: SweepTable = serde_json::from_value(table).unwrap();
    LabelledSweep { place: format!("street/v00/k{moment:03}/ego.LIDAR"), table, points }
}

fn keep<T: Copy>(image: &mut Option<InPatches<T>>, patches: Patches, other: T) {
    let image = image.as_mut().unwrap();
    image.patches = patches;
    let raster = &image.raster;
    let of = |x, y| if patches.hold(x, y) { *raster.at(x, y) } else { other };
    image.raster = Raster::from_fn(WIDTH, HEIGHT, of);
}

/// The whole street, and who reads it.
pub(super) struct Street {
    pub(super) frames: BTreeMap<String, LabelledFrame>,
    pub(super) sweeps: BTreeMap<String, LabelledSweep>,
}

impl Street {
    pub(super) fn new() -> Self {
        let frames = (0..MOMENTS).flat_map(|moment| (0..2).map(move |view| frame(view, moment)));
        let sweeps = (0..MOMENTS).map(sweep);
        Self {
            frames: frames.map(|frame| (frame.place.clone(), frame)).collect(),
            sweeps: sweeps.map(|sweep| (sweep.place.clone(), sweep)).collect(),
        }
    }

    /// The same as whoever reads one of so many patches has it: what stands elsewhere means nothing.
    pub(super) fn in_patches(mut self, every: u32) -> Self {
        let patches = Patches::one_of(every, 1);
        for frame in self.frames.values_mut() {
            keep(&mut frame.normal, patches, [-7.0; 3]);
            keep(&mut frame.range_m, patches, -7.0);
            keep(&mut frame.normal_world, patches, [-7.0; 3]);
            keep(&mut frame.object_coordinates, patches, [-7.0; 3]);
            frame.flow.iter_mut().for_each(|flow| keep(flow, patches, [-7.0; 2]));
            frame.scene_flow.iter_mut().for_each(|flow| keep(flow, patches, [-7.0; 3]));
        }
        self
    }

    /// Folders by which a walk finds them.
    pub(super) fn lay_out(&self, root: &Path) {
        let names = self.frames.keys().map(|place| (place, FrameTable::NAME));
        for (place, name) in names.chain(self.sweeps.keys().map(|place| (place, SweepTable::NAME))) {
            std::fs::create_dir_all(root.join(place)).unwrap();
            std::fs::write(root.join(place).join(name), "").unwrap();
        }
    }
}

impl FrameReader for Street {
    fn frame(&self, _: &Path, place: &str) -> Result<LabelledFrame, String> {
        Ok(self.frames[place].clone())
    }

    fn sweep(&self, _: &Path, place: &str) -> Result<LabelledSweep, String> {
        Ok(self.sweeps[place].clone())
    }
}
