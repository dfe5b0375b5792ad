//! Tables, recipes, and files that only trove writes.

use std::fs;
use std::path::Path;

use trove::recipe::Recipe;
use trove_format::{Curated, FrameLine, Manifest, RunIdentity, SiteFile};
use trove_model::{Luminaire, Report};
use trove_read::asset_files;
use trove_read::locale::Locales;
use trove_read::scanner::{self, ScannerChoice};

pub(crate) fn feed_recipe(_: &Path, data: &[u8]) {
    let _ = Recipe::parse(&String::from_utf8_lossy(data));
}

pub(crate) fn recipe_seeds() -> Vec<Vec<u8>> {
    let boston = include_str!("../../examples/boston.toml");
    let varied = "seed = 3\n[drive]\ndataset = \"nuscenes\"\nroot = \"data\"\nkeyframes = { every = 5 }\nversion = \"v1.0-mini\"\n\
        [map]\nosm = [\"a.osm\", \"b.osm.pbf\"]\ncountry = \"DE\"\n[views]\nrig = \"CAM_FRONT\"\nother_vehicles = 2\n\
        [light]\ntime = \"2018-08-01T15:26:00Z\"\nturbidity = 3.0\nclouds = 0.4\n[camera]\nexposure_s = 0.01\n\
        [variations]\ncount = 3\nseasons = [\"summer\", \"winter\"]\nwetness = [0.0, 1.0]\ntraffic = [0.5, 2.0]\n\
        [render]\nsize = [640, 480]\nspp = 16\nnoise = 0.02\ndenoise = \"fast\"\n[output]\nfiles = [\"rgb\", \"class\"]\n";
    vec![boston.into(), varied.into()]
}

pub(crate) fn feed_library(folder: &Path, data: &[u8]) {
    let folder = folder.join("mine");
    let _ = fs::write(folder.join("library.toml"), data);
    let _ = asset_files::read_library(&folder, &Report::default());
    asset_files::check(&folder);
}

pub(crate) fn library_seeds() -> Vec<Vec<u8>> {
    let text = "licence = \"CC0-1.0\"\nauthor = \"me\"\n[[asset]]\nfile = \"a.glb\"\nkind = \"car\"\ntags = [\"red\"]\nup = \"+y\"\n\
        front = \"-z\"\nlength_m = 4.5\nroles = { Paint = \"paint\" }\n\
        light = { table = \"in.ies\", lumens = 5000, kelvin = 3000 }\n[[surface]]\nname = \"a\"\nkind = \"facade\"\ncolor = \"in.png\"\n\
        normal = \"in.png\"\nnormal_style = \"dx\"\nsize_m = [2.0, 3.0]\ncells = [2, 3]\nheight_m = 0.02\n\
        [[environment]]\nfile = \"in.png\"\n";
    vec![text.into()]
}

pub(crate) fn feed_plans(_: &Path, data: &[u8]) {
    let _ = trove_assets::Plans::parse(&String::from_utf8_lossy(data));
}

pub(crate) fn plans_seeds() -> Vec<Vec<u8>> {
    vec![
        include_bytes!("../../crates/trove-assets/plans/cars.toml")[..].into(),
        include_bytes!("../../crates/trove-assets/plans/people.toml")[..].into(),
    ]
}

pub(crate) fn feed_locales(folder: &Path, data: &[u8]) {
    let path = folder.join("locales.toml");
    let _ = fs::write(&path, data);
    let _ = Locales::with_file(&path);
}

pub(crate) fn locales_seeds() -> Vec<Vec<u8>> {
    vec![include_bytes!("../../crates/trove-read/src/locale/locales.toml")[..].into()]
}

pub(crate) fn feed_ies(_: &Path, data: &[u8]) {
    let _ = Luminaire::from_ies(&String::from_utf8_lossy(data));
}

pub(crate) fn ies_seeds() -> Vec<Vec<u8>> {
    let tilted = "IESNA91\n[TEST] 1\nTILT=INCLUDE\n1\n2\n0 90\n1 0.9\n1 1000 1.0 3 2 1 1 0 0 0\n1.0 0.9 50\n0 45 90\n0 90\n\
        100 200 10\n100,400,20\n";
    vec![include_bytes!("../../crates/trove-assets/plans/luminaires/road.ies")[..].into(), tilted.into()]
}

pub(crate) fn feed_scanner(folder: &Path, data: &[u8]) {
    let path = folder.join("lidar.toml");
    let _ = fs::write(&path, data);
    let _ = scanner::read(&path, &ScannerChoice::default());
}

pub(crate) fn scanner_seeds() -> Vec<Vec<u8>> {
    vec![
        include_bytes!("../../crates/trove-read/src/scanner/presets/vls-128.toml")[..].into(),
        include_bytes!("../../crates/trove-read/src/scanner/presets/rs-m1.toml")[..].into(),
    ]
}

pub(crate) fn feed_class_map(folder: &Path, data: &[u8]) {
    let path = folder.join("classes.toml");
    let _ = fs::write(&path, data);
    let _ = trove_read::read_class_map(&path);
}

pub(crate) fn class_map_seeds() -> Vec<Vec<u8>> {
    let own = "name = \"mine\"\nunlabelled = 0\ninstance_divisor = 1000\n[[class]]\nid = 1\nname = \"car\"\nthing = true\n\
        rgb = [0, 0, 142]\ntrove = [\"car\", \"van\"]\n[[class]]\nid = 2\nname = \"dog\"\nkinds = [\"animal\"]\nignored = true\n\
        paper13 = \"person\"\n";
    let like = "like = \"cityscapes\"\n[[class]]\nid = 35\nname = \"cone\"\ntrove = [\"traffic_cone\"]\n";
    [own, like].map(|text| text.as_bytes().to_vec()).to_vec()
}

pub(crate) fn feed_cached_library(_: &Path, data: &[u8]) {
    trove::fuzzing::cached_library(data);
}

pub(crate) fn cached_library_seeds() -> Vec<Vec<u8>> {
    vec![trove::fuzzing::small_cached_library()]
}

/// As each of the files of an output folder.
pub(crate) fn feed_output(folder: &Path, data: &[u8]) {
    for name in [Manifest::NAME, SiteFile::NAME, RunIdentity::NAME, FrameLine::JOURNAL, Curated::NAME] {
        let _ = fs::write(folder.join(name), data);
    }
    let _ = Manifest::read(folder);
    let _ = SiteFile::read(folder);
    let _ = RunIdentity::read(folder);
    let _ = FrameLine::journal(folder);
    let _ = Curated::read(&folder.join(Curated::NAME));
}

pub(crate) fn output_seeds() -> Vec<Vec<u8>> {
    let line = r#"{"frame": "s/v00/k000/ego.A", "files": [{"name": "class.png", "sha256": "ba", "bytes": 7}]}"#;
    let run = r#"{"format": 2, "recipe": {"seed": 1}, "versions": {"trove": "0", "build": "1", "assets": ["a"], "kernel": "k", "denoiser": null}, "inputs": {"a": "b"}}"#;
    let manifest = r#"{"format": 2, "seed": 1, "recipe": {}, "versions": {"trove": "0", "build": "1", "assets": [], "kernel": "k", "denoiser": null}, "classes": [], "drives": [], "licences": [], "frames": []}"#;
    [line, run, manifest].map(|text| text.as_bytes().to_vec()).to_vec()
}
