//! Auto-rickshaws, the three-wheeled taxis of South Asia; x = 0 is the front of the mudguard, as in a Bajaj RE.

mod body;
mod fittings;
mod hood;
mod inside;
mod measures;

use glam::{Vec3, vec3};
use trove_model::{Asset, Kind};

use super::plate::{PLATE_M, PlateDesign};
use super::workshop::Workshop;
use crate::countries::met_in;

/// The paints that the cities of a region prescribe.
struct Scheme {
    id: &'static str,
    body: &'static [Vec3],
    hood: &'static [Vec3],
    /// How far its headlamps are from the middle; 0 for a single one.
    lamps_m: f32,
    commonness: f32,
}

const BLACK: Vec3 = vec3(0.016, 0.016, 0.017);
const YELLOWS: [Vec3; 3] = [vec3(0.68, 0.41, 0.02), vec3(0.62, 0.43, 0.04), vec3(0.56, 0.34, 0.03)];
const GREENS: [Vec3; 3] = [vec3(0.02, 0.17, 0.06), vec3(0.03, 0.21, 0.09), vec3(0.015, 0.12, 0.06)];

const SCHEMES: [Scheme; 3] = [
    // As in Hyderabad and Chennai.
    Scheme { id: "car/auto-rickshaw", body: &YELLOWS, hood: &[BLACK], lamps_m: 0.3, commonness: 3.5 },
    // As in Mumbai.
    Scheme { id: "car/auto-rickshaw-black", body: &[BLACK], hood: &YELLOWS, lamps_m: 0.0, commonness: 1.5 },
    // As in Delhi and Bangalore: they run on gas.
    Scheme { id: "car/auto-rickshaw-green", body: &GREENS, hood: &YELLOWS, lamps_m: 0.3, commonness: 3.0 },
];

/// Every auto-rickshaw.
pub(super) fn assets() -> Vec<Asset> {
    SCHEMES.iter().map(Scheme::asset).collect()
}

impl Scheme {
    fn asset(&self) -> Asset {
        let plate = PlateDesign {
            name: "plate/rickshaw".into(),
            size_m: PLATE_M.to_array(),
            text: "TRV 00 X 0000".into(),
            ink: [0.01, 0.01, 0.011],
            // What carries passengers for hire has yellow plates.
            ground: [0.62, 0.43, 0.02],
            field: None,
        };
        let mut work = Workshop::with(self.id, self.body, 0.0, self.hood, plate.material());
        let cowl = body::build(&mut work);
        hood::build(&mut work);
        inside::build(&mut work);
        fittings::build(&mut work, &cowl, self.lamps_m);
        let asset = work.asset(Kind::Car);
        Asset { commonness: self.commonness, countries: met_in("auto-rickshaw"), ..asset }.tagged(["auto-rickshaw"])
    }
}
