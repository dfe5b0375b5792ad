//! Small made-up drives and libraries for tests.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use glam::{DMat3, DQuat, DVec2, DVec3, Vec3};
use trove_model::{
    Asset, AssetLibrary, Bounds, BuildingCustoms, Camera, Cuboid, Distortion, Drive, DriveOrigin, Ego, EgoBody,
    Exposure, HeightField, Keyframe, Kind, Lane, LaneMap, Lens, Locale, MapProjection, Material, Mesh, ObjectBox,
    Polygon, Pose, Report, RigCamera, Road, RoadKind, Seed, Slot, StreetMap, Track, Trajectory,
};
use trove_read::locale::Locales;

use crate::agreement::OnDisagreement;
use crate::assembly::Weather;
use crate::ground::Spans;
use crate::light::LightChoice;
use crate::place::{Conditions, Place, Seeds};
use crate::roads::{self, RoadSurfaces};
use crate::site::BuildSettings;
use crate::traffic::Traffic;

static LOCALES: LazyLock<Locales> = LazyLock::new(Locales::built_in);

/// A country's customs, from the built-in table.
pub(crate) fn locale(country: &str) -> Locale {
    LOCALES.country(country).unwrap().clone()
}

/// A dry day in Singapore, with the recorded traffic alone and the model that fits best.
pub(crate) fn settings() -> BuildSettings {
    BuildSettings {
        seeds: Seed(1).into(),
        top_k: 1,
        traffic: Traffic::default(),
        light: LightChoice::default(),
        weather: Weather::default(),
        on_disagreement: OnDisagreement::default(),
        invent: false,
        locale: locale("SG"),
        borders: None,
    }
}

/// How a country builds.
pub(crate) fn building_customs(country: &str) -> &'static BuildingCustoms {
    &LOCALES.country(country).unwrap().buildings
}

/// A block that is its own bounding box, with three paints.
pub(crate) fn asset(id: &str, kind: Kind, size_m: [f64; 3]) -> Asset {
    let half = DVec3::from_array(size_m) / 2.0;
    let corner = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        (DVec3::new(sign(0), sign(1), sign(2)) * half + DVec3::Z * half.z).as_vec3()
    };
    let mesh = Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: vec![[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6]],
        ..Mesh::default()
    };
    let paints = vec![Vec3::X, Vec3::Y, Vec3::Z];
    let slots = vec![Slot::new(Material::plain(id, Vec3::ONE, 0.5), paints)];
    Asset { size_m: DVec3::from_array(size_m), ..Asset::new(id, kind, kind.class(), mesh, slots, "test") }
}

/// Four cars, two of each plant and of everything else one.
pub(crate) fn library() -> AssetLibrary {
    let mut assets = vec![
        asset("car/a", Kind::Car, [4.5, 1.8, 1.5]),
        asset("car/b", Kind::Car, [4.4, 1.8, 1.5]),
        asset("car/c", Kind::Car, [4.6, 1.9, 1.5]),
        asset("car/limousine", Kind::Car, [9.0, 1.8, 1.5]),
        asset("truck/a", Kind::Truck, [8.0, 2.5, 3.2]),
        asset("person/a", Kind::Adult, [0.5, 0.6, 1.75]),
        asset("tree/a", Kind::Tree, [5.0, 5.0, 8.0]),
        asset("tree/b", Kind::Tree, [4.0, 4.0, 6.0]),
        asset("bush/a", Kind::Bush, [1.2, 1.2, 1.0]),
        asset("bush/b", Kind::Bush, [1.0, 1.0, 0.8]),
        asset("lamp/a", Kind::StreetLamp, [2.0, 0.3, 8.0]),
        asset("sign/a", Kind::TrafficSign, [0.1, 0.6, 2.6]),
        asset("signal/a", Kind::TrafficSignal, [0.4, 0.4, 4.0]),
        asset("bench/a", Kind::Bench, [0.6, 1.8, 0.8]),
    ];
    assets.sort_by(|a, b| a.id.cmp(&b.id));
    AssetLibrary { assets, ..AssetLibrary::default() }
}

/// A street along x: carriageway from y = −4 to 12, sidewalks of 3 m on both sides.
fn street() -> LaneMap {
    let strip = |low: f64, high: f64| {
        let corners = [[-250.0, low], [250.0, low], [250.0, high], [-250.0, high]];
        Polygon::simple(corners.map(DVec2::from_array).to_vec())
    };
    let lane = |token: &str, low: f64, high: f64, ends: [f64; 2]| Lane {
        token: token.into(),
        polygon: strip(low, high),
        centreline: ends.map(|x| DVec2::new(x, (low + high) / 2.0)).to_vec(),
    };
    LaneMap {
        drivable: vec![strip(-4.0, 12.0)],
        lanes: vec![lane("east", -2.0, 2.0, [-250.0, 250.0]), lane("west", 2.0, 6.0, [250.0, -250.0])],
        walkways: vec![strip(-7.0, -4.0), strip(12.0, 15.0)],
        ..LaneMap::default()
    }
}

/// The surfaces of a drive on some ground.
pub(crate) fn surfaces(drive: &Drive, ground: &HeightField) -> RoadSurfaces {
    surfaces_on(drive, None, ground)
}

/// The same where there is a street map.
pub(crate) fn surfaces_on(drive: &Drive, map: Option<&StreetMap>, ground: &HeightField) -> RoadSurfaces {
    let bounds = crate::site::area(drive).unwrap();
    let (library, seeds, report) = (library(), Seed(0).into(), Report::default());
    roads::surfaces(&place(drive, map, bounds, ground, &library, &seeds, &report), &Spans::default(), None)
}

/// What a place in Singapore is built from, in the climate and season of the made-up drive.
pub(crate) fn place<'a>(
    drive: &'a Drive,
    map: Option<&'a StreetMap>,
    bounds: Bounds,
    ground: &'a HeightField,
    library: &'a AssetLibrary,
    seeds: &'a Seeds,
    report: &'a Report,
) -> Place<'a> {
    static SINGAPORE: LazyLock<Locale> = LazyLock::new(|| locale("SG"));
    Place {
        drive,
        map,
        is_assumed: false,
        invents: false,
        bounds,
        ground,
        library,
        locale: &SINGAPORE,
        conditions: conditions(),
        seeds,
        report,
    }
}

/// The climate and season of the made-up drive.
pub(crate) fn conditions() -> Conditions {
    Conditions::new(&drive(), 0, None)
}

/// Ten keyframes half a second apart, 5 m along x each; a parked car, a moving car ahead, a truck coming, a person.
pub(crate) fn drive() -> Drive {
    let camera_from = |yaw: f64| {
        let forward = DQuat::from_mat3(&DMat3::from_cols(-DVec3::Y, -DVec3::Z, DVec3::X));
        Pose::<Ego, Camera>::new(DQuat::from_rotation_z(yaw) * forward, DVec3::new(1.7, 0.0, 1.5))
    };
    let lens = Lens {
        width_px: 160,
        height_px: 90,
        fx_px: 126.0,
        fy_px: 126.0,
        cx_px: 80.0,
        cy_px: 45.0,
        distortion: Distortion::None,
    };
    let camera = |name: &str, yaw| RigCamera { name: name.into(), lens, ego_from_camera: camera_from(yaw) };
    let rig = vec![camera("CAM_BACK", std::f64::consts::PI), camera("CAM_FRONT", 0.0)];
    let path = |k: usize| Pose::from_yaw(0.0, DVec3::new(5.0 * k as f64, 0.0, 0.0));
    let cast = [
        ("parked", Kind::Car, DVec3::new(20.0, 6.0, 0.8), DVec3::ZERO, [4.5, 1.8, 1.6]),
        ("ahead", Kind::Car, DVec3::new(15.0, 0.0, 0.8), DVec3::new(10.0, 0.0, 0.0), [4.5, 1.8, 1.6]),
        ("coming", Kind::Truck, DVec3::new(60.0, 3.5, 1.6), DVec3::new(-8.0, 0.0, 0.0), [8.0, 2.5, 3.2]),
        ("walking", Kind::Adult, DVec3::new(30.0, -6.0, 0.9), DVec3::new(1.2, 0.0, 0.0), [0.6, 0.7, 1.8]),
    ];
    let cuboid = |k: usize, (_, _, start, velocity, size): (&str, Kind, DVec3, DVec3, [f64; 3])| Cuboid {
        world_from_body: Pose::from_yaw(
            if velocity.x < 0.0 { std::f64::consts::PI } else { 0.0 },
            start + velocity * 0.5 * k as f64,
        ),
        size_m: DVec3::from_array(size),
    };
    let keyframe = |k: usize| Keyframe {
        time_ns: 1_532_402_927_000_000_000 + k as i64 * 500_000_000,
        token: format!("keyframe-{k}"),
        world_from_ego: path(k),
        exposures: (0..rig.len())
            .map(|camera| Exposure {
                camera,
                time_ns: 1_532_402_927_000_000_000 + k as i64 * 500_000_000,
                world_from_ego: path(k),
                lens,
                ego_from_camera: rig[camera].ego_from_camera,
                token: None,
                file: None,
            })
            .collect(),
        boxes: cast
            .iter()
            .enumerate()
            .map(|(track, &member)| ObjectBox {
                track,
                kind: member.1,
                category: "test".into(),
                token: format!("{}-{k}", member.0),
                cuboid: cuboid(k, member),
                velocity_mps: Some(member.3),
                is_parked: None,
                attributes: Vec::new(),
                lidar_points: None,
                visibility: None,
            })
            .collect(),
        lidar: None,
    };
    let track = |&member: &(&str, Kind, DVec3, DVec3, [f64; 3])| Track {
        token: member.0.into(),
        kind: member.1,
        boxes: (0..10).map(|k| (k, cuboid(k, member))).collect(),
    };
    Drive {
        id: "made-up".into(),
        dataset: "test".into(),
        origin: DriveOrigin::Recorded,
        place: String::new(),
        is_georeferenced: true,
        projection: MapProjection::spherical(1.3, 103.8, DVec2::ZERO),
        keyframes: (0..10).map(keyframe).collect(),
        path: Trajectory::default(),
        lidars: Vec::new(),
        sweeps: Vec::new(),
        tracks: cast.iter().map(track).collect(),
        rig,
        ego_body: EgoBody { centre_ego: DVec3::new(1.0, 0.0, 0.78), size_m: DVec3::new(4.1, 1.8, 1.56) },
        lane_map: Some(street()),
        licence: "test".into(),
    }
}

/// A road on the ground of which the map says no more than where it runs.
pub(crate) fn road(id: i64, kind: RoadKind, points: &[[f64; 2]]) -> Road {
    Road::new(id, kind, points.iter().copied().map(DVec2::from_array).collect())
}

/// A map of one road.
pub(crate) fn map_with_road(ends: [[f64; 2]; 2]) -> StreetMap {
    let road = road(1, RoadKind::Residential, &ends);
    StreetMap { roads: vec![road], ..StreetMap::default() }
}

/// Edges that only one triangle has, and the volume that the triangles enclose.
pub(crate) fn open_edges_and_volume(mesh: &Mesh) -> (Vec<[[u32; 3]; 2]>, f64) {
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    let mut volume = 0.0;
    for t in &mesh.triangles {
        let p = t.map(|i| mesh.positions[i as usize]);
        let [a, b, c] = p.map(|p| p.as_dvec3());
        volume += a.dot(b.cross(c)) / 6.0;
        // Adding 0 makes −0 and 0 one.
        let key = p.map(|p| (p + 0.0).to_array().map(f32::to_bits));
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            *edges.entry([key[i], key[j]]).or_default() += 1;
            *edges.entry([key[j], key[i]]).or_default() -= 1;
        }
    }
    (edges.into_iter().filter(|(_, n)| *n > 0).map(|(e, _)| e).collect(), volume)
}
