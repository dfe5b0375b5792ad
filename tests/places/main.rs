//! Made-up places in three parts of the world, and the real ones of `TROVE_TEST_DATA`: what must hold of all of them.

#![allow(clippy::unwrap_used)] // all of this is tests

mod bars;
mod checks;
mod cover;
mod drawing;
mod footing;
mod made_up;
mod mapped;

use std::path::PathBuf;
use std::sync::LazyLock;

use glam::DVec2;
use trove_build::{BuildSettings, LightChoice, OnDisagreement, PlacePlan, SkyChoice, Weather};
use trove_model::{AssetLibrary, Bounds, Class, Drive, Locale, MapProjection, Report, Scene, Seed, StreetMap};
use trove_read::{locale::Locales, nuscenes::NuScenes, osm};

/// A place that has been built.
struct Place {
    name: String,
    drive: Drive,
    map: StreetMap,
    /// What the map was read for.
    area: Bounds,
    report: Report,
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
        invent: false,
        locale: locale(drive.projection),
        borders: None,
    };
    static LIBRARY: LazyLock<AssetLibrary> =
        LazyLock::new(|| trove_assets::library(&trove_assets::Ingredients::default()));
    let site = trove_build::build(&drive, Some(&map), &LIBRARY, &settings, &report).unwrap();
    let scene = site.scene(&drive, drive.keyframes.len() / 4);
    Place { name: name.into(), drive, map, area, report, scene }
}

/// Everything that must hold; prints at most a few of each kind.
fn check(place: &Place, inside_m2: f64) -> Vec<String> {
    let area = trove_build::area(&place.drive).unwrap();
    let checks: [(&str, Vec<String>); 5] = [
        ("numbers", checks::numbers(&place.scene)),
        ("solids", checks::solids(&place.scene, area, inside_m2)),
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

fn assert_sound(place: &Place, inside_m2: f64, also: Vec<String>) {
    let mut wrong = check(place, inside_m2);
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

/// The made-up towns' map is made here, so what is seen of its buildings is known.
fn assert_made_up(place: &Place) {
    let area = trove_build::area(&place.drive).unwrap();
    let mapped = cover::footprints(&place.map);
    let seen = cover::buildings(&place.scene, area, &mapped, &bars::TOWN, &place.name);
    assert_sound(place, bars::TOWN.inside_m2, seen);
}

#[test]
fn a_town_in_europe_is_sound() {
    assert_made_up(&made_up_place("europe", 52.5, 13.4, 0.0));
}

#[test]
fn a_town_on_a_slope_in_the_tropics_that_drives_on_the_left_is_sound() {
    assert_made_up(&made_up_place("tropics", 1.3, 103.8, 0.05));
}

#[test]
fn a_town_in_north_america_is_sound() {
    assert_made_up(&made_up_place("america", 42.35, -71.05, -0.03));
}

/// What is broken in a building on purpose.
enum Fault {
    Lost,
    Moved,
    WithoutRoof,
    WithoutWall,
}

/// The place with a fault in the building at a point.
fn broken(place: &Place, at: DVec2, fault: &Fault) -> Scene {
    let mut scene = place.scene.clone();
    let holds = |i: &usize| {
        let instance = &scene.instances[*i];
        let bounds = scene.meshes[instance.mesh].bounds();
        let is_there = |(low, high): (glam::Vec3, glam::Vec3)| {
            let p = instance.world_from_mesh.inverse().transform_point3(at.extend(0.0)).as_vec3();
            p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y
        };
        instance.class == Class::Building && bounds.is_some_and(is_there)
    };
    let index = (0..scene.instances.len()).find(holds).unwrap();
    let mesh = scene.instances[index].mesh;
    let mut broken = trove_model::Mesh::clone(&scene.meshes[mesh]);
    let (positions, slots) = (broken.positions.clone(), broken.slots.clone());
    let stays = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        match fault {
            Fault::Lost => false,
            Fault::Moved => true,
            Fault::WithoutRoof => normal.z < 0.3,
            Fault::WithoutWall => normal.x < 0.9,
        }
    };
    let kept: Vec<usize> = (0..broken.triangles.len()).filter(|&i| stays(&broken.triangles[i])).collect();
    assert_eq!(kept.len() < broken.triangles.len(), !matches!(fault, Fault::Moved));
    broken.slots = kept.iter().filter_map(|&i| slots.get(i).copied()).collect();
    broken.triangles = kept.iter().map(|&i| broken.triangles[i]).collect();
    scene.meshes[mesh] = broken.into();
    if matches!(fault, Fault::Moved) {
        scene.instances[index].world_from_mesh.translation.x += 1.0;
    }
    scene
}

#[test]
fn a_building_that_is_lost_or_moved_or_has_no_roof_or_a_wall_too_few_is_found() {
    let place = made_up_place("europe", 52.5, 13.4, 0.0);
    let area = trove_build::area(&place.drive).unwrap();
    let mapped = cover::footprints(&place.map);
    let check = |scene: &Scene| {
        (
            cover::buildings(scene, area, &mapped, &bars::TOWN, "broken").len(),
            checks::solids(scene, area, bars::TOWN.inside_m2).len(),
        )
    };
    // In the long wing of the house with a hip.
    let broken = |fault: Fault| check(&broken(&place, DVec2::new(26.0, -30.0), &fault));
    assert_eq!(check(&place.scene), (0, 0));
    assert!(broken(Fault::Lost).0 > 0);
    assert!(broken(Fault::Moved).0 > 0);
    let (unseen, open) = broken(Fault::WithoutRoof);
    assert!(unseen > 0 && open > 0);
    assert!(broken(Fault::WithoutWall).1 > 0);
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
    let map = trove_build::with_bends(map);
    build(scene, drive, map, area, report)
}

fn mapped_place(name: &str, file: &str, lat_deg: f64, lon_deg: f64) -> Place {
    let data = data();
    let report = Report::default();
    let plan = plan(name, lat_deg, lon_deg, 300.0);
    let area = Bounds::square(DVec2::ZERO, 300.0);
    let map = osm::read(&data.join("osm").join(file), &plan.projection, area, plan.driving_side, &report).unwrap();
    let map = trove_build::with_bends(map);
    let drive = trove_build::place_drive(&map, &plan, Seed(7), &report).unwrap();
    build(name, drive, map, area, report)
}

/// `file` is the map's extract; the bar is for what is seen of its buildings, where it has any.
fn assert_real(place: &Place, file: &str, bar: Option<&cover::Bar>) {
    let mut wrong = checks::accounted(&place.report);
    // Without a reader of its own for PBF, Monaco is compared with what the reader says.
    let mut mapped = cover::footprints(&place.map);
    if file.ends_with(".osm") {
        let read = mapped::MapFile::read(&data().join("osm").join(file), &place.drive.projection);
        wrong.extend(read.missing(place.area, &place.map));
        mapped = read.footprints();
    }
    let measured = |name: &str| place.report.measurements().iter().find(|m| m.name == name).map_or(0.0, |m| m.value);
    let [rectangular, replaced] = ["buildings.rectangular", "buildings.replaced_by_assets"].map(measured);
    println!("{}: {replaced} of {rectangular} rectangular buildings are models", place.name);
    if bar.is_some_and(|bar| replaced < bar.modelled * rectangular) {
        wrong.push(format!("models stand for {replaced} of {rectangular} rectangular buildings"));
    }
    wrong.extend(cover::road(&place.scene, &place.drive));
    match bar {
        Some(bar) => {
            let area = trove_build::area(&place.drive).unwrap();
            let mapped = cover::agreed(&mapped, &place.drive, &place.map);
            wrong.extend(cover::buildings(&place.scene, area, &mapped, bar, &place.name));
        }
        None => assert!(mapped.is_empty(), "{file} has buildings"),
    }
    assert_sound(place, bar.map_or(0.0, |bar| bar.inside_m2), wrong);
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_boston_as_recorded_is_sound() {
    let file = "boston-seaport.osm";
    assert_real(&recorded_place("scene-0103", file), file, Some(&bars::BOSTON));
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_singapore_as_recorded_is_sound() {
    let file = "singapore-onenorth.osm";
    assert_real(&recorded_place("scene-0061", file), file, None);
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_neukolln_is_sound() {
    let file = "neukolln.osm";
    assert_real(&mapped_place("neukolln", file, 52.4735, 13.4394), file, Some(&bars::NEUKOLLN));
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_taipei_is_sound() {
    let file = "taipei.osm";
    assert_real(&mapped_place("taipei", file, 25.0522, 121.5227), file, Some(&bars::TAIPEI));
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_monaco_is_sound() {
    let file = "monaco-latest.osm.pbf";
    assert_real(&mapped_place("monaco", file, 43.7396, 7.4275), file, Some(&bars::MONACO));
}
