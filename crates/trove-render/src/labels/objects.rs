//! What a picture shows of each object.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use trove_model::{Cuboid, ExtraLabel, GlassLabels, Mask, ObjectLabel, PixelBox, Pose, SceneObject, Shot};

use super::eye::SIDE;
use super::keypoints;
use super::outline;
use super::pixel::Shown;
use crate::PreparedScene;
use crate::placed::Placed;
use crate::prepare::Carrier;
use crate::ray::Ray;
use crate::sight;

/// Pixels, and the smallest box around them.
#[derive(Clone, Copy, Default)]
struct Extent {
    count: u32,
    around: Option<PixelBox>,
}

impl Extent {
    /// From one column to another.
    fn run([x0, x1]: [u32; 2], y: u32) -> Self {
        Self { count: x1 + 1 - x0, around: Some(PixelBox { min: [x0, y], max: [x1, y] }) }
    }

    fn pixel([x, y]: [u32; 2]) -> Self {
        Self::run([x, x], y)
    }

    fn and(self, other: Self) -> Self {
        let around = match (self.around, other.around) {
            (Some(a), Some(b)) => Some(PixelBox {
                min: [a.min[0].min(b.min[0]), a.min[1].min(b.min[1])],
                max: [a.max[0].max(b.max[0]), a.max[1].max(b.max[1])],
            }),
            (a, b) => a.or(b),
        };
        Self { count: self.count + other.count, around }
    }
}

/// All recorded objects, and road users like them, of which a pixel would be seen if nothing else were there, and the scenery of which one is seen,
/// in the order of ids; `None` once `stop` answers true.
pub(super) fn list(
    scene: &PreparedScene,
    carrier: &Carrier,
    shot: &Shot,
    shown: &Shown,
    stop: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<ObjectLabel>> {
    let mut visible = vec![Extent::default(); scene.instances.len()];
    for (y, row) in (0..).zip(shown.instance.chunks(shown.width.max(1) as usize)) {
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let next = x + run.len() as u32;
            // Sky and void are no instances.
            if let Some(extent) = visible.get_mut(run[0] as usize) {
                *extent = extent.and(Extent::run([x, next - 1], y));
            }
            x = next;
        }
    }
    let mut objects: Vec<ObjectLabel> = (0..scene.instances.len())
        .into_par_iter()
        .filter_map(|i| {
            if stop() {
                return None;
            }
            let (instance, id) = (&scene.instances[i], scene.shapes.placed[i].id);
            let object = instance.object.as_deref().filter(|_| id.0 != 0 && Some(id) != shot.carrier)?;
            // Scenery is plentiful, and nobody asks for the thousand trees behind the houses.
            (object.origin.is_road_user() || visible[i].count > 0)
                .then(|| label(scene, carrier, shot, shown, (i, object), visible[i]))
                .flatten()
        })
        .collect();
    objects.sort_by_key(|object| object.id);
    (!stop()).then_some(objects)
}

fn label(
    scene: &PreparedScene,
    carrier: &Carrier,
    shot: &Shot,
    shown: &Shown,
    (index, object): (usize, &SceneObject),
    visible: Extent,
) -> Option<ObjectLabel> {
    let hidden = hidden(scene, shot, shown, index);
    let amodal = hidden.iter().fold(visible, |extent, pixel| extent.and(Extent::pixel(*pixel)));
    let wanted = shot.labels.extra.contains(&ExtraLabel::AmodalMasks);
    let camera_from_world = shot.world_from_camera.inverse();
    let corners_camera = object.cuboid.corners_world().map(|corner| camera_from_world.point(corner));
    let range_m = object.cuboid.world_from_body.translation.distance(shot.world_from_camera.translation);
    (amodal.count > 0).then(|| ObjectLabel {
        id: scene.shapes.placed[index].id,
        visible_px: visible.count,
        visible_box: visible.around,
        amodal_px: amodal.count,
        amodal_box: amodal.around,
        amodal_mask: amodal.around.filter(|_| wanted).map(|around| mask(index as u32, around, shown, &hidden)),
        truncation: outline::truncation(&shot.lens, outline::project(&shot.lens, &corners_camera)) as f32,
        occlusion: 1.0 - visible.count as f32 / amodal.count as f32,
        range_m: range_m as f32,
        keypoints: object.keypoints_world.map(|points| keypoints::seen(scene, carrier, shot, index as u32, &points)),
    })
}

/// The pixels of an instance, seen and hidden.
fn mask(index: u32, around: PixelBox, shown: &Shown, hidden: &[[u32; 2]]) -> Mask {
    let mut mask = Mask::of(around, |x, y| shown.at(x, y).0 == index);
    hidden.iter().for_each(|[x, y]| *mask.pixels.at_mut(x - mask.min[0], y - mask.min[1]) = true);
    mask
}

/// The pixels, column and row, that would show an instance if other things did not hide it.
fn hidden(scene: &PreparedScene, shot: &Shot, shown: &Shown, index: usize) -> Vec<[u32; 2]> {
    let Some((corners_camera, farthest_m)) = bounds_camera(scene, index, shot) else { return Vec::new() };
    let Some(around) = outline::pixels_around(&shot.lens, &outline::project(&shot.lens, &corners_camera)) else {
        return Vec::new();
    };
    // Where something farther than all of it is seen, the instance is not: no ray is needed.
    let may_hide = |(instance, range_m): (u32, f64)| instance != index as u32 && range_m <= farthest_m;
    let through_glass = shot.labels.glass == GlassLabels::Behind;
    let ray = |x: u32, y: u32| {
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let direction = shot.lens.unproject(centre)?;
        Some(Ray { through_glass, ..sight::single(&shot.label_ray(direction)) })
    };
    let ([left, top], [right, bottom]) = (around.min, around.max);
    let bands = (top..bottom + 1).into_par_iter().step_by(SIDE as usize);
    let in_band = |first: u32| {
        let last = bottom.min(first + SIDE - 1);
        // Column by column, so that rays that follow each other run alike.
        let pixels = (left..=right).flat_map(|x| (first..=last).map(move |y| [x, y]));
        let asked = pixels.filter(|&[x, y]| may_hide(shown.at(x, y)));
        let (pixels, rays): (Vec<[u32; 2]>, Vec<Ray>) = asked.filter_map(|[x, y]| Some(([x, y], ray(x, y)?))).unzip();
        pixels.into_iter().zip(scene.meets(index as u32, &rays)).filter(|(_, is_met)| *is_met).map(|(pixel, _)| pixel)
    };
    bands.flat_map_iter(in_band).collect()
}

/// Corners of the box around an instance's mesh in Camera, and the greatest distance among them; `None` for an empty mesh.
fn bounds_camera(scene: &PreparedScene, index: usize, shot: &Shot) -> Option<([DVec3; 8], f64)> {
    let Placed { mesh, .. } = &scene.shapes.placed[index];
    let (low, high) = mesh.bounds()?;
    let (middle_mesh, size_m) = ((low + high).as_dvec3() * 0.5, (high - low).as_dvec3());
    let around_middle = Cuboid { world_from_body: Pose::IDENTITY, size_m };
    let camera_from_mesh = shot.world_from_camera.inverse().affine() * scene.instances[index].world_from_mesh.middle;
    let corners = around_middle.corners_world().map(|corner| camera_from_mesh.transform_point3(middle_mesh + corner));
    let farthest_m = corners.iter().map(|corner| corner.length()).fold(0.0, f64::max);
    Some((corners, farthest_m))
}
