//! Finished frames, as exports read them.

use std::fs;
use std::path::Path;

use trove_format::FrameTable;
use trove_write::{Choice, DatasetFormat, export};

#[allow(clippy::unwrap_used, dead_code)] // the writer's tests use the rest
#[path = "../../crates/trove-write/tests/made/mod.rs"]
mod made;

use made::Made;

/// The frame that is damaged.
const FRAME: &str = "run/scene-0001/v00/k000/ego.CAM_FRONT";
/// Its files, each with a form that reads all of it.
const FILES: [(&str, &str); 6] = [
    ("class.png", "cityscapes"),
    ("instance.png", "coco"),
    ("rgb.png", "hdf5"),
    ("depth.exr", "kitti-depth"),
    ("normal.exr", "hdf5"),
    ("flow_forward.exr", "kitti-flow"),
];

pub(crate) fn prepare(folder: &Path) {
    made::finished(&folder.join("run"), &[Made::new(0), Made::new(1)]);
}

/// As the frame's table, in every form but video, which runs another program.
pub(crate) fn feed_table(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join(FRAME).join(FrameTable::NAME), data);
    DatasetFormat::all().filter(|form| form.name() != "video").for_each(|form| exported(folder, form));
}

/// As each of its pictures.
pub(crate) fn feed_picture(folder: &Path, data: &[u8]) {
    for (name, form) in FILES {
        let path = folder.join(FRAME).join(name);
        let Ok(whole) = fs::read(&path) else { continue };
        let _ = fs::write(&path, data);
        DatasetFormat::named(form).into_iter().for_each(|form| exported(folder, form));
        let _ = fs::write(&path, whole);
    }
}

fn exported(folder: &Path, form: DatasetFormat) {
    let out = folder.join("out");
    let _ = fs::remove_dir_all(&out);
    let _ = export(&folder.join("run"), &out, form, &Choice::default(), &|_, _| true);
}

pub(crate) fn table_seeds() -> Vec<Vec<u8>> {
    seeds(&[FrameTable::NAME])
}

pub(crate) fn picture_seeds() -> Vec<Vec<u8>> {
    seeds(&FILES.map(|(name, _)| name))
}

fn seeds(names: &[&str]) -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    prepare(folder.path());
    names.iter().map(|name| fs::read(folder.path().join(FRAME).join(name)).expect("a file just written")).collect()
}
