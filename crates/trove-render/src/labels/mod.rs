//! What every pixel shows: one ray through each pixel's centre, as [`crate::sight`] follows it.

mod change;
mod flow;
mod keypoints;
mod objects;
mod outline;
mod pixel;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use trove_model::{Class, Labels, Raster, SensorRay, Shot};

pub(crate) use change::changes;

use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::Carrier;
use crate::sight::{self, Seen};
use flow::{Arrow, Neighbour, Spot};
use pixel::{OUTSIDE, OUTSIDE_LENS, Pixel, SKY};

/// All labels of a picture, computed with the current thread pool; `None` once `stop` answers true, which it then does
/// for good.
pub(crate) fn render(scene: &PreparedScene, shot: &Shot, stop: &(dyn Fn() -> bool + Sync)) -> Option<Labels> {
    let (width, height) = (shot.lens.width_px, shot.lens.height_px);
    let neighbours = Neighbour::both(scene, shot);
    let carrier = Carrier::new(scene, shot.carrier);
    let row = |y: u32| {
        let centres = (0..width).map(|x| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).collect::<Vec<_>>();
        centres.chunks(PACKET).flat_map(|centres| pixels(scene, shot, &carrier, &neighbours, centres)).collect()
    };
    let rows: Option<Vec<Vec<Pixel>>> = (0..height).into_par_iter().map(|y| (!stop()).then(|| row(y))).collect();
    let pixels = rows?.into_iter().flatten().collect();

    let instance = |index: u32| scene.instances.get(index as usize);
    let shown = Raster { width, height, data: pixels };
    let elsewhere = |p: &Pixel| if p.instance == OUTSIDE { Class::Void } else { Class::Sky };
    let class = shown.map(|p| instance(p.instance).map_or(elsewhere(p), |i| i.class));
    let objects = objects::list(scene, &carrier, shot, &shown, stop)?;
    Some(Labels {
        class,
        instance: shown.map(|p| scene.shapes.placed.get(p.instance as usize).map_or(0, |placed| placed.id.0)),
        depth_m: shown.map(|p| p.depth_m),
        normal: shown.map(|p| p.normal),
        flow_forward: shown.map(|p| p.flow[1]),
        flow_backward: shown.map(|p| p.flow[0]),
        occluded_forward: shown.map(|p| p.occlusion[1]),
        occluded_backward: shown.map(|p| p.occlusion[0]),
        objects,
    })
}

/// What up to [`PACKET`] neighbouring pixels show.
fn pixels(
    scene: &PreparedScene,
    shot: &Shot,
    carrier: &Carrier,
    neighbours: &[Neighbour<'_>; 2],
    centres: &[DVec2],
) -> Vec<Pixel> {
    let directions: Vec<Option<DVec3>> = centres.iter().map(|centre| shot.lens.unproject(*centre)).collect();
    let rays: Vec<SensorRay> = directions.iter().flatten().map(|d| shot.label_ray(*d)).collect();
    let mut seen = sight::seen(scene, carrier, &rays).into_iter();
    let arrows_of = |(centre, direction): (&DVec2, &Option<DVec3>)| {
        direction.map_or((OUTSIDE_LENS, None), |d| {
            let (pixel, arrows) = pixel(shot, neighbours, *centre, d, seen.next().flatten());
            (pixel, Some(arrows))
        })
    };
    let (mut pixels, arrows): (Vec<Pixel>, Vec<Option<[Arrow; 2]>>) =
        centres.iter().zip(&directions).map(arrows_of).unzip();
    for (side, neighbour) in neighbours.iter().enumerate() {
        let arrows: Vec<&Arrow> = arrows.iter().flatten().map(|arrows| &arrows[side]).collect();
        let inside = pixels.iter_mut().filter(|pixel| pixel.instance != OUTSIDE);
        inside.zip(neighbour.occlusion(&arrows)).for_each(|(pixel, occlusion)| pixel.occlusion[side] = occlusion);
    }
    pixels
}

/// What the pixel around a point shows, whose ray has met something or not, and where it leads.
fn pixel(
    shot: &Shot,
    neighbours: &[Neighbour<'_>; 2],
    centre: DVec2,
    direction_camera: DVec3,
    seen: Option<Seen>,
) -> (Pixel, [Arrow; 2]) {
    let direction = shot.world_from_camera.vector(direction_camera);
    let Some(Seen { hit, range_m, normal, .. }) = seen else {
        let arrows = neighbours.each_ref().map(|n| n.arrow_of_sky(centre, direction));
        return (Pixel { instance: SKY, flow: arrows.each_ref().map(|a| a.flow), ..OUTSIDE_LENS }, arrows);
    };
    let point = shot.world_from_camera.translation + direction * range_m;
    let arrows = neighbours.each_ref().map(|n| n.arrow(centre, &hit, Spot { point, normal }));
    let pixel = Pixel {
        instance: hit.instance,
        range_m,
        depth_m: (range_m * direction_camera.z) as f32,
        normal: shot.world_from_camera.inverse().vector(normal).as_vec3().to_array(),
        flow: arrows.each_ref().map(|a| a.flow),
        ..OUTSIDE_LENS
    };
    (pixel, arrows)
}
