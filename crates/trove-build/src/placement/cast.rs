//! Which asset stands for which object.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec3};
use trove_model::{
    Asset, AssetLibrary, Class, Cuboid, Drive, Keyframe, Kind, Outcome, Outdoors, Pose, Report, Seed, Track,
};

use super::choice::{self, Candidate, ObjectFit, draw, measure, object_fit, ranked};
use super::fit::Fit;
use super::gait::{Gait, Mode};
use super::rows::rows;
use super::shown::Shown;
use super::stand::{Placement, Stand};
use crate::between::Moments;
use crate::place::Seeds;

/// A living thing annotated higher than this above the ground stands on something, metres.
const PLATFORM_M: f64 = 0.6;
/// Anything annotated higher than this is on another level, metres.
const STOREY_M: f64 = 2.0;

/// An object of the drive with its asset: the same at every keyframe.
#[derive(Clone, Debug)]
pub(crate) struct Role<'a> {
    /// What stands for it: the same over all its keyframes but for the posture of people.
    pub asset: &'a Asset,
    /// How it is made to fit.
    pub fit: Fit,
    /// Draws its paints, its wear and what it carries.
    pub seed: Seed,
    /// It moves by itself or is ridden at some time.
    pub is_driven: bool,
    /// Where it stands, by moment, in the order of time.
    pub placements: Vec<(usize, Placement)>,
    /// What is seen of it at each of the placements.
    pub postures: Vec<Shown<'a>>,
}

impl Role<'_> {
    /// From the asset's mesh to World where it was placed, turned to the left in its box.
    pub(crate) fn world_from_mesh(&self, placement: &Placement, turn_rad: f64) -> DAffine3 {
        placement.world_from_base * DAffine3::from_rotation_z(turn_rad) * self.fit.body_from_mesh()
    }
}

/// Who plays whom, and how well they fit.
pub(crate) struct Cast<'a> {
    /// For every track, and last for the recording vehicle; `None` where the library has nothing of the kind.
    pub roles: Vec<Option<Role<'a>>>,
    /// For every track that has an asset.
    pub fits: Vec<ObjectFit>,
}

/// What assets are chosen with.
pub(crate) struct Casting<'a, 'b> {
    /// Its boxes decide who is cast, and its recording vehicle is cast too.
    pub drive: &'b Drive,
    /// When they are seen.
    pub moments: Moments<'b>,
    /// Who there is, as far as they are dressed for what it is like outdoors or nobody of their kind is.
    pub library: &'a AssetLibrary,
    /// What it is like outdoors.
    pub outdoors: Outdoors,
    /// The ground.
    pub stand: Stand<'b>,
    /// An asset is drawn among the best so many.
    pub top_k: usize,
    /// Where draws come from.
    pub seeds: &'b Seeds,
    /// What could not be cast.
    pub report: &'b Report,
}

/// What a track is cast by beside its boxes.
struct Part<'a> {
    /// Its boxes at all moments, by moment; `None` where these are the keyframes.
    at_moments: Option<&'a Track>,
    /// The token of the first of its row, and the row's middle size.
    row: (&'a str, DVec3),
    /// Its speed, for whom a single box shows none; `None` where that is not known.
    alone_mps: Option<f64>,
}

impl<'a> Casting<'a, '_> {
    /// Chooses an asset for every track but for those that are `absent`, and for the recording vehicle.
    pub(crate) fn recorded(&self, absent: &BTreeSet<usize>) -> Cast<'a> {
        let tracks = &self.drive.tracks;
        let mut fits = Vec::new();
        let mut roles = Vec::with_capacity(tracks.len() + 1);
        let rows = rows(tracks);
        for (i, (track, &first)) in tracks.iter().zip(&rows).enumerate() {
            if absent.contains(&i) {
                roles.push(None);
                continue;
            }
            let boxes = self.sound_boxes(track);
            let cast = median_size_m(&boxes).and_then(|size_m| {
                // A row is of one make, which fits its middle size.
                let row_size_m = row_size_m(self.drive, &rows, first).unwrap_or(size_m);
                let part = Part {
                    at_moments: self.moments.are_between().then(|| self.moments.drive.tracks.get(i)).flatten(),
                    row: (&tracks[first].token, row_size_m),
                    alone_mps: self.annotated_mps(i, track),
                };
                self.role(track, &boxes, size_m, &part)
            });
            roles.push(cast.map(|(role, fit)| {
                fits.push(fit);
                role
            }));
        }
        measure(&fits, self.report);
        roles.push(self.ego());
        Cast { roles, fits }
    }

    /// Chooses an asset for someone whom nobody recorded, of whom there are boxes at keyframes and at all moments.
    pub(crate) fn added(&self, track: &Track, at_moments: Option<&Track>, speed_mps: f64) -> Option<Role<'a>> {
        let boxes = self.sound_boxes(track);
        let size_m = median_size_m(&boxes)?;
        let part = Part { at_moments, row: (&track.token, size_m), alone_mps: Some(speed_mps) };
        Some(self.role(track, &boxes, size_m, &part)?.0)
    }

    /// The speed that the annotation of a track's first box states.
    fn annotated_mps(&self, track: usize, Track { boxes, .. }: &Track) -> Option<f64> {
        let &(keyframe, _) = boxes.first()?;
        let object = self.drive.keyframes.get(keyframe)?.boxes.iter().find(|b| b.track == track)?;
        Some(object.velocity_mps?.truncate().length())
    }

    fn sound_boxes(&self, track: &Track) -> Vec<(usize, Cuboid)> {
        let boxes: Vec<(usize, Cuboid)> = track.boxes.iter().filter(|(_, c)| is_sound(c)).copied().collect();
        for _ in boxes.len()..track.boxes.len() {
            let what = "box without size or with non-finite numbers";
            self.report.note(Outcome::Dropped, what, &track.token);
        }
        boxes
    }

    fn role(
        &self,
        track: &Track,
        boxes: &[(usize, Cuboid)],
        size_m: DVec3,
        part: &Part,
    ) -> Option<(Role<'a>, ObjectFit)> {
        let Self { drive, moments, library, outdoors, stand, top_k, seeds, report } = *self;
        let (first, row_size_m) = part.row;
        let seed = individual_seed(track.kind, seeds).child(&track.token);
        let row_seed = choice_seed(track.kind, seeds).child(first);
        let gait = Gait::new(drive, boxes, size_m, track.kind, part.alone_mps);
        let of_kind = |mode: Mode| library.of_kind(track.kind).filter(move |asset| mode.allows(asset));
        let mut ranked = ranked(of_kind(gait.main_mode()), row_size_m, track.kind);
        if ranked.is_empty() {
            ranked = choice::ranked(library.of_kind(track.kind), row_size_m, track.kind);
        }
        let Some(Candidate { asset, .. }) = draw(&ranked, top_k, row_seed) else {
            report.note(
                Outcome::Dropped,
                &format!("object without an asset of kind {}", track.kind.name()),
                &track.token,
            );
            return None;
        };
        if !asset.suits(outdoors) {
            let what = format!("{} in clothes for other weather, since the library has no others", track.kind.name());
            report.note(Outcome::Substituted, &what, &track.token);
        }
        let fit = Fit::new(asset.size_m, size_m, track.kind);
        let stays_up = stays_up(track, boxes, &stand, report);
        let place = |(k, cuboid): &(usize, Cuboid)| {
            (*k, if stays_up { stand.keep(cuboid) } else { stand.place(cuboid, track.kind) })
        };
        let is_driven = gait.moves();
        let (placements, gait) = match part.at_moments {
            None => (boxes.iter().map(place).collect(), gait),
            Some(at_moments) => {
                let at_moments: Vec<_> = at_moments.boxes.iter().filter(|(_, c)| is_sound(c)).copied().collect();
                let gait = gait.at_moments(moments, boxes, &at_moments);
                (at_moments.iter().map(place).collect(), gait)
            }
        };
        let postures = gait.postures(asset, library.of_kind(track.kind), fit.scale.x, seed);
        let role = Role { asset, fit, seed, is_driven, placements, postures };
        Some((role, object_fit(track, size_m, &Candidate { asset, fit }, &ranked)))
    }

    /// The recording vehicle at every moment, in its own body.
    fn ego(&self) -> Option<Role<'a>> {
        let Self { drive, moments, library, stand, top_k, seeds, .. } = *self;
        let body = drive.ego_body;
        let ranked = ranked(library.of_kind(Kind::Car), body.size_m, Kind::Car);
        let Candidate { asset, fit } = draw(&ranked, top_k, choice_seed(Kind::Car, seeds).child("ego"))?;
        let seed = individual_seed(Kind::Car, seeds).child("ego");
        let place = |(k, keyframe): (usize, &Keyframe)| (k, stand.place(&ego_cuboid(drive, keyframe), Kind::Car));
        let placements: Vec<(usize, Placement)> = moments.drive.keyframes.iter().enumerate().map(place).collect();
        let postures = vec![asset.into(); placements.len()];
        Some(Role { asset, fit, seed, is_driven: true, placements, postures })
    }
}

/// The recording vehicle's own box at a keyframe.
pub(crate) fn ego_cuboid(drive: &Drive, keyframe: &Keyframe) -> Cuboid {
    let (ego, body) = (keyframe.world_from_ego, drive.ego_body);
    Cuboid { world_from_body: Pose::new(ego.rotation, ego.point(body.centre_ego)), size_m: body.size_m }
}

/// Whether a track's annotated height is believed rather than the ground: over the whole drive its boxes are well above
/// it. Annotations wander by some decimetres where the recording has no heights, so only those of living things, which
/// do stand on platforms and steps, are believed below a storey's height.
fn stays_up(track: &Track, boxes: &[(usize, Cuboid)], stand: &Stand, report: &Report) -> bool {
    let mut lifts_m: Vec<f64> = boxes.iter().map(|(_, c)| stand.lift_m(c)).collect();
    lifts_m.sort_by(f64::total_cmp);
    let lift_m = lifts_m.get(lifts_m.len() / 2).copied().unwrap_or(0.0);
    let alive = matches!(track.kind.class(), Class::Human) || track.kind == Kind::Animal;
    let stays_up = lift_m > if alive { PLATFORM_M } else { STOREY_M };
    let example = || format!("{} ({}), {lift_m:.1} m", track.token, track.kind.name());
    if stays_up {
        report.note(Outcome::Warned, "object left above the ground, as annotated", example());
    } else if lift_m.abs() > PLATFORM_M {
        report.note(Outcome::Substituted, "annotated height far from the ground, replaced by the ground", example());
    }
    stays_up
}

/// What a model of a kind is drawn from.
fn choice_seed(kind: Kind, seeds: &Seeds) -> Seed {
    if kind.class() == Class::Human { seeds.people } else { seeds.assets }.child("cast")
}

/// What the paints, the wear, the extras and the postures of an individual are drawn from.
fn individual_seed(kind: Kind, seeds: &Seeds) -> Seed {
    if kind.is_vehicle() { seeds.paint.child("cast") } else { choice_seed(kind, seeds) }
}

fn is_sound(cuboid: &Cuboid) -> bool {
    cuboid.world_from_body.is_finite() && cuboid.size_m.is_finite() && cuboid.size_m.min_element() > 0.0
}

/// The middle size of the sound boxes of the row whose first track this is.
fn row_size_m(drive: &Drive, rows: &[usize], first: usize) -> Option<DVec3> {
    let of_row = drive.tracks.iter().zip(rows).filter(|(_, row)| **row == first);
    let boxes: Vec<(usize, Cuboid)> =
        of_row.flat_map(|(t, _)| &t.boxes).filter(|(_, c)| is_sound(c)).copied().collect();
    median_size_m(&boxes)
}

/// The middle length, width and height of boxes; `None` without boxes.
fn median_size_m(boxes: &[(usize, Cuboid)]) -> Option<DVec3> {
    let median = |axis: usize| {
        let mut sides: Vec<f64> = boxes.iter().map(|(_, c)| c.size_m[axis]).collect();
        sides.sort_by(f64::total_cmp);
        sides.get(sides.len() / 2).copied()
    };
    Some(DVec3::new(median(0)?, median(1)?, median(2)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::RoadSurfaces;
    use crate::testing;
    use glam::DVec2;
    use trove_model::{HeightField, Raster};

    fn slope() -> HeightField {
        let nodes = Raster::from_fn(41, 41, |x, y| 0.05 * x as f32 - 0.02 * y as f32);
        HeightField { origin: DVec2::splat(-200.0), cell_m: 10.0, nodes }
    }

    fn surfaces() -> RoadSurfaces {
        testing::surfaces(&testing::drive(), &slope())
    }

    fn cast<'a>(
        drive: &Drive,
        library: &'a AssetLibrary,
        stand: Stand,
        top_k: usize,
        seed: Seed,
        report: &Report,
    ) -> Vec<Option<Role<'a>>> {
        let seeds = seed.into();
        let moments = Moments::of_keyframes(drive);
        let outdoors = Outdoors::Cold;
        Casting { drive, moments, library, outdoors, stand, top_k, seeds: &seeds, report }
            .recorded(&BTreeSet::new())
            .roles
    }

    fn roles<'a>(library: &'a AssetLibrary, top_k: usize, seed: Seed, report: &Report) -> Vec<Option<Role<'a>>> {
        let (ground, surfaces) = (slope(), surfaces());
        let stand = Stand { ground: &ground, surfaces: &surfaces };
        cast(&testing::drive(), library, stand, top_k, seed, report)
    }

    #[test]
    fn everything_stands_on_the_ground_with_its_heading_kept() {
        let (library, drive, ground) = (testing::library(), testing::drive(), slope());
        for (track, role) in roles(&library, 3, Seed(1), &Report::default()).iter().enumerate() {
            let role = role.as_ref().unwrap();
            for (k, placement) in &role.placements {
                let foot_world = role.world_from_mesh(placement, 0.0).transform_point3(DVec3::ZERO);
                let kerb_m = if role.asset.kind == Kind::Adult { crate::roads::KERB_M } else { 0.0 };
                let surface_m = ground.height_m(foot_world.truncate()) + kerb_m;
                assert!((foot_world.z - surface_m).abs() < 1e-3, "{} at {k}: {foot_world}", role.asset.id);
                if let Some(annotated) = drive.tracks.get(track).and_then(|t| t.at(*k)) {
                    let turn = placement.cuboid.world_from_body.yaw_rad() - annotated.world_from_body.yaw_rad();
                    assert!(turn.sin().abs() < 1e-3);
                    assert_eq!(placement.cuboid.size_m, annotated.size_m);
                    let bottom = DVec3::NEG_Z * annotated.size_m.z / 2.0;
                    let bottom_world = placement.cuboid.world_from_body.point(bottom);
                    let (at, below_m) = (bottom_world.truncate(), ground.height_m(bottom_world.truncate()) + kerb_m);
                    assert!((bottom_world.z - below_m).abs() < 1e-3, "{} at {k}: {at}", role.asset.id);
                }
            }
        }
    }

    #[test]
    fn the_best_asset_is_taken_and_among_the_best_the_track_decides() {
        let (library, report) = (testing::library(), Report::default());
        let best = roles(&library, 1, Seed(1), &report);
        assert_eq!(best[0].as_ref().unwrap().asset.id, best[1].as_ref().unwrap().asset.id);
        let drawn: Vec<String> =
            (0..20).map(|s| roles(&library, 3, Seed(s), &report)[0].as_ref().unwrap().asset.id.clone()).collect();
        assert!(drawn.iter().any(|id| *id != drawn[0]));
        assert!(drawn.iter().all(|id| id != "car/limousine"));
        let differs = |s| {
            let roles = roles(&library, 3, Seed(s), &report);
            roles[0].as_ref().unwrap().asset.id != roles[1].as_ref().unwrap().asset.id
        };
        assert!((0..20).any(differs));
    }

    #[test]
    fn a_kind_without_an_asset_is_reported() {
        let library = AssetLibrary {
            assets: vec![testing::asset("car/a", Kind::Car, [4.5, 1.8, 1.5])],
            ..AssetLibrary::default()
        };
        let report = Report::default();
        let roles = roles(&library, 3, Seed(1), &report);
        assert!(roles[2].is_none() && roles[3].is_none());
        assert!(report.entries().iter().any(|e| e.outcome == Outcome::Dropped && e.what.contains("truck")));
    }

    #[test]
    fn someone_on_a_platform_stays_there_and_a_car_annotated_too_high_does_not() {
        let (library, ground, surfaces, report) = (testing::library(), slope(), surfaces(), Report::default());
        let mut drive = testing::drive();
        for track in [0, 3] {
            for (_, cuboid) in &mut drive.tracks[track].boxes {
                let position = cuboid.world_from_body.translation.truncate();
                let z = ground.height_m(position) + 1.0 + cuboid.size_m.z / 2.0;
                cuboid.world_from_body.translation.z = z;
            }
        }
        let stand = Stand { ground: &ground, surfaces: &surfaces };
        let roles = cast(&drive, &library, stand, 1, Seed(1), &report);
        let rise_m = |track: usize| {
            let placed = roles[track].as_ref().unwrap().placements[0].1.cuboid.world_from_body.translation;
            drive.tracks[track].boxes[0].1.world_from_body.translation.z - placed.z
        };
        assert!(rise_m(3).abs() < 1e-9);
        assert!((rise_m(0) - 1.0).abs() < 0.02, "{}", rise_m(0));
        let whats: Vec<Outcome> = report.entries().iter().map(|e| e.outcome).collect();
        assert_eq!(whats, [Outcome::Substituted, Outcome::Warned]);
    }
}
