//! Lamps, signals, signs, fences, wires and what else stands along a street: where the map has them, and by rule, as the
//! region has them, where it does not.

mod along;
mod boundaries;
mod fronts;
mod junctions;
mod layer;
mod lines;
mod litter;
mod mapped;
mod names;
mod scaffolds;
mod shops;
mod signals;
mod signs;
#[cfg(test)]
mod tests;
mod wires;
mod yard;

use trove_model::Seed;

use crate::pieces::Piece;
use crate::pieces::Scenery;
use crate::place::Place;
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;
use yard::Yard;

/// The furniture of a place.
pub(crate) struct Furniture<'a> {
    /// Models of the library.
    pub scenery: Vec<Scenery<'a>>,
    /// What was built for the place: fences, wires, written signs.
    pub pieces: Vec<Piece>,
}

/// Furnishes a place: what is mapped comes first, then what has to be somewhere, then what may be anywhere.
pub(crate) fn furniture<'a>(around: &Surroundings<'a>, clearance: &mut Clearance, seed: Seed) -> Furniture<'a> {
    let Place { library, report, .. } = *around.place;
    let mut yard = Yard::new(around, library, clearance, seed);
    let junctions = junctions::junctions(around, report);
    mapped::place(&mut yard, report);
    signals::place(&junctions, &mut yard, seed.child("signals"), report);
    let mut pieces = lines::place(&mut yard, seed.child("lines"), report);
    pieces.extend(wires::place(&mut yard, seed.child("wires"), report));
    signs::place(&junctions, &mut yard, seed.child("signs"), report);
    pieces.extend(names::place(&junctions, &mut yard, report));
    scaffolds::place(&mut yard, seed.child("scaffolds"), report);
    shops::place(&mut yard, seed.child("shops"), report);
    along::furnish(&mut yard, seed.child("along"), report);
    litter::strew(&mut yard, seed.child("litter"), report);
    report.measure("furniture.placed", (yard.placed.len() + pieces.len()) as f64);
    Furniture { scenery: yard.placed, pieces }
}
