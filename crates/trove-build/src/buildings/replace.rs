//! Building assets in place of plain rectangular buildings.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use rayon::prelude::*;
use trove_model::{
    Asset, AssetLibrary, Bounds, BuildingCustoms, BuildingKind, Kind, Polygon, Report, Seed, Tags, weighted_at,
};

use super::bays::Bays;
use super::floor_plan::Plan;
use super::rectangle::{Base, base};
use super::volumes::{House, Model, Volume};
use crate::geometry::near::Near;
use crate::geometry::plane::intersection;
use crate::roads::{Footing, RoadSurfaces};

/// Of the buildings that could be replaced so many are; the rest keeps streets from repeating few models.
const SHARE: f64 = 0.75;
/// A footprint that fills less of its box is no rectangle.
const LEAST_FILLED: f64 = 0.94;
/// What a model stands for, and the model's own plan, fill so much of their boxes: it then covers what is mapped.
const WELL_FILLED: f64 = 0.97;
/// A model may reach into other buildings by this share of its box.
const OVERLAP_SHARE: f64 = 0.01;
/// Between a model and the walls that it touches, metres.
const APART_M: f64 = 0.01;
/// An asset is stretched by no more than this against its own proportions.
const STRETCH: f64 = 1.25;
/// Windows and doors of an asset that is scaled beyond this look wrong.
const SCALE: f64 = 1.4;
/// What fits worse than the best by no more than this fits as well.
const ABOUT_AS_GOOD: f64 = 0.06;

/// Gives a model to each of [`SHARE`] of the rectangular buildings that one fits: drawn among those that fit about as
/// well as the best by 0.8 · error of aspect + 0.2 · error of volume, its front to the street. Buildings with parts, and
/// those whose look the map describes, keep what they are.
pub(super) fn assign<'a>(
    houses: &mut [House<'a>],
    library: &'a AssetLibrary,
    streets: &RoadSurfaces,
    seed: Seed,
    report: &Report,
) {
    let buildings: Vec<&Asset> = library.of_kind(Kind::Building).collect();
    let plans = buildings.par_iter().filter_map(|asset| Plan::new(asset));
    let plans: Vec<Plan<'a>> = plans.filter(|plan| plan.filled >= WELL_FILLED).collect();
    let bounds = |house: &House<'_>| {
        let corners = house.volumes.iter().flat_map(|v| v.footprint.exterior.iter().copied());
        Bounds::around(corners)
    };
    let near = Near::new(houses.iter().map(bounds));
    let found: Vec<(bool, Option<Model<'a>>)> = houses
        .par_iter()
        .enumerate()
        .map(|(i, house)| {
            let Some(base) = rectangular(house) else { return (false, None) };
            let mut random = seed.nth(house.building.id as u64).random();
            // Drawn first, so that the draw does not depend on the library.
            let is_drawn = random.chance(SHARE);
            let plain = plain(house).filter(|_| is_drawn && base.filled >= WELL_FILLED);
            let model = plain.and_then(|volume| {
                let suitable = |p: &&Plan<'a>| suits(&p.asset.tags, volume.building.kind, house.customs);
                let suitable: Vec<&Plan<'a>> = plans.iter().filter(suitable).collect();
                let is_clear = |model: &Model<'_>| stands_clear(model, i, houses, &near);
                fitting(&suitable, &base, [house.floor_m, volume.top_m], streets, is_clear, random.unit())
            });
            (true, model)
        })
        .collect();
    report.measure("buildings.rectangular", found.iter().filter(|(is_rectangular, _)| *is_rectangular).count() as f64);
    for (house, (_, model)) in houses.iter_mut().zip(found) {
        house.model = model;
    }
}

/// The rectangle that a building's whole footprint nearly is.
fn rectangular(house: &House<'_>) -> Option<Base> {
    base(&house.building.footprint).filter(|b| b.filled >= LEAST_FILLED)
}

/// The one volume of a building of which the map tells no more than its kind and its height.
fn plain<'h, 'a>(house: &'h House<'a>) -> Option<&'h Volume<'a>> {
    let [volume] = house.volumes.as_slice() else { return None };
    let building = volume.building;
    let is_described = building.part
        || volume.bottom_m > 0.0
        || building.roof.is_some()
        || building.material.is_some()
        || building.color.is_some();
    let is_whole =
        volume.footprint.holes.is_empty() && volume.footprint.area_m2() > 0.99 * building.footprint.area_m2();
    (!is_described && is_whole && !volume.is_canopy && !volume.is_built_on).then_some(volume)
}

/// The box of a model on the ground.
pub(super) fn outline(model: &Model<'_>) -> Polygon {
    let (low, high) = model.asset.mesh.bounds().unwrap_or_default();
    let more = model.bays.more_m(model.asset) / 2.0;
    let (low, high) = (low.as_dvec3() - more, high.as_dvec3() + more);
    let corner = |x: f64, y: f64| model.world_from_mesh.transform_point3(DVec3::new(x, y, 0.0)).truncate();
    Polygon::simple(vec![corner(low.x, low.y), corner(high.x, low.y), corner(high.x, high.y), corner(low.x, high.y)])
}

/// Whether a model reaches into no other building.
fn stands_clear(model: &Model<'_>, index: usize, houses: &[House<'_>], near: &Near) -> bool {
    let own = [outline(model)];
    let Some(bounds) = own[0].bounds() else { return false };
    let others = near.at(bounds).filter(|&j| j != index).flat_map(|j| &houses[j].volumes);
    let shared = others.flat_map(|v| intersection(&own, std::slice::from_ref(&v.footprint)));
    shared.map(|p| p.area_m2()).sum::<f64>() <= OVERLAP_SHARE * own[0].area_m2()
}

/// The model for a base between two heights, drawn at `drawn`, 0 to 1.
fn fitting<'a>(
    plans: &[&Plan<'a>],
    base: &Base,
    [floor_m, high_m]: [f64; 2],
    streets: &RoadSurfaces,
    is_clear: impl Fn(&Model<'_>) -> bool,
    drawn: f64,
) -> Option<Model<'a>> {
    // The front is the side, or of two like sides the one, that is nearest to a carriageway.
    let mut sides = [base.axis, base.axis.perp(), -base.axis, -base.axis.perp()];
    sides.sort_by(|a, b| street_distance_m(base, *a, streets).total_cmp(&street_distance_m(base, *b, streets)));
    let best = |front: DVec2| {
        let is_end = front.dot(base.axis).abs() > 0.5;
        let plan_m = if is_end { DVec2::new(base.size_m.y, base.size_m.x) } else { base.size_m };
        let size_m = (plan_m - 2.0 * APART_M).extend(high_m);
        let fit = |plan: &&Plan<'a>| {
            let bays = Bays::for_size(plan.asset, plan.size_m, size_m);
            let own_m = plan.size_m + bays.more_m(plan.asset);
            let misfit = misfit(own_m, size_m)?;
            let scale = size_m / own_m;
            // Fronts of models look towards −y.
            let turn = DQuat::from_rotation_z(front.perp().to_angle());
            let centre = base.centre.extend(floor_m) - turn * (scale * plan.centre.extend(0.0));
            let world_from_mesh = DAffine3::from_scale_rotation_translation(scale, turn, centre);
            let model = Model { asset: plan.asset, bays, world_from_mesh };
            is_clear(&model).then_some((misfit, model))
        };
        let fits: Vec<(f64, Model<'a>)> = plans.iter().filter_map(fit).collect();
        let least = fits.iter().map(|f| f.0).fold(f64::INFINITY, f64::min);
        let good: Vec<Model<'a>> = fits.iter().filter(|f| f.0 <= least + ABOUT_AS_GOOD).map(|f| f.1).collect();
        let weights = good.iter().map(|model| f64::from(model.asset.commonness.max(0.0)));
        weighted_at(drawn, weights).and_then(|i| good.get(i).copied())
    };
    sides.into_iter().find_map(best)
}

/// What the words of a model's tags make it for.
const USES: [(&str, &[BuildingKind]); 15] = {
    use BuildingKind as K;
    [
        ("apartments", &[K::Apartments, K::Residential]),
        ("office", &[K::Office, K::Commercial, K::Public]),
        ("warehouse", &[K::Industrial, K::Warehouse, K::Hangar]),
        ("hotel", &[K::Hotel]),
        ("shops", &[K::Retail, K::Commercial, K::Residential, K::Apartments]),
        ("mall", &[K::Retail, K::Commercial]),
        ("market", &[K::Retail]),
        ("supermarket", &[K::Supermarket, K::Retail]),
        ("public", &[K::Public]),
        ("school", &[K::School]),
        ("university", &[K::University]),
        ("hospital", &[K::Hospital]),
        ("station", &[K::Transport]),
        ("parking", &[K::Parking]),
        ("garage", &[K::Garage]),
    ]
};

/// Whether a model with these tags may stand for a kind of building in a country; one without any of them may for all.
fn suits(tags: &Tags, kind: Option<BuildingKind>, customs: &BuildingCustoms) -> bool {
    let is_house = tags.has("house");
    let mut uses = USES.iter().filter(|(word, _)| tags.has(word)).peekable();
    if uses.peek().is_none() && !is_house {
        return true;
    }
    match kind {
        Some(kind) if is_house => kind.is_house() || kind == BuildingKind::Terrace && tags.has("row"),
        Some(kind) => uses.any(|(_, kinds)| kinds.contains(&kind)),
        // What is not told is mostly lived in, with shops below.
        None if is_house => customs.family_houses,
        None => uses.any(|(word, _)| match *word {
            "office" => customs.unknown_offices,
            word => ["apartments", "shops"].contains(&word),
        }),
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
