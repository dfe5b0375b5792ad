//! Where on earth a place is, as far as it tells how people build there.

use trove_model::MapProjection;

/// Parts of the world with habits of building in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Region {
    NorthAmerica,
    /// North of the Alps.
    NorthernEurope,
    /// Around the Mediterranean.
    Mediterranean,
    EastAsia,
    /// Between the tropics of the Old World.
    TropicalAsia,
    Elsewhere,
}

impl Region {
    /// By latitude and longitude, in boxes.
    pub(crate) fn of(projection: &MapProjection) -> Self {
        let (lat_deg, lon_deg) = (projection.origin_lat_deg, projection.origin_lon_deg);
        let within =
            |lat: [f64; 2], lon: [f64; 2]| (lat[0]..lat[1]).contains(&lat_deg) && (lon[0]..lon[1]).contains(&lon_deg);
        if within([24.0, 72.0], [-170.0, -50.0]) {
            Self::NorthAmerica
        } else if within([28.0, 45.5], [-12.0, 45.0]) {
            Self::Mediterranean
        } else if within([45.5, 72.0], [-12.0, 60.0]) {
            Self::NorthernEurope
        } else if within([20.0, 55.0], [100.0, 150.0]) {
            Self::EastAsia
        } else if within([-12.0, 30.0], [60.0, 155.0]) {
            Self::TropicalAsia
        } else {
            Self::Elsewhere
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn cities_lie_where_they_should() {
        let of = |origin_lat_deg, origin_lon_deg| {
            Region::of(&MapProjection { origin_lat_deg, origin_lon_deg, anchor_m: DVec2::ZERO })
        };
        assert_eq!(of(42.35, -71.05), Region::NorthAmerica);
        assert_eq!(of(43.74, 7.43), Region::Mediterranean);
        assert_eq!(of(52.47, 13.44), Region::NorthernEurope);
        assert_eq!(of(25.05, 121.52), Region::EastAsia);
        assert_eq!(of(1.3, 103.79), Region::TropicalAsia);
        assert_eq!(of(f64::NAN, 0.0), Region::Elsewhere);
    }
}
