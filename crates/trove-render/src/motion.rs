//! Where an instance is while the shutter is open.

use glam::{Affine3A, DAffine3, DMat3};
use trove_model::SensorRay;

/// Motion is known this long before and after the moment of the labels, seconds; beyond it things stand.
const SPAN_S: f64 = SensorRay::MOVING_S;

/// A ray's time at the moment of the labels, of 0 (`SPAN_S` before it) to 1 (after it).
pub(crate) const MIDDLE: f32 = trove_trace::Motion::MIDDLE;

/// A ray's time some seconds after the moment of the labels.
pub(crate) fn ray_time(seconds: f64) -> f32 {
    (0.5 + seconds / (2.0 * SPAN_S)).clamp(0.0, 1.0) as f32
}

/// `world_from_mesh` over time, in the renderer's precision or the model's: two straight stretches that meet at the moment
/// of the labels.
#[derive(Clone, Copy)]
pub(crate) struct Motion<A = Affine3A> {
    pub(crate) middle: A,
    /// At times 0 and 1; `None` for what stands.
    pub(crate) ends: Option<[A; 2]>,
}

impl Motion<DAffine3> {
    /// From the placements at the previous keyframe and at the next one and their distances in time, seconds; where one
    /// is missing the motion of the other stretch goes on.
    pub(crate) fn new(middle: DAffine3, neighbours: [Option<DAffine3>; 2], apart_s: [f64; 2]) -> Self {
        let towards = |i: usize| {
            let share = SPAN_S / apart_s[i];
            let other = neighbours[i]?;
            let step = DAffine3 {
                matrix3: (other.matrix3 - middle.matrix3) * share,
                translation: (other.translation - middle.translation) * share,
            };
            (share > 0.0 && other != middle).then_some(step)
        };
        let steps = match [towards(0), towards(1)] {
            [None, None] => None,
            [Some(before), None] if neighbours[1].is_none() => Some([before, back(before)]),
            [None, Some(after)] if neighbours[0].is_none() => Some([back(after), after]),
            steps => Some(steps.map(|step| step.unwrap_or(DAffine3::ZERO))),
        };
        Self { middle, ends: steps.map(|steps| steps.map(|step| end(&middle, step))) }
    }

    /// The same in the renderer's precision.
    pub(crate) fn single(&self) -> Motion {
        Motion { middle: single(&self.middle), ends: self.ends.map(|ends| ends.map(|end| single(&end))) }
    }

    /// At a ray's time.
    pub(crate) fn at(&self, time: f32) -> DAffine3 {
        let Some([before, after]) = self.ends else { return self.middle };
        let (end, share) = if time < MIDDLE { (before, 1.0 - 2.0 * time) } else { (after, 2.0 * time - 1.0) };
        if share == 0.0 {
            return self.middle;
        }
        let share = f64::from(share);
        DAffine3 {
            matrix3: self.middle.matrix3 * (1.0 - share) + end.matrix3 * share,
            translation: self.middle.translation * (1.0 - share) + end.translation * share,
        }
    }
}

impl Motion {
    /// At a ray's time.
    pub(crate) fn at(&self, time: f32) -> Affine3A {
        self.flat().map_or(self.middle, |motion| motion.at(time))
    }

    /// As kernels keep it; `None` for what stands.
    pub(crate) fn flat(&self) -> Option<trove_trace::Motion> {
        Some(trove_trace::Motion { middle: self.middle, ends: self.ends? })
    }

    /// Every placement through which it goes lies between these.
    pub(crate) fn corners(&self) -> impl Iterator<Item = Affine3A> {
        std::iter::once(self.middle).chain(self.ends.into_iter().flatten())
    }
}

/// Half a turn between keyframes would squeeze what turns on a straight line: it only moves along.
fn end(middle: &DAffine3, step: DAffine3) -> DAffine3 {
    let turned = middle.matrix3 + step.matrix3;
    let squeezed = turned.determinant() / middle.matrix3.determinant();
    let matrix3 = if squeezed > 0.5 { turned } else { middle.matrix3 };
    DAffine3 { matrix3, translation: middle.translation + step.translation }
}

fn back(step: DAffine3) -> DAffine3 {
    DAffine3 { matrix3: -step.matrix3, translation: -step.translation }
}

fn single(m: &DAffine3) -> Affine3A {
    let DMat3 { x_axis, y_axis, z_axis } = m.matrix3;
    Affine3A::from_cols(x_axis.as_vec3a(), y_axis.as_vec3a(), z_axis.as_vec3a(), m.translation.as_vec3a())
}
