//! Writes drives in KITTI's forms.

use std::fmt::Write as _;
use std::path::Path;

use glam::{DMat3, DQuat, DVec3, EulerRot};
use trove_model::{
    Camera, Drive, Ego, Frame, Keyframe, Kind, MapProjection, ObjectBox, Pose, RigCamera, SensorFrame, World,
};

use crate::canonical;

pub(crate) const SYNCED: &str = "2020_09_13_drive_0007_sync";
pub(crate) const EXTRACTED: &str = "2020_09_13_drive_0007_extract";
const DAY: &str = "2020_09_13";
/// 2020-09-13 14:26:40 of Karlsruhe's summer.
const DAY_NS: i64 = 1_600_000_000_000_000_000;
/// OpenCV's pixels have their centres at whole numbers.
const HALF: f64 = 0.5;

fn put(root: &Path, file: &str, text: &str) {
    let path = root.join(file);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

pub(crate) fn picture(root: &Path, file: &str, [width, height]: [u32; 2]) {
    put(root, file, "");
    image::GrayImage::new(width, height).save(root.join(file)).unwrap();
}

pub(crate) fn sweep(root: &Path, file: &str) {
    let point = |p: DVec3| [p.x as f32, p.y as f32, p.z as f32, 0.3];
    let bytes: Vec<u8> = canonical::points_sensor().into_iter().flat_map(point).flat_map(f32::to_le_bytes).collect();
    put(root, file, "");
    std::fs::write(root.join(file), bytes).unwrap();
}

/// Half-way to the left of the car, above the rear axle.
fn ego_from_imu() -> Pose<Ego, SensorFrame> {
    Pose::new(DQuat::IDENTITY, DVec3::new(0.0, 0.31, 0.93))
}

fn words(numbers: impl IntoIterator<Item = f64>) -> String {
    numbers.into_iter().map(|n| n.to_string()).collect::<Vec<_>>().join(" ")
}

fn rows(rotation: DQuat) -> [f64; 9] {
    DMat3::from_quat(rotation).transpose().to_cols_array()
}

fn three_by_four<D: Frame, S: Frame>(pose: &Pose<D, S>) -> [f64; 12] {
    let ([a, b, c, d, e, f, g, h, i], t) = (rows(pose.rotation), pose.translation);
    [a, b, c, t.x, d, e, f, t.y, g, h, i, t.z]
}

/// The projection of a camera beside camera 0.
fn projection(reference: &RigCamera, camera: &RigCamera) -> [f64; 12] {
    let from_reference = camera.ego_from_camera.inverse() * reference.ego_from_camera;
    assert!(from_reference.rotation.angle_between(DQuat::IDENTITY) < 1e-6);
    let (lens, t) = (&camera.lens, from_reference.translation);
    let (cx, cy) = (lens.cx_px - HALF, lens.cy_px - HALF);
    [
        lens.fx_px,
        0.0,
        cx,
        lens.fx_px * t.x + cx * t.z,
        0.0,
        lens.fy_px,
        cy,
        lens.fy_px * t.y + cy * t.z,
        0.0,
        0.0,
        1.0,
        t.z,
    ]
}

/// Lines of OXTS at poses.
fn oxts(drive: &Drive, poses: &[Pose<World, Ego>]) -> Vec<String> {
    let imu = |pose: &Pose<World, Ego>| *pose * ego_from_imu();
    // The first vehicle is where the canonical one is; from its IMU's fix on, metres are the devkit's sphere's.
    let first = drive.keyframes[0].world_from_ego;
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(first.translation.truncate());
    let about_ego = MapProjection::spherical(lat_deg, lon_deg, glam::DVec2::ZERO);
    let start = imu(&first).translation;
    let (lat_deg, lon_deg) = about_ego.geo_from_world((start - first.translation).truncate());
    let sphere = MapProjection::spherical(lat_deg, lon_deg, glam::DVec2::ZERO);
    let line = |pose: &Pose<World, Ego>| {
        let imu = imu(pose);
        let (lat_deg, lon_deg) = sphere.geo_from_world((imu.translation - start).truncate());
        let (yaw, pitch, roll) = imu.rotation.to_euler(EulerRot::ZYX);
        let altitude_m = 230.0 + imu.translation.z;
        format!("{} {} 1 2 3", words([lat_deg, lon_deg, altitude_m, roll, pitch, yaw]), words([0.5; 16]))
    };
    poses.iter().map(line).collect()
}

fn timestamp(time_ns: i64) -> String {
    let since_ns = time_ns - DAY_NS;
    format!("2020-09-13 14:26:{:02}.{:09}\n", 40 + since_ns / 1_000_000_000, since_ns % 1_000_000_000)
}

fn category(kind: Kind) -> &'static str {
    match kind {
        Kind::Car => "Car",
        Kind::Adult => "Pedestrian",
        Kind::BicycleWithRider => "Cyclist",
        Kind::Truck => "Truck",
        other => panic!("{other:?} is not in the canonical drive"),
    }
}

/// A raw recording; where it is not synced it has no boxes.
pub(crate) fn raw(drive: &Drive, root: &Path, is_synced: bool) {
    let name = if is_synced { SYNCED } else { EXTRACTED };
    let folder = format!("{DAY}/{name}");
    calibrations(drive, root, is_synced);
    let mut poses: Vec<(i64, Pose<World, Ego>)> =
        drive.keyframes.iter().map(|k| (k.time_ns, k.world_from_ego)).collect();
    if !is_synced {
        poses.extend(drive.keyframes.iter().flat_map(|k| &k.exposures).map(|e| (e.time_ns, e.world_from_ego)));
        poses.extend(drive.path.moments());
        poses.sort_by_key(|(time_ns, _)| *time_ns);
        poses.dedup_by_key(|(time_ns, _)| *time_ns);
    }
    let only_poses: Vec<_> = poses.iter().map(|(_, pose)| *pose).collect();
    for (i, line) in oxts(drive, &only_poses).iter().enumerate() {
        put(root, &format!("{folder}/oxts/data/{i:010}.txt"), line);
    }
    put(root, &format!("{folder}/oxts/timestamps.txt"), &poses.iter().map(|(t, _)| timestamp(*t)).collect::<String>());
    for camera in 0..2 {
        let times: String = drive.keyframes.iter().map(|k| timestamp(k.exposures[camera].time_ns)).collect();
        put(root, &format!("{folder}/image_0{camera}/timestamps.txt"), &times);
    }
    let times: String = drive.keyframes.iter().map(|k| timestamp(k.time_ns)).collect();
    put(root, &format!("{folder}/velodyne_points/timestamps.txt"), &times);
    let swept = format!("{folder}/velodyne_points/data/{:010}", canonical::SWEPT);
    if is_synced {
        sweep(root, &format!("{swept}.bin"));
        put(root, &format!("{folder}/tracklet_labels.xml"), &tracklets(drive));
    } else {
        let line = |p: DVec3| format!("{} 0.3\n", words(p.to_array()));
        put(root, &format!("{swept}.txt"), &canonical::points_sensor().into_iter().map(line).collect::<String>());
    }
}

fn calibrations(drive: &Drive, root: &Path, is_synced: bool) {
    let split = |pose: &Pose<SensorFrame, SensorFrame>| {
        format!("R: {}\nT: {}\n", words(rows(pose.rotation)), words(pose.translation.to_array()))
    };
    let velodyne_from_ego = canonical::ego_from_lidar().inverse();
    put(
        root,
        &format!("{DAY}/calib_imu_to_velo.txt"),
        &format!("calib_time: 25-May-2012 16:47:16\n{}", split(&(velodyne_from_ego * ego_from_imu()))),
    );
    // Camera 0 as it is stands a little askew of the rectified one.
    let rectify =
        if is_synced { Pose::new(DQuat::from_rotation_y(0.01), DVec3::ZERO) } else { Pose::<Camera, Camera>::IDENTITY };
    let ego_from_original = drive.rig[0].ego_from_camera * rectify;
    let camera_from_velodyne = ego_from_original.inverse() * canonical::ego_from_lidar();
    let (r, t) = (rows(camera_from_velodyne.rotation), camera_from_velodyne.translation.to_array());
    put(root, &format!("{DAY}/calib_velo_to_cam.txt"), &format!("R: {}\nT: {}\ndelta_f: 0 0\n", words(r), words(t)));
    let mut text = String::from("calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.95e-02\n");
    for (i, camera) in drive.rig.iter().enumerate() {
        let lens = &camera.lens;
        let (cx, cy) = (lens.cx_px - HALF, lens.cy_px - HALF);
        let size = words([lens.width_px, lens.height_px].map(f64::from));
        let of_original = camera.ego_from_camera.inverse() * ego_from_original;
        let p = if is_synced { projection(&drive.rig[0], camera) } else { [1.0; 12] };
        let distortion = if i == 0 { [0.0; 5] } else { [-0.2636, -0.05866, 0.0004, -0.0007, 0.0944] };
        writeln!(text, "S_0{i}: {size}\nS_rect_0{i}: {size}").unwrap();
        writeln!(text, "K_0{i}: {}", words([lens.fx_px, 0.0, cx, 0.0, lens.fy_px, cy, 0.0, 0.0, 1.0])).unwrap();
        writeln!(text, "D_0{i}: {}", words(distortion)).unwrap();
        writeln!(
            text,
            "R_0{i}: {}\nT_0{i}: {}",
            words(rows(of_original.rotation)),
            words(of_original.translation.to_array())
        )
        .unwrap();
        writeln!(text, "R_rect_0{i}: {}\nP_rect_0{i}: {}", words(rows(rectify.rotation)), words(p)).unwrap();
    }
    put(root, &format!("{DAY}/calib_cam_to_cam.txt"), &text);
}

fn tracklets(drive: &Drive) -> String {
    let mut xml = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n<!DOCTYPE boost_serialization>\n\
         <boost_serialization signature=\"serialization::archive\" version=\"9\">\n<tracklets class_id=\"0\">\n",
    );
    writeln!(xml, "<count>{}</count><item_version>1</item_version>", drive.tracks.len()).unwrap();
    for track in &drive.tracks {
        let size = track.boxes[0].1.size_m;
        writeln!(xml, "<item class_id=\"1\">\n<objectType>{}</objectType>", category(track.kind)).unwrap();
        writeln!(xml, "<h>{}</h><w>{}</w><l>{}</l>", size.z, size.y, size.x).unwrap();
        writeln!(
            xml,
            "<first_frame>{}</first_frame>\n<poses class_id=\"2\"><count>{}</count>",
            track.boxes[0].0,
            track.boxes.len()
        )
        .unwrap();
        for (k, cuboid) in &track.boxes {
            let velodyne_from_world = (drive.keyframes[*k].world_from_ego * canonical::ego_from_lidar()).inverse();
            let pose = velodyne_from_world * cuboid.world_from_body;
            let t = pose.translation - pose.vector(DVec3::Z) * size.z / 2.0;
            writeln!(xml, "<item><tx>{}</tx><ty>{}</ty><tz>{}</tz>", t.x, t.y, t.z).unwrap();
            writeln!(xml, "<rx>0</rx><ry>0</ry><rz>{}</rz>", pose.yaw_rad()).unwrap();
            writeln!(xml, "<state>2</state><occlusion>0</occlusion><truncation>0</truncation></item>").unwrap();
        }
        xml.push_str("</poses><finished>1</finished></item>\n");
    }
    xml + "</tracklets>\n</boost_serialization>\n"
}

/// A label from its class on.
fn label(drive: &Drive, keyframe: &Keyframe, object: &ObjectBox) -> String {
    let rectified_from_world = (keyframe.world_from_ego * drive.rig[0].ego_from_camera).inverse();
    let pose = rectified_from_world * object.cuboid.world_from_body;
    let size = object.cuboid.size_m;
    let bottom = pose.translation - pose.vector(DVec3::Z) * size.z / 2.0;
    let forward = pose.vector(DVec3::X);
    let yaw_rad = (-forward.z).atan2(forward.x);
    // The annotators' words are those of the object's number.
    let number = object.track;
    let seen = format!("{} {number} -10 0 0 10 10", number % 2);
    let numbers = words([size.z, size.y, size.x, bottom.x, bottom.y, bottom.z, yaw_rad]);
    format!("{} {seen} {numbers}", category(object.kind))
}

fn benchmark_calibration(drive: &Drive) -> String {
    let mut text = String::new();
    for (i, camera) in drive.rig.iter().enumerate() {
        writeln!(text, "P{i}: {}", words(projection(&drive.rig[0], camera))).unwrap();
    }
    let rectify = Pose::<Camera, Camera>::new(DQuat::from_rotation_x(0.02), DVec3::ZERO);
    let camera_from_velodyne = (drive.rig[0].ego_from_camera * rectify).inverse() * canonical::ego_from_lidar();
    let velodyne_from_imu = canonical::ego_from_lidar().inverse() * ego_from_imu();
    // Tracking's keys lack the colon.
    writeln!(text, "R_rect {}", words(rows(rectify.rotation))).unwrap();
    writeln!(text, "Tr_velo_cam {}", words(three_by_four(&camera_from_velodyne))).unwrap();
    writeln!(text, "Tr_imu_velo {}", words(three_by_four(&velodyne_from_imu))).unwrap();
    text
}

/// A tracking sequence.
pub(crate) fn tracking(drive: &Drive, root: &Path) {
    put(root, "training/calib/0003.txt", &benchmark_calibration(drive));
    let poses: Vec<_> = drive.keyframes.iter().map(|k| k.world_from_ego).collect();
    put(root, "training/oxts/0003.txt", &(oxts(drive, &poses).join("\n") + "\n"));
    let mut labels =
        String::from("0 -1 DontCare -1 -1 -10 219.31 188.49 245.5 218.56 -1000 -1000 -1000 -10 -1 -1 -1\n");
    for (k, keyframe) in drive.keyframes.iter().enumerate() {
        for object in &keyframe.boxes {
            writeln!(labels, "{k} {} {}", 10 + object.track, label(drive, keyframe, object)).unwrap();
        }
    }
    put(root, "training/label_02/0003.txt", &labels);
    for camera in &drive.rig {
        let size_px = [camera.lens.width_px, camera.lens.height_px];
        picture(root, &format!("training/{}/0003/000001.png", camera.name), size_px);
    }
    sweep(root, &format!("training/velodyne/0003/{:06}.bin", canonical::SWEPT));
}

/// Object frames, one a keyframe.
pub(crate) fn object(drive: &Drive, root: &Path) {
    for (k, keyframe) in drive.keyframes.iter().enumerate() {
        let calibration = benchmark_calibration(drive)
            .replace("R_rect ", "R0_rect: ")
            .replace("Tr_velo_cam ", "Tr_velo_to_cam: ")
            .replace("Tr_imu_velo ", "Tr_imu_to_velo: ");
        put(root, &format!("training/calib/{k:06}.txt"), &calibration);
        let labels: String = keyframe.boxes.iter().map(|object| label(drive, keyframe, object) + "\n").collect();
        put(root, &format!("training/label_2/{k:06}.txt"), &labels);
        for (i, camera) in drive.rig.iter().enumerate() {
            picture(root, &format!("training/image_{i}/{k:06}.png"), [camera.lens.width_px, camera.lens.height_px]);
        }
        if keyframe.lidar.is_some() {
            sweep(root, &format!("training/velodyne/{k:06}.bin"));
        }
    }
}
