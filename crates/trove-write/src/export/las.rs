//! ASPRS's LAS 1.4 with points of format 6, in World.

use std::io::Cursor;

use las::point::{Classification, Format};
use las::{Builder, GpsTimeType, Point, Transform, Vector, Vlr, Writer};
use trove_format::SweepTable;
use trove_model::LidarPoint;

use super::cloud::Cloud;
use super::geometry::affine;
use crate::WriteError;

/// What GPS time is ahead of UTC, from when on.
const LEAP_SECONDS: &str = include_str!("leap_seconds.tsv");
/// The beginning of GPS time, seconds since 1970 UTC.
const GPS_BEGINS_S: i64 = 315_964_800;
/// What the form takes off GPS time, so that fractions of a second stay exact.
const ADJUSTED_S: i64 = 1_000_000_000;
/// Steps of coordinates, metres.
const STEP_M: f64 = 0.001;
/// The form's record that tells of bytes beyond a format's own, and two of its types.
const EXTRA_BYTES: u16 = 4;
const U16: u8 = 3;
const U32: u8 = 5;
/// The form's record of a coordinate system in well-known text.
const WELL_KNOWN_TEXT: u16 = 2112;

/// A sweep's file.
pub(super) fn file(cloud: &Cloud) -> Result<Vec<u8>, WriteError> {
    written(cloud).map_err(|e| WriteError::Encoding { name: "a sweep as LAS".into(), found: e.to_string() })
}

fn written(cloud: &Cloud) -> las::Result<Vec<u8>> {
    let table = &cloud.sweep.table;
    let mut header = Builder::from((1, 4));
    header.generating_software = "TRoVE".into();
    header.system_identifier = table.lidar.chars().take(32).collect();
    header.gps_time_type = GpsTimeType::Standard;
    header.has_wkt_crs = true;
    header.point_format = Format { extra_bytes: 6, ..Format::new(6)? };
    header.transforms = Vector { x: STEP, y: STEP, z: STEP };
    let record = |user_id: &str, record_id, description: &str, data| Vlr {
        user_id: user_id.into(),
        record_id,
        description: description.into(),
        data,
    };
    let extra = [extra("ring", "from 0", U16), extra("instance", "0 for what is not counted", U32)].concat();
    header.vlrs = vec![
        record("LASF_Projection", WELL_KNOWN_TEXT, "World", world(table).into_bytes()),
        record("LASF_Spec", EXTRA_BYTES, "ring and instance", extra),
    ];
    let mut writer = Writer::new(Cursor::new(Vec::new()), header.into_header()?)?;
    let world_from_lidar = affine(&table.world_from_lidar);
    let returns = returns(&cloud.points);
    for ((point, label), of) in cloud.points.iter().zip(&cloud.labels).zip(returns) {
        let place = world_from_lidar.transform_point3(point.position_m);
        let mut extra_bytes = point.ring.to_le_bytes().to_vec();
        extra_bytes.extend(point.instance.0.to_le_bytes());
        writer.write_point(Point {
            x: place.x,
            y: place.y,
            z: place.z,
            // The whole of the field, as the form asks for.
            intensity: u16::from(point.intensity) * 257,
            return_number: point.number + 1,
            number_of_returns: of,
            classification: Classification::new(*label)?,
            gps_time: Some(gps_s(table.time_ns, point.time_s)),
            extra_bytes,
            ..Point::default()
        })?;
    }
    Ok(writer.into_inner()?.into_inner())
}

const STEP: Transform = Transform { scale: STEP_M, offset: 0.0 };

/// How many returns of each point's beam are told; those of one follow each other.
fn returns(points: &[LidarPoint]) -> Vec<u8> {
    let beams = points.chunk_by(|_, next| next.number > 0);
    beams.flat_map(|beam| vec![beam.len() as u8; beam.len()]).collect()
}

/// A time in adjusted standard GPS time, seconds.
fn gps_s(time_ns: i64, after_s: f64) -> f64 {
    let unix_s = time_ns.div_euclid(1_000_000_000);
    let row =
        |line: &str| line.split_once('\t').and_then(|(from, ahead)| Some((from.parse().ok()?, ahead.parse().ok()?)));
    let mut rows = LEAP_SECONDS.lines().filter_map(row).filter(|(from, _): &(i64, i64)| *from <= unix_s);
    let ahead_s = rows.next_back().map_or(0, |(_, ahead_s)| ahead_s);
    let whole_s = unix_s + ahead_s - GPS_BEGINS_S - ADJUSTED_S;
    whole_s as f64 + time_ns.rem_euclid(1_000_000_000) as f64 * 1e-9 + after_s
}

/// World as an engineering system, whose datum says where it is.
fn world(table: &SweepTable) -> String {
    let (lat, lon) = (table.projection.origin_lat_deg, table.projection.origin_lon_deg);
    format!(
        "LOCAL_CS[\"TRoVE World of {}\",LOCAL_DATUM[\"Plane at latitude {lat}, longitude {lon}\",0],UNIT[\"metre\",1],\
         AXIS[\"East\",EAST],AXIS[\"North\",NORTH]]",
        table.scene
    )
}

/// What tells of one number beyond the format's own.
fn extra(name: &str, description: &str, kind: u8) -> Vec<u8> {
    let text = |text: &str, bytes: usize| {
        let mut field = text.as_bytes().to_vec();
        field.resize(bytes, 0);
        field
    };
    [vec![0, 0, kind, 0], text(name, 32), vec![0; 4 + 5 * 24], text(description, 32)].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Class, InstanceId};

    #[test]
    fn gps_time_is_as_many_leap_seconds_ahead_as_there_had_been() {
        // The form's zero is 2011-09-14 01:46:40 GPS, which was 15 s earlier in UTC.
        assert_eq!(gps_s(1_315_964_785_000_000_000, 0.0), 0.0);
        // 2018-07-24 03:28:47.647951 UTC, when GPS time was 18 s ahead.
        assert!((gps_s(1_532_402_927_647_951_000, -0.05) - 216_438_145.597_951).abs() < 1e-6);
    }

    #[test]
    fn returns_of_a_beam_are_counted_together() {
        let point = |number| LidarPoint {
            position_m: glam::DVec3::ZERO,
            intensity: 0,
            ring: 0,
            number,
            time_s: 0.0,
            class: Class::Road,
            instance: InstanceId(0),
        };
        assert_eq!(returns(&[0, 0, 1, 0, 1, 0].map(point)), [1, 2, 2, 2, 2, 1]);
        assert!(returns(&[]).is_empty());
    }
}
