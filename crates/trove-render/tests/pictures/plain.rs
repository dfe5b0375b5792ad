//! Pictures held to those of a path tracer that shares nothing with the renderer: every triangle is tried in double
//! precision, directions are drawn by the cosine alone, and light is found by chance.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec3};
use trove_model::{Fog, Material, Mesh, Random, Scene, Seed, Shot};

use crate::sets::{block, quad};
use crate::studio::{cube, empty, inside_out, kernels, put, renderer, shot, take, uniform};

/// Pixels along a side, and of the blocks that are compared.
const SIDE: usize = 64;
const BLOCK: usize = 8;
const BLOCKS: usize = (SIDE / BLOCK) * (SIDE / BLOCK);
/// Paths a pixel of the plain pictures, and how often they bounce; what is left then is below a part in a thousand.
const PATHS: usize = 60;
const BOUNCES: usize = 12;
/// Samples a pixel of the renderer's, and how many it takes.
const SPP: u32 = 64;
const TAKES: u64 = 6;

/// A matt triangle that shines to its front.
struct Triangle {
    corners: [DVec3; 3],
    normal: DVec3,
    albedo: DVec3,
    emission: DVec3,
}

struct Plain {
    triangles: Vec<Triangle>,
    sky: DVec3,
    fog: Option<Fog>,
}

impl Plain {
    fn new(scene: &Scene, sky: f64) -> Self {
        let of = |instance: &trove_model::Instance| {
            let (mesh, material) = (&scene.meshes[instance.mesh], &scene.materials[instance.materials[0]]);
            let corner = |i: u32| instance.world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3());
            let triangle = |t: &[u32; 3]| {
                let corners = t.map(corner);
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
                let [albedo, emission] = [material.base_color, material.emission].map(|rgb| rgb.as_dvec3());
                Triangle { corners, normal, albedo, emission }
            };
            mesh.triangles.iter().map(triangle).collect::<Vec<_>>()
        };
        Self { triangles: scene.instances.iter().flat_map(of).collect(), sky: DVec3::splat(sky), fog: scene.light.fog }
    }

    /// The nearest triangle along a ray and how far it is (Möller and Trumbore 1997).
    fn hit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, &Triangle)> {
        let distance = |triangle: &Triangle| {
            let [a, b, c] = triangle.corners;
            let (ab, ac, ao) = (b - a, c - a, origin - a);
            let (p, q) = (direction.cross(ac), ao.cross(ab));
            let det = ab.dot(p);
            let (u, v, t) = (ao.dot(p) / det, direction.dot(q) / det, ac.dot(q) / det);
            (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1e-9).then_some(t)
        };
        let hits = self.triangles.iter().filter_map(|triangle| Some((distance(triangle)?, triangle)));
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Light that comes against a ray.
    fn radiance(&self, mut origin: DVec3, mut direction: DVec3, random: &mut Random) -> DVec3 {
        let (mut light, mut share, mut bounces) = (DVec3::ZERO, DVec3::ONE, 0);
        while bounces < BOUNCES {
            let hit = self.hit(origin, direction);
            if let Some(t) = self.droplet(origin, direction, hit.as_ref().map_or(f64::INFINITY, |hit| hit.0), random) {
                origin += direction * t;
                direction = scattered(direction, random);
                continue;
            }
            let Some((distance, triangle)) = hit else { return light + share * self.sky };
            bounces += 1;
            if triangle.normal.dot(direction) < 0.0 {
                light += share * triangle.emission;
            }
            share *= triangle.albedo;
            origin += direction * distance;
            let normal = -triangle.normal * triangle.normal.dot(direction).signum();
            // A point on the unit sphere around the normal's tip lies in a direction drawn by its cosine.
            let z = random.range(-1.0, 1.0);
            let around = DVec2::from_angle(random.range(0.0, std::f64::consts::TAU)) * (1.0 - z * z).sqrt();
            direction = (normal + around.extend(z)).normalize();
            origin += normal * 1e-9;
        }
        light
    }

    /// How far it is to the first droplet nearer than `most`: of those in fog as thick as it is on the ground, which is at 0
    /// and below which there is none, as many are taken away as there are less (Woodcock et al. 1965).
    fn droplet(&self, origin: DVec3, direction: DVec3, most: f64, random: &mut Random) -> Option<f64> {
        let fog = self.fog?;
        let mut t = 0.0;
        loop {
            t -= (1.0 - random.unit()).ln() * fog.visibility_m / 20.0f64.ln();
            let z = origin.z + direction.z * t;
            if t >= most || z < 0.0 || z > 40.0 * fog.height_m {
                return None;
            }
            if random.unit() < (-z / fog.height_m).exp() {
                return Some(t);
            }
        }
    }

    /// Means of the picture's blocks, from [`TAKES`] independent pictures.
    fn blocks(&self, shot: &Shot) -> Vec<[DVec3; BLOCKS]> {
        let (lens, pose) = (&shot.lens, shot.world_from_camera);
        let rotation = DMat3::from_quat(pose.rotation);
        let take = |seed| {
            let mut random = Seed(seed).random();
            let mut blocks = [DVec3::ZERO; BLOCKS];
            for i in (0..SIDE * SIDE).flat_map(|i| std::iter::repeat_n(i, PATHS)) {
                let pixel = DVec2::new((i % SIDE) as f64 + random.unit(), (i / SIDE) as f64 + random.unit());
                let at = (pixel - DVec2::new(lens.cx_px, lens.cy_px)) / DVec2::new(lens.fx_px, lens.fy_px);
                let light = self.radiance(pose.translation, (rotation * at.extend(1.0)).normalize(), &mut random);
                blocks[block_of(i)] += light / (PATHS * BLOCK * BLOCK) as f64;
            }
            blocks
        };
        (0..TAKES).map(take).collect()
    }
}

/// A direction after a droplet, by Henyey and Greenstein's function of the cosine with 0.85: of all directions alike, as many
/// are kept as it says.
fn scattered(direction: DVec3, random: &mut Random) -> DVec3 {
    loop {
        let z = random.range(-1.0, 1.0);
        let around = DVec2::from_angle(random.range(0.0, std::f64::consts::TAU)) * (1.0 - z * z).sqrt();
        let on = around.extend(z);
        if random.unit() < (0.15f64.powi(2) / (1.7225 - 1.7 * on.dot(direction))).powf(1.5) {
            return on;
        }
    }
}

/// The block of a pixel.
fn block_of(pixel: usize) -> usize {
    pixel / SIDE / BLOCK * (SIDE / BLOCK) + pixel % SIDE / BLOCK
}

/// Mean of independent pictures' blocks, and the variance of that mean.
fn statistics(pictures: &[[DVec3; BLOCKS]]) -> [[DVec3; BLOCKS]; 2] {
    let n = pictures.len() as f64;
    let mean = std::array::from_fn(|i| pictures.iter().map(|picture| picture[i]).sum::<DVec3>() / n);
    let square = |i: usize| pictures.iter().map(|picture| (picture[i] - mean[i]).powf(2.0)).sum::<DVec3>();
    [mean, std::array::from_fn(|i| square(i) / (n * (n - 1.0)))]
}

fn matt(color: Vec3) -> Material {
    Material { ior: 1.0, ..Material::plain("matt", color, 0.0) }
}

/// A shot of [`SIDE`] × [`SIDE`] pixels.
fn large(small: Shot) -> Shot {
    let mut shot = Shot { spp: SPP, ..small };
    let scale = SIDE as f64 / f64::from(shot.lens.width_px);
    (shot.lens.width_px, shot.lens.height_px) = (SIDE as u32, SIDE as u32);
    for length in [&mut shot.lens.fx_px, &mut shot.lens.fy_px, &mut shot.lens.cx_px, &mut shot.lens.cy_px] {
        *length *= scale;
    }
    shot
}

/// Walls of three colours, a turned block, and a lamp out of sight. As dark as streets are: light that has met more surfaces
/// than the renderer follows does not count.
fn room() -> (Scene, Shot) {
    // Nothing of this sky comes in, but it says how bright the brightest samples may be.
    let mut scene = empty(uniform(1.0));
    put(&mut scene, inside_out(cube()), matt(Vec3::splat(0.35)), block(DVec3::Z, DVec3::ONE));
    let beside = |x: f32| quad(Vec3::new(x, x.signum(), 0.0), Vec3::Y * -2.0 * x.signum(), Vec3::Z * 2.0);
    put(&mut scene, beside(-0.99), matt(Vec3::new(0.4, 0.05, 0.05)), DAffine3::IDENTITY);
    put(&mut scene, beside(0.99), matt(Vec3::new(0.05, 0.35, 0.08)), DAffine3::IDENTITY);
    let turned = DQuat::from_rotation_z(0.4);
    let tall =
        DAffine3::from_scale_rotation_translation(DVec3::new(0.25, 0.25, 0.5), turned, DVec3::new(0.3, 0.3, 0.5));
    put(&mut scene, cube(), matt(Vec3::splat(0.4)), tall);
    let lamp = Material { emission: Vec3::splat(2.0), ..matt(Vec3::splat(0.1)) };
    put(&mut scene, cube(), lamp, block(DVec3::new(0.0, 0.0, 1.97), DVec3::new(0.8, 0.8, 0.01)));
    (scene, large(shot(DVec3::new(0.0, -0.95, 1.0), DVec3::new(0.0, 1.0, 0.5), 0.9)))
}

/// A block in the corner of two walls under an even sky.
fn yard() -> (Scene, Shot) {
    let mut scene = empty(uniform(1.0));
    let ground = quad(Vec3::new(-6.0, -6.0, 0.0), Vec3::X * 12.0, Vec3::Y * 12.0);
    put(&mut scene, ground, matt(Vec3::new(0.5, 0.45, 0.4)), DAffine3::IDENTITY);
    let wall: Mesh = quad(Vec3::new(-6.0, 1.5, 0.0), Vec3::X * 12.0, Vec3::Z * 3.0);
    put(&mut scene, wall, matt(Vec3::new(0.7, 0.3, 0.2)), DAffine3::IDENTITY);
    put(&mut scene, cube(), matt(Vec3::new(0.2, 0.4, 0.8)), block(DVec3::new(0.2, 0.6, 0.5), DVec3::splat(0.5)));
    (scene, large(shot(DVec3::new(-1.5, -5.0, 2.5), DVec3::new(0.2, 0.6, 0.6), 1.8)))
}

/// How often light from a sun of that height (sine) strikes the ground below a layer of fog, each photon in the mean: it
/// meets every droplet, and what the ground reflects comes down again.
pub(crate) fn hits_below_fog(depth: f64, g: f64, height: f64, albedo: f64, photons: u32) -> f64 {
    let mut random = Seed(8).random();
    let mut hits = 0u32;
    for _ in 0..photons {
        // Depth below the top, and the cosine downwards.
        let (mut at, mut down) = (0.0, height);
        while at >= 0.0 {
            at -= (1.0 - random.unit()).ln() * down;
            if at > depth {
                hits += 1;
                if random.unit() >= albedo {
                    break;
                }
                (at, down) = (depth, -random.unit().sqrt());
            } else if at >= 0.0 {
                let inner = (1.0 - g * g) / (1.0 - g + 2.0 * g * random.unit());
                let (cos, turn) = ((1.0 + g * g - inner * inner) / (2.0 * g), std::f64::consts::TAU * random.unit());
                down = (down * cos + ((1.0 - down * down) * (1.0 - cos * cos)).max(0.0).sqrt() * turn.cos())
                    .clamp(-1.0, 1.0);
            }
        }
    }
    f64::from(hits) / f64::from(photons)
}

/// The same yard in fog that hides its wall.
fn foggy_yard() -> (Scene, Shot) {
    let (mut scene, shot) = yard();
    scene.light.fog = Some(Fog { visibility_m: 10.0, height_m: 3.0, ground_z_m: 0.0 });
    (scene, shot)
}

#[test]
fn pictures_are_those_of_a_path_tracer_without_any_of_our_code() {
    // The plain pictures' own noise leaves that much in all and in a block.
    let sets = [("room", room(), 0.02, 0.12), ("yard", yard(), 0.005, 0.03), ("fog", foggy_yard(), 0.005, 0.03)];
    for (name, (scene, shot), most_bias, most_off) in sets {
        let [plain, plain_error] = statistics(&Plain::new(&scene, 1.0).blocks(&shot));
        for kernel in kernels() {
            let renderer = renderer(kernel, 2);
            let take = |seed| {
                let picture = take(&renderer, &scene, &Shot { seed: Seed(seed), ..shot.clone() });
                let mut blocks = [DVec3::ZERO; BLOCKS];
                for (i, rgb) in picture.data.iter().enumerate() {
                    blocks[block_of(i)] += Vec3::from_array(*rgb).as_dvec3() / (BLOCK * BLOCK) as f64;
                }
                blocks
            };
            let [ours, error] = statistics(&(0..TAKES).map(take).collect::<Vec<_>>());
            let sum = |blocks: &[DVec3; BLOCKS]| blocks.iter().sum::<DVec3>().element_sum();
            let bias = sum(&ours) / sum(&plain) - 1.0;
            assert!(bias.abs() < most_bias, "{kernel:?}, {name}: {bias}");
            let mut squares = DVec3::ZERO;
            for (i, (ours, plain)) in ours.iter().zip(&plain).enumerate() {
                let off = (*ours - *plain).abs();
                squares += off * off / (error[i] + plain_error[i]) / BLOCKS as f64;
                let off = (off / *plain).max_element();
                assert!(off < most_off, "{kernel:?}, {name}: block {i} is {ours}, not {plain}");
            }
            // In units of the noise of both; few pictures tell it roughly.
            assert!(squares.max_element() < 3.0, "{kernel:?}, {name}: mean z² = {squares}");
        }
    }
}
