//! Which country a point lies in.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use country_boundaries::{BOUNDARIES_ODBL_180X90, BoundingBox, CountryBoundaries, LatLon};

/// A place at sea follows the nearest country within the last of these, kilometres.
const REACHES_KM: [f64; 9] = [1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 70.0, 120.0, 200.0];
/// In so many directions.
const DIRECTIONS: usize = 24;
const KM_PER_DEG: f64 = 111.2;

static BORDERS: LazyLock<CountryBoundaries> = LazyLock::new(|| {
    CountryBoundaries::from_reader(BOUNDARIES_ODBL_180X90).expect("the crate's own data are read by its own reader")
});

/// The country of a point.
pub(super) enum Finding {
    /// The point lies within its borders.
    Inside(&'static str),
    /// It is the nearest one.
    Near(&'static str),
    /// There is none near.
    Nowhere,
}

/// The smallest area around a point that `is_known`.
pub(super) fn country(lat_deg: f64, lon_deg: f64, is_known: impl Fn(&str) -> bool) -> Finding {
    let at = |lat_deg: f64, lon_deg: f64| {
        let lon_deg = (lon_deg + 180.0).rem_euclid(360.0) - 180.0;
        let position = LatLon::new(lat_deg.clamp(-90.0, 90.0), lon_deg).ok()?;
        BORDERS.ids(position).into_iter().find(|code| is_known(code))
    };
    if !(lat_deg.is_finite() && lon_deg.is_finite()) {
        return Finding::Nowhere;
    }
    if let Some(code) = at(lat_deg, lon_deg) {
        return Finding::Inside(code);
    }
    // Meridians meet at the poles, where there is no country to the east or west.
    let lon_per_km = 1.0 / (KM_PER_DEG * lat_deg.to_radians().cos().max(0.05));
    let around = REACHES_KM.into_iter().find_map(|reach_km| {
        (0..DIRECTIONS).find_map(|i| {
            let (north, east) = (std::f64::consts::TAU * i as f64 / DIRECTIONS as f64).sin_cos();
            at(lat_deg + north * reach_km / KM_PER_DEG, lon_deg + east * reach_km * lon_per_km)
        })
    });
    around.map_or(Finding::Nowhere, Finding::Near)
}

/// The codes of all areas: countries by ISO 3166-1, their parts by ISO 3166-2.
pub(super) fn codes() -> BTreeSet<&'static str> {
    let halves = [[-180.0, 0.0], [0.0, 179.999]];
    let boxes = halves.into_iter().filter_map(|[west, east]| BoundingBox::new(-90.0, west, 90.0, east).ok());
    boxes.flat_map(|bounds| BORDERS.intersecting_ids(bounds)).collect()
}
