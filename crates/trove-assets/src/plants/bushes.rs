//! Bushes, hedges and ground cover: stems and a dark core inside, sprigs over a rounded or clipped surface.

use glam::{Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material, Seed};

use super::growth::{Foliage, limb};
use super::leaves::{Sprig, bark, material};
use super::trees::{SHADES, direction};
use crate::shape::{Model, Shape};

/// A kind of bush.
struct Habit {
    id: &'static str,
    /// Half axes; the foot is in the middle of the underside.
    half_m: Vec3,
    /// 2 is round, more is boxy.
    power: f32,
    /// Clumps on it, 0 for a clipped surface.
    lumps: f32,
    sprig: Sprig,
    green: Vec3,
    card_m: f32,
    cards: usize,
    /// Sprigs start from the ground instead of near the surface.
    from_ground: bool,
}

/// Share of the sprigs that hang below the widest place, down to the ground.
const SKIRT: f64 = 0.42;

pub(super) fn assets() -> Vec<Asset> {
    [
        Habit {
            id: "bush/round",
            half_m: vec3(0.95, 0.9, 0.75),
            power: 2.2,
            lumps: 0.22,
            sprig: Sprig::Broad,
            green: vec3(0.09, 0.147, 0.045),
            card_m: 0.34,
            cards: 1500,
            from_ground: false,
        },
        Habit {
            id: "bush/tall",
            half_m: vec3(1.2, 1.1, 1.35),
            power: 2.4,
            lumps: 0.28,
            sprig: Sprig::Broad,
            green: vec3(0.105, 0.157, 0.05),
            card_m: 0.46,
            cards: 1700,
            from_ground: false,
        },
        Habit {
            id: "bush/tropical",
            half_m: vec3(0.85, 0.85, 0.55),
            power: 2.0,
            lumps: 0.15,
            sprig: Sprig::Blades,
            green: vec3(0.093, 0.165, 0.045),
            card_m: 0.8,
            cards: 260,
            from_ground: true,
        },
        Habit {
            id: "bush/ground-cover",
            half_m: vec3(0.9, 0.9, 0.14),
            power: 3.0,
            lumps: 0.3,
            sprig: Sprig::Broad,
            green: vec3(0.105, 0.175, 0.053),
            card_m: 0.22,
            cards: 1500,
            from_ground: false,
        },
    ]
    .iter()
    .map(bush)
    .chain([hedge()])
    .collect()
}

/// What is seen between leaves: twigs in the dark, which also let no light through the foot.
fn core(id: &str) -> Material {
    Material::plain(&format!("{id}-core"), vec3(0.032, 0.042, 0.018), 0.9)
}

/// A clipped piece whose ends are flush, so that several make a hedge.
fn hedge() -> Asset {
    let id = "bush/hedge";
    let half = vec3(1.0, 0.35, 0.5);
    let seed = Seed(14).child(id);
    let mut random = seed.random();
    let mut model = Model::default();
    let dark = model.slot(core(id), &[]);
    model.add(dark, Shape::block(vec3(2.0, 0.52, 0.88)).moved(Vec3::Z * 0.44));
    let green = vec3(0.083, 0.14, 0.042);
    let leaves = model.slot(material(&format!("{id}-leaves"), Sprig::Feathered, green, seed.0), &SHADES);
    let mut foliage = Foliage::default();
    let faces = [(Vec3::Z, 1.4), (Vec3::Y, 2.0), (-Vec3::Y, 2.0), (Vec3::X, 0.7), (-Vec3::X, 0.7)];
    let area: f64 = faces.iter().map(|f| f.1).sum();
    for _ in 0..1300 {
        let mut at = random.range(0.0, area);
        let outward = faces.iter().find(|f| {
            at -= f.1;
            at < 0.0
        });
        let outward = outward.map_or(Vec3::Z, |f| f.0);
        let spread = Vec3::from_array(std::array::from_fn(|_| random.range(-1.0, 1.0) as f32));
        // On the face, a little uneven.
        let p = (spread * (1.0 - outward.abs()) + outward * random.range(0.8, 0.97) as f32) * half + Vec3::Z * half.z;
        let along = outward * 0.55 + direction(&mut random) + Vec3::Z * 0.25;
        let size = 0.2 * random.range(0.75, 1.2) as f32;
        let foot = (p - along.normalize_or(Vec3::Z) * size * 0.6).max(vec3(-1.05, -0.4, 0.0));
        foliage.card(foot, along, outward + direction(&mut random) * 0.7, size, (outward + Vec3::Z * 0.3).normalize());
    }
    model.add(leaves, foliage.into_shape());
    model.asset(id, Kind::Bush, Class::Bush)
}

fn bush(habit: &Habit) -> Asset {
    let seed = Seed(14).child(habit.id);
    let mut random = seed.random();
    let mut model = Model::default();
    let wood = model.slot(bark(&format!("{}-bark", habit.id), vec3(0.1, 0.08, 0.055), 13), &[]);
    let leaves = model.slot(material(&format!("{}-leaves", habit.id), habit.sprig, habit.green, seed.0), &SHADES);
    if !habit.from_ground {
        let dark = model.slot(core(habit.id), &[]);
        let profile =
            [vec2(0.0, 0.0), vec2(0.72, 0.0), vec2(0.78, 0.6), vec2(0.6, 1.1), vec2(0.3, 1.4), vec2(0.0, 1.45)];
        model.add(dark, Shape::lathe(&profile, 10).scaled(habit.half_m * vec3(0.8, 0.8, 0.95)));
    }
    let lumps: Vec<Vec3> = (0..9).map(|_| direction(&mut random)).collect();
    let mut foliage = Foliage::default();
    for _ in 0..habit.cards {
        let out = direction(&mut random);
        // Below the widest place it hangs to the ground like a skirt.
        let skirt = random.chance(SKIRT);
        let out = vec3(out.x, out.y, if skirt { 0.0 } else { out.z.abs().powf(0.8) });
        // A superellipsoid with clumps; most sprigs near its surface, some inside.
        let norm = out.abs().to_array().iter().map(|x| x.powf(habit.power)).sum::<f32>().powf(1.0 / habit.power);
        let clump = lumps.iter().map(|l| l.dot(out.normalize_or(Vec3::Z)).max(0.0).powi(6)).fold(0.0, f32::max);
        let depth = 1.0 - habit.lumps * (1.0 - clump) - 0.35 * (random.unit() as f32).powi(3);
        let height = if skirt { random.unit() as f32 } else { 1.0 };
        let p = out / norm.max(1e-3) * depth * (0.82 + 0.18 * height) * habit.half_m;
        let z = habit.half_m.z * height + p.z;
        let at = vec3(p.x, p.y, z.max(0.03));
        let share = p / habit.half_m;
        let outward = share.abs().powf(habit.power - 1.0) * share.signum();
        let outward = (outward / habit.half_m + Vec3::Z * 0.25).normalize_or(Vec3::Z);
        let size = habit.card_m * random.range(0.75, 1.2) as f32;
        if habit.from_ground {
            // The outermost leaves hang to the ground.
            let foot = vec3(p.x, p.y, 0.0) * 0.55 + Vec3::Z * 0.05 * random.unit() as f32;
            let rise = if skirt { -0.35 } else { 0.35 };
            let along = vec3(out.x, out.y, rise + 1.1 * random.unit() as f32) + direction(&mut random) * 0.3;
            let lift = Vec3::Z * habit.half_m.z * if skirt { 0.25 } else { 0.9 } * random.unit() as f32;
            foliage.card(foot + lift, along, Vec3::Z + out * 0.5, size, (along + Vec3::Z * 0.6).normalize_or(Vec3::Z));
        } else {
            let along = outward * 0.8 + direction(&mut random) + Vec3::Z * 0.3;
            let foot = at - along.normalize_or(Vec3::Z) * size * 0.55;
            let face = outward + direction(&mut random) * 0.8;
            foliage.card(foot.max(vec3(f32::MIN, f32::MIN, 0.0)), along, face, size, outward);
        }
    }
    let stems = 7;
    for i in 0..stems {
        let turn = i as f32 * 2.399_963;
        let reach = vec3(turn.cos(), turn.sin(), 0.0) * habit.half_m * (0.25 + 0.45 * i as f32 / stems as f32);
        let (low, high) = (reach * 0.25, reach + Vec3::Z * habit.half_m.z * 1.3);
        let middle = low.lerp(high, 0.5) + reach * 0.15;
        let r = 0.012 + 0.01 * habit.half_m.z;
        model.add(wood, limb(&[(low, r), (middle, r * 0.8), (high, r * 0.3)]));
    }
    model.add(leaves, foliage.into_shape());
    model.asset(habit.id, Kind::Bush, Class::Bush)
}
