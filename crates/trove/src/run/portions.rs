//! How much there is to do, before a drive has been read.

use std::collections::BTreeSet;
use std::path::Path;

use super::manifest::variation_folder;
use super::share::{Share, Slice};
use crate::recipe::Recipe;

/// Cameras of a rig before the first drive has been read.
const CAMERAS_HINT: usize = 6;

/// What is to be made of a variation of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Portion {
    pub(super) slice: Slice,
    /// Frames of it, as far as is known.
    pub(super) frames_hint: usize,
    /// Frames of the whole variation.
    pub(super) of_hint: usize,
}

/// What is to be made of each scene's variations, of scenes with so many keyframes; `None` where nothing is.
pub(super) fn portions(
    recipe: &Recipe,
    scenes: &[(String, usize)],
    frames: Option<&BTreeSet<String>>,
    share: Option<Share>,
) -> Vec<Vec<Option<Portion>>> {
    let hints = scenes.iter().map(|(scene, keyframes)| {
        let hints = frames_hints(recipe, scene, *keyframes, frames).into_iter();
        hints.map(|hint| (hint > 0 || frames.is_none()).then_some(hint)).collect()
    });
    let hints: Vec<Vec<Option<usize>>> = hints.collect();
    let all = scenes.iter().zip(&hints).flat_map(|((scene, _), hints)| {
        (0..).zip(hints).filter(|(_, hint)| hint.is_some()).map(|(variation, _)| (scene.clone(), variation))
    });
    let slices = share.map(|share| share.slices(&all.collect::<Vec<_>>()));
    let portion = |scene: &str, variation: u32, of_hint: usize| {
        let slice = match &slices {
            Some(slices) => *slices.get(&(scene.to_owned(), variation))?,
            None => Slice::ALL,
        };
        Some(Portion { slice, frames_hint: slice.count(of_hint), of_hint })
    };
    let of_scene = |((scene, _), hints): (&(String, usize), &Vec<Option<usize>>)| {
        (0..).zip(hints).map(|(variation, hint)| portion(scene, variation, (*hint)?)).collect()
    };
    scenes.iter().zip(&hints).map(of_scene).collect()
}

/// Frames of each variation of a scene with so many keyframes.
fn frames_hints(recipe: &Recipe, scene: &str, keyframes: usize, frames: Option<&BTreeSet<String>>) -> Vec<usize> {
    let cameras = recipe.camera_names().map_or(CAMERAS_HINT, |names| names.len());
    let chosen = match &recipe.drive {
        Some(drive) => drive.keyframes.of(keyframes).map_or(0, |chosen| chosen.len()),
        None => keyframes,
    };
    let all = chosen * (cameras * (1 + recipe.views.other_vehicles) + recipe.sensors.len() + recipe.grids.len());
    let listed = |frames: &BTreeSet<String>, variation| {
        let folder = variation_folder(scene, variation);
        frames.iter().filter(|frame| Path::new(frame).starts_with(&folder)).count()
    };
    (0..recipe.variations.count).map(|variation| frames.map_or(all, |frames| listed(frames, variation))).collect()
}
