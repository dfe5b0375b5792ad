//! Snow on what faces up: white as it fell, grey and uneven where wheels and feet have been; where it ends it crumbles,
//! thins out to slush and wets what it has left bare.

use glam::{Vec2, Vec3, vec2};

use super::weather::{TOO_WIDE_M, WATER_F0, soak};
use crate::bsdf::{Coat, Parameters};
use crate::lookups::Lookups;
use crate::math::{length, sqrt, step, unit_or, unit2};
use crate::surface::Surface;

/// Reflectance of snow a day old (Wiscombe and Warren 1980), and of slush full of grit.
const FRESH: Vec3 = Vec3::new(0.85, 0.87, 0.9);
const SLUSH: Vec3 = Vec3::new(0.36, 0.35, 0.33);
/// GGX α, and Oren and Nayar's roughness, of its grains.
const ALPHA: f32 = 0.6;
const DIFFUSE_ROUGHNESS: f32 = 0.3;
/// Share of the light through a leaf that snow on it keeps.
const OPAQUE: f32 = 0.8;
/// Cosines of slopes between which it begins to hold: 65° and 45°.
const HOLDS: [f32; 2] = [0.42, 0.7];

/// Periods of the two fields that say by halves where it is thick, metres: patches of 80 cm and finer, crumbs of 11 cm down
/// to 1 cm.
const PATCHES_M: f32 = 13.0;
const CRUMBS_M: f32 = 1.7;
/// Samples of these widths begin to miss crumbs, and see none, metres.
const CRUMBS_WIDE_M: [f32; 2] = [0.03, 0.25];
/// Ranges of those fields in which it ends, is thin, and has wetted what is bare.
const ENDS: f32 = 0.02;
const THIN: f32 = 0.12;
const WET: f32 = 0.1;
/// Light goes through where it is thin: its least cover.
const THIN_COVER: f32 = 0.8;
/// How high its edge is, how much patches rise beyond it, and crumbs of what is pressed, metres.
const EDGE_M: f32 = 0.015;
const RISE_M: f32 = 0.03;
const PRESSED_M: f32 = 0.03;
/// Its steepest slope.
const STEEPEST: f32 = 1.2;
/// Where what is left grows faster than this, a track ends, per metre; and what is drawn out there, metres.
const TRACK_PER_M: f32 = 0.4;
const STREAK_M: [f32; 4] = [-0.18, -0.06, 0.06, 0.18];
/// GGX α of the water that it leaves, and its share where all is wet.
const MELT_ALPHA: f32 = 0.15;
const MELT: f32 = 0.7;

/// Whether it may lie on a slope.
#[inline]
pub fn holds(outward_z: f32) -> bool {
    outward_z > HOLDS[0]
}

/// Lays snow on a point; returns its normal.
#[inline(always)]
pub(super) fn lie(lookups: &Lookups, surface: &Surface, width_m: f32, normal: Vec3, p: &mut Parameters) -> Vec3 {
    let exposure = surface.exposure;
    let holds = step(HOLDS[0], HOLDS[1], surface.outward_z());
    if holds <= 0.0 {
        return normal;
    }
    let used = 1.0 - exposure.left;
    // What is pressed is spread, and hides the ground until little is left.
    let share = (exposure.snow * holds * exposure.left * (1.0 + 2.0 * used * exposure.left)).min(1.0);
    let at = if exposure.moves { surface.point_mesh } else { surface.point }.truncate();
    let thick = Thickness::new(lookups, share, exposure.left_grows, width_m);
    let crumb = thick.crumb(at);
    let depth = thick.depth(at, crumb);
    let far = step(0.5, TOO_WIDE_M, width_m);
    let thin = 1.0 - step(ENDS - thick.ends, thick.thin, depth);
    let covered = {
        let near = thick.lies(depth) * (1.0 - (1.0 - THIN_COVER) * thin);
        near + (share - near) * far
    };
    let wet = step(-WET - thick.ends, 0.0, depth) * (1.0 - far);
    melt(surface, wet.max(used * exposure.snow), p);
    if covered <= 0.0 {
        return normal;
    }
    // Grit is where it was pressed, and in hollows between crumbs.
    let uneven = 1.8 * step(0.1, 0.9, 0.5 * lookups.noise(vec2(at.y, at.x) / 5.0) + 0.5 * crumb);
    let grit = (sqrt(used) * uneven + thin * (3.0 * used).min(1.0)).min(1.0);
    let keep = 1.0 - covered;
    p.base_color = p.base_color.lerp(FRESH.lerp(SLUSH, grit), covered);
    p.alpha += (ALPHA - p.alpha) * covered;
    p.diffuse_roughness += (DIFFUSE_ROUGHNESS - p.diffuse_roughness) * covered;
    p.translucency *= 1.0 - OPAQUE * covered;
    p.sheen *= keep;
    p.metalness *= keep;
    p.transmission *= keep;
    p.coat.share *= keep;
    let slope = if thick.crumbs > 0.0 { thick.slope(at, depth, used) } else { Vec2::ZERO };
    let side = if surface.is_front { 1.0 } else { -1.0 };
    let lying = unit_or(surface.shading - side * slope.extend(0.0), surface.shading);
    unit_or(normal.lerp(lying, covered), normal)
}

/// Wets the ground beside it.
fn melt(surface: &Surface, wet: f32, p: &mut Parameters) {
    let film = MELT * soak(wet, p);
    if film > p.coat.share {
        p.coat = Coat { normal: surface.shading, share: film, alpha: MELT_ALPHA, f0: WATER_F0 };
    }
}

/// How thick it lies on a plane, as a sample sees it that covers so much.
struct Thickness<'a> {
    lookups: &'a Lookups,
    /// What the fields are below where it lies.
    limit: f32,
    /// Share of the crumbs that are seen.
    crumbs: f32,
    /// Unit, along the track of wheels at whose edge it is; `None` elsewhere.
    along: Option<Vec2>,
    /// Half the range in which it ends: those that are not seen blur it.
    ends: f32,
    /// Up to this depth it is thin.
    thin: f32,
}

impl<'a> Thickness<'a> {
    fn new(lookups: &'a Lookups, share: f32, left_grows: Vec2, width_m: f32) -> Self {
        let crumbs = 1.0 - step(CRUMBS_WIDE_M[0], CRUMBS_WIDE_M[1], width_m);
        let ends = ENDS + (1.0 - crumbs) * 0.25;
        // All of it lies at 1, none at 0.
        let limit = (1.0 + 2.0 * ENDS) * below(share) - ENDS;
        let along = (length(left_grows) > TRACK_PER_M).then(|| unit2(left_grows.perp()));
        Self { lookups, limit, crumbs, along, ends, thin: ends + THIN * (8.0 * (1.0 - share)).min(1.0) }
    }

    /// Above 0 where it lies.
    fn depth(&self, at: Vec2, crumb: f32) -> f32 {
        self.limit - 0.5 * self.lookups.noise(at / PATCHES_M) - 0.5 * crumb
    }

    /// Share of a sample that it lies on: as many crumbs as are above the depth, being spread evenly.
    fn lies(&self, depth: f32) -> f32 {
        (0.5 + 0.5 * depth / self.ends).clamp(0.0, 1.0)
    }

    /// How steep its surface is against what it lies on, along x and y, where it is so thick.
    fn slope(&self, at: Vec2, depth: f32, used: f32) -> Vec2 {
        const STEP_M: f32 = 0.012;
        let height_m = |depth: f32| EDGE_M * step(0.0, self.thin, depth) + (RISE_M + PRESSED_M * used) * depth;
        let here = height_m(depth);
        let rise_m = |off: Vec2| {
            let there = at + off * STEP_M;
            height_m(self.depth(there, self.crumb(there))) - here
        };
        let slope = vec2(rise_m(Vec2::X), rise_m(Vec2::Y)) * (self.crumbs / STEP_M);
        slope * (STEEPEST / length(slope)).min(1.0)
    }

    /// The field of crumbs, as far as they are seen; where wheels roll along, it is drawn out.
    fn crumb(&self, at: Vec2) -> f32 {
        if self.crumbs <= 0.0 {
            return 0.5;
        }
        /// Of a turn, so that no grid is seen.
        const SIXTH: Vec2 = vec2(0.5, 0.866_025_4);
        let crumb = |at: Vec2| 0.5 + self.crumbs * (self.lookups.noise(SIXTH.rotate(at) / CRUMBS_M) - 0.5);
        let Some(along) = self.along else { return crumb(at) };
        let mean = STREAK_M.map(|off_m| crumb(at + along * off_m)).iter().sum::<f32>() / STREAK_M.len() as f32;
        // A mean differs less than what it is of.
        (0.5 + 1.6 * (mean - 0.5)).clamp(0.0, 1.0)
    }
}

/// What the mean of both fields is below on this share of a plane, both being spread evenly.
fn below(share: f32) -> f32 {
    let near = |share: f32| sqrt(0.5 * share);
    if share < 0.5 { near(share) } else { 1.0 - near(1.0 - share) }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::surface::Exposure;
    use crate::testing::LOOKUPS;

    fn asphalt() -> Parameters {
        Parameters {
            base_color: Vec3::splat(0.1),
            alpha: 0.7,
            diffuse_roughness: 0.4,
            metalness: 0.0,
            f0: 0.04,
            coat: Coat { normal: Vec3::Z, share: 0.5, alpha: 0.003, f0: 0.02 },
            sheen: Vec3::ZERO,
            subsurface: 0.0,
            translucency: 0.0,
            transmission: 0.0,
            tint: Vec3::ONE,
        }
    }

    /// Mean reflectance of many places of a plane.
    fn reflectance(normal: Vec3, exposure: Exposure) -> f32 {
        let n = 4000;
        let place = |i: usize| {
            let point = Vec3::new(i as f32 * 1.37, i as f32 * 0.61, 0.0);
            let surface = Surface { exposure, ..Surface::plain(point, normal) };
            let mut p = asphalt();
            let shading = lie(&LOOKUPS, &surface, 0.01, normal, &mut p);
            assert!(shading.is_normalized() && shading.dot(normal) > 0.5);
            p.base_color.y
        };
        (0..n).map(place).sum::<f32>() / n as f32
    }

    #[test]
    fn as_much_of_the_ground_is_white_as_snow_covers_and_none_of_a_wall() {
        let open = |snow: f32, left: f32| Exposure { snow, left, ..Exposure::BARE };
        let is = |found: f32, expected: f32| (found - expected).abs() < 1e-3;
        assert!(is(reflectance(Vec3::Z, open(0.0, 1.0)), 0.1));
        assert!(is(reflectance(Vec3::Z, open(1.0, 1.0)), FRESH.y));
        for snow in [0.25, 0.5, 0.75] {
            let share = (reflectance(Vec3::Z, open(snow, 1.0)) - 0.1) / (FRESH.y - 0.1);
            assert!((share - snow).abs() < 0.08, "{share} of {snow}");
        }
        assert!(reflectance(Vec3::Z, open(1.0, 0.5)) < 0.5);
        assert!(is(reflectance(Vec3::Y, open(1.0, 1.0)), 0.1));
        assert!(is(reflectance(Vec3::new(0.0, 0.5, 0.75f32.sqrt()), open(1.0, 1.0)), FRESH.y));
    }

    #[test]
    fn snow_on_what_drives_moves_on_with_it() {
        let colors = |moved_m: f32, moves: bool| -> Vec<f32> {
            let exposure = Exposure { snow: 0.5, moves, ..Exposure::BARE };
            let color = |i: u16| {
                let on_roof = Vec3::new(f32::from(i) * 0.13, 0.2, 1.5);
                let plain = Surface::plain(on_roof, Vec3::Z);
                let surface = Surface { point: on_roof + Vec3::X * moved_m, exposure, ..plain };
                let mut p = asphalt();
                lie(&LOOKUPS, &surface, 0.01, Vec3::Z, &mut p);
                p.base_color.y
            };
            (0..20).map(color).collect()
        };
        assert_eq!(colors(0.0, true), colors(4.0, true));
        assert_ne!(colors(0.0, false), colors(4.0, false));
    }

    #[test]
    fn borders_crumble_at_several_sizes_and_wide_samples_see_as_much_snow() {
        let n = 40_000;
        let covers = |thick: &Thickness, along_m: f32| {
            let at = vec2(along_m, 0.37 * along_m);
            thick.lies(thick.depth(at, thick.crumb(at)))
        };
        for share in [0.2, 0.6, 0.9] {
            let [near, far] = [0.005, 0.3].map(|width_m| Thickness::new(&LOOKUPS, share, Vec2::ZERO, width_m));
            let covered = |thick: &Thickness| (0..n).map(|i| covers(thick, i as f32 * 0.21)).sum::<f32>() / n as f32;
            assert!((covered(&near) - share).abs() < 0.03, "{} of {share}", covered(&near));
            assert!((covered(&far) - share).abs() < 0.03, "{} of {share} from afar", covered(&far));
        }
        // Metres on which it lies or does not without a break.
        let thick = Thickness::new(&LOOKUPS, 0.6, Vec2::ZERO, 0.005);
        let lies: Vec<bool> = (0..n).map(|i| covers(&thick, i as f32 * 0.004) > 0.5).collect();
        let runs: Vec<f32> = lies.chunk_by(|a, b| a == b).map(|run| run.len() as f32 * 0.0043).collect();
        let share = |is: &dyn Fn(f32) -> bool| runs.iter().filter(|&&run| is(run)).count() as f32 / runs.len() as f32;
        let [fine, broad] = [share(&|run| run < 0.05), share(&|run| run > 0.3)];
        assert!(fine > 0.2 && broad > 0.1, "{fine} below 5 cm, {broad} above 30 cm");
    }
}
