//! The passenger cars and vans that there are, with the measures of what is common on roads.
//!
//! Boxes of data sets are as wide as bodies, without mirrors; so are these models' measures, and the mirrors are an
//! extra that every one of them has.

use glam::{Vec2, Vec3, vec3};
use rayon::prelude::*;
use trove_model::{Asset, Class, Kind, Material};

use super::cabin;
use super::car::CarPlan;
use super::extras;
use super::fittings;
use super::models::*;
use super::palette::{COMMERCIAL, FLEET, Palette};
use super::plate;
use super::tall_models::*;
use crate::shape::{Model, Shape};

const WHITE: Vec3 = vec3(0.76, 0.76, 0.74);
const NEARLY_BLACK: Vec3 = vec3(0.012, 0.014, 0.02);

/// What is put on an ordinary car, in (model, its palette, its plan).
type Extras = fn(&mut Model, &Palette, &CarPlan);

/// A car of the table.
struct Make(&'static str, Kind, Class, fn() -> CarPlan, &'static [Vec3], Extras, f32);

/// Every passenger car and van.
pub(crate) fn assets() -> Vec<Asset> {
    use Class::{Car, Jeep, Van};
    const YELLOW: &[Vec3] = &[vec3(0.62, 0.33, 0.015)];
    const IVORY: &[Vec3] = &[vec3(0.66, 0.58, 0.4)];
    const BLUE: &[Vec3] = &[vec3(0.015, 0.07, 0.4), vec3(0.015, 0.07, 0.4), vec3(0.62, 0.4, 0.015), WHITE];
    const ONLY_WHITE: &[Vec3] = &[WHITE];
    const ONLY_BLACK: &[Vec3] = &[NEARLY_BLACK];
    const SILVER: &[Vec3] = &[vec3(0.42, 0.43, 0.44)];
    let plain = |id, class, plan, commonness| Make(id, Kind::Car, class, plan, &FLEET, extras::none, commonness);
    let goods = |id, plan, extras: Extras, commonness| Make(id, Kind::Car, Van, plan, &COMMERCIAL, extras, commonness);
    let makes = [
        plain("car/sedan-compact", Car, sedan_compact, 1.5),
        plain("car/sedan-family", Car, sedan_family, 1.5),
        plain("car/sedan-executive", Car, sedan_executive, 1.0),
        plain("car/sedan-old", Car, sedan_old, 0.6),
        plain("car/sedan-fastback", Car, sedan_fastback, 1.0),
        plain("car/hatchback", Car, hatchback, 1.5),
        plain("car/hatchback-small", Car, hatchback_small, 1.3),
        plain("car/hatchback-city", Car, hatchback_city, 0.8),
        plain("car/hatchback-retro", Car, hatchback_retro, 0.5),
        plain("car/hatchback-kei", Car, kei, 0.4),
        plain("car/estate", Car, estate, 1.0),
        Make("car/estate-roof-box", Kind::Car, Car, estate, &FLEET, extras::roof_box, 0.2),
        plain("car/coupe", Car, coupe, 0.5),
        plain("car/sports", Car, sports, 0.15),
        plain("car/suv-compact", Jeep, suv_compact, 1.5),
        plain("car/suv-midsize", Jeep, suv_midsize, 1.3),
        plain("car/suv-coupe", Jeep, suv_coupe, 0.6),
        plain("car/suv-large", Jeep, suv_large, 1.0),
        plain("car/suv-full", Jeep, suv_full, 0.6),
        Make("car/suv-roof-box", Kind::Car, Jeep, suv_midsize, &FLEET, extras::roof_box, 0.2),
        plain("car/offroader-short", Jeep, offroader_short, 0.3),
        plain("car/offroader-long", Jeep, offroader_long, 0.4),
        plain("car/mpv", Car, mpv, 1.0),
        plain("car/minivan", Van, minivan, 1.0),
        plain("car/minivan-large", Van, minivan_large, 0.7),
        plain("car/pickup", Car, pickup, 0.5),
        plain("car/pickup-large", Car, pickup_large, 0.4),
        // nuScenes, for one, counts pick-ups as trucks.
        Make("truck/pickup", Kind::Truck, Class::Truck, pickup, &FLEET, extras::none, 1.0),
        Make("truck/pickup-large", Kind::Truck, Class::Truck, pickup_large, &FLEET, extras::none, 1.0),
        goods("car/van-small", van_small, extras::load_doors, 0.8),
        goods("car/van-panel", van_panel, extras::load_doors, 0.8),
        goods("car/van-minibus", van_minibus, extras::none, 0.6),
        goods("car/van-high-roof", van_high_roof, extras::load_doors, 0.5),
        goods("car/van-minibus-high", minibus_high, extras::none, 0.3),
        goods("car/van-step", step_van, extras::load_doors, 0.3),
        Make("car/taxi-america", Kind::Car, Car, sedan_family, YELLOW, extras::taxi, 0.2),
        Make("car/taxi-europe", Kind::Car, Car, estate, IVORY, extras::taxi, 0.2),
        Make("car/taxi-asia", Kind::Car, Car, sedan_asia, BLUE, extras::taxi, 0.2),
        Make("car/taxi-mpv", Kind::Car, Car, mpv, ONLY_WHITE, extras::taxi, 0.2),
        Make("car/police-america", Kind::PoliceCar, Car, sedan_executive, ONLY_BLACK, extras::police_two_tone, 1.0),
        Make("car/police-suv", Kind::PoliceCar, Jeep, suv_large, ONLY_WHITE, extras::police_band, 1.0),
        Make("car/police-europe", Kind::PoliceCar, Car, estate, SILVER, extras::police_band, 1.0),
        Make("car/police-britain", Kind::PoliceCar, Car, hatchback, ONLY_WHITE, extras::police_checks, 1.0),
        Make("van/ambulance", Kind::Ambulance, Van, van_high_roof, ONLY_WHITE, extras::ambulance, 1.0),
        Make("van/ambulance-small", Kind::Ambulance, Van, van_panel, ONLY_WHITE, extras::ambulance, 1.0),
    ];
    makes.par_iter().enumerate().map(|(turn, make)| finish(make, turn)).collect()
}

fn finish(make: &Make, turn: usize) -> Asset {
    let Make(id, kind, class, plan, paints, extras, commonness) = *make;
    let plan = plan();
    let mut model = Model::default();
    let palette = Palette::new(&mut model, paints, &[]);
    let car = plan.build(&palette);
    plates(&mut model, &palette, &plan, &car, plate::plate_of(id, turn));
    model.add_marked(car);
    extras(&mut model, &palette, &plan);
    model.add_extra("mirrors", 1.0, false, fittings::mirrors(&plan, &palette));
    model.add_extra("driver", 1.0, true, cabin::occupant(&plan, true, &palette));
    model.add_extra("passenger", 0.35, true, cabin::occupant(&plan, false, &palette));
    Asset { commonness, ..model.asset(id, kind, class) }
}

/// Number plates in front and behind.
fn plates(
    model: &mut Model,
    palette: &Palette,
    plan: &CarPlan,
    car: &Shape,
    (plate, material): (plate::Plate, Material),
) {
    let p = &plan.profile;
    let middle = |direction: Vec3, z: f32| {
        // Clear of bumpers that lean.
        let reach = |dz: f32| car.outermost(direction, vec3(0.0, 0.01, z + dz)).unwrap_or(0.0);
        reach(0.05).max(reach(-0.05))
    };
    let (front_z, back_z) = (p.clearance_m + plan.face.plate_m, p.tail_m + plan.back.plate_m);
    let front = vec3(middle(Vec3::X, front_z), 0.0, front_z);
    let back = vec3(-middle(-Vec3::X, back_z), 0.0, back_z);
    let slot = model.slot(material, &[]);
    let size = Vec2::from_array(plate.size_m);
    let frame = Shape::rounded_block(vec3(0.016, size.x + 0.02, size.y + 0.02), 0.006).slot(palette.trim);
    let one = frame.and(plate::face(size, Vec3::X * 0.0095).slot(slot));
    let turned = one.clone().turned(glam::Quat::from_rotation_z(std::f32::consts::PI));
    model.add_marked(one.moved(front + Vec3::X * 0.004).and(turned.moved(back - Vec3::X * 0.004)));
}

#[cfg(test)]
mod tests {
    use std::sync::LazyLock;

    use super::*;

    static CARS: LazyLock<Vec<Asset>> = LazyLock::new(assets);

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
}
