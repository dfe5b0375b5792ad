use std::collections::BTreeMap;
use std::num::NonZero;

use super::*;
use crate::{Class, Kind, Role};

fn map(name: &str) -> ClassMap {
    ClassMap::named(name).unwrap()
}

fn numbers(name: &str) -> [u8; 20] {
    let map = map(name);
    Class::ALL.map(|class| map.id(class))
}

/// Ids of classes that count or not, by name.
fn ids(name: &str) -> BTreeMap<String, u8> {
    map(name).classes.into_iter().map(|class| (class.name, class.id)).collect()
}

#[test]
fn our_classes_have_the_numbers_that_each_dataset_documents() {
    // Written down from the datasets' documentation, not from the tables; in the order of our ids: void, sky, car, bus,
    // jeep, truck, van, human, building, road, barrier, ground, cycle rider, construction, bush, tree, motorcycle rider,
    // traffic cone, traffic sign, sidewalk.
    for (name, expected) in [
        ("trove20", [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19]),
        ("paper13", [0, 12, 1, 2, 1, 3, 1, 4, 8, 6, 0, 11, 5, 3, 10, 10, 5, 9, 9, 7]),
        ("cityscapes", [0, 23, 26, 28, 26, 27, 26, 24, 11, 7, 14, 22, 25, 27, 21, 21, 25, 17, 20, 8]),
        ("cityscapes-train", [255, 10, 13, 15, 13, 14, 13, 11, 2, 0, 255, 9, 12, 14, 8, 8, 12, 5, 7, 1]),
        ("kitti-step", [255, 10, 13, 15, 13, 14, 13, 11, 2, 0, 255, 9, 12, 14, 8, 8, 12, 5, 7, 1]),
        ("coco", [0, 187, 3, 6, 3, 8, 3, 1, 197, 149, 185, 193, 2, 8, 184, 184, 4, 0, 13, 191]),
        ("camvid", [11, 0, 8, 8, 8, 8, 8, 9, 1, 3, 7, 5, 10, 8, 5, 5, 11, 11, 6, 4]),
        // IDD has riders and what they ride apart, which our class has in one.
        ("idd-lite", [255, 6, 3, 3, 3, 3, 3, 2, 5, 0, 4, 1, 255, 3, 5, 5, 255, 4, 4, 1]),
        ("waymo", [0, 25, 2, 4, 2, 3, 2, 9, 19, 20, 28, 26, 10, 5, 24, 24, 11, 14, 17, 23]),
        ("occ3d", [0, 17, 4, 3, 4, 10, 4, 7, 15, 11, 1, 14, 2, 5, 16, 16, 6, 8, 15, 13]),
        // ASPRS LAS 1.4, table 17; from 64 on, which users define, docs/judge.md.
        ("asprs", [1, 0, 64, 65, 64, 66, 64, 68, 6, 11, 72, 2, 69, 67, 4, 5, 70, 72, 73, 71]),
    ] {
        assert_eq!(numbers(name), expected, "{name}");
    }
    assert_eq!(ClassMap::named("trove13"), ClassMap::named("paper13"));
    assert_eq!(ClassMap::named("pascal"), None);
}

#[test]
fn every_built_in_map_numbers_what_counts_from_0_and_knows_what_does_not() {
    for (name, counted, ignored, instances) in [
        ("paper13", 12, vec![0, 255], InstanceCoding::Beside),
        ("trove20", 19, vec![0, 255], InstanceCoding::Beside),
        ("cityscapes", 19, vec![0, 1, 2, 3, 4, 5, 6, 9, 10, 14, 15, 16, 18, 29, 30, 255], InstanceCoding::Beside),
        ("cityscapes-train", 19, vec![255], InstanceCoding::Beside),
        ("kitti-step", 19, vec![255], InstanceCoding::GreenBlue),
        ("coco", 133, vec![0, 255], InstanceCoding::Beside),
        ("camvid", 11, vec![11, 255], InstanceCoding::Beside),
        ("idd-lite", 7, vec![255], InstanceCoding::Beside),
        ("waymo", 27, vec![0, 1, 255], InstanceCoding::Divisor(NonZero::new(1000).unwrap())),
        ("occ3d", 17, vec![17, 255], InstanceCoding::Beside),
        ("asprs", 16, vec![0, 1, 255], InstanceCoding::Beside),
    ] {
        let map = map(name);
        assert_eq!((map.name.as_str(), map.instances), (name, instances));
        let trained: Vec<u8> = map.counted().filter_map(|class| class.train_id).collect();
        assert_eq!(trained, (0..counted).collect::<Vec<_>>(), "{name}");
        assert!(map.classes.is_sorted_by(|a, b| a.id < b.id), "{name}");
        assert_eq!(map.ignored(), ignored, "{name}");
        assert_eq!(map.train_ids().iter().flatten().count(), usize::from(counted), "{name}");
        assert!(Class::ALL.iter().all(|class| map.class(map.id(*class)).is_some()), "{name}");
    }
    assert!(ClassMap::NAMES.iter().all(|name| map(name).name == *name));
    assert_eq!(map("cityscapes").train_ids_of_ours()[usize::from(Class::Jeep.id())], Some(13));
    assert_eq!(map("cityscapes").train_ids_of_ours()[usize::from(Class::Barrier.id())], None);
}

#[test]
fn datasets_number_their_classes_as_they_document_it() {
    let check = |name: &str, expected: &[(&str, u8)]| {
        let found = ids(name);
        for (class, id) in expected {
            assert_eq!(found.get(*class), Some(id), "{name}: {class}");
        }
    };
    check("cityscapes", &[("wall", 12), ("pole", 17), ("traffic light", 19), ("train", 31), ("bicycle", 33)]);
    check("kitti-step", &[("road", 0), ("person", 11), ("car", 13), ("bicycle", 18), ("void", 255)]);
    // COCO's categories leave numbers out: 12, 26, 29, 30, 45, 66, 68, 69, 71, 83 and 91 of things, and all of stuff
    // that was merged.
    check("coco", &[("person", 1), ("traffic light", 10), ("fire hydrant", 11), ("stop sign", 13), ("bench", 15)]);
    check("coco", &[("backpack", 27), ("bottle", 44), ("tv", 72), ("toothbrush", 90), ("banner", 92), ("road", 149)]);
    check("coco", &[("tree-merged", 184), ("fence-merged", 185), ("sky-other-merged", 187), ("pavement-merged", 191)]);
    check(
        "coco",
        &[("grass-merged", 193), ("building-other-merged", 197), ("wall-other-merged", 199), ("rug-merged", 200)],
    );
    let coco = map("coco");
    assert!([12, 26, 29, 30, 45, 66, 68, 69, 71, 83, 91, 150, 182, 201].iter().all(|id| coco.class(*id).is_none()));
    assert_eq!(coco.counted().filter(|class| class.thing).count(), 80);
    check(
        "waymo",
        &[("undefined", 0), ("ego vehicle", 1), ("other large vehicle", 5), ("trailer", 8), ("cyclist", 10)],
    );
    check(
        "waymo",
        &[("bird", 12), ("construction cone or pole", 14), ("pole", 15), ("lane marker", 21), ("static", 28)],
    );
    // Only people and cars have numbers of objects in KITTI-STEP.
    let things: Vec<u8> = map("kitti-step").counted().filter(|class| class.thing).map(|class| class.id).collect();
    assert_eq!(things, [11, 13]);
    let colour = |name: &str, id| map(name).class(id).unwrap().rgb;
    assert_eq!(colour("cityscapes", 24), [220, 20, 60]);
    assert_eq!(colour("kitti-step", 9), [152, 251, 152]);
    assert_eq!(colour("coco", 191), [96, 96, 96]);
    assert_eq!(colour("camvid", 8), [64, 0, 128]);
}

#[test]
fn kinds_say_more_than_classes_where_a_map_is_finer() {
    let number = |name: &str, kind: Kind| map(name).object_id(kind.class(), kind);
    for (kind, cityscapes, train, coco, waymo, ours) in [
        (Kind::TrafficSignal, 19, 6, 10, 18, 18),
        (Kind::StreetLamp, 17, 5, 0, 15, 18),
        (Kind::TrafficSign, 20, 7, 13, 17, 18),
        (Kind::Hydrant, 4, 255, 11, 28, 18),
        (Kind::Bicycle, 33, 18, 2, 6, 12),
        (Kind::BicycleWithRider, 25, 12, 2, 10, 12),
        (Kind::Wall, 12, 3, 199, 19, 10),
        (Kind::Fence, 13, 4, 185, 28, 10),
        (Kind::Trailer, 30, 255, 8, 8, 5),
        (Kind::Bench, 4, 255, 15, 28, 0),
    ] {
        let found = ["cityscapes", "cityscapes-train", "coco", "waymo", "trove20"].map(|name| number(name, kind));
        assert_eq!(found, [cityscapes, train, coco, waymo, ours], "{kind:?}");
    }
    // The class of an asset counts where the kind says nothing: a van of kind car.
    assert_eq!(map("trove20").object_id(Class::Van, Kind::Car), 6);
}

#[test]
fn parts_say_more_than_objects_where_a_map_is_finer() {
    let (bicycle, motorcycle) = (Kind::BicycleWithRider, Kind::MotorcycleWithRider);
    let of = |name: &str, kind: Kind, part| map(name).part_id(kind.class(), Some(kind), part);
    // A cyclist and the bicycle, a motorcyclist and the lamp of the motorcycle, by the datasets' documentation.
    for (name, expected) in [
        ("cityscapes", [25, 33, 25, 32]),
        ("cityscapes-train", [12, 18, 12, 17]),
        ("kitti-step", [12, 18, 12, 17]),
        ("coco", [1, 2, 1, 4]),
        ("waymo", [10, 6, 11, 7]),
        ("idd-lite", [2, 3, 2, 3]),
        // Theirs are one, as ours are.
        ("camvid", [10, 10, 11, 11]),
        ("trove20", [12, 12, 16, 16]),
        ("paper13", [5, 5, 5, 5]),
    ] {
        let found = [
            of(name, bicycle, Some(Role::Cyclist)),
            of(name, bicycle, Some(Role::Ridden)),
            of(name, motorcycle, Some(Role::Motorcyclist)),
            of(name, motorcycle, Some(Role::Headlamp)),
        ];
        assert_eq!(found, expected, "{name}");
        // A model that does not tell its parts is numbered as a whole, and so is what nobody rides.
        assert_eq!(of(name, bicycle, None), map(name).object_id(Class::CycleRider, bicycle), "{name}");
        let parked = map(name).object_id(Class::MotorcycleRider, Kind::Motorcycle);
        assert_eq!(of(name, Kind::Motorcycle, Some(Role::TailLamp)), parked, "{name}");
        assert_eq!(map(name).knows_parts(), !["trove20", "paper13"].contains(&name), "{name}");
    }
    // Yards and car parks are no meadows.
    let ground = [None, Some(Role::Paved), Some(Role::CarPark)];
    for (name, expected) in [
        ("cityscapes", [22, 6, 9]),
        ("cityscapes-train", [9, 255, 255]),
        ("kitti-step", [9, 255, 255]),
        ("camvid", [5, 4, 3]),
        ("coco", [193, 191, 149]),
        ("waymo", [26; 3]),
        ("idd-lite", [1, 1, 0]),
        ("asprs", [2; 3]),
        ("trove20", [11; 3]),
    ] {
        let found = ground.map(|part| map(name).part_id(Class::Ground, None, part));
        assert_eq!(found, expected, "{name}");
    }
    // IDD has kerbs and boards of shops among what stands beside the road, and trodden earth is driven on.
    let part = |class: Class, part| map("idd-lite").part_id(class, None, Some(part));
    assert_eq!([part(Class::Sidewalk, Role::Kerb), part(Class::Sidewalk, Role::Unpaved)], [4, 0]);
    assert_eq!([part(Class::Building, Role::ShopSign), part(Class::Building, Role::RoomLamp)], [4, 5]);
    let of_kind = |kind: Kind| map("idd-lite").object_id(kind.class(), kind);
    assert_eq!([Kind::Animal, Kind::Bicycle, Kind::Debris, Kind::Bench].map(of_kind), [2, 3, 4, 4]);
}

#[test]
fn roles_have_numbers_and_names_of_their_own() {
    for (place, (role, name)) in Role::ALL.into_iter().enumerate() {
        assert_eq!((usize::from(role.id()), role.name()), (place + 1, name));
        assert_eq!((Role::from_id(role.id()), Role::from_name(name)), (Some(role), Some(role)));
    }
    assert_eq!([Role::from_id(0), Role::from_id(Role::ALL.len() as u8 + 1)], [None; 2]);
    // Written down, since files have them.
    assert_eq!([Role::StreetLamp, Role::NameAlongY, Role::Cyclist, Role::CarPark].map(Role::id), [1, 11, 12, 20]);
}

#[test]
fn numbers_are_changed_only_into_maps_where_they_are_known() {
    let change = |from: &str, to: &str| map(from).in_map(&map(to));
    let check = |from: &str, to: &str, pairs: &[(u8, u8)]| {
        let numbers = change(from, to).unwrap();
        for (own, other) in pairs {
            assert_eq!(numbers[usize::from(*own)], *other, "{from} {own} in {to}");
        }
    };
    check("trove20", "paper13", &[(0, 0), (4, 1), (10, 0), (18, 9), (255, 0)]);
    check("trove20", "waymo", &[(9, 20), (19, 23)]);
    check("cityscapes", "paper13", &[(19, 9), (12, 0), (33, 5), (14, 0), (24, 4)]);
    check("kitti-step", "cityscapes", &[(0, 7), (18, 33), (255, 0)]);
    check("cityscapes", "kitti-step", &[(7, 0), (14, 255)]);
    check("waymo", "paper13", &[(21, 6), (22, 6), (8, 3), (14, 9), (26, 11), (16, 0), (1, 0)]);
    check("coco", "paper13", &[(149, 6), (128, 8), (194, 11), (62, 0)]);
    check("camvid", "camvid", &[(0, 0), (11, 11), (10, 10)]);
    // CamVid's trees are terrain too, and nobody says which of our classes a pole of Cityscapes is.
    for (from, to) in [("camvid", "paper13"), ("cityscapes", "trove20"), ("paper13", "trove20"), ("coco", "waymo")] {
        assert_eq!(change(from, to), None, "{from} in {to}");
    }
}

fn entry(id: u8, name: &str, ours: &[Class]) -> ClassMapEntry {
    let (name, ours) = (name.to_owned(), ours.to_vec());
    let (kinds, parts, rgb) = (Vec::new(), Vec::new(), [0; 3]);
    ClassMapEntry { id, name, thing: false, ignored: false, rgb, ours, kinds, parts, paper13: None }
}

#[test]
fn a_map_of_one_s_own_takes_in_what_it_lists() {
    let tree = ClassMapEntry { kinds: vec![Kind::Fence], ..entry(9, "green", &[Class::Bush, Class::Tree]) };
    let lost = ClassMapEntry { ignored: true, ..entry(4, "lost", &[Class::Void]) };
    let all = entry(3, "hard", &[Class::Road, Class::Sidewalk]);
    let map = ClassMap::new("mine", 7, InstanceCoding::Beside, vec![tree, lost, all]).unwrap();
    assert_eq!(
        map.classes.iter().map(|class| (class.id, class.train_id)).collect::<Vec<_>>(),
        [(3, Some(0)), (4, None), (9, Some(1))]
    );
    let of = [Class::Tree, Class::Road, Class::Void, Class::Car].map(|class| map.id(class));
    assert_eq!(of, [9, 3, 4, 7]);
    assert_eq!(map.object_id(Class::Barrier, Kind::Fence), 9);
    assert_eq!(map.ignored(), [4, 7, 255]);
    // Greenery is vegetation, whatever it is; what is hard is two of the thirteen.
    assert_eq!(map.class(9).unwrap().paper13, Some(10));
    assert_eq!(map.class(3).unwrap().paper13, None);
}

#[test]
fn what_is_listed_twice_is_refused() {
    let check = |entries: Vec<ClassMapEntry>, class: &str, part: &str| {
        let fault = ClassMap::new("mine", 255, InstanceCoding::Beside, entries).unwrap_err();
        assert_eq!(fault.class, class);
        assert!(fault.found.contains(part), "{fault:?}");
    };
    check(vec![entry(1, "a", &[]), entry(1, "b", &[])], "b", "that of \"a\"");
    check(vec![entry(1, "a", &[]), entry(2, "a", &[])], "a", "another class");
    check(vec![entry(1, "a", &[Class::Car]), entry(2, "b", &[Class::Car])], "b", "car");
    check(vec![entry(255, "a", &[])], "a", "255");
    let fence = |id, name| ClassMapEntry { kinds: vec![Kind::Fence], ..entry(id, name, &[]) };
    check(vec![fence(1, "a"), fence(2, "b")], "b", "fence");
    let kerb = |id, name| ClassMapEntry { parts: vec![Role::Kerb], ..entry(id, name, &[]) };
    check(vec![kerb(1, "a"), kerb(2, "b")], "b", "kerb");
}
