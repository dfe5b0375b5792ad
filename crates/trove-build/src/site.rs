//! The static place of one drive, and the scene of each of its moments.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use trove_model::{
    AssetLibrary, Bounds, Cuboid, Drive, DriveOrigin, HeightField, Instance, InstanceId, Kind, Light, Locale, Looks,
    Origin, Outcome, Polygon, Provenance, Puff, Report, RoadPlan, Scene, SceneObject, Season, StreetMap,
};

use crate::agreement::{OnDisagreement, agreed, assumed};
use crate::assembly::{Actor, Assembly, MeshesNow, Movement, Stock, Weather};
use crate::between::Moments;
use crate::error::BuildError;
use crate::furniture::furniture;
use crate::ground::{Drape, Ground, ground};
use crate::light::{LightChoice, is_dark, light, solar_hour, switch_on};
use crate::pieces::Scenery;
use crate::place::{Conditions, Place, Seeds, apart_s, moment_s, next, previous};
use crate::placement::{Cast, Casting, ObjectFit, Stand};
use crate::skyline::skyline;
use crate::snow::lying;
use crate::spray::{film_m, has_tyres, spray};
use crate::surroundings::Clearance;
use crate::surroundings::Kerbs;
use crate::surroundings::Surroundings;
use crate::traffic::Traffic;
use crate::vegetation::{driven_path, undergrowth, vegetation};
use crate::{buildings, roads, traffic};

/// A recorded drive's place is at least this wide, metres, as in the paper's toolkit.
const MIN_SIDE_M: f64 = 600.0;
/// A larger place does not fit into memory beside its pictures, metres.
const MAX_SIDE_M: f64 = 3000.0;
/// LiDAR points further from the sensor do not widen the place, metres.
const LIDAR_REACH_M: f64 = 100.0;
/// Added around everything seen, metres.
const MARGIN_M: f64 = 60.0;

/// Ids are written as 16-bit numbers.
const MAX_ID: u32 = u16::MAX as u32;

/// What decides how a place is built.
#[derive(Clone, Debug)]
pub struct BuildSettings {
    /// Sources of all randomness in it.
    pub seeds: Seeds,
    /// An object's asset is drawn among the best so many; 1 is the best.
    pub top_k: usize,
    /// How many road users there are.
    pub traffic: Traffic,
    /// Where the light comes from.
    pub light: LightChoice,
    /// What weather has done to its surfaces.
    pub weather: Weather,
    /// What becomes of a street map that does not lie on the drive.
    pub on_disagreement: OnDisagreement,
    /// Whether buildings are made up along streets beside which the map has none.
    pub invent: bool,
    /// Whose customs it follows.
    pub locale: Locale,
    /// Where the borders come from that tell so; `None` where a user does.
    pub borders: Option<Provenance>,
}

/// The static place of one drive and variation: ground, roads, buildings, plants, furniture, with the objects' assets
/// chosen.
#[derive(Clone, Debug)]
pub struct Site {
    ground: HeightField,
    stock: Stock,
    /// Everything that stands still, the same at all moments.
    fixed: Vec<Instance>,
    /// The drive's tracks in their order, then the recording vehicle; `None` where no asset stands for it.
    actors: Vec<Option<Actor>>,
    /// Road users whom nobody recorded.
    added: Vec<Added>,
    footprints: Vec<Polygon>,
    roads: RoadPlan,
    light: Light,
    /// Water on its roads.
    film_m: f64,
    season: Season,
    provenance: Vec<Provenance>,
    fits: Vec<ObjectFit>,
}

/// A road user whom nobody recorded.
#[derive(Clone, Debug)]
struct Added {
    id: InstanceId,
    kind: Kind,
    speed_mps: f64,
    actor: Actor,
}

/// Feet that slide farther than this from one moment to the next are told of, metres.
const SLIDES_M: f64 = 0.02;

/// The square that is built around a drive: around the driven path, the annotated objects and the LiDAR points within
/// 100 m of the sensor, with a margin, and at least 600 m wide; `None` for a drive without keyframes.
///
/// A place without a recording ([`place_drive`](crate::place_drive)) is as wide as its views are spread.
pub fn area(drive: &Drive) -> Option<Bounds> {
    let seen = drive.bounds(LIDAR_REACH_M)?.grown(MARGIN_M);
    let least_m = match drive.origin {
        DriveOrigin::Recorded => MIN_SIDE_M,
        DriveOrigin::MadeUp => 0.0,
    };
    Some(Bounds::square(seen.centre(), seen.size_m().max_element().max(least_m)))
}

/// Builds the place of a drive.
///
/// # Errors
/// A drive without keyframes, a vehicle pose that is not finite, or a place wider than 3 km.
pub fn build(
    drive: &Drive,
    map: Option<&StreetMap>,
    library: &AssetLibrary,
    settings: &BuildSettings,
    report: &Report,
) -> Result<Site, BuildError> {
    build_at(drive, Moments::of_keyframes(drive), map, library, settings, report)
}

/// Builds the place of a drive to be seen at moments of which its keyframes are some: all but where road users are then comes
/// from the keyframes alone, and is the same whatever the moments.
///
/// # Errors
/// As [`build`].
pub fn build_at(
    drive: &Drive,
    moments: Moments,
    map: Option<&StreetMap>,
    library: &AssetLibrary,
    settings: &BuildSettings,
    report: &Report,
) -> Result<Site, BuildError> {
    let bounds = checked_area(drive)?;
    let (seeds, locale) = (settings.seeds, &settings.locale);
    let relief = map.and_then(|map| map.relief.as_ref());
    let map = map.filter(|map| !map.is_only_relief());
    let map = map.and_then(|map| agreed(drive, map, locale.driving_side, bounds, settings.on_disagreement, report));
    // Where nothing is known but the recording, it tells where streets are.
    let assumed = (map.is_none() && drive.lane_map.is_none()).then(|| assumed(drive, locale, report));
    let known = map.as_ref();
    let map = assumed.as_ref().or(known);

    // Plants are those of the season, and people wear what is worn in it.
    let conditions = Conditions::new(drive, settings.light.time_ns(drive), settings.weather.season());
    let Weather { falling, wind_mps, snow, people_respond, .. } = settings.weather;
    let outdoors = if people_respond { conditions.outdoors(falling, snow) } else { conditions.outdoors(None, 0.0) };
    let library = &library.in_season(conditions.season()).found_in(locale.country.as_deref()).dressed_for(outdoors);

    // What lies and stands for good.
    let Ground { heights: ground, spans, land } = ground(drive, map, relief, locale.kerb.height_m, bounds, report);
    let is_assumed = assumed.is_some();
    let place = Place {
        drive,
        map,
        is_assumed,
        invents: is_assumed || settings.invent,
        bounds,
        ground: &ground,
        library,
        locale,
        conditions,
        seeds: &seeds,
        report,
    };
    let surfaces = roads::surfaces(&place, &spans, land);
    let buildings = buildings::buildings(&place, &surfaces);

    // The recorded objects come before all that is made up around them.
    let stand = Stand { ground: &ground, surfaces: &surfaces };
    let absent = traffic::absent(drive, settings.traffic.density, seeds.traffic.child("absent"), report);
    let casting = Casting { drive, moments, library, outdoors, stand, top_k: settings.top_k, seeds: &seeds, report };
    let Cast { roles, fits } = casting.recorded(&absent);

    // What is made up keeps clear of everything recorded; poles come before plants.
    let mut clearance = Clearance::new(drive, &surfaces, &buildings.footprints, bounds);
    let kerbs = Kerbs::new(drive, map, &surfaces, bounds);
    let around = Surroundings { place: &place, kerbs: &kerbs, stand };
    let furniture = furniture(&around, &mut clearance, seeds.furniture.child("furniture"));
    let seed = seeds.vegetation;
    let mut plants = vegetation(&around, &mut clearance, seed.child("vegetation"));

    // Numbers: tracks from 1, the recording vehicle, then what stands still.
    let sky = light(drive, bounds, &settings.light, settings.weather.snow, seeds.light.child("light"));
    let mut assembly = Assembly::default();
    assembly.stock.is_dark = is_dark(&sky.environment);
    assembly.stock.car_colors = Some(place.locale.traffic.car_colors);
    let mut actors: Vec<Option<Actor>> =
        roles.iter().map(|role| Some(assembly.actor(role.as_ref()?, moments))).collect();
    for (track, actor) in drive.tracks.iter().zip(&actors) {
        if let Some(actor) = actor.as_ref().filter(|actor| actor.slides_m > SLIDES_M) {
            let example = format!("{} ({}), {:.2} m", track.token, track.kind.name(), actor.slides_m);
            report.note(Outcome::Warned, "feet that slide, since annotated boxes go farther than legs reach", example);
        }
    }
    let mut next_id = actors.len() as u32 + 1;
    for piece in surfaces.pieces.iter().chain(&buildings.pieces).chain(&furniture.pieces) {
        assembly.piece(piece, &mut next_id);
    }
    let left = (MAX_ID + 1).saturating_sub(next_id) as usize;
    let others = furniture.scenery.len() + traffic::most_added(&around, settings.traffic.density);
    drop_farthest(&mut plants, drive, left.saturating_sub(others), report);
    let skyline = skyline(&place, &surfaces, land, &buildings, &plants);
    let undergrowth = undergrowth(&around, &clearance, &plants, seed.child("undergrowth"));
    for piece in &undergrowth {
        assembly.piece(piece, &mut next_id);
    }
    let path = driven_path(drive);
    // Plants come late, so that their number changes no other's.
    for scenery in furniture.scenery.iter().chain(&plants) {
        assembly.scenery(scenery, distance_m(&path, scenery), &mut next_id);
    }
    for piece in &skyline.houses {
        assembly.piece(piece, &mut next_id);
    }
    for scenery in &skyline.plants {
        assembly.scenery(scenery, distance_m(&path, scenery), &mut next_id);
    }
    // Road users whom nobody recorded come last: they take the room that is left.
    let seed = seeds.traffic.child("added");
    let users = traffic::added(&around, &absent, &clearance, &assembly, moments, settings.traffic, seed);
    let mut added = Vec::new();
    for user in &users {
        let Some(role) = casting.added(&user.track, user.at_moments.as_ref(), user.speed_mps) else { continue };
        let actor = assembly.actor(&role, moments);
        added.push(Added { id: InstanceId(next_id), kind: user.track.kind, speed_mps: user.speed_mps, actor });
        next_id += 1;
    }
    let all = actors.iter().flatten().chain(added.iter().map(|a| &a.actor));
    settings.weather.treat(&mut assembly, all);
    let fog = settings.weather.fog_over(drive);
    let snow = lying(snow, &surfaces, Drape::new(&ground).bounds());
    let light = Light { fog, falling, wind_mps, snow, ..sky };
    let recorded = actors.iter_mut().flatten().map(|actor| (actor.moves(), actor));
    let driven = recorded.chain(added.iter_mut().map(|a| (a.speed_mps > 0.0, &mut a.actor)));
    let (_, lon_deg) = drive.projection.geo_from_world(bounds.centre());
    let solar_hour = solar_hour(settings.light.time_ns(drive), lon_deg);
    let drives_lit = assembly.stock.is_dark || settings.weather.asks_for_lights();
    switch_on(solar_hour, locale.driving_side, drives_lit, &mut assembly.stock, driven);
    let sources = assembly.provenance(drive, known).into_iter().chain(settings.borders.clone());
    let sources = sources.chain(relief.into_iter().flat_map(|relief| relief.sources.clone())).collect();
    Ok(Site {
        light,
        film_m: film_m(settings.weather.wetness),
        season: conditions.season(),
        provenance: sources,
        ground,
        stock: assembly.stock,
        fixed: assembly.fixed,
        actors,
        added,
        footprints: buildings.footprints,
        roads: surfaces.plan.clone(),
        fits,
    })
}

/// How far something stands from the driven path as far as its details show: what is larger is seen from farther away.
fn distance_m(path: &[DVec2], scenery: &Scenery) -> f64 {
    let foot = scenery.foot_world.truncate();
    let nearest = path.iter().map(|p| p.distance_squared(foot)).fold(f64::INFINITY, f64::min).sqrt();
    nearest / scenery.scale.max_element()
}

/// Keeps the `most` plants that are nearest to the driven path, in their order.
fn drop_farthest(plants: &mut Vec<Scenery>, drive: &Drive, most: usize, report: &Report) {
    if plants.len() <= most {
        return;
    }
    let path: Vec<DVec3> = drive.keyframes.iter().map(|k| k.world_from_ego.translation).collect();
    let distance_m = |s: &Scenery| path.iter().map(|p| p.distance(s.foot_world)).fold(f64::INFINITY, f64::min);
    let distances_m: Vec<f64> = plants.iter().map(distance_m).collect();
    let mut order: Vec<usize> = (0..plants.len()).collect();
    order.sort_by(|&a, &b| distances_m[a].total_cmp(&distances_m[b]).then(a.cmp(&b)));
    let kept: BTreeSet<usize> = order[..most].iter().copied().collect();
    for _ in most..plants.len() {
        report.note(Outcome::Dropped, "plant beyond the 65,535 objects that can be numbered", &drive.id);
    }
    let mut index = 0..;
    plants.retain(|_| index.next().is_some_and(|i| kept.contains(&i)));
}

/// The area of a drive that has one.
fn checked_area(drive: &Drive) -> Result<Bounds, BuildError> {
    for (keyframe, k) in drive.keyframes.iter().enumerate() {
        if !k.world_from_ego.is_finite() {
            return Err(BuildError::BadPose {
                drive: drive.id.clone(),
                keyframe,
                found: format!("{:?}", k.world_from_ego.translation),
            });
        }
    }
    let bounds = area(drive).ok_or_else(|| BuildError::EmptyDrive { drive: drive.id.clone() })?;
    let side_m = bounds.size_m().max_element();
    if !(bounds.min.is_finite() && bounds.max.is_finite() && side_m <= MAX_SIDE_M) {
        return Err(BuildError::TooLarge { drive: drive.id.clone(), side_m, limit_m: MAX_SIDE_M });
    }
    Ok(bounds)
}

impl Site {
    /// Everything that a picture of one keyframe needs; a keyframe that the drive does not have shows the place alone. Where
    /// the place was built for other moments, the drive is theirs ([`Moments::drive`]).
    pub fn scene(&self, drive: &Drive, keyframe: usize) -> Scene {
        let neighbours = [previous(drive, keyframe), next(drive, keyframe)];
        let mut meshes = MeshesNow::new(&self.stock.meshes);
        let mut instances = Vec::with_capacity(self.fixed.len() + self.actors.len());
        let boxes = drive.keyframes.get(keyframe).map_or(&[][..], |k| &k.boxes);
        for annotated in boxes {
            let (Some(Some(actor)), Some(track)) =
                (self.actors.get(annotated.track), drive.tracks.get(annotated.track))
            else {
                continue;
            };
            let Some(pose) = actor.at(keyframe) else { continue };
            let object = SceneObject {
                kind: annotated.kind,
                origin: Origin::Recorded {
                    track_token: track.token.clone(),
                    annotation_token: annotated.token.clone(),
                    category: annotated.category.clone(),
                },
                asset: Some(actor.asset(pose)),
                cuboid: pose.cuboid,
                velocity_mps: annotated.velocity_mps,
                yaw_rate_radps: pose.movement.yaw_rate_radps,
                states: pose.movement.states(annotated.kind, pose.posture, annotated.is_parked),
                paint: actor.paint,
                keypoints_world: pose.keypoints_world,
            };
            let id = track_id(annotated.track);
            instances.extend(actor.instance(id, keyframe, neighbours, &mut meshes, Some(object)));
        }
        instances.extend(self.ego_instance(drive, keyframe, neighbours, &mut meshes));
        instances.sort_by_key(|i| i.id);
        instances.extend(self.fixed.iter().cloned());
        instances.extend(self.added.iter().filter_map(|added| added.instance(keyframe, neighbours, &mut meshes)));
        let others = neighbours.map(|then| self.others(keyframe, then, &mut meshes));
        Scene {
            meshes: meshes.into_meshes(),
            materials: self.stock.materials.clone(),
            instances,
            others,
            keyframes_apart_s: neighbours.map(|other| apart_s(drive, keyframe, other)),
            light: Light { moment_s: moment_s(drive, keyframe), spray: self.spray(keyframe), ..self.light.clone() },
            provenance: self.provenance.clone(),
        }
    }

    /// What vehicles throw up at a keyframe.
    fn spray(&self, keyframe: usize) -> Vec<Vec<Puff>> {
        let known = self.actors.iter().enumerate().filter_map(|(i, actor)| Some((track_id(i), actor.as_ref()?, None)));
        let added = self.added.iter().map(|added| (added.id, &added.actor, Some(added.speed_mps)));
        let on_wheels = known.chain(added).filter(|(_, actor, _)| has_tyres(actor.class()));
        let behind = on_wheels.filter_map(|(id, actor, speed_mps)| {
            let pose = actor.at(keyframe)?;
            Some(spray(self.film_m, self.light.wind_mps, id, &pose.cuboid, pose.movement.speed_mps.or(speed_mps)?))
        });
        behind.filter(|puffs| !puffs.is_empty()).collect()
    }

    /// Who is there at a keyframe beside and not at this one.
    fn others(&self, keyframe: usize, beside: Option<usize>, meshes: &mut MeshesNow) -> Vec<Instance> {
        let Some(beside) = beside else { return Vec::new() };
        let tracks = self.actors.iter().enumerate().filter_map(|(i, actor)| Some((track_id(i), actor.as_ref()?)));
        let all = tracks.chain(self.added.iter().map(|added| (added.id, &added.actor)));
        let come_or_gone = all.filter(|(_, actor)| actor.at(keyframe).is_none());
        come_or_gone.filter_map(|(id, actor)| actor.instance(id, beside, [None; 2], meshes, None)).collect()
    }

    fn ego_instance(
        &self,
        drive: &Drive,
        keyframe: usize,
        neighbours: [Option<usize>; 2],
        meshes: &mut MeshesNow,
    ) -> Option<Instance> {
        let ego = self.actors.last()?.as_ref()?;
        let pose = ego.at(keyframe)?;
        let object = SceneObject {
            kind: Kind::Car,
            origin: Origin::Carrier,
            asset: Some(ego.asset(pose)),
            cuboid: pose.cuboid,
            velocity_mps: None,
            yaw_rate_radps: pose.movement.yaw_rate_radps,
            states: pose.movement.states(Kind::Car, None, None),
            paint: ego.paint,
            keypoints_world: pose.keypoints_world,
        };
        ego.instance(self.ego_id(drive), keyframe, neighbours, meshes, Some(object))
    }

    /// Colours it as photographs tell: the paint of vehicles, buildings, and what of other classes stands or lies still.
    pub fn tint(&mut self, looks: &Looks) {
        for instance in &mut self.fixed {
            if let Some(&factor) = looks.things.get(&instance.id).or_else(|| looks.classes.get(&instance.class)) {
                for material in &mut instance.materials {
                    *material = self.stock.tinted(*material, factor);
                }
            }
        }
        for (track, actor) in self.actors.iter_mut().enumerate() {
            let factor = looks.things.get(&track_id(track)).copied();
            if let Some((actor, factor)) = actor.as_mut().zip(factor) {
                actor.repaint(factor, &mut self.stock);
            }
        }
    }

    /// Takes pattern and relief from all surfaces: each has the mean colour of its texture.
    pub fn flatten(&mut self) {
        self.stock.flatten();
    }

    /// The number of the recording vehicle.
    pub fn ego_id(&self, drive: &Drive) -> InstanceId {
        track_id(drive.tracks.len())
    }

    /// Height of the carriageway.
    pub fn ground(&self) -> &HeightField {
        &self.ground
    }

    /// What plants show.
    pub fn season(&self) -> Season {
        self.season
    }

    /// Sun and sky.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// Where everything came from, with licences.
    pub fn provenance(&self) -> &[Provenance] {
        &self.provenance
    }

    /// How well the assets of the recorded objects fit their boxes, in the order of the tracks.
    pub fn fits(&self) -> &[ObjectFit] {
        &self.fits
    }

    /// What the roads are.
    pub fn roads(&self) -> &RoadPlan {
        &self.roads
    }

    /// The box of a track as placed at a keyframe; `None` where it was not annotated or has no asset.
    pub(crate) fn placed(&self, track: usize, keyframe: usize) -> Option<Cuboid> {
        Some(self.actors.get(track)?.as_ref()?.at(keyframe)?.cuboid)
    }

    /// Outlines of the buildings, those of their parts apart.
    pub fn footprints(&self) -> &[Polygon] {
        &self.footprints
    }

    /// Boxes of what stands still and has one of its own, but for buildings.
    pub(crate) fn fixed_boxes(&self) -> impl Iterator<Item = &Cuboid> {
        self.fixed.iter().filter_map(|i| i.object.as_deref()).filter(|o| o.kind != Kind::Building).map(|o| &o.cuboid)
    }
}

impl Added {
    fn instance(&self, keyframe: usize, neighbours: [Option<usize>; 2], meshes: &mut MeshesNow) -> Option<Instance> {
        let pose = self.actor.at(keyframe)?;
        // Nobody waits in a lane: a vehicle that was added and stands is parked.
        let parks = self.speed_mps == 0.0;
        let movement = Movement { speed_mps: pose.movement.speed_mps.or(Some(self.speed_mps)), ..pose.movement };
        let object = SceneObject {
            kind: self.kind,
            origin: Origin::Added,
            asset: Some(self.actor.asset(pose)),
            cuboid: pose.cuboid,
            velocity_mps: Some(pose.cuboid.world_from_body.vector(DVec3::X) * self.speed_mps),
            yaw_rate_radps: pose.movement.yaw_rate_radps,
            states: movement.states(self.kind, pose.posture, Some(parks)),
            paint: self.actor.paint,
            keypoints_world: pose.keypoints_world,
        };
        self.actor.instance(self.id, keyframe, neighbours, meshes, Some(object))
    }
}

/// The number of a track: 1 for the first.
pub(crate) fn track_id(track: usize) -> InstanceId {
    InstanceId(track as u32 + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Asset, Form, Outdoors, Precipitation, Seed};

    use crate::testing;
    use crate::views::{PictureSize, ViewPlan, ViewSettings};

    fn settings(seed: u64) -> BuildSettings {
        BuildSettings { seeds: Seed(seed).into(), top_k: 3, ..testing::settings() }
    }

    fn site(seed: u64) -> Site {
        build(&testing::drive(), None, &testing::library(), &settings(seed), &Report::default()).unwrap()
    }

    #[test]
    fn an_object_keeps_its_number_asset_and_paint_over_all_keyframes() {
        let (drive, site) = (testing::drive(), site(1));
        let first = site.scene(&drive, 0);
        for k in 1..10 {
            let scene = site.scene(&drive, k);
            assert_eq!(scene.instances.len(), first.instances.len());
            for (a, b) in first.instances.iter().zip(&scene.instances) {
                assert_eq!((a.id, a.class, a.mesh, &a.materials), (b.id, b.class, b.mesh, &b.materials));
            }
        }
        let ids: Vec<u32> = first.instances.iter().map(|i| i.id.0).filter(|&id| id > 0).collect();
        assert!(ids.iter().enumerate().all(|(i, &id)| id == i as u32 + 1), "{ids:?}");
    }

    #[test]
    fn who_comes_and_goes_leaves_everyone_elses_number() {
        // The parked car is seen in the middle of the recording alone.
        let mut drive = testing::drive();
        let is_seen = |keyframe: usize| (3..7).contains(&keyframe);
        drive.tracks[0].boxes.retain(|(k, _)| is_seen(*k));
        for (k, keyframe) in drive.keyframes.iter_mut().enumerate() {
            keyframe.boxes.retain(|b| b.track != 0 || is_seen(k));
        }
        let site = build(&drive, None, &testing::library(), &settings(1), &Report::default()).unwrap();
        let mut names = std::collections::BTreeMap::new();
        for k in 0..10 {
            let scene = site.scene(&drive, k);
            let mut at_once = std::collections::BTreeSet::new();
            for instance in &scene.instances {
                let Some(object) = instance.object.as_deref() else { continue };
                let nameless = || format!("{:?} {:?}", object.origin, object.asset);
                let name = object.origin.track_token().map_or_else(nameless, str::to_owned);
                assert!(at_once.insert(instance.id), "{:?} is there twice at {k}", instance.id);
                assert_eq!(names.entry(instance.id).or_insert_with(|| name.clone()), &name, "at {k}");
            }
            let recorded =
                |i: &&Instance| i.object.as_deref().is_some_and(|o| matches!(o.origin, Origin::Recorded { .. }));
            assert_eq!(scene.instances.iter().filter(recorded).count(), if is_seen(k) { 4 } else { 3 });
        }
    }

    #[test]
    fn a_factor_s_seed_changes_what_it_decides_and_nothing_else() {
        let drive = testing::drive();
        let built = |seeds: Seeds| {
            let settings = BuildSettings { seeds, ..settings(1) };
            build(&drive, None, &testing::library(), &settings, &Report::default()).unwrap().scene(&drive, 0)
        };
        type Look = (InstanceId, Option<String>, [f64; 3], Vec<glam::Vec3>);
        let looks = |scene: &Scene| -> Vec<Look> {
            let asset = |i: &Instance| i.object.as_ref().and_then(|o| o.asset.clone());
            let paints = |i: &Instance| i.materials.iter().map(|&m| scene.materials[m].base_color).collect();
            let place = |i: &Instance| i.world_from_mesh.translation.to_array();
            scene.instances.iter().map(|i| (i.id, asset(i), place(i), paints(i))).collect()
        };
        let base: Seeds = Seed(1).into();
        let before = looks(&built(base));
        assert_eq!(looks(&built(base)), before);
        let is_vehicle = |i: usize| (0..3).contains(&i) || i == 4;
        let changed = |change: fn(&mut Seeds, Seed)| -> Vec<usize> {
            let differing = (2..5).flat_map(|s| {
                let mut seeds = base;
                change(&mut seeds, Seed(s));
                let after = looks(&built(seeds));
                assert_eq!(after.len(), before.len());
                (0..after.len()).filter(|&i| after[i] != before[i]).collect::<Vec<_>>()
            });
            let differing: std::collections::BTreeSet<usize> = differing.collect();
            differing.into_iter().collect()
        };
        let painted = changed(|seeds, seed| seeds.paint = seed);
        assert!(!painted.is_empty() && painted.iter().all(|&i| is_vehicle(i)), "{painted:?}");
        let cast = changed(|seeds, seed| seeds.assets = seed);
        assert!(!cast.is_empty() && cast.iter().all(|&i| is_vehicle(i)), "{cast:?}");
        assert_eq!(changed(|seeds, seed| seeds.people = seed), [3], "one person walks there");
        let lit = changed(|seeds, seed| seeds.light = seed);
        assert!(lit.is_empty(), "{lit:?}");
    }

    #[test]
    fn people_wear_what_is_worn_in_the_weather_and_whoever_is_there_where_nothing_is() {
        let drive = testing::drive();
        let person = |id: &str, worn_in: &[Outdoors]| Asset {
            worn_in: worn_in.to_vec(),
            ..testing::asset(id, Kind::Adult, [0.5, 0.6, 1.75])
        };
        let (coat, tee) = (person("person/coat", &[Outdoors::Cold]), person("person/tee", &[Outdoors::Warm]));
        let walks = |people: &[&Asset], weather: Weather| {
            let mut library = testing::library();
            library.assets.retain(|asset| asset.kind != Kind::Adult);
            library.assets.extend(people.iter().copied().cloned());
            let report = Report::default();
            let drawn: BTreeSet<String> = (0..2)
                .map(|seed| {
                    let settings = BuildSettings { weather, ..settings(seed) };
                    let scene = build(&drive, None, &library, &settings, &report).unwrap().scene(&drive, 0);
                    scene.instances.iter().filter_map(|i| i.object.clone()).find(|o| o.kind == Kind::Adult)
                })
                .map(|object| object.unwrap().asset.clone().unwrap())
                .collect();
            let is_told = report.entries().iter().any(|e| e.what.contains("adult in clothes for other weather"));
            (drawn.into_iter().collect::<Vec<_>>(), is_told)
        };
        let flakes = Precipitation { form: Form::Snow, rate_mm_h: 1.0 };
        let snows = Weather { falling: Some(flakes), ..Weather::default() };
        let snowed = Weather { snow: 0.5, ..Weather::default() };
        let alike = Weather { falling: Some(flakes), people_respond: false, ..Weather::default() };
        let named = |id: &str| vec![id.to_owned()];
        assert_eq!(walks(&[&coat, &tee], Weather::default()), (named("person/tee"), false));
        assert_eq!(walks(&[&coat, &tee], snows), (named("person/coat"), false));
        assert_eq!(walks(&[&coat, &tee], snowed), (named("person/coat"), false));
        assert_eq!(walks(&[&coat, &tee], alike), (named("person/tee"), false));
        assert_eq!(walks(&[&tee], snowed), (named("person/tee"), true));
    }

    #[test]
    fn motion_leads_from_keyframe_to_keyframe_and_ends_with_the_recording() {
        let (drive, site) = (testing::drive(), site(1));
        let scenes: Vec<Scene> = (0..10).map(|k| site.scene(&drive, k)).collect();
        for k in 1..10 {
            for (before, now) in scenes[k - 1].instances.iter().zip(&scenes[k].instances) {
                assert_eq!((before.next, now.previous), (Some(now.now()), Some(before.now())));
            }
        }
        assert!(scenes[0].instances[1].previous.is_none());
        let ahead = &scenes[3].instances[1];
        let moved = ahead.next.unwrap().world_from_mesh.translation - ahead.world_from_mesh.translation;
        assert!((moved - DVec3::new(5.0, 0.0, 0.0)).length() < 1e-2, "{moved}");
    }

    #[test]
    fn plants_and_furniture_stand_off_the_road_and_clear_of_everything_recorded() {
        let (drive, site) = (testing::drive(), site(2));
        let bounds = area(&drive).unwrap();
        let surfaces = testing::surfaces(&drive, &HeightField::flat(bounds, 0.0));
        let scenery: Vec<&Instance> =
            site.fixed.iter().filter(|i| i.object.as_ref().is_some_and(|o| o.kind != Kind::Building)).collect();
        let kinds: BTreeSet<Kind> = scenery.iter().filter_map(|i| Some(i.object.as_ref()?.kind)).collect();
        let expected = [Kind::Tree, Kind::Bush, Kind::StreetLamp, Kind::Bench];
        assert!(expected.iter().all(|k| kinds.contains(k)), "{kinds:?}");
        for instance in scenery {
            let object = instance.object.as_ref().unwrap();
            if matches!(object.kind, Kind::Tree | Kind::Bush) {
                let foot = instance.world_from_mesh.translation.truncate();
                assert_ne!(surfaces.footing(foot), crate::roads::Footing::Carriageway, "{object:?}");
            }
            for annotated in drive.keyframes.iter().flat_map(|k| &k.boxes) {
                let foot = instance.world_from_mesh.translation.truncate();
                let centre = annotated.cuboid.world_from_body.translation;
                assert!(!annotated.cuboid.grown(0.3).contains(foot.extend(centre.z)), "{object:?}");
            }
        }
    }

    #[test]
    fn the_same_seed_builds_the_same_place_with_any_number_of_threads() {
        let built = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let drive = testing::drive();
            let site = pool.install(|| site(5));
            let size = PictureSize::Scaled(0.5);
            let views = ViewSettings { other_vehicles: 2, size, spp: 1, ..ViewSettings::default() };
            let (scene, report) = (site.scene(&drive, 4), Report::default());
            format!(
                "{:?} {:?}",
                (scene.instances, scene.materials),
                ViewPlan::new(&drive, &site, views, Seed(5).into(), &report).shots(&drive, &site, 4, &report)
            )
        };
        assert_eq!(built(1), built(2));
    }

    #[test]
    fn a_drive_without_keyframes_with_a_broken_pose_or_a_box_out_of_this_world_is_an_error() {
        let (library, report) = (testing::library(), Report::default());
        let empty = Drive { keyframes: Vec::new(), ..testing::drive() };
        assert!(matches!(build(&empty, None, &library, &settings(0), &report), Err(BuildError::EmptyDrive { .. })));
        let mut broken = testing::drive();
        broken.keyframes[3].world_from_ego.translation.x = f64::NAN;
        let error = build(&broken, None, &library, &settings(0), &report).unwrap_err();
        assert!(matches!(error, BuildError::BadPose { keyframe: 3, .. }));
        let mut strayed = testing::drive();
        strayed.keyframes[3].boxes[0].cuboid.world_from_body.translation.x = 1e7;
        let error = build(&strayed, None, &library, &settings(0), &report).unwrap_err();
        assert!(matches!(error, BuildError::TooLarge { .. }));
    }
}
