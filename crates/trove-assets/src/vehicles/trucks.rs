//! The lorries and trailers that there are.

use glam::{Vec3, vec3};
use trove_model::{Asset, Kind};

use super::palette::{COMMERCIAL, Palette};
use super::truck::{Load, TruckPlan, semi_trailer};
use crate::shape::{Model, Shape};

const WHITE: Vec3 = vec3(0.72, 0.72, 0.7);
const BOXES: [Vec3; 5] = [WHITE, WHITE, WHITE, vec3(0.5, 0.52, 0.54), vec3(0.03, 0.1, 0.3)];
const CANVAS: [Vec3; 4] = [vec3(0.5, 0.5, 0.48), vec3(0.06, 0.07, 0.08), vec3(0.04, 0.1, 0.22), vec3(0.05, 0.13, 0.08)];
const TIPPERS: [Vec3; 3] = [vec3(0.5, 0.2, 0.02), vec3(0.06, 0.12, 0.25), vec3(0.35, 0.36, 0.36)];

/// Every lorry and trailer.
pub(crate) fn assets() -> Vec<Asset> {
    let heavy = TruckPlan {
        length_m: 8.4,
        width_m: 2.45,
        cab_length_m: 1.75,
        cab_height_m: 2.75,
        load_height_m: 3.45,
        deck_m: 1.02,
        wheel_radius_m: 0.48,
        front_axle_m: 1.15,
        rear_axles_m: &[6.1],
        load: Load::Box,
    };
    let light = TruckPlan {
        length_m: 5.9,
        width_m: 2.0,
        cab_length_m: 1.5,
        cab_height_m: 2.15,
        load_height_m: 2.85,
        deck_m: 0.82,
        wheel_radius_m: 0.37,
        front_axle_m: 0.95,
        rear_axles_m: &[4.35],
        load: Load::Box,
    };
    let truck = |id: &str, plan: TruckPlan, second: &[Vec3]| finish(id, Kind::Truck, second, |p| plan.build(p));
    vec![
        truck("truck/box", heavy, &BOXES),
        truck(
            "truck/box-long",
            TruckPlan { length_m: 10.6, load_height_m: 3.7, rear_axles_m: &[7.2, 8.5], ..heavy },
            &BOXES,
        ),
        truck(
            "truck/canvas",
            TruckPlan { load: Load::Canvas, length_m: 9.3, rear_axles_m: &[6.6], load_height_m: 3.55, ..heavy },
            &CANVAS,
        ),
        truck(
            "truck/tipper",
            TruckPlan {
                load: Load::Tipper,
                length_m: 8.0,
                load_height_m: 2.6,
                deck_m: 1.1,
                rear_axles_m: &[5.3, 6.65],
                ..heavy
            },
            &TIPPERS,
        ),
        truck("truck/delivery", light, &BOXES),
        truck(
            "truck/flatbed-light",
            TruckPlan { load: Load::Flatbed, length_m: 5.4, load_height_m: 2.0, rear_axles_m: &[3.95], ..light },
            &BOXES,
        ),
        truck(
            "truck/tractor",
            TruckPlan {
                load: Load::Tractor,
                length_m: 6.0,
                cab_length_m: 2.25,
                cab_height_m: 3.5,
                load_height_m: 3.3,
                front_axle_m: 1.4,
                rear_axles_m: &[5.0],
                wheel_radius_m: 0.5,
                ..heavy
            },
            &BOXES,
        ),
        finish("trailer/box", Kind::Trailer, &BOXES, |p| semi_trailer(p, false)),
        finish("trailer/curtain", Kind::Trailer, &CANVAS, |p| semi_trailer(p, true)),
    ]
}

fn finish(id: &str, kind: Kind, second: &[Vec3], build: impl Fn(&Palette) -> Shape) -> Asset {
    let mut model = Model::default();
    let palette = Palette::new(&mut model, &COMMERCIAL, second);
    model.add_marked(build(&palette));
    model.asset(id, kind, kind.class())
}
