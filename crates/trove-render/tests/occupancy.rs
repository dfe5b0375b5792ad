//! What fills the cells of a grid, and who sees them: against closed forms.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec2, Vec3};
use trove_model::{
    Class, ClassMap, ColorSpace, Distortion, Environment, EnvironmentMap, GridForm, GridFrame, GridPlan, GridShot,
    Instance, InstanceId, Lens, LidarShot, Light, Material, Mesh, Occupancy, Pose, Scanner, Scene, Seed, SensorFrame,
    Shot, SweepPhase, Texture, ToldReturns, VoxelGrid, World,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

const FREE: u8 = 17;
const CAR: u8 = 4;
const ROAD: u8 = 11;
const MANMADE: u8 = 15;
const GRID: VoxelGrid = VoxelGrid { low_m: DVec3::new(-40.0, -40.0, -1.0), voxel_m: 0.4, counts: [200, 200, 16] };

/// The vehicle, far from the origin and turned.
fn world_from_grid() -> Pose<World, SensorFrame> {
    Pose::from_yaw(0.4, DVec3::new(412.3, -633.7, 14.0))
}

#[test]
fn a_box_on_a_road_fills_the_cells_that_it_reaches_into() {
    let instances = || vec![ground(-0.13), boxed(7, Class::Car, DVec3::new(10.1, 3.1, 0.9), DVec3::new(4.1, 1.9, 1.5))];
    for is_solid in [true, false] {
        let cells = filled(&scene(instances()), &shot(is_solid));
        for (index, &label) in cells.labels.iter().enumerate() {
            let [x, y, z] = GRID.cell(index);
            // From 8.05, 2.15 and 0.15 to 12.15, 4.05 and 1.65.
            let in_box = (120..=130).contains(&x) && (105..=110).contains(&y) && (2..=6).contains(&z);
            let within = (121..=129).contains(&x) && (106..=109).contains(&y) && (3..=5).contains(&z);
            let expected = match (in_box, z) {
                (true, _) if is_solid || !within => CAR,
                (false, 2) => ROAD,
                _ => FREE,
            };
            assert_eq!(label, expected, "{x} {y} {z}");
            assert_eq!(cells.instances[index], InstanceId(if expected == CAR { 7 } else { 0 }));
        }
    }
}

#[test]
fn a_house_without_a_floor_is_filled_and_a_gateway_is_not() {
    let (middle, size) = (DVec3::new(-20.1, 0.1, 1.6), DVec3::new(12.0, 8.0, 3.1));
    for (left_out, expected) in [(4, MANMADE), (0, FREE)] {
        // The bottom, or the two sides across x.
        let missing = if left_out == 4 { vec![4] } else { vec![0, 1] };
        let mut house = boxed(9, Class::Building, middle, size);
        house.mesh = 2;
        let mut scene = scene(vec![ground(-0.13), house]);
        scene.meshes.push(Arc::new(cube(&missing)));
        let cells = filled(&scene, &shot(true));
        let at = |p: DVec3| GRID.index(((p - GRID.low_m) / GRID.voxel_m).floor().to_array().map(|i| i as usize));
        assert_eq!(cells.labels[at(middle)], expected);
        assert_eq!(cells.labels[at(middle + DVec3::Z * 2.5)], FREE, "above the roof");
    }
}

#[test]
fn the_larger_surface_names_a_cell_and_holes_are_no_surface() {
    let within = |class, size, at| boxed(0, class, at, size);
    // In the cell from [4, 4, 0.6] on.
    let corner = DVec3::new(4.2, 4.2, 0.8);
    let (small, large) = (DVec3::new(0.1, 0.1, 0.1), DVec3::new(0.1, 0.1, 0.2));
    let index = GRID.index([110, 110, 4]);
    for (sidewalk, road, expected) in [(small, large, ROAD), (large, small, 13)] {
        let both = vec![
            within(Class::Sidewalk, sidewalk, corner + DVec3::X * 0.1),
            within(Class::Road, road, corner - DVec3::X * 0.1),
        ];
        let cells = filled(&scene(both), &shot(true));
        assert_eq!(cells.labels[index], expected);
        assert_eq!(cells.labels.iter().filter(|label| **label != FREE).count(), 1);
    }
    let mut leaves = boxed(3, Class::Tree, corner, small);
    leaves.materials = vec![1];
    assert_eq!(filled(&scene(vec![leaves]), &shot(true)).labels, vec![FREE; GRID.len()]);
}

#[test]
fn what_stands_behind_a_wall_is_not_seen() {
    let wall = boxed(5, Class::Building, DVec3::new(10.3, 0.1, 4.0), DVec3::new(0.2, 40.0, 12.0));
    let lens = Lens {
        width_px: 180,
        height_px: 120,
        fx_px: 120.0,
        fy_px: 120.0,
        cx_px: 90.0,
        cy_px: 60.0,
        distortion: Distortion::None,
    };
    let eye = DVec3::new(0.1, 0.1, 1.7);
    let ahead = DQuat::from_mat3(&DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X));
    let grid = world_from_grid();
    let camera = Shot::new("ego.CAM", lens, Pose::new(grid.rotation * ahead, grid.point(eye)));
    let camera = Shot { carrier: Some(InstanceId(1)), ..camera };
    let lidar = LidarShot {
        view: "ego.LIDAR".into(),
        scanner: Scanner {
            name: "level".into(),
            elevations_rad: vec![0.0],
            width_rad: std::f64::consts::TAU,
            columns: 720,
            sweep_s: 0.1,
            divergence_rad: 0.0,
            nearest_m: 1.0,
            farthest_m: 30.0,
            reach_m: 100.0,
            noise_m: 0.0,
            pulse_m: 0.5,
            intensity_exponent: 1.0,
            told: ToldReturns::Strongest,
        },
        phase: SweepPhase::FORWARD,
        time_ns: 0,
        world_from_lidar: Pose::new(grid.rotation, grid.point(eye)),
        world_from_ego: Pose::from_yaw(0.0, DVec3::ZERO),
        way: vec![Pose::new(grid.rotation, grid.point(eye)); 2],
        seed: Seed(1),
        carrier: None,
    };
    let shot = GridShot { cameras: vec![camera], lidars: vec![lidar], ..shot(true) };
    let cells = filled(&scene(vec![ground(-0.13), wall]), &shot);
    let wall_cell = 125; // from 10.0 to 10.4: the wall begins at 10.2
    let (mut before, mut behind) = (0, 0);
    for index in 0..GRID.len() {
        let [x, y, z] = GRID.cell(index);
        let way = GRID.centre_m([x, y, z]) - eye;
        let in_picture = way.x > 1.0 && (way.y / way.x).abs() < 0.7 && (way.z / way.x).abs() < 0.45;
        let seen = cells.seen_by_cameras[index];
        if x > wall_cell || z < 2 || way.x < -0.4 {
            assert!(!seen, "{x} {y} {z}");
            behind += 1;
        } else if in_picture && x <= wall_cell {
            assert!(seen, "{x} {y} {z}");
            before += 1;
        }
        let by_lidar = cells.seen_by_lidars[index];
        // It turns in the layer of its own height, and beams that meet nothing tell nothing.
        assert!(!by_lidar || z == 6 && x <= wall_cell && way.x > 0.0, "{x} {y} {z}");
        assert!(by_lidar || z != 6 || x > wall_cell || !in_picture, "{x} {y} {z}");
    }
    assert!(before > 5000 && behind > 100_000, "{before} {behind}");
}

/// With the built-in kernel, and with Embree where `TROVE_EMBREE` says that there is one, and with one thread and two.
fn filled(scene: &Scene, shot: &GridShot) -> Occupancy {
    let embree = std::env::var_os("TROVE_EMBREE");
    let by = |kernel, threads| {
        let search = embree.iter().map(Into::into).collect();
        let renderer =
            Renderer::new(&RendererOptions { kernel, denoise: Denoising::None, threads, search, ..Default::default() })
                .unwrap();
        renderer.occupancy(&renderer.prepare(scene).unwrap(), shot)
    };
    let found = by(KernelChoice::Obvhs, 1);
    assert!(by(KernelChoice::Obvhs, 2) == found, "threads change nothing");
    if embree.is_some() {
        assert!(by(KernelChoice::Embree, 2) == found, "Embree finds the same");
    }
    found
}

fn shot(is_solid: bool) -> GridShot {
    let plan = GridPlan {
        name: "test".into(),
        grid: GRID,
        frame: GridFrame::Ego,
        classes: ClassMap::named("occ3d").unwrap(),
        is_solid,
        form: GridForm::Dense,
    };
    GridShot {
        map: Vec::new(),
        view: "ego.TEST".into(),
        plan: Arc::new(plan),
        world_from_grid: world_from_grid(),
        world_from_ego: Pose::IDENTITY,
        time_ns: 0,
        absent: Some(InstanceId(1)),
        cameras: Vec::new(),
        lidars: Vec::new(),
    }
}

fn scene(mut instances: Vec<Instance>) -> Scene {
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    let clear =
        Texture { name: "clear".into(), width: 8, height: 8, rgba: vec![[0; 4]; 64], color_space: ColorSpace::Srgb };
    let leaves = Material { base_color_map: Some(Arc::new(clear)), alpha_cutoff: 0.5, ..Material::default() };
    // The vehicle itself, which is not there.
    instances.push(boxed(1, Class::Car, DVec3::new(1.5, 0.0, 0.8), DVec3::new(4.5, 1.8, 1.3)));
    for instance in &mut instances {
        instance.world_from_mesh = world_from_grid().affine() * instance.world_from_mesh;
    }
    Scene {
        meshes: vec![Arc::new(square()), Arc::new(cube(&[]))],
        materials: vec![Material::default(), leaves],
        instances: instances.into_iter().map(Instance::at_rest).collect(),
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

fn ground(z_m: f64) -> Instance {
    Instance { mesh: 0, ..boxed(0, Class::Road, DVec3::Z * z_m, DVec3::ONE) }
}

/// A box along the grid's axes.
fn boxed(id: u32, class: Class, centre_m: DVec3, size_m: DVec3) -> Instance {
    Instance {
        id: InstanceId(id),
        class,
        mesh: 1,
        materials: vec![0],
        world_from_mesh: DAffine3::from_scale_rotation_translation(size_m, DQuat::IDENTITY, centre_m),
        previous: None,
        next: None,
        object: None,
    }
}

fn square() -> Mesh {
    let corners = [(-300.0, -300.0), (300.0, -300.0), (300.0, 300.0), (-300.0, 300.0)];
    Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Side 1 around the origin; without some of its faces: lower and upper x, then y, then z.
fn cube(missing: &[usize]) -> Mesh {
    let mut mesh = Mesh::default();
    for face in (0..6).filter(|face| !missing.contains(face)) {
        let (axis, side) = (face / 2, [-0.5, 0.5][face % 2]);
        let base = mesh.positions.len() as u32;
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let mut p = Vec3::ZERO;
            p[axis] = side;
            p[(axis + 1) % 3] = u - 0.5;
            p[(axis + 2) % 3] = v - 0.5;
            mesh.positions.push(p);
            mesh.uvs.push(Vec2::new(u, v));
        }
        mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }
    mesh
}
