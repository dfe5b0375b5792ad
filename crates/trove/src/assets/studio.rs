//! A place to take a picture of one model or material in.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec2, Vec3};
use trove_model::{
    Asset, AssetLibrary, Camera, Class, Distortion, Environment, ExposureRule, Film, Instance, InstanceId, Lens, Light,
    Material, Mesh, PhysicalSky, Pose, Scene, Seed, Shot, Surface, SurfaceKind, World,
};

/// Vertical angle of view, radians: that of a short telephoto lens.
const VIEW_RAD: f64 = 0.42;
/// Height of the camera above what it looks at, radians.
const ELEVATION_RAD: f64 = 0.16;
/// Share of the picture that the box around the thing fills.
const FILL: f64 = 0.98;
/// Side of the ground, metres: its edge is the horizon.
const GROUND_M: f32 = 4000.0;
/// The pictures are as bright as a photographer would have them who meters on the thing, stops.
const BRIGHTER_EV: f64 = 0.4;

/// How pictures are taken.
pub(super) struct Studio {
    pub size_px: [u32; 2],
    pub spp: u32,
    pub seed: u64,
    pub turn_deg: f64,
    /// `None`: a clear afternoon.
    pub environment: Option<Environment>,
}

/// What is shown.
#[derive(Clone, Copy)]
pub(super) enum Subject<'a> {
    Model(&'a Asset),
    /// A material, on a wall and a ball.
    Sample(&'a Surface),
}

impl Subject<'_> {
    pub(super) fn id(&self) -> &str {
        match self {
            Self::Model(asset) => &asset.id,
            Self::Sample(surface) => &surface.id,
        }
    }
}

impl Studio {
    /// The scene around it and the camera before it.
    pub(super) fn set(&self, library: &AssetLibrary, subject: Subject) -> (Scene, Shot) {
        let seed = Seed(self.seed);
        let (class, mesh, materials) = match subject {
            Subject::Model(asset) => {
                let seed = seed.child(&asset.id);
                let mesh = asset.with_extras(&asset.drawn_extras(true, seed));
                (asset.class, mesh, asset.materials(seed, None))
            }
            Subject::Sample(surface) => (Class::Void, Arc::new(sample()), vec![surface.material.clone()]),
        };
        let (low, high) = mesh.bounds().unwrap_or_default();
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let asphalt = library.surfaces_of(SurfaceKind::Asphalt).last().map(|s| s.material.clone());
        let mut all = vec![asphalt.unwrap_or_else(|| Material::plain("ground", Vec3::splat(0.15), 0.9))];
        all.extend(materials);
        let slots = (1..all.len()).collect();
        let instances = vec![instance(0, Class::Road, 0, vec![0]), instance(1, class, 1, slots)];
        let scene = Scene {
            meshes: vec![Arc::new(ground(GROUND_M)), mesh],
            materials: all,
            instances,
            others: Default::default(),
            keyframes_apart_s: [f64::INFINITY; 2],
            light: Light::clear(self.environment.clone().unwrap_or(Environment::Sky(afternoon()))),
            provenance: Vec::new(),
        };
        (scene, self.shot(low, high))
    }

    /// A camera before the front's left that sees the whole box.
    fn shot(&self, low: DVec3, high: DVec3) -> Shot {
        let [width_px, height_px] = self.size_px;
        let (width, height) = (f64::from(width_px), f64::from(height_px));
        let focal_px = height / 2.0 / (VIEW_RAD / 2.0).tan();
        let lens = Lens {
            width_px,
            height_px,
            fx_px: focal_px,
            fy_px: focal_px,
            cx_px: width / 2.0,
            cy_px: height / 2.0,
            distortion: Distortion::None,
        };
        let (sin, cos) = self.turn_deg.to_radians().sin_cos();
        let (rise, level) = ELEVATION_RAD.sin_cos();
        let backward = DVec3::new(cos * level, sin * level, rise);
        let right = DVec3::new(-sin, cos, 0.0);
        let down = right.cross(backward);
        let middle = (low + high) / 2.0;
        let slope = DVec3::new(width, height, 0.0) / 2.0 / focal_px * FILL;
        let corner = |i: usize| DVec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low) - middle;
        let needed_m = |c: DVec3| (c.dot(right).abs() / slope.x).max(c.dot(down).abs() / slope.y) + c.dot(backward);
        let distance_m = (0..8).map(corner).map(needed_m).fold(0.1, f64::max);
        let rotation = DQuat::from_mat3(&DMat3::from_cols(right, down, -backward));
        let world_from_camera = Pose::<World, Camera>::new(rotation, middle + backward * distance_m);
        let film = Film { exposure: ExposureRule::Auto { compensation_ev: BRIGHTER_EV }, ..Film::default() };
        Shot { spp: self.spp, film, seed: Seed(self.seed), ..Shot::new("sheet", lens, world_from_camera) }
    }
}

/// Sun from behind the camera's left.
fn afternoon() -> PhysicalSky {
    let (elevation, azimuth) = (0.75f64, 1.25f64);
    let to_sun = DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin());
    PhysicalSky { to_sun, moon: None, turbidity: 3.0, ground_albedo: 0.2, cloud_cover: 0.25, cloud_seed: 3 }
}

fn instance(id: u32, class: Class, mesh: usize, materials: Vec<usize>) -> Instance {
    Instance {
        id: InstanceId(id),
        class,
        mesh,
        materials,
        world_from_mesh: DAffine3::IDENTITY,
        previous: None,
        next: None,
        object: None,
    }
    .at_rest()
}

fn ground(side_m: f32) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|c| Vec2::from_array(c) * side_m / 2.0);
    Mesh {
        positions: corners.map(|c| c.extend(-1e-3)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A ball of a metre before a wall of three by two, with uvs in metres.
fn sample() -> Mesh {
    let (around, up, radius) = (48u32, 24u32, 0.5);
    let mut ball = Mesh::default();
    for row in 0..=up {
        for column in 0..=around {
            let (azimuth, polar) = (column as f32 / around as f32, row as f32 / up as f32);
            let (sin, cos) = (azimuth * std::f32::consts::TAU).sin_cos();
            let (ring, z) = (polar * std::f32::consts::PI).sin_cos();
            let normal = Vec3::new(ring * cos, ring * sin, -z);
            ball.positions.push(normal * radius + Vec3::new(0.9, -0.5, radius));
            ball.normals.push(normal);
            ball.uvs.push(Vec2::new(azimuth * std::f32::consts::TAU, polar * std::f32::consts::PI) * radius);
            if row < up && column < around {
                let a = row * (around + 1) + column;
                let b = a + around + 1;
                ball.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
            }
        }
    }
    let wall = [[-1.5, 0.0], [1.5, 0.0], [1.5, 2.0], [-1.5, 2.0]].map(Vec2::from_array);
    let wall = Mesh {
        positions: wall.map(|c| Vec3::new(0.0, c.x, c.y)).to_vec(),
        normals: vec![Vec3::X; 4],
        uvs: wall.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    ball.append(&wall, 0);
    ball
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_thing_is_in_the_picture_and_fills_it() {
        for size_m in [[4.5, 1.8, 1.5], [0.3, 0.3, 6.0], [12.0, 0.2, 1.0]] {
            let (low, high) = (DVec3::ZERO, DVec3::from_array(size_m));
            let studio = Studio { size_px: [400, 300], spp: 1, seed: 1, turn_deg: 35.0, environment: None };
            let shot = studio.shot(low, high);
            let corner = |i: usize| DVec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low);
            let pixels: Vec<_> =
                (0..8).map(|i| shot.lens.project(shot.world_from_camera.inverse().point(corner(i))).unwrap()).collect();
            assert!(pixels.iter().all(|p| (0.0..400.0).contains(&p.x) && (0.0..300.0).contains(&p.y)), "{pixels:?}");
            let reach = pixels.iter().map(|p| ((p.x - 200.0).abs() / 200.0).max((p.y - 150.0).abs() / 150.0));
            assert!(reach.fold(0.0, f64::max) > FILL - 1e-6);
        }
    }

    #[test]
    fn a_sample_is_sound() {
        let mesh = sample();
        assert_eq!(mesh.defect(), None);
        let out = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a).dot(mesh.normals[t[1] as usize]) > -1e-6
        };
        assert!(mesh.triangles.iter().all(out));
    }
}
