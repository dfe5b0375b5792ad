//! Real models import without hand work: up, front and size class against a list that was made by looking at them.

#![allow(clippy::unwrap_used)] // all of this is tests

use std::path::PathBuf;

use trove_model::Report;
use trove_read::asset_files;

/// A model as a person sees it in pictures of its file from three sides.
struct Judged {
    file: &'static str,
    /// Kinds that it can stand for, parted by `|`.
    kind: &'static str,
    /// The file's axis that points up.
    up: &'static str,
    /// The file's axes that can be called forward, parted by `|`; `*` for what looks the same from all sides, and for
    /// buildings, whose front nobody asks for.
    front: &'static str,
    /// What is measured: length or height.
    measure: char,
    /// What it may be, metres.
    range: [f64; 2],
}

const fn m(
    file: &'static str,
    kind: &'static str,
    up: &'static str,
    front: &'static str,
    measure: char,
    range: [f64; 2],
) -> Judged {
    Judged { file, kind, up, front, measure, range }
}

const CAR: [f64; 2] = [3.6, 5.3];
const SEATED: [f64; 2] = [1.2, 1.6];
const STANDING: [f64; 2] = [1.55, 2.0];
const WAVING: [f64; 2] = [1.8, 2.4];
const BENDING: [f64; 2] = [0.9, 1.3];
const HOUSE: [f64; 2] = [4.0, 14.0];
const BLOCK: [f64; 2] = [8.0, 30.0];
const BUSH: [f64; 2] = [0.5, 2.5];
const TREE: [f64; 2] = [3.0, 20.0];
const ROCK: [f64; 2] = [0.3, 3.0];
const BLADES: [f64; 2] = [0.1, 0.6];
const SIGN: [f64; 2] = [1.6, 3.5];
const TILE: [f64; 2] = [5.0, 30.0];
const LAMP: [f64; 2] = [3.0, 10.0];

#[rustfmt::skip]
const MODELS: [Judged; 116] = [
    m("gazebo/ambulance.glb", "ambulance", "+y", "+z", 'l', [5.0, 8.0]),
    m("gazebo/bus.glb", "bus", "+y", "+z", 'l', [9.0, 14.0]),
    m("gazebo/bus_stop__base_link.glb", "shelter", "+y", "*", 'h', [2.2, 3.6]),
    m("gazebo/bus_stop__head.glb", "shelter", "-z", "*", 'h', [0.4, 0.9]),
    m("gazebo/construction_barrel.glb", "traffic_cone|barrier", "+y", "*", 'h', [0.9, 1.7]),
    m("gazebo/construction_cone.glb", "traffic_cone", "+y", "*", 'h', [0.4, 1.15]),
    m("gazebo/dumpster.glb", "bin|pushable_pullable", "+y", "+z", 'h', [0.9, 1.8]),
    m("gazebo/fire_hydrant.glb", "hydrant", "+y", "*", 'h', [0.6, 1.2]),
    m("gazebo/fire_truck.glb", "truck", "+y", "-z", 'l', [7.0, 14.0]),
    m("gazebo/gas_station.glb", "building", "+y", "*", 'h', [5.0, 12.0]),
    m("gazebo/hatchback.glb", "car", "+y", "+z", 'l', CAR),
    m("gazebo/hatchback_blue__hatchback.glb", "car", "+y", "+z", 'l', CAR),
    m("gazebo/hatchback_red__hatchback.glb", "car", "+y", "+z", 'l', CAR),
    m("gazebo/house_1.glb", "building", "+y", "*", 'h', HOUSE),
    m("gazebo/house_2.glb", "building", "+y", "*", 'h', HOUSE),
    m("gazebo/house_3.glb", "building", "+y", "*", 'h', HOUSE),
    m("gazebo/jersey_barrier.glb", "barrier", "+y", "+z|-z", 'h', [0.8, 1.3]),
    m("gazebo/lamp_post.glb", "street_lamp", "+y", "+z", 'h', LAMP),
    m("gazebo/mailbox.glb", "street_furniture", "+y", "+z|-z", 'h', [0.9, 1.6]),
    m("gazebo/oak_tree.glb", "tree", "+y", "*", 'h', TREE),
    m("gazebo/office_building.glb", "building", "+y", "*", 'h', BLOCK),
    m("gazebo/pickup.glb", "car", "+y", "-z", 'l', [4.8, 6.2]),
    m("gazebo/pine_tree.glb", "tree", "+y", "*", 'h', TREE),
    m("gazebo/post_office.glb", "building", "+y", "*", 'h', [3.0, 10.0]),
    m("gazebo/postbox.glb", "street_furniture", "+y", "+z", 'h', [1.1, 1.7]),
    m("gazebo/prius_hybrid__Hybrid.glb", "car", "+y", "+z", 'l', CAR),
    m("gazebo/speed_limit_sign.glb", "traffic_sign", "+y", "-z", 'h', SIGN),
    m("gazebo/stop_light.glb", "traffic_signal", "+y", "+z", 'h', [0.6, 1.3]),
    m("gazebo/stop_light_post.glb", "traffic_signal|utility_pole|street_lamp", "+y", "*", 'h', [4.5, 8.0]),
    m("gazebo/stop_sign.glb", "traffic_sign", "+y", "+z", 'h', SIGN),
    m("gazebo/suv.glb", "car", "+y", "-z", 'l', [4.3, 5.5]),
    m("gazebo/telephone_pole.glb", "utility_pole", "+y", "*", 'h', [7.0, 13.0]),
    m("quaternius-buildings/Building1_Large.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/Building1_Small.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/Building2_Large.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/Building2_Small.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/Building3_Big.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/Building3_Small.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/Building4.glb", "building", "+y", "*", 'h', BLOCK),
    m("quaternius-buildings/House1.glb", "building", "+y", "*", 'h', HOUSE),
    m("quaternius-buildings/House2.glb", "building", "+y", "*", 'h', HOUSE),
    m("quaternius-nature/Bush1.glb", "bush", "+y", "*", 'h', BUSH),
    m("quaternius-nature/Bush2.glb", "bush", "+y", "*", 'h', BUSH),
    m("quaternius-nature/Bush3.glb", "bush", "+y", "*", 'h', BUSH),
    m("quaternius-nature/Grass1.glb", "none", "+y", "*", 'h', BLADES),
    m("quaternius-nature/Grass2.glb", "none", "+y", "*", 'h', BLADES),
    m("quaternius-nature/Grass3.glb", "none", "+y", "*", 'h', BLADES),
    m("quaternius-nature/Rock1.glb", "none", "+y", "*", 'h', ROCK),
    m("quaternius-nature/Rock2.glb", "none", "+y", "*", 'h', ROCK),
    m("quaternius-nature/Rock3.glb", "none", "+y", "*", 'h', ROCK),
    m("quaternius-nature/Tree1.glb", "tree", "+y", "*", 'h', TREE),
    m("quaternius-nature/Tree2.glb", "tree", "+y", "*", 'h', TREE),
    m("quaternius-nature/Tree3.glb", "tree", "+y", "*", 'h', TREE),
    m("quaternius-nature/Tree4.glb", "tree", "+y", "*", 'h', TREE),
    m("quaternius-street/Sign_NoParking.glb", "traffic_sign", "+y", "+x", 'h', SIGN),
    m("quaternius-street/Sign_Stop.glb", "traffic_sign", "+y", "+x", 'h', SIGN),
    m("quaternius-street/Sign_Triangle.glb", "traffic_sign", "+y", "+x", 'h', SIGN),
    m("quaternius-street/Street_3Way.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_3Way_2.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_4Way.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_4Way_2.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_Curve.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_Deadend.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_Empty.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Street_Straight.glb", "none", "+y", "*", 'l', TILE),
    m("quaternius-street/Streetlight_Double.glb", "street_lamp", "+y", "+z|-z", 'h', LAMP),
    m("quaternius-street/Streetlight_Single.glb", "street_lamp", "+y", "*", 'h', LAMP),
    m("quaternius-street/Streetlight_Triple.glb", "street_lamp", "+y", "+z|-z", 'h', LAMP),
    m("quaternius-street/TrafficLight.glb", "traffic_signal", "+y", "+x", 'h', [2.5, 5.0]),
    m("quaternius-street/TrafficLight_2.glb", "traffic_signal", "+y", "+x", 'h', [3.0, 8.0]),
    m("quaternius/basic_BasicCar.glb", "car", "+y", "+z", 'l', CAR),
    m("quaternius/basic_CopCar.glb", "police_car", "+y", "+z", 'l', CAR),
    m("quaternius/basic_RaceCar.glb", "car", "+y", "+z", 'l', CAR),
    m("quaternius/basic_SimpleCarHigh.glb", "car", "+y", "+z", 'l', CAR),
    m("quaternius/basic_SimpleCarShort.glb", "car", "+y", "+z", 'l', CAR),
    m("quaternius/basic_Taxi.glb", "car", "+y", "+z", 'l', CAR),
    m("quaternius/person_Female_LookingUp.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Female_PickingUp.glb", "adult", "+y", "+z", 'h', BENDING),
    m("quaternius/person_Female_Running.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Female_Sitting.glb", "adult", "+y", "+z", 'h', SEATED),
    m("quaternius/person_Female_Sitting_Cheering.glb", "adult", "+y", "+z", 'h', [1.3, 1.9]),
    m("quaternius/person_Female_Standing.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Female_Standing_CoveringEyes.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Female_Standing_Hips.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Female_Walking.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Male_LookingUp.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Male_PickingUp.glb", "adult", "+y", "+z", 'h', BENDING),
    m("quaternius/person_Male_Running.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Male_Sitting.glb", "adult", "+y", "+z", 'h', SEATED),
    m("quaternius/person_Male_Sitting_Cheering.glb", "adult", "+y", "+z", 'h', [1.3, 1.9]),
    m("quaternius/person_Male_Standing.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Male_Standing_CoveringEyes.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Male_Standing_Hips.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Male_Standing_Waving.glb", "adult", "+y", "+z", 'h', WAVING),
    m("quaternius/person_Male_Walking.glb", "adult", "+y", "+z", 'h', STANDING),
    m("quaternius/person_Woman_Standing_Waving.glb", "adult", "+y", "+z", 'h', WAVING),
    m("quaternius/realistic_Cop.glb", "police_car", "+y", "-z", 'l', CAR),
    m("quaternius/realistic_Cop_SUV.glb", "police_car", "+y", "-z", 'l', CAR),
    m("quaternius/realistic_NormalCar1.glb", "car", "+y", "-z", 'l', CAR),
    m("quaternius/realistic_NormalCar2.glb", "car", "+y", "-z", 'l', [3.2, 5.0]),
    m("quaternius/realistic_SUV.glb", "car", "+y", "-z", 'l', CAR),
    m("quaternius/realistic_SportsCar.glb", "car", "+y", "-z", 'l', CAR),
    m("quaternius/realistic_SportsCar2.glb", "car", "+y", "-z", 'l', CAR),
    m("quaternius/realistic_Taxi.glb", "car", "+y", "-z", 'l', CAR),
    m("quaternius/transport_Ambulance.glb", "ambulance", "+y", "+z", 'l', [5.0, 8.0]),
    m("quaternius/transport_Bicycle.glb", "bicycle", "+y", "-z", 'l', [1.5, 2.0]),
    m("quaternius/transport_Bus.glb", "bus", "+y", "-x", 'l', [7.0, 14.0]),
    m("quaternius/transport_SchoolBus.glb", "bus", "+y", "-x", 'l', [6.0, 13.0]),
    m("quaternius/transport_SquareFrameBicycle.glb", "bicycle", "+y", "-z", 'l', [1.5, 2.0]),
    m("quaternius/transport_Taxi.glb", "car", "+y", "+z", 'l', CAR),
    m("quaternius/transport_TrafficCone.glb", "traffic_cone", "+y", "*", 'h', [0.4, 1.1]),
    m("quaternius/transport_TrafficLight.glb", "traffic_signal", "+y", "-x", 'h', [2.5, 5.0]),
    m("quaternius/transport_TrafficSign1.glb", "traffic_sign", "+y", "-x", 'h', SIGN),
    m("quaternius/transport_TrafficSign2.glb", "traffic_sign", "+y", "+z", 'h', SIGN),
    m("quaternius/transport_TrafficSign3.glb", "traffic_sign", "+y", "+z", 'h', SIGN),
    m("quaternius/transport_Train.glb", "none", "+y", "+z|-z", 'l', [12.0, 30.0]),
];

/// A folder of copies of the real models, which stay untouched.
fn copied() -> (tempfile::TempDir, PathBuf) {
    let data = std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA");
    let temporary = tempfile::tempdir().unwrap();
    let library = temporary.path().join("real");
    std::fs::create_dir(&library).unwrap();
    for folder in std::fs::read_dir(PathBuf::from(data).join("models")).unwrap().flatten() {
        let target = library.join(folder.file_name());
        std::fs::create_dir(&target).unwrap();
        for file in std::fs::read_dir(folder.path()).unwrap().flatten() {
            std::fs::copy(file.path(), target.join(file.file_name())).unwrap();
        }
    }
    (temporary, library)
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_models_stand_look_and_measure_as_people_see_them() {
    let (_temporary, library) = copied();
    let report = Report::default();
    let file = asset_files::import(&library, &report).unwrap();
    let mut right = 0;
    for judged in &MODELS {
        let entry = file.assets.iter().find(|e| e.file == judged.file);
        let Some(entry) = entry else {
            println!("{}: not imported", judged.file);
            continue;
        };
        let kind = entry.kind.as_deref().unwrap_or_default();
        let size = entry.size_m.unwrap();
        let measured = if judged.measure == 'l' { size.x } else { size.z };
        let (up, front) = (entry.up.unwrap().name(), entry.front.unwrap().name());
        let wrong = [
            (!judged.kind.split('|').any(|k| k == kind), "kind"),
            (up != judged.up, "up"),
            (judged.front != "*" && !judged.front.split('|').any(|f| f == front), "front"),
            (!(judged.range[0]..=judged.range[1]).contains(&measured), "size"),
        ];
        if wrong.iter().any(|w| w.0) {
            let what: Vec<&str> = wrong.iter().filter(|w| w.0).map(|w| w.1).collect();
            println!("{}: {what:?} wrong: {kind}, up {up}, front {front}, {size:.2}", judged.file);
            entry
                .guesses
                .iter()
                .for_each(|g| println!("    {} = {} ({:.2}: {})", g.key, g.value, g.confidence, g.reason));
        } else {
            right += 1;
        }
    }
    println!("{right} of {} are right", MODELS.len());
    assert!(right as f64 >= 0.95 * MODELS.len() as f64, "{right} of {}", MODELS.len());
}
