//! Point Cloud Library's PCD, version 0.7, binary.

use super::cloud::Cloud;
use super::geometry::{affine, quaternion_wxyz};

/// Names, bytes and types of a point's fields.
const FIELDS: [Field; 9] = [
    ("x", 4, 'F'),
    ("y", 4, 'F'),
    ("z", 4, 'F'),
    ("intensity", 4, 'F'),
    ("ring", 2, 'U'),
    ("time", 4, 'F'),
    ("return", 1, 'U'),
    ("label", 4, 'U'),
    ("instance", 4, 'U'),
];
/// x, y, z and a quaternion w, x, y, z: World.
pub(super) const UNMOVED: [f64; 7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];

/// Name, bytes, and type: `F` float, `I` signed, `U` unsigned.
pub(super) type Field = (&'static str, u8, char);

/// What stands before the points; the viewpoint leads from their axes to those in which the sensor's pose is told.
pub(super) fn header(fields: &[Field], points: usize, viewpoint: [f64; 7]) -> Vec<u8> {
    let column = |of: fn(&Field) -> String| fields.iter().map(of).collect::<Vec<_>>().join(" ");
    let (names, sizes, types) =
        (column(|field| field.0.into()), column(|field| field.1.to_string()), column(|field| field.2.to_string()));
    let (ones, viewpoint) = (column(|_| "1".into()), viewpoint.map(|number| number.to_string()).join(" "));
    format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {names}\nSIZE {sizes}\nTYPE {types}\nCOUNT {ones}\n\
         WIDTH {points}\nHEIGHT 1\nVIEWPOINT {viewpoint}\nPOINTS {points}\nDATA binary\n"
    )
    .into_bytes()
}

/// A sweep's file.
pub(super) fn file(cloud: &Cloud) -> Vec<u8> {
    let world_from_lidar = affine(&cloud.sweep.table.world_from_lidar);
    let (place, [w, i, j, k]) = (world_from_lidar.translation, quaternion_wxyz(&world_from_lidar));
    let mut bytes = header(&FIELDS, cloud.points.len(), [place.x, place.y, place.z, w, i, j, k]);
    for (point, label) in cloud.points.iter().zip(&cloud.labels) {
        let p = point.position_m;
        let floats = [p.x as f32, p.y as f32, p.z as f32, f32::from(point.intensity)];
        bytes.extend(floats.map(f32::to_le_bytes).as_flattened());
        bytes.extend(point.ring.to_le_bytes());
        bytes.extend((point.time_s as f32).to_le_bytes());
        bytes.push(point.number);
        bytes.extend([u32::from(*label), point.instance.0].map(u32::to_le_bytes).as_flattened());
    }
    bytes
}
