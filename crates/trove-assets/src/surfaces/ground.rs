//! What is not paved.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Noise, step};

/// Grass seen from above: tufts, thatch and moss between them, patches of clover, and bare earth by `bare`.
pub(super) fn grass(fresh: Vec3, dry: Vec3, bare: f32, seed: u32, detail: u32) -> Canvas {
    let size = [8.0, 8.0];
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (clump, tuft, patch, earth) = (noise(0.5, 1).field(3), noise(0.09, 2), noise(1.6, 3).field(4), noise(0.03, 4));
    let (clover, sward) = (noise(1.0, 5).field(4), noise(4.0, 6).field(3));
    let thatch = fresh.lerp(dry, 0.6) * vec3(0.62, 0.55, 0.62);
    let clover_green = fresh * vec3(0.62, 0.86, 0.95);
    let mut canvas = Canvas::new([1024 * detail, 1024 * detail], size, |p| {
        let (c, e, broad) = (clump.at(p), earth.at(p), sward.at(p));
        let soil = vec3(0.13, 0.09, 0.058) * (1.0 + 0.3 * e);
        let dead = step(0.05, 0.75, patch.at(p) + 0.25 * c + 0.2 * broad);
        let green = fresh.lerp(dry, 0.4 * dead) * (0.8 + 0.3 * c + 0.15 * broad);
        let swarm = step(0.28, 0.42, clover.at(p) + 0.12 * tuft.at(p));
        let open = step(1.0 - bare, 1.25 - bare, 0.5 + 0.5 * patch.at(p + size_m * 0.31) + 0.2 * tuft.at(p));
        let ground = thatch.lerp(green * 0.6, 0.55).lerp(clover_green * 0.7, 0.8 * swarm);
        let mut texel = Texel::new(ground.lerp(soil, open), 0.9);
        texel.height_m = 0.006 * tuft.fbm(p, 2) - 0.012 * open;
        texel.alpha = (1.0 - open) * (1.0 - 0.35 * swarm);
        texel
    });
    // Tufts: short strokes, each of its own shade; they thin out over bare earth (kept in alpha until here).
    let mut random = trove_model::Seed(u64::from(seed)).child("blades").random();
    for _ in 0..52_000 {
        let at = vec2(random.unit() as f32, random.unit() as f32) * size_m;
        let along = Vec2::from_angle(random.range(0.0, std::f64::consts::TAU) as f32);
        let length = random.range(0.04, 0.1) as f32;
        let shade = random.range(0.6, 1.45) as f32;
        let hue = random.unit() as f32;
        let keep = random.unit() as f32;
        let reach = along.abs() * length / 2.0 + 0.006;
        let color = fresh.lerp(dry, hue * hue * hue) * shade * (1.0 + 0.25 * clump.at(at));
        canvas.rect(at - reach, at + reach, |p, texel| {
            let q = p - reach;
            let (t, off) = (q.dot(along) / length, q.perp_dot(along).abs());
            if texel.alpha > keep * 0.8 && t.abs() < 0.5 && off < 0.0065 * (0.65 - t) {
                texel.albedo = color * (0.8 + 0.5 * t);
                texel.height_m = 0.01 + 0.012 * t;
                texel.roughness = 0.75;
            }
        });
    }
    canvas.all(|_, texel| texel.alpha = 1.0);
    canvas
}

/// Bare earth with crumbs and small stones.
pub(super) fn soil(seed: u32, detail: u32) -> Canvas {
    let size = [3.0, 3.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (crumb, broad, pebble) = (noise(0.05, 1), noise(0.8, 2).field(4), noise(0.11, 3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (c, b) = (crumb.fbm(p, 4), broad.at(p));
        let stone = pebble.near(p);
        let is_stone = step(0.24, 0.17, stone.first) * step(0.72, 0.75, stone.id);
        let earth = vec3(0.135, 0.095, 0.064) * (1.0 + 0.35 * c + 0.3 * b);
        let mut texel = Texel::new(earth.lerp(vec3(0.21, 0.19, 0.165) * (0.7 + 0.5 * stone.id), is_stone), 0.93);
        texel.height_m = 0.012 * c + 0.02 * b + 0.012 * is_stone;
        texel
    })
}

/// Dry earth that feet have trodden flat: dust of a colour, and stones in it.
pub(super) fn trodden(dust: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [4.0, 4.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (grain, broad, pebble) = (noise(0.03, 1), noise(1.1, 2).field(4), noise(0.07, 3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (g, b) = (grain.fbm(p, 3), broad.at(p));
        let stone = pebble.near(p);
        // They lie in heaps, between which it is bare.
        let is_stone = step(0.22, 0.16, stone.first) * step(0.78 - 0.25 * b, 0.8 - 0.25 * b, stone.id);
        let earth = dust * (1.0 + 0.16 * g + 0.22 * b);
        let mut texel = Texel::new(earth.lerp(vec3(0.27, 0.25, 0.225) * (0.6 + 0.5 * stone.id), is_stone), 0.95);
        texel.height_m = 0.004 * g + 0.012 * b + 0.009 * is_stone;
        texel
    })
}

/// Wet earth that feet and wheels have kneaded, puddles in its hollows.
pub(super) fn mud(seed: u32, detail: u32) -> Canvas {
    let size = [3.0, 3.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (lumps, broad, fine) = (noise(0.16, 1), noise(0.7, 2).field(4), noise(0.02, 3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (l, b) = (lumps.fbm(p, 4), broad.at(p));
        let low = step(-0.12, -0.35, 0.6 * b + 0.5 * l);
        let mut texel = Texel::new(vec3(0.085, 0.062, 0.043) * (1.0 + 0.4 * l + 0.25 * fine.at(p)), 0.72 - 0.2 * b);
        texel.tint(vec3(0.05, 0.039, 0.03), low);
        texel.roughness += (0.08 - texel.roughness) * low;
        texel.height_m = (0.03 * l + 0.04 * b).max(-0.012);
        texel
    })
}

/// Sand with the wind's ripples and footprints' hollows.
pub(super) fn sand(seed: u32, detail: u32) -> Canvas {
    let size = [2.0, 2.0];
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt| Noise::stretched(size_m, feature, seed * 31 + salt);
    let (ripple, broad) = (noise(vec2(0.3, 0.09), 1), noise(Vec2::splat(0.5), 2).field(4));
    let grains = noise(Vec2::splat(0.006), 3);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let grain = grains.near(p);
        let r = ripple.fbm(p, 3);
        let tone = 1.0 + 0.3 * (grain.id - 0.5) + 0.12 * r + 0.12 * broad.at(p);
        let mut texel = Texel::new(vec3(0.36, 0.285, 0.19) * tone, 0.93);
        texel.height_m = 0.008 * r + 0.015 * broad.at(p) + 0.0006 * (grain.id - 0.5);
        texel
    })
}

/// Loose stones of about `stone_m`.
pub(super) fn gravel(color: Vec3, stone_m: f32, seed: u32, detail: u32) -> Canvas {
    let size = [2.0, 2.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (stones, fine, grain, broad) =
        (noise(stone_m, 1), noise(stone_m * 0.6, 2), noise(0.02, 3), noise(0.6, 4).field(3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (large, small) = (stones.near(p), fine.near(p));
        let on_top = large.first < 0.52;
        let (stone, depth) = if on_top { (large, 1.0) } else { (small, 0.6) };
        let dome = (1.0 - (stone.first * 1.5).powi(2)).max(0.0);
        let tone = depth * (0.55 + 0.8 * stone.id) * (0.45 + 0.55 * dome) * (1.0 + 0.15 * grain.at(p));
        let warm = vec3(1.0 + 0.12 * (stone.id - 0.5), 1.0, 1.0 - 0.15 * (stone.id - 0.5));
        let mut texel = Texel::new(color * warm * tone * (1.0 + 0.2 * broad.at(p)), 0.88);
        texel.height_m = stone_m * (0.3 * dome + if on_top { 0.25 } else { 0.0 });
        texel
    })
}

/// Still water with small ripples.
pub(super) fn water(detail: u32) -> Canvas {
    let size = [8.0, 8.0];
    let noise = |feature_m, seed| Noise::new(Vec2::from_array(size), feature_m, seed);
    let (swell, ripple) = (noise(1.6, 881), noise(0.4, 882));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = Texel::new(vec3(0.012, 0.022, 0.02), 0.06);
        texel.height_m = 0.018 * swell.fbm(p, 3) + 0.005 * ripple.fbm(p, 3);
        texel
    })
}
