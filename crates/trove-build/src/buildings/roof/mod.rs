//! Roofs.

mod canopy;
mod edges;
mod fill;
mod fittings;
mod flat;
mod materials;
mod pitched;
mod plant;
mod rings;
mod skeleton;
#[cfg(test)]
mod tests;

use trove_model::{Outcome, Random, Report, RoofShape};

use super::shell::Shell;
use super::volumes::{EAVES_SEEN_M, House, Volume, name};
pub(super) use canopy::canopy;
pub(super) use materials::materials;

/// Gutters and ridge tiles are seen up to the first distance from the driven path, what stands on flat roofs up to the
/// second, metres.
const FINE_SEEN_M: f64 = 90.0;
const PLANT_SEEN_M: f64 = 300.0;

/// Puts a volume's roof on, with gables and all that stands above the walls, and says how high in World its walls
/// must be.
pub(super) fn roof(
    shell: &mut Shell,
    volume: &Volume<'_>,
    house: &House<'_>,
    random: &mut Random,
    report: &Report,
) -> f64 {
    let (eaves, top) = (house.floor_m + volume.eaves_m, house.floor_m + volume.top_m);
    let footprint = &volume.footprint;
    if volume.is_built_on {
        shell.cover(super::shell::Slot::FlatRoof, std::slice::from_ref(footprint), |_| top, true);
        return top;
    }
    if volume.roof == RoofShape::Flat || top - eaves < 0.1 {
        let deck = flat::flat(shell, footprint, house.floor_m + volume.bottom_m, top, random);
        let Some((areas, z)) = deck else { return top };
        if house.path_m < PLANT_SEEN_M && !volume.is_canopy {
            plant::plant(shell, &areas, z, volume, house, random);
        }
        return z;
    }
    if volume.roof == RoofShape::Skillion {
        flat::skillion(shell, footprint, volume.building.roof_direction_rad, eaves, top);
        return eaves;
    }
    let is_round = matches!(volume.roof, RoofShape::Pyramidal | RoofShape::Cone | RoofShape::Dome | RoofShape::Onion);
    if is_round && rings::rings(shell, footprint, volume.roof, eaves, top) {
        return eaves;
    }
    let Some(pitched) = pitched::pitched(volume, volume.roof, eaves, top) else {
        let what = format!("{:?} roof on a footprint that cannot carry it, built flat", volume.roof);
        report.note(Outcome::Substituted, &what, name(volume.building));
        let level = (eaves + top) / 2.0;
        let deck = flat::flat(shell, footprint, house.floor_m + volume.bottom_m, level, random);
        return deck.map_or(level, |(_, z)| z);
    };
    if pitched.became != volume.roof || matches!(volume.roof, RoofShape::Cone | RoofShape::Onion) {
        let what = format!("{:?} roof on a footprint that cannot carry it, built as its nearest form", volume.roof);
        report.note(Outcome::Substituted, &what, name(volume.building));
    }
    pitched.cover(shell);
    if house.path_m < EAVES_SEEN_M {
        edges::edges(shell, &pitched, volume, house.path_m < FINE_SEEN_M);
        fittings::fittings(shell, &pitched, volume, house, random);
    }
    eaves
}
