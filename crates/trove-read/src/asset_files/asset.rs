//! An entry of a library and its model → `Asset`.

use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::{Mat3, Vec3};
use trove_model::{Asset, Coarser, Figure, Kind, Mesh, Posture, Slot};

use super::axes::Axis;
use super::fault::Fault;
use super::guess::scale;
use super::library_file::{AssetEntry, RepeatsEntry};
use super::model::Model;
use super::names::{class_named, kind_named, outdoors_named, role_named};
use super::repair::thinned;

/// A bay or a storey is no thinner, metres, and reaches out of its model by rounding only.
const THINNEST_M: f64 = 0.5;
const WITHIN_M: f64 = 0.01;

/// Turns, scales and places a model by a completed entry; `None` for one that is not to be placed.
pub(super) fn asset(id: &str, entry: &AssetEntry, model: Model) -> Result<Option<Asset>, Fault> {
    let place = format!("asset {:?}", entry.file);
    let Some(Some(kind)) = kind_named(entry.kind.as_deref(), &place)? else { return Ok(None) };
    let class = class_named(entry.class.as_deref(), &place)?.flatten().unwrap_or(kind.class());
    let (up, front) = (entry.up.unwrap_or(Axis::PlusY), entry.front.unwrap_or(Axis::PlusZ));
    if up.is_along(front) {
        let found = format!("up {} and front {}", up.name(), front.name());
        return Err(Fault::new(place, "up and front at right angles", found, "correct one of them in library.toml"));
    }
    let mut mesh = model.mesh;
    // Buildings lie along x with their fronts towards −y.
    let forward = if kind == Kind::Building { Mat3::from_rotation_z(-FRAC_PI_2) } else { Mat3::IDENTITY };
    stand(&mut mesh, forward * Axis::turn(front, up), entry, kind);
    let mut slots: Vec<Slot> = model.materials.into_iter().map(|material| Slot::new(material, Vec::new())).collect();
    for (name, role) in &entry.roles {
        let role = role_named(role, &place)?;
        let mut named = slots.iter_mut().filter(|slot| slot.material.name == *name).peekable();
        if named.peek().is_none() {
            let remedy = "name a material of the model, or remove the line";
            return Err(Fault::new(format!("{place}: roles"), "the model's materials", format!("{name:?}"), remedy));
        }
        named.for_each(|slot| slot.material.role = Some(role));
    }
    let mut asset = Asset::new(id, kind, class, mesh, slots, &licence(entry));
    asset = asset.tagged(entry.tags.iter().flatten());
    asset.commonness = entry.commonness.filter(|c| c.is_finite() && *c >= 0.0).unwrap_or(1.0);
    asset.worn_in = entry.worn_in.iter().map(|name| outdoors_named(name, &place)).collect::<Result<_, _>>()?;
    asset.figure = posture(entry).map(|posture| Figure { person: id.into(), posture });
    asset.coarser = coarser(&asset);
    asset.countries.clone_from(&entry.countries);
    asset.repeats = repeats(entry, &asset, &place)?;
    Ok(Some(asset))
}

/// The slabs that may be repeated, of a building alone and within it.
fn repeats(entry: &AssetEntry, asset: &Asset, place: &str) -> Result<[Option<[f64; 2]>; 3], Fault> {
    let RepeatsEntry { x, y, z } = entry.repeats;
    let (low, high) = asset.mesh.bounds().unwrap_or_default();
    for (axis, slab) in [x, y, z].into_iter().enumerate() {
        let Some([from, to]) = slab else { continue };
        let place = || format!("{place}: repeats.{}", ["x", "y", "z"][axis]);
        if asset.kind != Kind::Building {
            return Err(Fault::new(place(), "nothing", "a slab of what is no building", "remove the key"));
        }
        let [low, high] = [low, high].map(|v| f64::from(v[axis]));
        let is_within = from >= low - WITHIN_M && to <= high + WITHIN_M && to - from >= THINNEST_M;
        if !is_within {
            let expected = format!("from and to between {low:.2} and {high:.2} m, at least {THINNEST_M} m apart");
            return Err(Fault::new(place(), expected, format!("[{from}, {to}]"), "measure the model's bay or storey"));
        }
    }
    Ok([x, y, z])
}

/// Metres, x forward, z up, standing on z = 0 over the origin.
fn stand(mesh: &mut Mesh, turn: Mat3, entry: &AssetEntry, kind: Kind) {
    for v in mesh.positions.iter_mut().chain(&mut mesh.normals) {
        *v = turn * *v;
    }
    let (low, high) = mesh.bounds().unwrap_or_default();
    let size = high - low;
    let scale = scale(entry, size);
    let mut origin = Vec3::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, low.z);
    if kind.is_on_pole() {
        // The foot is what lies lowest.
        let edge = low.z + 0.02 * size.z;
        let foot = || mesh.positions.iter().filter(|p| p.z <= edge);
        let (mut lowest, mut highest) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        foot().for_each(|p| (lowest, highest) = (lowest.min(*p), highest.max(*p)));
        origin = ((lowest + highest) / 2.0).with_z(low.z);
    }
    mesh.positions.iter_mut().for_each(|p| *p = (*p - origin) * scale);
}

/// `CC0-1.0, Quaternius, https://…`.
fn licence(entry: &AssetEntry) -> String {
    let parts = [&entry.licence, &entry.author, &entry.source];
    let parts: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
    if entry.licence.is_none() {
        format!("licence unknown {}", parts.join(", ")).trim().into()
    } else {
        parts.join(", ")
    }
}

fn posture(entry: &AssetEntry) -> Option<Posture> {
    // A file shows one phase: the step's widest, as models of walkers do.
    match entry.posture.as_deref()? {
        "sitting" => Some(Posture::Sitting),
        "walking" => Some(Posture::Walking { phase: 0.0, stride_m: 1.4 }),
        "running" => Some(Posture::Running { phase: 0.0, stride_m: 2.4 }),
        _ => Some(Posture::Standing),
    }
}

/// A fifth of the triangles from where the largest ones left out are a pixel wide, for models of over 20,000.
fn coarser(asset: &Asset) -> Vec<Coarser> {
    if asset.mesh.triangles.len() < 20_000 {
        return Vec::new();
    }
    let mut mesh = (*asset.mesh).clone();
    thinned(&mut mesh, asset.mesh.triangles.len() / 5);
    let from_m = (12.0 * asset.size_m.max_element()).max(25.0);
    vec![Coarser { from_m, mesh: Arc::new(mesh) }]
}
