//! Cells in which surfaces lie.

use glam::{DAffine3, DVec3, Vec2};
use rayon::prelude::*;
use trove_model::{GridShot, InstanceId, Occupancy, VoxelGrid};

use super::clip::{Polygon, barycentric};
use super::frame::{Frame, is_there, label};
use crate::PreparedScene;
use crate::material::Opacity;

/// Areas are added up as whole numbers of square cells over this, so that their sum does not depend on the order.
const AREA_STEPS: f64 = 1e9;
/// Triangles that one thread takes at once.
const CHUNK: usize = 4096;
/// Where each triangle of what is left of a cut-out's triangle is looked at for holes, as shares of its corners.
const LOOKS: [[f64; 3]; 4] = [[1.0 / 3.0; 3], [0.7, 0.15, 0.15], [0.15, 0.7, 0.15], [0.15, 0.15, 0.7]];

/// How much of a thing's surface lies in a cell.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Share {
    cell: usize,
    label: u8,
    instance: InstanceId,
    area: u64,
}

/// Fills the cells of `found` in which surfaces lie.
pub(super) fn fill(scene: &PreparedScene, shot: &GridShot, frame: &Frame, found: &mut Occupancy) {
    let chunks: Vec<(usize, usize)> = (0..scene.instances.len())
        .filter(|&i| is_there(scene, shot, i) && is_near(scene, i, &shot.plan.grid, frame))
        .flat_map(|i| (0..scene.placed(i as u32).mesh.triangles.len()).step_by(CHUNK).map(move |first| (i, first)))
        .collect();
    let shares: Vec<Vec<Share>> =
        chunks.par_iter().map(|&(instance, first)| of_triangles(scene, shot, frame, instance, first)).collect();
    let mut shares = shares.concat();
    shares.par_sort_unstable();
    for of_cell in shares.chunk_by(|a, b| a.cell == b.cell) {
        let (label, instance) = winner(of_cell, shot);
        found.labels[of_cell[0].cell] = label;
        found.instances[of_cell[0].cell] = instance;
    }
}

/// Things come before stuff, then what has the most surface, then what has the lower number.
fn winner(of_cell: &[Share], shot: &GridShot) -> (u8, InstanceId) {
    let total = |shares: &[Share]| shares.iter().map(|share| share.area).sum::<u64>();
    let is_thing = |label: u8| shot.plan.classes.class(label).is_some_and(|class| class.thing);
    let labels = of_cell.chunk_by(|a, b| a.label == b.label);
    let of_label = labels.rev().max_by_key(|of| (is_thing(of[0].label), total(of))).unwrap_or(of_cell);
    let instances = of_label.chunk_by(|a, b| a.instance == b.instance);
    let of_instance = instances.rev().max_by_key(|of| total(of)).unwrap_or(of_label);
    (of_instance[0].label, of_instance[0].instance)
}

/// Whether anything of a shape may lie in the grid.
fn is_near(scene: &PreparedScene, instance: usize, grid: &VoxelGrid, frame: &Frame) -> bool {
    let Some((low, high)) = scene.placed(instance as u32).mesh.bounds() else { return false };
    let cells_from_mesh = cells_from_mesh(scene, instance, frame);
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        cells_from_mesh.transform_point3(DVec3::new(pick(0).into(), pick(1).into(), pick(2).into()))
    };
    let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let bounds = (0..8).map(corner).fold(empty, |[low, high], p| [low.min(p), high.max(p)]);
    overlaps(bounds, grid)
}

fn overlaps([low, high]: [DVec3; 2], grid: &VoxelGrid) -> bool {
    high.cmpge(DVec3::ZERO).all() && low.cmplt(grid.size()).all()
}

fn cells_from_mesh(scene: &PreparedScene, instance: usize, frame: &Frame) -> DAffine3 {
    frame.cells_from_world * scene.instances[instance].world_from_mesh.middle
}

/// What lies where of some triangles of an instance.
fn of_triangles(scene: &PreparedScene, shot: &GridShot, frame: &Frame, instance: usize, first: usize) -> Vec<Share> {
    let placed = scene.placed(instance as u32);
    let (mesh, cells_from_mesh) = (&placed.mesh, cells_from_mesh(scene, instance, frame));
    let (label, id) = (label(scene, shot, instance), placed.id);
    let mut shares = Vec::new();
    for triangle in first..mesh.triangles.len().min(first + CHUNK) {
        let indices = mesh.triangles[triangle];
        let corners = indices.map(|i| cells_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3()));
        let opacity = &scene.shapes.opacities[placed.materials[usize::from(mesh.slot(triangle))] as usize];
        let uvs = (opacity.has_holes() && !mesh.uvs.is_empty()).then(|| indices.map(|i| mesh.uvs[i as usize]));
        in_cells(Polygon::triangle(corners), &shot.plan.grid, |cell, part| {
            let there = uvs.map_or(1.0, |uvs| share_there(part, corners, uvs, opacity));
            let area = (part.area() * there * AREA_STEPS).round() as u64;
            if area > 0 {
                shares.push(Share { cell, label, instance: id, area });
            }
        });
    }
    shares.sort_unstable();
    let is_same = |a: &Share, b: &Share| (a.cell, a.label, a.instance) == (b.cell, b.label, b.instance);
    let sum = |of: &[Share]| Share { area: of.iter().map(|share| share.area).sum(), ..of[0] };
    shares.chunk_by(is_same).map(sum).collect()
}

/// Tells of the part of a polygon in each cell of the grid.
fn in_cells(polygon: Polygon, grid: &VoxelGrid, mut tell: impl FnMut(usize, &Polygon)) {
    if !overlaps(polygon.bounds(), grid) {
        return;
    }
    let range = |part: &Polygon, axis: usize| {
        let [low, high] = part.bounds();
        let last = grid.counts[axis] as f64 - 1.0;
        // Empty where the part is.
        let (from, to) = (low[axis].floor().max(0.0), high[axis].floor().min(last));
        if from <= to { from as usize..to as usize + 1 } else { 0..0 }
    };
    let slab = |part: &Polygon, axis: usize, cells: &std::ops::Range<usize>, i: usize| {
        let [low, high] = part.bounds();
        let (from, to) = (i as f64, i as f64 + 1.0);
        // What lies in one slab needs no cutting.
        if cells.len() == 1 && low[axis] >= from && high[axis] <= to { *part } else { part.slab(axis, from, to) }
    };
    let along_x = range(&polygon, 0);
    for x in along_x.clone() {
        let column = slab(&polygon, 0, &along_x, x);
        let along_y = range(&column, 1);
        for y in along_y.clone() {
            let row = slab(&column, 1, &along_y, y);
            let along_z = range(&row, 2);
            for z in along_z.clone() {
                tell(grid.index([x, y, z]), &slab(&row, 2, &along_z, z));
            }
        }
    }
}

/// The share of a part of a triangle that its material does not leave out.
fn share_there(part: &Polygon, corners: [DVec3; 3], uvs: [Vec2; 3], opacity: &Opacity) -> f64 {
    let (mut there, mut looks) = (0, 0);
    for [a, b, c] in part.fan() {
        for [i, j, k] in LOOKS {
            let shares = barycentric(corners, a * i + b * j + c * k).as_vec3();
            let uv = uvs[0] * shares.x + uvs[1] * shares.y + uvs[2] * shares.z;
            there += usize::from(opacity.covers(uv));
            looks += 1;
        }
    }
    there as f64 / (looks as f64).max(1.0)
}
