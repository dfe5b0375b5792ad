//! Panoptic labels of pictures, out of both forms.

use std::num::NonZero;
use std::path::Path;

use trove_model::{Outcome, Report};
use trove_read::drive_source::LabelPicture;
use trove_read::waymo::Waymo;

use crate::forms::notes;
use crate::parquet_writer::Packing;
use crate::waymo_writer::{Segment, put};

/// A PNG as far as its first bytes tell.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\nlabels";

/// The labels of a folder's only segment.
fn labels(root: &Path, report: &Report) -> Vec<LabelPicture> {
    let waymo = Waymo::open(root, 1, report).unwrap();
    let mut found = Vec::new();
    waymo.labels("small", report, &mut |label| found.push(label)).unwrap();
    found
}

#[test]
fn labels_come_out_of_both_forms_as_they_are_in_them() {
    let mut segment = Segment::small();
    // The second of three frames has none, as most frames.
    segment.frames[0].pictures[0].panoptic = Some((1000, [PNG, &[0, 255, 200]].concat()));
    segment.frames[2].pictures[0].panoptic = Some((256, PNG.to_vec()));
    let root = tempfile::tempdir().unwrap();
    segment.write(root.path());
    let read = |form: &str| labels(&root.path().join(form), &Report::default());
    let label = |k: usize, divisor, png: Vec<u8>| LabelPicture {
        time_ns: segment.frames[k].time_us * 1000,
        camera: "FRONT".into(),
        classes: "waymo",
        instance_divisor: NonZero::new(divisor).unwrap(),
        png,
    };
    assert_eq!(read("v1"), [label(0, 1000, [PNG, &[0, 255, 200]].concat()), label(2, 256, PNG.to_vec())]);
    assert_eq!(read("v2"), read("v1"));
    // Boxes and all else are the same with and without.
    assert_eq!(
        crate::forms::load(&root.path().join("v1"), &Report::default()).unwrap(),
        crate::forms::load(&root.path().join("v2"), &Report::default()).unwrap()
    );
}

#[test]
fn segments_without_labels_have_none_and_that_is_no_fault() {
    let root = tempfile::tempdir().unwrap();
    Segment::small().write(root.path());
    std::fs::remove_dir_all(root.path().join("v2/camera_segmentation")).unwrap();
    for form in ["v1", "v2"] {
        let report = Report::default();
        assert_eq!(labels(&root.path().join(form), &report), []);
        assert_eq!(notes(&report), [], "{form}");
    }
}

#[test]
fn labels_that_cannot_be_used_are_left_out_and_told() {
    for (divisor, png, camera, why) in [
        (0, PNG, 1, "a divisor that 16 bits do not hold"),
        (70_000, PNG, 1, "a divisor that 16 bits do not hold"),
        (-1, PNG, 1, "a divisor that 16 bits do not hold"),
        (1000, b"GIF89a", 1, "no PNG"),
        (1000, PNG, 9, "unknown camera"),
    ] {
        let mut segment = Segment::small();
        segment.frames[1].pictures[0].panoptic = Some((1000, PNG.to_vec()));
        let bad = &mut segment.frames[0].pictures[0];
        (bad.camera, bad.panoptic) = (camera, Some((divisor, png.to_vec())));
        let root = tempfile::tempdir().unwrap();
        segment.write(root.path());
        for form in ["v1", "v2"] {
            let report = Report::default();
            assert_eq!(labels(&root.path().join(form), &report).len(), 1, "{form}: {why}");
            assert_eq!(notes(&report), [(Outcome::Dropped, format!("Waymo labels: {why}"), 1)], "{form}");
        }
    }
}

#[test]
fn a_damaged_file_gives_what_is_whole() {
    let mut segment = Segment::small();
    segment.frames.iter_mut().for_each(|frame| frame.pictures[0].panoptic = Some((1000, PNG.to_vec())));
    let root = tempfile::tempdir().unwrap();
    let v1 = segment.v1();
    // The last record is cut, and one byte of the second's is another.
    let mut bytes = v1[..v1.len() - 9].to_vec();
    bytes[v1.len() / 2] ^= 1;
    put(root.path(), "segment-small.tfrecord", &bytes);
    let report = Report::default();
    assert_eq!(labels(root.path(), &report).len(), 1);
    assert_eq!(notes(&report).iter().map(|(.., count)| count).sum::<u64>(), 2, "{:?}", notes(&report));
    // A component that is cut off is an error, with the file's name.
    let (root, component) = (tempfile::tempdir().unwrap(), "camera_segmentation/small.parquet");
    for (name, bytes) in segment.v2(Packing::None) {
        put(root.path(), &format!("{name}/small.parquet"), &bytes);
    }
    let whole = std::fs::read(root.path().join(component)).unwrap();
    for cut in [0, 3, whole.len() / 2, whole.len() - 1] {
        std::fs::write(root.path().join(component), &whole[..cut]).unwrap();
        let waymo = Waymo::open(root.path(), 1, &Report::default()).unwrap();
        let error = waymo.labels("small", &Report::default(), &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains("camera_segmentation"), "{error}");
    }
}
