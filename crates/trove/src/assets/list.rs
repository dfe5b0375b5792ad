//! `trove assets list`.

use anyhow::Result;
use serde_json::{Value, json};
use trove_model::{Asset, AssetLibrary, Surface};

use crate::message::shown;

/// Prints what the libraries hold.
pub(crate) fn run(library: &AssetLibrary, as_json: bool) -> Result<()> {
    if as_json {
        let assets: Vec<Value> = library.assets.iter().map(asset).collect();
        let materials: Vec<Value> = library.surfaces.iter().map(material).collect();
        println!("{}", serde_json::to_string_pretty(&json!({ "assets": assets, "materials": materials }))?);
        return Ok(());
    }
    for a in &library.assets {
        let [l, w, h] = a.size_m.to_array();
        println!(
            "{:36} {:22} {l:6.2} × {w:5.2} × {h:5.2} m  {:6} triangles",
            shown(&a.id),
            a.kind.name(),
            a.mesh.triangles.len()
        );
    }
    for s in &library.surfaces {
        println!("{:36} {:22} {:6.2} × {:5.2} m", shown(&s.id), s.kind.name(), s.size_m[0], s.size_m[1]);
    }
    println!("{} models, {} materials", library.assets.len(), library.surfaces.len());
    Ok(())
}

fn asset(a: &Asset) -> Value {
    json!({
        "id": a.id,
        "kind": a.kind.name(),
        "class": a.class.row().name,
        "tags": a.tags.iter().collect::<Vec<_>>(),
        "size_m": a.size_m.to_array(),
        "triangles": a.mesh.triangles.len(),
        "materials": a.slots.iter().map(|slot| &slot.material.name).collect::<Vec<_>>(),
        "extras": a.extras.iter().map(|extra| &extra.group).collect::<Vec<_>>(),
        "commonness": a.commonness,
        "worn_in": a.worn_in.iter().map(|outdoors| outdoors.name()).collect::<Vec<_>>(),
        "licence": a.licence,
    })
}

fn material(s: &Surface) -> Value {
    json!({
        "id": s.id,
        "kind": s.kind.name(),
        "tags": s.tags.iter().collect::<Vec<_>>(),
        "size_m": s.size_m,
        "textures": s.material.textures().map(|t| json!({ "name": t.name, "size_px": [t.width, t.height] })).collect::<Vec<_>>(),
    })
}
