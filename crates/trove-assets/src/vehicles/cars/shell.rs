//! The painted shell of a car: rings around its lower body, a bonnet and a boot lid spanned between them, and the
//! greenhouse on top. Only the left half is made.
//!
//! Distances along the car, `s`, are measured from the front end backwards; x = −s.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3, vec2, vec3};

use super::grid::{Grid, straighten};
use super::plan::{CarPlan, Profile};
use crate::shape::{Curve, Shape, rounded};

/// Columns of the shell around the front, along the side and around the back.
const SHELL_COLUMNS: [usize; 3] = [13, 17, 11];
/// Columns of the greenhouse around windscreen, side and rear window.
const HOUSE_COLUMNS: [usize; 3] = [10, 10, 10];
/// Columns of windscreen and rear window that are glass, of those around a corner; the rest is the pillar.
const SCREEN_COLUMNS: usize = 7;

/// Materials of the shell's parts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Skin {
    pub(crate) paint: u16,
    pub(crate) glass: u16,
    pub(crate) rear_glass: u16,
    pub(crate) trim: u16,
    pub(crate) under: u16,
    pub(crate) lining: u16,
    pub(crate) has_rear_window: bool,
}

/// The shell's shape before it is meshed.
#[derive(Clone, Debug)]
pub(crate) struct Shell {
    profile: Profile,
    /// Axles as (distance from the front, height, radius of the arch).
    arches: Vec<Vec3>,
    roof: Curve,
    edge: Curve,
    /// The shell's upper edge from the middle of the front to the middle of the back, (s, y, z).
    rim: Vec<Vec3>,
}

impl Shell {
    /// The shell of a plan.
    pub(crate) fn of(plan: &CarPlan) -> Self {
        let arches = plan.axles_m.map(|s| vec3(s, plan.wheel_radius_m + 0.01, plan.arch_radius_m()));
        let p = &plan.profile;
        let roof = Curve::new(&[p.header, p.peak, p.rear_header]);
        let mid = p.cowl.0 * 0.5;
        let back = p.deck.0.min(p.length_m - 0.3);
        let edge = Curve::new(&[
            (0.0, p.nose_m),
            (mid, p.nose_m.mul_add(0.35, (p.belt_m[0] - 0.02) * 0.65)),
            (p.cowl.0 + 0.2, p.belt_m[0] - 0.008),
            (back, p.belt_m[1]),
            (p.length_m, p.tail_m),
        ]);
        let mut body = Self { profile: p.clone(), arches: arches.to_vec(), roof, edge, rim: Vec::new() };
        body.rim = body.outline().iter().map(|&(q, n)| *body.section(q, n).last().unwrap_or(&Vec3::ZERO)).collect();
        body
    }

    /// Height of the shell's upper edge on the side: of the windows' lower edge.
    pub(crate) fn belt_m(&self, s: f32) -> f32 {
        self.edge.at(s)
    }

    /// Height of the roof in the middle.
    pub(crate) fn roof_m(&self, s: f32) -> f32 {
        self.roof.at(s)
    }

    /// Height of the roof's edge above the side windows.
    pub(crate) fn rail_m(&self, s: f32) -> f32 {
        self.roof.at(s) - 0.035 - 0.02 * self.profile.roof_share
    }

    /// Distance from the front of the windscreen's side edge, at the foot (0) to the roof (1).
    pub(crate) fn screen_side_m(&self, share: f32) -> f32 {
        let p = &self.profile;
        p.cowl.0 + (p.header.0 - p.cowl.0) * share + p.screen_bow_m[0] * (1.0 - 0.3 * share)
    }

    /// How far behind the front the bonnet's leading edge is, at a distance from the middle.
    pub(crate) fn nose_s(&self, y: f32) -> f32 {
        self.rim.iter().find(|q| q.y >= y).map_or(0.3, |q| q.x)
    }

    /// Left half of the plan at its widest, (s, y), with outward normals.
    fn outline(&self) -> Vec<(Vec2, Vec2)> {
        let p = &self.profile;
        let half = p.width_m / 2.0 - p.flare_m;
        let corner = |end: usize| {
            let fine: Vec<Vec2> = (0..=160)
                .map(|i| {
                    let (sin, cos) = (FRAC_PI_2 * i as f32 / 160.0).sin_cos();
                    let s = p.round_m[end] * (1.0 - cos.max(0.0).powf(2.0 / 2.2));
                    vec2(s, half * sin.powf(2.0 / p.square[end]))
                })
                .collect();
            resampled(&fine, SHELL_COLUMNS[if end == 0 { 0 } else { 2 }])
        };
        let (front, back) = (corner(0), corner(1));
        let (from, to) = (p.round_m[0], p.length_m - p.round_m[1]);
        let steps = SHELL_COLUMNS[1];
        let side = (1..steps).map(|i| vec2(from + (to - from) * i as f32 / steps as f32, half));
        let back = back.iter().rev().map(|q| vec2(p.length_m - q.x, q.y));
        let points: Vec<Vec2> = front.iter().copied().chain(side).chain(back).collect();
        let last = points.len() - 1;
        let normal = |i: usize| match i {
            0 => vec2(-1.0, 0.0),
            i if i == last => vec2(1.0, 0.0),
            i => (points[i + 1] - points[i - 1]).perp().normalize_or(Vec2::Y),
        };
        points.iter().enumerate().map(|(i, &q)| (q, normal(i))).collect()
    }

    /// The lower body's section at a point of the outline, from under the floor to the upper edge, (s, y, z).
    fn section(&self, q: Vec2, normal: Vec2) -> Vec<Vec3> {
        let p = &self.profile;
        let (c, nose, tail, top) = (p.clearance_m, p.nose_m, p.tail_m, self.edge.at(q.x));
        let up = |share: f32| c + (top - c) * share;
        let (rake, lean) = (p.rake_m[0], p.rake_m[1]);
        let hollow = p.hollow_m;
        // Rows as (inset, height) of front, side and back, and over how much a corner is rounded.
        let rows = [
            ([(0.45, c + 0.02), (0.45, c), (0.45, c + 0.06)], 0.0),
            ([(0.09, c + 0.01), (0.06, c), (0.10, c + 0.07)], 0.0),
            ([(0.02, c + 0.06), (0.012, c + 0.045), (0.02, c + 0.13)], 0.03),
            ([(0.0, c + 0.19), (0.0, c + 0.12), (0.0, c + 0.24)], 0.0),
            ([(0.0, c + (nose - c) * 0.5), (hollow, up(0.36)), (0.0, c + 0.36)], 0.0),
            ([(0.02 + rake * 0.05, nose - 0.19), (hollow * 0.6, up(0.58)), (0.035, c + 0.42)], 0.0),
            ([(0.03 + rake * 0.2, nose - 0.1), (0.0, up(0.79)), (0.03, tail - 0.16)], 0.022),
            ([(0.03 + rake * 0.45, nose - 0.035), (p.shoulder_m * 0.35, up(0.93)), (0.02, tail - 0.03)], 0.04),
            ([(0.03 + rake, nose), (p.shoulder_m, top), (0.03 + lean, tail)], 0.0),
        ];
        let (front, back) = (normal.x.min(0.0).powi(2), normal.x.max(0.0).powi(2));
        let side = normal.y * normal.y;
        let corners: Vec<(Vec3, f32)> = rows
            .iter()
            .map(|&([f, s, b], reach)| {
                let inset = f.0 * front + s.0 * side + b.0 * back;
                let z = f.1 * front + s.1 * side + b.1 * back;
                let flare = p.flare_m * side * self.arch_share(q.x, z);
                ((q - normal * (inset - flare)).extend(z), reach)
            })
            .collect();
        rounded(&corners)
    }

    /// How much of the flare there is at a place of the side.
    fn arch_share(&self, s: f32, z: f32) -> f32 {
        let near = |arch: &Vec3| {
            let off = (vec2(s, z).distance(arch.truncate()) - arch.z).max(0.0) / 0.13;
            (-off * off).exp()
        };
        self.arches.iter().map(near).fold(0.0, f32::max)
    }

    /// The rim's (y, z) at a distance from the front, towards the front or the back half of the car.
    fn rim_at(rim: &[Vec3], s: f32) -> Vec2 {
        let next = rim.partition_point(|q| q.x < s).clamp(1, rim.len() - 1);
        let (a, b) = (rim[next - 1], rim[next]);
        let t = ((s - a.x) / (b.x - a.x).max(1e-5)).clamp(0.0, 1.0);
        vec2(a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t)
    }

    /// A lid between the middle line and a rim's left half, its four sides blended (after Coons): the rim's corner
    /// parts its side from its bow, which is in front or behind; `middle` is the middle line from the other end to the
    /// bow.
    fn lid(side: &[Vec3], bow: &[Vec3], middle: &[Vec3], slot: impl Fn(usize) -> u16) -> Shape {
        // Side and middle line lead to the bow, which leads to the middle.
        let rear = (side[0], middle[0]);
        let columns = side.iter().zip(middle).enumerate().map(|(i, (&edge, &spine))| {
            let a = i as f32 / (side.len() - 1) as f32;
            let row = bow.iter().enumerate().map(|(k, &front)| {
                let b = 1.0 - k as f32 / (bow.len() - 1) as f32;
                let crown = b.powf(2.2);
                let back = vec3(0.0, rear.0.y * b, 0.0) + (rear.1 + (rear.0 - rear.1) * crown) * vec3(1.0, 0.0, 1.0);
                let between = |back: Vec3, front: Vec3| back + (front - back) * a;
                let to_spine = spine - between(rear.1, bow[bow.len() - 1]);
                let to_edge = edge - between(rear.0, bow[0]);
                between(back, front) + to_spine * (1.0 - crown) + to_edge * crown
            });
            row.collect()
        });
        let columns: Vec<Vec<Vec3>> = columns.collect();
        if bow[0].x < side[0].x {
            Grid(columns.into_iter().rev().collect()).shape(|column, _| slot(side.len() - 2 - column))
        } else {
            Grid(columns).shape(|column, _| slot(column))
        }
    }

    /// The lower body with bonnet and boot lid, its top left open under the windows.
    pub(crate) fn lower(&self, skin: &Skin) -> Shape {
        let p = &self.profile;
        let columns: Vec<Vec<Vec3>> = self.outline().iter().map(|&(q, n)| self.section(q, n)).collect();
        let walls = Grid(columns).shape(|_, row| if row < 2 { skin.under } else { skin.paint });
        let (front, back) = (self.bonnet_end(), self.boot_start());
        // It rises from the nose like a bow that flattens towards the windscreen.
        let from = self.rim[0].x;
        let rise = |along: f32, up: f32| (from + (p.cowl.0 - from) * along, p.nose_m + (p.cowl.1 - p.nose_m) * up);
        let bonnet = Curve::new(&[rise(0.0, 0.0), rise(0.25, 0.38), rise(0.65, 0.8), rise(1.0, 1.0)]);
        let corner = self.rim.partition_point(|q| q.y < p.width_m * 0.36 && q.x < p.cowl.0 * 0.6).max(4);
        let side: Vec<Vec3> = self.rim[corner..=front].iter().rev().copied().collect();
        let bow: Vec<Vec3> = self.rim[..=corner].iter().rev().copied().collect();
        let spine = |from: f32, to: Vec3, steps: usize, height: &Curve| -> Vec<Vec3> {
            let at = |i: usize| from + (to.x - from) * i as f32 / (steps - 1) as f32;
            (0..steps).map(|i| if i + 1 == steps { to } else { vec3(at(i), 0.0, height.at(at(i))) }).collect()
        };
        let middle = spine(p.cowl.0 + 0.04, self.rim[0], side.len(), &bonnet);
        let bonnet = Self::lid(&side, &bow, &middle, |k| if k == 0 { skin.trim } else { skin.paint });
        // The ledge that the windows stand on.
        let ledge = Grid(
            self.rim[front..=back]
                .iter()
                .map(|&q| vec![q, q - vec3(0.0, 0.06, 0.015), q - vec3(0.0, 0.09, 0.14)])
                .collect(),
        );
        let mut parts = vec![walls, bonnet, ledge.shape(|_, row| if row == 0 { skin.paint } else { skin.lining })];
        if p.has_bed {
            parts.push(self.bed(&self.rim[back..], skin));
        } else {
            let last = self.rim.len() - 1;
            let height = Curve::new(&[(p.deck.0, p.deck.1), (self.rim[last].x, p.tail_m)]);
            let is_side = |q: &Vec3| q.y > p.width_m * 0.38;
            let corner = (back + 1..last - 2).rev().find(|&i| is_side(&self.rim[i])).unwrap_or(back + 1);
            let side = &self.rim[back..=corner];
            let middle = spine(p.deck.0 - 0.04, self.rim[last], side.len(), &height);
            parts.push(Self::lid(side, &self.rim[corner..], &middle, |_| skin.paint));
        }
        let mut shell = Shape::join(parts).smooth(0.62);
        straighten(&mut shell);
        shell
    }

    /// Column of the rim where the bonnet ends.
    fn bonnet_end(&self) -> usize {
        let end = self.screen_side_m(0.0) + 0.02;
        self.rim.partition_point(|q| q.x < end).clamp(2, self.rim.len() - 4)
    }

    /// Column of the rim where the boot lid or the bed starts.
    fn boot_start(&self) -> usize {
        let p = &self.profile;
        let start = if p.has_bed { p.deck.0 + 0.06 } else { p.deck.0 - p.screen_bow_m[1] - 0.02 };
        self.rim.partition_point(|q| q.x < start).clamp(self.bonnet_end() + 1, self.rim.len() - 3)
    }

    /// Walls and floor of a load bed within a stretch of rim.
    fn bed(&self, rim: &[Vec3], skin: &Skin) -> Shape {
        let floor = self.profile.clearance_m + 0.45;
        let inner = |q: Vec3, inset: f32, z: f32| {
            let s = q.x.min(self.profile.length_m - 0.1 - inset);
            vec3(s, (q.y - inset).max(0.0).min(self.profile.width_m / 2.0 - 0.08 - inset), z)
        };
        let columns = rim.iter().map(|&q| {
            vec![
                q,
                inner(q, 0.05, q.z + 0.006),
                inner(q, 0.07, q.z - 0.02),
                inner(q, 0.09, floor),
                vec3(inner(q, 0.09, 0.0).x, 0.0, floor),
            ]
        });
        Grid(columns.collect()).shape(|_, row| if row == 0 { skin.paint } else { skin.trim })
    }

    /// Windows, pillars and roof; the side windows are still to be cut.
    pub(crate) fn greenhouse(&self, skin: &Skin) -> Shape {
        let columns = self.house_columns();
        // Spine of the roof: from header to rear header, as far along as each column stands.
        let tops: Vec<Vec3> = columns.iter().map(|c| c[3]).collect();
        let arcs: Vec<f32> = std::iter::once(0.0)
            .chain(tops.windows(2).scan(0.0, |sum, w| {
                *sum += w[0].truncate().distance(w[1].truncate());
                Some(*sum)
            }))
            .collect();
        let total = arcs.last().copied().unwrap_or(1.0);
        let (first, last) = (tops[0].x, tops[tops.len() - 1].x);
        let crown = |s: f32, y: f32| {
            let edge = Self::rim_at(&tops, s);
            edge.y + (self.roof.at(s) - edge.y) * (1.0 - (y / edge.x.max(1e-3)).min(1.0).powf(2.4))
        };
        let sections: Vec<Vec<Vec3>> = columns
            .iter()
            .zip(&arcs)
            .map(|(c, arc)| {
                let top = c[3];
                let spine = first + (last - first) * arc / total;
                let roof = |k: f32| {
                    let (s, y) = (top.x + (spine - top.x) * k, top.y * (1.0 - k));
                    vec3(s, y, crown(s, y).max(top.z))
                };
                let walls = rounded(&[(c[0], 0.0), (c[1], 0.0), (c[2], 0.0), (top, 0.05), (roof(0.22), 0.0)]);
                // Windscreen and rear window end a little off the body and the roof.
                let mut points = vec![walls[0], walls[0].lerp(walls[1], 0.25)];
                points.extend(&walls[1..3]);
                points.push(walls[2].lerp(walls[3], 0.75));
                points.extend(&walls[3..]);
                points.extend([0.4, 0.7, 1.0].map(roof));
                points
            })
            .collect();
        let columns = HOUSE_COLUMNS.iter().sum::<usize>();
        let shape = Grid(sections.clone()).shape(|column, row| {
            let from_back = columns - 1 - column;
            let pane = |column: usize, glass: u16| if column == SCREEN_COLUMNS - 1 { skin.trim } else { glass };
            match row {
                0 if column < HOUSE_COLUMNS[0] => skin.trim,
                1..4 if column < SCREEN_COLUMNS => pane(column, skin.glass),
                1..4 if skin.has_rear_window && from_back < SCREEN_COLUMNS => pane(from_back, skin.rear_glass),
                _ => skin.paint,
            }
        });
        let inside = sections.iter().map(|c| c[7..].iter().map(|&q| q - Vec3::Z * 0.03).collect()).collect();
        let lining = Grid(inside).shape(|_, _| skin.lining).inside_out();
        shape.and(lining)
    }

    /// Four points a column of the greenhouse, from its foot to the roof's edge, (s, y, z).
    fn house_columns(&self) -> Vec<[Vec3; 4]> {
        let p = &self.profile;
        let half = p.width_m / 2.0;
        let point = |column: usize, share: f32| {
            // Windows bulge outwards between their edges.
            let bulge = share * (1.0 - share) * 4.0;
            let lean = |a: (f32, f32), b: (f32, f32)| (a.0 + (b.0 - a.0) * share, a.1 + (b.1 - a.1) * share);
            let front = lean(p.cowl, p.header);
            let back = lean(p.deck, p.rear_header);
            let (front_s, back_s) = (front.0 - 0.02 * bulge, back.0 + 0.015 * bulge);
            let a = front_s + p.screen_bow_m[0] * (1.0 - 0.3 * share);
            let c = back_s - p.screen_bow_m[1] * (1.0 - 0.2 * share);
            let width = |s: f32| {
                let foot = Self::rim_at(&self.rim, s.clamp(p.round_m[0] * 0.8, p.length_m - 0.12)).x - 0.004;
                let along = ((s - p.header.0) / (p.rear_header.0 - p.header.0)).clamp(-0.5, 1.3);
                let roof = half * p.roof_share * (1.0 - 0.035 * (2.0 * along - 0.9).powi(2));
                foot + (roof - foot) * share + 0.014 * bulge
            };
            let height = |s: f32| {
                let (low, high) = (self.edge.at(s) - 0.012, self.rail_m(s.clamp(p.header.0, p.rear_header.0)));
                low + (high - low) * share
            };
            let corner = |k: usize, count: usize| (FRAC_PI_2 * (k as f32 / count as f32).powf(0.9)).sin_cos();
            let [n_front, n_side, n_back] = HOUSE_COLUMNS;
            if column <= n_front {
                let (sin, cos) = corner(column, n_front);
                let s = front_s + (a - front_s) * (1.0 - cos.max(0.0).powf(2.0 / 2.1));
                let z = front.1 + (height(a) - front.1) * sin.powi(4) - if share == 0.0 { 0.025 } else { 0.0 };
                vec3(s, width(a) * sin.powf(2.0 / 3.0), z)
            } else if column < n_front + n_side {
                let s = a + (c - a) * (column - n_front) as f32 / n_side as f32;
                vec3(s, width(s), height(s))
            } else {
                let (sin, cos) = corner(n_front + n_side + n_back - column, n_back);
                let s = back_s - (back_s - c) * (1.0 - cos.max(0.0).powf(2.0 / 2.1));
                let sunk = if share > 0.0 {
                    0.0
                } else if p.has_bed {
                    0.5
                } else {
                    0.025
                };
                let z = back.1 + (height(c) - back.1) * sin.powi(4) - sunk;
                vec3(s, width(c) * sin.powf(2.0 / 3.4), z)
            }
        };
        (0..=HOUSE_COLUMNS.iter().sum()).map(|i| [0.0, 0.36, 0.7, 1.0].map(|share| point(i, share))).collect()
    }
}

/// As many points and one more at even distances along a polyline.
fn resampled(line: &[Vec2], steps: usize) -> Vec<Vec2> {
    let arcs: Vec<f32> = std::iter::once(0.0)
        .chain(line.windows(2).scan(0.0, |sum, w| {
            *sum += w[0].distance(w[1]);
            Some(*sum)
        }))
        .collect();
    let total = arcs[arcs.len() - 1];
    (0..=steps)
        .map(|i| {
            let arc = total * i as f32 / steps as f32;
            let next = arcs.partition_point(|a| *a < arc).clamp(1, line.len() - 1);
            let (from, to) = (arcs[next - 1], arcs[next]);
            line[next - 1].lerp(line[next], (arc - from) / (to - from).max(1e-6))
        })
        .collect()
}
