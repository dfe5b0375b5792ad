//! The passenger cars and vans that there are, with the measures of what is common on roads.

use glam::{Vec3, vec3};
use trove_model::{Asset, Class, Kind};

use super::body::Profile;
use super::car::CarPlan;
use super::extras;
use super::palette::{COMMERCIAL, FLEET, Palette};
use super::wheel::Rim;
use crate::shape::Model;

const WHITE: Vec3 = vec3(0.76, 0.76, 0.74);

/// Every passenger car and van.
pub(crate) fn assets() -> Vec<Asset> {
    let fleet = |id: &str, class: Class, plan: &CarPlan| finish(id, Kind::Car, class, plan, &FLEET, extras::none);
    let taxis = [vec3(0.62, 0.33, 0.015), vec3(0.015, 0.06, 0.3), vec3(0.45, 0.02, 0.02), WHITE];
    let police = [WHITE, vec3(0.012, 0.014, 0.02)];
    vec![
        fleet("car/sedan-compact", Class::Car, &sedan()),
        fleet("car/sedan-executive", Class::Car, &executive()),
        fleet("car/sedan-fastback", Class::Car, &fastback()),
        fleet("car/hatchback-small", Class::Car, &small_hatchback()),
        fleet("car/hatchback", Class::Car, &hatchback()),
        fleet("car/estate", Class::Car, &estate()),
        fleet("car/pickup", Class::Car, &pickup()),
        // nuScenes, for one, counts pick-ups as trucks.
        finish("truck/pickup", Kind::Truck, Class::Truck, &pickup(), &FLEET, extras::none),
        fleet("car/suv-compact", Class::Jeep, &compact_suv()),
        fleet("car/suv-midsize", Class::Jeep, &midsize_suv()),
        fleet("car/mpv", Class::Car, &mpv()),
        fleet("car/suv-large", Class::Jeep, &large_suv()),
        fleet("car/minivan", Class::Van, &minivan()),
        finish("car/van-panel", Kind::Car, Class::Van, &panel_van(false), &COMMERCIAL, extras::load_doors),
        finish("car/van-minibus", Kind::Car, Class::Van, &panel_van(true), &COMMERCIAL, extras::none),
        finish("car/taxi", Kind::Car, Class::Car, &sedan(), &taxis, extras::taxi),
        finish("car/police", Kind::PoliceCar, Class::Car, &executive(), &police, extras::police),
        finish("van/ambulance", Kind::Ambulance, Class::Van, &panel_van(false), &[WHITE], extras::ambulance),
    ]
}

type Extras = fn(&mut Model, &Palette, &CarPlan);

fn finish(id: &str, kind: Kind, class: Class, plan: &CarPlan, paints: &[Vec3], extras: Extras) -> Asset {
    let mut model = Model::default();
    let palette = Palette::new(&mut model, paints, &[]);
    model.add_marked(plan.build(&palette));
    extras(&mut model, &palette, plan);
    model.asset(id, kind, class)
}

fn sedan() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.63,
            width_m: 1.78,
            clearance_m: 0.17,
            nose: (0.12, 0.74),
            cowl: (1.14, 0.97),
            header: (1.98, 1.39),
            peak: (2.55, 1.45),
            rear_header: (3.25, 1.40),
            deck: (4.05, 1.12),
            tail: (4.52, 1.07),
            belt_m: [0.92, 1.0],
            roof_share: 0.64,
            bow_m: [0.3, 0.2],
            round_m: [0.14, 0.12],
        },
        axles_m: [0.93, 3.63],
        wheel_radius_m: 0.32,
        rim: Rim::Spokes(10),
        pillars_m: vec![2.28, 3.2],
        last_window_m: 3.72,
        blind_from_m: f32::INFINITY,
        cladding: false,
        grille_m: [0.11, 0.4],
        tall_tail_lamps: false,
        roof_rails: false,
        seats_m: vec![2.2, 3.05],
        right_hand_drive: false,
    }
}

fn executive() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.93,
            width_m: 1.86,
            nose: (0.1, 0.77),
            cowl: (1.42, 0.98),
            header: (2.25, 1.40),
            peak: (2.85, 1.47),
            rear_header: (3.5, 1.41),
            deck: (4.35, 1.13),
            tail: (4.82, 1.09),
            ..sedan().profile
        },
        axles_m: [0.86, 3.8],
        wheel_radius_m: 0.34,
        rim: Rim::Spokes(7),
        pillars_m: vec![2.6, 3.48],
        last_window_m: 3.98,
        grille_m: [0.2, 0.36],
        seats_m: vec![2.5, 3.4],
        ..sedan()
    }
}

fn fastback() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.72,
            width_m: 1.85,
            clearance_m: 0.15,
            nose: (0.12, 0.68),
            cowl: (1.02, 0.95),
            header: (1.95, 1.38),
            peak: (2.6, 1.44),
            rear_header: (3.2, 1.40),
            deck: (4.3, 1.12),
            tail: (4.62, 1.08),
            belt_m: [0.90, 1.02],
            roof_share: 0.62,
            bow_m: [0.34, 0.24],
            ..sedan().profile
        },
        axles_m: [0.87, 3.75],
        wheel_radius_m: 0.335,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.35, 3.25],
        last_window_m: 3.78,
        grille_m: [0.03, 0.3],
        seats_m: vec![2.25, 3.1],
        ..sedan()
    }
}

fn small_hatchback() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 3.84,
            width_m: 1.69,
            nose: (0.14, 0.78),
            cowl: (0.92, 1.02),
            header: (1.68, 1.46),
            peak: (2.2, 1.52),
            rear_header: (3.4, 1.43),
            deck: (3.68, 1.03),
            tail: (3.76, 0.95),
            belt_m: [0.95, 1.04],
            roof_share: 0.66,
            bow_m: [0.3, 0.2],
            ..sedan().profile
        },
        axles_m: [0.78, 3.29],
        wheel_radius_m: 0.3,
        rim: Rim::Spokes(8),
        pillars_m: vec![2.0, 2.82],
        last_window_m: 3.2,
        tall_tail_lamps: true,
        grille_m: [0.07, 0.34],
        seats_m: vec![1.95, 2.7],
        ..sedan()
    }
}

fn hatchback() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.28,
            width_m: 1.79,
            nose: (0.12, 0.76),
            cowl: (1.1, 0.99),
            header: (1.92, 1.41),
            peak: (2.45, 1.47),
            rear_header: (3.72, 1.39),
            deck: (4.1, 1.02),
            tail: (4.19, 0.95),
            belt_m: [0.93, 1.03],
            ..sedan().profile
        },
        axles_m: [0.86, 3.49],
        wheel_radius_m: 0.317,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.22, 3.1],
        last_window_m: 3.55,
        tall_tail_lamps: true,
        grille_m: [0.05, 0.42],
        seats_m: vec![2.15, 2.95],
        ..sedan()
    }
}

fn estate() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.72,
            width_m: 1.82,
            rear_header: (4.25, 1.43),
            peak: (2.6, 1.48),
            header: (2.0, 1.41),
            deck: (4.56, 1.04),
            tail: (4.63, 0.97),
            belt_m: [0.93, 1.02],
            ..sedan().profile
        },
        axles_m: [0.92, 3.66],
        rim: Rim::Spokes(9),
        pillars_m: vec![2.3, 3.22],
        last_window_m: 4.12,
        tall_tail_lamps: true,
        roof_rails: true,
        seats_m: vec![2.2, 3.05],
        ..sedan()
    }
}

fn compact_suv() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.48,
            width_m: 1.84,
            clearance_m: 0.21,
            nose: (0.1, 0.93),
            cowl: (1.12, 1.14),
            header: (1.92, 1.6),
            peak: (2.45, 1.67),
            rear_header: (3.95, 1.58),
            deck: (4.3, 1.15),
            tail: (4.39, 1.05),
            belt_m: [1.07, 1.16],
            roof_share: 0.66,
            bow_m: [0.26, 0.18],
            round_m: [0.13, 0.12],
        },
        axles_m: [0.88, 3.55],
        wheel_radius_m: 0.35,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.24, 3.12],
        last_window_m: 3.78,
        cladding: true,
        grille_m: [0.16, 0.4],
        tall_tail_lamps: true,
        roof_rails: true,
        seats_m: vec![2.15, 2.98],
        ..sedan()
    }
}

fn midsize_suv() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.7,
            width_m: 1.9,
            nose: (0.09, 0.98),
            cowl: (1.22, 1.18),
            header: (2.02, 1.65),
            peak: (2.55, 1.72),
            rear_header: (4.1, 1.62),
            deck: (4.5, 1.2),
            tail: (4.6, 1.09),
            belt_m: [1.11, 1.2],
            ..compact_suv().profile
        },
        axles_m: [0.92, 3.74],
        wheel_radius_m: 0.365,
        rim: Rim::Spokes(10),
        pillars_m: vec![2.34, 3.26],
        last_window_m: 3.95,
        cladding: false,
        grille_m: [0.2, 0.45],
        roof_rails: false,
        seats_m: vec![2.25, 3.1],
        ..compact_suv()
    }
}

/// A tall small family car.
fn mpv() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.26,
            width_m: 1.72,
            nose: (0.11, 0.86),
            cowl: (0.82, 1.07),
            header: (1.62, 1.58),
            peak: (2.3, 1.68),
            rear_header: (3.95, 1.6),
            deck: (4.14, 1.07),
            tail: (4.2, 0.98),
            belt_m: [1.0, 1.06],
            roof_share: 0.7,
            ..minivan().profile
        },
        axles_m: [0.83, 3.56],
        wheel_radius_m: 0.305,
        rim: Rim::Spokes(8),
        pillars_m: vec![1.3, 2.12, 3.02],
        last_window_m: 3.82,
        grille_m: [0.08, 0.4],
        seats_m: vec![1.9, 2.75],
        ..minivan()
    }
}

fn large_suv() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.9,
            width_m: 1.94,
            clearance_m: 0.23,
            nose: (0.08, 1.03),
            cowl: (1.3, 1.22),
            header: (2.0, 1.74),
            peak: (2.6, 1.81),
            rear_header: (4.5, 1.75),
            deck: (4.76, 1.2),
            tail: (4.82, 1.1),
            belt_m: [1.16, 1.2],
            roof_share: 0.7,
            bow_m: [0.2, 0.14],
            round_m: [0.1, 0.1],
        },
        axles_m: [0.88, 3.75],
        wheel_radius_m: 0.385,
        rim: Rim::Spokes(6),
        pillars_m: vec![2.42, 3.36],
        last_window_m: 4.36,
        cladding: true,
        grille_m: [0.22, 0.42],
        tall_tail_lamps: true,
        roof_rails: true,
        seats_m: vec![2.35, 3.2],
        ..sedan()
    }
}

fn pickup() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.3,
            width_m: 1.87,
            clearance_m: 0.26,
            nose: (0.08, 1.02),
            cowl: (1.34, 1.18),
            header: (2.02, 1.7),
            peak: (2.5, 1.78),
            rear_header: (3.42, 1.72),
            deck: (3.66, 1.14),
            tail: (5.22, 1.12),
            belt_m: [1.12, 1.13],
            roof_share: 0.69,
            bow_m: [0.22, 0.04],
            round_m: [0.1, 0.05],
        },
        axles_m: [0.95, 4.03],
        wheel_radius_m: 0.38,
        rim: Rim::Spokes(6),
        pillars_m: vec![2.46, 3.28],
        last_window_m: 3.44,
        cladding: true,
        grille_m: [0.2, 0.42],
        tall_tail_lamps: false,
        roof_rails: false,
        seats_m: vec![2.38, 3.12],
        ..sedan()
    }
}

fn minivan() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.7,
            width_m: 1.75,
            clearance_m: 0.18,
            nose: (0.1, 0.92),
            cowl: (0.72, 1.12),
            header: (1.55, 1.76),
            peak: (2.3, 1.86),
            rear_header: (4.38, 1.8),
            deck: (4.58, 1.12),
            tail: (4.63, 1.02),
            belt_m: [1.03, 1.08],
            roof_share: 0.74,
            bow_m: [0.24, 0.12],
            round_m: [0.12, 0.09],
        },
        axles_m: [0.9, 3.75],
        wheel_radius_m: 0.32,
        rim: Rim::Spokes(10),
        pillars_m: vec![1.35, 2.2, 3.25],
        last_window_m: 4.25,
        tall_tail_lamps: true,
        grille_m: [0.16, 0.44],
        seats_m: vec![1.95, 2.85, 3.7],
        ..sedan()
    }
}

/// A delivery van; with windows all along it is a minibus.
fn panel_van(windows: bool) -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.3,
            width_m: 1.95,
            clearance_m: 0.2,
            nose: (0.1, 1.02),
            cowl: (0.72, 1.26),
            header: (1.5, 2.08),
            peak: (2.3, 2.22),
            rear_header: (5.1, 2.18),
            deck: (5.22, 1.3),
            tail: (5.25, 1.1),
            belt_m: [1.16, 1.2],
            roof_share: 0.8,
            bow_m: [0.22, 0.05],
            round_m: [0.12, 0.06],
        },
        axles_m: [0.95, 4.15],
        wheel_radius_m: 0.34,
        rim: Rim::Steel,
        pillars_m: if windows { vec![2.1, 3.1, 4.1] } else { vec![2.1] },
        last_window_m: if windows { 5.02 } else { 2.1 },
        blind_from_m: if windows { f32::INFINITY } else { 2.1 },
        cladding: true,
        grille_m: [0.14, 0.42],
        tall_tail_lamps: true,
        seats_m: if windows { vec![1.95, 2.9, 3.9] } else { vec![1.9] },
        ..sedan()
    }
}
