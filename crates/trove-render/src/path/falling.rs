//! Drops and flakes before the camera: each draws a streak while light is gathered, as bright as what it refracts or
//! scatters.
//!
//! A falling drop gathers light from a wide field behind it (Garg and Nayar 2007), and a flake from all sides, so all that are
//! near each other have the brightness of paths through a few. Those too far away to be told apart are part of the air.

use glam::{DVec2, DVec3, IVec3, Vec3};
use rayon::prelude::*;
use trove_model::{Form, Precipitation, Raster, Seed, Shot};
use trove_trace::path::{Cone, Start};
use trove_trace::{Basis, Sampler, disk};

use super::splash;
use super::streak::{REACH_M, Streak, cover};
use super::wave::Wave;
use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::motion::MIDDLE;
use crate::ray::Ray;

/// Smaller ones are too many and cover too little.
const SMALLEST_M: f64 = 0.5e-3;
/// Side of the cubes in which they are counted.
const CELL_M: f64 = 1.0;
/// Places in the picture where their brightness is told, and paths at each.
const NODES: [u32; 2] = [24, 14];
const PATHS: u32 = 64;
/// Distance at which it is.
const TYPICAL_M: f32 = 3.0;
/// Refractive index of water.
pub(crate) const WATER: f32 = 1.333;

/// Draws what falls before a shot's camera into its picture.
pub(crate) fn draw(
    scene: &PreparedScene,
    shot: &Shot,
    falling: Precipitation,
    depth_m: &Raster<f32>,
    picture: &mut Raster<[f32; 3]>,
) {
    let mut streaks = in_the_open(scene, streaks(shot, scene.wind_mps, falling));
    if falling.form == Form::Rain {
        streaks.extend(splash::streaks(scene, shot, falling));
    }
    let cover = cover(&streaks, depth_m);
    let light = light(scene, shot, falling.form, depth_m);
    let (width, height) = (f64::from(picture.width), f64::from(picture.height));
    let pixel = |(i, rgb): (usize, &mut [f32; 3])| {
        let share = cover.data[i];
        if share > 0.0 {
            let (x, y) = (i as u32 % cover.width, i as u32 / cover.width);
            let at = DVec2::new((f64::from(x) + 0.5) / width, (f64::from(y) + 0.5) / height);
            *rgb = Vec3::from_array(*rgb).lerp(between(&light, at), share).to_array();
        }
    };
    picture.data.par_iter_mut().enumerate().for_each(pixel);
}

/// All of them, sheltered or not.
fn streaks(shot: &Shot, wind_mps: DVec2, falling: Precipitation) -> Vec<Streak> {
    let eye = shot.world_from_camera.translation;
    let around = (REACH_M[1] / CELL_M).ceil() as i32;
    let middle = (eye / CELL_M).floor().as_ivec3();
    let field_rad = field_rad(shot);
    let seed = Seed(shot.time_ns as u64).child("rain");
    let rows = -around..=around;
    let cells: Vec<IVec3> = rows
        .clone()
        .flat_map(|z| rows.clone().map(move |y| (y, z)))
        .flat_map(|(y, z)| rows.clone().map(move |x| IVec3::new(x, y, z)))
        .collect();
    let in_cell = |cell: &IVec3| -> Vec<Streak> {
        let cell = middle + *cell;
        if !may_be_seen(shot, field_rad, (cell.as_dvec3() + 0.5) * CELL_M) {
            return Vec::new();
        }
        let mut random = cell.to_array().into_iter().fold(seed, |seed, part| seed.nth(part as u64)).random();
        let mean = falling.pieces_per_m3(SMALLEST_M) * CELL_M.powi(3);
        let count = (mean + random.unit()) as usize;
        let mut piece = || {
            let place = DVec3::new(random.unit(), random.unit(), random.unit());
            let diameter_m = falling.diameter_m(SMALLEST_M, random.unit());
            let falls_mps = wind_mps.extend(-falling.speed_mps(diameter_m));
            Streak::new(shot, (cell.as_dvec3() + place) * CELL_M, diameter_m, falls_mps)
        };
        (0..count).filter_map(|_| piece()).collect()
    };
    cells.par_iter().flat_map_iter(in_cell).collect()
}

/// Those of them that have nothing above them.
fn in_the_open(scene: &PreparedScene, streaks: Vec<Streak>) -> Vec<Streak> {
    let is_open = |group: &[Streak]| {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); PACKET];
        rays.iter_mut()
            .zip(group)
            .for_each(|(ray, streak)| *ray = Ray { time: MIDDLE, ..Ray::new(streak.place, Vec3::Z) });
        let mut light = [Vec3::ONE; PACKET];
        scene.any(&rays[..group.len()], Coherence::Coherent, &mut light[..group.len()]);
        light.map(|light| light.min_element() > 0.5)
    };
    let open: Vec<bool> =
        streaks.par_chunks(PACKET).flat_map_iter(|group| is_open(group).into_iter().take(group.len())).collect();
    streaks.into_iter().zip(open).filter_map(|(streak, is_open)| is_open.then_some(streak)).collect()
}

/// Whether anything within a cell's reach of its middle may be in the picture.
fn may_be_seen(shot: &Shot, field_rad: f64, middle: DVec3) -> bool {
    let point = shot.world_from_camera.inverse().point(middle);
    let (distance_m, half_m) = (point.length(), CELL_M * 0.9);
    if distance_m > REACH_M[1] + half_m {
        return false;
    }
    if distance_m < 2.0 * half_m {
        return true;
    }
    point.angle_between(DVec3::Z) < field_rad + (half_m / distance_m).asin()
}

/// The widest angle to its axis at which a camera sees, by its picture's corners and the middles of its sides.
pub(crate) fn field_rad(shot: &Shot) -> f64 {
    let (width, height) = (f64::from(shot.lens.width_px), f64::from(shot.lens.height_px));
    let rim = (0..9).map(|i| DVec2::new(width * f64::from(i % 3) / 2.0, height * f64::from(i / 3) / 2.0));
    let angle = |pixel| {
        shot.lens.unproject(pixel).map_or(std::f64::consts::PI, |direction| direction.z.clamp(-1.0, 1.0).acos())
    };
    rim.map(angle).fold(0.0, f64::max)
}

/// Radiance of what falls across the picture, row by row.
fn light(scene: &PreparedScene, shot: &Shot, form: Form, depth_m: &Raster<f32>) -> Vec<Vec3> {
    let seed = shot.seed.child("rain");
    let node = |i: u32| {
        let [x, y] = [i % NODES[0], i / NODES[0]];
        let at = |k: u32, n: u32, size: u32| (f64::from(k) + 0.5) / f64::from(n) * f64::from(size);
        let pixel = DVec2::new(at(x, NODES[0], shot.lens.width_px), at(y, NODES[1], shot.lens.height_px));
        let Some(direction) = shot.lens.unproject(pixel) else { return Vec3::ZERO };
        let free_m = *depth_m.at(pixel.x as u32, pixel.y as u32) / direction.z.max(0.05) as f32;
        let towards = shot.world_from_camera.vector(direction).as_vec3();
        let origin = shot.world_from_camera.translation.as_vec3() + towards * TYPICAL_M.min(0.8 * free_m);
        let mut wave = Wave::default();
        for k in 0..PATHS {
            let mut sampler = Sampler::new(seed.0, [x, y], k, PATHS.ilog2());
            let (onwards, which) = (sampler.next2(), sampler.next2());
            let from = match form {
                Form::Rain => through_drop(towards, onwards, which[0]),
                Form::Snow => anywhere(onwards),
            };
            let cone = Cone { width_m: 0.0, spread_rad: 0.05 };
            wave.starts.push(Start { ray: Ray::new(origin, from).plain(), past: 0, cone, sampler });
        }
        wave.run(scene, None);
        wave.samples.iter().map(|sample| sample.radiance).sum::<Vec3>() / PATHS as f32
    };
    (0..NODES[0] * NODES[1]).into_par_iter().map(node).collect()
}

/// Where a ray comes from that leaves a round drop against a direction: reflected at its front or refracted twice.
fn through_drop(direction: Vec3, u: [f32; 2], which: f32) -> Vec3 {
    let [x, y] = disk(u);
    let sin = (x * x + y * y).sqrt().min(0.9999);
    let (into, inside) = (sin.asin(), (sin / WATER).asin());
    let reflected = reflectance(sin);
    let turned = if which < reflected { std::f32::consts::PI - 2.0 * into } else { 2.0 * (into - inside) };
    // Reflected away from the drop's middle, refracted towards it.
    let outwards = Basis::about(direction).to_world(Vec3::new(x, y, 0.0) / sin.max(1e-6));
    let side = if which < reflected { outwards } else { -outwards };
    (direction * turned.cos() + side * turned.sin()).normalize()
}

/// What the surface between air and water reflects of light whose way makes an angle with its normal in air, given the sine
/// (Fresnel, unpolarised).
pub(crate) fn reflectance(sin: f32) -> f32 {
    let (into, inside) = (sin.asin(), (sin / WATER).asin());
    let (s, p) = (into - inside, into + inside);
    if sin < 1e-3 {
        ((WATER - 1.0) / (WATER + 1.0)).powi(2)
    } else {
        0.5 * ((s.sin() / p.sin()).powi(2) + (s.tan() / p.tan()).powi(2))
    }
}

/// Where a ray comes from that a flake scatters: from all sides alike.
fn anywhere(u: [f32; 2]) -> Vec3 {
    let (z, turn) = (1.0 - 2.0 * u[0], std::f32::consts::TAU * u[1]);
    (Vec3::new(turn.cos(), turn.sin(), 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z)
}

/// The brightness at a place in the picture, 0 to 1 from its upper left corner.
fn between(light: &[Vec3], at: DVec2) -> Vec3 {
    let place = |c: f64, n: u32| (c * f64::from(n) - 0.5).clamp(0.0, f64::from(n - 1));
    let (x, y) = (place(at.x, NODES[0]), place(at.y, NODES[1]));
    let node = |x: f64, y: f64| {
        light[(y.min(f64::from(NODES[1] - 1)) as u32 * NODES[0] + x.min(f64::from(NODES[0] - 1)) as u32) as usize]
    };
    let (right, down) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
    let upper = node(x, y).lerp(node(x + 1.0, y), right);
    upper.lerp(node(x, y + 1.0).lerp(node(x + 1.0, y + 1.0), right), down)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::streak::looks_along_y;

    #[test]
    fn drops_cover_as_much_of_the_picture_as_the_rain_has_of_them() {
        // Of drops that are seen as large as these, hardly any are left out as too small.
        let shot = Shot { shutter: trove_model::Shutter { exposure_s: 1e-4, readout_s: 0.0 }, ..looks_along_y() };
        let rain = Precipitation { form: Form::Rain, rate_mm_h: 20.0 };
        let far = Raster::filled(400, 300, f32::INFINITY);
        let streaks: Vec<Streak> = (0..6)
            .flat_map(|i| streaks(&Shot { time_ns: i, ..shot.clone() }, DVec2::ZERO, rain))
            .filter(|streak| streak.depth_m < 4.0)
            .collect();
        let covered: f64 = cover(&streaks, &far).data.iter().map(|share| f64::from(*share)).sum::<f64>() / 6.0;
        let second_moment = |d_mm: f64| d_mm * d_mm * (-4.1 * 20.0f64.powf(-0.21) * d_mm).exp() * 1e-6;
        let steps = 10_000;
        let per_m: f64 =
            (0..steps).map(|i| second_moment(0.5 + 7.5 * (f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>()
                * 8000.0
                * 7.5
                / f64::from(steps)
                * std::f64::consts::FRAC_PI_4;
        let expected = per_m * (4.0 - REACH_M[0]) * 400.0 * 300.0;
        assert!((covered / expected - 1.0).abs() < 0.1, "{covered} {expected}");
    }

    #[test]
    fn a_drop_bends_light_as_a_ball_of_water_does() {
        // Geometric optics without diffraction: a mean cosine of 0.77 (half of 0.885 that both have together).
        let (side, mut sum) = (200, 0.0);
        for i in 0..side * side {
            let u = [(i % side) as f32 + 0.5, (i / side) as f32 + 0.5].map(|u| u / side as f32);
            let on = through_drop(Vec3::Y, u, (i as f32 * 0.618_034).fract());
            assert!(on.is_normalized());
            sum += on.dot(Vec3::Y);
        }
        let mean = sum / (side * side) as f32;
        assert!((0.72..0.84).contains(&mean), "{mean}");
    }
}
