//! What a run is told apart by, and what makes it another one.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::Result;
use serde_json::Value;
use trove_format::{FrameFile, RunIdentity, Versions};
use trove_model::RigCamera;
use trove_render::Renderer;

use super::inputs::{self, CAMERA};
use crate::contents::Contents;
use crate::library;
use crate::recipe::Recipe;
use crate::sources::Sources;

/// Keys of the recipe that say how many frames and files there are, not what is in them: a run may go on with others.
const EXTENT: [[&str; 2]; 6] = [
    ["drive", "scenes"],
    ["drive", "keyframes"],
    ["variations", "count"],
    ["views", "rig"],
    ["output", "files"],
    ["output", "formats"],
];
/// Those among them that decide which frames a scene has.
const PLANNED: [[&str; 2]; 2] = [["drive", "keyframes"], ["views", "rig"]];
/// Differences that are told of.
const TOLD: usize = 5;

/// Everything that decides the output's bytes: a folder holds the frames of one identity.
pub(super) fn of_run(
    recipe: &Recipe,
    search: &[PathBuf],
    renderer: &Renderer,
    sources: &Sources,
    contents: &mut Contents,
) -> Result<RunIdentity> {
    let found = renderer.capabilities();
    let versions = Versions {
        trove: env!("CARGO_PKG_VERSION").into(),
        build: env!("TROVE_BUILD").into(),
        assets: library::fingerprints(recipe, search, contents)?,
        kernel: found.kernel,
        denoiser: found.denoiser.ok(),
        device: found.device,
        card: found.card,
    };
    Ok(RunIdentity::new(serde_json::to_value(recipe)?, versions, inputs::of_run(recipe, sources, contents)?))
}

/// What of a recipe decides which frames a scene has.
pub(super) fn planned(recipe: &Recipe, sources: &Sources) -> Result<Value> {
    let recipe = serde_json::to_value(recipe)?;
    let values = PLANNED.iter().map(|key| (key.join("."), at(&recipe, key).cloned().unwrap_or_default()));
    // What a rig's file holds may grow while the recipe stays as it is.
    let names = |rig: &[RigCamera]| Value::from_iter(rig.iter().map(|camera| camera.name.clone()));
    let cameras = sources.rig().map(|rig| ("views.rig's cameras".to_owned(), names(rig)));
    Ok(Value::Object(values.chain(cameras).collect()))
}

/// What makes a run another one than that which a folder was begun with, a line each; empty where it may go on.
pub(super) fn differences(was: &RunIdentity, is: &RunIdentity) -> Vec<String> {
    let mut sides = [was, is].map(|identity| {
        let mut value = serde_json::to_value(identity).unwrap_or_default();
        for [section, key] in EXTENT {
            let section = value.get_mut("recipe").and_then(|recipe| recipe.get_mut(section));
            if let Some(keys) = section.and_then(Value::as_object_mut) {
                keys.remove(key);
            }
        }
        if let Some(inputs) = value.get_mut("inputs").and_then(Value::as_object_mut) {
            inputs.retain(|input, _| !input.starts_with(CAMERA));
        }
        value
    });
    // Where no picture showed light, no card has followed any, and none has been denoised either.
    if !shows_light(&was.recipe) || !shows_light(&is.recipe) {
        for side in &mut sides {
            (side["versions"]["denoiser"], side["versions"]["card"]) = (Value::Null, Value::Null);
        }
    }
    // The device counts where both sides' libraries choose by it.
    if sides.iter().any(|side| side["versions"]["device"].is_null()) && was.versions.kernel == is.versions.kernel {
        sides.iter_mut().for_each(|side| side["versions"]["device"] = Value::Null);
    }
    let mut found = cameras(was, is);
    compare("", &sides[0], &sides[1], &mut found);
    let more = found.len().saturating_sub(TOLD);
    found.truncate(TOLD);
    if more > 0 {
        found.push(format!("{more} more"));
    }
    found
}

/// What differs between the rigs of two runs where they have some of their own: cameras may be added. One that was left
/// out for a run could come back as another, so none may.
fn cameras(was: &RunIdentity, is: &RunIdentity) -> Vec<String> {
    let own = |identity: &RunIdentity| -> BTreeMap<String, String> {
        let cameras = identity.inputs.iter().filter_map(|(input, camera)| Some((input.strip_prefix(CAMERA)?, camera)));
        cameras.map(|(name, camera)| (name.to_owned(), camera.clone())).collect()
    };
    let [was, is] = [was, is].map(own);
    if was.is_empty() != is.is_empty() {
        let words = |own: &BTreeMap<_, _>| if own.is_empty() { "the recorded cameras" } else { "a rig of its own" };
        return vec![format!("views.rig was {}, is {}", words(&was), words(&is))];
    }
    let changed = was.iter().filter(|(name, camera)| is.get(*name) != Some(*camera));
    changed.map(|(name, _)| format!("camera {name} of views.rig has changed or gone")).collect()
}

fn at<'a>(recipe: &'a Value, [section, key]: &[&str; 2]) -> Option<&'a Value> {
    recipe.get(section)?.get(key)
}

fn shows_light(recipe: &Value) -> bool {
    let is_light = |file: &Value| serde_json::from_value(file.clone()).is_ok_and(FrameFile::shows_light);
    at(recipe, &["output", "files"]).and_then(Value::as_array).is_none_or(|files| files.iter().any(is_light))
}

fn compare(key: &str, was: &Value, is: &Value, found: &mut Vec<String>) {
    let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match (was, is) {
        _ if was == is => {}
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let side = |values: &serde_json::Map<String, Value>| values.get(name).cloned().unwrap_or_default();
                compare(&below(name), &side(a), &side(b), found);
            }
        }
        _ => found.push(told(key, was, is)),
    }
}

/// A difference in words.
fn told(key: &str, was: &Value, is: &Value) -> String {
    match (key.split_once('.'), was, is) {
        (Some(("inputs", file)), Value::Null, _) => format!("{file} is new"),
        (Some(("inputs", file)), _, Value::Null) => format!("{file} is no longer read"),
        (Some(("inputs", file)), ..) => format!("the contents of {file} have changed"),
        (Some(("versions", "build")), ..) => "trove was built from other sources".into(),
        (Some(("versions", "assets")), ..) => "models, materials or plans of an asset library have changed".into(),
        (Some((_, key)), ..) => format!("{key} was {was}, is {is}"),
        (None, ..) => format!("{key} was {was}, is {is}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn identity(change: impl Fn(&mut Value)) -> RunIdentity {
        let mut value = json!({
            "format": 2,
            "recipe": {
                "seed": 1, "drive": {"scenes": ["a"], "keyframes": [0]}, "variations": {"count": 1}, "views": {"rig": "all"},
                "render": {"spp": 4}, "output": {"files": null},
            },
            "versions": {"trove": "0.1.0", "build": "ab", "assets": ["x"], "kernel": "k", "denoiser": "d", "device": "x", "card": null},
            "inputs": {"map.osm: a.osm": "01"},
        });
        change(&mut value);
        serde_json::from_value(value).unwrap()
    }

    #[test]
    fn what_changes_bytes_is_told_and_what_adds_frames_is_not() {
        let told = |change: &dyn Fn(&mut Value)| differences(&identity(|_| ()), &identity(change)).join("; ");
        assert_eq!(told(&|_| ()), "");
        assert_eq!(told(&|v| v["recipe"]["render"]["spp"] = json!(16)), "render.spp was 4, is 16");
        assert_eq!(told(&|v| v["recipe"]["seed"] = json!(2)), "seed was 1, is 2");
        assert_eq!(
            told(&|v| v["inputs"]["map.osm: a.osm"] = json!("02")),
            "the contents of map.osm: a.osm have changed"
        );
        assert_eq!(told(&|v| v["inputs"] = json!({})), "map.osm: a.osm is no longer read");
        assert_eq!(told(&|v| v["versions"]["build"] = json!("cd")), "trove was built from other sources");
        assert!(told(&|v| v["versions"]["assets"] = json!(["y"])).contains("asset library"));
        assert_eq!(told(&|v| v["versions"]["denoiser"] = json!("e")), r#"denoiser was "d", is "e""#);
        assert_eq!(told(&|v| v["versions"]["device"] = json!("y")), r#"device was "x", is "y""#);
        assert_eq!(told(&|v| v["versions"]["card"] = json!("c")), r#"card was null, is "c""#);
        for (section, key, more) in [
            ("drive", "scenes", json!(["a", "b"])),
            ("drive", "keyframes", json!("all")),
            ("variations", "count", json!(3)),
            ("views", "rig", json!(["A", "B"])),
            ("output", "files", json!(["class"])),
        ] {
            assert_eq!(told(&|v| v["recipe"][section][key] = more.clone()), "", "{key}");
        }
    }

    #[test]
    fn a_rig_of_ones_own_may_gain_cameras_and_keeps_those_that_it_has() {
        let rig = |cameras: &[(&str, &str)]| {
            identity(|v| {
                v["recipe"]["views"]["rig"] = json!("rig.toml");
                cameras.iter().for_each(|(name, camera)| v["inputs"][format!("{CAMERA}{name}")] = json!(camera));
            })
        };
        let was = rig(&[("A", "1"), ("B", "2")]);
        for (is, told) in [
            (rig(&[("A", "1"), ("B", "2")]), ""),
            (rig(&[("A", "1"), ("B", "2"), ("C", "3")]), ""),
            (rig(&[("B", "2")]), "camera A of views.rig has changed or gone"),
            (rig(&[("A", "1"), ("B", "3")]), "camera B of views.rig has changed or gone"),
            (identity(|_| ()), "views.rig was a rig of its own, is the recorded cameras"),
        ] {
            assert_eq!(differences(&was, &is).join("; "), told);
        }
    }

    #[test]
    fn light_may_be_added_to_labels() {
        let labels = identity(|v| {
            v["recipe"]["output"]["files"] = json!(["class"]);
            v["versions"]["denoiser"] = Value::Null;
        });
        assert_eq!(differences(&labels, &identity(|_| ())), [""; 0]);
        assert_eq!(differences(&labels, &identity(|v| v["versions"]["card"] = json!("c"))), [""; 0]);
        // Labels of the built-in kernel are the same on every machine, denoised pictures beside them are not.
        let everywhere = identity(|v| v["versions"]["device"] = Value::Null);
        assert_eq!(differences(&everywhere, &identity(|_| ())), [""; 0]);
    }
}
