//! Label rays: one through each pixel's centre, as [`crate::sight`] follows it, and where what it meets leads.

use glam::{DVec2, DVec3};
use trove_model::{Class, InstanceId, Occlusion, SensorRay, Shot};

use super::flow::{Arrow, Neighbour, Spot};
use super::layers::{ExtraRow, Row, put};
use super::pixel::{OUTSIDE, SKY};
use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::Carrier;
use crate::sight::{self, Seen};

/// What is not defined.
const NOTHING: [f32; 3] = [f32::NAN; 3];

/// A camera in a scene.
pub(super) struct Eye<'a> {
    pub scene: &'a PreparedScene,
    pub shot: &'a Shot,
    pub carrier: Carrier,
    neighbours: [Neighbour<'a>; 2],
}

/// A pixel inside the lens's image circle.
struct Pixel {
    column: usize,
    centre: DVec2,
    /// In World.
    direction: DVec3,
    /// In Camera, along the axis.
    ahead: f64,
}

impl<'a> Eye<'a> {
    pub(super) fn new(scene: &'a PreparedScene, shot: &'a Shot) -> Self {
        let carrier = Carrier::of_labels(scene, None, shot);
        Self { scene, shot, carrier, neighbours: Neighbour::both(scene, shot) }
    }

    /// Fills in a row of the picture.
    pub(super) fn look(&self, y: u32, row: &mut Row<'_>) {
        let width = self.shot.lens.width_px;
        let mut pixels: Vec<Pixel> = Vec::with_capacity(PACKET);
        let mut rays: Vec<SensorRay> = Vec::with_capacity(PACKET);
        let mut arrows: [Vec<(usize, Arrow)>; 2] = [Vec::with_capacity(PACKET), Vec::with_capacity(PACKET)];
        for first in (0..width).step_by(PACKET) {
            pixels.clear();
            rays.clear();
            for x in first..width.min(first + PACKET as u32) {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let column = x as usize;
                let Some(direction_camera) = self.shot.lens.unproject(centre) else {
                    outside(row, column);
                    continue;
                };
                let ray = self.shot.label_ray(direction_camera);
                rays.push(ray);
                pixels.push(Pixel { column, centre, direction: ray.direction, ahead: direction_camera.z });
            }
            for (pixel, seen) in pixels.iter().zip(sight::seen(self.scene, &self.carrier, &rays)) {
                let leads = match seen {
                    Some(seen) => self.surface(row, pixel, &seen),
                    None => self.sky(row, pixel),
                };
                for ((side, arrow), arrows) in leads.into_iter().enumerate().zip(&mut arrows) {
                    row.flow[side][pixel.column] = arrow.flow;
                    arrows.push((pixel.column, arrow));
                }
            }
            for ((neighbour, arrows), layer) in self.neighbours.iter().zip(&mut arrows).zip(&mut row.occlusion) {
                neighbour.occlusion(arrows, layer);
                arrows.clear();
            }
        }
    }

    /// What a pixel shows of a surface, and where that leads.
    fn surface(&self, row: &mut Row<'_>, pixel: &Pixel, seen: &Seen) -> [Arrow; 2] {
        let (x, hit) = (pixel.column, &seen.hit);
        let spot = Spot {
            point: self.shot.world_from_camera.translation + pixel.direction * seen.range_m,
            normal: seen.normal,
        };
        let then = self.neighbours.each_ref().map(|neighbour| neighbour.carried(hit, spot));
        row.shown[x] = hit.instance;
        row.exact_range_m[x] = seen.range_m;
        row.class[x] = self.scene.instances[hit.instance as usize].class;
        row.instance[x] = self.scene.placed(hit.instance).id.0;
        row.depth_m[x] = (seen.range_m * pixel.ahead) as f32;
        row.normal[x] = self.shot.world_from_camera.inverse().vector(seen.normal).as_vec3().to_array();
        self.extra(&mut row.extra, x, seen, spot.point, then);
        std::array::from_fn(|side| self.neighbours[side].arrow(pixel.centre, then[side]))
    }

    fn extra(&self, row: &mut ExtraRow<'_>, x: usize, seen: &Seen, point: DVec3, then: [Option<Spot>; 2]) {
        put(&mut row.range_m, x, || seen.range_m as f32);
        put(&mut row.normal_world, x, || seen.normal.as_vec3().to_array());
        if row.albedo.is_some() || row.roughness.is_some() {
            let (surface, material) = self.scene.surface(&seen.hit, &seen.ray);
            let (albedo, roughness) = material.look(&surface);
            put(&mut row.albedo, x, || albedo.to_array());
            put(&mut row.roughness, x, || roughness);
        }
        for ((layer, then), is_there) in row.scene_flow.iter_mut().zip(then).zip(self.scene.has_beside) {
            let way = then.filter(|_| is_there).map(|then| (then.point - point).as_vec3().to_array());
            put(layer, x, || way.unwrap_or(NOTHING));
        }
        put(&mut row.object_coordinates, x, || {
            let is_object = self.scene.placed(seen.hit.instance).id != InstanceId(0);
            let object = self.scene.instances[seen.hit.instance as usize].object.as_deref().filter(|_| is_object);
            object.map_or(NOTHING, |object| {
                let point_body = object.cuboid.world_from_body.inverse().point(point);
                (point_body / object.cuboid.size_m + 0.5).as_vec3().to_array()
            })
        });
    }

    /// What a pixel shows of the sky, and where that leads.
    fn sky(&self, row: &mut Row<'_>, pixel: &Pixel) -> [Arrow; 2] {
        nothing(row, pixel.column, SKY, Class::Sky);
        self.neighbours.each_ref().map(|neighbour| neighbour.arrow_of_sky(pixel.centre, pixel.direction))
    }
}

/// A pixel that no ray belongs to.
fn outside(row: &mut Row<'_>, x: usize) {
    nothing(row, x, OUTSIDE, Class::Void);
    row.flow.iter_mut().for_each(|flow| flow[x] = [f32::NAN; 2]);
    row.occlusion.iter_mut().for_each(|occlusion| occlusion[x] = Occlusion::Undefined);
}

/// A pixel without a surface.
fn nothing(row: &mut Row<'_>, x: usize, shown: u32, class: Class) {
    row.shown[x] = shown;
    row.exact_range_m[x] = f64::INFINITY;
    row.class[x] = class;
    row.instance[x] = 0;
    row.depth_m[x] = f32::INFINITY;
    row.normal[x] = [0.0; 3];
    let extra = &mut row.extra;
    put(&mut extra.range_m, x, || f32::INFINITY);
    put(&mut extra.normal_world, x, || [0.0; 3]);
    put(&mut extra.albedo, x, || NOTHING);
    put(&mut extra.roughness, x, || f32::NAN);
    extra.scene_flow.iter_mut().for_each(|layer| put(layer, x, || NOTHING));
    put(&mut extra.object_coordinates, x, || NOTHING);
}
