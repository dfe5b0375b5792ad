//! What sums a run up, and rows of what was built.

use trove_build::{AssetFit, ObjectFit};
use trove_format::{
    AssetFitRow, ClassEntry, FORMAT, FitRow, FrameRow, Manifest, ManifestDrive, RunIdentity, RunReport, SceneReport,
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
}

impl FrameKey {
    /// Path of the frame's folder below the output folder.
    pub(super) fn path(&self) -> String {
        let folder = variation_folder(&self.scene, self.variation);
        format!("{folder}/k{:03}/{}", self.keyframe, self.view)
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

/// The manifest of finished frames.
pub(super) fn manifest(seed: u64, identity: RunIdentity, sites: &[SiteSummary], frames: Vec<FrameRow>) -> Manifest {
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
        drives,
        licences,
        frames,
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
