//! The postures that everyone takes, and some take besides.

use glam::{Vec3, vec3};
use serde::Deserialize;
use trove_model::Posture;

use super::gait::Gait;
use super::skeleton::Skeleton;
use super::stance::{Arm, Foot, Stance};

/// Phases of a cycle that there are meshes of.
const WALKING: u8 = 8;
const RUNNING: u8 = 4;

/// What someone does; everyone walks and runs, which no plan says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Act {
    /// Phase of so many.
    #[serde(skip)]
    Walk(u8),
    #[serde(skip)]
    Run(u8),
    Easy,
    /// On one leg more than the other.
    Leaning,
    /// Hands before the body.
    Clasped,
    HandsBehind,
    ArmsCrossed,
    Pockets,
    Akimbo,
    LookingAtPhone,
    Phoning,
    Waving,
    Pointing,
    Carrying,
    Bending,
    Sitting,
}

const AHEAD: Vec3 = vec3(-0.3, 0.7, -1.0);

impl Act {
    /// The phases that everyone has.
    pub(super) fn cycles() -> impl Iterator<Item = Self> {
        (0..WALKING).map(Self::Walk).chain((0..RUNNING).map(Self::Run))
    }

    /// Part of an id.
    pub(super) fn name(self) -> String {
        match self {
            Self::Walk(k) => format!("walk-{k}"),
            Self::Run(k) => format!("run-{k}"),
            Self::Easy => "easy".into(),
            Self::Leaning => "leaning".into(),
            Self::Clasped => "clasped".into(),
            Self::HandsBehind => "hands-behind".into(),
            Self::ArmsCrossed => "arms-crossed".into(),
            Self::Pockets => "pockets".into(),
            Self::Akimbo => "akimbo".into(),
            Self::LookingAtPhone => "phone".into(),
            Self::Phoning => "phoning".into(),
            Self::Waving => "waving".into(),
            Self::Pointing => "pointing".into(),
            Self::Carrying => "carrying".into(),
            Self::Bending => "bending".into(),
            Self::Sitting => "sitting".into(),
        }
    }

    /// What the builder knows it by.
    pub(super) fn posture(self, skeleton: &Skeleton) -> Posture {
        let phase = |k: u8, of: u8| f32::from(k) / f32::from(of);
        match self {
            Self::Walk(k) => Posture::Walking { phase: phase(k, WALKING), stride_m: Gait::Walk.stride_m(skeleton) },
            Self::Run(k) => Posture::Running { phase: phase(k, RUNNING), stride_m: Gait::Run.stride_m(skeleton) },
            Self::Sitting => Posture::Sitting,
            _ => Posture::Standing,
        }
    }

    /// How the joints stand.
    pub(super) fn stance(self, skeleton: &Skeleton) -> Stance {
        let easy = Stance::EASY;
        let [hang, other] = easy.arms;
        let reach = Arm::reaching;
        let both = |arm: Arm| [arm, arm];
        match self {
            Self::Walk(k) => Gait::Walk.stance(f32::from(k) / f32::from(WALKING), skeleton),
            Self::Run(k) => Gait::Run.stance(f32::from(k) / f32::from(RUNNING), skeleton),
            Self::Easy => Stance {
                feet: [Foot { yaw_rad: 0.25, ..Foot::flat(0.05, 0.13) }, Foot::flat(-0.04, 0.13)],
                head: vec3(0.0, 0.05, 0.2),
                ..easy
            },
            Self::Leaning => Stance {
                hips_up: 0.975,
                hips_shift: [0.0, 0.06],
                pelvis: vec3(0.07, 0.0, 0.1),
                spine: vec3(-0.12, 0.02, -0.05),
                head: vec3(-0.03, 0.04, -0.35),
                feet: [Foot::flat(-0.02, 0.1), Foot { yaw_rad: 0.45, ..Foot::flat(0.12, 0.2) }],
                ..easy
            },
            Self::Clasped => Stance {
                arms: [
                    reach(vec3(0.44, -0.26, -0.66), vec3(-0.5, 0.9, -0.3)),
                    reach(vec3(0.48, -0.26, -0.68), vec3(-0.5, 0.9, -0.3)),
                ],
                head: vec3(0.0, 0.12, -0.1),
                ..easy
            },
            Self::HandsBehind => Stance {
                arms: both(reach(vec3(-0.3, -0.2, -0.78), vec3(-0.3, 1.0, 0.1))),
                spine: vec3(0.0, -0.02, 0.0),
                head: vec3(0.0, 0.0, 0.5),
                ..easy
            },
            Self::ArmsCrossed => Stance {
                arms: [
                    reach(vec3(0.5, -0.42, -0.42), vec3(-0.1, 1.0, -0.9)).gripping(),
                    reach(vec3(0.58, -0.4, -0.5), vec3(-0.1, 1.0, -0.9)).gripping(),
                ],
                head: vec3(0.0, 0.02, 0.3),
                ..easy
            },
            Self::Pockets => Stance {
                arms: both(reach(vec3(0.12, 0.06, -0.83), vec3(-0.8, 0.9, 0.0))),
                spine: vec3(0.0, 0.06, 0.0),
                head: vec3(0.0, 0.1, -0.3),
                feet: [Foot::flat(0.04, 0.15), Foot { yaw_rad: 0.35, ..Foot::flat(-0.05, 0.14) }],
                ..easy
            },
            Self::Akimbo => Stance {
                arms: both(reach(vec3(0.05, 0.12, -0.64), vec3(-0.7, 1.0, 0.1)).gripping()),
                feet: [Foot { yaw_rad: 0.3, ..Foot::flat(0.0, 0.18) }, Foot { yaw_rad: 0.3, ..Foot::flat(0.0, 0.18) }],
                head: vec3(0.0, 0.0, -0.4),
                ..easy
            },
            Self::LookingAtPhone => Stance {
                arms: [hang, Arm { roll_rad: 0.9, ..reach(vec3(0.6, -0.1, -0.36), AHEAD).gripping() }],
                spine: vec3(0.0, 0.1, 0.0),
                head: vec3(0.0, 0.5, -0.08),
                ..easy
            },
            Self::Phoning => Stance {
                arms: [hang, Arm { roll_rad: 0.3, ..reach(vec3(0.26, 0.1, 0.24), vec3(0.4, 1.0, -0.9)).gripping() }],
                head: vec3(0.12, 0.06, 0.25),
                ..easy
            },
            Self::Waving => Stance {
                arms: [other, Arm { curl: 0.05, ..reach(vec3(0.32, 0.3, 0.22), vec3(-0.1, 1.0, -1.0)) }],
                head: vec3(0.0, 0.0, -0.25),
                ..easy
            },
            Self::Pointing => Stance {
                arms: [hang, Arm { curl: 0.1, ..reach(vec3(0.93, 0.2, 0.08), vec3(-0.2, 0.8, -1.0)) }],
                head: vec3(0.0, 0.0, -0.2),
                ..easy
            },
            Self::Carrying => Stance {
                arms: both(Arm { roll_rad: -0.5, ..reach(vec3(0.72, -0.02, -0.5), AHEAD) }),
                spine: vec3(0.0, -0.06, 0.0),
                ..easy
            },
            Self::Bending => Stance {
                hips_up: 0.86,
                hips_shift: [-0.12, 0.0],
                pelvis: vec3(0.0, 0.55, 0.0),
                spine: vec3(0.0, 0.55, 0.0),
                head: vec3(0.0, 0.75, 0.0),
                arms: both(reach(vec3(0.35, -0.05, -0.82), vec3(-0.6, 0.8, -0.2))),
                ..easy
            },
            Self::Sitting => Stance {
                hips_up: 0.5,
                hips_shift: [-0.46, 0.0],
                pelvis: vec3(0.0, -0.12, 0.0),
                spine: vec3(0.0, 0.2, 0.0),
                head: vec3(0.0, 0.05, 0.1),
                arms: both(reach(vec3(0.6, -0.02, -0.62), vec3(-0.5, 0.9, -0.4))),
                feet: [Foot::flat(0.02, 0.14), Foot::flat(0.06, 0.14)],
                knees_out: 0.1,
            },
        }
    }
}
