//! A scene with all that paths find in it as tables of plain numbers, which lie in this processor's memory or in a card's.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec2;
use trove_trace::light::{Haze, Pattern, Sun};
use trove_trace::{
    ComesDown, FlatLights, FlatMaterials, FlatTexture, FlatWeather, FlatWorld, Fog, Lookups, SnowLeft, Spray, Stand,
    Table,
};

use crate::PreparedScene;
use crate::accel::{Flat, Hold};
use crate::lookups::LOOKUPS;
use crate::texture::{MapOf, MipMap};

/// What of a scene is traced, or why none of its paths can be followed through tables.
pub(super) fn flat(scene: &PreparedScene) -> Result<Flat, String> {
    Flat::new(&scene.shapes).ok_or_else(|| "nothing is in the scene".into())
}

/// The tables of a scene in some memory, into which `hold` puts each of them; a texture that many share is put there once.
/// There is no field of the light in its air.
pub(super) fn world<H: Hold>(scene: &PreparedScene, shapes: &Flat, hold: &mut H) -> Result<FlatWorld, H::Error> {
    let (mut stands, mut slots) = (Vec::new(), Vec::new());
    for (placed, instance) in scene.shapes.placed.iter().zip(&scene.instances) {
        let (world_from_mesh, world_from_normal) = placed.at(trove_trace::Motion::MIDDLE);
        stands.push(Stand { world_from_mesh, world_from_normal, materials: slots.len() as u32, bears: instance.bears });
        slots.extend_from_slice(&placed.materials);
    }
    let mut maps = Maps { hold, held: BTreeMap::new() };
    let mut materials = Vec::with_capacity(scene.materials.len());
    for material in &scene.materials {
        materials.push(material.scatters.with_maps(|map| maps.flat(map))?);
    }
    let lights = maps.lights(scene)?;
    let lookups: &Lookups = &LOOKUPS;
    let lookups = hold.hold(std::slice::from_ref(lookups))?;
    let materials = FlatMaterials { lookups, materials: hold.hold(&materials)? };
    let clear = Fog { extinction_per_m: 0.0, height_m: 1.0, ground_z: 0.0, lowest_z: 0.0 };
    let (shapes, looks) = shapes.scene(hold)?;
    Ok(FlatWorld {
        scene: shapes,
        stands: hold.hold(&stands)?,
        looks,
        slots: hold.hold(&slots)?,
        materials,
        lights,
        nodes: Table::at(0, 0),
        lowest: Default::default(),
        fog: scene.fog.unwrap_or(clear),
        has_fog: scene.fog.is_some(),
        weather: weather(scene, hold)?,
    })
}

fn weather<H: Hold>(scene: &PreparedScene, hold: &mut H) -> Result<FlatWeather, H::Error> {
    let ComesDown { snow, left, rain_mm_h, moment_s } = scene.comes_down.view();
    let Spray { plumes, puffs } = scene.spray.view();
    let none = SnowLeft { origin: Vec2::ZERO, cell_m: 1.0, size: [0; 2], shares: &[] };
    let SnowLeft { origin, cell_m, size, shares } = left.unwrap_or(none);
    Ok(FlatWeather {
        shares: hold.hold(shares)?,
        size,
        origin,
        cell_m,
        snow: snow.unwrap_or_default(),
        rain_mm_h,
        moment_s,
        plumes: hold.hold(plumes)?,
        puffs: hold.hold(puffs)?,
        has_snow: snow.is_some(),
    })
}

/// Textures that are in a memory.
struct Maps<'a, H> {
    hold: &'a mut H,
    held: BTreeMap<*const MipMap, FlatTexture>,
}

impl<H: Hold> Maps<'_, H> {
    fn flat(&mut self, map: &MapOf) -> Result<FlatTexture, H::Error> {
        let Some(map) = &map.0 else {
            // SAFETY: there is nothing in it.
            return Ok(unsafe { FlatTexture::new([1; 2], Table::at(0, 0), Table::at(0, 0), false) });
        };
        let address = Arc::as_ptr(map);
        if let Some(flat) = self.held.get(&address) {
            return Ok(*flat);
        }
        let flat = self.hold.map(map)?;
        self.held.insert(address, flat);
        Ok(flat)
    }

    fn lights(&mut self, scene: &PreparedScene) -> Result<FlatLights, H::Error> {
        let lights = scene.lights.view();
        let (sky, cells) = (&lights.sky, &lights.sky.cells);
        let mut patterns = Vec::new();
        for Pattern { brightest, scale, uvs, map } in lights.emitters.as_ref().map_or(&[][..], |e| e.patterns) {
            patterns.push(Pattern { brightest: *brightest, scale: *scale, uvs: *uvs, map: self.flat(map)? });
        }
        let hold = &mut *self.hold;
        let emitters = lights.emitters.as_ref();
        let tree = emitters.map(|emitters| &emitters.tree);
        Ok(FlatLights {
            picture: hold.hold(sky.picture.rgb)?,
            cells: hold.hold(cells.cells)?,
            patches: hold.hold(std::slice::from_ref(cells.patches))?,
            within: hold.hold(cells.within)?,
            cumulative: hold.hold(cells.cumulative)?,
            guide: hold.hold(cells.guide)?,
            tables: hold.hold(lights.beams.tables)?,
            numbers: hold.hold(lights.beams.numbers)?,
            triangles: hold.hold(emitters.map_or(&[], |emitters| emitters.triangles))?,
            patterns: hold.hold(&patterns)?,
            groups: hold.hold(tree.map_or(&[], |tree| tree.groups))?,
            order: hold.hold(tree.map_or(&[], |tree| tree.order))?,
            leaf_of: hold.hold(tree.map_or(&[], |tree| tree.leaf_of))?,
            aims: hold.hold(tree.map_or(&[], |tree| tree.aims))?,
            sun: lights.sun.unwrap_or(Sun::new(glam::Vec3::Z, glam::Vec3::ZERO)),
            haze: lights.haze.unwrap_or(Haze { extinction_per_m: glam::Vec3::ZERO }),
            picture_size: [sky.picture.width as u32, sky.picture.height as u32],
            side: cells.side as u32,
            emitter_share: lights.emitter_share,
            scale: lights.scale,
            is_smooth: sky.is_smooth,
            has_sun: lights.sun.is_some(),
            has_haze: lights.haze.is_some(),
        })
    }
}
