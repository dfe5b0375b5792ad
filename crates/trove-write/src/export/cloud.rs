//! A LiDAR's sweep with numbers of another class map.

use std::collections::HashMap;

use trove_model::{ClassMap, LidarPoint};

use crate::{StoredSweep, WriteError};

/// A sweep's points and the labels of each.
pub(super) struct Cloud {
    /// Where they come from.
    pub sweep: StoredSweep,
    /// The points.
    pub points: Vec<LidarPoint>,
    /// Number of each point's class.
    pub labels: Vec<u8>,
}

impl Cloud {
    /// Of a stored sweep, by a class map.
    pub(super) fn of(sweep: StoredSweep, map: &ClassMap) -> Result<Self, WriteError> {
        let points = sweep.points()?;
        let objects: HashMap<u32, u8> =
            (sweep.table.objects.iter()).map(|object| (object.id, map.object_id(object.class, object.kind))).collect();
        let label = |point: &LidarPoint| objects.get(&point.instance.0).copied().unwrap_or(map.id(point.class));
        let labels = points.iter().map(label).collect();
        Ok(Self { sweep, points, labels })
    }
}
