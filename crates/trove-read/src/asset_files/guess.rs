//! The keys of an asset that its users have not written, by its name and its shape.

use glam::Vec3;
use trove_model::Kind;

use super::axes::Axis;
use super::fault::Fault;
use super::front::front;
use super::library_file::{AssetEntry, Guess};
use super::licence::{Terms, spdx};
use super::model::Model;
use super::names::{class_named, kind_name, kind_named};
use super::samples::samples;
use super::subjects::{self, Expected, Named};
use super::tags;
use super::upright::{Scale, upright};

/// Fills in what the entry lacks; what it has is kept and helps with the rest.
pub(super) fn complete(entry: &mut AssetEntry, model: &Model, terms: Option<&Terms>) -> Result<(), Fault> {
    let place = format!("asset {:?}", entry.file);
    let named = subjects::named(&entry.file);
    let said = kind_named(entry.kind.as_deref(), &place)?;
    let class = class_named(entry.class.as_deref(), &place)?.flatten();
    let subject = match said {
        Some(Some(kind)) => {
            named.map(|n| n.subject).filter(|s| s.kind == Some(kind)).or_else(|| subjects::of_kind(kind, class))
        }
        _ => named.map(|n| n.subject),
    };
    let mut add = |key, value: String, confidence: f32, reason: String| {
        entry.guesses.push(Guess { key, value, confidence, reason });
    };
    let kind = said.unwrap_or(named.and_then(|n| n.subject.kind));
    if said.is_none() {
        let (confidence, reason) = named.map_or((0.3, "nothing in its name says what it shows".into()), why);
        let name = kind_name(kind);
        add("kind", format!("\"{name}\""), confidence, reason.clone());
        entry.kind = Some(name);
        if let Some(class) = named.and_then(|n| n.subject.class).filter(|_| entry.class.is_none() && kind.is_some()) {
            add("class", format!("{:?}", class.row().name), confidence, reason);
            entry.class = Some(class.row().name.into());
        }
    }
    if let (None, Some(kind)) = (&entry.tags, kind)
        && let Some((tags, guess)) = tags::of_model(&entry.file, kind, model.materials.iter().map(|m| m.name.as_str()))
    {
        add(guess.key, guess.value, guess.confidence, guess.reason);
        entry.tags = Some(tags);
    }
    let points = samples(model);
    let (low, high) = model.mesh.bounds().unwrap_or((Vec3::ZERO, Vec3::ONE));
    let size = (high - low).max(Vec3::splat(1e-9));
    let expected = subject.map(|s| Expected::of(s, &entry.file));
    let mut stance = upright(size, &points, expected, model.declared);
    match entry.up {
        Some(up) if up != stance.up => {
            // The user turns it: only stances with that axis up are left.
            stance = super::upright::with_up(size, &points, expected, up);
        }
        Some(_) => {}
        None => {
            add("up", format!("{:?}", stance.up.name()), stance.up_confidence, stance.up_reason.clone());
            entry.up = Some(stance.up);
        }
    }
    if entry.front.is_none() {
        let found = front(&points, &model.marks, kind, &stance);
        add("front", format!("{:?}", found.front.name()), found.confidence, found.reason);
        entry.front = Some(found.front);
    }
    if entry.unit_m.is_none() && entry.height_m.is_none() && entry.length_m.is_none() {
        let (key, metres) = match stance.scale {
            Scale::Unit(m) => ("unit_m", m),
            Scale::Height(m) => ("height_m", m),
            Scale::Length(m) => ("length_m", m),
        };
        // Through its decimal form, so that 0.3048 stays 0.3048.
        let value: f64 = metres.to_string().parse().unwrap_or(f64::from(metres));
        add(key, format!("{value:?}"), stance.scale_confidence, stance.scale_reason.clone());
        match stance.scale {
            Scale::Unit(_) => entry.unit_m = Some(value),
            Scale::Height(_) => entry.height_m = Some(value),
            Scale::Length(_) => entry.length_m = Some(value),
        }
    }
    if entry.posture.is_none() && kind.is_some_and(is_on_foot) {
        let (posture, reason) = posture(&entry.file);
        add("posture", format!("{posture:?}"), 0.7, reason.into());
        entry.posture = Some(posture.into());
    }
    provenance(entry, model, terms);
    if let (Some(up), Some(front)) = (entry.up, entry.front) {
        let size = (Axis::turn(front, up) * size).abs();
        entry.size_m = Some((size * scale(entry, size)).as_dvec3());
    }
    Ok(())
}

/// Metres a unit of the file, whose model has that size turned upright.
pub(super) fn scale(entry: &AssetEntry, size: Vec3) -> f32 {
    let per = |metres: Option<f64>, units: f32| metres.map(|m| m as f32 / units.max(1e-9));
    per(entry.height_m, size.z).or(per(entry.length_m, size.x)).or(entry.unit_m.map(|u| u as f32)).unwrap_or(1.0)
}

fn why(named: Named) -> (f32, String) {
    let place = if named.in_folder { "its folder's name" } else { "its name" };
    (named.confidence, format!("{:?} in {place}", named.phrase))
}

pub(super) fn is_on_foot(kind: Kind) -> bool {
    matches!(kind, Kind::Adult | Kind::Child | Kind::ConstructionWorker | Kind::PoliceOfficer)
}

fn posture(file: &str) -> (&'static str, &'static str) {
    let words = super::words::words(super::scan::stem_of(file));
    for (stem, posture) in
        [("sit", "sitting"), ("seat", "sitting"), ("walk", "walking"), ("run", "running"), ("jog", "running")]
    {
        if words.iter().any(|w| w.starts_with(stem)) {
            return (posture, "its name");
        }
    }
    ("standing", "nothing else in its name")
}

/// Licence, author and source: of the model itself, else of a licence file beside it.
fn provenance(entry: &mut AssetEntry, model: &Model, terms: Option<&Terms>) {
    let own = model.licence.as_deref().filter(|l| !l.trim().is_empty());
    let licence = own.map(|l| (spdx(l).unwrap_or(l).to_owned(), 0.95, "the model's file".to_owned()));
    let licence = licence.or_else(|| terms.map(|t| (t.licence.clone(), 0.9, t.file.clone())));
    let author = model.author.clone().map(|a| (a, 0.95, "the model's file".to_owned()));
    let author = author.or_else(|| terms.and_then(|t| Some((t.author.clone()?, 0.7, t.file.clone()))));
    let source = model.source.clone().map(|s| (s, 0.95, "the model's file".to_owned()));
    for (key, slot, found) in [
        ("licence", &mut entry.licence, licence),
        ("author", &mut entry.author, author),
        ("source", &mut entry.source, source),
    ] {
        let (None, Some((value, confidence, reason))) = (slot.as_ref(), found) else { continue };
        entry.guesses.push(Guess { key, value: toml::Value::String(value.clone()).to_string(), confidence, reason });
        *slot = Some(value);
    }
}
