//! The recording's own map of the road.

use glam::{DVec2, DVec3};
use trove_format::{PlainLaneMap, PlainPolygon};
use trove_model::{Lane, LaneMap, LaneMark, Polygon};

use super::earth::{self, Earth};

/// The map in World; the error says what is wrong with it.
pub(super) fn lane_map(given: &PlainLaneMap, earth: &Earth) -> Result<LaneMap, String> {
    if !earth.has_world() {
        return Err("lane_map: expected none, since the georeference is wgs84 and its points are World's".to_owned());
    }
    let line = |key: &str, points: &[[f64; 2]], least: usize| -> Result<Vec<DVec2>, String> {
        if points.len() < least {
            return Err(format!("lane_map.{key}: expected lines of at least {least} points, found {}", points.len()));
        }
        let world = |&[x, y]: &[f64; 2]| {
            let point = earth.point(DVec3::new(x, y, 0.0)).truncate();
            earth::near(&format!("lane_map.{key}"), point.extend(0.0)).map(|()| point)
        };
        points.iter().map(world).collect()
    };
    let polygon = |key: &str, polygon: &PlainPolygon| -> Result<Polygon, String> {
        let holes = polygon.holes.iter().map(|hole| line(key, hole, 3)).collect::<Result<_, _>>()?;
        Ok(Polygon { exterior: line(key, &polygon.outline, 3)?, holes })
    };
    let polygons = |key: &str, given: &[PlainPolygon]| given.iter().map(|p| polygon(key, p)).collect::<Result<_, _>>();
    let lines = |key: &str, given: &[Vec<[f64; 2]>]| given.iter().map(|l| line(key, l, 2)).collect::<Result<_, _>>();
    let lanes = given.lanes.iter().map(|lane| {
        let centreline =
            if lane.centreline.is_empty() { vec![] } else { line("lanes.centreline", &lane.centreline, 2)? };
        Ok(Lane { token: lane.token.clone(), polygon: polygon("lanes", &lane.polygon)?, centreline })
    });
    let marks = given.marks.iter().map(|mark| {
        Ok(LaneMark { line: line("marks.line", &mark.line, 2)?, paint: mark.paint, pattern: mark.pattern })
    });
    let ground = given.ground.iter().map(|&point| {
        let world = earth.point(DVec3::from(point));
        earth::near("lane_map.ground", world).map(|()| world)
    });
    Ok(LaneMap {
        drivable: polygons("drivable", &given.drivable)?,
        lanes: lanes.collect::<Result<_, String>>()?,
        walkways: polygons("walkways", &given.walkways)?,
        crossings: polygons("crossings", &given.crossings)?,
        stop_lines: polygons("stop_lines", &given.stop_lines)?,
        carparks: polygons("carparks", &given.carparks)?,
        road_dividers: lines("road_dividers", &given.road_dividers)?,
        lane_dividers: lines("lane_dividers", &given.lane_dividers)?,
        marks: marks.collect::<Result<_, String>>()?,
        ground: ground.collect::<Result<_, String>>()?,
    })
}
