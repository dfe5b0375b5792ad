//! Writes segments as the dataset does: TFRecord of protobuf frames (v1), Parquet components (v2).

use std::io::Write;
use std::path::Path;

use super::parquet_writer::{Column, Packing, parquet};

/// A segment, in the dataset's own terms.
#[derive(Clone, Default)]
pub(crate) struct Segment {
    pub(crate) name: String,
    pub(crate) location: String,
    pub(crate) cameras: Vec<Camera>,
    pub(crate) lasers: Vec<Laser>,
    pub(crate) frames: Vec<Frame>,
    /// Encoded `MapFeature`s, which v1 alone has.
    pub(crate) map: Vec<Vec<u8>>,
}

#[derive(Clone)]
pub(crate) struct Camera {
    pub(crate) number: i64,
    pub(crate) intrinsics: [f64; 9],
    pub(crate) extrinsic: [f64; 16],
    pub(crate) size: [i64; 2],
}

#[derive(Clone)]
pub(crate) struct Laser {
    pub(crate) number: i64,
    pub(crate) inclinations: Vec<f64>,
    pub(crate) extrinsic: [f64; 16],
}

#[derive(Clone)]
pub(crate) struct Frame {
    pub(crate) time_us: i64,
    pub(crate) pose: [f64; 16],
    pub(crate) pictures: Vec<Picture>,
    pub(crate) labels: Vec<Label>,
    pub(crate) scans: Vec<Scan>,
}

#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) camera: i64,
    pub(crate) pose: [f64; 16],
    pub(crate) pose_s: f64,
    pub(crate) trigger_s: f64,
    pub(crate) readout_done_s: f64,
    pub(crate) velocity: [f64; 3],
    pub(crate) turning: [f64; 3],
    pub(crate) jpeg: Vec<u8>,
    pub(crate) panoptic: Option<Panoptic>,
}

/// Divisor and PNG of a picture's panoptic labels.
pub(crate) type Panoptic = (i64, Vec<u8>);

#[derive(Clone)]
pub(crate) struct Label {
    pub(crate) id: String,
    pub(crate) kind: i64,
    pub(crate) centre: [f64; 3],
    /// Length, width, height.
    pub(crate) size: [f64; 3],
    pub(crate) heading: f64,
    pub(crate) speed: [f64; 3],
    pub(crate) points: i64,
}

/// Range images of a LiDAR.
#[derive(Clone)]
pub(crate) struct Scan {
    pub(crate) number: i64,
    pub(crate) first: Image,
    pub(crate) poses: Option<Image>,
}

#[derive(Clone)]
pub(crate) struct Image {
    pub(crate) shape: [usize; 3],
    pub(crate) values: Vec<f32>,
}

impl Segment {
    /// One frame that is valid: a car ahead, a camera, a LiDAR of two beams on even ground.
    pub(crate) fn small() -> Self {
        let level = |x, z| [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0];
        let ranges = (0..8).flat_map(|i| [if i < 4 { 20.0 } else { 10.0 }, 0.5, 0.0, 0.0]).collect();
        let frame = |k: i64| Frame {
            time_us: 1_600_000_000_000_000 + k * 100_000,
            pose: level(100.0 + k as f64, 7.0),
            pictures: vec![Picture {
                camera: 1,
                pose: level(100.0 + k as f64, 7.0),
                pose_s: 1_600_000_000.02 + k as f64 * 0.1,
                trigger_s: 1_600_000_000.0 + k as f64 * 0.1,
                readout_done_s: 1_600_000_000.04 + k as f64 * 0.1,
                velocity: [10.0, 0.0, 0.0],
                turning: [0.0; 3],
                jpeg: vec![0xff, 0xd8, 0xff],
                panoptic: None,
            }],
            labels: vec![Label {
                id: "car".into(),
                kind: 1,
                centre: [20.0, 1.0, 0.8],
                size: [4.5, 1.9, 1.6],
                heading: 0.1,
                speed: [5.0, 0.5, 0.0],
                points: 40,
            }],
            scans: vec![Scan {
                number: 1,
                first: Image { shape: [2, 4, 4], values: Vec::clone(&ranges) },
                poses: None,
            }],
        };
        Self {
            name: "small".into(),
            location: "location_phx".into(),
            cameras: vec![Camera {
                number: 1,
                intrinsics: [2000.0, 2000.0, 960.0, 640.0, 0.04, -0.33, 0.001, -0.001, 0.0],
                extrinsic: level(1.5, 2.1),
                size: [1920, 1280],
            }],
            lasers: vec![Laser { number: 1, inclinations: vec![-0.2, -0.1], extrinsic: level(1.4, 2.0) }],
            frames: (0..3).map(frame).collect(),
            map: Vec::new(),
        }
    }

    /// As a TFRecord file.
    pub(crate) fn v1(&self) -> Vec<u8> {
        let frames = self.frames.iter().enumerate();
        frames.flat_map(|(i, frame)| record(&self.frame_message(frame, i == 0))).collect()
    }

    /// As Parquet components by their names.
    pub(crate) fn v2(&self, packing: Packing) -> Vec<(&'static str, Vec<u8>)> {
        let file = |columns: Vec<(&str, Column)>| parquet(&columns, packing);
        let frames = || self.frames.iter();
        let name = |rows: usize| ("key.segment_context_name", Column::Text(vec![self.name.clone(); rows]));
        let times = |count: &dyn Fn(&Frame) -> usize| {
            Column::Long(frames().flat_map(|frame| vec![frame.time_us; count(frame)]).collect())
        };
        let labels: Vec<&Label> = frames().flat_map(|frame| &frame.labels).collect();
        let pictures: Vec<&Picture> = frames().flat_map(|frame| &frame.pictures).collect();
        let labelled: Vec<(i64, &Picture, &Panoptic)> = frames()
            .flat_map(|frame| frame.pictures.iter().map(|picture| (frame.time_us, picture)))
            .filter_map(|(time_us, picture)| Some((time_us, picture, picture.panoptic.as_ref()?)))
            .collect();
        let scans: Vec<&Scan> = frames().flat_map(|frame| &frame.scans).collect();
        let label = |of: &dyn Fn(&Label) -> f64| Column::Double(labels.iter().map(|label| of(label)).collect());
        let picture = |of: &dyn Fn(&Picture) -> f64| Column::Double(pictures.iter().map(|p| of(p)).collect());
        let camera = |of: &dyn Fn(&Camera) -> i64| Column::Int(self.cameras.iter().map(of).collect());
        let image = |of: &dyn Fn(&Scan) -> Option<Image>| {
            let images: Vec<_> = scans.iter().map(|scan| of(scan)).collect();
            let shape = |image: Image| image.shape.iter().map(|n| *n as i64).collect();
            let values = images.iter().map(|i| i.clone().map(|i| i.values)).collect();
            (Column::Floats(values), Column::Ints(images.into_iter().map(|i| i.map(shape)).collect()))
        };
        let mut intrinsics = vec![name(self.cameras.len()), ("key.camera_name", camera(&|c| c.number))];
        for (i, column) in ["f_u", "f_v", "c_u", "c_v", "k1", "k2", "p1", "p2", "k3"].iter().enumerate() {
            let column: &'static str = format!("[CameraCalibrationComponent].intrinsic.{column}").leak();
            intrinsics.push((column, Column::Double(self.cameras.iter().map(|c| c.intrinsics[i]).collect())));
        }
        intrinsics.push((
            "[CameraCalibrationComponent].extrinsic.transform",
            Column::Doubles(self.cameras.iter().map(|c| Some(c.extrinsic.to_vec())).collect()),
        ));
        intrinsics.push(("[CameraCalibrationComponent].width", camera(&|c| c.size[0])));
        intrinsics.push(("[CameraCalibrationComponent].height", camera(&|c| c.size[1])));
        let of_scan = |of: &dyn Fn(&Scan) -> i64| Column::Int(scans.iter().map(|scan| of(scan)).collect());
        let (values, shape) = image(&|scan| Some(scan.first.clone()));
        let (pose_values, pose_shape) = image(&|scan| scan.poses.clone());
        let scan_times = || times(&|frame| frame.scans.len());
        vec![
            (
                "vehicle_pose",
                file(vec![
                    name(self.frames.len()),
                    ("key.frame_timestamp_micros", times(&|_| 1)),
                    (
                        "[VehiclePoseComponent].world_from_vehicle.transform",
                        Column::Doubles(frames().map(|frame| Some(frame.pose.to_vec())).collect()),
                    ),
                ]),
            ),
            ("camera_calibration", file(intrinsics)),
            (
                "camera_image",
                file(vec![
                    ("key.frame_timestamp_micros", times(&|frame| frame.pictures.len())),
                    ("key.camera_name", Column::Int(pictures.iter().map(|p| p.camera).collect())),
                    (
                        "[CameraImageComponent].image",
                        Column::Text(pictures.iter().map(|p| "x".repeat(p.jpeg.len())).collect()),
                    ),
                    (
                        "[CameraImageComponent].pose.transform",
                        Column::Doubles(pictures.iter().map(|p| Some(p.pose.to_vec())).collect()),
                    ),
                    ("[CameraImageComponent].velocity.linear_velocity.x", picture(&|p| p.velocity[0])),
                    ("[CameraImageComponent].velocity.linear_velocity.y", picture(&|p| p.velocity[1])),
                    ("[CameraImageComponent].velocity.linear_velocity.z", picture(&|p| p.velocity[2])),
                    ("[CameraImageComponent].velocity.angular_velocity.x", picture(&|p| p.turning[0])),
                    ("[CameraImageComponent].velocity.angular_velocity.y", picture(&|p| p.turning[1])),
                    ("[CameraImageComponent].velocity.angular_velocity.z", picture(&|p| p.turning[2])),
                    ("[CameraImageComponent].pose_timestamp", picture(&|p| p.pose_s)),
                    ("[CameraImageComponent].rolling_shutter_params.camera_trigger_time", picture(&|p| p.trigger_s)),
                    (
                        "[CameraImageComponent].rolling_shutter_params.camera_readout_done_time",
                        picture(&|p| p.readout_done_s),
                    ),
                ]),
            ),
            (
                "camera_segmentation",
                file(vec![
                    (
                        "key.frame_timestamp_micros",
                        Column::Long(labelled.iter().map(|(time_us, ..)| *time_us).collect()),
                    ),
                    ("key.camera_name", Column::Int(labelled.iter().map(|(_, p, _)| p.camera).collect())),
                    (
                        "[CameraSegmentationLabelComponent].panoptic_label_divisor",
                        Column::Int(labelled.iter().map(|(.., (divisor, _))| *divisor).collect()),
                    ),
                    (
                        "[CameraSegmentationLabelComponent].panoptic_label",
                        Column::Bytes(labelled.iter().map(|(.., (_, png))| png.clone()).collect()),
                    ),
                ]),
            ),
            (
                "lidar_box",
                file(vec![
                    ("key.frame_timestamp_micros", times(&|frame| frame.labels.len())),
                    ("key.laser_object_id", Column::Text(labels.iter().map(|label| label.id.clone()).collect())),
                    ("[LiDARBoxComponent].box.center.x", label(&|l| l.centre[0])),
                    ("[LiDARBoxComponent].box.center.y", label(&|l| l.centre[1])),
                    ("[LiDARBoxComponent].box.center.z", label(&|l| l.centre[2])),
                    ("[LiDARBoxComponent].box.size.x", label(&|l| l.size[0])),
                    ("[LiDARBoxComponent].box.size.y", label(&|l| l.size[1])),
                    ("[LiDARBoxComponent].box.size.z", label(&|l| l.size[2])),
                    ("[LiDARBoxComponent].box.heading", label(&|l| l.heading)),
                    ("[LiDARBoxComponent].type", Column::Int(labels.iter().map(|label| label.kind).collect())),
                    (
                        "[LiDARBoxComponent].num_lidar_points_in_box",
                        Column::Long(labels.iter().map(|label| label.points).collect()),
                    ),
                    ("[LiDARBoxComponent].speed.x", label(&|l| l.speed[0])),
                    ("[LiDARBoxComponent].speed.y", label(&|l| l.speed[1])),
                    ("[LiDARBoxComponent].speed.z", label(&|l| l.speed[2])),
                ]),
            ),
            (
                "lidar_calibration",
                file(vec![
                    ("key.laser_name", Column::Int(self.lasers.iter().map(|l| l.number).collect())),
                    (
                        "[LiDARCalibrationComponent].extrinsic.transform",
                        Column::Doubles(self.lasers.iter().map(|l| Some(l.extrinsic.to_vec())).collect()),
                    ),
                    (
                        "[LiDARCalibrationComponent].beam_inclination.min",
                        Column::Double(self.lasers.iter().map(|_| -0.3).collect()),
                    ),
                    (
                        "[LiDARCalibrationComponent].beam_inclination.max",
                        Column::Double(self.lasers.iter().map(|_| 0.1).collect()),
                    ),
                    (
                        "[LiDARCalibrationComponent].beam_inclination.values",
                        Column::Doubles(self.lasers.iter().map(|l| Some(l.inclinations.clone())).collect()),
                    ),
                ]),
            ),
            (
                "lidar",
                file(vec![
                    ("key.frame_timestamp_micros", scan_times()),
                    ("key.laser_name", of_scan(&|scan| scan.number)),
                    ("[LiDARComponent].range_image_return1.values", values),
                    ("[LiDARComponent].range_image_return1.shape", shape),
                ]),
            ),
            (
                "lidar_pose",
                file(vec![
                    ("key.frame_timestamp_micros", scan_times()),
                    ("key.laser_name", of_scan(&|scan| scan.number)),
                    ("[LiDARPoseComponent].range_image_return1.values", pose_values),
                    ("[LiDARPoseComponent].range_image_return1.shape", pose_shape),
                ]),
            ),
            (
                "stats",
                file(vec![
                    ("key.frame_timestamp_micros", times(&|_| 1)),
                    ("[StatsComponent].location", Column::Text(vec![self.location.clone(); self.frames.len()])),
                ]),
            ),
        ]
    }

    /// Writes both forms below a folder: `v1/segment-NAME.tfrecord` and `v2/COMPONENT/NAME.parquet`.
    pub(crate) fn write(&self, root: &Path) {
        put(root, &format!("v1/segment-{}.tfrecord", self.name), &self.v1());
        for (component, bytes) in self.v2(Packing::None) {
            put(root, &format!("v2/{component}/{}.parquet", self.name), &bytes);
        }
    }

    pub(crate) fn frame_message(&self, frame: &Frame, is_first: bool) -> Vec<u8> {
        let mut context = Message::default().text(1, &self.name);
        for camera in &self.cameras {
            let calibration = Message::default()
                .varint(1, camera.number)
                .doubles(2, &camera.intrinsics)
                .message(3, Message::default().doubles(1, &camera.extrinsic))
                .varint(4, camera.size[0])
                .varint(5, camera.size[1]);
            context = context.message(2, calibration);
        }
        for laser in &self.lasers {
            let calibration = Message::default()
                .varint(1, laser.number)
                .doubles(2, &laser.inclinations)
                .double(3, -0.3)
                .double(4, 0.1)
                .message(5, Message::default().doubles(1, &laser.extrinsic));
            context = context.message(3, calibration);
        }
        context = context.message(4, Message::default().text(2, "Day").text(3, &self.location));
        let pose = Message::default().doubles(1, &frame.pose);
        let mut message = Message::default().message(1, context).varint(2, frame.time_us).message(3, pose);
        for picture in &frame.pictures {
            let [x, y, z] = picture.velocity.map(|v| v as f32);
            let velocity = Message::default().float(1, x).float(2, y).float(3, z);
            let [x, y, z] = picture.turning;
            let velocity = velocity.double(4, x).double(5, y).double(6, z);
            let image = Message::default()
                .varint(1, picture.camera)
                .bytes(2, &picture.jpeg)
                .message(3, Message::default().doubles(1, &picture.pose))
                .message(4, velocity)
                .double(5, picture.pose_s)
                .double(7, picture.trigger_s)
                .double(8, picture.readout_done_s);
            let image = match &picture.panoptic {
                Some((divisor, png)) => image.message(10, Message::default().varint(1, *divisor).bytes(2, png)),
                None => image,
            };
            message = message.message(4, image);
        }
        for scan in &frame.scans {
            let mut image = Message::default().bytes(2, &packed(&scan.first));
            if let Some(poses) = &scan.poses {
                image = image.bytes(4, &packed(poses));
            }
            message = message.message(5, Message::default().varint(1, scan.number).message(2, image));
        }
        for label in &frame.labels {
            let ([x, y, z], [length, width, height]) = (label.centre, label.size);
            let place = Message::default().double(1, x).double(2, y).double(3, z);
            let size = place.double(4, width).double(5, length).double(6, height).double(7, label.heading);
            let [x, y, z] = label.speed;
            let speed = Message::default().double(1, x).double(2, y).double(5, z);
            let label = Message::default()
                .message(1, size)
                .message(2, speed)
                .varint(3, label.kind)
                .text(4, &label.id)
                .varint(7, label.points);
            message = message.message(6, label);
        }
        for feature in self.map.iter().filter(|_| is_first) {
            message = message.bytes(10, feature);
        }
        message.0
    }
}

/// Protocol Buffers' fields, one after the other.
#[derive(Clone, Default)]
pub(crate) struct Message(pub(crate) Vec<u8>);

impl Message {
    pub(crate) fn varint(mut self, field: u32, value: i64) -> Self {
        varint(&mut self.0, u64::from(field) << 3);
        varint(&mut self.0, value as u64);
        self
    }

    pub(crate) fn bytes(mut self, field: u32, value: &[u8]) -> Self {
        varint(&mut self.0, u64::from(field) << 3 | 2);
        varint(&mut self.0, value.len() as u64);
        self.0.extend_from_slice(value);
        self
    }

    pub(crate) fn text(self, field: u32, value: &str) -> Self {
        self.bytes(field, value.as_bytes())
    }

    pub(crate) fn message(self, field: u32, value: Self) -> Self {
        self.bytes(field, &value.0)
    }

    pub(crate) fn double(mut self, field: u32, value: f64) -> Self {
        varint(&mut self.0, u64::from(field) << 3 | 1);
        self.0.extend(value.to_le_bytes());
        self
    }

    fn float(mut self, field: u32, value: f32) -> Self {
        varint(&mut self.0, u64::from(field) << 3 | 5);
        self.0.extend(value.to_le_bytes());
        self
    }

    fn doubles(self, field: u32, values: &[f64]) -> Self {
        values.iter().fold(self, |message, value| message.double(field, *value))
    }
}

pub(crate) fn varint(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

/// A zlib stream of a `MatrixFloat`.
pub(crate) fn packed(image: &Image) -> Vec<u8> {
    let floats: Vec<u8> = image.values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let shape = image.shape.iter().fold(Message::default(), |message, n| message.varint(1, *n as i64));
    let matrix = Message::default().bytes(1, &floats).message(2, shape);
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&matrix.0).unwrap();
    packer.finish().unwrap()
}

/// A record of a TFRecord file.
pub(crate) fn record(bytes: &[u8]) -> Vec<u8> {
    let length = (bytes.len() as u64).to_le_bytes();
    [&length[..], &masked(&length), bytes, &masked(bytes)].concat()
}

/// The checksum as the specification has it, bit by bit.
pub(crate) fn masked(bytes: &[u8]) -> [u8; 4] {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0x82f6_3b78 } else { crc >> 1 };
        }
    }
    (!crc).rotate_right(15).wrapping_add(0xa282_ead8).to_le_bytes()
}

/// Writes a file below the root.
pub(crate) fn put(root: &Path, file: &str, bytes: &[u8]) {
    std::fs::create_dir_all(root.join(file).parent().unwrap()).unwrap();
    std::fs::write(root.join(file), bytes).unwrap();
}
