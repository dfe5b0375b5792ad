//! Space around the vehicle in equal cells, and what fills them.

use std::sync::Arc;

use glam::DVec3;

use crate::{ClassMap, Ego, InstanceId, LidarShot, Pose, SensorFrame, Shot, World};

/// Cubes in a box whose sides run along the axes of a frame. Cell `[x, y, z]` begins at `low_m + voxel_m · [x, y, z]` and does
/// not reach the next one's beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelGrid {
    /// The lowest corner, metres.
    pub low_m: DVec3,
    /// Side of a cube, metres.
    pub voxel_m: f64,
    /// Cells along x, y and z.
    pub counts: [usize; 3],
}

impl VoxelGrid {
    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Whether it has no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The place of a cell in lists of all: z changes fastest, x slowest, as in a NumPy array of `counts`.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.counts[1] + y) * self.counts[2] + z
    }

    /// The cell at a place in such lists.
    pub fn cell(&self, index: usize) -> [usize; 3] {
        let [_, y, z] = self.counts;
        [index / (y * z), index / z % y, index % z]
    }

    /// The middle of a cell, metres.
    pub fn centre_m(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        self.low_m + (DVec3::new(x as f64, y as f64, z as f64) + 0.5) * self.voxel_m
    }

    /// Cells along x, y and z as a vector.
    pub fn size(&self) -> DVec3 {
        DVec3::from_array(self.counts.map(|count| count as f64))
    }
}

/// Which axes a grid has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridFrame {
    /// The vehicle's.
    Ego,
    /// Those of its LiDAR, of the first where it has several.
    Lidar,
}

/// How a grid is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridForm {
    /// An array of all cells, as Occ3D's.
    Dense,
    /// A list of those that are not free, as OpenOccupancy's, with masks of all.
    Sparse,
}

impl GridForm {
    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dense => "dense",
            Self::Sparse => "sparse",
        }
    }
}

/// A grid that goes with the vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct GridPlan {
    /// The preset or the name of its file.
    pub name: String,
    /// Its cells.
    pub grid: VoxelGrid,
    /// The frame whose axes they follow.
    pub frame: GridFrame,
    /// What cells are called; its number for what is unlabelled is that of free ones.
    pub classes: ClassMap,
    /// Whether the inside of objects is filled as well as their surface.
    pub is_solid: bool,
    /// How it is written.
    pub form: GridForm,
}

/// A grid to be filled: where it is at the moment of a scene, and who looks into it.
#[derive(Clone, Debug, PartialEq)]
pub struct GridShot {
    /// Name of its folder (`ego.OCC3D`).
    pub view: String,
    /// The grid.
    pub plan: Arc<GridPlan>,
    /// The frame that its axes are of.
    pub world_from_grid: Pose<World, SensorFrame>,
    /// The vehicle at that moment.
    pub world_from_ego: Pose<World, Ego>,
    /// The moment of the scene, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// The vehicle around which it is, which fills no cell.
    pub absent: Option<InstanceId>,
    /// Cameras that look into it.
    pub cameras: Vec<Shot>,
    /// LiDARs that look into it.
    pub lidars: Vec<LidarShot>,
    /// The bits of the [`MapLayer`](crate::MapLayer)s of each column of cells; y changes fastest.
    pub map: Vec<u8>,
}

/// What fills the cells of a grid, one entry a cell in the order of [`VoxelGrid::index`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Occupancy {
    /// Numbers of the grid's class map.
    pub labels: Vec<u8>,
    /// The object; 0 for stuff and free cells.
    pub instances: Vec<InstanceId>,
    /// Whether a camera sees into the cell.
    pub seen_by_cameras: Vec<bool>,
    /// Whether a LiDAR does.
    pub seen_by_lidars: Vec<bool>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_counted_as_numpy_counts() {
        let grid = VoxelGrid { low_m: DVec3::new(-40.0, -40.0, -1.0), voxel_m: 0.4, counts: [200, 200, 16] };
        assert_eq!(
            (grid.len(), grid.index([0, 0, 1]), grid.index([0, 1, 0]), grid.index([1, 0, 0])),
            (640_000, 1, 16, 3200)
        );
        for index in [0, 17, 3_201, 639_999] {
            assert_eq!(grid.index(grid.cell(index)), index);
        }
        assert!((grid.centre_m([100, 100, 2]) - DVec3::new(0.2, 0.2, 0.0)).length() < 1e-12);
    }
}
