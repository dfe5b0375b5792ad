//! What shapes say about which way a thing looks. Points are level in x and y around the middle of their box, and a
//! height is 1.

use glam::{Vec2, Vec3, vec2};
use trove_model::Kind;

use super::evidence::Evidence;
use super::samples::Sample;

/// Slices along a vehicle's length.
const BINS: usize = 48;

fn mean(points: impl Iterator<Item = Vec3>) -> Option<Vec3> {
    let (sum, count) = points.fold((Vec3::ZERO, 0.0), |(sum, count), p| (sum + p, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// Slopes, hood, cabin, mirrors, handlebars and tail lamps; `length` is the level direction of the vehicle's length.
pub(super) fn vehicle(points: &[Sample], length: Vec2, kind: Kind) -> Vec<Evidence> {
    let across = vec2(-length.y, length.x);
    let half = points.iter().map(|s| s.at.truncate().dot(length).abs()).fold(1e-6, f32::max);
    let bin = |s: &Sample| (((s.at.truncate().dot(length) / half + 1.0) / 2.0 * BINS as f32) as usize).min(BINS - 1);
    let mut tops = [0.0f32; BINS];
    let mut widths = [0.0f32; BINS];
    let body = points.iter().filter(|s| (0.3..0.8).contains(&s.at.z));
    body.for_each(|s| widths[bin(s)] = widths[bin(s)].max(s.at.truncate().dot(across).abs()));
    points.iter().for_each(|s| tops[bin(s)] = tops[bin(s)].max(s.at.z));
    let mut sorted = tops;
    sorted.sort_by(f32::total_cmp);
    // Beacons and aerials stand above the roof.
    let roof = sorted[BINS * 4 / 5];
    let towards = |score: f32, reason| Evidence { towards: length * score, either: false, reason };
    let two_wheels =
        matches!(kind, Kind::Bicycle | Kind::BicycleWithRider | Kind::Motorcycle | Kind::MotorcycleWithRider);
    if two_wheels {
        return bars(points, length, half).map(|score| towards(score, "the handlebar")).into_iter().collect();
    }
    let mut evidence = Vec::new();
    // A windscreen leans more than a rear window: where the outline passes from the hood's height to the roof's.
    let run = |bins: &mut dyn Iterator<Item = f32>| {
        let outline: Vec<f32> = bins.collect();
        let first = |height: f32| outline.iter().position(|t| *t >= height * roof).unwrap_or(0) as f32;
        (first(0.93) - first(0.7)) / BINS as f32
    };
    let (back, fore) = (run(&mut tops.into_iter()), run(&mut tops.into_iter().rev()));
    evidence.push(towards(((fore - back) * 10.0).clamp(-1.0, 1.0), "the slope of its windscreen"));
    let ends = |range: std::ops::Range<usize>| tops[range].iter().map(|t| t.min(roof)).sum::<f32>() / (BINS / 5) as f32;
    let lower_front = (ends(0..BINS / 5) - ends(BINS - BINS / 5..BINS)) / roof.max(1e-6);
    evidence.push(towards((lower_front * 5.0).clamp(-1.5, 1.5), "its hood"));
    let high: Vec<f32> =
        (0..BINS).filter(|&i| tops[i] > 0.9 * roof).map(|i| (i as f32 + 0.5) / BINS as f32 * 2.0 - 1.0).collect();
    let cabin = high.iter().sum::<f32>() / high.len().max(1) as f32;
    let weight = if kind == Kind::Car || kind == Kind::PoliceCar { 3.0 } else { 1.5 };
    evidence.push(towards((-cabin * weight).clamp(-1.0, 1.0), "where its cabin is"));
    evidence.extend(mirrors(&widths, cabin, kind).map(|score| towards(score, "its mirrors")));
    let red = |s: &Sample| s.color.x > 0.12 && s.color.x > 3.0 * s.color.y && s.color.x > 3.0 * s.color.z;
    let share = |sign: f32| {
        let end = || points.iter().filter(|s| s.at.truncate().dot(length) * sign > 0.93 * half && s.at.z > 0.2);
        end().filter(|s| red(s)).count() as f32 / end().count().max(1) as f32
    };
    evidence.push(towards(((share(-1.0) - share(1.0)) * 6.0).clamp(-1.0, 1.0), "red lamps at its rear"));
    evidence
}

/// Mirrors stand out of the sides in a short piece of the length, ahead of a car's cabin and at the head of the rest.
fn mirrors(widths: &[f32; BINS], cabin: f32, kind: Kind) -> Option<f32> {
    let mut sorted = *widths;
    sorted.sort_by(f32::total_cmp);
    let body = sorted[BINS * 3 / 5];
    let wide: Vec<usize> = (0..BINS).filter(|&i| widths[i] > 1.05 * body).collect();
    let (first, last) = (*wide.first()?, *wide.last()?);
    if last - first > BINS / 6 {
        return None;
    }
    let at = (first + last + 1) as f32 / BINS as f32 - 1.0;
    let middle = if kind == Kind::Car || kind == Kind::PoliceCar { cabin } else { 0.0 };
    Some(((at - middle) * 8.0).clamp(-2.0, 2.0))
}

/// Where the upper part is widest: the handlebar.
fn bars(points: &[Sample], length: Vec2, half: f32) -> Option<f32> {
    let across = vec2(-length.y, length.x);
    let upper = || points.iter().filter(|s| s.at.z > 0.6);
    let widest = upper().map(|s| s.at.truncate().dot(across).abs()).fold(0.0, f32::max);
    let wide = upper().filter(|s| s.at.truncate().dot(across).abs() > 0.6 * widest).map(|s| s.at);
    let at = mean(wide)?.truncate().dot(length) / half;
    Some((at * 4.0).clamp(-2.0, 2.0))
}

/// Feet stand out ahead of the shanks, each for itself since one of them may be lifted; the head is held forward.
pub(super) fn person(points: &[Sample]) -> Vec<Evidence> {
    let low = || points.iter().filter(|s| s.at.z < 0.2);
    let mut centres = {
        let far = |sign: f32| low().max_by(|a, b| ((a.at.x + a.at.y) * sign).total_cmp(&((b.at.x + b.at.y) * sign)));
        let (Some(a), Some(b)) = (far(1.0), far(-1.0)) else { return Vec::new() };
        [a.at.truncate(), b.at.truncate()]
    };
    let nearer = |centres: &[Vec2; 2], s: &Sample| {
        usize::from(s.at.truncate().distance_squared(centres[1]) < s.at.truncate().distance_squared(centres[0]))
    };
    for _ in 0..8 {
        let of = |k: usize| mean(low().filter(|s| nearer(&centres, s) == k).map(|s| s.at)).map(Vec3::truncate);
        centres = [of(0).unwrap_or(centres[0]), of(1).unwrap_or(centres[1])];
    }
    let step = |k: usize| {
        let slice = |from: f32, to: f32| {
            mean(low().filter(|s| nearer(&centres, s) == k && (from..to).contains(&s.at.z)).map(|s| s.at))
        };
        Some((slice(0.0, 0.05)? - slice(0.07, 0.14)?).truncate())
    };
    let steps: Vec<Vec2> = [step(0), step(1)].into_iter().flatten().collect();
    let feet = steps.iter().sum::<Vec2>() / steps.len().max(1) as f32;
    let slice = |from: f32, to: f32| mean(points.iter().filter(|s| (from..to).contains(&s.at.z)).map(|s| s.at));
    let head = slice(0.88, 1.01).zip(slice(0.45, 0.6)).map_or(Vec2::ZERO, |(head, hips)| (head - hips).truncate());
    let spoken =
        |towards: Vec2, most: f32, reason| Evidence { towards: towards.clamp_length_max(most), either: false, reason };
    vec![spoken(feet * 40.0, 3.0, "its feet"), spoken(head * 4.0, 0.4, "its head")]
}

/// A sign's plate is mounted before its pole.
pub(super) fn plate(points: &[Sample]) -> Vec<Evidence> {
    let pole = mean(points.iter().filter(|s| s.at.z < 0.4).map(|s| s.at));
    let upper = || points.iter().filter(|s| s.at.z > 0.75);
    let (Some(pole), Some(plate)) = (pole, mean(upper().map(|s| s.at))) else { return Vec::new() };
    // The plate's two faces look along its thin axis.
    let facing = upper().map(|s| s.normal.truncate().abs()).sum::<Vec2>();
    let axis = if facing.x > facing.y { Vec2::X } else { Vec2::Y };
    let offset = (plate - pole).truncate().dot(axis);
    // The face has more colours than the back.
    let variety = |sign: f32| {
        let face = || upper().filter(|s| s.normal.truncate().dot(axis) * sign > 0.8).map(|s| s.color);
        let count = face().count().max(1) as f32;
        let middle = face().sum::<Vec3>() / count;
        face().map(|c| c.distance(middle)).sum::<f32>() / count
    };
    let painted = ((variety(1.0) - variety(-1.0)) * 8.0).clamp(-1.5, 1.5);
    vec![
        Evidence {
            towards: axis * (offset * 200.0).clamp(-1.5, 1.5),
            either: false,
            reason: "its plate in front of the pole",
        },
        Evidence { towards: axis * painted, either: false, reason: "what is painted on it" },
        Evidence { towards: axis * 0.5, either: true, reason: "its plate" },
    ]
}

/// A signal's back is flat; visors and lenses are at its front.
pub(super) fn lamps(points: &[Sample]) -> Vec<Evidence> {
    let mut evidence = flat_back(points, 0.62, 2.0);
    let lens = |s: &&Sample| {
        let c = s.color;
        c.max_element() > 0.1 && c.max_element() > 2.5 * c.min_element()
    };
    let upper = || points.iter().filter(|s| s.at.z > 0.5);
    let colored = upper().filter(lens).map(|s| s.normal.truncate());
    let count = colored.clone().count();
    if count > 30 && count < points.len() / 3 {
        evidence.push(Evidence {
            towards: colored.sum::<Vec2>() / count as f32 * 3.0,
            either: false,
            reason: "its coloured lenses",
        });
    }
    evidence
}

/// Away from where a level side is closed by a flat face.
fn flat_back(points: &[Sample], from_height: f32, weight: f32) -> Vec<Evidence> {
    let upper = || points.iter().filter(|s| s.at.z > from_height);
    let count = upper().count().max(1) as f32;
    [Vec2::X, Vec2::Y]
        .into_iter()
        .map(|axis| {
            let flat = |sign: f32| {
                let far = upper().map(|s| s.at.truncate().dot(axis) * sign).fold(f32::MIN, f32::max);
                let near = upper().map(|s| s.at.truncate().dot(axis) * sign).fold(f32::MAX, f32::min);
                let edge = far - (far - near) * 0.06;
                let face =
                    |s: &&Sample| s.at.truncate().dot(axis) * sign > edge && s.normal.truncate().dot(axis).abs() > 0.9;
                upper().filter(face).count() as f32 / count
            };
            let score = ((flat(-1.0) - flat(1.0)) * 8.0 * weight).clamp(-weight, weight);
            Evidence { towards: axis * score, either: false, reason: "its flat back" }
        })
        .collect()
}

/// A lamp's arm reaches over the road.
pub(super) fn arm(points: &[Sample]) -> Vec<Evidence> {
    let foot = mean(points.iter().filter(|s| s.at.z < 0.3).map(|s| s.at));
    let Some(foot) = foot else { return Vec::new() };
    let reach = |axis: Vec2| {
        let at = |s: &Sample| (s.at - foot).truncate().dot(axis);
        let upper = || points.iter().filter(|s| s.at.z > 0.7);
        (upper().map(at).fold(0.0, f32::max), -upper().map(at).fold(0.0, f32::min))
    };
    [Vec2::X, Vec2::Y]
        .into_iter()
        .flat_map(|axis| {
            let (fore, back) = reach(axis);
            // Both arms of a double lamp say along which axis, the longer one where to.
            [
                Evidence { towards: axis * ((fore - back) * 10.0).clamp(-2.0, 2.0), either: false, reason: "its arm" },
                Evidence { towards: axis * (fore + back) * 4.0, either: true, reason: "its arms" },
            ]
        })
        .collect()
}

/// Benches, shelters and bins are open, low or structured before and closed behind.
pub(super) fn open_side(points: &[Sample]) -> Vec<Evidence> {
    let mut evidence = flat_back(points, 0.1, 0.5);
    let upper = mean(points.iter().filter(|s| s.at.z > 0.65).map(|s| s.at));
    let lower = mean(points.iter().filter(|s| s.at.z < 0.65).map(|s| s.at));
    if let (Some(upper), Some(lower)) = (upper, lower) {
        let towards = ((lower - upper).truncate() * 6.0).clamp_length_max(1.0);
        evidence.push(Evidence { towards, either: false, reason: "it is higher at the back" });
    }
    evidence
}
