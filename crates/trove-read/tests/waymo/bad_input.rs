//! Damaged segments: a clear error, or a reported skip of what is damaged.

use proptest::prelude::*;
use trove_model::{Outcome, Report};

use crate::forms::{load, notes};
use crate::parquet_writer::{Column, Packing, parquet};
use crate::waymo_writer::{Image, Label, Message, Scan, Segment, packed, put, record};

/// What is said of a v1 file.
fn v1_error(bytes: &[u8]) -> String {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), "a.tfrecord", bytes);
    load(root.path(), &Report::default()).unwrap_err().to_string()
}

/// What is noted of a v1 file that can be used: keyframes, boxes, and the notes.
fn v1_notes(bytes: &[u8]) -> (usize, usize, Vec<(Outcome, String, u64)>) {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "a.tfrecord", bytes);
    let drive = load(root.path(), &report).unwrap();
    (drive.keyframes.len(), drive.keyframes.iter().map(|k| k.boxes.len()).sum(), notes(&report))
}

/// The small segment with a change.
fn changed(change: impl FnOnce(&mut Segment)) -> Vec<u8> {
    let mut segment = Segment::small();
    change(&mut segment);
    segment.v1()
}

/// What is said of v2 components of which one is replaced; without bytes it is taken away.
fn v2_error(component: &str, bytes: Option<&[u8]>) -> String {
    v2(component, bytes, &Report::default()).unwrap_err().to_string()
}

fn v2(component: &str, bytes: Option<&[u8]>, report: &Report) -> Result<trove_model::Drive, trove_read::ReadError> {
    let root = tempfile::tempdir().unwrap();
    for (name, whole) in Segment::small().v2(Packing::None) {
        match bytes {
            _ if name != component => put(root.path(), &format!("{name}/small.parquet"), &whole),
            Some(bytes) => put(root.path(), &format!("{name}/small.parquet"), bytes),
            None => {}
        }
    }
    load(root.path(), report)
}

fn dropped(what: &str, count: u64) -> Vec<(Outcome, String, u64)> {
    vec![(Outcome::Dropped, what.to_owned(), count)]
}

#[test]
fn a_folder_without_segments_says_what_is_expected() {
    let root = tempfile::tempdir().unwrap();
    let error = load(root.path(), &Report::default()).unwrap_err().to_string();
    assert!(error.contains("*.tfrecord (v1)") && error.contains("vehicle_pose"), "{error}");
    put(root.path(), "a.tfrecord", &Segment::small().v1());
    let waymo = trove_read::waymo::Waymo::open(root.path(), 1, &Report::default()).unwrap();
    let error = waymo.drive("smal", &Report::default()).unwrap_err().to_string();
    assert!(error.contains("a segment named 'smal'") && error.contains("the nearest names are small"), "{error}");
}

#[test]
fn a_file_that_is_no_tfrecord_names_the_place() {
    assert!(v1_error(b"").contains("record 0 at byte 0"), "{}", v1_error(b""));
    assert!(v1_error(&[7; 64]).contains("record 0 at byte 0"), "{}", v1_error(&[7; 64]));
    let no_frame = record(b"\x0b\x0b\x0b");
    assert!(v1_error(&no_frame).contains("expected a frame of a Waymo segment"), "{}", v1_error(&no_frame));
    let nameless = changed(|s| s.name.clear());
    assert!(v1_error(&nameless).contains("the name of its segment"), "{}", v1_error(&nameless));
    // A record that says it has an exabyte.
    let long = [&u64::MAX.to_le_bytes()[..], &crate::waymo_writer::masked(&u64::MAX.to_le_bytes()), &[0; 8]].concat();
    assert!(v1_error(&long).contains("record 0"), "{}", v1_error(&long));
}

#[test]
fn a_record_with_another_checksum_is_left_out() {
    let whole = Segment::small();
    let mut bytes = whole.v1();
    let second = record(&whole.frame_message(&whole.frames[0], true)).len();
    bytes[second + 40] ^= 1;
    assert_eq!(v1_notes(&bytes), (2, 2, dropped("Waymo frame: another checksum", 1)));
    // Where a length is wrong, nobody knows where the next record begins.
    let mut bytes = whole.v1();
    bytes[second] ^= 1;
    let rest = "rest of a Waymo segment: another checksum of the record's length";
    assert_eq!(v1_notes(&bytes), (1, 1, dropped(rest, 1)));
    let truncated = &whole.v1()[..second + 100];
    assert_eq!(v1_notes(truncated), (1, 1, dropped("rest of a Waymo segment: the end of the file", 1)));
}

#[test]
fn a_record_that_is_no_frame_is_left_out() {
    let bytes = [Segment::small().v1(), record(b"\x0a\xff\xff\xff")].concat();
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo frame: bytes that are not a message", 1)));
}

#[test]
fn what_is_not_a_number_is_left_out() {
    let bytes = changed(|s| s.frames[1].pose[3] = f64::NAN);
    assert_eq!(v1_notes(&bytes), (2, 2, dropped("Waymo frame: no valid vehicle pose", 1)));
    let bytes = changed(|s| s.frames[1].labels[0].centre[0] = f64::INFINITY);
    assert_eq!(v1_notes(&bytes), (3, 2, dropped("Waymo label: no usable position", 1)));
    let bytes = changed(|s| s.frames[1].labels[0].size[2] = -1.0);
    assert_eq!(v1_notes(&bytes), (3, 2, dropped("Waymo label: no usable size", 1)));
    let bytes = changed(|s| s.frames[1].labels[0].kind = 77);
    assert_eq!(v1_notes(&bytes), (3, 2, dropped("Waymo label: unknown type", 1)));
    let bytes = changed(|s| s.cameras[0].intrinsics[0] = f64::NAN);
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo camera: no usable intrinsics", 1)));
    let bytes = changed(|s| s.cameras[0].size = [0, 1 << 40]);
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo camera: image of no size", 1)));
    let bytes = changed(|s| s.frames[2].pictures[0].pose_s = f64::NAN);
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo picture without a usable pose or time", 1)));
    let every = changed(|s| s.frames.iter_mut().for_each(|frame| frame.pose = [0.0; 16]));
    assert!(v1_error(&every).contains("at least one frame with a vehicle pose"), "{}", v1_error(&every));
}

#[test]
fn duplicates_are_left_out() {
    let bytes = changed(|s| {
        let twin = s.frames[0].labels[0].clone();
        s.frames[0].labels.push(twin);
    });
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo label: second of its object in a frame", 1)));
    let bytes = changed(|s| s.frames[1].time_us = s.frames[0].time_us);
    assert_eq!(v1_notes(&bytes), (2, 2, dropped("Waymo frame: second of its time", 1)));
    let bytes = changed(|s| {
        let twin = s.frames[0].pictures[0].clone();
        s.frames[0].pictures.push(twin);
    });
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo picture: second of its camera in a frame", 1)));
    // Two files of one segment.
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "a/a.tfrecord", &Segment::small().v1());
    put(root.path(), "b/a.tfrecord", &Segment::small().v1());
    assert_eq!(load(root.path(), &report).unwrap().keyframes.len(), 3);
    assert_eq!(notes(&report), dropped("Waymo segment: second of its name", 1));
}

#[test]
fn time_that_runs_backwards_is_put_in_order() {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "a.tfrecord", &changed(|s| s.frames.reverse()));
    let drive = load(root.path(), &report).unwrap();
    assert!(drive.keyframes.len() == 3 && drive.keyframes.is_sorted_by_key(|k| k.time_ns));
    let note = (Outcome::Substituted, "Waymo frames out of order, put in order of time".to_owned(), 1);
    assert_eq!(notes(&report), [note]);
}

#[test]
fn frames_of_another_segment_are_left_out() {
    let other = Segment { name: "other".into(), ..Segment::small() };
    let bytes = [Segment::small().v1(), other.v1()].concat();
    assert_eq!(v1_notes(&bytes), (3, 3, dropped("Waymo frame: of another segment", 3)));
}

#[test]
fn damaged_range_images_are_left_out() {
    let image = |shape: [usize; 3]| Image { shape, values: vec![5.0; shape.iter().product()] };
    let scan = |number, first, poses| vec![Scan { number, first, poses }];
    let cases = [
        (scan(9, image([2, 4, 4]), None), "LiDAR without calibration"),
        (scan(1, image([3, 4, 4]), None), "another number of beams than its calibration"),
        (scan(1, image([2, 4, 4]), Some(image([2, 5, 6]))), "poses of another shape than the range image"),
        (scan(1, Image { shape: [2, 4, 5], values: vec![1.0; 32] }, None), "bytes that are none"),
    ];
    for (scans, why) in cases {
        let bytes = changed(|s| s.frames[1].scans = scans);
        assert_eq!(v1_notes(&bytes), (3, 3, dropped(&format!("Waymo range image: {why}"), 1)));
    }
    // A hundred times the size of the largest there is, in a few kilobytes.
    let bomb = packed(&Image { shape: [6400, 2650, 6], values: vec![0.0; 6400 * 2650 * 6] });
    assert!(bomb.len() < 4 << 20);
    let laser = Message::default().varint(1, 1).message(2, Message::default().bytes(2, &bomb));
    let small = Segment::small();
    let frame = [small.frame_message(&small.frames[0], true), Message::default().message(5, laser).0].concat();
    assert_eq!(v1_notes(&record(&frame)), (1, 1, dropped("Waymo range image: bytes that are none", 1)));
}

#[test]
fn a_component_that_is_not_there_is_reported() {
    for component in ["camera_calibration", "camera_image", "lidar_box", "lidar_calibration", "lidar", "stats"] {
        let report = Report::default();
        assert_eq!(v2(component, None, &report).unwrap().keyframes.len(), 3, "{component}");
        let is_told = |note: &(Outcome, String, u64)| note.1.contains("without the component of its");
        assert!(notes(&report).iter().any(is_told), "{component} {:?}", report.entries());
    }
    assert!(v2_error("vehicle_pose", None).contains("Waymo segments: *.tfrecord (v1)"));
}

#[test]
fn a_component_that_is_damaged_names_file_and_place() {
    for component in ["vehicle_pose", "camera_image", "lidar_box"] {
        for bytes in [&b""[..], b"PAR1", &[0; 100], b"PAR1\xff\xff\xff\x7fPAR1"] {
            let error = v2_error(component, Some(bytes));
            assert!(error.contains(&format!("{component}/small.parquet: footer")), "{error}");
        }
    }
}

#[test]
fn a_column_that_is_missing_or_of_another_type_is_named() {
    let poses = |name, column| {
        let times = Column::Long(vec![1, 2, 3]);
        v2_error(
            "vehicle_pose",
            Some(&parquet(&[("key.frame_timestamp_micros", times), (name, column)], Packing::None)),
        )
    };
    let (transform, rows) = ("[VehiclePoseComponent].world_from_vehicle.transform", vec![Some(vec![0.0; 16]); 3]);
    let error = poses("[VehiclePoseComponent].world_from_vehicle.transfrom", Column::Doubles(rows));
    assert!(error.contains(&format!("column '{transform}'")) && error.contains("transfrom"), "{error}");
    let error = poses(transform, Column::Text(vec!["a".into(); 3]));
    assert!(error.contains("expected floating-point numbers, found Bytes"), "{error}");
    let error = poses(transform, Column::Doubles(vec![Some(vec![1.0; 15]), None, Some(vec![f64::NAN; 16])]));
    assert!(error.contains("at least one frame with a vehicle pose"), "{error}");
}

#[test]
fn rows_of_no_frame_and_images_of_another_shape_are_told() {
    let mut segment = Segment::small();
    let van = Label { id: "van".into(), ..segment.frames[1].labels[0].clone() };
    segment.frames[1].labels.push(van);
    let boxes =
        |segment: &Segment| segment.v2(Packing::None).into_iter().find(|(name, _)| *name == "lidar_box").unwrap().1;
    segment.frames[2].time_us += 7;
    let report = Report::default();
    let drive = v2("lidar_box", Some(&boxes(&segment)), &report).unwrap();
    assert_eq!(drive.keyframes.iter().map(|k| k.boxes.len()).collect::<Vec<_>>(), [1, 2, 0]);
    assert_eq!(notes(&report), dropped("Waymo label of no frame", 1));
    let times = Column::Long(vec![segment.frames[0].time_us]);
    let columns = [
        ("key.frame_timestamp_micros", times),
        ("key.laser_name", Column::Int(vec![1])),
        ("[LiDARComponent].range_image_return1.values", Column::Floats(vec![Some(vec![1.0; 7])])),
        ("[LiDARComponent].range_image_return1.shape", Column::Ints(vec![Some(vec![2, 4, 4])])),
    ];
    let error = v2_error("lidar", Some(&parquet(&columns, Packing::None)));
    assert!(error.contains("row 0") && error.contains("7 values of shape [2, 4, 4]"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn no_damage_makes_the_reader_panic(
        file in 0..9usize, place in 0.0..1.0f64, from_end in any::<bool>(), damage in damage()
    ) {
        let mut segment = Segment::small();
        segment.map = vec![Message::default().varint(1, 1).message(3, Message::default().message(8, Message::default())).0];
        let root = tempfile::tempdir().unwrap();
        let damaged = |mut bytes: Vec<u8>| {
            // Half of the damage falls on the footer.
            let reach = if from_end { bytes.len().min(300) } else { bytes.len() };
            let at = bytes.len() - 1 - (place * reach as f64) as usize;
            match damage {
                Damage::Flip(bit) => bytes[at] ^= 1 << bit,
                Damage::Set(value) => bytes[at] = value,
                Damage::Truncate => bytes.truncate(at),
                Damage::Remove(n) => drop(bytes.drain(at..(at + n).min(bytes.len()))),
            }
            bytes
        };
        if file == 8 {
            // Behind the checksums, which catch all other damage.
            let frames = segment.frames.iter().enumerate().map(|(i, frame)| {
                let message = segment.frame_message(frame, i == 0);
                record(&if i == 1 { damaged(message) } else { message })
            });
            put(root.path(), "a.tfrecord", &frames.flatten().collect::<Vec<_>>());
        } else {
            for (i, (name, bytes)) in segment.v2(Packing::Snappy).into_iter().enumerate() {
                put(root.path(), &format!("{name}/small.parquet"), &if i == file { damaged(bytes) } else { bytes });
            }
        }
        if let Ok(drive) = load(root.path(), &Report::default()) {
            prop_assert!(!drive.keyframes.is_empty());
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Damage {
    Flip(u8),
    Set(u8),
    Truncate,
    Remove(usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        (0..8u8).prop_map(Damage::Flip),
        prop_oneof![Just(0u8), Just(0xff), any::<u8>()].prop_map(Damage::Set),
        Just(Damage::Truncate),
        (1..9usize).prop_map(Damage::Remove),
    ]
}
