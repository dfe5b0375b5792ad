//! A recipe's scene, ready for pictures from anywhere.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use glam::{DMat3, DQuat, DVec3};
use trove_format::{LensModel, Matrix4, ReportTable};
use trove_model::{Camera, Lens, Pose, Report, Seed, Shot, Viewpoint, World};
use trove_render::{KernelChoice, PreparedScene, Renderer, RendererOptions};
use trove_write::{Frame, FrameMeta};

use crate::build::write_scene;
use crate::built_scene::BuiltScene;
use crate::recipe::Recipe;
use crate::watch::Watch;
use crate::{libraries, message};

/// How far a rotation's rows may be from unit length and right angles: that of numbers rounded to six digits.
const ROTATION_TOLERANCE: f64 = 1e-4;

/// A camera that a drive need not have.
#[derive(Clone, Debug)]
pub struct FreeCamera {
    /// Columns and rows.
    pub size_px: [u32; 2],
    /// K, rows first, pixels; pixel centres are at .5.
    pub intrinsics: [[f64; 3]; 3],
    /// The lens's name, as in `frame.json`.
    pub lens_model: String,
    /// Its coefficients, as in `frame.json`.
    pub distortion: Vec<f64>,
}

/// Which picture to take.
#[derive(Clone, Debug, Default)]
pub struct PictureRequest {
    /// The view whose camera takes it; the first where it is `None`.
    pub view: Option<String>,
    /// Another camera in place of the view's.
    pub camera: Option<FreeCamera>,
    /// Where it stands, from Camera (x right, y down, z forward) to World; `None`: where the view's stands.
    pub world_from_camera: Option<Matrix4>,
    /// Samples a pixel; `None`: the recipe's.
    pub spp: Option<u32>,
    /// Source of its noise; `None`: the view's.
    pub seed: Option<u64>,
    /// Whether labels alone are wanted.
    pub labels_only: bool,
}

/// The recipe's first scene at one keyframe, with its renderer.
pub struct ReadyScene {
    built: BuiltScene,
    renderer: Renderer,
    prepared: PreparedScene,
    /// What was dropped, guessed or substituted, as JSON.
    report: String,
}

impl ReadyScene {
    /// Builds the scene of a recipe (a path) at a keyframe, by default the recipe's first, and makes it ready.
    ///
    /// # Errors
    /// What `trove build` says of a recipe, a dataset, a place or a kernel that cannot be used, and an end that was asked
    /// for.
    pub fn build(
        recipe: &Path,
        keyframe: Option<usize>,
        site_packages: &[PathBuf],
        watch: &Watch,
    ) -> Result<Self, String> {
        let build = || -> Result<Self> {
            let recipe = Recipe::read(recipe)?;
            let search = libraries::search(site_packages);
            let report = Report::default();
            let built = BuiltScene::build(&recipe, keyframe, &search, &report)?;
            ensure!(!watch.stops(), "ended before the scene was ready");
            let renderer = Renderer::new(&RendererOptions {
                kernel: KernelChoice::Auto,
                denoise: recipe.denoising(),
                threads: recipe.render.threads,
                search,
                ..RendererOptions::default()
            })?;
            let prepared = renderer.prepare(&built.scene)?;
            let report = serde_json::to_string(&ReportTable::from(&report))?;
            Ok(Self { built, renderer, prepared, report })
        };
        build().map_err(|error| message::of(&error))
    }

    /// The scene's name and keyframe.
    pub fn name(&self) -> (&str, usize) {
        (&self.built.name, self.built.keyframe)
    }

    /// The recipe's cameras in this keyframe.
    pub fn views(&self) -> Vec<(&str, FreeCamera, Matrix4)> {
        let camera = |lens: &Lens| FreeCamera {
            size_px: [lens.width_px, lens.height_px],
            intrinsics: [[lens.fx_px, 0.0, lens.cx_px], [0.0, lens.fy_px, lens.cy_px], [0.0, 0.0, 1.0]],
            lens_model: lens.distortion.name().into(),
            distortion: lens.distortion.coefficients(),
        };
        self.built.shots.iter().map(|s| (s.view.as_str(), camera(&s.lens), matrix(&s.world_from_camera))).collect()
    }

    /// What was dropped, guessed or substituted, as `report.json` has it.
    pub fn report(&self) -> &str {
        &self.report
    }

    /// Writes the scene as binary glTF 2.0, with the recipe's cameras and the sun, as `trove build` does.
    ///
    /// # Errors
    /// A file system that refuses.
    pub fn write_glb(&self, path: &Path) -> Result<(), String> {
        write_scene(&self.built, path, None).map(drop).map_err(|error| message::of(&error))
    }

    /// Takes a picture with its labels; `None` where an end was asked for.
    ///
    /// # Errors
    /// A view that the recipe does not have, and a camera or pose that is none.
    pub fn picture(&self, request: &PictureRequest, watch: &Watch) -> Result<Option<Frame>, String> {
        self.taken(request, watch).map_err(|error| message::of(&error))
    }

    fn taken(&self, request: &PictureRequest, watch: &Watch) -> Result<Option<Frame>> {
        let shot = self.shot(request)?;
        let following = |share: f32| {
            if let Some(follower) = watch.follower() {
                follower.progress(f64::from(share), 1, &shot.view);
            }
            watch.stops()
        };
        let Some(capture) = self.renderer.render(&self.prepared, &shot, !request.labels_only, &following) else {
            return Ok(None);
        };
        let BuiltScene { name, timeline, keyframe, scene, .. } = &self.built;
        let drive = timeline.moments().drive;
        let moment = &drive.keyframes[*keyframe];
        let exposure = match shot.viewpoint {
            Viewpoint::Recording { camera } => moment.exposures.iter().find(|e| e.camera == camera),
            Viewpoint::OtherVehicle { .. } | Viewpoint::Free => None,
        };
        let meta = FrameMeta {
            scene: name.clone(),
            dataset: drive.dataset.clone(),
            place: drive.place.clone(),
            variation: 0,
            keyframe: *keyframe as u32,
            keyframe_token: moment.token.clone(),
            keyframe_time_ns: moment.time_ns,
            recorded_keyframe: timeline.moments().keyframe(*keyframe).map(|k| k as u32),
            source_token: exposure.and_then(|e| e.token.clone()),
            source_image: exposure.and_then(|e| e.file.clone()),
            projection: drive.projection,
        };
        Ok(Some(Frame::of(shot.view.clone(), scene, &shot, capture, &meta)?))
    }

    /// The recipe's own shot, or one by another camera or from elsewhere, which nothing carries and which has no
    /// neighbouring keyframes.
    fn shot(&self, request: &PictureRequest) -> Result<Shot> {
        let shots = &self.built.shots;
        let view = match &request.view {
            None => shots.first().context("the recipe has no view")?,
            Some(name) => shots.iter().find(|shot| shot.view == *name).with_context(|| {
                let known: Vec<&str> = shots.iter().map(|shot| shot.view.as_str()).collect();
                format!("view: expected one of {}, found {name:?}", known.join(", "))
            })?,
        };
        let mut shot = match (&request.camera, &request.world_from_camera) {
            (None, None) => view.clone(),
            (camera, pose) => {
                let lens = camera.as_ref().map_or(Ok(view.lens), lens)?;
                let pose = pose.as_ref().map_or(Ok(view.world_from_camera), pose_of)?;
                let name = if camera.is_some() { "free" } else { &view.view };
                let Shot { time_ns, spp, noise, film, seed, .. } = *view;
                let labels = view.labels.clone();
                Shot { time_ns, spp, noise, film, seed, labels, ..Shot::new(name, lens, pose) }
            }
        };
        if let Some(spp) = request.spp {
            ensure!(spp > 0, "spp: expected 1 or more, found 0");
            (shot.spp, shot.noise) = (spp, 0.0);
        }
        shot.seed = request.seed.map_or(shot.seed, Seed);
        Ok(shot)
    }
}

fn lens(camera: &FreeCamera) -> Result<Lens> {
    let FreeCamera { size_px, intrinsics, lens_model, distortion } = camera;
    let [[fx_px, skew, cx_px], [_, fy_px, cy_px], _] = *intrinsics;
    let numbers = [fx_px, fy_px, cx_px, cy_px];
    ensure!(
        numbers.iter().all(|n| n.is_finite()) && fx_px > 0.0 && fy_px > 0.0 && skew == 0.0,
        "intrinsics: expected focal lengths above 0, a principal point and no skew, in pixels, found {intrinsics:?}"
    );
    ensure!(
        size_px.iter().all(|side| (1..=MOST_SIDE_PX).contains(side)),
        "camera: expected 1 to {MOST_SIDE_PX} pixels a side, found {} × {}",
        size_px[0],
        size_px[1]
    );
    let model: LensModel =
        serde_json::from_value(lens_model.as_str().into()).map_err(|error| anyhow::anyhow!("lens_model: {error}"))?;
    let distortion = model.distortion(distortion).map_err(anyhow::Error::msg)?;
    let [width_px, height_px] = *size_px;
    Ok(Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion })
}

/// As large as the largest picture that a recipe's lens may have.
const MOST_SIDE_PX: u32 = 16_384;

fn pose_of(rows: &Matrix4) -> Result<Pose<World, Camera>> {
    let row = |i: usize| DVec3::new(rows[i][0], rows[i][1], rows[i][2]);
    let matrix = DMat3::from_cols(row(0), row(1), row(2)).transpose();
    let error = (matrix * matrix.transpose() - DMat3::IDENTITY).to_cols_array();
    let is_rotation = error.iter().all(|e| e.abs() < ROTATION_TOLERANCE) && matrix.determinant() > 0.0;
    let translation = DVec3::new(rows[0][3], rows[1][3], rows[2][3]);
    ensure!(
        is_rotation && translation.is_finite() && rows[3] == [0.0, 0.0, 0.0, 1.0],
        "world_from_camera: expected a rotation and a translation (4×4, rows first), found {rows:?}"
    );
    Ok(Pose::new(DQuat::from_mat3(&matrix), translation))
}

fn matrix(pose: &Pose<World, Camera>) -> Matrix4 {
    let (m, t) = (pose.rotation_matrix().transpose(), pose.translation);
    let row = |r: DVec3, t: f64| [r.x, r.y, r.z, t];
    [row(m.x_axis, t.x), row(m.y_axis, t.y), row(m.z_axis, t.z), [0.0, 0.0, 0.0, 1.0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_comes_back_as_its_matrix() {
        let pose = Pose::new(DQuat::from_xyzw(0.1, -0.5, 0.3, 0.8), DVec3::new(3.0, -4.0, 1.5));
        let back = pose_of(&matrix(&pose)).unwrap();
        assert!((back.translation - pose.translation).length() < 1e-12);
        assert!(back.rotation.angle_between(pose.rotation) < 1e-6);
    }

    #[test]
    fn what_is_no_pose_is_refused_with_what_was_found() {
        let unit = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        assert!(pose_of(&unit).is_ok());
        for (row, column, value) in [(0, 0, 2.0), (0, 0, -1.0), (0, 3, f64::NAN), (3, 3, 0.0), (1, 2, 0.1)] {
            let mut wrong: Matrix4 = unit;
            wrong[row][column] = value;
            let error = pose_of(&wrong).unwrap_err().to_string();
            assert!(error.contains("world_from_camera: expected a rotation"), "{error}");
        }
    }

    #[test]
    fn a_camera_without_a_picture_or_a_known_lens_is_refused() {
        let camera = FreeCamera {
            size_px: [64, 48],
            intrinsics: [[50.0, 0.0, 32.0], [0.0, 50.0, 24.0], [0.0, 0.0, 1.0]],
            lens_model: "pinhole".into(),
            distortion: Vec::new(),
        };
        assert_eq!(lens(&camera).unwrap().fx_px, 50.0);
        let faults: [(FreeCamera, &str); 4] = [
            (FreeCamera { size_px: [0, 48], ..camera.clone() }, "pixels a side"),
            (FreeCamera { lens_model: "fisheye".into(), ..camera.clone() }, "kannala-brandt"),
            (FreeCamera { distortion: vec![0.1], ..camera.clone() }, "distortion"),
            (FreeCamera { intrinsics: [[0.0; 3]; 3], ..camera }, "focal lengths above 0"),
        ];
        for (camera, expect) in faults {
            let error = lens(&camera).unwrap_err().to_string();
            assert!(error.contains(expect), "{error}");
        }
    }
}
