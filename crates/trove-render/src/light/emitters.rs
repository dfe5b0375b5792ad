//! Triangles that shine, made ready.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use trove_model::{Scene, luminance};
use trove_trace::light::{self, Emitter, LEAST_SHARE, Pattern, barycentric};
use trove_trace::{Basis, NONE, cosine_hemisphere};

use super::tree::{Aim, Tree, TreeEntry};
use crate::lookups::LOOKUPS;
use crate::ray::Ray;
use crate::texture::{Glow, MapOf};

/// Which rays that start on an instance do not end on it.
pub(crate) type GetsAway<'a> = dyn Fn(u32, &[Ray; PROBES]) -> [bool; PROBES] + Sync + 'a;

/// How a material shines.
pub(crate) struct Shines {
    /// Where it is brightest.
    pub(crate) radiance: Vec3,
    /// What that is multiplied by where.
    pub(crate) glow: Option<Glow>,
    /// Index of its beam; [`NONE`] for none.
    pub(crate) beam: u32,
}

/// How a material shines, by its index.
pub(crate) type Emission<'a> = dyn Fn(usize) -> Shines + 'a;

/// Rays by which a triangle's share of light that gets away is measured, a square number.
pub(crate) const PROBES: usize = 16;
/// They start this far above it, metres.
const PROBE_FROM_M: f32 = 1e-3;

/// How far light of the outermost emitters reaches, roughly.
const MARGIN_M: f32 = 20.0;

/// What [`light::Emitters`] looks up.
pub(super) struct Emitters {
    triangles: Vec<Emitter>,
    patterns: Vec<Pattern<MapOf>>,
    tree: Tree,
    /// Irradiance of a surface among them: all their light, spread over the ground that they stand on.
    pub(super) typical_irradiance: f32,
}

impl Emitters {
    /// `None` where nothing shines. Cut-out materials are left out: rays that meet them by chance still count them.
    ///
    /// `emission` is that of each of the scene's materials.
    pub(super) fn new(scene: &Scene, emission: &Emission<'_>, gets_away: &GetsAway<'_>) -> Option<Self> {
        let (mut triangles, mut patterns, mut aims) = (Vec::new(), Vec::new(), Vec::new());
        for (i, instance) in scene.instances.iter().enumerate() {
            let first_aim = aims.len();
            if !instance.materials.iter().any(|&m| scene.materials[m].is_emitter()) {
                continue;
            }
            let mesh = &scene.meshes[instance.mesh];
            let mesh_from_world = instance.world_from_mesh.matrix3.inverse().as_mat3();
            // A mirrored instance turns its triangles inside out.
            let side = instance.world_from_mesh.matrix3.determinant().signum() as f32;
            for (t, corners) in mesh.triangles.iter().enumerate() {
                let index = instance.materials[usize::from(mesh.slot(t))];
                let material = &scene.materials[index];
                if !material.is_emitter() || material.alpha_cutoff > 0.0 {
                    continue;
                }
                let at = |c: u32| instance.world_from_mesh.transform_point3(mesh.positions[c as usize].as_dvec3());
                let [a, b, c]: [DVec3; 3] = corners.map(at);
                let cross = (b - a).cross(c - a).as_vec3() * side;
                if cross.length() > 0.0 {
                    let Shines { radiance: brightest, glow, beam: beam_index } = emission(index);
                    let pattern = glow.filter(|_| !mesh.uvs.is_empty()).map(|Glow { map, scale }| {
                        let uvs = corners.map(|c| mesh.uvs[c as usize]);
                        Pattern { brightest, scale, uvs, map: MapOf(Some(map)) }
                    });
                    let radiance = pattern.as_ref().map_or(brightest, mean);
                    if radiance == Vec3::ZERO {
                        continue;
                    }
                    let aim = material.beam.as_ref().map_or(NONE, |beam| {
                        let known = aims[first_aim..].iter().position(|aim: &Aim| Arc::ptr_eq(&aim.beam, beam));
                        let index = first_aim + known.unwrap_or(aims.len() - first_aim);
                        if index == aims.len() {
                            aims.push(Aim::new(beam.clone(), beam_index, mesh_from_world));
                        }
                        index as u32
                    });
                    triangles.push(Emitter {
                        key: [i as u32, t as u32],
                        corner: a.as_vec3(),
                        edges: [(b - a).as_vec3(), (c - a).as_vec3()],
                        cross,
                        radiance,
                        brightness: luminance(radiance),
                        pattern: pattern.as_ref().map_or(NONE, |_| patterns.len() as u32),
                        aim,
                    });
                    patterns.extend(pattern);
                }
            }
        }
        Self::of(triangles, patterns, &aims, |emitter| measured(emitter, gets_away))
    }

    /// Of triangles as bright as if all of their light got away, of which this share does.
    fn of(
        mut triangles: Vec<Emitter>,
        patterns: Vec<Pattern<MapOf>>,
        aims: &[Aim],
        gets_away: impl Fn(&Emitter) -> f32 + Sync,
    ) -> Option<Self> {
        let aim = |emitter: &Emitter| aims.get(emitter.aim as usize);
        let flux = |e: &Emitter| PI * power(e) * aim(e).map_or(1.0, |aim| aim.flux_share(e.cross));
        let all: f32 = triangles.iter().map(flux).sum();
        let corners = || triangles.iter().map(|e| e.corner.truncate());
        let (low, high) = (corners().fold(Vec2::INFINITY, Vec2::min), corners().fold(-Vec2::INFINITY, Vec2::max));
        let typical_irradiance = all / (high - low + MARGIN_M).element_product();
        triangles.par_iter_mut().for_each(|emitter| emitter.brightness *= gets_away(emitter));
        let entries: Vec<TreeEntry> = triangles.iter().map(|emitter| entry(emitter, aim(emitter))).collect();
        (!triangles.is_empty()).then(|| Self {
            tree: Tree::new(&entries, aims),
            triangles,
            patterns,
            typical_irradiance,
        })
    }

    /// To be looked up.
    pub(super) fn view<'a>(&'a self, beams: light::Beams<'a>) -> light::Emitters<'a, MapOf> {
        light::Emitters { triangles: &self.triangles, patterns: &self.patterns, tree: self.tree.view(beams) }
    }
}

/// The mean over points that are spread evenly.
fn mean(pattern: &Pattern<MapOf>) -> Vec3 {
    const SIDE: usize = 12;
    let points = (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE].map(|k| (k as f32 + 0.5) / SIDE as f32));
    points.map(|u| pattern.at(&LOOKUPS, barycentric(u))).sum::<Vec3>() / (SIDE * SIDE) as f32
}

/// Area times luminance, in the brightest direction of its beam.
fn power(emitter: &Emitter) -> f32 {
    0.5 * emitter.cross.length() * emitter.brightness
}

/// Share of a triangle's light that gets away, by rays of a fixed pattern. Never nothing: more rays might find a way.
fn measured(emitter: &Emitter, gets_away: &GetsAway<'_>) -> f32 {
    let normal = emitter.cross.normalize();
    let basis = Basis::about(normal);
    let side = PROBES.isqrt();
    let rays = std::array::from_fn(|i| {
        let [column, row] = [i % side, i / side].map(|k| (k as f32 + 0.5) / side as f32);
        // Directions and places in another order, so that no direction always starts at the same edge.
        let point = emitter.point(barycentric([row, (column + 0.5 * row).fract()]));
        let direction = basis.to_world(cosine_hemisphere([column, (row + column * 0.5).fract()]));
        Ray { through_glass: true, ..Ray::new(point + normal * PROBE_FROM_M, direction) }
    });
    let away = gets_away(emitter.key[0], &rays).iter().filter(|away| **away).count();
    (away as f32 + 0.25) / (PROBES as f32 + 0.25)
}

/// As the tree knows it: with a beam that leaves much of what is before it, as a light that shines evenly.
fn entry(emitter: &Emitter, aim: Option<&Aim>) -> TreeEntry {
    let broad = aim.filter(|aim| aim.is_broad);
    let Emitter { corner, edges, cross, .. } = *emitter;
    let corners = [corner, corner + edges[0], corner + edges[1]];
    TreeEntry {
        low: corners[0].min(corners[1]).min(corners[2]),
        high: corners[0].max(corners[1]).max(corners[2]),
        centre: emitter.centre(),
        axis: cross.normalize(),
        power: power(emitter) * broad.map_or(1.0, |aim| aim.flux_share(cross).max(LEAST_SHARE)),
        aim: (emitter.aim != NONE && broad.is_none()).then_some(emitter.aim),
    }
}

#[cfg(test)]
mod tests {
    use glam::Mat3;
    use trove_model::{Beam, Seed};
    use trove_trace::light::EmitterPoint;

    use super::*;
    use crate::light::beams::Beams;
    use crate::light::cdf::Lists;

    /// A box at a place that shines on all sides.
    fn lamp(number: u32, at: Vec3, radiance: f32, aim: Option<u32>) -> impl Iterator<Item = Emitter> {
        let sides = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].into_iter().enumerate();
        sides.flat_map(move |(side, axis)| {
            let (a, b) = axis.any_orthonormal_pair();
            let (a, b) = if a.cross(b).dot(axis) > 0.0 { (a, b) } else { (b, a) };
            [1.0, -1.0].into_iter().enumerate().map(move |(half, sign)| {
                let edges = [a * 0.3 * sign, b * 0.3 * sign];
                let key = [number, 2 * side as u32 + half as u32];
                let (corner, cross) = (at + axis * 0.15 - (a + b) * 0.15 * sign, edges[0].cross(edges[1]));
                let radiance = Vec3::splat(radiance);
                let (brightness, aim) = (luminance(radiance), aim.unwrap_or(NONE));
                Emitter { key, corner, edges, cross, radiance, brightness, pattern: NONE, aim }
            })
        })
    }

    /// Lights and their beams.
    struct Street(Emitters, Beams);

    impl Street {
        fn view(&self) -> light::Emitters<'_, MapOf> {
            self.0.view(self.1.view())
        }
    }

    /// Lights of which all aims have one beam.
    fn emitters(triangles: Vec<Emitter>, aims: Vec<Aim>) -> Street {
        let mut beams = Beams::default();
        aims.first().map(|aim| beams.index(&aim.beam));
        Street(Emitters::of(triangles, Vec::new(), &aims, |_| 1.0).unwrap(), beams)
    }

    /// Lamps along a street, 300 of them on both sides, some a hundred times as bright.
    fn street() -> Street {
        let lamps = (0..300).flat_map(|i| {
            let at = Vec3::new((i / 2) as f32 * 6.0, if i % 2 == 0 { -8.0 } else { 8.0 }, 5.0 + (i % 3) as f32);
            lamp(i, at, if i % 7 == 0 { 100.0 } else { 1.0 + (i % 5) as f32 }, None)
        });
        emitters(lamps.collect(), Vec::new())
    }

    /// Far fewer lamps, and cars between them whose beams are a thousand times as bright ahead and on the road as elsewhere.
    fn street_with_cars() -> Street {
        let beam = Beam::new(vec![-12.0, -10.0, 10.0, 12.0], vec![-9.0, -7.0, -0.5, 0.0], {
            let row = |level: f32| [0.001, level, level, 0.001];
            [row(0.001), row(1.0), row(1.0), row(0.001)].concat()
        });
        let beam = Arc::new(beam.unwrap());
        let (ahead, towards) = (Mat3::IDENTITY, Mat3::from_rotation_z(PI));
        let aims = (0..40).map(|i| Aim::new(beam.clone(), 0, if i % 2 == 0 { ahead } else { towards }));
        let lamps = (0..30).flat_map(|i| {
            let at = Vec3::new((i / 2) as f32 * 60.0, if i % 2 == 0 { -8.0 } else { 8.0 }, 7.0);
            lamp(i, at, 20.0, None)
        });
        let cars = (0..40).flat_map(|i| {
            let at = Vec3::new((i / 2) as f32 * 45.0, if i % 2 == 0 { -1.6 } else { 1.6 }, 0.65);
            [-0.6, 0.6].map(|y| (at + Vec3::Y * y, i)).into_iter()
        });
        let beams = cars.enumerate().flat_map(|(k, (at, car))| lamp(30 + k as u32, at, 900.0, Some(car)));
        emitters(lamps.chain(beams).collect(), aims.collect())
    }

    /// As many lamps as along a street, each with its own aim, whose beams look down and along the road.
    fn street_with_tables() -> Street {
        let steps = |count: i32, least: f32| -> Vec<f32> { (0..=count).map(|i| least + 5.0 * i as f32).collect() };
        let beam = Beam::of(&steps(72, -180.0), &steps(36, -90.0), |toward| {
            let gamma_deg = (-toward.z).acos().to_degrees();
            let lobe = (-((gamma_deg - 66.0) / 22.0).powi(2)).exp();
            if gamma_deg > 88.0 { 0.0 } else { 0.2 + 0.8 * lobe * toward.y.powi(2) }
        });
        let beam = Arc::new(beam.unwrap());
        let turns = [PI / 2.0, -PI / 2.0];
        let aims = (0..200).map(|i| Aim::new(beam.clone(), 0, Mat3::from_rotation_z(-turns[i as usize % 2])));
        let lamps = (0..200).flat_map(|i| {
            let at = Vec3::new((i / 2) as f32 * 30.0, if i % 2 == 0 { -8.0 } else { 8.0 }, 8.0);
            lamp(i, at, 20.0, Some(i))
        });
        emitters(lamps.collect(), aims.collect())
    }

    /// Places on the road and on a wall beside it.
    fn places() -> Vec<(Vec3, Vec3)> {
        let x = |i: usize| 3.0 + 90.0 * i as f32;
        (0..10).flat_map(|i| [(Vec3::new(x(i), 1.0, 0.0), Vec3::Z), (Vec3::new(x(i), 12.0, 3.0), -Vec3::Y)]).collect()
    }

    /// What one sample brings.
    fn brought(drawn: &EmitterPoint, (from, normal): (Vec3, Vec3)) -> f64 {
        let cos = (drawn.point - from).normalize().dot(normal).max(0.0);
        f64::from(drawn.radiance.x * cos / drawn.pdf)
    }

    /// The noise of one sample relative to the light at each place, and of one that is drawn by power alone; fails where the
    /// mean is not the light.
    fn noise(street: &Street) -> Vec<[f64; 2]> {
        let powers: Vec<f64> = street.0.triangles.iter().map(|e| f64::from(power(e))).collect();
        let mut lists = Lists::default();
        lists.append(&powers);
        let by_power = lists.one();
        let mut random = Seed(5).random();
        let mut unit = || random.unit() as f32;
        let on = |e: &Emitter, place: Vec3, u: [f32; 2], probability: f32| {
            let point = e.point(u);
            let tree = street.view().tree;
            let aim = tree.aims.get(e.aim as usize);
            let share = aim.map_or(1.0, |aim| tree.beams.aimed(aim, place - point));
            let is_lit = e.cross.dot(place - point) > 0.0;
            let pdf = probability * e.density(place, point);
            is_lit.then_some(EmitterPoint { point, radiance: e.radiance * share, pdf })
        };
        let measured = places().into_iter().map(|place| {
            // All lamps, finely: those in view, from the side that faces the place.
            let mut truth = 0.0;
            for e in &street.0.triangles {
                let n = 8;
                for k in 0..n * n {
                    let u = [k / n, k % n].map(|i| (i as f32 + 0.5) / n as f32);
                    truth += on(e, place.0, u, 1.0).map_or(0.0, |drawn| brought(&drawn, place)) / f64::from(n * n);
                }
            }
            let draws = 4000;
            let (mut sum, mut squares, mut squares_by_power) = (0.0, 0.0, 0.0);
            let shining = street.view();
            let cut = shining.tree.cut(place.0, place.1);
            for _ in 0..draws {
                let u = [unit(), unit(), unit()];
                let part =
                    shining.draw(&LOOKUPS, &cut, place.0, place.1, u).map_or(0.0, |drawn| brought(&drawn, place));
                sum += part;
                squares += part * part;
                let (index, _) = by_power.draw(u[0]);
                let drawn = on(&street.0.triangles[index], place.0, [u[1], u[2]], by_power.probability(index));
                squares_by_power += drawn.map_or(0.0, |drawn| brought(&drawn, place).powi(2));
            }
            let n = f64::from(draws);
            let (mean, variance) = (sum / n, squares / n - (sum / n).powi(2));
            assert!((mean - truth).abs() < 4.5 * (variance / n).sqrt(), "{place:?}: {mean} instead of {truth}");
            [variance, squares_by_power / n - truth * truth].map(|variance| variance.max(0.0) / (truth * truth))
        });
        measured.collect()
    }

    #[test]
    fn many_lamps_are_sampled_with_far_less_noise_than_by_power_and_without_bias() {
        for street in [street(), street_with_cars(), street_with_tables()] {
            let noise = noise(&street);
            let by_power = noise.iter().map(|[_, by_power]| by_power).sum::<f64>() / noise.len() as f64;
            let worst = noise.iter().map(|[ours, _]| *ours).fold(0.0, f64::max);
            assert!(worst < 1.0 && by_power > 100.0, "{noise:?}");
        }
    }

    #[test]
    fn below_a_lamp_with_a_table_the_road_is_as_bright_as_its_candelas_say() {
        // A lens of 0.04 m² at 8 m that looks down, with 5 cd at its nadir and most at 60° along the road.
        let candelas = |toward: Vec3| {
            let gamma = (-toward.z).clamp(0.0, 1.0).acos();
            5.0 + 20.0 * (gamma.sin() / 60.0f32.to_radians().sin()).powi(4) * toward.x.powi(2)
        };
        let steps = |count: i32, least: f32| -> Vec<f32> { (0..=count).map(|i| least + 2.0 * i as f32).collect() };
        let beam = Beam::of(&steps(180, -180.0), &steps(42, -90.0), |toward| candelas(toward) / (0.04 * -toward.z));
        let aim = Aim::new(Arc::new(beam.unwrap()), 0, Mat3::IDENTITY);
        let at = Vec3::new(0.0, 0.0, 8.0);
        let half = |number: u32, sign: f32| {
            let edges = [Vec3::Y * 0.2 * sign, Vec3::X * 0.2 * sign];
            let corner = at - (Vec3::X + Vec3::Y) * 0.1 * sign;
            let cross = edges[0].cross(edges[1]);
            Emitter {
                key: [0, number],
                corner,
                edges,
                cross,
                radiance: Vec3::ONE,
                brightness: 1.0,
                pattern: NONE,
                aim: 0,
            }
        };
        let lamp = emitters(vec![half(0, 1.0), half(1, -1.0)], vec![aim]);
        let mut random = Seed(8).random();
        for gamma_deg in [0.0f32, 30.0, 50.0, 60.0, 70.0] {
            let place = (Vec3::new(8.0 * gamma_deg.to_radians().tan(), 0.0, 0.0), Vec3::Z);
            let shining = lamp.view();
            let cut = shining.tree.cut(place.0, place.1);
            let draw = |u| shining.draw(&LOOKUPS, &cut, place.0, place.1, u).unwrap();
            let draws = 2000;
            let mut unit = || random.unit() as f32;
            let sum: f64 = (0..draws).map(|_| brought(&draw([unit(), unit(), unit()]), place)).sum();
            let (found, cos) = (sum / f64::from(draws), f64::from(gamma_deg).to_radians().cos());
            let expected = f64::from(candelas((place.0 - at).normalize())) * cos.powi(3) / 64.0;
            assert!((found / expected - 1.0).abs() < 0.01, "{gamma_deg}°: {found} instead of {expected}");
        }
    }

    #[test]
    fn what_gets_away_of_a_lamp_is_what_its_surroundings_let_through() {
        // With nothing around it, closed in, and with half of all ways closed.
        let lamp = emitters(lamp(3, Vec3::ZERO, 1.0, None).collect(), Vec::new());
        for e in &lamp.0.triangles {
            let normal = e.cross.normalize();
            let share = |away: &(dyn Fn(&Ray) -> bool + Sync)| measured(e, &|_, rays| rays.each_ref().map(away));
            assert_eq!(share(&|ray| ray.through_glass && ray.direction.dot(normal) > 0.0), 1.0);
            assert!((0.001..0.05).contains(&share(&|_| false)));
            // Cosine-weighted, half of all light is within 45° of the normal.
            let within = share(&|ray| ray.direction.dot(normal) > 0.5_f32.sqrt());
            assert!((within - 0.5).abs() < 0.13, "{within}");
            let aside = share(&|ray| ray.direction.cross(normal).dot(e.edges[0]) > 0.0);
            assert!((aside - 0.5).abs() < 0.13, "{aside}");
        }
    }

    #[test]
    fn triangles_are_drawn_with_the_probability_that_is_claimed() {
        claimed_probabilities_hold(&street());
        claimed_probabilities_hold(&street_with_cars());
        claimed_probabilities_hold(&street_with_tables());
    }

    fn claimed_probabilities_hold(street: &Street) {
        let mut random = Seed(6).random();
        let place = places()[3];
        let draws = 100_000;
        let shining = street.view();
        let mut drawn = vec![0.0; street.0.triangles.last().map_or(0, |e| e.key[0] as usize + 1)];
        for _ in 0..draws {
            let u = [random.unit() as f32, random.unit() as f32, random.unit() as f32];
            let Some(point) = shining.draw(&LOOKUPS, &shining.tree.cut(place.0, place.1), place.0, place.1, u) else {
                continue;
            };
            let near = |e: &&Emitter| {
                let above = e.cross.normalize().dot(point.point - e.corner).abs();
                above < 1e-4 && (point.point - e.centre()).length() < 0.3
            };
            let e = street.0.triangles.iter().filter(near).min_by(|a, b| {
                let claimed = |e: &Emitter| (shining.pdf(e.key, place.0, place.1, point.point) / point.pdf - 1.0).abs();
                claimed(a).total_cmp(&claimed(b))
            });
            let e = e.unwrap();
            assert!((shining.pdf(e.key, place.0, place.1, point.point) / point.pdf - 1.0).abs() < 1e-3);
            drawn[e.key[0] as usize] += 1.0;
        }
        let weight = |e: &Emitter| shining.pdf(e.key, place.0, place.1, e.centre()) / e.density(place.0, e.centre());
        let mut expected = vec![0.0; street.0.triangles.last().map_or(0, |e| e.key[0] as usize + 1)];
        for e in &street.0.triangles {
            expected[e.key[0] as usize] += f64::from(weight(e)) * f64::from(draws);
        }
        let total: f64 = expected.iter().sum();
        assert!((total / f64::from(draws) - 1.0).abs() < 1e-3, "{total}");
        // Rare ones together.
        let (mut chi2, mut degrees, mut rest) = (0.0, -1.0f64, (0.0, 0.0));
        for (n, e) in drawn.iter().zip(&expected) {
            if *e > 10.0 {
                chi2 += (n - e).powi(2) / e;
                degrees += 1.0;
            } else {
                rest = (rest.0 + n, rest.1 + e);
            }
        }
        chi2 += (rest.0 - rest.1).powi(2) / rest.1.max(1e-9);
        let limit = degrees + 1.0 + 3.3 * (2.0 * (degrees + 1.0)).sqrt() + 5.0;
        assert!(chi2 < limit, "χ² = {chi2} of {degrees}");
    }
}
