//! The measures of off-roaders, people carriers, pick-ups and vans, in metres, each told by how it differs from another.

use super::body::Profile;
use super::car::CarPlan;
use super::faces;
use super::models::hatchback;
use super::wheel::Rim;

/// A compact off-road look.
pub(super) fn suv_compact() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.45,
            width_m: 1.84,
            clearance_m: 0.2,
            nose_m: 0.92,
            cowl: (1.1, 1.13),
            header: (1.92, 1.58),
            peak: (2.5, 1.645),
            rear_header: (3.88, 1.58),
            deck: (4.24, 1.15),
            tail_m: 1.06,
            belt_m: [1.06, 1.16],
            roof_share: 0.66,
            square: [3.5, 4.4],
            rake_m: [0.11, 0.08],
            shoulder_m: 0.06,
            flare_m: 0.03,
            hollow_m: 0.035,
            ..hatchback().profile
        },
        axles_m: [0.9, 3.55],
        wheel_radius_m: 0.35,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.24, 3.15],
        glass_end_m: [3.78, 3.54],
        dark_from_m: 2.9,
        cladding: true,
        face: faces::TALL,
        back: faces::WIDE,
        roof_rails: true,
        seats_m: vec![2.2, 3.0],
        ..hatchback()
    }
}

/// A larger one.
pub(super) fn suv_midsize() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.7,
            width_m: 1.89,
            clearance_m: 0.21,
            nose_m: 0.97,
            cowl: (1.22, 1.165),
            header: (2.02, 1.63),
            peak: (2.6, 1.7),
            rear_header: (4.1, 1.63),
            deck: (4.48, 1.19),
            tail_m: 1.1,
            belt_m: [1.1, 1.19],
            ..suv_compact().profile
        },
        axles_m: [0.93, 3.76],
        wheel_radius_m: 0.37,
        rim: Rim::Pairs(5),
        pillars_m: vec![2.36, 3.3],
        glass_end_m: [4.0, 3.74],
        is_chromed: true,
        face: faces::EXECUTIVE,
        back: faces::HATCH,
        seats_m: vec![2.32, 3.16],
        ..suv_compact()
    }
}

/// With the back of a fastback.
pub(super) fn suv_coupe() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.78,
            width_m: 1.92,
            header: (2.0, 1.6),
            peak: (2.5, 1.66),
            rear_header: (3.7, 1.6),
            deck: (4.5, 1.2),
            tail_m: 1.16,
            flare_m: 0.04,
            ..suv_midsize().profile
        },
        rim: Rim::Spokes(10),
        glass_end_m: [3.98, 3.46],
        is_chromed: false,
        face: faces::SPORT,
        back: faces::BAR,
        roof_rails: false,
        ..suv_midsize()
    }
}

/// For seven.
pub(super) fn suv_large() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.95,
            width_m: 1.95,
            clearance_m: 0.22,
            nose_m: 1.02,
            cowl: (1.3, 1.2),
            header: (2.04, 1.71),
            peak: (2.7, 1.785),
            rear_header: (4.46, 1.73),
            deck: (4.76, 1.21),
            tail_m: 1.12,
            belt_m: [1.14, 1.2],
            roof_share: 0.69,
            square: [3.8, 5.0],
            rake_m: [0.09, 0.06],
            ..suv_midsize().profile
        },
        axles_m: [0.9, 3.85],
        wheel_radius_m: 0.385,
        rim: Rim::Spokes(6),
        pillars_m: vec![2.44, 3.42],
        glass_end_m: [4.36, 4.16],
        cladding: false,
        face: faces::SPLIT,
        back: faces::COLUMN,
        seats_m: vec![2.4, 3.3, 4.05],
        ..suv_midsize()
    }
}

/// The largest.
pub(super) fn suv_full() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.3,
            width_m: 2.04,
            clearance_m: 0.24,
            nose_m: 1.1,
            cowl: (1.38, 1.28),
            header: (2.06, 1.85),
            peak: (2.8, 1.93),
            rear_header: (4.95, 1.88),
            deck: (5.17, 1.27),
            tail_m: 1.18,
            belt_m: [1.22, 1.26],
            roof_share: 0.74,
            round_m: [0.7, 0.45],
            square: [4.2, 5.6],
            rake_m: [0.06, 0.05],
            screen_bow_m: [0.38, 0.22],
            ..suv_large().profile
        },
        axles_m: [0.98, 4.05],
        wheel_radius_m: 0.41,
        rim: Rim::Spokes(6),
        pillars_m: vec![2.56, 3.56],
        glass_end_m: [4.88, 4.74],
        face: faces::TRUCK,
        back: faces::POST,
        seats_m: vec![2.5, 3.45, 4.35],
        ..suv_large()
    }
}

/// An upright off-roader.
pub(super) fn offroader_short() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.25,
            width_m: 1.84,
            clearance_m: 0.26,
            nose_m: 1.06,
            cowl: (1.42, 1.18),
            header: (1.72, 1.76),
            peak: (2.3, 1.84),
            rear_header: (3.98, 1.81),
            deck: (4.08, 1.2),
            tail_m: 1.16,
            belt_m: [1.13, 1.15],
            roof_share: 0.82,
            round_m: [0.35, 0.22],
            square: [5.0, 7.0],
            rake_m: [0.03, 0.02],
            shoulder_m: 0.03,
            flare_m: 0.06,
            hollow_m: 0.008,
            screen_bow_m: [0.2, 0.12],
            ..suv_full().profile
        },
        axles_m: [0.72, 3.15],
        wheel_radius_m: 0.375,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.7],
        glass_end_m: [3.88, 3.86],
        cladding: true,
        is_chromed: false,
        face: faces::OFFROAD,
        back: faces::SPARE,
        roof_rails: false,
        seats_m: vec![2.4, 3.1],
        ..suv_full()
    }
}

/// The same with four doors.
pub(super) fn offroader_long() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.8,
            width_m: 1.9,
            nose_m: 1.1,
            cowl: (1.45, 1.22),
            header: (1.78, 1.86),
            peak: (2.5, 1.93),
            rear_header: (4.53, 1.9),
            deck: (4.63, 1.25),
            tail_m: 1.2,
            belt_m: [1.17, 1.19],
            ..offroader_short().profile
        },
        axles_m: [0.76, 3.62],
        wheel_radius_m: 0.39,
        pillars_m: vec![2.62, 3.5],
        glass_end_m: [4.42, 4.4],
        seats_m: vec![2.5, 3.35],
        ..offroader_short()
    }
}

/// A tall family car.
pub(super) fn mpv() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.32,
            width_m: 1.77,
            nose_m: 0.86,
            cowl: (0.84, 1.07),
            header: (1.66, 1.57),
            peak: (2.35, 1.66),
            rear_header: (3.94, 1.59),
            deck: (4.18, 1.08),
            tail_m: 0.99,
            belt_m: [1.0, 1.06],
            roof_share: 0.71,
            rake_m: [0.2, 0.06],
            shoulder_m: 0.045,
            screen_bow_m: [0.4, 0.24],
            ..hatchback().profile
        },
        axles_m: [0.85, 3.6],
        wheel_radius_m: 0.31,
        rim: Rim::Spokes(8),
        pillars_m: vec![1.5, 2.22, 3.1],
        glass_end_m: [3.88, 3.76],
        dark_from_m: 2.9,
        face: faces::SMALL,
        back: faces::COLUMN,
        seats_m: vec![2.02, 2.86],
        ..hatchback()
    }
}

/// A van for families.
pub(super) fn minivan() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.72,
            width_m: 1.78,
            nose_m: 0.92,
            cowl: (0.76, 1.12),
            header: (1.56, 1.74),
            peak: (2.35, 1.84),
            rear_header: (4.44, 1.79),
            deck: (4.6, 1.12),
            tail_m: 1.03,
            belt_m: [1.03, 1.08],
            roof_share: 0.76,
            round_m: [0.75, 0.4],
            rake_m: [0.17, 0.05],
            screen_bow_m: [0.36, 0.18],
            ..mpv().profile
        },
        axles_m: [0.92, 3.78],
        wheel_radius_m: 0.325,
        rim: Rim::Spokes(10),
        pillars_m: vec![1.42, 2.24, 3.3],
        glass_end_m: [4.42, 4.34],
        is_chromed: true,
        face: faces::SPLIT,
        seats_m: vec![2.02, 2.95, 3.8],
        ..mpv()
    }
}

/// A large one.
pub(super) fn minivan_large() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.15,
            width_m: 1.97,
            nose_m: 0.93,
            cowl: (1.0, 1.14),
            header: (1.86, 1.7),
            peak: (2.7, 1.8),
            rear_header: (4.78, 1.74),
            deck: (5.02, 1.14),
            tail_m: 1.05,
            belt_m: [1.05, 1.1],
            roof_share: 0.72,
            square: [3.4, 4.6],
            ..minivan().profile
        },
        axles_m: [0.98, 4.06],
        wheel_radius_m: 0.35,
        rim: Rim::Spokes(5),
        pillars_m: vec![1.75, 2.58, 3.68],
        glass_end_m: [4.76, 4.6],
        face: faces::CLOSED,
        back: faces::WIDE,
        seats_m: vec![2.4, 3.35, 4.2],
        ..minivan()
    }
}

/// A pick-up with two rows of seats.
pub(super) fn pickup() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.35,
            width_m: 1.89,
            clearance_m: 0.25,
            nose_m: 1.07,
            cowl: (1.3, 1.2),
            header: (2.0, 1.72),
            peak: (2.5, 1.79),
            rear_header: (3.55, 1.75),
            deck: (3.68, 1.18),
            tail_m: 1.16,
            belt_m: [1.14, 1.17],
            roof_share: 0.7,
            round_m: [0.75, 0.22],
            square: [3.8, 7.0],
            rake_m: [0.09, 0.01],
            flare_m: 0.035,
            screen_bow_m: [0.4, 0.12],
            has_bed: true,
            ..suv_large().profile
        },
        axles_m: [0.95, 4.1],
        wheel_radius_m: 0.385,
        rim: Rim::Spokes(6),
        pillars_m: vec![2.44, 3.3],
        glass_end_m: [3.5, 3.42],
        dark_from_m: f32::INFINITY,
        face: faces::TRUCK,
        back: faces::POST,
        roof_rails: false,
        seats_m: vec![2.4, 3.15],
        ..suv_large()
    }
}

/// A large one.
pub(super) fn pickup_large() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.88,
            width_m: 2.03,
            clearance_m: 0.28,
            nose_m: 1.16,
            cowl: (1.42, 1.29),
            header: (2.1, 1.86),
            peak: (2.7, 1.94),
            rear_header: (3.9, 1.9),
            deck: (4.02, 1.29),
            tail_m: 1.3,
            belt_m: [1.23, 1.28],
            roof_share: 0.73,
            square: [4.2, 7.0],
            ..pickup().profile
        },
        axles_m: [0.97, 4.67],
        wheel_radius_m: 0.41,
        rim: Rim::Pairs(6),
        pillars_m: vec![2.6, 3.6],
        glass_end_m: [3.84, 3.78],
        seats_m: vec![2.55, 3.45],
        ..pickup()
    }
}

/// A small delivery van.
pub(super) fn van_small() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.42,
            width_m: 1.82,
            nose_m: 0.9,
            cowl: (0.86, 1.09),
            header: (1.6, 1.7),
            peak: (2.3, 1.81),
            rear_header: (4.3, 1.79),
            deck: (4.36, 1.08),
            tail_m: 1.07,
            belt_m: [1.04, 1.08],
            roof_share: 0.8,
            round_m: [0.75, 0.2],
            square: [3.3, 6.0],
            rake_m: [0.17, 0.02],
            shoulder_m: 0.028,
            flare_m: 0.012,
            hollow_m: 0.015,
            screen_bow_m: [0.38, 0.1],
            ..mpv().profile
        },
        axles_m: [0.9, 3.65],
        wheel_radius_m: 0.32,
        rim: Rim::Cover(8),
        pillars_m: vec![2.12],
        glass_end_m: [2.12, 2.12],
        blind_from_m: 2.12,
        dark_from_m: f32::INFINITY,
        cladding: true,
        face: faces::VAN,
        back: faces::POST,
        seats_m: vec![1.96],
        ..mpv()
    }
}

/// A delivery van.
pub(super) fn van_panel() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.3,
            width_m: 1.95,
            clearance_m: 0.2,
            nose_m: 1.0,
            cowl: (0.74, 1.24),
            header: (1.5, 1.92),
            peak: (2.4, 1.99),
            rear_header: (5.18, 1.96),
            deck: (5.24, 1.18),
            tail_m: 1.17,
            belt_m: [1.15, 1.18],
            roof_share: 0.84,
            round_m: [0.7, 0.2],
            screen_bow_m: [0.38, 0.09],
            ..van_small().profile
        },
        axles_m: [0.98, 4.3],
        wheel_radius_m: 0.345,
        rim: Rim::Cover(6),
        pillars_m: vec![2.1],
        glass_end_m: [2.1, 2.1],
        blind_from_m: 2.1,
        seats_m: vec![1.94],
        ..van_small()
    }
}

/// The same with windows all along.
pub(super) fn van_minibus() -> CarPlan {
    CarPlan {
        rim: Rim::Spokes(5),
        pillars_m: vec![2.1, 3.2, 4.2],
        glass_end_m: [5.06, 5.04],
        blind_from_m: f32::INFINITY,
        dark_from_m: 2.6,
        seats_m: vec![1.94, 2.95, 3.9, 4.7],
        ..van_panel()
    }
}

/// A delivery van that one can stand in.
pub(super) fn van_high_roof() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.95,
            width_m: 2.02,
            nose_m: 1.05,
            cowl: (0.7, 1.3),
            header: (1.55, 2.38),
            peak: (2.5, 2.6),
            rear_header: (5.82, 2.56),
            deck: (5.88, 1.22),
            tail_m: 1.21,
            belt_m: [1.2, 1.22],
            roof_share: 0.85,
            ..van_panel().profile
        },
        axles_m: [1.0, 4.65],
        wheel_radius_m: 0.355,
        rim: Rim::Steel,
        pillars_m: vec![2.05],
        glass_end_m: [2.05, 2.05],
        blind_from_m: 2.05,
        seats_m: vec![1.92],
        ..van_panel()
    }
}

/// A minibus that one can stand in.
pub(super) fn minibus_high() -> CarPlan {
    CarPlan {
        pillars_m: vec![2.05, 3.3, 4.4],
        glass_end_m: [5.7, 5.68],
        blind_from_m: f32::INFINITY,
        dark_from_m: 2.6,
        seats_m: vec![1.92, 2.9, 3.75, 4.6, 5.4],
        ..van_high_roof()
    }
}

/// A box on wheels, as for parcels.
pub(super) fn step_van() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 5.8,
            width_m: 2.1,
            clearance_m: 0.32,
            nose_m: 1.12,
            cowl: (0.55, 1.3),
            header: (0.86, 2.5),
            peak: (2.0, 2.72),
            rear_header: (5.7, 2.68),
            deck: (5.74, 1.28),
            tail_m: 1.27,
            belt_m: [1.24, 1.28],
            roof_share: 0.93,
            round_m: [0.45, 0.15],
            square: [4.5, 8.0],
            rake_m: [0.16, 0.01],
            shoulder_m: 0.015,
            hollow_m: 0.006,
            screen_bow_m: [0.3, 0.06],
            ..van_high_roof().profile
        },
        axles_m: [0.85, 4.35],
        wheel_radius_m: 0.39,
        rim: Rim::Steel,
        pillars_m: vec![1.7],
        glass_end_m: [1.7, 1.7],
        blind_from_m: 1.7,
        back: faces::POST,
        seats_m: vec![1.5],
        ..van_high_roof()
    }
}
