//! What holds for every asset.

mod cars;
mod street;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use glam::{Vec2, Vec3};
use trove_model::{Asset, Class, KEYPOINTS, Kind, Outdoors, Role};

use crate::{Ingredients, assets};

static ASSETS: LazyLock<Vec<Asset>> = LazyLock::new(|| assets(&Ingredients::default(), &[]));

#[test]
fn every_asset_is_sound_and_stands_centred_on_the_ground() {
    let mut ids = BTreeSet::new();
    for asset in &*ASSETS {
        let (id, mesh) = (&asset.id, &asset.mesh);
        assert!(ids.insert(id.clone()), "{id} is there twice");
        assert_eq!(mesh.defect(), None, "{id}");
        let extras = asset.extras.iter().map(|e| e.mesh.slot_count());
        assert_eq!(extras.fold(mesh.slot_count(), usize::max), asset.slots.len(), "{id}");
        let (low, high) = mesh.bounds().unwrap();
        assert!(low.z.abs() < 1e-6, "{id} stands at {}", low.z);
        let foot = if asset.kind.is_on_pole() { foot(asset) } else { (low + high).truncate() / 2.0 };
        let tolerance = if asset.kind == Kind::Tree { 0.05 } else { 1e-3 };
        assert!(foot.length() < tolerance, "{id} is off by {foot}");
        assert_eq!(asset.size_m, high.as_dvec3() - low.as_dvec3(), "{id}");
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3), "{id} has normals that are not unit");
        assert_eq!(asset.licence, crate::licence::LICENCE, "{id}");
    }
    assert!(ASSETS.is_sorted_by(|a, b| a.id < b.id));
}

#[test]
fn everyone_on_foot_and_on_wheels_has_points_in_their_body() {
    let number = |name: &str| KEYPOINTS.iter().position(|n| *n == name).unwrap();
    let [nose, left, right, ankle] = ["nose", "left_hip", "right_hip", "left_ankle"].map(number);
    let mut people = 0;
    for asset in &*ASSETS {
        let has_rider = matches!(asset.kind, Kind::BicycleWithRider | Kind::MotorcycleWithRider);
        assert_eq!(asset.keypoints.is_some(), asset.class == Class::Human || has_rider, "{}", asset.id);
        let Some(points) = &asset.keypoints else { continue };
        people += 1;
        assert!(points[left].y > points[right].y && points[nose].z > points[left].z, "{}", asset.id);
        assert!(points[left].z > points[ankle].z && points[nose].x > points[left].x - 0.3, "{}", asset.id);
        for (point, name) in points.iter().zip(KEYPOINTS) {
            let off_m = asset.mesh.positions.iter().map(|p| p.distance(*point)).fold(f32::INFINITY, f32::min);
            assert!(off_m < 0.2, "{}: {name} is {off_m} m from the mesh", asset.id);
        }
    }
    assert!(people > 20, "{people}");
}

#[test]
fn riders_are_told_apart_from_what_they_ride() {
    let corners = |asset: &Asset, role: Role| {
        let is_of = |slot: &u16| asset.slots[usize::from(*slot)].material.role == Some(role);
        let triangles = asset.mesh.triangles.iter().zip(&asset.mesh.slots).filter(|(_, slot)| is_of(slot));
        triangles.flat_map(|(t, _)| t.map(|i| asset.mesh.positions[i as usize])).collect::<Vec<_>>()
    };
    for asset in &*ASSETS {
        let rider = match asset.kind {
            Kind::BicycleWithRider => Role::Cyclist,
            Kind::MotorcycleWithRider => Role::Motorcyclist,
            _ => {
                let of_riders = [Role::Cyclist, Role::Motorcyclist, Role::Ridden];
                let told = asset.slots.iter().find(|slot| slot.material.role.is_some_and(|r| of_riders.contains(&r)));
                assert!(told.is_none(), "{}", asset.id);
                continue;
            }
        };
        let (person, cycle) = (corners(asset, rider), corners(asset, Role::Ridden));
        assert!(asset.slots.iter().all(|slot| slot.material.role.is_some()), "{}: all of it is told", asset.id);
        let lamps = asset.slots.iter().filter(|slot| slot.material.role == Some(Role::Headlamp)).count();
        assert!(lamps <= 1, "{}: nothing that is worn shines", asset.id);
        // Heads are of the person, wheels of the cycle, and points of the body are at the person.
        let [head, foot] = [&person, &cycle].map(|p| p.iter().map(|p| p.z).fold(f32::NEG_INFINITY, f32::max));
        assert!(head > foot && head > asset.size_m.z as f32 - 0.01, "{}: {head} {foot}", asset.id);
        assert!(cycle.iter().any(|p| p.z < 0.01) && person.iter().all(|p| p.z > 0.01), "{}", asset.id);
        for point in asset.keypoints.unwrap() {
            let off_m = |of: &[Vec3]| of.iter().map(|p| p.distance(point)).fold(f32::INFINITY, f32::min);
            assert!(off_m(&person) < 0.2, "{}", asset.id);
        }
    }
}

#[test]
fn boards_and_awnings_of_shops_are_told() {
    for role in [Role::ShopSign, Role::Awning] {
        let has = |asset: &&Asset| asset.slots.iter().any(|slot| slot.material.role == Some(role));
        let found: Vec<_> = ASSETS.iter().filter(has).collect();
        assert!(!found.is_empty(), "{role:?}");
        assert!(found.iter().all(|asset| asset.kind == Kind::Building), "{role:?}");
    }
}

#[test]
fn for_every_weather_there_is_somebody_dressed_of_every_kind() {
    let people = [
        Kind::Adult,
        Kind::Child,
        Kind::ConstructionWorker,
        Kind::PoliceOfficer,
        Kind::PersonalMobility,
        Kind::Stroller,
        Kind::Wheelchair,
        Kind::BicycleWithRider,
        Kind::MotorcycleWithRider,
    ];
    for outdoors in Outdoors::ALL {
        for kind in people {
            let of_kind = || ASSETS.iter().filter(|a| a.kind == kind);
            let (dressed, warm) = [outdoors, Outdoors::Warm].map(|o| of_kind().filter(|a| a.suits(o)).count()).into();
            assert!(dressed > 0 && dressed == warm, "{kind:?}, {outdoors:?}: {dressed} of {warm}");
        }
    }
    let light = |id: &str| ASSETS.iter().find(|a| a.id == id).unwrap().worn_in.clone();
    assert_eq!(light("bicycle/racing-rider"), [Outdoors::Warm]);
    assert_eq!(light("person/man-shorts"), [Outdoors::Warm]);
}

/// The middle of what touches the ground; a trunk leans, and touches it all around only a little higher.
fn foot(asset: &Asset) -> Vec2 {
    let height_m = if asset.kind == Kind::Tree { 0.2 } else { 0.01 };
    let touching = asset.mesh.positions.iter().filter(|p| p.z < height_m).map(|p| p.truncate());
    let (low, high) = touching.fold((Vec2::MAX, Vec2::MIN), |(low, high), p| (low.min(p), high.max(p)));
    (low + high) / 2.0
}

#[test]
fn everything_that_moves_has_models_within_its_budget() {
    let mut count: BTreeMap<Kind, usize> = BTreeMap::new();
    for asset in &*ASSETS {
        *count.entry(asset.kind).or_default() += 1;
    }
    #[rustfmt::skip]
    let wanted = [
        (Kind::Car, 13), (Kind::PoliceCar, 1), (Kind::Ambulance, 1), (Kind::Truck, 25), (Kind::Trailer, 5),
        (Kind::ConstructionVehicle, 12), (Kind::Bus, 12), (Kind::ArticulatedBus, 2), (Kind::Motorcycle, 7),
        (Kind::MotorcycleWithRider, 7), (Kind::Bicycle, 8), (Kind::BicycleWithRider, 8), (Kind::Adult, 8),
        (Kind::Child, 2), (Kind::ConstructionWorker, 2), (Kind::PoliceOfficer, 1), (Kind::PersonalMobility, 2),
        (Kind::Stroller, 1), (Kind::Wheelchair, 1), (Kind::Animal, 1),
    ];
    for (kind, least) in wanted {
        let found = count.get(&kind).copied().unwrap_or(0);
        assert!(found >= least, "{found} of {least} models of {kind:?}");
    }
    let most = |asset: &Asset| match asset.kind {
        Kind::Adult | Kind::Child => 8_000,
        // A tractor with its trailer, two halves of a bus.
        _ if asset.size_m.x > 14.0 => 50_000,
        // Rooms and frames are seen.
        Kind::Bus | Kind::Truck => 36_000,
        _ => 25_000,
    };
    let moving = ASSETS.iter().filter(|a| wanted.iter().any(|w| w.0 == a.kind));
    let above = moving.map(|a| (a, a.mesh.triangles.len())).filter(|(a, triangles)| *triangles > most(a));
    let above: Vec<String> = above.map(|(a, triangles)| format!("{} {triangles}", a.id)).collect();
    assert_eq!(above, Vec::<String>::new(), "have too many triangles");
}

#[test]
fn sizes_are_those_of_real_ones() {
    // Shortest and longest, narrowest and widest, lowest and highest; cars without their mirrors.
    let ranges = |asset: &Asset| match asset.kind {
        Kind::Car if asset.tags.has("auto-rickshaw") => Some([(2.5, 2.8), (1.25, 1.35), (1.65, 1.8)]),
        Kind::Car | Kind::PoliceCar => Some([(3.3, 6.0), (1.48, 2.2), (1.25, 2.75)]),
        Kind::Truck => Some([(4.4, 20.5), (1.85, 3.0), (1.75, 4.1)]),
        Kind::Bus => Some([(6.9, 13.5), (2.3, 3.2), (2.6, 4.5)]),
        // With horns.
        Kind::Animal if asset.tags.has("cow") => Some([(2.0, 2.4), (0.5, 0.75), (1.4, 1.7)]),
        Kind::Adult => Some([(0.3, 1.2), (0.4, 0.95), (1.5, 2.0)]),
        Kind::Bicycle => Some([(1.3, 2.5), (0.4, 0.75), (0.8, 1.25)]),
        Kind::BicycleWithRider => Some([(1.3, 2.5), (0.4, 0.8), (1.3, 2.0)]),
        _ => None,
    };
    let fits = |asset: &Asset, ranges: [(f64, f64); 3]| {
        ranges.into_iter().zip(asset.size_m.to_array()).all(|((low, high), size)| (low..=high).contains(&size))
    };
    let outside = ASSETS.iter().filter(|a| ranges(a).is_some_and(|ranges| !fits(a, ranges)));
    let outside: Vec<String> = outside.map(|a| format!("{} {}", a.id, a.size_m)).collect();
    assert_eq!(outside, Vec::<String>::new());
}

#[test]
fn what_only_south_asia_has_stands_only_there() {
    let is_there = |asset: &&Asset| asset.tags.has("auto-rickshaw") || asset.tags.has("cow");
    let (there, elsewhere): (Vec<&Asset>, Vec<&Asset>) =
        ASSETS.iter().filter(|a| a.kind.is_vehicle() || a.kind == Kind::Animal).partition(is_there);
    assert_eq!(there.len(), 4);
    assert!(there.iter().all(|a| a.countries == ["BD", "IN", "LK", "NP", "PK"]));
    assert!(elsewhere.iter().all(|a| a.countries.is_empty()));
}

#[test]
fn the_driver_of_an_auto_rickshaw_sits_in_its_middle_before_the_passengers() {
    for asset in ASSETS.iter().filter(|a| a.tags.has("auto-rickshaw")) {
        let middles = |group: &str| -> Vec<glam::Vec3> {
            let meshes = asset.extras.iter().filter(|e| e.group == group && e.when_driven).map(|e| e.mesh.bounds());
            meshes.map(Option::unwrap).map(|(low, high)| (low + high) / 2.0).collect()
        };
        let [driver] = middles("driver")[..] else { panic!("{}", asset.id) };
        assert!(driver.y.abs() < 0.02, "{} {driver}", asset.id);
        assert!(middles("passenger").iter().all(|p| p.x < driver.x - 0.5), "{}", asset.id);
    }
}

/// A row of a table of tags in the documentation: a kind, and its tags but for its own word.
pub(crate) fn tag_row<'t>(kind: &str, word: &str, tags: impl Iterator<Item = &'t str>) -> String {
    let plain = |tag: &'t str| if tag.starts_with("speed-") { "speed-50" } else { tag };
    let tags: BTreeSet<&str> = tags.filter(|tag| *tag != word).map(plain).collect();
    let snake: String =
        kind.chars().map(|c| if c.is_uppercase() { format!("_{}", c.to_lowercase()) } else { c.into() }).collect();
    let quoted: Vec<String> = tags.iter().map(|tag| format!("`{tag}`")).collect();
    format!("| `{}` | {} |", snake.trim_start_matches('_'), quoted.join(" "))
}

/// Says which rows the documentation lacks.
pub(crate) fn assert_documented(rows: &[String]) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/assets.md");
    let text = std::fs::read_to_string(path).unwrap();
    let missing: Vec<&str> = rows.iter().map(String::as_str).filter(|row| !text.contains(row)).collect();
    assert!(missing.is_empty(), "docs/assets.md lacks\n{}", missing.join("\n"));
}

#[test]
fn the_documentation_lists_the_tags_of_models() {
    use Kind::*;
    let asked = [
        Building,
        TrafficSign,
        TrafficSignal,
        StreetLamp,
        Hydrant,
        Bin,
        Bench,
        BicycleRack,
        StreetFurniture,
        Fence,
        Wall,
        GuardRail,
    ];
    let row = |kind: Kind| {
        let tags = ASSETS.iter().filter(|a| a.kind == kind).flat_map(|a| a.tags.iter());
        tag_row(&format!("{kind:?}"), kind.word(), tags)
    };
    assert_documented(&asked.map(row));
}

#[test]
fn the_library_is_the_same_every_time() {
    for (a, b) in ASSETS.iter().zip(&assets(&Ingredients::default(), &[])) {
        assert_eq!((&a.id, &a.mesh), (&b.id, &b.mesh));
    }
}
