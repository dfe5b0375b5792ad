//! Plans of buildings built.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Surface};

use super::finish;
use super::parts::{PartPlan, Side};
use super::plan::{ArcadePlan, BuildingPlan, DeckPlan, LevelPlan, MassPlan, RoofPlan};
use super::repeat::repeat;
use super::roof::Pitched;
use super::site::{Site, rectangle};
use super::spot::Spot;
use crate::shape::Shape;

impl BuildingPlan {
    /// What it tells of, in these surfaces.
    pub(crate) fn asset(&self, surfaces: &[Surface]) -> Asset {
        let mut builder = Builder { plan: self, site: Site::new(surfaces) };
        self.masses.iter().for_each(|mass| builder.mass(mass));
        self.parts.iter().for_each(|part| builder.part(part));
        let middle = builder.site.middle();
        let mut asset = builder.site.asset(&self.id).tagged(&self.tags);
        asset.commonness = self.commonness;
        asset.countries.clone_from(&self.countries);
        asset.repeats = self.repeats(&asset, middle);
        asset
    }

    /// Slabs that the plan states, or else what its modules and storeys imply.
    fn repeats(&self, asset: &Asset, middle: Vec2) -> [Option<[f64; 2]>; 3] {
        let half = [asset.size_m.x as f32 / 2.0, asset.size_m.y as f32 / 2.0];
        // Bays begin at the corners of the walls.
        let corner = |axis: usize| {
            let mass = self.masses.first().map_or(0.0, |mass| mass.at_m[axis] - mass.size_m[axis] / 2.0);
            mass - middle[axis]
        };
        let level =
            |axis: usize| repeat(&asset.mesh, axis, self.module_m[axis], [-half[axis], half[axis]], corner(axis));
        let storeys = self.masses.iter().flat_map(MassPlan::levels).filter(|(_, level)| level.count > 1);
        let most = storeys.max_by(|(_, a), (_, b)| a.height_m().total_cmp(&b.height_m()));
        // Planes lie under the floors, over the heads of windows, so that the lowest begins below its level;
        // doors stay at the foot.
        let upright = || {
            most.and_then(|(foot, level)| {
                repeat(
                    &asset.mesh,
                    2,
                    level.storey_m,
                    [(foot - level.storey_m / 2.0).max(0.75 * level.storey_m), foot + level.height_m()],
                    foot,
                )
            })
        };
        [self.repeat.x.or_else(|| level(0)), self.repeat.y.or_else(|| level(1)), self.repeat.z.or_else(upright)]
    }
}

/// A plan's building under construction.
struct Builder<'p, 's> {
    plan: &'p BuildingPlan,
    site: Site<'s>,
}

impl Builder<'_, '_> {
    fn slot(&mut self, name: &str) -> u16 {
        match self.plan.finishes.get(name) {
            Some(own) => finish::own(&mut self.site, name, own),
            None => finish::common(&mut self.site, name),
        }
    }

    /// A wall's slot and the surface whose bays and storeys it shows.
    fn wall(&mut self, name: &str) -> (u16, String) {
        let surface = self.plan.finishes.get(name).and_then(|own| own.surface.clone());
        (self.slot(name), surface.unwrap_or_else(|| name.to_owned()))
    }

    fn mass(&mut self, mass: &MassPlan) {
        let (size, at) = (Vec2::from_array(mass.size_m), Vec2::from_array(mass.at_m));
        let outline: Vec<Vec2> = rectangle(size).iter().map(|p| *p + at).collect();
        if let Some(soffit) = &mass.soffit {
            let slot = self.slot(soffit);
            self.site.add(slot, Shape::flat(&outline).inside_out().moved(Vec3::Z * mass.base_m));
        }
        for (foot, level) in mass.levels() {
            self.level(level, &outline, foot);
        }
        if let Some(roof) = &mass.roof {
            self.roof(roof, &outline, at.extend(mass.top_m()), size);
        }
    }

    fn level(&mut self, level: &LevelPlan, outline: &[Vec2], foot: f32) {
        let top = foot + level.height_m();
        let mut ring = outline.to_vec();
        if let Some(arcade) = &level.arcade {
            self.arcade(arcade, outline, foot, top);
            ring[0].y += arcade.deep_m;
            ring[1].y += arcade.deep_m;
        }
        let walls: Vec<(u16, String)> = level.walls.iter().map(|name| self.wall(name)).collect();
        if !walls.is_empty() {
            let walls: Vec<(u16, &str)> = walls.iter().map(|(slot, id)| (*slot, id.as_str())).collect();
            self.site.walls_of(&ring, foot..top, &walls);
        }
        for storey in 0..level.count {
            let z = foot + level.storey_m * storey as f32;
            for band in level.bands.iter().filter(|band| !band.top || storey + 1 == level.count) {
                let slot = self.slot(&band.finish);
                let [low, high] = band.between_m.map(|by| z + by);
                self.site.band(slot, &ring, low..high, band.out_m, 0.03);
            }
            if let Some(deck) = &level.deck {
                self.deck(deck, outline, [z, z + level.storey_m], storey > 0);
            }
        }
        if let Some(deck) = &level.deck {
            self.columns(deck, outline, [foot, top]);
        }
    }

    /// A walk behind piers, with its ceiling; the wall at its back is the level's.
    fn arcade(&mut self, arcade: &ArcadePlan, outline: &[Vec2], foot: f32, top: f32) {
        let slot = self.slot(&arcade.finish);
        let (low, high) = (outline[0], outline[1]);
        let (length, deep) = (high.x - low.x, arcade.deep_m);
        let middle = vec3((low.x + high.x) / 2.0, low.y, foot);
        let [wide, thick] = arcade.pier_m;
        let walk = vec3(length, deep, 0.12);
        self.site.block(slot, middle + vec3(0.0, deep / 2.0, 0.06), walk);
        let ceiling = vec3(length - 0.02, deep, 0.1);
        self.site.block(slot, vec3(middle.x, low.y + deep / 2.0 + 0.01, top - 0.06), ceiling);
        let beam = vec3(length, thick, arcade.beam_m);
        self.site.block(slot, vec3(middle.x, low.y + thick / 2.0, top - arcade.beam_m / 2.0 - 0.01), beam);
        let count = (length / arcade.every_m).round() as u32;
        let high_m = top - foot - arcade.beam_m;
        for i in 0..=count {
            // The outermost stand within the wall's ends.
            let x =
                (arcade.every_m * (i as f32 - count as f32 / 2.0)).clamp((wide - length) / 2.0, (length - wide) / 2.0);
            let pier = vec3(wide, thick, high_m);
            self.site.block(slot, middle + vec3(x, thick / 2.0, high_m / 2.0), pier);
        }
    }

    /// The slab over an open storey and the parapet around its floor.
    fn deck(&mut self, deck: &DeckPlan, outline: &[Vec2], [z, top]: [f32; 2], is_raised: bool) {
        let (slab, parapet) = (self.slot(&deck.finish), self.slot(&deck.parapet));
        let (low, high) = (outline[0], outline[2]);
        let size = (high - low - 0.2).extend(deck.slab_m - 0.01);
        self.site.block(slab, ((low + high) / 2.0).extend(top - 0.01 - size.z / 2.0), size);
        if is_raised {
            self.site.band(parapet, outline, z - deck.slab_m..z + deck.parapet_m, 0.0, 0.2);
        }
        // The topmost is closed by the roof's own parapet.
        self.site.band(parapet, outline, top - deck.slab_m..top - 0.005, 0.0, 0.2);
    }

    fn columns(&mut self, deck: &DeckPlan, outline: &[Vec2], [foot, top]: [f32; 2]) {
        let slot = self.slot(&deck.finish);
        let (low, high) = (outline[0], outline[2]);
        let size = high - low;
        let counts = [0, 1].map(|axis| (size[axis] / deck.columns_m[axis]).round().max(1.0) as u32);
        for (i, j) in (0..=counts[0]).flat_map(|i| (0..=counts[1]).map(move |j| (i, j))) {
            let grid = vec2(
                deck.columns_m[0] * (i as f32 - counts[0] as f32 / 2.0),
                deck.columns_m[1] * (j as f32 - counts[1] as f32 / 2.0),
            );
            let inner = size / 2.0 - 0.5;
            let at = (low + high) / 2.0 + grid.clamp(-inner, inner);
            self.site.block(slot, at.extend((foot + top) / 2.0), vec3(0.45, 0.45, top - foot - 0.1));
        }
    }

    fn roof(&mut self, roof: &RoofPlan, outline: &[Vec2], middle: Vec3, size: Vec2) {
        match roof {
            RoofPlan::Flat { covering, coping, parapet_m } => {
                let (covering, coping) = (self.slot(covering), self.slot(coping));
                self.site.flat_roof(outline, middle.z, *parapet_m, covering, coping);
            }
            RoofPlan::Pitched { tiles, gable, rise_m, hip_m, across } => {
                let slots = [self.slot(tiles), self.slot(gable)];
                let size = if *across { vec2(size.y, size.x) } else { size };
                let roof = Pitched { slots, middle, size, rise_m: *rise_m, hip_m: *hip_m, across: *across };
                self.site.pitched_roof(&roof);
            }
            RoofPlan::Mansard { tiles, covering, trim, rise_m, in_m } => {
                let slots = [self.slot(tiles), self.slot(covering), self.slot(trim)];
                self.site.mansard_roof(slots, middle, size, *rise_m, *in_m);
            }
        }
    }

    fn part(&mut self, part: &PartPlan) {
        let slot = self.slot(&part.finish);
        let tiles = part.shape.tiles().map_or(slot, |name| self.slot(name));
        let mass = &self.plan.masses[part.mass];
        let (half, middle) = (Vec2::from_array(mass.size_m) / 2.0, Vec2::from_array(mass.at_m));
        let [along, out, up] = [&part.along, &part.out, &part.up].map(|places| places.metres());
        for side in &part.sides {
            let (quarters, wall) = match side {
                Side::Front => (0.0, half.y),
                Side::Right => (1.0, half.x),
                Side::Back => (2.0, half.y),
                Side::Left => (3.0, half.x),
                Side::Top => (0.0, 0.0),
            };
            let turn = Quat::from_rotation_z(quarters * FRAC_PI_2);
            let places = along.iter().flat_map(|x| out.iter().map(move |y| (*x, *y)));
            for ((x, y), z) in places.flat_map(|place| up.iter().map(move |z| (place, *z))) {
                let at = middle.extend(0.0) + turn * vec3(x, -wall - y, z);
                Spot { at, turn }.build(&mut self.site, slot, tiles, &part.shape);
            }
        }
    }
}
