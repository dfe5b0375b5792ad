//! Vegetation as the LiDAR saw it.
//!
//! Where the dataset labels its points, those of vegetation count. Elsewhere geometry decides: leaves scatter the beam
//! in all directions, while walls, cars and the ground give planes, and poles and edges give lines.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use trove_model::{Cuboid, Keyframe, Kind, LidarClass, Seed};

use super::columns::Columns;
use super::wish::{Wish, species_group};
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;

/// Points further from the sensor are too few to tell, metres.
const REACH_M: f64 = 50.0;
/// Within this of the sensor the LiDAR knows what there is, metres.
const COVER_M: f64 = 40.0;
/// The recording vehicle's own surfaces, metres.
const OWN_BODY_M: f64 = 2.5;
/// Grass and kerbs are below, crowns beyond any tree above, metres over the ground.
const HEIGHTS_M: std::ops::Range<f64> = 0.35..30.0;
/// Below this a point may be a bush's, metres.
const BUSH_TOP_M: f64 = 2.0;
/// Columns higher than this are trees, metres.
const TREE_TOP_M: f64 = 2.8;
/// Side of the cubes that geometry is judged in, metres.
const VOXEL_M: f64 = 1.5;
/// Fewer points in a cube tell nothing.
const MIN_POINTS: u32 = 5;
/// Foliage: its thinnest extent (standard deviation) is at least this, metres, and this share of its widest.
const MIN_DEPTH_M: f64 = 0.075;
const MIN_DEPTH_SHARE: f64 = 0.2;
/// Side of the density map's cells, metres.
const CELL_M: f64 = 1.0;
/// A point this far away has mass 1; masses grow with the square of the distance as points thin out.
const UNIT_RANGE_M: f64 = 10.0;
/// A square metre with this mass is dense: it surely carries a plant.
const DENSE: f64 = 25.0;
/// A square metre with less is noise.
const THIN: f64 = 3.0;
/// Crowns that reach this near to the highest beam go on above it, radians.
const BEAM_EDGE_RAD: f64 = 0.03;

/// The vegetation that the LiDAR saw.
pub(super) struct Seen {
    columns: Columns,
    /// Where the sensor was.
    origins: Vec<DVec2>,
}

/// A point that may be a leaf.
#[derive(Clone, Copy)]
struct Leaf {
    position: DVec3,
    above_m: f64,
    mass: f64,
    /// Near the highest beam.
    cut: bool,
    labelled: bool,
}

impl Seen {
    /// Gathers the points of all sweeps.
    pub(super) fn new(around: &Surroundings, clearance: &Clearance) -> Self {
        let keyframes: Vec<&Keyframe> = around.place.drive.keyframes.iter().filter(|k| k.lidar.is_some()).collect();
        let leaves: Vec<Vec<Leaf>> = keyframes.par_iter().map(|k| leaves(k, around, clearance)).collect();
        let leaves: Vec<Leaf> = leaves.into_iter().flatten().collect();
        let cubes = cubes(leaves.iter().filter(|l| !l.labelled));
        let mut columns = Columns::new(around.place.bounds, CELL_M);
        let foliage = |l: &&Leaf| l.labelled || cubes.get(&cube(l.position)).is_some_and(Moments::is_scattered);
        for leaf in leaves.iter().filter(foliage) {
            columns.add(leaf.position.truncate(), leaf.above_m, leaf.mass, leaf.above_m < BUSH_TOP_M, leaf.cut);
        }
        let origins = keyframes.iter().filter_map(|k| k.lidar.as_ref()).map(|s| s.origin_world.truncate()).collect();
        Self { columns, origins }
    }

    /// Whether the LiDAR would have seen a plant at a position.
    pub(super) fn covers(&self, p: DVec2) -> bool {
        self.origins.iter().any(|o| o.distance(p) < COVER_M)
    }

    /// Trees where columns are tall, bushes where they are low; the denser the column, the earlier and the likelier.
    pub(super) fn wishes(&self, seed: Seed) -> Vec<Wish> {
        let mut random = seed.random();
        let mut drawn: Vec<(bool, f64, Wish)> = Vec::new();
        for (centre, column) in self.columns.filled() {
            let [order, keep, dx, dy, height] = std::array::from_fn(|_| random.unit());
            let near = self.columns.around(centre, 1.5);
            let position = centre + (DVec2::new(dx, dy) - 0.5) * CELL_M;
            let is_tree = near.top_m > TREE_TOP_M;
            let mass = if is_tree { near.mass / 5.0 } else { column.low_mass };
            if mass < THIN || keep > mass / DENSE {
                continue;
            }
            let wish = if is_tree {
                // What the highest beam cuts off has a street tree's height, or a little more than was seen.
                let top_m = self.columns.around(centre, 2.5);
                let grown_m = if top_m.cut { (top_m.top_m * 1.25).max(5.5 + 4.5 * height) } else { top_m.top_m };
                let tree = Wish::new(Kind::Tree, position, grown_m, species_group(seed, centre));
                Wish { paved: true, ..tree }
            } else {
                let height_m = column.top_m.clamp(0.5, 1.8);
                let bush = Wish::new(Kind::Bush, position, height_m, species_group(seed.child("bush"), centre));
                Wish { radius_m: Some(0.45 * height_m.max(0.8)), paved: true, ..bush }
            };
            // Weighted order without replacement: Efraimidis and Spirakis, 2006.
            drawn.push((!is_tree, -(1.0 - order).ln() / mass, wish));
        }
        drawn.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        drawn.into_iter().map(|(.., wish)| wish).collect()
    }
}

/// The points of a sweep that may be leaves: above the ground, not on recorded objects, not at buildings.
fn leaves(keyframe: &Keyframe, around: &Surroundings, clearance: &Clearance) -> Vec<Leaf> {
    let Some(sweep) = &keyframe.lidar else { return Vec::new() };
    let boxes: Vec<(Cuboid, f64)> = keyframe
        .boxes
        .iter()
        .map(|b| b.cuboid.grown(0.25))
        .map(|cuboid| (cuboid, cuboid.size_m.length_squared() / 4.0))
        .collect();
    let highest_rad = sweep.highest_beam_rad();
    let labels = (sweep.classes.len() == sweep.points_world.len()).then_some(&sweep.classes);
    let mut leaves = Vec::new();
    for (i, point) in sweep.points_world.iter().enumerate() {
        if labels.is_some_and(|labels| labels[i] != LidarClass::Vegetation) {
            continue;
        }
        let position = point.as_dvec3();
        let range_m = position.distance(sweep.origin_world);
        let plane = position.truncate();
        if !(OWN_BODY_M..REACH_M).contains(&range_m) || !around.place.bounds.contains(plane) {
            continue;
        }
        let above_m = position.z - around.stand.ground.height_m(plane);
        let in_box = |(cuboid, radius2): &(Cuboid, f64)| {
            cuboid.world_from_body.translation.distance_squared(position) <= *radius2 && cuboid.contains(position)
        };
        let at_building = labels.is_none() && clearance.building_distance_m(plane) < 1.0;
        if !HEIGHTS_M.contains(&above_m) || at_building || boxes.iter().any(in_box) {
            continue;
        }
        leaves.push(Leaf {
            position,
            above_m,
            mass: (range_m / UNIT_RANGE_M).powi(2),
            cut: sweep.height_rad(position) > highest_rad - BEAM_EDGE_RAD,
            labelled: labels.is_some(),
        });
    }
    leaves
}

/// Sums of the points in a cube, from its corner.
#[derive(Clone, Copy, Default)]
struct Moments {
    count: u32,
    sum: DVec3,
    squares: DVec3,
    products: DVec3,
}

fn cube(p: DVec3) -> [i32; 3] {
    (p / VOXEL_M).floor().as_ivec3().to_array()
}

fn cubes<'a>(leaves: impl Iterator<Item = &'a Leaf>) -> HashMap<[i32; 3], Moments> {
    let mut cubes: HashMap<[i32; 3], Moments> = HashMap::new();
    for leaf in leaves {
        let key = cube(leaf.position);
        let p = leaf.position - DVec3::from_array(key.map(f64::from)) * VOXEL_M;
        let moments = cubes.entry(key).or_default();
        moments.count += 1;
        moments.sum += p;
        moments.squares += p * p;
        moments.products += DVec3::new(p.y * p.z, p.z * p.x, p.x * p.y);
    }
    cubes
}

impl Moments {
    /// Whether the points fill space, as leaves do.
    fn is_scattered(&self) -> bool {
        if self.count < MIN_POINTS {
            return false;
        }
        let n = f64::from(self.count);
        let mean = self.sum / n;
        let diagonal = self.squares / n - mean * mean;
        let off = self.products / n - DVec3::new(mean.y * mean.z, mean.z * mean.x, mean.x * mean.y);
        let [widest, _, thinnest] = eigenvalues(diagonal, off).map(|v| v.max(0.0).sqrt());
        thinnest >= MIN_DEPTH_M && thinnest >= MIN_DEPTH_SHARE * widest
    }
}

/// Eigenvalues of a symmetric matrix, the largest first, from its diagonal and (yz, zx, xy).
///
/// Oliver K. Smith, *Eigenvalues of a symmetric 3 × 3 matrix* (1961).
fn eigenvalues(diagonal: DVec3, off: DVec3) -> [f64; 3] {
    let off2 = off.length_squared();
    let q = diagonal.element_sum() / 3.0;
    let centred = diagonal - q;
    let p = ((centred.length_squared() + 2.0 * off2) / 6.0).sqrt();
    if p < 1e-12 {
        return [q; 3];
    }
    let (d, o) = (centred / p, off / p);
    let determinant =
        d.element_product() + 2.0 * o.element_product() - d.x * o.x * o.x - d.y * o.y * o.y - d.z * o.z * o.z;
    let angle = (determinant / 2.0).clamp(-1.0, 1.0).acos() / 3.0;
    let largest = q + 2.0 * p * angle.cos();
    let smallest = q + 2.0 * p * (angle + std::f64::consts::TAU / 3.0).cos();
    [largest, 3.0 * q - largest - smallest, smallest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::Stand;
    use crate::surroundings::Kerbs;
    use crate::testing;
    use trove_model::{HeightField, LidarSweep, Report};

    /// A crown 4 m above the land, a wall beside it, and a sensor on the road.
    fn sweep(labelled: bool) -> LidarSweep {
        let mut random = Seed(2).random();
        let mut cloud = |low: DVec3, size: DVec3| -> Vec<glam::Vec3> {
            let point = |_| low + DVec3::new(random.unit(), random.unit(), random.unit()) * size;
            (0..1500).map(point).map(|p| p.as_vec3()).collect()
        };
        let crown = cloud(DVec3::new(18.0, -24.0, 2.0), DVec3::new(4.0, 4.0, 3.0));
        let wall = cloud(DVec3::new(30.0, -20.0, 0.0), DVec3::new(8.0, 0.02, 4.0));
        let classes = [vec![LidarClass::Vegetation; crown.len()], vec![LidarClass::Manmade; wall.len()]].concat();
        LidarSweep {
            origin_world: DVec3::new(10.0, 0.0, 1.8),
            points_world: [crown, wall].concat(),
            classes: if labelled { classes } else { Vec::new() },
        }
    }

    #[test]
    fn trees_grow_where_the_lidar_saw_a_crown_and_not_at_a_wall_with_labels_and_without() {
        for labelled in [true, false] {
            let mut drive = testing::drive();
            drive.keyframes[2].lidar = Some(sweep(labelled));
            let bounds = crate::area(&drive).unwrap();
            let ground = HeightField::flat(bounds, 0.0);
            let surfaces = testing::surfaces(&drive, &ground);
            let clearance = Clearance::new(&drive, &surfaces, &[], bounds);
            let kerbs = Kerbs::new(&drive, None, &surfaces, bounds);
            let stand = Stand { ground: &ground, surfaces: &surfaces };
            let (library, seeds, report) = (testing::library(), Seed(0).into(), Report::default());
            let place = testing::place(&drive, None, bounds, &ground, &library, &seeds, &report);
            let around = Surroundings { place: &place, kerbs: &kerbs, stand };
            let seen = Seen::new(&around, &clearance);
            let wishes = seen.wishes(Seed(1));
            assert!(wishes.iter().any(|w| w.kind == Kind::Tree));
            for wish in &wishes {
                assert!(wish.position.distance(DVec2::new(20.0, -22.0)) < 4.5, "{wish:?}");
                assert!((3.0..10.1).contains(&wish.height_m));
            }
            assert!(seen.covers(DVec2::new(30.0, -20.0)) && !seen.covers(DVec2::new(80.0, 0.0)));
        }
    }

    #[test]
    fn eigenvalues_of_a_turned_ellipsoid_come_out() {
        let turn = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, -1.1);
        let m = turn * glam::DMat3::from_diagonal(DVec3::new(3.0, 0.5, 2.0)) * turn.transpose();
        let found =
            eigenvalues(DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), DVec3::new(m.y_axis.z, m.z_axis.x, m.x_axis.y));
        for (value, expected) in found.iter().zip([3.0, 2.0, 0.5]) {
            assert!((value - expected).abs() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn a_bush_is_scattered_and_a_wall_a_pole_and_the_ground_are_not() {
        let mut random = Seed(1).random();
        let mut cloud = |size: DVec3| {
            let leaf = |p: DVec3| Leaf { position: p, above_m: 1.0, mass: 1.0, cut: false, labelled: false };
            let points: Vec<Leaf> = (0..60)
                .map(|_| DVec3::new(random.unit(), random.unit(), random.unit()) * size * 0.98)
                .map(|p| leaf(p + 0.01))
                .collect();
            cubes(points.iter())[&[0, 0, 0]].is_scattered()
        };
        assert!(cloud(DVec3::ONE));
        assert!(!cloud(DVec3::new(1.0, 0.05, 1.0)));
        assert!(!cloud(DVec3::new(0.15, 0.15, 1.0)));
        assert!(!cloud(DVec3::new(1.0, 1.0, 0.1)));
    }
}
