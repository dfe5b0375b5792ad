//! What lorries carry in some of their variations.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::Seed;

use super::bed::Bed;
use crate::shape::Shape;
use crate::vehicles::coverings::metric;
use crate::vehicles::workshop::{Workshop, block};

impl Bed {
    /// Gravel heaped up in a tub, which it fills to `rim`; its crest stays below `rim` + `crest_m`.
    pub(crate) fn gravel(&self, work: &mut Workshop, share: f32, rim: f32, crest_m: f32) {
        let (nx, ny) = (22, 12);
        let mut random = Seed(0x96a).random();
        let rows: Vec<Vec<Vec3>> = (0..=nx)
            .map(|i| {
                let s = i as f32 / nx as f32;
                (0..=ny)
                    .map(|k| {
                        let t = 1.0 - 2.0 * k as f32 / ny as f32;
                        let heap = ((PI * s).sin() * (1.0 - t * t)).max(0.0).powf(0.7);
                        let bump = random.range(-0.03, 0.03) as f32 * heap.min(0.5);
                        let z = rim - 0.22 + (0.22 + crest_m) * heap * 0.96 + bump;
                        vec3(-self.to + 0.05 + (self.length() - 0.1) * s, t * (self.half - 0.08), z.min(rim + crest_m))
                    })
                    .collect()
            })
            .collect();
        let heap = metric(Shape::sheet(&rows).smooth(0.9)).slot(work.slots.gravel);
        work.model.add_extra("load", share, false, heap);
    }

    /// Pipes along the bed, in a pile held by straps.
    pub(crate) fn pipes(&self, work: &mut Workshop, share: f32, radius_m: f32) {
        let slots = work.slots;
        let floor = self.floor_top() + 0.09;
        let length = self.length() * 0.93;
        let across = ((self.half * 1.8) / (radius_m * 2.0)) as usize;
        let mut parts = Vec::new();
        for layer in 0..3 {
            for k in 0..across.saturating_sub(layer) {
                let y = (k as f32 - (across - layer - 1) as f32 / 2.0) * radius_m * 2.01;
                let z = floor + radius_m + layer as f32 * radius_m * 1.74;
                let shift = 0.1 * ((k * 7 + layer * 3) % 5) as f32 / 5.0;
                let profile = [
                    (radius_m * 0.84, 0.0),
                    (radius_m, 0.0),
                    (radius_m, length),
                    (radius_m * 0.84, length),
                    (radius_m * 0.84, 0.0),
                ];
                let pipe = Shape::lathe(&profile.map(|(r, z)| vec2(r, z)), 14).turned(Quat::from_rotation_y(PI / 2.0));
                parts.push(pipe.moved(vec3(-self.to + 0.08 + shift * 0.5, y, z)).slot(slots.second));
            }
        }
        for t in [0.2, 0.5, 0.8] {
            let x = -self.to + length * t;
            parts.push(block([0.1, self.half * 1.8, 0.08], [x, 0.0, floor - 0.045], 0.01).slot(slots.cargo));
            let (w, top) = (across as f32 * radius_m, floor + radius_m * 5.6);
            let strap: Vec<Vec3> = [
                (w + 0.02, floor),
                (w + 0.01, floor + radius_m * 1.4),
                (w - radius_m * 2.0, top),
                (-w + radius_m * 2.0, top),
                (-w - 0.01, floor + radius_m * 1.4),
                (-w - 0.02, floor),
            ]
            .map(|(y, z)| vec3(x + 0.2, y, z))
            .to_vec();
            parts.push(Shape::tube(&strap, 0.012, 4).slot(slots.yellow));
        }
        work.model.add_extra("load", share, false, Shape::join(parts));
    }

    /// Pallets in two rows with cartons or sacks on them, up to a height; over a share of the bed from the back.
    pub(crate) fn pallets(&self, work: &mut Workshop, share: f32, height_m: f32, filled: f32) {
        let slots = work.slots;
        let mut random = Seed(0x60_0d5).nth((self.to * 100.0) as u64).random();
        let mut parts = Vec::new();
        let floor = self.floor_top() + 0.01;
        let columns = if self.half > 0.98 { 2 } else { 1 };
        let rows = ((self.length() * filled) / 1.28) as usize;
        for row in 0..rows {
            for column in 0..columns {
                if random.chance(0.12) {
                    continue;
                }
                let y = if columns == 2 { self.half * (0.5 - column as f32) * 0.96 } else { 0.0 };
                let x = -self.to + 0.75 + row as f32 * 1.28;
                let turn = Quat::from_rotation_z(random.range(-0.04, 0.04) as f32);
                let place = |s: Shape| s.turned(turn).moved(vec3(x, y, floor));
                for k in 0..5 {
                    let board = block([1.2, 0.11, 0.022], [0.0, -0.4 + 0.2 * k as f32, 0.133], 0.004);
                    parts.push(place(board).slot(slots.cargo));
                }
                for k in -1..=1 {
                    let beam = block([0.1, 0.98, 0.1], [0.54 * k as f32, 0.0, 0.06], 0.006);
                    parts.push(place(beam).slot(slots.cargo));
                }
                let height = height_m * random.range(0.45, 1.0) as f32 - 0.15;
                let layers = (height / 0.3).ceil().max(1.0) as usize;
                let sacks = random.chance(0.35);
                let slot = if sacks { slots.white } else { slots.cargo };
                for layer in 0..layers {
                    let each = height / layers as f32;
                    for k in 0..4 {
                        let (dx, dy) = ((k % 2) as f32 - 0.5, (k / 2) as f32 - 0.5);
                        if layer + 1 == layers && random.chance(0.3) {
                            continue;
                        }
                        let size = vec3(0.565, 0.47, each * 0.97);
                        let wobble = Quat::from_rotation_z(random.range(-0.03, 0.03) as f32);
                        let at = vec3(dx * 0.58, dy * 0.485, 0.145 + each * (layer as f32 + 0.5));
                        let one = if sacks {
                            Shape::rounded_block(size * vec3(1.0, 1.0, 1.05), 0.09)
                        } else {
                            Shape::rounded_block(size, 0.008)
                        };
                        parts.push(place(one.turned(wobble).moved(at)).slot(slot));
                    }
                }
            }
        }
        work.model.add_extra("load", share, false, Shape::join(parts));
    }

    /// Sacks of sand lying across one another.
    pub(crate) fn sand_bags(&self, work: &mut Workshop, share: f32) {
        let mut random = Seed(0x5a_4d).random();
        let floor = self.floor_top() + 0.02;
        let mut parts = Vec::new();
        let (nx, ny) = ((self.length() * 0.85 / 0.62) as usize, (self.half * 1.8 / 0.42) as usize);
        for layer in 0..3_usize {
            for i in layer..nx.saturating_sub(layer) {
                for k in 0..ny {
                    let bag = Shape::ellipsoid(vec3(0.34, 0.24, 0.11), 10);
                    let turn = Quat::from_rotation_z(random.range(-0.15, 0.15) as f32);
                    let at = vec3(
                        -self.to + 0.5 + 0.62 * i as f32 + random.range(-0.03, 0.03) as f32,
                        (k as f32 - (ny as f32 - 1.0) / 2.0) * 0.42,
                        floor + 0.1 + 0.165 * layer as f32,
                    );
                    parts.push(bag.turned(turn).moved(at));
                }
            }
        }
        work.model.add_extra("load", share, false, Shape::join(parts).slot(work.slots.white));
    }

    /// Drums of cable.
    pub(crate) fn drums(&self, work: &mut Workshop, share: f32, radius_m: f32) {
        let slots = work.slots;
        let floor = self.floor_top() + 0.01;
        let count = ((self.length() - 0.4) / (radius_m * 2.2)) as usize;
        let mut parts = Vec::new();
        for i in 0..count.max(1) {
            let at = vec3(-self.to + 0.3 + radius_m * (1.0 + 2.2 * i as f32), 0.0, floor + radius_m);
            for side in [-0.55, 0.48] {
                parts.push(Shape::cylinder(radius_m, 0.06, 28).upright().moved(at + Vec3::Y * side).slot(slots.cargo));
            }
            let coil: Vec<_> = (0..=24)
                .map(|k| {
                    let swell =
                        if k == 0 || k == 24 { 0.0 } else { radius_m * (0.72 + 0.015 * (TAU * k as f32 / 4.0).sin()) };
                    vec2(swell, 0.96 * k as f32 / 24.0)
                })
                .collect();
            parts.push(Shape::lathe(&coil, 20).upright().moved(at - Vec3::Y * 0.48).slot(slots.rubber));
        }
        work.model.add_extra("load", share, false, Shape::join(parts));
    }
}
