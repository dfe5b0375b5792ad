//! What holds for every car.

use std::sync::LazyLock;

use trove_model::{Asset, Kind};

use crate::plans::Plans;
use crate::vehicles;

static CARS: LazyLock<Vec<Asset>> = LazyLock::new(|| vehicles::cars(&Plans::built_in().cars));

/// Lengths, widths and heights of nuScenes' cars, from the smallest to the largest and the oddest.
const BOXES_M: [[f64; 3]; 14] = [
    [3.484, 1.604, 1.58],
    [3.554, 1.732, 1.683],
    [3.871, 1.63, 1.955],
    [3.924, 1.927, 2.196],
    [4.115, 1.847, 1.526],
    [4.363, 1.875, 1.441],
    [4.394, 2.062, 2.435],
    [4.474, 1.788, 2.17],
    [4.701, 1.762, 1.539],
    [4.734, 2.001, 1.481],
    [4.956, 2.135, 2.17],
    [5.212, 2.012, 2.042],
    [5.419, 2.316, 2.0],
    [5.582, 2.018, 2.132],
];

#[test]
fn a_car_fits_every_annotated_box_without_looking_stretched() {
    for box_m in BOXES_M.map(glam::DVec3::from_array) {
        let stretch = |asset: &Asset| {
            let scale = box_m / asset.size_m;
            let along = scale.x;
            (scale / along).max(glam::DVec3::splat(along) / scale).max_element()
        };
        let least = CARS.iter().filter(|a| a.kind == Kind::Car).map(stretch).fold(f64::INFINITY, f64::min);
        assert!(least < 1.12, "{box_m} is {least} off the best");
    }
}

#[test]
fn only_mirrors_stand_out_of_a_car() {
    for car in &*CARS {
        let half = (car.size_m / 2.0).as_vec3() + 1e-3;
        for extra in &car.extras {
            let (low, high) = extra.mesh.bounds().unwrap();
            let is_inside = high.y < half.y && -low.y < half.y;
            assert_eq!(is_inside, extra.group != "mirrors", "{} of {}", extra.group, car.id);
            assert!(high.z < car.size_m.z as f32 && low.z > 0.0, "{} of {}", extra.group, car.id);
        }
    }
}

#[test]
fn the_driver_sits_where_the_steering_wheel_is() {
    let side = |id: &str| {
        let car = CARS.iter().find(|a| a.id == id).unwrap();
        let driver = car.extras.iter().find(|e| e.group == "driver").unwrap();
        let (low, high) = driver.mesh.bounds().unwrap();
        (low.y + high.y).signum()
    };
    assert_eq!((side("car/sedan-compact"), side("car/taxi-asia")), (1.0, -1.0));
}
