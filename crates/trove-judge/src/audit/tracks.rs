//! Objects over views and times.

use std::collections::BTreeMap;

use glam::DVec3;
use trove_format::{ObjectOrigin, ObjectRow};
use trove_model::Class;

use super::finding::{Check, Notes};
use super::frame::LabelledFrame;
use super::single::position;

/// Nothing on a road is faster, metres per second.
const FASTEST_MPS: f64 = 90.0;
/// No vehicle gains or loses more speed than braking tyres and crashes' first instants allow, m/s²; annotators are a few
/// decimetres out, so displacements are given room besides.
const MOST_MPS2: f64 = 15.0;
const ANNOTATED_M: f64 = 1.0;

/// What an id was when it was last seen.
#[derive(Clone, Debug)]
struct Known {
    place: String,
    identity: Identity,
    at: Vec<(i64, DVec3)>,
}

/// What never changes of an object.
#[derive(Clone, Debug, PartialEq)]
struct Identity {
    token: String,
    class: Class,
    origin: ObjectOrigin,
}

impl Identity {
    fn of(object: &ObjectRow) -> Self {
        let ObjectRow { class, origin, .. } = *object;
        Self { token: object.track_token.clone(), class, origin }
    }
}

/// The objects of a variation, as far as its moments have been looked at, in the order of time.
#[derive(Debug, Default)]
pub(super) struct Tracks {
    known: BTreeMap<u32, Known>,
}

impl Tracks {
    /// Looks at a frame; frames of one moment come one after another.
    pub(super) fn check(&mut self, frame: &LabelledFrame, notes: &mut Notes) {
        notes.look(Check::Tracks);
        let now = frame.table.keyframe_time_ns;
        for object in &frame.table.objects {
            let (identity, position) = (Identity::of(object), position(object));
            let known = self.known.entry(object.id).or_insert_with(|| Known {
                place: frame.place.clone(),
                identity: identity.clone(),
                at: Vec::new(),
            });
            if known.identity != identity {
                let (was, place) = (&known.identity, &known.place);
                let what = format!("object {}: expected {was:?} as in {place}, found {identity:?}", object.id);
                notes.wrong(Check::Tracks, what);
                known.identity = identity;
                known.at.clear();
            }
            match known.at.last() {
                Some((time, at)) if *time == now => {
                    if at.distance(position) > 0.01 {
                        let what = format!(
                            "object {}: expected one place at one moment, found {at} and {position}",
                            object.id
                        );
                        notes.wrong(Check::Tracks, what);
                    }
                    continue;
                }
                _ => known.at.push((now, position)),
            }
            if let Some(what) = jump(&known.at) {
                notes.wrong(Check::Tracks, format!("object {}: {what}", object.id));
            }
            let more = known.at.len().saturating_sub(3);
            known.at.drain(..more);
        }
    }
}

/// What is wrong with the last of an object's places.
pub(super) fn jump(at: &[(i64, DVec3)]) -> Option<String> {
    let seconds = |a: i64, b: i64| (b - a) as f64 * 1e-9;
    let [.., (before, from), (now, to)] = at else { return None };
    let time_s = seconds(*before, *now);
    let apart_m = from.distance(*to);
    if apart_m > FASTEST_MPS * time_s + ANNOTATED_M {
        return Some(format!("expected to move smoothly, found {apart_m:.1} m in {time_s:.2} s"));
    }
    let [.., (earlier, first), _, _] = at else { return None };
    let before_s = seconds(*earlier, *before);
    // Across gaps nothing is known of what happened between.
    if time_s > 1.0 || before_s > 1.0 {
        return None;
    }
    let expected = *from + (*from - *first) * (time_s / before_s);
    let room_m = 0.5 * MOST_MPS2 * time_s * (time_s + before_s) + ANNOTATED_M;
    let off_m = expected.distance(*to);
    (off_m > room_m).then(|| format!("expected to go on as before within {room_m:.1} m, found it {off_m:.1} m off"))
}
