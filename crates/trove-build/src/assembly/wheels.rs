//! Wheels of vehicles: found by their shape, turned as far as the vehicle has rolled, and the front ones steered along its way.

use std::collections::HashMap;

use std::f64::consts::{PI, TAU};

use glam::{DVec2, Vec2, Vec3};
use trove_model::{Cuboid, Mesh};

use crate::between::Moments;

/// Radii of tyres, metres.
const RADII_M: std::ops::RangeInclusive<f32> = 0.1..=1.2;
/// A tyre is as high as it is long, but for this share …
const ROUND: f32 = 0.02;
/// … has points near its tread in all of so many directions …
const SECTORS: usize = 16;
const TREAD: f32 = 0.9;
/// … and stands on the ground, no farther from it than this, metres.
const ON_GROUND_M: f32 = 0.05;
/// A tyre is narrower than this many radii.
const WIDEST: f32 = 1.4;
/// What lies within a tyre's circle and no farther out or in than this turns with it, metres: rims, hubs, discs.
const ASIDE_M: f32 = 0.06;
/// Points of one corner are no farther apart, metres.
const WELD_M: f32 = 1e-4;

/// Nothing steers farther than this, radians: a taxi's lock.
const LOCK_RAD: f64 = 0.7;
/// The way on either side of a keyframe by which the curve of the way is told, metres: annotated headings tremble.
const TELLS_M: f64 = 2.0;
/// Who turns farther than this on that way was annotated the wrong way round, radians.
const FLIP_RAD: f64 = 2.2;
/// Axles are no closer than this, metres.
const SHORTEST_M: f32 = 0.5;
/// Wheels of one axle are no farther apart along the vehicle, metres.
const ONE_AXLE_M: f32 = 0.2;

/// Something round that turns about an axle along y.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wheel {
    /// Its middle, x and z in the mesh's metres.
    axle: Vec2,
    radius_m: f32,
    /// Where it stands across, in the mesh's metres.
    across_m: f32,
    /// How far it is ahead of the axle that does not steer, in the mesh's metres; `None` where it does not steer either.
    ahead_m: Option<f32>,
    /// What turns, in the order of the mesh.
    vertices: Vec<u32>,
}

/// The wheels of a vehicle's mesh, whose x is forward and whose ground is z = 0: round parts that stand on the ground, with
/// all that is inside them. There are none where wheels are one piece with the body.
pub(super) fn wheels(mesh: &Mesh, parts: &[Vec<u32>]) -> Vec<Wheel> {
    let mut found: Vec<(Wheel, [f32; 2])> = parts.iter().filter_map(|part| tyre(mesh, part)).collect();
    for part in parts {
        let inside = |(wheel, [low, high]): &&mut (Wheel, [f32; 2])| {
            part.iter().all(|i| {
                let p = mesh.positions[*i as usize];
                let is_beside = (low - ASIDE_M..=high + ASIDE_M).contains(&p.y);
                is_beside && Vec2::new(p.x, p.z).distance(wheel.axle) <= wheel.radius_m * (1.0 + ROUND)
            })
        };
        if let Some((wheel, _)) = found.iter_mut().find(inside) {
            wheel.vertices.extend(part);
        }
    }
    found.iter_mut().for_each(|(wheel, _)| wheel.vertices.sort_unstable());
    let mut found: Vec<Wheel> = found.into_iter().map(|(wheel, _)| wheel).collect();
    found.retain(|wheel| !wheel.vertices.is_empty());
    steer_front(&mut found);
    found
}

/// Wheels in pairs steer by the foremost axle, about the middle of all others; those one behind the other hang in forks, which no
/// shape tells.
fn steer_front(wheels: &mut [Wheel]) {
    let foremost = wheels.iter().map(|wheel| wheel.axle.x).fold(f32::NEG_INFINITY, f32::max);
    let is_front = |wheel: &Wheel| foremost - wheel.axle.x < ONE_AXLE_M;
    let (front, others): (Vec<&Wheel>, Vec<&Wheel>) = wheels.iter().partition(|wheel| is_front(wheel));
    if front.len() < 2 || others.is_empty() {
        return;
    }
    let ahead_m = foremost - others.iter().map(|wheel| wheel.axle.x).sum::<f32>() / others.len() as f32;
    if ahead_m > SHORTEST_M {
        wheels.iter_mut().filter(|wheel| is_front(wheel)).for_each(|wheel| wheel.ahead_m = Some(ahead_m));
    }
}

/// A part as a tyre, nothing of which turns yet, and from where to where it goes along y.
fn tyre(mesh: &Mesh, part: &[u32]) -> Option<(Wheel, [f32; 2])> {
    let points = || part.iter().map(|i| mesh.positions[*i as usize]);
    let (low, high) = (points().reduce(Vec3::min)?, points().reduce(Vec3::max)?);
    let size = high - low;
    let radius_m = (size.x + size.z) / 4.0;
    let is_round = (size.x - size.z).abs() <= ROUND * size.x;
    if !is_round || !RADII_M.contains(&radius_m) || low.z.abs() > ON_GROUND_M || size.y > WIDEST * radius_m {
        return None;
    }
    let axle = Vec2::new(low.x + high.x, low.z + high.z) / 2.0;
    let mut has_tread = [false; SECTORS];
    for point in points() {
        let off = Vec2::new(point.x, point.z) - axle;
        if off.length() > radius_m * (1.0 + ROUND) {
            return None;
        }
        if off.length() > radius_m * TREAD {
            let turn = off.to_angle() / std::f32::consts::TAU + 0.5;
            has_tread[(turn * SECTORS as f32) as usize % SECTORS] = true;
        }
    }
    let wheel = Wheel { axle, radius_m, across_m: (low.y + high.y) / 2.0, ahead_m: None, vertices: Vec::new() };
    has_tread.iter().all(|has| *has).then_some((wheel, [low.y, high.y]))
}

/// The vertices of a mesh by what hangs together, each part and all of them in the order of the mesh.
pub(super) fn parts(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut above: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    fn top(above: &mut [u32], mut i: u32) -> u32 {
        while above[i as usize] != i {
            above[i as usize] = above[above[i as usize] as usize];
            i = above[i as usize];
        }
        i
    }
    let mut join = |a: u32, b: u32| {
        let (a, b) = (top(&mut above, a), top(&mut above, b));
        above[a.max(b) as usize] = a.min(b);
    };
    // Only ever looked up.
    let mut corners: HashMap<[i32; 3], u32> = HashMap::new();
    for (i, p) in (0..).zip(&mesh.positions) {
        let corner = (*p / WELD_M).round().as_ivec3().to_array();
        join(*corners.entry(corner).or_insert(i), i);
    }
    for &[a, b, c] in &mesh.triangles {
        join(a, b);
        join(b, c);
    }
    let mut number = vec![None; above.len()];
    let mut parts: Vec<Vec<u32>> = Vec::new();
    for i in 0..above.len() as u32 {
        let top = top(&mut above, i) as usize;
        let part = *number[top].get_or_insert_with(|| {
            parts.push(Vec::new());
            parts.len() - 1
        });
        parts[part].push(i);
    }
    parts
}

/// Rolls the wheels of a mesh so far forward, in its own metres, and steers those in front along a curve, 1/m, positive to the
/// left.
pub(super) fn roll(mesh: &mut Mesh, wheels: &[Wheel], way_m: f64, curve_per_m: f64) {
    for Wheel { axle, radius_m, across_m, ahead_m, vertices } in wheels {
        // Turns about y from z to x: the upper side goes forward.
        let turn = Vec2::from_angle(-(way_m / f64::from(*radius_m)).rem_euclid(TAU) as f32);
        let steer_rad = ahead_m.map_or(0.0, |ahead_m| (f64::from(ahead_m) * curve_per_m).atan());
        let steer = Vec2::from_angle(steer_rad.clamp(-LOCK_RAD, LOCK_RAD) as f32);
        let turned = |off: Vec3| {
            let rolled = turn.rotate(Vec2::new(off.x, off.z));
            steer.rotate(Vec2::new(rolled.x, off.y)).extend(rolled.y)
        };
        let middle = Vec3::new(axle.x, *across_m, axle.y);
        for &i in vertices {
            let i = i as usize;
            mesh.positions[i] = middle + turned(mesh.positions[i] - middle);
            if let Some(normal) = mesh.normals.get_mut(i) {
                *normal = turned(*normal);
            }
        }
    }
}

/// How curved the way of something is at each of its boxes, 1/m, positive to the left: by those at keyframes, and between two of
/// these between; `ways_m` is how far it has rolled.
pub(super) fn curves_per_m(boxes: &[(usize, Cuboid)], ways_m: &[f64], moments: Moments) -> Vec<f64> {
    let known: Vec<usize> = (0..boxes.len()).filter(|i| moments.keyframe(boxes[*i].0).is_some()).collect();
    let yaw_rad = |i: usize| boxes[i].1.world_from_body.yaw_rad();
    let curve = |at: usize| {
        let is_far = |i: &&usize| (ways_m[**i] - ways_m[known[at]]).abs() >= TELLS_M;
        let before = known[..at].iter().rev().find(is_far).unwrap_or(&known[0]);
        let after = known[at..].iter().find(is_far).unwrap_or(&known[known.len() - 1]);
        let way_m = ways_m[*after] - ways_m[*before];
        let turn_rad = (yaw_rad(*after) - yaw_rad(*before) + PI).rem_euclid(TAU) - PI;
        if way_m.abs() < TELLS_M || turn_rad.abs() > FLIP_RAD { 0.0 } else { turn_rad / way_m }
    };
    let curves: Vec<f64> = (0..known.len()).map(curve).collect();
    let between = |i: usize| {
        let next = known.partition_point(|k| *k <= i);
        match (next.checked_sub(1).map(|k| (known[k], curves[k])), known.get(next).zip(curves.get(next))) {
            (Some((a, from)), Some((&b, &to))) => from + (to - from) * (i - a) as f64 / (b - a) as f64,
            (Some((_, only)), None) | (None, Some((_, &only))) => only,
            (None, None) => 0.0,
        }
    };
    (0..boxes.len()).map(between).collect()
}

/// How far the wheel behind all others turns on a way, radians.
pub(super) fn turned_rad(wheels: &[Wheel], way_m: f64) -> f64 {
    let rear = wheels.iter().min_by(|a, b| a.axle.x.total_cmp(&b.axle.x));
    rear.map_or(0.0, |rear| way_m / f64::from(rear.radius_m))
}

/// How far something has rolled along its heading since its first box, metres, for each of its boxes. At keyframes that
/// depends on keyframes alone, and between two of these the way is shared out as the moments between go on.
pub(super) fn ways_m(boxes: &[(usize, Cuboid)], moments: Moments) -> Vec<f64> {
    let mut ways_m = vec![0.0; boxes.len()];
    let mut last = 0;
    for i in 1..boxes.len() {
        if moments.keyframe(boxes[i].0).is_none() && i + 1 < boxes.len() {
            continue;
        }
        let whole_m = ahead_m(&boxes[last].1, &boxes[i].1);
        let mut sums_m = vec![0.0];
        for pair in boxes[last..=i].windows(2) {
            sums_m.push(sums_m[sums_m.len() - 1] + ahead_m(&pair[0].1, &pair[1].1));
        }
        let sum_m = sums_m[sums_m.len() - 1];
        let share = if sum_m.abs() > 1e-9 { whole_m / sum_m } else { 0.0 };
        for (way_m, sum_m) in (last + 1..i).zip(&sums_m[1..]) {
            ways_m[way_m] = ways_m[last] + sum_m * share;
        }
        ways_m[i] = ways_m[last] + whole_m;
        last = i;
    }
    ways_m
}

/// How far a box is ahead of another, along the heading between theirs.
fn ahead_m(from: &Cuboid, to: &Cuboid) -> f64 {
    let heading = |cuboid: &Cuboid| DVec2::from_angle(cuboid.world_from_body.yaw_rad());
    let along = (heading(from) + heading(to)).try_normalize().unwrap_or(heading(from));
    (to.world_from_body.translation - from.world_from_body.translation).truncate().dot(along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use std::f32::consts::TAU;
    use trove_model::Pose;

    /// A band about an axle, as wide as told.
    fn band(mesh: &mut Mesh, middle: Vec3, radius_m: f32, half_m: f32) {
        let first = mesh.positions.len() as u32;
        for i in 0..24 {
            let rim = Vec2::from_angle(TAU * i as f32 / 24.0) * radius_m;
            for y in [-half_m, half_m] {
                mesh.positions.push(middle + Vec3::new(rim.x, y, rim.y));
                mesh.normals.push(Vec3::new(rim.x, 0.0, rim.y) / radius_m);
            }
        }
        for i in 0..24 {
            let [a, b, c, d] = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3].map(|i| first + i % 48);
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }

    /// A body that hides no wheel: two bands with a hub each, and a slab between and above them.
    fn cart() -> Mesh {
        let mut mesh = Mesh::default();
        for x in [-1.0, 1.0] {
            band(&mut mesh, Vec3::new(x, 0.8, 0.3), 0.3, 0.1);
            band(&mut mesh, Vec3::new(x, 0.8, 0.3), 0.08, 0.12);
        }
        // A spare wheel on the slab does not stand on the ground.
        band(&mut mesh, Vec3::new(0.0, 0.0, 1.2), 0.3, 0.1);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([Vec3::new(-2.0, 0.8, 0.3), Vec3::new(2.0, 0.8, 0.3), Vec3::new(0.0, -0.8, 0.9)]);
        mesh.normals.extend([Vec3::Z; 3]);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh
    }

    fn rolled(mesh: &Mesh, wheels: &[Wheel], way_m: f64) -> Mesh {
        let mut mesh = mesh.clone();
        roll(&mut mesh, wheels, way_m, 0.0);
        mesh
    }

    #[test]
    fn what_is_round_and_stands_on_the_ground_turns_with_its_hub_and_nothing_else_does() {
        let mesh = cart();
        let found = wheels(&mesh, &parts(&mesh));
        let [rear, front] = &found[..] else { panic!("{found:?}") };
        assert_eq!((rear.vertices.clone(), front.vertices.clone()), ((0..96).collect(), (96..192).collect()));
        assert!((rear.axle - Vec2::new(-1.0, 0.3)).length() < 1e-6 && (rear.radius_m - 0.3).abs() < 1e-6);
        // A quarter of a turn: what was on top is in front, and the lowest point was the front one.
        let turned = rolled(&mesh, &found, std::f64::consts::TAU * 0.3 / 4.0);
        let [top, front, low] = [6, 0, 18].map(|step| 2 * step);
        assert!(turned.positions[top].distance(mesh.positions[front]) < 1e-6);
        assert!(turned.positions[front].distance(mesh.positions[low]) < 1e-6);
        assert!(turned.normals[top].distance(Vec3::X) < 1e-6);
        assert_eq!(turned.positions[192..], mesh.positions[192..]);
    }

    #[test]
    fn front_wheels_steer_along_the_circle_that_is_driven() {
        // Two carts' halves: wheels in pairs, 2 m apart along the vehicle.
        let mut mesh = cart();
        for x in [-1.0, 1.0] {
            band(&mut mesh, Vec3::new(x, -0.8, 0.3), 0.3, 0.1);
        }
        let found = wheels(&mesh, &parts(&mesh));
        assert_eq!(found.iter().filter(|wheel| wheel.ahead_m == Some(2.0)).count(), 2, "{found:?}");
        // About the point on the rear axle's line from which the circle is driven, every tread point of a front wheel's middle
        // plane is as far as the others.
        for radius_m in [6.0, -15.0] {
            let mut steered = mesh.clone();
            roll(&mut steered, &found, 0.7, 1.0 / radius_m);
            for wheel in &found {
                let middle = Vec3::new(wheel.axle.x, wheel.across_m, wheel.axle.y);
                let axis = |mesh: &Mesh| {
                    let [a, b] = [0, 1].map(|i| mesh.positions[wheel.vertices[i] as usize]);
                    (b - a).truncate().normalize()
                };
                let turned_rad = f64::from(axis(&mesh).angle_to(axis(&steered)));
                let expected_rad = if wheel.ahead_m.is_some() { (2.0 / radius_m).atan() } else { 0.0 };
                assert!((turned_rad - expected_rad).abs() < 1e-5, "{radius_m} {turned_rad} {expected_rad}");
                let rims = wheel.vertices.iter().map(|i| steered.positions[*i as usize].distance(middle));
                assert!(rims.fold(0.0, f32::max) < 0.32);
            }
        }
        // A circle as boxes tell it, at keyframes and between, and a stop on it.
        let drive = testing::drive();
        let angle = |k: usize| 0.25 * k.min(6) as f64;
        let on = |k: usize| Pose::from_yaw(angle(k), 12.0 * glam::DVec3::new(angle(k).sin(), -angle(k).cos(), 0.0));
        let boxes: Vec<(usize, Cuboid)> =
            (0..10).map(|k| (k, Cuboid { world_from_body: on(k), size_m: glam::DVec3::ONE })).collect();
        let moments = Moments::of_keyframes(&drive);
        let curves = curves_per_m(&boxes, &ways_m(&boxes, moments), moments);
        assert!(curves.iter().all(|curve| (curve - 1.0 / 12.0).abs() < 0.001), "{curves:?}");
    }

    #[test]
    fn the_lowest_point_of_a_rolling_wheel_stands_still() {
        let mesh = cart();
        let found = wheels(&mesh, &parts(&mesh));
        let step_m = 1e-3;
        let low = 2 * 18;
        let moved = rolled(&mesh, &found, step_m).positions[low] + Vec3::X * step_m as f32 - mesh.positions[low];
        assert!(moved.length() < 5e-6, "{moved}");
    }

    #[test]
    fn wheels_stand_at_keyframes_as_they_do_without_moments_between() {
        let drive = testing::drive();
        let boxes = &drive.tracks[1].boxes;
        let alone = ways_m(boxes, Moments::of_keyframes(&drive));
        assert!((alone[9] - 45.0).abs() < 1e-9 && alone.is_sorted());
        let timeline = crate::between::between(drive.clone(), 10.0, &trove_model::Report::default());
        let moments = timeline.moments();
        let among = ways_m(&moments.drive.tracks[1].boxes, moments);
        for (k, way_m) in alone.iter().enumerate() {
            assert_eq!(among[moments.of_keyframe(k)], *way_m);
        }
        assert!(among.windows(2).all(|pair| (pair[1] - pair[0] - 1.0).abs() < 1e-6), "{among:?}");
        // Backwards.
        let mut back = boxes.clone();
        back.iter_mut().for_each(|(_, c)| {
            c.world_from_body = Pose::from_yaw(std::f64::consts::PI, c.world_from_body.translation);
        });
        assert!((ways_m(&back, Moments::of_keyframes(&drive))[9] + 45.0).abs() < 1e-9);
    }
}
