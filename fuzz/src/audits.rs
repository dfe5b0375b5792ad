//! Datasets of others, as `trove verify --labels` reads them.

use std::fs;
use std::path::Path;

use trove_judge::audit::{FrameReader, LabelForm, LabelledFrame, LabelledSweep, audit};

/// Files that are fed, below a root of their form, each with a valid content.
const FILES: [(LabelForm, &str, &str); 7] = [
    (
        LabelForm::Coco,
        "coco/annotations/instances.json",
        r#"{"images":[{"id":1,"file_name":"a.png","width":4,"height":3}],"categories":[{"id":3}],"annotations":[
        {"id":1,"image_id":1,"category_id":3,"bbox":[1,0,2,2],"area":4,"iscrowd":0,"segmentation":[[1,0,3,0,3,2,1,2]]},
        {"id":2,"image_id":1,"category_id":3,"bbox":[0,0,4,3],"area":12,"iscrowd":1,"segmentation":{"size":[3,4],"counts":"0<"}},
        {"id":3,"image_id":1,"category_id":3,"bbox":[0,0,4,3],"keypoints":[1,1,2,0,0,0],"num_keypoints":1},
        {"image_id":1,"file_name":"b.png","segments_info":[{"id":5,"category_id":3,"area":12,"bbox":[0,0,4,3]}]}]}"#,
    ),
    (
        LabelForm::Cityscapes,
        "cityscapes/a_000000_000001_gtFine_polygons.json",
        r#"{"imgHeight":3,"imgWidth":4,"objects":[{"label":"road","polygon":[[0,0],[4,0],[4,3],[0,3]]},{"label":"cargroup","polygon":[[1,1],[2,1],[2,2]]}]}"#,
    ),
    (
        LabelForm::Kitti,
        "kitti/label_02/0000.txt",
        "0 1 Car 0 0 -1.57 599.41 156.40 629.75 189.25 2.85 2.63 12.34 0.47 1.49 69.44 -1.56\n1 -1 DontCare -1 -1 -10 503.89 169.71 590.61 190.13 -1 -1 -1 -1000 -1000 -1000 -10\n",
    ),
    (
        LabelForm::Kitti,
        "kitti/calib/0000.txt",
        "P2: 7.2e+02 0 6.1e+02 4.5e+01 0 7.2e+02 1.7e+02 2.1e-01 0 0 1 2.7e-03\n",
    ),
    (
        LabelForm::NuScenes,
        "nuscenes/v1.0-mini/sample_annotation.json",
        r#"[{"token":"a","sample_token":"s","instance_token":"i","translation":[1,2,3],"size":[2,4,1.5],"rotation":[1,0,0,0],"prev":"","next":""}]"#,
    ),
    (
        LabelForm::NuScenes,
        "nuscenes/v1.0-mini/sample.json",
        r#"[{"token":"s","timestamp":1532402927647951,"prev":"","next":""}]"#,
    ),
    (
        LabelForm::NuScenes,
        "nuscenes/v1.0-mini/sample_data.json",
        r#"[{"token":"d","sample_token":"s","ego_pose_token":"e","calibrated_sensor_token":"c","filename":"samples/a.png","width":4,"height":3,"is_key_frame":true}]"#,
    ),
];

/// Tables that are only there to be referred to.
const MORE: [(&str, &str); 3] = [
    ("nuscenes/v1.0-mini/instance.json", r#"[{"token":"i"}]"#),
    ("nuscenes/v1.0-mini/ego_pose.json", r#"[{"token":"e","rotation":[1,0,0,0],"translation":[0,0,0]}]"#),
    ("nuscenes/v1.0-mini/calibrated_sensor.json", r#"[{"token":"c"}]"#),
];

/// An 8-bit grey PNG of 4 × 3 pixels, all 7.
const PICTURES: [&str; 4] =
    ["coco/a.png", "coco/b.png", "cityscapes/a_000000_000001_gtFine_labelIds.png", "nuscenes/samples/a.png"];

/// There are no frames of ours.
struct Nobody;

impl FrameReader for Nobody {
    fn frame(&self, _: &Path, place: &str) -> Result<LabelledFrame, String> {
        Err(place.to_owned())
    }

    fn sweep(&self, _: &Path, place: &str) -> Result<LabelledSweep, String> {
        Err(place.to_owned())
    }
}

pub(crate) fn prepare(folder: &Path) {
    let texts = FILES.iter().map(|(_, name, text)| (*name, *text)).chain(MORE);
    for (name, text) in texts {
        let path = folder.join(name);
        let _ = path.parent().map(fs::create_dir_all);
        let _ = fs::write(path, text);
    }
    for name in PICTURES {
        let path = folder.join(name);
        let _ = path.parent().map(fs::create_dir_all);
        let _ = image::GrayImage::from_pixel(4, 3, image::Luma([7])).save(&path);
    }
}

/// As each of the files.
pub(crate) fn feed(folder: &Path, data: &[u8]) {
    for (form, name, text) in FILES {
        let _ = fs::write(folder.join(name), data);
        let root = folder.join(name.split('/').next().unwrap_or_default());
        let _ = audit(&root, Some(form), &Nobody, &|_, _| true);
        let _ = fs::write(folder.join(name), text);
    }
}

pub(crate) fn seeds() -> Vec<Vec<u8>> {
    FILES.iter().map(|(_, _, text)| text.as_bytes().to_vec()).collect()
}
