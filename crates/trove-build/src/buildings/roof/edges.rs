//! What runs along the edges of a pitched roof: eaves with gutters, verges, ridge tiles. Each is a closed body of its
//! own, a little within the roof and the walls, so that it shares no plane with them.

use glam::{DVec2, DVec3};

use super::pitched::Pitched;
use crate::buildings::shell::{Shell, Slot};
use crate::buildings::volumes::Volume;

/// Eaves reach out this far, if nothing is in the way, and never drop lower than this under the walls' top, metres.
const EAVES_M: f64 = 0.4;
const EAVES_DROP_M: f64 = 0.3;
const EAVES_THICK_M: f64 = 0.16;
/// Verges reach out and in this far, and stand this much above the roof, metres.
const VERGE_M: f64 = 0.3;
const VERGE_IN_M: f64 = 0.12;
const VERGE_ABOVE_M: f64 = 0.05;
/// Eaves and verges stay this far from what is next to them, metres.
const SPARE_M: f64 = 0.08;
/// Width and height of a gutter, metres.
const GUTTER_M: [f64; 2] = [0.13, 0.1];
/// Half a ridge tile's width, and its height over the ridge, metres.
const RIDGE_M: [f64; 2] = [0.14, 0.06];

/// Puts eaves, verges and, with `fine`, gutters and ridge tiles on a shell.
pub(super) fn edges(shell: &mut Shell, roof: &Pitched, volume: &Volume<'_>, fine: bool) {
    let reach_m = EAVES_M.min(EAVES_DROP_M / roof.slope_at_eaves().max(0.1));
    let has_eaves: Vec<bool> = (0..roof.edges.len())
        .map(|i| roof.skeleton.sides[i].start == 0.0 && room_m(volume, roof, i) >= reach_m + GUTTER_M[0] + SPARE_M)
        .collect();
    let has_verge: Vec<bool> =
        (0..roof.edges.len()).map(|i| roof.is_gable(i) && room_m(volume, roof, i) >= VERGE_M + SPARE_M).collect();
    for side in 0..roof.edges.len() {
        if has_eaves[side] {
            eaves(shell, roof, side, reach_m, &has_eaves, fine);
        }
        if has_verge[side] {
            verge(shell, roof, side, reach_m, &has_eaves);
        }
    }
    if fine {
        ridges(shell, roof);
    }
}

fn room_m(volume: &Volume<'_>, roof: &Pitched, side: usize) -> f64 {
    volume.sides.get(roof.edges[side]).map_or(0.0, |s| s.room_m)
}

/// The sides of the same ring before and after one.
fn neighbours(roof: &Pitched, side: usize) -> [usize; 2] {
    let start = |i: usize| roof.skeleton.nodes[i].position;
    let end = |i: usize| roof.chains_end(i);
    let n = roof.edges.len();
    let before = (0..n).find(|&i| end(i) == start(side)).unwrap_or(side);
    let after = (0..n).find(|&i| start(i) == end(side)).unwrap_or(side);
    [before, after]
}

/// Boards along a side, in line with the slope, and a gutter before them.
fn eaves(shell: &mut Shell, roof: &Pitched, side: usize, reach_m: f64, has_eaves: &[bool], fine: bool) {
    let own = roof.skeleton.sides[side];
    let ends = [own.from, roof.chains_end(side)];
    let outward = -own.along.perp();
    let [before, after] = neighbours(roof, side);
    // Where the next side has eaves too they meet in a mitre.
    let stretch = |other: usize| -> DVec2 {
        let away = -roof.skeleton.sides[other].along.perp();
        let fits = has_eaves[other] && 1.0 + outward.dot(away) > 0.4;
        if fits { (outward + away) / (1.0 + outward.dot(away)) } else { outward }
    };
    let [first, last] = [before, after].map(stretch);
    let slope = roof.slope_at_eaves().min(EAVES_DROP_M / reach_m);
    let eaves = roof.level(0.0);
    let at = |end: usize, out_m: f64, z: f64| {
        let along = [first, last][end];
        // Blunt ends stay clear of the next side's wall.
        let inset = if along == outward { own.along * if end == 0 { 0.02 } else { -0.02 } } else { DVec2::ZERO };
        (ends[end] + along * out_m + inset).extend(z)
    };
    let section = |end: usize, points: [[f64; 2]; 4]| points.map(|[x, z]| at(end, x, z));
    // Between two inner corners nothing is left of a short side's boards but what is turned inside out.
    let least_m = |out_m: f64| (at(1, out_m, 0.0) - at(0, out_m, 0.0)).truncate().dot(own.along);
    if least_m(reach_m + GUTTER_M[0]).min(least_m(-0.06)) <= 0.0 {
        return;
    }
    let top = |x: f64| eaves - slope * x - 0.012;
    let board = [
        [-0.06, top(-0.06)],
        [reach_m, top(reach_m)],
        [reach_m, top(reach_m) - EAVES_THICK_M],
        [-0.06, top(-0.06) - EAVES_THICK_M],
    ];
    let slots = [Slot::PitchedRoof, Slot::Boards, Slot::Boards, Slot::Boards];
    shell.sweep(slots, &[section(0, board), section(1, board)]);
    if fine {
        let [width, height] = GUTTER_M;
        let (near, high) = (reach_m + 0.004, top(reach_m) - 0.02);
        let gutter = [[near, high], [near + width, high], [near + width * 0.8, high - height], [near, high - height]];
        shell.sweep([Slot::Metal; 4], &[section(0, gutter), section(1, gutter)]);
    }
}

/// A board along a gable's slopes.
fn verge(shell: &mut Shell, roof: &Pitched, side: usize, reach_m: f64, has_eaves: &[bool]) {
    let own = roof.skeleton.sides[side];
    let outward = -own.along.perp();
    let mut rake = roof.rake(side);
    if rake.len() < 3 {
        return;
    }
    // From the eaves that reach out, if they do.
    let [before, after] = neighbours(roof, side);
    let slope = roof.slope_at_eaves();
    let run_on = |end: &mut Vec<DVec2>, has: bool, at: usize, sign: f64| {
        if has && at < end.len() {
            end[at] += DVec2::new(sign * reach_m, -slope.min(EAVES_DROP_M / reach_m) * reach_m);
        }
    };
    let last = rake.len() - 1;
    run_on(&mut rake, has_eaves[after], 0, 1.0);
    run_on(&mut rake, has_eaves[before], last, -1.0);
    let rings: Vec<[DVec3; 4]> = rake
        .iter()
        .map(|p| {
            let foot = own.from + own.along * p.x;
            let at = |out_m: f64, z: f64| (foot + outward * out_m).extend(p.y + z);
            let (inside, outside) = (-VERGE_IN_M, VERGE_M);
            [
                at(inside, VERGE_ABOVE_M),
                at(inside, VERGE_ABOVE_M - EAVES_THICK_M),
                at(outside, VERGE_ABOVE_M - EAVES_THICK_M),
                at(outside, VERGE_ABOVE_M),
            ]
        })
        .collect();
    shell.sweep([Slot::Boards, Slot::Boards, Slot::Boards, Slot::PitchedRoof], &rings);
}

/// Tiles over the ridges and hips.
fn ridges(shell: &mut Shell, roof: &Pitched) {
    for [low, high] in roof.ridges() {
        let along = (high - low).normalize_or_zero();
        let across = DVec3::Z.cross(along).normalize_or_zero();
        if along.distance_squared(DVec3::ZERO) < 0.5 || across.length_squared() < 0.5 {
            continue;
        }
        let up = along.cross(across);
        let [half_m, high_m] = RIDGE_M;
        let ring = |p: DVec3| {
            [p + up * high_m, p + across * half_m - up * 0.07, p - up * 0.12, p - across * half_m - up * 0.07]
        };
        shell.sweep([Slot::PitchedRoof; 4], &[ring(low), ring(high)]);
    }
}

impl Pitched {
    fn chains_end(&self, side: usize) -> DVec2 {
        self.chain(side).last().copied().unwrap_or_default()
    }

    /// The upper border of a gable from its right end to its left: position along the side, and level.
    fn rake(&self, side: usize) -> Vec<DVec2> {
        let face = &self.skeleton.faces[side];
        let flat: Vec<DVec2> =
            face.iter().skip(1).chain(face.first()).map(|&n| self.skeleton.in_face(side, n)).collect();
        let breaks = self.breaks();
        let mut rake = Vec::new();
        for (i, &p) in flat.iter().enumerate() {
            rake.push(p);
            let Some(&q) = flat.get(i + 1) else { break };
            let mut between: Vec<f64> = breaks.iter().copied().filter(|&t| (t - p.y) * (t - q.y) < -1e-9).collect();
            between.sort_by(|a, b| (a - p.y).abs().total_cmp(&(b - p.y).abs()));
            rake.extend(between.iter().map(|&t| p + (q - p) * ((t - p.y) / (q.y - p.y))));
        }
        rake.into_iter().map(|p| DVec2::new(p.x, self.level(p.y))).collect()
    }

    /// Borders between two slopes that water runs away from, lower end first, without those too short to see.
    pub(super) fn ridges(&self) -> Vec<[DVec3; 2]> {
        let mut found = Vec::new();
        let at = |n: usize| {
            let node = self.skeleton.nodes[n];
            node.position.extend(self.level(node.time))
        };
        let slopes = || self.skeleton.faces.iter().enumerate().filter(|(i, f)| !self.is_gable(*i) && !f.is_empty());
        for (i, face) in slopes() {
            for k in 0..face.len() {
                let (a, b) = (face[k], face[(k + 1) % face.len()]);
                let borders = |f: &Vec<usize>| (0..f.len()).any(|m| f[m] == b && f[(m + 1) % f.len()] == a);
                let Some((j, _)) = slopes().find(|(j, f)| *j > i && borders(f)) else { continue };
                let [left, right] = [i, j].map(|s| self.skeleton.sides[s].along);
                let (low, high) = if at(a).z <= at(b).z { (at(a), at(b)) } else { (at(b), at(a)) };
                // A valley has both slopes rising away from it.
                let along = (high - low).truncate();
                let is_valley = left.perp_dot(right).abs() > 0.05
                    && (left.perp().dot(along) > 0.0) == (right.perp().dot(along) > 0.0)
                    && self.starts_at_a_reflex_corner(low);
                if !is_valley && low.distance(high) > 0.6 {
                    found.push([low, high]);
                }
            }
        }
        found
    }

    fn starts_at_a_reflex_corner(&self, low: DVec3) -> bool {
        let n = self.edges.len();
        (0..n).any(|after| {
            let own = self.skeleton.sides[after];
            let before = (0..n).find(|&i| self.chains_end(i) == own.from);
            own.from.distance(low.truncate()) < 1e-6
                && before.is_some_and(|b| self.skeleton.sides[b].along.perp_dot(own.along) < 0.0)
        })
    }
}
