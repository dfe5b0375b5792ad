//! What stands in the plan of a car. Distances along a car are measured from its front.

use serde::Deserialize;
use trove_model::{Class, Kind};

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

/// Whether a point of an outline is on a car.
fn is_near(&(share, height_m): &(f32, f32)) -> bool {
    (-2.0..=2.0).contains(&share) && (-3.0..=3.0).contains(&height_m)
}

fn ordinary() -> f32 {
    1.0
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
    /// The key of a value that no car can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), (&'static str, &'static str, String)> {
        let wrong = |key, expected, found: &dyn std::fmt::Debug| Err((key, expected, format!("{found:?}")));
        let p = &self.profile;
        if !(2.0..=9.0).contains(&p.length_m) {
            return wrong("profile.length_m", "metres from 2 to 9", &p.length_m);
        }
        if !(1.0..=3.0).contains(&p.width_m) {
            return wrong("profile.width_m", "metres from 1 to 3", &p.width_m);
        }
        let along = [0.0, p.cowl.0, p.header.0, p.peak.0, p.rear_header.0, p.deck.0, p.length_m];
        if !along.is_sorted_by(|a, b| a < b) {
            let expected = "cowl, header, peak, rear_header and deck one behind the other, within length_m";
            return wrong("profile", expected, &along);
        }
        let heights = [p.clearance_m, p.nose_m, p.tail_m, p.cowl.1, p.header.1, p.peak.1, p.rear_header.1, p.deck.1];
        if heights.into_iter().chain(p.belt_m).any(|z| !(0.05..=4.0).contains(&z)) {
            return wrong("profile", "heights from 0.05 to 4 metres", &heights);
        }
        if !(0.2..=1.0).contains(&p.roof_share) {
            return wrong("profile.roof_share", "a share from 0.2 to 1", &p.roof_share);
        }
        if p.round_m.iter().any(|m| !(0.05..=p.length_m / 3.0).contains(m)) {
            return wrong("profile.round_m", "metres from 0.05 to a third of the length", &p.round_m);
        }
        if p.square.iter().any(|n| !(1.0..=12.0).contains(n)) {
            return wrong("profile.square", "numbers from 1 to 12", &p.square);
        }
        let small = [p.shoulder_m, p.flare_m, p.hollow_m].into_iter().chain(p.rake_m).chain(p.screen_bow_m);
        if let Some(found) = small.into_iter().find(|m| !(0.0..=1.0).contains(m)) {
            let expected = "shoulder_m, flare_m, hollow_m, rake_m and screen_bow_m from 0 to 1";
            return wrong("profile", expected, &found);
        }
        if ![0.0, self.axles_m[0], self.axles_m[1], p.length_m].is_sorted_by(|a, b| a < b) {
            return wrong("axles_m", "two axles one behind the other, within profile.length_m", &self.axles_m);
        }
        if !(0.15..=0.8).contains(&self.wheel_radius_m) {
            return wrong("wheel_radius_m", "metres from 0.15 to 0.8", &self.wheel_radius_m);
        }
        if let Rim::Spokes(count) | Rim::Pairs(count) | Rim::Cover(count) = self.rim
            && !(1..=40).contains(&count)
        {
            return wrong("rim", "a number from 1 to 40", &self.rim);
        }
        if self.seats_m.is_empty() || self.seats_m.iter().any(|s| !(0.0..=p.length_m).contains(s)) {
            return wrong("seats_m", "at least one row of seats, within profile.length_m", &self.seats_m);
        }
        if self.pillars_m.iter().chain(&self.glass_end_m).any(|s| !(0.0..=p.length_m).contains(s)) {
            let found = (&self.pillars_m, self.glass_end_m);
            return wrong("pillars_m", "pillars and glass_end_m within profile.length_m", &found);
        }
        if self.blind_from_m.is_nan() || self.dark_from_m.is_nan() {
            return wrong("blind_from_m", "metres, or no key", &self.blind_from_m);
        }
        self.check_ends()?;
        if self.paint.colors.is_empty() {
            return wrong("paint.colors", "at least one colour", &self.paint.colors);
        }
        let plate = &self.plate;
        if plate.size_m.iter().any(|m| !(0.05..=1.0).contains(m)) {
            return wrong("plate.size_m", "metres from 0.05 to 1", &plate.size_m);
        }
        let colors = self.paint.colors.iter().chain([&plate.ink, &plate.ground]).chain(&plate.field);
        if let Some(color) = colors.into_iter().find(|c| c.iter().any(|v| !(0.0..=1.0).contains(v))) {
            return wrong("paint", "colours from 0 to 1", color);
        }
        if !(self.commonness.is_finite() && self.commonness > 0.0) {
            return wrong("commonness", "a number above 0", &self.commonness);
        }
        self.check_extras()
    }

    /// Lamps and openings of both ends.
    fn check_ends(&self) -> Result<(), (&'static str, &'static str, String)> {
        let wrong = |key, expected, found: &dyn std::fmt::Debug| Err((key, expected, format!("{found:?}")));
        let (face, back) = (&self.face, &self.back);
        let needs_grille = face.bars != Bars::Closed;
        let outlines = [
            ("face.lamp", &face.lamp, true),
            ("face.strip", &face.strip, false),
            ("face.grille", &face.grille, needs_grille),
            ("face.intake", &face.intake, false),
            ("face.vent", &face.vent, false),
            ("back.lamp", &back.lamp, true),
            ("back.strip", &back.strip, false),
            ("back.white", &back.white, false),
        ];
        for (key, outline, is_needed) in outlines {
            let is_there = outline.len() > 2 || (outline.is_empty() && !is_needed);
            if !is_there || outline.len() > 40 || !outline.iter().all(is_near) {
                return wrong(key, "from 3 to 40 points (share of half the width, metres)", outline);
            }
        }
        if !face.bulbs.iter().all(is_near) {
            return wrong("face.bulbs", "points (share of half the width, metres)", &face.bulbs);
        }
        if let Bars::Across(count) | Bars::Upright(count) = face.bars
            && !(1..=40).contains(&count)
        {
            return wrong("face.bars", "a number from 1 to 40", &face.bars);
        }
        let heights = [face.badge_m, face.plate_m, back.plate_m, back.lid_m, back.black_m];
        if heights.iter().any(|m| !(-2.0..=2.0).contains(m)) {
            return wrong("face", "badge_m, plate_m, lid_m and black_m from -2 to 2", &heights);
        }
        if !(0.005..=0.2).contains(&face.bulb_m) {
            return wrong("face.bulb_m", "metres from 0.005 to 0.2", &face.bulb_m);
        }
        Ok(())
    }

    fn check_extras(&self) -> Result<(), (&'static str, &'static str, String)> {
        let is_blind = self.blind_from_m < self.profile.length_m;
        for extra in &self.extras {
            let expected = match extra {
                CarExtra::LoadDoors | CarExtra::LoadName(_) if !is_blind => {
                    "no load_doors or load_name, or blind_from_m within profile.length_m"
                }
                CarExtra::LightBar(bar) if !(0.3..=2.5).contains(&bar.width_m) => "lights from 0.3 to 2.5 metres wide",
                CarExtra::Checks(checks) if !(0.05..=1.0).contains(&checks.row_m) => "rows of 0.05 to 1 metres",
                _ => continue,
            };
            return Err(("extras", expected, format!("{extra:?}")));
        }
        Ok(())
    }

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
