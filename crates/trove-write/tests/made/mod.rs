//! A finished folder of small frames, for the tests of exports: a car on a plain road, seen from known places.

use std::fs;
use std::path::Path;

use trove_format::{
    ClassEntry, Factors, FrameFile, FrameRow, FrameTable, GlassPolicy, LensModel, LightFactor, Manifest, Matrix4,
    ObjectOrigin, ObjectRow, PartEntry, Projection, Source, Versions,
};
use trove_model::{
    Class, Color, ExtraLabels, InstanceId, Kind, Labels, Mask, ObjectLabel, Occlusion, PixelBox, Raster, Season, State,
};
use trove_write::{Frame, FrameFolders};

pub(crate) const WIDTH: u32 = 64;
pub(crate) const HEIGHT: u32 = 48;
pub(crate) const FOCAL_PX: f64 = 40.0;
/// The camera's height, metres.
pub(crate) const EYE_M: f64 = 1.5;
/// The car's size: length, width, height.
pub(crate) const CAR_M: [f64; 3] = [4.0, 2.0, 1.0];
/// The car's id in `instance.png`.
pub(crate) const CAR: u32 = 300;
/// World's origin in the dataset's plane.
pub(crate) const ANCHOR_M: [f64; 2] = [100.0, 200.0];

/// What a test may choose about a frame.
pub(crate) struct Made {
    pub(crate) view: &'static str,
    pub(crate) keyframe: u32,
    /// The car's middle in World: the camera looks north from the origin, [`EYE_M`] above it.
    pub(crate) car_m: [f64; 3],
    pub(crate) has_vehicle: bool,
    pub(crate) files: Vec<FrameFile>,
}

impl Made {
    /// A frame of the front camera, with all files and the car 20 m ahead, standing on the road.
    pub(crate) fn new(keyframe: u32) -> Self {
        let files = FrameFile::ALL
            .into_iter()
            .filter(|file| (file.is_usual() && *file != FrameFile::Change) || *file == FrameFile::Radiance)
            .collect();
        Self { view: "ego.CAM_FRONT", keyframe, car_m: [0.0, 20.0, CAR_M[2] / 2.0], has_vehicle: true, files }
    }
}

/// World is east, north, up; Camera right, down, forward: it looks north.
fn world_from_camera() -> Matrix4 {
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, EYE_M], [0.0, 0.0, 0.0, 1.0]]
}

/// Drives north: x forward is World's y.
fn heading_north([x, y, z]: [f64; 3]) -> Matrix4 {
    [[0.0, -1.0, 0.0, x], [1.0, 0.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]
}

/// Pixels of the car's rear, which hides the rest of it: by the pinhole's equation.
pub(crate) fn rear_px([x, y, z]: [f64; 3]) -> [f64; 4] {
    let depth = y - CAR_M[0] / 2.0;
    let column = |x: f64| f64::from(WIDTH) / 2.0 + FOCAL_PX * x / depth;
    let row = |z: f64| f64::from(HEIGHT) / 2.0 + FOCAL_PX * (EYE_M - z) / depth;
    [column(x - CAR_M[1] / 2.0), row(z + CAR_M[2] / 2.0), column(x + CAR_M[1] / 2.0), row(z - CAR_M[2] / 2.0)]
}

fn table(made: &Made, bounds: [u32; 4]) -> FrameTable {
    let [x0, y0, x1, y1] = bounds;
    let pixels = (x1 + 1 - x0) * (y1 + 1 - y0);
    let car = ObjectRow {
        id: CAR,
        class: Class::Car,
        class_id: Class::Car.id(),
        kind: Kind::Car,
        origin: ObjectOrigin::Recorded,
        category: "vehicle.car".into(),
        token: format!("annotation{}", made.keyframe),
        track_token: "track".into(),
        asset: "car/made".into(),
        world_from_body: heading_north(made.car_m),
        size_m: CAR_M,
        world_from_asset: Some(heading_north([made.car_m[0], made.car_m[1], 0.0])),
        paint: Some([200, 0, 0]),
        velocity_mps: Some([0.0, 5.0, 0.0]),
        yaw_rate_radps: Some(0.0),
        states: vec![State::Moving],
        visible_px: pixels,
        amodal_px: pixels,
        visible_box: Some(bounds),
        amodal_box: Some(bounds),
        truncation: 0.0,
        occlusion: 0.0,
        range_m: 20.0,
        keypoints: None,
        keypoints_world_m: None,
    };
    let keyframe_time_ns = 1_532_402_927_000_000_000 + i64::from(made.keyframe) * 500_000_000;
    FrameTable {
        scene: "scene-0001".into(),
        dataset: "made".into(),
        place: "nowhere".into(),
        variation: 0,
        keyframe: made.keyframe,
        keyframe_token: String::new(),
        keyframe_time_ns,
        recorded_keyframe: Some(made.keyframe),
        view: made.view.into(),
        time_ns: keyframe_time_ns + 10_000_000,
        source_token: String::new(),
        source_image: String::new(),
        width_px: WIDTH,
        height_px: HEIGHT,
        intrinsics: [
            [FOCAL_PX, 0.0, f64::from(WIDTH) / 2.0],
            [0.0, FOCAL_PX, f64::from(HEIGHT) / 2.0],
            [0.0, 0.0, 1.0],
        ],
        lens_model: LensModel::Pinhole,
        distortion: vec![],
        exposure_s: 0.0,
        readout_s: 0.0,
        drops: 0.0,
        world_from_camera: world_from_camera(),
        world_from_camera_rotation_wxyz: [0.5f64.sqrt(), -(0.5f64.sqrt()), 0.0, 0.0],
        world_from_camera_translation_m: [0.0, 0.0, EYE_M],
        world_from_camera_previous: None,
        world_from_camera_next: None,
        world_from_ego: made.has_vehicle.then(|| heading_north([0.0; 3])),
        carrier: None,
        carrier_track_token: String::new(),
        projection: Projection { origin_lat_deg: 0.0, origin_lon_deg: 0.0, anchor_m: ANCHOR_M, metres_per_rad: None },
        glass: GlassPolicy::Glass,
        exposure_ev: Some(0.0),
        spp: 1,
        denoised: false,
        seed: 1,
        objects: vec![car],
    }
}

fn frame(made: &Made, path: String) -> Frame {
    let [x0, y0, x1, y1] = rear_px(made.car_m);
    // Pixels whose centres lie in it.
    let bounds = [x0, y0].map(|v| (v - 0.5).ceil() as u32);
    let last = [x1, y1].map(|v| (v - 0.5).floor() as u32);
    let around = PixelBox { min: bounds, max: last };
    let bounds = [bounds[0], bounds[1], last[0], last[1]];
    let is_car = |x: u32, y: u32| (bounds[0]..=bounds[2]).contains(&x) && (bounds[1]..=bounds[3]).contains(&y);
    let is_sky = |x: u32, y: u32| !is_car(x, y) && y < HEIGHT / 2;
    // The road's depth, by the pinhole's equation.
    let road_m = |y: u32| FOCAL_PX * EYE_M / (f64::from(y) + 0.5 - f64::from(HEIGHT) / 2.0);
    let by_pixel = |sky: f32, car: f32, road: &dyn Fn(u32) -> f32| {
        Raster::from_fn(WIDTH, HEIGHT, |x, y| {
            if is_car(x, y) {
                car
            } else if is_sky(x, y) {
                sky
            } else {
                road(y)
            }
        })
    };
    let labels = Labels {
        class: Raster::from_fn(WIDTH, HEIGHT, |x, y| match (is_car(x, y), is_sky(x, y)) {
            (true, _) => Class::Car,
            (_, true) => Class::Sky,
            _ => Class::Road,
        }),
        instance: Raster::from_fn(WIDTH, HEIGHT, |x, y| if is_car(x, y) { CAR } else { 0 }),
        depth_m: by_pixel(f32::INFINITY, (made.car_m[1] - CAR_M[0] / 2.0) as f32, &|y| road_m(y) as f32),
        normal: Raster::from_fn(WIDTH, HEIGHT, |x, y| match (is_car(x, y), is_sky(x, y)) {
            (true, _) => [0.0, 0.0, -1.0],
            (_, true) => [0.0; 3],
            _ => [0.0, -1.0, 0.0],
        }),
        flow_forward: Raster::from_fn(WIDTH, HEIGHT, |x, y| if is_sky(x, y) { [f32::NAN; 2] } else { [1.5, -0.25] }),
        flow_backward: Raster::filled(WIDTH, HEIGHT, [f32::NAN; 2]),
        occluded_forward: Raster::from_fn(WIDTH, HEIGHT, |x, y| match x {
            _ if is_sky(x, y) => Occlusion::Undefined,
            0..3 => Occlusion::Hidden,
            _ => Occlusion::Seen,
        }),
        occluded_backward: Raster::filled(WIDTH, HEIGHT, Occlusion::Undefined),
        extra: ExtraLabels::default(),
        objects: vec![ObjectLabel {
            id: InstanceId(CAR),
            visible_px: 0,
            visible_box: Some(around),
            amodal_px: 0,
            amodal_box: Some(around),
            amodal_mask: Some(Mask::of(around, |_, _| true)),
            truncation: 0.0,
            occlusion: 0.0,
            range_m: 20.0,
            keypoints: None,
        }],
    };
    let color = Color {
        radiance: Raster::filled(WIDTH, HEIGHT, [0.5; 3]),
        // Every picture has other bytes.
        srgb: Raster::from_fn(WIDTH, HEIGHT, |x, y| [4 * x as u8, 4 * y as u8, 10 * made.keyframe as u8]),
        exposure_ev: 0.0,
    };
    Frame { path, table: table(made, bounds), color: Some(color), labels, change: None }
}

/// Writes the frames and the manifest of a finished run.
pub(crate) fn finished(root: &Path, frames: &[Made]) {
    let folders = FrameFolders::new(root);
    let rows = frames.iter().map(|made| {
        let path = format!("scene-0001/v00/k{:03}/{}", made.keyframe, made.view);
        let files = folders.frame(&frame(made, path.clone()), &made.files.iter().copied().collect()).unwrap();
        FrameRow {
            path,
            scene: "scene-0001".into(),
            variation: 0,
            keyframe: made.keyframe,
            view: made.view.into(),
            factors: factors(),
            files: files.into_iter().map(|file| (file.name, file.sha256)).collect(),
            counterfactual: None,
        }
    });
    let manifest = Manifest {
        format: 2,
        seed: 1,
        recipe: serde_json::Value::Null,
        versions: Versions {
            trove: "0".into(),
            build: String::new(),
            assets: vec![],
            kernel: "made".into(),
            denoiser: None,
            device: None,
            card: None,
        },
        classes: ClassEntry::all(),
        parts: PartEntry::all(),
        drives: vec![],
        licences: vec![Source { source: "made".into(), licence: "CC0-1.0".into() }],
        frames: rows.collect(),
        sweeps: vec![],
        grids: vec![],
        radars: vec![],
    };
    fs::write(root.join(Manifest::NAME), manifest.to_json()).unwrap();
}

fn factors() -> Factors {
    let light = LightFactor::Sky {
        environment: "sky".into(),
        sun_elevation_deg: 40.0,
        sun_azimuth_deg: 180.0,
        turbidity: 3.0,
        clouds: 0.0,
    };
    Factors {
        assets: 0,
        paint: 0,
        people: 0,
        facades: 0,
        materials: 0,
        furniture: 0,
        vegetation: 0,
        place: [0.0; 2],
        season: Season::Summer,
        light,
        traffic: 1.0,
        wetness: 0.0,
        visibility_m: None,
        rain_mm_h: None,
        snowfall_mm_h: None,
        snow: None,
        exposure_ev: 0.0,
        camera_height_m: 0.0,
        camera_pitch_deg: 0.0,
        other_vehicles: 0,
    }
}
