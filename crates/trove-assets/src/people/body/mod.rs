//! People on foot with MakeHuman's body: shaped, dressed, and put into postures.

mod build;
mod carried;
mod check;
mod fabric;
mod gait;
mod head;
mod keypoints;
mod outfit;
mod pattern;
mod plan;
mod posture;
mod skeleton;
mod stance;
mod stock;
mod tailor;
mod thin;
mod wearer;

use std::collections::BTreeMap;

use glam::Vec3;
use rayon::prelude::*;
use trove_model::{Asset, HumanBody};

pub(crate) use plan::PersonPlan;

use fabric::Fabrics;
use outfit::Cutter;
use pattern::Pattern;
use stock::Stock;

/// These people in every posture of theirs; nobody where the body lacks its clothing helpers.
pub(crate) fn persons(plans: &[PersonPlan], body: &HumanBody) -> Vec<Asset> {
    let lacks = |group: &&str| !body.groups.contains_key(*group);
    if plans.is_empty() || ["body", "helper-tights", "helper-skirt"].iter().any(lacks) {
        return Vec::new();
    }
    let ((skin, tights), (skirt, fabrics)) = rayon::join(
        || rayon::join(|| thinned(body, "body", 2_450), || thinned(body, "helper-tights", 1_750)),
        || rayon::join(|| thinned(body, "helper-skirt", 700), Fabrics::new),
    );
    let stock = Stock { body, cutter: Cutter::new(body), skin, tights, skirt, fabrics };
    plans.par_iter().flat_map(|plan| tailor::assets(&stock, plan)).collect()
}

/// A group of the body with about so many triangles.
fn thinned(body: &HumanBody, group: &str, keep: usize) -> Pattern {
    let quads = &body.groups[group];
    let triangles: Vec<[u32; 3]> = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [Some([a, b, c]), (c != d).then_some([a, c, d])])
        .flatten()
        .filter(|t| !is_inner(body, t))
        .collect();
    let importance = |v: u32| {
        let p = body.positions[v as usize];
        match () {
            // Feet are in shoes.
            () if p.z < -0.74 && group == "body" => 0.1,
            // Necklines and cuffs.
            () if group == "helper-tights" && (p.z > 0.5 && p.y.abs() < 0.11 || p.y.abs() > 0.4) => 4.0,
            // The face, more so about eyes and mouth.
            () if p.z > 0.6 && p.x > 0.1 && group == "body" => {
                let near = |y: f32, z: f32| ((p.y.abs() - y) / 0.026).hypot((p.z - z) / 0.02);
                if p.y.abs() < 0.002 {
                    30.0
                } else if near(0.031, 0.729).min(near(0.0, 0.66)) < 1.0 {
                    16.0
                } else {
                    5.0
                }
            }
            () if p.z > 0.6 && group == "body" => 2.5,
            // Hands.
            () if p.y.abs() > 0.42 && group == "body" => 2.0,
            () => 1.0,
        }
    };
    let shares: Vec<BTreeMap<u16, f32>> =
        body.weights.iter().map(|w| w.iter().copied().filter(|s| s.1 > 0.0).collect()).collect();
    let difference = |v: u32, w: u32| {
        let (v, w) = (&shares[v as usize], &shares[w as usize]);
        let one: f32 = v.iter().map(|(j, s)| (s - w.get(j).copied().unwrap_or(0.0)).abs()).sum();
        one + w.iter().filter(|(j, _)| !v.contains_key(j)).map(|(_, s)| s).sum::<f32>()
    };
    Pattern::new(&thin::thinned(&body.positions, &triangles, keep, &importance, &difference))
}

/// Whether a face lies inside the mouth, whose walls face its middle.
fn is_inner(body: &HumanBody, t: &[u32; 3]) -> bool {
    let [a, b, c] = t.map(|v| body.positions[v as usize]);
    let middle = Vec3::new(0.11, 0.0, 0.66);
    let (off, normal) = ((a + b + c) / 3.0 - middle, (b - a).cross(c - a).normalize_or_zero());
    let is_behind_lips = off.x < 0.036 - 0.3 * (off.y.abs() - 0.012).max(0.0);
    is_behind_lips && (off * Vec3::new(1.0, 1.4, 1.6)).length() < 0.05 && normal.dot(off.normalize_or_zero()) < -0.2
}
