//! What stands in the plan of a car. Distances along a car are measured from its front.

use serde::Deserialize;
use trove_model::{Class, Kind};

use crate::measure::ordinary;
use crate::vehicles::plate::PlateDesign;
use crate::vehicles::slots::Paint;
use crate::vehicles::wheel::Rim;

/// What a car counts as.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CarKind {
    #[default]
    Car,
    PoliceCar,
    Ambulance,
    /// As nuScenes, for one, counts pick-ups.
    Truck,
}

impl From<CarKind> for Kind {
    fn from(kind: CarKind) -> Self {
        match kind {
            CarKind::Car => Self::Car,
            CarKind::PoliceCar => Self::PoliceCar,
            CarKind::Ambulance => Self::Ambulance,
            CarKind::Truck => Self::Truck,
        }
    }
}

/// What the pixels of a car are.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CarClass {
    #[default]
    Car,
    Jeep,
    Van,
    Truck,
}

impl From<CarClass> for Class {
    fn from(class: CarClass) -> Self {
        match class {
            CarClass::Car => Self::Car,
            CarClass::Jeep => Self::Jeep,
            CarClass::Van => Self::Van,
            CarClass::Truck => Self::Truck,
        }
    }
}

fn nowhere() -> f32 {
    f32::INFINITY
}

/// A car to build: a `[[car]]` of a file of plans, with what it takes from others filled in.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CarPlan {
    /// Unique in its library.
    pub(crate) id: String,
    #[serde(default)]
    pub(crate) kind: CarKind,
    #[serde(default)]
    pub(crate) class: CarClass,
    /// Words that say what it is.
    #[serde(default)]
    pub(crate) tags: Vec<String>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    #[serde(default = "ordinary")]
    pub(crate) commonness: f32,
    pub(crate) paint: Paint,
    pub(crate) plate: PlateDesign,
    /// What is put on it, in this order.
    #[serde(default)]
    pub(crate) extras: Vec<CarExtra>,
    pub(crate) profile: Profile,
    /// Distances of the axles from the front.
    pub(crate) axles_m: [f32; 2],
    pub(crate) wheel_radius_m: f32,
    pub(crate) rim: Rim,
    /// Where the side windows are parted, from the front; doors end there too.
    pub(crate) pillars_m: Vec<f32>,
    /// Where the side windows end, at their lower and at their upper edge.
    pub(crate) glass_end_m: [f32; 2],
    /// Windows behind this distance are sheet metal (panel vans).
    #[serde(default = "nowhere")]
    pub(crate) blind_from_m: f32,
    /// Side windows behind this distance are dark.
    #[serde(default = "nowhere")]
    pub(crate) dark_from_m: f32,
    /// Black plastic around the lower edge and the wheels.
    #[serde(default)]
    pub(crate) cladding: bool,
    /// A bright line around the side windows.
    #[serde(default)]
    pub(crate) is_chromed: bool,
    pub(crate) face: Face,
    pub(crate) back: Back,
    /// Rails on the roof.
    #[serde(default)]
    pub(crate) roof_rails: bool,
    /// Rows of seats, as distances of their backs from the front.
    pub(crate) seats_m: Vec<f32>,
    /// Drives on the left: the steering wheel is on the right.
    #[serde(default)]
    pub(crate) right_hand_drive: bool,
}

impl CarPlan {
    pub(super) fn half_m(&self) -> f32 {
        self.profile.width_m / 2.0
    }

    pub(super) fn arch_radius_m(&self) -> f32 {
        self.wheel_radius_m * 1.09 + 0.02
    }

    /// Where the front doors begin.
    pub(super) fn first_gap_m(&self) -> f32 {
        (self.axles_m[0] + self.arch_radius_m() + 0.05).max(self.profile.cowl.0 + 0.05)
    }

    /// Where doors end: at every pillar but one that only parts off a small pane beside the windscreen.
    pub(super) fn door_ends_m(&self) -> impl Iterator<Item = f32> {
        let first = self.first_gap_m();
        self.pillars_m.iter().copied().filter(move |&s| s > first + 0.3)
    }
}

/// What is put on a car; colours are linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CarExtra {
    /// A box for skis and luggage on the roof.
    RoofBox,
    /// A lit sign on the roof with this word on it.
    RoofSign(String),
    /// Windows and seams of doors behind and of a sliding door.
    LoadDoors,
    /// Blue and red lights across.
    LightBar(LightBar),
    /// Doors in another paint, with a word.
    Doors(Livery),
    /// A reflecting band along the sides, with a word.
    Band(Livery),
    /// Two rows of reflecting checks along the sides.
    Checks(Checks),
    /// A word on the sides behind the driver, above the windows' lower edge.
    LoadName(Name),
}

/// Where a bar of lights stands and how wide it is.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightBar {
    pub(crate) on: Mount,
    pub(crate) width_m: f32,
}

/// A place on a roof.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Mount {
    /// Its highest point.
    Roof,
    /// Behind the windscreen.
    Front,
    /// Before its rear end.
    Rear,
}

/// Another paint on a part of the sides, and a word in it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Livery {
    /// The material's name.
    pub(crate) paint: String,
    pub(crate) color: [f32; 3],
    pub(crate) text: String,
    pub(crate) ink: [f32; 3],
}

/// Checks in two colours by turns.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Checks {
    pub(crate) colors: [[f32; 3]; 2],
    /// Height of one of the two rows.
    pub(crate) row_m: f32,
}

/// A word on a ground of its own colour.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) ink: [f32; 3],
    pub(crate) color: [f32; 3],
}

/// The side view of a car and how it is rounded; points are (distance from the front, height).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Profile {
    pub(crate) length_m: f32,
    /// Widest point of the body, without mirrors.
    pub(crate) width_m: f32,
    /// Under the sills.
    pub(crate) clearance_m: f32,
    /// Leading edge of the bonnet.
    pub(crate) nose_m: f32,
    /// Bonnet meets windscreen.
    pub(crate) cowl: (f32, f32),
    /// Windscreen meets roof.
    pub(crate) header: (f32, f32),
    /// Highest point of the roof.
    pub(crate) peak: (f32, f32),
    /// Roof meets rear window.
    pub(crate) rear_header: (f32, f32),
    /// Rear window meets boot.
    pub(crate) deck: (f32, f32),
    /// Upper rear edge of the boot.
    pub(crate) tail_m: f32,
    /// Lower edge of the side windows at the front and at the back.
    pub(crate) belt_m: [f32; 2],
    /// Half width of the roof, a share of half the width.
    pub(crate) roof_share: f32,
    /// Length over which the front and the back are rounded in plan.
    pub(crate) round_m: [f32; 2],
    /// How square the front and the back are in plan: 2 is an ellipse.
    pub(crate) square: [f32; 2],
    /// How far the upper edge of the nose and of the tail lies behind the bumper.
    pub(crate) rake_m: [f32; 2],
    /// How far the windows stand in from the doors.
    pub(crate) shoulder_m: f32,
    /// How far the wheel arches stand out from the doors.
    pub(crate) flare_m: f32,
    /// How far the doors are hollowed between sill and shoulder.
    pub(crate) hollow_m: f32,
    /// How far the ends of windscreen and rear window lie behind, or before, their middles.
    pub(crate) screen_bow_m: [f32; 2],
    /// An open load bed in place of a boot lid.
    #[serde(default)]
    pub(crate) has_bed: bool,
}

/// What fills a grille.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Bars {
    /// Nothing behind the frame but dark.
    Dark,
    Across(usize),
    Upright(usize),
    /// Body colour: no opening.
    Closed,
}

/// Points (share of half the width, height in metres).
type Outline = Vec<(f32, f32)>;

/// The front.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Face {
    /// Head lamp, from the nose.
    pub(crate) lamp: Outline,
    /// Daytime light guide in it.
    #[serde(default)]
    pub(crate) strip: Outline,
    /// Middles of its projectors.
    pub(crate) bulbs: Outline,
    pub(crate) bulb_m: f32,
    /// From the nose; its inner side is the middle of the car.
    #[serde(default)]
    pub(crate) grille: Outline,
    pub(crate) bars: Bars,
    /// A bright frame and bright bars.
    #[serde(default)]
    pub(crate) is_chromed: bool,
    /// Lower opening, from the sill.
    #[serde(default)]
    pub(crate) intake: Outline,
    /// Openings or fog lamps on its sides, from the sill.
    #[serde(default)]
    pub(crate) vent: Outline,
    /// Height of the badge, from the nose.
    pub(crate) badge_m: f32,
    /// Height of the plate, from the sill.
    pub(crate) plate_m: f32,
}

/// The back.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Back {
    /// Tail lamp, from the tail; it may reach up beside the rear window.
    pub(crate) lamp: Outline,
    /// Its light guide.
    #[serde(default)]
    pub(crate) strip: Outline,
    /// Reversing lamp and indicator.
    #[serde(default)]
    pub(crate) white: Outline,
    /// Height of the plate, from the tail.
    pub(crate) plate_m: f32,
    /// Height of the lid's lower edge, from the tail.
    pub(crate) lid_m: f32,
    /// Black lower part of the bumper, height from the sill.
    pub(crate) black_m: f32,
    /// A spare wheel on the door.
    #[serde(default)]
    pub(crate) has_spare: bool,
}
