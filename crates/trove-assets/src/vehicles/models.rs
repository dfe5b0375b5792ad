//! The measures of saloons, hatchbacks, estates and coupés, in metres, each told by how it differs from another.

use super::body::Profile;
use super::car::CarPlan;
use super::faces;
use super::wheel::Rim;

/// A small saloon.
pub(super) fn sedan_compact() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.62,
            width_m: 1.79,
            clearance_m: 0.16,
            nose_m: 0.78,
            cowl: (1.12, 0.985),
            header: (1.98, 1.39),
            peak: (2.6, 1.455),
            rear_header: (3.3, 1.41),
            deck: (4.02, 1.095),
            tail_m: 1.06,
            belt_m: [0.93, 0.995],
            roof_share: 0.64,
            round_m: [0.78, 0.55],
            square: [3.7, 4.6],
            rake_m: [0.15, 0.06],
            shoulder_m: 0.055,
            flare_m: 0.018,
            hollow_m: 0.032,
            screen_bow_m: [0.42, 0.34],
            has_bed: false,
        },
        axles_m: [0.93, 3.63],
        wheel_radius_m: 0.32,
        rim: Rim::Spokes(10),
        pillars_m: vec![2.3, 3.2],
        glass_end_m: [3.66, 3.16],
        blind_from_m: f32::INFINITY,
        dark_from_m: f32::INFINITY,
        cladding: false,
        is_chromed: true,
        face: faces::FAMILY,
        back: faces::BOOT,
        roof_rails: false,
        seats_m: vec![2.3, 3.12],
        right_hand_drive: false,
    }
}

/// A saloon for families.
pub(super) fn sedan_family() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.88,
            width_m: 1.84,
            nose_m: 0.8,
            cowl: (1.2, 1.0),
            header: (2.1, 1.385),
            peak: (2.75, 1.45),
            rear_header: (3.45, 1.41),
            deck: (4.22, 1.12),
            tail_m: 1.09,
            belt_m: [0.93, 1.01],
            ..sedan_compact().profile
        },
        axles_m: [0.96, 3.79],
        wheel_radius_m: 0.33,
        rim: Rim::Pairs(5),
        pillars_m: vec![2.42, 3.34],
        glass_end_m: [3.84, 3.3],
        face: faces::MOUTH,
        back: faces::WIDE,
        seats_m: vec![2.42, 3.28],
        ..sedan_compact()
    }
}

/// A large saloon.
pub(super) fn sedan_executive() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.96,
            width_m: 1.87,
            nose_m: 0.81,
            cowl: (1.42, 1.0),
            header: (2.26, 1.395),
            peak: (2.9, 1.465),
            rear_header: (3.6, 1.42),
            deck: (4.3, 1.125),
            tail_m: 1.1,
            belt_m: [0.935, 1.01],
            rake_m: [0.1, 0.06],
            ..sedan_compact().profile
        },
        axles_m: [0.87, 3.82],
        wheel_radius_m: 0.345,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.58, 3.5],
        glass_end_m: [3.96, 3.46],
        face: faces::EXECUTIVE,
        back: faces::BOOT,
        seats_m: vec![2.55, 3.42],
        ..sedan_compact()
    }
}

/// A saloon of twenty years ago.
pub(super) fn sedan_old() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.5,
            width_m: 1.71,
            nose_m: 0.74,
            cowl: (1.2, 0.95),
            header: (1.92, 1.37),
            peak: (2.5, 1.42),
            rear_header: (3.2, 1.38),
            deck: (3.72, 1.06),
            tail_m: 1.03,
            belt_m: [0.89, 0.93],
            roof_share: 0.66,
            square: [3.8, 5.0],
            rake_m: [0.09, 0.04],
            flare_m: 0.01,
            hollow_m: 0.015,
            screen_bow_m: [0.34, 0.26],
            ..sedan_compact().profile
        },
        axles_m: [0.88, 3.48],
        wheel_radius_m: 0.3,
        rim: Rim::Cover(7),
        pillars_m: vec![2.24, 3.1],
        glass_end_m: [3.42, 3.12],
        is_chromed: false,
        face: faces::LINE,
        seats_m: vec![2.2, 3.0],
        ..sedan_compact()
    }
}

/// An electric saloon.
pub(super) fn sedan_fastback() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.72,
            width_m: 1.86,
            clearance_m: 0.145,
            nose_m: 0.74,
            cowl: (1.0, 0.95),
            header: (1.95, 1.365),
            peak: (2.6, 1.435),
            rear_header: (3.35, 1.385),
            deck: (4.32, 1.105),
            tail_m: 1.085,
            belt_m: [0.89, 0.99],
            roof_share: 0.62,
            rake_m: [0.24, 0.05],
            flare_m: 0.028,
            ..sedan_compact().profile
        },
        axles_m: [0.86, 3.74],
        wheel_radius_m: 0.338,
        rim: Rim::Pairs(5),
        pillars_m: vec![2.3, 3.24],
        glass_end_m: [3.8, 3.2],
        is_chromed: false,
        face: faces::CLOSED,
        back: faces::WIDE,
        seats_m: vec![2.24, 3.1],
        ..sedan_compact()
    }
}

/// The compact saloon as a taxi that drives on the left.
pub(super) fn sedan_asia() -> CarPlan {
    CarPlan { rim: Rim::Cover(9), face: faces::LINE, right_hand_drive: true, ..sedan_compact() }
}

/// A compact car.
pub(super) fn hatchback() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.29,
            width_m: 1.79,
            nose_m: 0.8,
            cowl: (1.06, 1.0),
            header: (1.92, 1.4),
            peak: (2.5, 1.465),
            rear_header: (3.74, 1.4),
            deck: (4.12, 1.0),
            tail_m: 0.955,
            belt_m: [0.93, 1.02],
            roof_share: 0.65,
            round_m: [0.78, 0.5],
            square: [3.7, 4.4],
            rake_m: [0.15, 0.09],
            screen_bow_m: [0.42, 0.3],
            ..sedan_compact().profile
        },
        axles_m: [0.87, 3.5],
        wheel_radius_m: 0.32,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.2, 3.06],
        glass_end_m: [3.6, 3.42],
        is_chromed: false,
        face: faces::MOUTH,
        back: faces::HATCH,
        seats_m: vec![2.16, 2.96],
        ..sedan_compact()
    }
}

/// A small car.
pub(super) fn hatchback_small() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 3.95,
            width_m: 1.71,
            nose_m: 0.77,
            cowl: (0.94, 1.0),
            header: (1.74, 1.42),
            peak: (2.25, 1.48),
            rear_header: (3.42, 1.42),
            deck: (3.79, 1.02),
            tail_m: 0.975,
            belt_m: [0.945, 1.035],
            roof_share: 0.66,
            hollow_m: 0.026,
            ..hatchback().profile
        },
        axles_m: [0.8, 3.34],
        wheel_radius_m: 0.305,
        rim: Rim::Cover(8),
        pillars_m: vec![2.04, 2.84],
        glass_end_m: [3.26, 3.1],
        face: faces::SMALL,
        seats_m: vec![2.0, 2.76],
        ..hatchback()
    }
}

/// A city car.
pub(super) fn hatchback_city() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 3.6,
            width_m: 1.64,
            nose_m: 0.82,
            cowl: (0.78, 1.03),
            header: (1.5, 1.47),
            peak: (2.0, 1.53),
            rear_header: (3.16, 1.48),
            deck: (3.47, 1.05),
            tail_m: 0.98,
            belt_m: [0.97, 1.05],
            roof_share: 0.69,
            round_m: [0.7, 0.5],
            rake_m: [0.14, 0.07],
            ..hatchback_small().profile
        },
        axles_m: [0.68, 3.06],
        wheel_radius_m: 0.29,
        rim: Rim::Cover(6),
        pillars_m: vec![1.86, 2.6],
        glass_end_m: [3.0, 2.86],
        back: faces::COLUMN,
        seats_m: vec![1.82, 2.52],
        ..hatchback_small()
    }
}

/// A small car in an old style.
pub(super) fn hatchback_retro() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 3.85,
            width_m: 1.73,
            nose_m: 0.8,
            cowl: (1.02, 1.0),
            header: (1.62, 1.36),
            peak: (2.2, 1.42),
            rear_header: (3.4, 1.38),
            deck: (3.68, 1.03),
            tail_m: 0.98,
            belt_m: [0.96, 1.0],
            roof_share: 0.7,
            round_m: [0.9, 0.6],
            square: [2.7, 3.2],
            rake_m: [0.1, 0.06],
            shoulder_m: 0.075,
            flare_m: 0.03,
            hollow_m: 0.012,
            screen_bow_m: [0.3, 0.26],
            ..hatchback_small().profile
        },
        axles_m: [0.74, 3.23],
        wheel_radius_m: 0.305,
        rim: Rim::Spokes(8),
        pillars_m: vec![2.25],
        glass_end_m: [3.26, 3.18],
        cladding: true,
        is_chromed: true,
        face: faces::RETRO,
        back: faces::HATCH,
        seats_m: vec![2.0, 2.72],
        ..hatchback_small()
    }
}

/// A small box, as in Japan.
pub(super) fn kei() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 3.4,
            width_m: 1.48,
            nose_m: 0.98,
            cowl: (0.5, 1.12),
            header: (1.0, 1.68),
            peak: (1.7, 1.76),
            rear_header: (3.18, 1.72),
            deck: (3.33, 1.06),
            tail_m: 0.98,
            belt_m: [1.02, 1.05],
            roof_share: 0.8,
            round_m: [0.5, 0.35],
            square: [3.6, 5.0],
            rake_m: [0.12, 0.03],
            shoulder_m: 0.03,
            flare_m: 0.008,
            hollow_m: 0.015,
            screen_bow_m: [0.26, 0.16],
            ..hatchback_city().profile
        },
        axles_m: [0.5, 2.96],
        wheel_radius_m: 0.27,
        rim: Rim::Cover(9),
        pillars_m: vec![0.95, 1.72, 2.55],
        glass_end_m: [3.1, 3.04],
        seats_m: vec![1.56, 2.4],
        right_hand_drive: true,
        ..hatchback_city()
    }
}

/// An estate car.
pub(super) fn estate() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.76,
            width_m: 1.83,
            header: (2.08, 1.39),
            peak: (2.7, 1.455),
            rear_header: (4.24, 1.42),
            deck: (4.52, 1.05),
            tail_m: 0.98,
            belt_m: [0.93, 1.015],
            roof_share: 0.66,
            round_m: [0.78, 0.5],
            square: [3.7, 4.6],
            rake_m: [0.15, 0.08],
            screen_bow_m: [0.42, 0.26],
            ..sedan_family().profile
        },
        axles_m: [0.94, 3.72],
        rim: Rim::Spokes(9),
        pillars_m: vec![2.4, 3.3],
        glass_end_m: [4.08, 3.86],
        dark_from_m: 2.9,
        face: faces::LINE,
        back: faces::COLUMN,
        roof_rails: true,
        seats_m: vec![2.4, 3.22],
        ..sedan_family()
    }
}

/// A coupé.
pub(super) fn coupe() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.66,
            width_m: 1.87,
            clearance_m: 0.135,
            nose_m: 0.74,
            cowl: (1.42, 0.94),
            header: (2.28, 1.31),
            peak: (2.75, 1.36),
            rear_header: (3.3, 1.325),
            deck: (4.2, 1.03),
            tail_m: 1.01,
            belt_m: [0.88, 0.96],
            roof_share: 0.6,
            rake_m: [0.16, 0.05],
            shoulder_m: 0.07,
            flare_m: 0.035,
            ..sedan_executive().profile
        },
        axles_m: [0.82, 3.63],
        wheel_radius_m: 0.34,
        rim: Rim::Spokes(5),
        pillars_m: vec![2.98],
        glass_end_m: [3.56, 3.1],
        is_chromed: false,
        face: faces::SPORT,
        back: faces::BAR,
        seats_m: vec![2.55, 3.2],
        ..sedan_executive()
    }
}

/// A sports car.
pub(super) fn sports() -> CarPlan {
    CarPlan {
        profile: Profile {
            length_m: 4.5,
            width_m: 1.88,
            clearance_m: 0.12,
            nose_m: 0.64,
            cowl: (1.2, 0.87),
            header: (2.06, 1.24),
            peak: (2.4, 1.285),
            rear_header: (2.85, 1.26),
            deck: (4.05, 0.93),
            tail_m: 0.92,
            belt_m: [0.84, 0.9],
            roof_share: 0.56,
            square: [2.9, 3.6],
            rake_m: [0.34, 0.06],
            flare_m: 0.055,
            hollow_m: 0.035,
            ..coupe().profile
        },
        axles_m: [1.0, 3.46],
        wheel_radius_m: 0.342,
        rim: Rim::Pairs(5),
        pillars_m: vec![2.9],
        glass_end_m: [3.3, 2.75],
        seats_m: vec![2.38],
        ..coupe()
    }
}
