//! Materials as plain numbers, in this processor's memory or in a card's.

use std::collections::BTreeMap;
use std::sync::Arc;

use trove_trace::{FlatMaterials, FlatTexture, Table};

use super::PreparedMaterial;
use crate::accel::Hold;
use crate::lookups::LOOKUPS;
use crate::texture::{MapOf, MipMap};

/// The materials of a scene in some memory, into which `hold` puts each table; a texture that many share is put there once.
pub(crate) fn flat<E>(materials: &[PreparedMaterial], hold: &mut impl Hold<Error = E>) -> Result<FlatMaterials, E> {
    let mut held: BTreeMap<*const MipMap, FlatTexture> = BTreeMap::new();
    let mut map = |map: &MapOf| {
        // SAFETY: there is nothing in it.
        let Some(map) = &map.0 else {
            return Ok(unsafe { FlatTexture::new([1; 2], Table::at(0, 0), Table::at(0, 0), false) });
        };
        let address = Arc::as_ptr(map);
        if let Some(flat) = held.get(&address) {
            return Ok(*flat);
        }
        let texture = map.texture();
        let (firsts, texels) = (hold.hold(texture.firsts)?, hold.hold(texture.texels)?);
        // SAFETY: whoever holds them keeps them.
        let flat = unsafe { FlatTexture::new(texture.size, firsts, texels, texture.is_srgb) };
        held.insert(address, flat);
        Ok(flat)
    };
    let mut flat = Vec::with_capacity(materials.len());
    for material in materials {
        flat.push(material.scatters.with_maps(&mut map)?);
    }
    Ok(FlatMaterials { lookups: hold.hold(std::slice::from_ref(&*LOOKUPS))?, materials: hold.hold(&flat)? })
}
