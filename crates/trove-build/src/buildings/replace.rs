//! Building assets in place of plain rectangular buildings.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use trove_model::{Asset, AssetLibrary, BuildingCustoms, BuildingKind, Kind, Random, Tags};

use super::rectangle::{Base, base};
use super::volumes::House;
use crate::roads::{Footing, RoadSurfaces};

/// Of the buildings that could be replaced so many are; the rest keeps streets from repeating few models.
const SHARE: f64 = 0.75;
/// A footprint that fills less of its box is no rectangle.
const LEAST_FILLED: f64 = 0.94;
/// Assets stand alone: this far from their neighbours, metres.
const LEAST_ROOM_M: f64 = 0.25;
/// Higher buildings are landmarks, and no model is meant for them.
const HIGHEST_M: f64 = 25.0;
/// An asset is stretched by no more than this against its own proportions.
const STRETCH: f64 = 1.25;
/// Windows and doors of an asset that is scaled beyond this look wrong.
const SCALE: f64 = 1.5;

/// An asset and where it stands.
pub(super) struct Replacement<'a> {
    pub asset: &'a Asset,
    pub world_from_mesh: DAffine3,
}

/// The asset that fits a building best by 0.8 · error of aspect + 0.2 · error of volume, drawn for [`SHARE`] of the
/// rectangular ones that stand alone, its front to the street; `None` for all others, for those with parts, and for
/// those whose look the map describes.
pub(super) fn replacement<'a>(
    house: &House<'_>,
    library: &'a AssetLibrary,
    streets: &RoadSurfaces,
    random: &mut Random,
) -> Option<Replacement<'a>> {
    // Drawn first, so that the draw does not depend on the library.
    let drawn = random.chance(SHARE);
    let [volume] = house.volumes.as_slice() else { return None };
    let building = volume.building;
    let described = building.part
        || volume.bottom_m > 0.0
        || building.roof.is_some()
        || building.material.is_some()
        || building.color.is_some();
    let stands_alone = volume.sides.iter().all(|s| s.covers.is_empty() && s.room_m >= LEAST_ROOM_M);
    let is_plain = !volume.is_canopy && !volume.is_built_on && volume.footprint.holes.is_empty();
    if !drawn || described || !is_plain || !stands_alone || volume.top_m > HIGHEST_M {
        return None;
    }
    let base = base(&volume.footprint).filter(|b| b.filled >= LEAST_FILLED)?;
    // The front is the side, or of two like sides the one, that is nearest to a carriageway.
    let mut sides = [base.axis, base.axis.perp(), -base.axis, -base.axis.perp()];
    sides.sort_by(|a, b| street_distance_m(&base, *a, streets).total_cmp(&street_distance_m(&base, *b, streets)));
    let candidate = |asset: &'a Asset, front: DVec2| {
        let length_m =
            if front.dot(base.axis).abs() > 0.5 { base.size_m } else { DVec2::new(base.size_m.y, base.size_m.x) };
        let size_m = length_m.extend(volume.top_m);
        misfit(asset.size_m, size_m).map(|misfit| (misfit, asset, front, size_m))
    };
    let best = |front: DVec2| {
        let suitable = |a: &&Asset| suits(&a.tags, building.kind, house.customs);
        let fitting = library.of_kind(Kind::Building).filter(suitable).filter_map(|a| candidate(a, front));
        fitting.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (_, asset, front, size_m) = sides.into_iter().find_map(best)?;
    let world_from_mesh = DAffine3::from_scale_rotation_translation(
        size_m / asset.size_m,
        DQuat::from_rotation_z(front.y.atan2(front.x)),
        base.centre.extend(house.floor_m),
    );
    Some(Replacement { asset, world_from_mesh })
}

/// Whether a model with these tags may stand for a kind of building in a country; one without any of them may for all.
fn suits(tags: &Tags, kind: Option<BuildingKind>, customs: &BuildingCustoms) -> bool {
    use BuildingKind as K;
    let is_unknown = kind.is_none();
    let is = |kinds: &[K]| kind.is_some_and(|kind| kinds.contains(&kind));
    if tags.has("house") {
        kind.is_some_and(K::is_house) || (is(&[K::Terrace]) && tags.has("row")) || (is_unknown && customs.family_houses)
    } else if tags.has("apartments") {
        is(&[K::Apartments, K::Residential]) || is_unknown
    } else if tags.has("office") {
        is(&[K::Office, K::Commercial, K::Public]) || (is_unknown && customs.unknown_offices)
    } else if tags.has("warehouse") {
        kind.is_some_and(K::is_works)
    } else if tags.has("hotel") {
        is(&[K::Hotel])
    } else if tags.has("shops") {
        is(&[K::Retail, K::Commercial, K::Residential, K::Apartments]) || is_unknown
    } else {
        true
    }
}

/// How badly an asset fits a box; `None` where it would be stretched or scaled too much.
fn misfit(asset_m: DVec3, box_m: DVec3) -> Option<f64> {
    let scale = box_m / asset_m;
    let mean = scale.element_product().cbrt();
    let stretched = (scale / mean).max(mean / scale).max_element();
    if !(mean.is_finite() && stretched <= STRETCH && (1.0 / SCALE..=SCALE).contains(&mean)) {
        return None;
    }
    let volume = asset_m.element_product() / box_m.element_product();
    Some(0.8 * (stretched - 1.0) + 0.2 * (1.0 - volume.min(1.0 / volume)))
}

/// From the middle of a base's side to the first carriageway straight ahead, metres.
fn street_distance_m(base: &Base, side: DVec2, streets: &RoadSurfaces) -> f64 {
    let half_m = if side.dot(base.axis).abs() > 0.5 { base.size_m.x } else { base.size_m.y } / 2.0;
    let ahead = |i: &u32| streets.footing(base.centre + side * (half_m + f64::from(*i))) == Footing::Carriageway;
    (0..60).find(ahead).map_or(f64::INFINITY, f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn no_country_house_stands_in_a_business_park() {
        let suits = |tags: &[&str], kind, country| suits(&Tags::new(tags), kind, testing::building_customs(country));
        assert!(suits(&["house", "detached"], Some(BuildingKind::House), "SG"));
        assert!(suits(&["house", "detached"], None, "DE"));
        assert!(!suits(&["house", "detached"], None, "SG"));
        assert!(suits(&["house", "row"], Some(BuildingKind::Terrace), "SG"));
        assert!(!suits(&["house", "row"], Some(BuildingKind::Office), "US"));
        assert!(suits(&["office", "ribbon"], Some(BuildingKind::Office), "SG"));
        assert!(suits(&["building"], Some(BuildingKind::Office), "KE"));
    }

    #[test]
    fn what_a_library_is_called_says_nothing_of_its_buildings() {
        let asset = testing::asset("houses/tower", Kind::Building, [20.0, 15.0, 20.0]);
        use BuildingKind::{Apartments, Hotel, House, Office, Retail};
        for kind in [Apartments, Hotel, House, Office, Retail] {
            assert!(suits(&asset.tags, Some(kind), testing::building_customs("SG")), "{kind:?}");
        }
    }

    #[test]
    fn an_asset_is_never_stretched_beyond_a_quarter() {
        let asset = DVec3::new(10.0, 20.0, 12.0);
        assert_eq!(misfit(asset, asset), Some(0.0));
        assert!(misfit(asset, asset * 1.2).is_some());
        assert!(misfit(asset, asset * 2.0).is_none());
        assert!(misfit(asset, DVec3::new(10.0, 30.0, 12.0)).is_none());
        assert!(misfit(asset, DVec3::new(10.0, f64::NAN, 12.0)).is_none());
    }
}
