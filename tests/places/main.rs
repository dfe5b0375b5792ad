//! Made-up places in three parts of the world, and the real ones of `TROVE_TEST_DATA`: what must hold of all of them.

#![allow(clippy::unwrap_used)] // all of this is tests

mod checks;
mod cover;
mod drawing;
mod footing;
mod made_up;
mod mapped;

use std::path::PathBuf;
use std::sync::LazyLock;

use glam::DVec2;
use trove_build::{BuildSettings, LightChoice, OnDisagreement, PlacePlan, Site, SkyChoice, Weather};
use trove_model::{AssetLibrary, Bounds, Drive, Locale, MapProjection, Report, Scene, Seed, StreetMap};
use trove_read::{locale::Locales, nuscenes::NuScenes, osm};

/// A place that has been built.
struct Place {
    name: String,
    drive: Drive,
    map: StreetMap,
    /// What the map was read for.
    area: Bounds,
    report: Report,
    site: Site,
    scene: Scene,
}

fn locale(projection: MapProjection) -> Locale {
    static LOCALES: LazyLock<Locales> = LazyLock::new(Locales::built_in);
    LOCALES.at(projection.origin_lat_deg, projection.origin_lon_deg, &Report::default())
}

fn plan(name: &str, lat_deg: f64, lon_deg: f64, size_m: f64) -> PlacePlan<'_> {
    let projection = MapProjection::spherical(lat_deg, lon_deg, DVec2::ZERO);
    PlacePlan { name, projection, size_m, driving_side: locale(projection).driving_side, time_ns: 0 }
}

fn build(name: &str, drive: Drive, map: StreetMap, area: Bounds, report: Report) -> Place {
    let settings = BuildSettings {
        seeds: Seed(7).into(),
        top_k: 3,
        traffic: trove_build::Traffic::default(),
        light: LightChoice::Sky(SkyChoice::default()),
        weather: Weather::default(),
        on_disagreement: OnDisagreement::default(),
        locale: locale(drive.projection),
        borders: None,
    };
    static LIBRARY: LazyLock<AssetLibrary> =
        LazyLock::new(|| trove_assets::library(&trove_assets::Ingredients::default()));
    let site = trove_build::build(&drive, Some(&map), &LIBRARY, &settings, &report).unwrap();
    let scene = site.scene(&drive, drive.keyframes.len() / 4);
    Place { name: name.into(), drive, map, area, report, site, scene }
}

/// Everything that must hold; prints at most a few of each kind.
fn check(place: &Place) -> Vec<String> {
    let area = trove_build::area(&place.drive).unwrap();
    let checks: [(&str, Vec<String>); 5] = [
        ("numbers", checks::numbers(&place.scene)),
        ("solids", checks::solids(&place.scene, area)),
        ("standing", checks::standing(&place.scene, area)),
        ("lanes", checks::lanes(&place.scene)),
        ("bodies", checks::bodies(&place.scene)),
    ];
    let mut wrong = Vec::new();
    for (check, found) in checks {
        let total = found.len();
        wrong.extend(found.into_iter().take(12).map(|w| format!("{} {check} ({total}): {w}", place.name)));
    }
    wrong
}

fn assert_sound(place: &Place, also: Vec<String>) {
    let mut wrong = check(place);
    wrong.extend(also.into_iter().map(|w| format!("{}: {w}", place.name)));
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

fn made_up_place(name: &str, lat_deg: f64, lon_deg: f64, slope: f64) -> Place {
    let (map, report) = (made_up::town(), Report::default());
    let plan = plan(name, lat_deg, lon_deg, 240.0);
    let mut drive = trove_build::place_drive(&map, &plan, Seed(3), &report).unwrap();
    for keyframe in &mut drive.keyframes {
        let rise_m = slope * keyframe.world_from_ego.translation.x;
        keyframe.world_from_ego.translation.z += rise_m;
        for exposure in &mut keyframe.exposures {
            exposure.world_from_ego.translation.z += rise_m;
        }
    }
    build(name, drive, map, Bounds::square(DVec2::ZERO, 240.0), report)
}

#[test]
fn a_town_in_europe_is_sound() {
    assert_sound(&made_up_place("europe", 52.5, 13.4, 0.0), Vec::new());
}

#[test]
fn a_town_on_a_slope_in_the_tropics_that_drives_on_the_left_is_sound() {
    assert_sound(&made_up_place("tropics", 1.3, 103.8, 0.05), Vec::new());
}

#[test]
fn a_town_in_north_america_is_sound() {
    assert_sound(&made_up_place("america", 42.35, -71.05, -0.03), Vec::new());
}

/// The folder of real data.
fn data() -> PathBuf {
    PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA"))
}

fn recorded_place(scene: &str, file: &str) -> Place {
    let data = data();
    let report = Report::default();
    let dataset = NuScenes::open(&data.join("nuscenes"), "v1.0-mini", None, &report).unwrap();
    let drive = dataset.drive(scene, &report).unwrap();
    let area = trove_build::area(&drive).unwrap();
    let driving_side = locale(drive.projection).driving_side;
    let map = osm::read(&data.join("osm").join(file), &drive.projection, area, driving_side, &report).unwrap();
    build(scene, drive, map, area, report)
}

fn mapped_place(name: &str, file: &str, lat_deg: f64, lon_deg: f64) -> Place {
    let data = data();
    let report = Report::default();
    let plan = plan(name, lat_deg, lon_deg, 300.0);
    let area = Bounds::square(DVec2::ZERO, 300.0);
    let map = osm::read(&data.join("osm").join(file), &plan.projection, area, plan.driving_side, &report).unwrap();
    let drive = trove_build::place_drive(&map, &plan, Seed(7), &report).unwrap();
    build(name, drive, map, area, report)
}

/// `file` is the map's extract.
fn assert_real(place: &Place, file: &str) {
    let mut wrong = checks::accounted(&place.report);
    if file.ends_with(".osm") {
        let path = data().join("osm").join(file);
        wrong.extend(mapped::missing(&path, &place.drive.projection, place.area, &place.map));
    }
    wrong.extend(cover::road(&place.scene, &place.drive));
    wrong.extend(cover::buildings(&place.site, &place.drive, &place.map));
    assert_sound(place, wrong);
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_boston_as_recorded_is_sound() {
    assert_real(&recorded_place("scene-0103", "boston-seaport.osm"), "boston-seaport.osm");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_singapore_as_recorded_is_sound() {
    assert_real(&recorded_place("scene-0061", "singapore-onenorth.osm"), "singapore-onenorth.osm");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_neukolln_is_sound() {
    assert_real(&mapped_place("neukolln", "neukolln.osm", 52.4735, 13.4394), "neukolln.osm");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_taipei_is_sound() {
    assert_real(&mapped_place("taipei", "taipei.osm", 25.0522, 121.5227), "taipei.osm");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_monaco_is_sound() {
    assert_real(&mapped_place("monaco", "monaco-latest.osm.pbf", 43.7396, 7.4275), "monaco-latest.osm.pbf");
}
