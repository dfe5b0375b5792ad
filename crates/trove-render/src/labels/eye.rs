//! Label rays: one through each pixel's centre, as [`crate::sight`] follows it, and where what it meets leads.

use glam::{DVec2, DVec3};
use trove_model::{Class, InstanceId, Occlusion, SensorRay, Shot};

use super::flow::{Arrow, Neighbour, Spot};
use super::layers::{Band, ExtraBand, put};
use super::pixel::{OUTSIDE, SKY};
use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::Carrier;
use crate::sight::{self, Seen};

/// Pixels along a side of the square whose rays are traced together: they run more alike than those of a line.
pub(super) const SIDE: u32 = 4;
const _: () = assert!((SIDE * SIDE) as usize == PACKET);

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
    /// In its band.
    index: usize,
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

    /// Fills in a band of [`SIDE`] rows of the picture, or what is left of it, from row `top` on.
    pub(super) fn look(&self, top: u32, band: &mut Band<'_>) {
        let width = self.shot.lens.width_px;
        let rows = band.shown.len() as u32 / width;
        let mut pixels: Vec<Pixel> = Vec::with_capacity(PACKET);
        let mut rays: Vec<SensorRay> = Vec::with_capacity(PACKET);
        let mut arrows: [Vec<(usize, Arrow)>; 2] = [Vec::with_capacity(PACKET), Vec::with_capacity(PACKET)];
        for left in (0..width).step_by(SIDE as usize) {
            pixels.clear();
            rays.clear();
            for (y, x) in (0..rows).flat_map(|y| (left..width.min(left + SIDE)).map(move |x| (y, x))) {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(top + y) + 0.5);
                let index = (y * width + x) as usize;
                let Some(direction_camera) = self.shot.lens.unproject(centre) else {
                    outside(band, index);
                    continue;
                };
                let ray = self.shot.label_ray(direction_camera);
                rays.push(ray);
                pixels.push(Pixel { index, centre, direction: ray.direction, ahead: direction_camera.z });
            }
            for (pixel, seen) in pixels.iter().zip(sight::seen(self.scene, &self.carrier, &rays)) {
                let leads = match seen {
                    Some(seen) => self.surface(band, pixel, &seen),
                    None => self.sky(band, pixel),
                };
                for ((side, arrow), arrows) in leads.into_iter().enumerate().zip(&mut arrows) {
                    band.flow[side][pixel.index] = arrow.flow;
                    arrows.push((pixel.index, arrow));
                }
            }
            for ((neighbour, arrows), layer) in self.neighbours.iter().zip(&mut arrows).zip(&mut band.occlusion) {
                neighbour.occlusion(arrows, layer);
                arrows.clear();
            }
        }
    }

    /// What a pixel shows of a surface, and where that leads.
    fn surface(&self, band: &mut Band<'_>, pixel: &Pixel, seen: &Seen) -> [Arrow; 2] {
        let (i, hit) = (pixel.index, &seen.hit);
        let spot = Spot {
            point: self.shot.world_from_camera.translation + pixel.direction * seen.range_m,
            normal: seen.normal,
        };
        let then = self.neighbours.each_ref().map(|neighbour| neighbour.carried(hit, spot));
        band.shown[i] = hit.instance;
        band.exact_range_m[i] = seen.range_m;
        band.class[i] = self.scene.instances[hit.instance as usize].class;
        band.instance[i] = self.scene.placed(hit.instance).id.0;
        band.depth_m[i] = (seen.range_m * pixel.ahead) as f32;
        band.normal[i] = self.shot.world_from_camera.inverse().vector(seen.normal).as_vec3().to_array();
        self.extra(&mut band.extra, i, seen, spot.point, then);
        std::array::from_fn(|side| self.neighbours[side].arrow(pixel.centre, then[side]))
    }

    fn extra(&self, band: &mut ExtraBand<'_>, i: usize, seen: &Seen, point: DVec3, then: [Option<Spot>; 2]) {
        put(&mut band.range_m, i, || seen.range_m as f32);
        put(&mut band.normal_world, i, || seen.normal.as_vec3().to_array());
        if band.albedo.is_some() || band.roughness.is_some() {
            let (surface, material) = self.scene.surface(&seen.hit, &seen.ray);
            let (albedo, roughness) = material.look(&surface);
            put(&mut band.albedo, i, || albedo.to_array());
            put(&mut band.roughness, i, || roughness);
        }
        for ((layer, then), is_there) in band.scene_flow.iter_mut().zip(then).zip(self.scene.has_beside) {
            let way = then.filter(|_| is_there).map(|then| (then.point - point).as_vec3().to_array());
            put(layer, i, || way.unwrap_or(NOTHING));
        }
        put(&mut band.object_coordinates, i, || {
            let is_object = self.scene.placed(seen.hit.instance).id != InstanceId(0);
            let object = self.scene.instances[seen.hit.instance as usize].object.as_deref().filter(|_| is_object);
            object.map_or(NOTHING, |object| {
                let point_body = object.cuboid.world_from_body.inverse().point(point);
                (point_body / object.cuboid.size_m + 0.5).as_vec3().to_array()
            })
        });
        put(&mut band.part, i, || self.scene.material(&seen.hit).role);
    }

    /// What a pixel shows of the sky, and where that leads.
    fn sky(&self, band: &mut Band<'_>, pixel: &Pixel) -> [Arrow; 2] {
        nothing(band, pixel.index, SKY, Class::Sky);
        self.neighbours.each_ref().map(|neighbour| neighbour.arrow_of_sky(pixel.centre, pixel.direction))
    }
}

/// A pixel that no ray belongs to.
fn outside(band: &mut Band<'_>, i: usize) {
    nothing(band, i, OUTSIDE, Class::Void);
    band.flow.iter_mut().for_each(|flow| flow[i] = [f32::NAN; 2]);
    band.occlusion.iter_mut().for_each(|occlusion| occlusion[i] = Occlusion::Undefined);
}

/// A pixel without a surface.
fn nothing(band: &mut Band<'_>, i: usize, shown: u32, class: Class) {
    band.shown[i] = shown;
    band.exact_range_m[i] = f64::INFINITY;
    band.class[i] = class;
    band.instance[i] = 0;
    band.depth_m[i] = f32::INFINITY;
    band.normal[i] = [0.0; 3];
    let extra = &mut band.extra;
    put(&mut extra.range_m, i, || f32::INFINITY);
    put(&mut extra.normal_world, i, || [0.0; 3]);
    put(&mut extra.albedo, i, || NOTHING);
    put(&mut extra.roughness, i, || f32::NAN);
    extra.scene_flow.iter_mut().for_each(|layer| put(layer, i, || NOTHING));
    put(&mut extra.object_coordinates, i, || NOTHING);
    put(&mut extra.part, i, || None);
}
