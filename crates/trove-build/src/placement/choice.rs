//! Which asset fits a box best, and which others would have.

use std::collections::BTreeSet;

use glam::DVec3;
use trove_model::{Asset, Kind, Outcome, Report, Seed, Track};

use super::fit::Fit;

/// Runners-up that are told of.
const RUNNERS_UP: usize = 3;
/// What fits worse than this share of the best is not drawn.
const ABOUT_AS_GOOD: f64 = 0.85;
/// So many times as many people are drawn from as other things.
const PEOPLE: usize = 4;
/// True 3D IoU below which an asset is no good fit.
const GOOD_IOU: f64 = 0.6;

/// An asset and how well it fits a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate<'a> {
    /// The asset.
    pub asset: &'a Asset,
    /// What is done to it.
    pub fit: Fit,
}

/// How well the asset that stands for a recorded object fits its box, and who came next.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectFit {
    /// The dataset's token of its track.
    pub track_token: String,
    /// What it is.
    pub kind: Kind,
    /// Length, width and height of its box, the middle ones of all keyframes, metres.
    pub size_m: DVec3,
    /// What was taken.
    pub chosen: AssetFit,
    /// Others that fit, the best first, by the paper's measure.
    pub runners_up: Vec<AssetFit>,
}

/// How well an asset fits a box.
#[derive(Clone, Debug, PartialEq)]
pub struct AssetFit {
    /// The asset's id.
    pub asset: String,
    /// The paper's measure, IoU of the outlines seen from above times the lower height, metres, with the aspect kept.
    pub quality_m: f64,
    /// True 3D intersection over union after the asset was made to fit, 0 to 1.
    pub iou3d: f64,
}

impl From<&Candidate<'_>> for AssetFit {
    fn from(Candidate { asset, fit }: &Candidate) -> Self {
        Self { asset: asset.id.clone(), quality_m: fit.quality_m, iou3d: fit.iou3d }
    }
}

/// The assets by how well they fit, the best first; of a person the posture that fits best.
pub(super) fn ranked<'a>(assets: impl Iterator<Item = &'a Asset>, size_m: DVec3, kind: Kind) -> Vec<Candidate<'a>> {
    let fit = |asset: &'a Asset| Candidate { asset, fit: Fit::new(asset.size_m, size_m, kind) };
    let mut ranked: Vec<Candidate> = assets.map(fit).collect();
    ranked.sort_by(|a, b| b.fit.quality_m.total_cmp(&a.fit.quality_m).then_with(|| a.asset.id.cmp(&b.asset.id)));
    let mut people = BTreeSet::new();
    ranked.retain(|c| c.asset.figure.as_ref().is_none_or(|figure| people.insert(figure.person.clone())));
    ranked
}

/// One of the `top_k` best that fit about as well as the best, drawn by how common they are. Boxes of people say more
/// about their stride and what they carry than about who they are: more of them are drawn from.
pub(super) fn draw<'a>(ranked: &[Candidate<'a>], top_k: usize, seed: Seed) -> Option<Candidate<'a>> {
    let least_m = ranked.first()?.fit.quality_m * ABOUT_AS_GOOD;
    let is_person = ranked.first()?.asset.figure.is_some();
    let most = if is_person && top_k > 1 { top_k * PEOPLE } else { top_k.max(1) };
    let best: Vec<&Candidate> = ranked.iter().take(most).take_while(|c| c.fit.quality_m >= least_m).collect();
    let weights = best.iter().map(|c| f64::from(c.asset.commonness.max(0.0)));
    let drawn = seed.child("asset").random().weighted(weights).unwrap_or(0);
    best.get(drawn).copied().copied()
}

/// The choice for a track, with those who came next.
pub(super) fn object_fit(track: &Track, size_m: DVec3, chosen: &Candidate, ranked: &[Candidate]) -> ObjectFit {
    let others = ranked.iter().filter(|c| c.asset.id != chosen.asset.id);
    ObjectFit {
        track_token: track.token.clone(),
        kind: track.kind,
        size_m,
        chosen: chosen.into(),
        runners_up: others.take(RUNNERS_UP).map(AssetFit::from).collect(),
    }
}

/// Notes how well assets fit on the whole and by kind, and names what nothing fits well.
pub(super) fn measure(fits: &[ObjectFit], report: &Report) {
    if fits.is_empty() {
        return;
    }
    let mean = |fits: &[&ObjectFit], of: fn(&AssetFit) -> f64| {
        fits.iter().map(|f| of(&f.chosen)).sum::<f64>() / fits.len() as f64
    };
    let all: Vec<&ObjectFit> = fits.iter().collect();
    report.measure("fit.objects", all.len() as f64);
    report.measure("fit.mean_quality", mean(&all, |f| f.quality_m));
    report.measure("fit.mean_iou3d", mean(&all, |f| f.iou3d));
    for kind in Kind::ALL {
        let of_kind: Vec<&ObjectFit> = fits.iter().filter(|f| f.kind == kind).collect();
        if !of_kind.is_empty() {
            report.measure(&format!("fit.mean_iou3d.{}", kind.name()), mean(&of_kind, |f| f.iou3d));
        }
    }
    for fit in fits.iter().filter(|f| f.chosen.iou3d < GOOD_IOU) {
        let [length, width, height] = fit.size_m.to_array();
        let example = format!(
            "{}: {length:.2} × {width:.2} × {height:.2} m, {} with an IoU of {:.2}",
            fit.track_token, fit.chosen.asset, fit.chosen.iou3d
        );
        report.note(Outcome::Warned, &format!("no asset of kind {} fits well", fit.kind.name()), example);
    }
}
