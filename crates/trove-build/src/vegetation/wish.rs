//! A plant that is wanted somewhere.

use glam::DVec2;
use trove_model::{Kind, MappedPlant, PlantForm, Seed};

/// Side of the squares in which plants are of one species, metres.
const SPECIES_SQUARE_M: f64 = 60.0;

/// A plant that is wanted somewhere.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wish {
    /// Tree or bush.
    pub kind: Kind,
    /// Where.
    pub position: DVec2,
    /// How tall, metres.
    pub height_m: f64,
    /// Plants with the same number are of one species.
    pub group: u64,
    /// Species or genus and leaves, where the map says so.
    pub mapped: MappedPlant,
    /// Half the distance to its like, metres; `None`: as its size asks.
    pub radius_m: Option<f64>,
    /// How it stands.
    pub form: Form,
    /// It may stand in paving too.
    pub paved: bool,
}

/// How a plant stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    /// As it grows.
    Free,
    /// A piece of a row that runs along a direction, of plants of some form.
    Row { planted: PlantForm, yaw_rad: f64, length_m: f64, width_m: f64 },
}

impl Wish {
    /// A free plant of whatever grows there, on open land, with as much room as its size asks.
    pub(super) fn new(kind: Kind, position: DVec2, height_m: f64, group: u64) -> Self {
        Self {
            kind,
            position,
            height_m,
            group,
            mapped: MappedPlant::default(),
            radius_m: None,
            form: Form::Free,
            paved: false,
        }
    }

    /// Where it needs room for its width: a row's piece at both ends and in its middle.
    pub(super) fn spots(&self) -> [DVec2; 3] {
        let reach = match self.form {
            Form::Free => DVec2::ZERO,
            Form::Row { yaw_rad, length_m, width_m, .. } => {
                DVec2::from_angle(yaw_rad) * ((length_m - width_m) / 2.0).max(0.0)
            }
        };
        [self.position - reach, self.position, self.position + reach]
    }

    /// The corners of a row's piece; none of what is round.
    pub(super) fn corners(&self) -> Vec<DVec2> {
        let Form::Row { yaw_rad, length_m, width_m, .. } = self.form else { return Vec::new() };
        let along = DVec2::from_angle(yaw_rad);
        let [reach, side] = [along * length_m / 2.0, along.perp() * width_m / 2.0];
        [reach + side, reach - side, -reach + side, -reach - side].map(|d| self.position + d).into()
    }
}

/// Plants in the same large square are of one species.
pub(super) fn species_group(seed: Seed, p: DVec2) -> u64 {
    let cell = (p / SPECIES_SQUARE_M).floor();
    seed.child("species").nth(cell.x as i64 as u64).nth(cell.y as i64 as u64).0
}
