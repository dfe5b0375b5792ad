use super::*;
use crate::placement::ego_cuboid;
use crate::site::{BuildSettings, Site};
use crate::testing;
use glam::{DVec2, DVec3};
use room::Outline;
use trove_model::{
    Asset, AssetLibrary, Bounds, Building, DrivingSide, Instance, MapProjection, Origin, Parking, Scene, SceneObject,
    Sides, State, StreetMap,
};

use crate::geometry::plane::rectangle;
use crate::place::PlacePlan;

const RIDER: &str = "bicycle/rider";

fn library() -> AssetLibrary {
    let mut library = testing::library();
    library.assets.push(testing::asset(RIDER, Kind::BicycleWithRider, [1.75, 0.6, 1.75]));
    library.assets.sort_by(|a, b| a.id.cmp(&b.id));
    library
}

fn site(density: f64, seed: u64, report: &Report) -> Site {
    site_with(Traffic { density, ..Traffic::default() }, seed, report)
}

fn site_with(traffic: Traffic, seed: u64, report: &Report) -> Site {
    let seeds = crate::Seeds { traffic: Seed(seed), ..Seed(1).into() };
    let settings = BuildSettings { seeds, top_k: 3, traffic, ..testing::settings() };
    crate::build(&testing::drive(), None, &library(), &settings, report).unwrap()
}

/// Boxes of who was recorded, with their tracks' tokens, and of who was added.
fn road_users(scene: &Scene) -> (Vec<(String, Cuboid)>, Vec<Cuboid>) {
    let objects = || scene.instances.iter().filter_map(|i| i.object.as_deref());
    let recorded = |o: &SceneObject| match &o.origin {
        Origin::Recorded { track_token, .. } => Some((track_token.clone(), o.cuboid)),
        _ => None,
    };
    let added = objects().filter(|o| o.origin == Origin::Added).map(|o| o.cuboid).collect();
    (objects().filter_map(recorded).collect(), added)
}

#[test]
fn whole_tracks_are_left_out_by_the_seed_and_fewer_at_a_higher_density() {
    let drive = testing::drive();
    let absent = |density, seed| absent(&drive, density, Seed(seed), &Report::default());
    assert!(absent(1.0, 3).is_empty() && absent(2.0, 3).is_empty());
    assert_eq!(absent(0.0, 3).len(), drive.tracks.len());
    assert!((0..20).all(|seed| absent(0.7, seed).is_subset(&absent(0.3, seed))));
    let counts: usize = (0..200).map(|seed| absent(0.5, seed).len()).sum();
    assert!((counts as f64 / 200.0 - 2.0).abs() < 0.3, "{counts}");
    assert!((0..20).any(|seed| absent(0.5, seed) != absent(0.5, seed + 100)));
}

#[test]
fn who_is_left_out_is_so_at_every_keyframe_and_all_else_stays() {
    let (drive, report) = (testing::drive(), Report::default());
    let seed = (0..50).find(|&s| absent(&drive, 0.5, Seed(s).child("absent"), &Report::default()).len() == 2).unwrap();
    let (all, fewer) = (site(1.0, seed, &Report::default()), site(0.5, seed, &report));
    let gone = absent(&drive, 0.5, Seed(seed).child("absent"), &Report::default());
    for k in 0..10 {
        let (before, after) = (all.scene(&drive, k), fewer.scene(&drive, k));
        let is_gone = |i: &Instance| gone.iter().any(|&track| i.id.0 == track as u32 + 1);
        let left: Vec<&Instance> = before.instances.iter().filter(|i| !is_gone(i)).collect();
        let ids = |instances: &mut dyn Iterator<Item = &Instance>| -> Vec<_> {
            instances.map(|i| (i.id, i.class, i.world_from_mesh)).collect()
        };
        assert_eq!(ids(&mut left.into_iter()), ids(&mut after.instances.iter()));
    }
    let dropped = report.entries().into_iter().find(|e| e.what.contains("less traffic")).unwrap();
    assert_eq!((dropped.outcome, dropped.count), (Outcome::Dropped, 2));
}

#[test]
fn who_is_added_meets_nobody_keeps_a_steady_course_and_changes_nothing_else() {
    let (drive, report) = (testing::drive(), Report::default());
    let (base, more) = (site(1.0, 5, &Report::default()), site(6.0, 5, &report));
    let mut seen = std::collections::BTreeMap::new();
    for (k, keyframe) in drive.keyframes.iter().enumerate() {
        let (before, after) = (base.scene(&drive, k), more.scene(&drive, k));
        for (a, b) in before.instances.iter().zip(&after.instances) {
            assert_eq!((a.id, a.class, a.world_from_mesh), (b.id, b.class, b.world_from_mesh));
        }
        let (recorded, added) = road_users(&after);
        let ego = ego_cuboid(&drive, keyframe);
        let recorded_cuboids = recorded.iter().map(|(_, cuboid)| cuboid);
        let bodies: Vec<Outline> = recorded_cuboids.chain(&added).chain([&ego]).map(Outline::of).collect();
        for i in 0..bodies.len() {
            let meets = (0..i).find(|&j| bodies[i].meets(&bodies[j]) && i >= recorded.len());
            assert_eq!(meets, None, "{i} at {k}: {:?}", bodies[i]);
        }
        for instance in &after.instances[before.instances.len()..] {
            let object = instance.object.as_ref().unwrap();
            let now = object.cuboid.world_from_body.translation;
            let (place, speed) = (now, object.velocity_mps.unwrap().length());
            let found = seen.entry(instance.id).or_insert((k, place, object.asset.clone()));
            let ten = (k - found.0) as f64 * 0.5 * speed;
            assert!((found.1.distance(place) - ten).abs() < 0.5, "{:?} at {k}", object.asset);
            if let Some(next) = instance.next {
                let moved = next.world_from_mesh.translation.distance(instance.world_from_mesh.translation);
                assert!((moved - 0.5 * speed).abs() < 0.3, "{moved} {speed}");
            }
        }
    }
    let guessed: u64 = report.entries().iter().filter(|e| e.what.contains("more traffic")).map(|e| e.count).sum();
    assert_eq!(guessed, seen.len() as u64);
    assert!(seen.len() >= 15, "{} of 20", seen.len());
    let assets: BTreeSet<String> = seen.into_values().filter_map(|(.., asset)| asset).collect();
    assert!(assets.contains(RIDER) && assets.contains("person/a"), "{assets:?}");
}

#[test]
fn a_place_without_a_recording_gets_the_usual_number_at_each_standpoint() {
    let mut drive = testing::drive();
    assert_eq!((wanted(&drive, 1.0), wanted(&drive, 2.5), wanted(&drive, 0.2)), (0, 6, 0));
    drive.tracks.clear();
    assert_eq!(wanted(&drive, 2.0), USUAL);
    for (k, keyframe) in drive.keyframes.iter_mut().enumerate() {
        keyframe.time_ns += k as i64 * 60_000_000_000;
    }
    assert_eq!(wanted(&drive, 1.5), USUAL / 2 * 10);
    drive.origin = DriveOrigin::MadeUp;
    assert_eq!([0.0, 0.5, 1.0].map(|density| wanted(&drive, density)), [0, USUAL / 2 * 10, USUAL * 10]);
}

/// A place on a map, with what drives, stands and walks in it.
fn in_a_place(map: &StreetMap, traffic: Traffic) -> (Drive, Site) {
    in_a_place_of(map, &library(), &BuildSettings { traffic, ..testing::settings() })
}

fn in_a_place_of(map: &StreetMap, library: &AssetLibrary, settings: &BuildSettings) -> (Drive, Site) {
    let projection = MapProjection::spherical(1.3, 103.8, DVec2::ZERO);
    let plan = PlacePlan { name: "p", projection, size_m: 300.0, driving_side: DrivingSide::Left, time_ns: 0 };
    let drive = crate::place_drive(map, &plan, Seed(1), &Report::default()).unwrap();
    let site = crate::build(&drive, Some(map), library, settings, &Report::default()).unwrap();
    (drive, site)
}

/// How many cows there are in a street of a country, and how many three-wheelers, which are met in India alone.
fn in_a_street_of(country: &str) -> [usize; 2] {
    let mut library = library();
    let rickshaw = Asset {
        countries: vec!["IN".into()],
        commonness: 8.0,
        ..testing::asset("car/rickshaw", Kind::Car, [2.65, 1.3, 1.7])
    };
    library.assets.extend([testing::asset("animal/cow", Kind::Animal, [2.2, 0.6, 1.4]), rickshaw]);
    library.assets.sort_by(|a, b| a.id.cmp(&b.id));
    let map = testing::map_with_road([[-200.0, 0.0], [200.0, 0.0]]);
    let traffic = Traffic { density: 3.0, ..Traffic::default() };
    let settings = BuildSettings { traffic, locale: testing::locale(country), ..testing::settings() };
    let (drive, site) = in_a_place_of(&map, &library, &settings);
    let of = |asset: &str| {
        let scenes = (0..drive.keyframes.len()).map(|k| site.scene(&drive, k));
        let is_it = |i: &Instance| i.object.as_ref().is_some_and(|o| o.asset.as_deref() == Some(asset));
        scenes.map(|scene| scene.instances.iter().filter(|i| is_it(i)).count()).sum::<usize>()
    };
    [of("animal/cow"), of("car/rickshaw")]
}

#[test]
fn animals_stray_and_models_of_a_country_are_met_where_they_are_at_home() {
    assert_eq!(in_a_street_of("SG"), [0, 0]);
    let [cows, rickshaws] = in_a_street_of("IN");
    assert!(cows > 0 && rickshaws > 5, "{cows} {rickshaws}");
}

/// Boxes of what is parked in a place along a quiet street that is 7 m wide, by keyframe; nobody may park on its left.
fn parked_in_a_place(density: f64, left: Option<Parking>) -> Vec<Vec<Cuboid>> {
    let mut map = testing::map_with_road([[-200.0, 0.0], [200.0, 0.0]]);
    map.roads[0].parking = Sides { left, right: None };
    let (drive, site) = in_a_place(&map, Traffic { density, cyclists: 0.0 });
    let parked = |k: usize| {
        let scene = site.scene(&drive, k);
        let objects = scene.instances.iter().filter_map(|i| i.object.as_deref());
        let stands = |o: &&SceneObject| o.origin == Origin::Added && o.states.contains(&State::Parked);
        let found: Vec<Cuboid> = objects.filter(stands).map(|o| o.cuboid).collect();
        let ego = Outline::of(&ego_cuboid(&drive, &drive.keyframes[k]));
        assert!(!found.iter().any(|cuboid| Outline::of(cuboid).meets(&ego)));
        found
    };
    (0..drive.keyframes.len()).map(parked).collect()
}

#[test]
fn kerbs_of_a_place_are_as_full_as_its_habit_and_stay_so() {
    let both = parked_in_a_place(1.0, None);
    let one = parked_in_a_place(1.0, Some(Parking::No));
    assert!(both[0].len() > 20 && both.windows(2).all(|pair| pair[0] == pair[1]), "{}", both[0].len());
    let side = |cuboid: &Cuboid| cuboid.world_from_body.translation.y > 0.0;
    assert!(both[0].iter().any(side) && both[0].iter().any(|c| !side(c)));
    assert!(!one[0].is_empty() && !one[0].iter().any(side));
    for (i, a) in both[0].iter().enumerate() {
        // At the kerb, along it, with room between the rows, and nobody in another.
        let [along, aside] = [a.world_from_body.vector(DVec3::X), a.world_from_body.translation].map(|v| v.y.abs());
        assert!(along < 0.03 && (1.8..2.9).contains(&aside), "{a:?}");
        assert!(!both[0][..i].iter().any(|b| Outline::of(a).meets(&Outline::of(b))));
    }
    let fewer = parked_in_a_place(0.3, None);
    assert!(fewer[0].len() * 2 < both[0].len() && parked_in_a_place(0.0, None)[0].is_empty());
}

/// How many people are on the left and on the right of a street with houses, of which those on the left have shops in them.
fn people_beside(shops: bool) -> [usize; 2] {
    let mut map = testing::map_with_road([[-200.0, 0.0], [200.0, 0.0]]);
    let house = |(i, y): (i32, f64)| {
        let at = DVec2::new(f64::from(i) * 12.0 - 196.0, y);
        let footprint = rectangle(Bounds { min: at, max: at + DVec2::new(12.0, 8.0) });
        Building {
            shop: shops && y > 0.0,
            ..Building::new(1000 + i64::from(i) * 2 + (y > 0.0) as i64, footprint, None)
        }
    };
    map.buildings = (0..32).flat_map(|i| [(i, 7.5), (i, -15.5)]).map(house).collect();
    let (drive, site) = in_a_place(&map, Traffic::default());
    let mut count = [0; 2];
    for k in 0..drive.keyframes.len() {
        let (_, added) = road_users(&site.scene(&drive, k));
        for person in added.iter().filter(|cuboid| cuboid.size_m.x < 1.0 && cuboid.size_m.y < 1.0) {
            count[usize::from(person.world_from_body.translation.y < 0.0)] += 1;
        }
    }
    count
}

#[test]
fn people_are_where_shops_are() {
    let ([left, right], [before_shops, opposite]) = (people_beside(false), people_beside(true));
    let all = left + right;
    assert!(all > 50 && (3 * all..7 * all).contains(&(10 * left)), "{left} {right}");
    assert!(before_shops * 2 > opposite * 3, "{before_shops} {opposite}");
}

#[test]
fn outlines_that_are_turned_meet_where_their_corners_do() {
    let square =
        |x: f64, turn: f64| Outline { centre: DVec2::new(x, 0.0), along: DVec2::from_angle(turn), half_m: DVec2::ONE };
    let eighth = std::f64::consts::FRAC_PI_4;
    assert!(square(0.0, 0.0).meets(&square(1.9, 0.0)) && !square(0.0, 0.0).meets(&square(2.1, 0.0)));
    assert!(square(0.0, 0.0).meets(&square(2.3, eighth)) && !square(0.0, 0.0).meets(&square(2.5, eighth)));
}

#[test]
fn cyclists_are_as_common_as_asked_for() {
    let drive = testing::drive();
    let riders = |cyclists: f64| {
        let site = site_with(Traffic { density: 4.0, cyclists }, 1, &Report::default());
        let (_, added) = road_users(&site.scene(&drive, 5));
        let is_rider = |cuboid: &&Cuboid| cuboid.size_m.x > 1.7 && cuboid.size_m.x < 1.8;
        (added.iter().filter(is_rider).count(), added.len())
    };
    assert_eq!(riders(0.0).0, 0);
    let (some, many) = (riders(1.0), riders(100.0));
    assert!(many.0 > some.0 && many.0 * 2 > many.1, "{some:?} {many:?}");
}

#[test]
fn added_vehicles_that_stand_are_parked_and_the_others_move() {
    let drive = testing::drive();
    let site = site_with(Traffic { density: 6.0, ..Traffic::default() }, 1, &Report::default());
    let added = |keyframe| {
        let instances = site.scene(&drive, keyframe).instances;
        let of = |i: &Instance| Some((i.id, i.object.as_deref().filter(|o| o.origin == Origin::Added)?.clone()));
        instances.iter().filter_map(of).collect::<std::collections::BTreeMap<_, _>>()
    };
    let (now, next) = (added(5), added(6));
    let mut seen = [0, 0];
    for (id, object) in now.iter().filter(|(_, object)| object.kind.is_vehicle()) {
        let Some(later) = next.get(id) else { continue };
        let place = |object: &SceneObject| object.cuboid.world_from_body.translation;
        let moves = place(object).distance(place(later)) > 0.1;
        let expected = if moves { State::Moving } else { State::Parked };
        assert!(object.states.contains(&expected), "{object:?}");
        seen[usize::from(moves)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}
