//! From a city's frame to World.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use trove_model::{DatasetPlane, Ego, MapProjection, Outcome, Pose, Report, World};

use super::frames::{Axle, City};
use super::kinds::rows;
use crate::geodesy::Utm;

/// City, UTM zone, latitude and longitude of the frame's origin, a line each.
const CITIES: &str = include_str!("cities.tsv");

/// Height of the rear axle, and with it of the dataset's vehicle frame, over the road, metres: a tyre 225/50 R 17 of a Ford
/// Fusion has a radius of 0.328 m, less when loaded, and the axle of the Pittsburgh log stays 0.323 m (median) above the
/// dataset's own ground height.
pub(super) const AXLE_HEIGHT_M: f64 = 0.325;

/// Ego, which stands on the ground, in the dataset's vehicle frame.
pub(super) fn axle_from_ego() -> Pose<Axle, Ego> {
    Pose::new(DQuat::IDENTITY, DVec3::new(0.0, 0.0, -AXLE_HEIGHT_M))
}

/// Where a log lies in its city and the city on earth.
///
/// Convergence and scale are those of the UTM grid at the anchor: over a log of 500 m the first changes by 50 µrad and the
/// second by a millionth. Heights, boxes and points are true metres already.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CityFrame {
    plane: DatasetPlane,
    /// Height of World's origin in the city, metres.
    anchor_z_m: f64,
    /// `None` where the city is not known.
    pub(super) projection: Option<MapProjection>,
}

impl CityFrame {
    /// Of a log that begins at a position; a city whose origin is not known leaves World off the earth, which is reported.
    pub(super) fn new(city: Option<&str>, first_city_m: DVec3, report: &Report) -> Self {
        let anchor_city_m = first_city_m.round();
        let projection = city.and_then(|city| place(city, anchor_city_m.truncate()));
        if projection.is_none() {
            let example = city.unwrap_or("a log without a map, whose name would say");
            let what = "Argoverse 2 city of unknown origin: no street map can be aligned with the drive";
            report.note(Outcome::Warned, what, example);
        }
        let off_earth = DatasetPlane { origin_m: anchor_city_m.truncate(), turn_rad: 0.0, scale: 1.0 };
        let plane = projection.map_or(off_earth, |projection| projection.plane);
        Self { plane, anchor_z_m: anchor_city_m.z, projection }
    }

    /// A position in World.
    pub(super) fn world(&self, city_m: DVec3) -> DVec3 {
        self.plane.world(city_m.truncate()).extend(city_m.z - self.anchor_z_m)
    }

    /// The vehicle's frame in World.
    pub(super) fn world_from_axle(&self, city_from_axle: &Pose<City, Axle>) -> Pose<World, Axle> {
        let turn = DQuat::from_rotation_z(self.plane.turn_rad);
        Pose::new(turn * city_from_axle.rotation, self.world(city_from_axle.translation))
    }

    /// The vehicle, on the ground, in World.
    pub(super) fn world_from_ego(&self, city_from_axle: &Pose<City, Axle>) -> Pose<World, Ego> {
        self.world_from_axle(city_from_axle) * axle_from_ego()
    }
}

/// How World lies on earth whose origin is at a position in a city.
fn place(city: &str, origin_m: DVec2) -> Option<MapProjection> {
    let row = rows(CITIES).find(|row| row[0] == city)?;
    let number = |i: usize| row[i].parse::<f64>().ok();
    let utm = Utm::new(number(1)? as u32, false)?;
    let (lat_deg, lon_deg) = utm.geo_from_utm(utm.utm_from_geo(number(2)?, number(3)?)? + origin_m)?;
    let (turn_rad, scale) = utm.convergence_and_scale(lat_deg, lon_deg)?;
    let is_sane = turn_rad.abs() < TAU && (0.9..1.1).contains(&scale);
    let projection = MapProjection::ellipsoidal(lat_deg, lon_deg, DVec2::ZERO);
    is_sane.then_some(MapProjection { plane: DatasetPlane { origin_m, turn_rad, scale }, ..projection })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Positions in city frames and on earth that av2-api's own tests give (tests/unit/geometry/test_utm.py).
    const PUBLISHED: [(&str, [f64; 2], [f64; 2]); 5] = [
        ("ATX", [1745.37, -1421.37], [30.261642967615092, -97.72246957081633]),
        ("ATX", [1738.54, -1415.03], [30.26170086362131, -97.72253982250783]),
        ("ATX", [1731.53, -1410.81], [30.261739638233472, -97.72261222631731]),
        ("WDC", [1716.85, 4470.38], [38.9299801515994, -77.0168603173312]),
        ("WDC", [2139.70, 4606.14], [38.931286945069985, -77.0120195048271]),
    ];

    #[test]
    fn places_on_earth_are_those_that_the_dataset_s_tools_give() {
        for (city, [x, y], geo) in PUBLISHED {
            let report = Report::default();
            // From anchors half a kilometre off, the similarity holds to a centimetre.
            for off in [DVec3::ZERO, DVec3::new(300.0, -400.0, 7.0)] {
                let frame = CityFrame::new(Some(city), DVec3::new(x, y, 0.0) + off, &report);
                let (lat_deg, lon_deg) =
                    frame.projection.unwrap().geo_from_world(frame.world(DVec3::new(x, y, 0.0)).truncate());
                let off_m = DVec2::new((lon_deg - geo[1]) * geo[0].to_radians().cos(), lat_deg - geo[0]) * 111_200.0;
                assert!(off_m.length() < 0.02, "{city}: {off_m}");
            }
            assert!(report.entries().is_empty());
        }
    }

    #[test]
    fn every_city_has_an_origin_in_its_zone() {
        for row in rows(CITIES) {
            let projection = place(row[0], DVec2::ZERO).unwrap();
            let DatasetPlane { turn_rad: convergence_rad, scale, .. } = projection.plane;
            let zone = ((projection.origin_lon_deg + 180.0) / 6.0).floor() + 1.0;
            assert_eq!(zone.to_string(), row[1], "{}", row[0]);
            assert!(convergence_rad.abs() < 0.04 && (0.9995..1.0005).contains(&scale));
        }
    }

    #[test]
    fn an_unknown_city_is_reported_and_keeps_its_axes() {
        let report = Report::default();
        let frame = CityFrame::new(Some("XYZ"), DVec3::new(10.4, 20.0, 5.0), &report);
        assert_eq!((frame.world(DVec3::new(11.0, 22.0, 5.5)), frame.projection), (DVec3::new(1.0, 2.0, 0.5), None));
        assert_eq!(report.entries()[0].examples, ["XYZ"]);
    }
}
