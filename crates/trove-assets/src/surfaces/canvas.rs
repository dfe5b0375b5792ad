//! A surface under the brush: colour, relief and gloss for every texel, turned into a material's maps at the end.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3, uvec2, vec2};
use trove_model::{ColorSpace, Material, Seed, Texture};

/// What a surface is at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Texel {
    /// Reflectance, linear.
    pub(crate) albedo: Vec3,
    /// Height above the surface's plane.
    pub(crate) height_m: f32,
    /// Perceptual roughness.
    pub(crate) roughness: f32,
    /// 0 dielectric, 1 metal.
    pub(crate) metalness: f32,
    /// Coverage.
    pub(crate) alpha: f32,
}

impl Texel {
    /// Opaque, at height 0.
    pub(crate) fn new(albedo: Vec3, roughness: f32) -> Self {
        Self { albedo, height_m: 0.0, roughness, metalness: 0.0, alpha: 1.0 }
    }

    /// Goes towards another colour.
    pub(crate) fn tint(&mut self, albedo: Vec3, share: f32) {
        self.albedo = self.albedo.lerp(albedo, share.clamp(0.0, 1.0));
    }
}

/// Straight lines strewn over a canvas: scratches, creases, scuffs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strokes {
    /// How many on the canvas.
    pub(crate) count: u32,
    /// Shortest and longest.
    pub(crate) length_m: [f32; 2],
    /// Narrower than a texel they are fainter.
    pub(crate) width_m: f32,
    /// Directions, from u anticlockwise.
    pub(crate) turn_rad: [f32; 2],
    pub(crate) seed: u32,
}

/// Texels that repeat in both directions; points are metres from the bottom left corner.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    pub(crate) size_m: Vec2,
    size_px: UVec2,
    texels: Vec<Texel>,
}

impl Canvas {
    /// Every texel computed from its middle.
    pub(crate) fn new(size_px: [u32; 2], size_m: [f32; 2], texel: impl Fn(Vec2) -> Texel) -> Self {
        let (size_px, size_m) = (UVec2::from_array(size_px), Vec2::from_array(size_m));
        let texel_m = size_m / size_px.as_vec2();
        let middle = |x: u32, row: u32| (vec2(x as f32, (size_px.y - 1 - row) as f32) + 0.5) * texel_m;
        let texels = (0..size_px.y).flat_map(|row| (0..size_px.x).map(move |x| (x, row)));
        Self { size_m, size_px, texels: texels.map(|(x, row)| texel(middle(x, row))).collect() }
    }

    /// Paints every texel between two corners, which may lie outside: the brush gets metres from the low corner.
    pub(crate) fn rect(&mut self, low: Vec2, high: Vec2, mut brush: impl FnMut(Vec2, &mut Texel)) {
        let texel_m = self.size_m / self.size_px.as_vec2();
        let start = (low / texel_m - 0.5).ceil().as_ivec2();
        let end = (high / texel_m - 0.5).ceil().as_ivec2();
        let size = self.size_px.as_ivec2();
        for y in start.y..end.y {
            let row = size.y - 1 - y.rem_euclid(size.y);
            for x in start.x..end.x {
                let p = (vec2(x as f32, y as f32) + 0.5) * texel_m - low;
                brush(p, &mut self.texels[(row * size.x + x.rem_euclid(size.x)) as usize]);
            }
        }
    }

    /// The texel that a point within the canvas lies in.
    pub(crate) fn at(&self, p_m: Vec2) -> Texel {
        let p = (p_m / self.size_m * self.size_px.as_vec2()).as_uvec2().min(self.size_px - 1);
        self.texels[((self.size_px.y - 1 - p.y) * self.size_px.x + p.x) as usize]
    }

    /// Paints every texel; the brush gets metres.
    pub(crate) fn all(&mut self, brush: impl FnMut(Vec2, &mut Texel)) {
        self.rect(Vec2::ZERO, self.size_m, brush);
    }

    /// Draws strokes; the brush gets how much of the texel one covers, and a number in 0..1 that was drawn for it.
    pub(crate) fn strokes(&mut self, strokes: Strokes, mut brush: impl FnMut(&mut Texel, f32, f32)) {
        let texel_m = (self.size_m / self.size_px.as_vec2()).max_element();
        let half_m = strokes.width_m.max(texel_m);
        let strength = (strokes.width_m / texel_m).min(1.0);
        let mut random = Seed(u64::from(strokes.seed)).child("strokes").random();
        let mut draw = |[from, to]: [f32; 2]| random.range(f64::from(from), f64::from(to)) as f32;
        for _ in 0..strokes.count {
            let at = vec2(draw([0.0, 1.0]), draw([0.0, 1.0])) * self.size_m;
            let along = Vec2::from_angle(draw(strokes.turn_rad));
            let length = draw(strokes.length_m);
            let drawn = draw([0.0, 1.0]);
            let reach = along.abs() * length / 2.0 + half_m;
            self.rect(at - reach, at + reach, |p, texel| {
                let q = p - reach;
                let t = q.dot(along) / length * 2.0;
                let share = (1.0 - q.perp_dot(along).abs() / half_m) * (1.0 - t * t);
                if share > 0.0 && t.abs() < 1.0 {
                    brush(texel, share * strength, drawn);
                }
            });
        }
    }

    /// The colour map alone (things with faces and leaves).
    pub(crate) fn color(&self, name: &str) -> Arc<Texture> {
        let srgb = SrgbTable::new();
        let texel = |t: &Texel| {
            let [r, g, b] = t.albedo.to_array().map(|c| srgb.encode(c));
            [r, g, b, byte(t.alpha)]
        };
        texture(name, "color", self.size_px, self.texels.iter().map(texel).collect(), ColorSpace::Srgb)
    }

    /// The material for uvs in metres; gloss and normals are kept at a `coarser`-th of the resolution, heights at a
    /// quarter of theirs.
    pub(crate) fn material(&self, name: &str, coarser: u32) -> Material {
        let orm_px = self.size_px / coarser;
        let gloss: Vec<Vec2> = self.texels.iter().map(|t| vec2(t.roughness, t.metalness)).collect();
        let metalness = gloss.iter().map(|g| g.y).fold(0.0, f32::max);
        // Occlusion stays 1: rays find it.
        let orm = boxed(&gloss, self.size_px, coarser, |g| [255, byte(g.x), byte(g.y), 255]);
        let normals = boxed(&self.normals(), self.size_px, coarser, |n: Vec3| {
            let n = n.normalize_or(Vec3::Z) * 0.5 + 0.5;
            [byte(n.x), byte(n.y), byte(n.z), 255]
        });
        let heights: Vec<f32> = self.texels.iter().map(|t| t.height_m).collect();
        let (low_m, high_m) = heights.iter().fold((f32::MAX, f32::MIN), |(low, high), &h| (low.min(h), high.max(h)));
        let height_m = high_m - low_m;
        let height_map = (height_m > 0.0).then(|| {
            let coarser = (coarser * 4).min(self.size_px.min_element());
            let heights = boxed(&heights, self.size_px, coarser, |h| {
                let h = byte((h - low_m) / height_m);
                [h, h, h, 255]
            });
            texture(name, "height", self.size_px / coarser, heights, ColorSpace::Linear)
        });
        Material {
            name: name.into(),
            base_color: Vec3::ONE,
            base_color_map: Some(self.color(name)),
            roughness: 1.0,
            metalness: if metalness > 0.0 { 1.0 } else { 0.0 },
            height_map,
            height_m,
            orm_map: Some(texture(name, "orm", orm_px, orm, ColorSpace::Linear)),
            normal_map: Some(texture(name, "normal", orm_px, normals, ColorSpace::Linear)),
            uv_scale: 1.0 / self.size_m,
            ..Material::default()
        }
    }

    /// Normals of the relief, by central differences around the edges too.
    fn normals(&self) -> Vec<Vec3> {
        let (w, h) = (self.size_px.x as usize, self.size_px.y as usize);
        let reach_m = 2.0 * self.size_m / self.size_px.as_vec2();
        let height = |x: usize, y: usize| self.texels[y * w + x].height_m;
        let mut normals = Vec::with_capacity(w * h);
        for y in 0..h {
            let (above, below) = ((y + h - 1) % h, (y + 1) % h);
            for x in 0..w {
                let across = height((x + 1) % w, y) - height((x + w - 1) % w, y);
                let up = height(x, above) - height(x, below);
                normals.push(Vec3::new(-across / reach_m.x, -up / reach_m.y, 1.0).normalize());
            }
        }
        normals
    }
}

fn byte(x: f32) -> u8 {
    (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

fn texture(name: &str, map: &str, size: UVec2, rgba: Vec<[u8; 4]>, color_space: ColorSpace) -> Arc<Texture> {
    Arc::new(Texture { name: format!("{name}.{map}"), width: size.x, height: size.y, rgba, color_space })
}

/// Means of squares of `side` texels.
fn boxed<T>(texels: &[T], size: UVec2, side: u32, encode: impl Fn(T) -> [u8; 4]) -> Vec<[u8; 4]>
where
    T: Copy + Default + std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>,
{
    let coarse = size / side;
    let at = |p: UVec2| texels[(p.y * size.x + p.x) as usize];
    let mean = |corner: UVec2| {
        let square = (0..side).flat_map(|y| (0..side).map(move |x| uvec2(x, y)));
        square.fold(T::default(), |sum, p| sum + at(corner + p)) * (1.0 / (side * side) as f32)
    };
    (0..coarse.y).flat_map(|y| (0..coarse.x).map(move |x| uvec2(x, y))).map(|p| encode(mean(p * side))).collect()
}

/// sRGB's encoding by table; fine enough for 8 bits from black to white.
struct SrgbTable(Vec<u8>);

impl SrgbTable {
    const STEPS: usize = 8192;

    fn new() -> Self {
        let encode = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        Self((0..=Self::STEPS).map(|i| byte(encode(i as f32 / Self::STEPS as f32))).collect())
    }

    fn encode(&self, linear: f32) -> u8 {
        self.0[(linear.clamp(0.0, 1.0) * Self::STEPS as f32 + 0.5) as usize]
    }
}
