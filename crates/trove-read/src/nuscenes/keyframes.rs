//! A scene's keyframes in their order.

use std::collections::HashSet;

use trove_model::{Outcome, Report};

use super::records::{SampleRecord, SceneRecord};
use super::tables::Tables;

/// The samples of a scene along their chain; by time where the chain does not hold all of them in that order.
pub(super) fn in_order<'a>(tables: &'a Tables, scene: usize, report: &Report) -> Vec<&'a SampleRecord> {
    let (record, tokens) = (&tables.scenes[scene], &tables.samples_of_scene[scene]);
    if record.nbr_samples != tokens.len() as i64 {
        let example = format!("{}: {} declared, {} found", record.name, record.nbr_samples, tokens.len());
        report.note(Outcome::Warned, "nuScenes scene with a wrong number of samples", example);
    }
    let chain = chain(tables, record);
    if chain.len() == tokens.len() && chain.is_sorted_by_key(|s| s.timestamp) {
        if let Some(last) = chain.last().filter(|s| !s.next.is_empty()) {
            report.note(Outcome::Warned, "nuScenes keyframe chain that continues past its scene", &last.token);
        }
        return chain;
    }
    report.note(Outcome::Substituted, "broken nuScenes keyframe chain, put in order of time", &record.name);
    let mut by_time: Vec<_> = tokens.iter().filter_map(|token| tables.samples.get(token)).collect();
    by_time.sort_by_key(|s| s.timestamp);
    by_time
}

/// The samples from the scene's first along `next`, as far as they are the scene's.
fn chain<'a>(tables: &'a Tables, scene: &SceneRecord) -> Vec<&'a SampleRecord> {
    let (mut chain, mut seen) = (Vec::new(), HashSet::new());
    let mut token = scene.first_sample_token.as_str();
    while let Some(sample) = tables.samples.get(token) {
        if sample.scene_token != scene.token || !seen.insert(token) {
            break;
        }
        chain.push(sample);
        token = &sample.next;
    }
    chain
}
