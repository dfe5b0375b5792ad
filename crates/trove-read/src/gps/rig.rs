//! Rigs by name.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use trove_format::PlainCamera;
use trove_model::RigCamera;

use crate::plain::camera;

static RIGS: LazyLock<BTreeMap<String, BTreeMap<String, PlainCamera>>> =
    LazyLock::new(|| toml::from_str(include_str!("rigs.toml")).expect("a table of rigs, which a test reads"));

/// The cameras of a rig in the order of their names; the error says which rigs there are.
pub(super) fn rig(name: &str) -> Result<Vec<RigCamera>, String> {
    let known: Vec<&str> = RIGS.keys().map(String::as_str).collect();
    let rig = RIGS.get(name).ok_or_else(|| format!("rig: expected one of {}, found \"{name}\"", known.join(", ")))?;
    let camera = |(name, given): (&String, &PlainCamera)| {
        let (lens, ego_from_camera) = camera(given).map_err(|why| format!("rig: {name}: {why}"))?;
        Ok(RigCamera { name: name.clone(), lens, ego_from_camera })
    };
    rig.iter().map(camera).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rig_in_the_table_can_be_used() {
        for name in RIGS.keys() {
            assert!(!rig(name).unwrap().is_empty(), "{name}");
        }
        let across = 2.0 * (800.0 / rig("front").unwrap()[0].lens.fx_px).atan();
        assert!((across.to_degrees() - 70.0).abs() < 0.01, "{across}");
        assert!(rig("roof").unwrap_err().contains("front"));
    }
}
