//! Which part of the earth a recipe's scenes need.

use anyhow::{Result, ensure};
use trove_model::{Bounds, MapProjection};
use trove_read::osm::GeoExtent;

/// Beyond what is built, metres: the map is moved by a few metres to lie on the recording.
const MARGIN_M: f64 = 100.0;
/// Edges lie on multiples of this, so that the same scene always asks for the same box: 11 m.
const STEP_DEG: f64 = 1e-4;
/// Public servers are not there for more than a part of a city, km².
const MOST_KM2: f64 = 100.0;
/// Names of scenes that are printed.
const TOLD: usize = 3;
/// Mean radius of the earth, kilometres.
const EARTH_RADIUS_KM: f64 = 6371.0;

/// A rectangle that some scenes need a map of.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapBox {
    pub(super) extent: GeoExtent,
    pub(super) scenes: Vec<String>,
}

impl MapBox {
    /// Its area on the earth.
    pub(super) fn km2(&self) -> f64 {
        let GeoExtent { min_lat_deg, max_lat_deg, min_lon_deg, max_lon_deg } = self.extent;
        let height = max_lat_deg.to_radians().sin() - min_lat_deg.to_radians().sin();
        EARTH_RADIUS_KM.powi(2) * height * (max_lon_deg - min_lon_deg).to_radians()
    }

    /// Its scenes in words.
    pub(super) fn told_scenes(&self) -> String {
        let more = self.scenes.len().saturating_sub(TOLD);
        let told = self.scenes[..self.scenes.len() - more].join(", ");
        if more > 0 { format!("{told} and {more} more") } else { told }
    }

    fn overlaps(&self, other: &Self) -> bool {
        let (a, b) = (&self.extent, &other.extent);
        let [width_a, width_b] = [a, b].map(|e| e.max_lon_deg - e.min_lon_deg);
        // How far the other one begins to the east, once around the earth.
        let east = (b.min_lon_deg - a.min_lon_deg).rem_euclid(360.0);
        let in_lon = east <= width_a || 360.0 - east <= width_b;
        in_lon && a.min_lat_deg <= b.max_lat_deg && b.min_lat_deg <= a.max_lat_deg
    }

    fn join(&mut self, other: Self) {
        let (a, b) = (&self.extent, &other.extent);
        // Both are near each other, maybe on the two sides of the antimeridian.
        let turns = ((a.min_lon_deg - b.min_lon_deg) / 360.0).round() * 360.0;
        let (west, east) = (a.min_lon_deg.min(b.min_lon_deg + turns), a.max_lon_deg.max(b.max_lon_deg + turns));
        let whole = if west < -180.0 { 360.0 } else { 0.0 };
        self.extent = GeoExtent {
            min_lat_deg: a.min_lat_deg.min(b.min_lat_deg),
            max_lat_deg: a.max_lat_deg.max(b.max_lat_deg),
            min_lon_deg: west + whole,
            max_lon_deg: east + whole,
        };
        self.scenes.extend(other.scenes);
    }
}

/// What one scene needs.
pub(super) fn needed(scene: &str, projection: &MapProjection, area: Bounds) -> Result<MapBox> {
    let is_known = (projection.origin_lat_deg, projection.origin_lon_deg) != (0.0, 0.0);
    ensure!(
        is_known,
        "{scene}: expected a drive whose place on earth is known, found none; no map can be fetched for it"
    );
    let exact = GeoExtent::of_bounds(projection, area.grown(MARGIN_M));
    let down = |deg: f64| ((deg / STEP_DEG).floor() * STEP_DEG * 1e4).round() / 1e4;
    let up = |deg: f64| ((deg / STEP_DEG).ceil() * STEP_DEG * 1e4).round() / 1e4;
    let extent = GeoExtent {
        min_lat_deg: down(exact.min_lat_deg),
        max_lat_deg: up(exact.max_lat_deg),
        min_lon_deg: down(exact.min_lon_deg),
        max_lon_deg: up(exact.max_lon_deg),
    };
    let is_on_earth = extent.min_lat_deg >= -90.0 && extent.max_lat_deg <= 90.0;
    ensure!(is_on_earth, "{scene}: expected a place on earth, found {extent}");
    Ok(MapBox { extent, scenes: vec![scene.to_owned()] })
}

/// The same with those that overlap made one, until none does.
pub(super) fn merged(boxes: Vec<MapBox>) -> Result<Vec<MapBox>> {
    let mut apart: Vec<MapBox> = Vec::new();
    for mut next in boxes {
        while let Some(i) = apart.iter().position(|other| other.overlaps(&next)) {
            let mut other = apart.remove(i);
            other.join(next);
            next = other;
        }
        apart.push(next);
    }
    for map_box in &apart {
        ensure!(
            map_box.km2() <= MOST_KM2,
            "expected at most {MOST_KM2} km² at a time, found {:.0} km² ({}) for {}; name fewer scenes in drive.scenes, \
             or give map.osm an extract of the region (.osm.pbf)",
            map_box.km2(),
            map_box.extent,
            map_box.told_scenes()
        );
    }
    Ok(apart)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    fn at(lat_deg: f64, lon_deg: f64, size_m: f64) -> MapBox {
        let projection = MapProjection::spherical(lat_deg, lon_deg, DVec2::ZERO);
        needed(&format!("{lat_deg} {lon_deg}"), &projection, Bounds::square(DVec2::ZERO, size_m)).unwrap()
    }

    #[test]
    fn a_box_is_what_is_built_with_a_margin_on_a_grid() {
        let GeoExtent { min_lat_deg, max_lat_deg, min_lon_deg, max_lon_deg } = at(60.0, 25.0, 400.0).extent;
        // 300 m are 0.002695° of latitude and twice that of longitude at 60° north.
        assert_eq!([min_lat_deg, max_lat_deg, min_lon_deg, max_lon_deg], [59.9973, 60.0027, 24.9946, 25.0054]);
        assert!((at(60.0, 25.0, 400.0).km2() - 0.6 * 0.6).abs() < 0.01);
        assert!(
            needed("a", &MapProjection::spherical(0.0, 0.0, DVec2::ZERO), Bounds::square(DVec2::ZERO, 10.0)).is_err()
        );
    }

    #[test]
    fn boxes_that_overlap_become_one_until_none_does() {
        let apart = merged(vec![at(60.0, 25.0, 400.0), at(1.3, 103.8, 400.0), at(60.0, 25.02, 400.0)]).unwrap();
        assert_eq!(apart.len(), 3);
        // The third joins the first two, which are apart.
        let chain = merged(vec![at(60.0, 25.0, 400.0), at(60.0, 25.016, 400.0), at(60.0, 25.008, 400.0)]).unwrap();
        assert_eq!((chain.len(), chain[0].scenes.len()), (1, 3));
        assert_eq!((chain[0].extent.min_lon_deg, chain[0].extent.max_lon_deg), (24.9946, 25.0214));
        assert_eq!(chain[0].told_scenes(), "60 25.016, 60 25, 60 25.008");
    }

    #[test]
    fn a_place_at_the_antimeridian_is_one_box() {
        let joined = merged(vec![at(-17.0, 179.999, 400.0), at(-17.0, -179.999, 400.0)]).unwrap();
        assert_eq!(joined.len(), 1);
        let extent = joined[0].extent;
        assert!(extent.min_lon_deg > 179.9 && extent.max_lon_deg < 180.1 && joined[0].km2() < 1.0, "{extent}");
    }

    #[test]
    fn a_box_as_large_as_a_country_is_refused_with_what_to_do() {
        let wide = MapBox {
            extent: GeoExtent { min_lat_deg: -90.0, max_lat_deg: 90.0, min_lon_deg: -180.0, max_lon_deg: 180.0 },
            scenes: (0..5).map(|i| i.to_string()).collect(),
        };
        assert!((wide.km2() / 510e6 - 1.0).abs() < 0.01, "the earth's surface");
        let error = merged(vec![wide]).unwrap_err().to_string();
        assert!(
            error.contains("100 km²") && error.contains("0, 1, 2 and 2 more") && error.contains("drive.scenes"),
            "{error}"
        );
    }
}
