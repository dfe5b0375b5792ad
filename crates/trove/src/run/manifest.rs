//! What sums a run up, and rows of what was built.

use anyhow::{Context, Result};
use trove_build::{AssetFit, ObjectFit};
use trove_format::{
    AssetFitRow, ClassEntry, FORMAT, FitRow, Manifest, ManifestDrive, PartEntry, RunIdentity, RunReport, SceneReport,
    SiteFile, Source,
};
use trove_model::Report;

/// How well assets fit, an object a row.
pub(crate) fn fit_rows(fits: &[ObjectFit]) -> Vec<FitRow> {
    let asset = |fit: &AssetFit| AssetFitRow { asset: fit.asset.clone(), quality_m: fit.quality_m, iou3d: fit.iou3d };
    let row = |fit: &ObjectFit| FitRow {
        track: fit.track_token.clone(),
        kind: fit.kind,
        size_m: fit.size_m.to_array(),
        chosen: asset(&fit.chosen),
        runners_up: fit.runners_up.iter().map(asset).collect(),
    };
    fits.iter().map(row).collect()
}

/// Which frame it is.
#[derive(Clone, Debug)]
pub(super) struct FrameKey {
    pub(super) scene: String,
    pub(super) variation: u32,
    pub(super) keyframe: u32,
    pub(super) view: String,
    pub(super) sensed: Sensed,
}

/// What a folder holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Sensed {
    /// A camera's frame.
    Frame,
    /// A LiDAR's sweep.
    Sweep,
    /// A grid.
    Grid,
    /// A radar's cycle.
    Radar,
}

impl FrameKey {
    /// Path of the frame's folder below the output folder.
    pub(super) fn path(&self) -> String {
        let folder = variation_folder(&self.scene, self.variation);
        format!("{folder}/k{:03}/{}", self.keyframe, self.view)
    }

    /// What was planned for it, among that of all keyframes.
    pub(super) fn of<'a, T>(&self, planned: &'a [(u32, Vec<T>)], view: impl Fn(&T) -> &String) -> Result<&'a T> {
        let of_keyframe =
            planned.iter().filter(|(keyframe, _)| *keyframe == self.keyframe).flat_map(|(_, taken)| taken);
        of_keyframe.into_iter().find(|taken| *view(taken) == self.view).context("a planned view has no shot")
    }
}

/// Path of the folder of a scene's variation below the output folder.
pub(super) fn variation_folder(scene: &str, variation: u32) -> String {
    format!("{scene}/v{variation:02}")
}

/// A built scene of one variation.
pub(super) struct SiteSummary {
    pub(super) scene: String,
    pub(super) variation: u32,
    pub(super) file: SiteFile,
}

/// What was planned for a variation of a scene, keyframe by keyframe.
pub(super) fn planned(scene: &str, variation: u32, file: &SiteFile) -> Vec<FrameKey> {
    let of = |sensed: Sensed, planned: &[(u32, String)]| -> Vec<FrameKey> {
        let key = |(keyframe, view): &(u32, String)| FrameKey {
            scene: scene.to_owned(),
            variation,
            keyframe: *keyframe,
            view: view.clone(),
            sensed,
        };
        planned.iter().map(key).collect()
    };
    let mut keys = [
        of(Sensed::Frame, &file.frames),
        of(Sensed::Sweep, &file.sweeps),
        of(Sensed::Radar, &file.radars),
        of(Sensed::Grid, &file.grids),
    ]
    .concat();
    keys.sort_by_key(|key| key.keyframe);
    keys
}

/// The manifest of what is finished, without its rows.
pub(super) fn manifest(seed: u64, identity: RunIdentity, sites: &[SiteSummary]) -> Manifest {
    let mut drives: Vec<ManifestDrive> = Vec::new();
    for SiteSummary { file, .. } in sites {
        let row = ManifestDrive { drive: file.drive.clone(), sources: file.sources.clone() };
        if !drives.contains(&row) {
            drives.push(row);
        }
    }
    let mut licences: Vec<Source> = drives.iter().flat_map(|drive| drive.sources.clone()).collect();
    licences.sort();
    licences.dedup();
    Manifest {
        format: FORMAT,
        seed,
        recipe: identity.recipe,
        versions: identity.versions,
        classes: ClassEntry::all(),
        parts: PartEntry::all(),
        drives,
        licences,
        frames: Vec::new(),
        sweeps: Vec::new(),
        radars: Vec::new(),
        grids: Vec::new(),
    }
}

/// The report: what concerns the run as a whole, and then each scene's.
pub(super) fn report(run: &Report, sites: &[SiteSummary]) -> RunReport {
    let scene = |site: &SiteSummary| SceneReport {
        scene: site.scene.clone(),
        variation: site.variation,
        report: site.file.report.clone(),
    };
    RunReport { run: run.into(), scenes: sites.iter().map(scene).collect() }
}
