//! Finds room for what is wanted, and the model that fits.

use std::collections::{BTreeMap, HashMap};

use glam::{DVec2, DVec3};
use trove_model::{Asset, AssetLibrary, Kind, Locale, ModelShare, Outcome, Report, RoadKind, Seed};

use crate::geometry::plane_raster::bucket;
use crate::geometry::segments::SegmentIndex;
use crate::pieces::Scenery;
use crate::surroundings::KerbPoint;
use crate::surroundings::Surroundings;
use crate::surroundings::{Clearance, Room};

/// Poles stand at least this far behind the kerb, metres, and wider things with this much before them.
const OFF_KERB_M: f64 = 0.55;
const BEFORE_M: f64 = 0.4;
/// What is above this is over people's heads and needs no room, metres.
const HEADROOM_M: f32 = 1.9;
/// Made-up things keep this far from walls, for doors, metres.
const FROM_WALLS_M: f64 = 1.2;
/// No camera is so near to something made up that is wide, and to a pole, metres.
const SIGHT_M: f64 = 6.0;
const POLE_SIGHT_M: f64 = 3.4;
/// What is narrower than this to each side is a pole.
const POLE_M: f64 = 0.3;
/// Crossings are kept free this far from their middle line, and beyond their ends, metres.
const CROSSING_M: f64 = 2.4;
const CROSSING_END_M: f64 = 3.0;
/// Recorded crossings are kept free this far around, metres.
const AROUND_CROSSING_M: f64 = 0.8;
/// Lamps and the like are of one model over a square of this side, metres.
const ALIKE_SQUARE_M: f64 = 150.0;
/// Side of the buckets that neighbours are looked for in.
const BUCKET_M: f64 = 30.0;

/// Whether something is known to be there or is made up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Mapped,
    MadeUp,
}

/// A piece of furniture that is wanted somewhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wish<'w> {
    pub kind: Kind,
    /// What the models that will do are all tagged with.
    pub tags: &'w [&'w str],
    /// Where its foot stands.
    pub position: DVec2,
    /// Where its front looks, or its arm reaches.
    pub yaw_rad: f64,
    pub source: Source,
}

impl Wish<'_> {
    /// Its tags in the order in which they are asked for, as seeds and reports name it: `lamp/curved`.
    fn name(&self) -> String {
        self.tags.join("/")
    }
}

/// The room that a model takes on the ground, in its own frame.
#[derive(Clone, Debug)]
struct Plan {
    spots: Vec<DVec2>,
    radius_m: f64,
}

/// What has been placed, and room for more.
pub(super) struct Yard<'a, 'b, 'c> {
    pub library: &'a AssetLibrary,
    pub around: &'b Surroundings<'b>,
    pub clearance: &'b mut Clearance<'c>,
    pub locale: &'b Locale,
    pub placed: Vec<Scenery<'a>>,
    seed: Seed,
    plans: BTreeMap<&'a str, Plan>,
    crossings: SegmentIndex,
    crossing_edges: SegmentIndex,
    // Only ever looked up, so the order inside does not reach a result.
    cameras: HashMap<[i64; 2], Vec<DVec2>>,
    by_place: HashMap<[i64; 2], Vec<(Kind, DVec2)>>,
}

impl<'a, 'b, 'c> Yard<'a, 'b, 'c> {
    pub(super) fn new(
        around: &'b Surroundings<'b>,
        library: &'a AssetLibrary,
        clearance: &'b mut Clearance<'c>,
        seed: Seed,
    ) -> Self {
        let roads = around.place.map.iter().flat_map(|m| &m.roads).filter(|r| r.kind == RoadKind::Crossing);
        let crossings: Vec<Vec<DVec2>> = roads.map(|r| lengthened(&r.centreline)).collect();
        let lane_map = around.place.drive.lane_map.as_ref();
        let recorded = lane_map.map_or(&[][..], |m| &m.crossings);
        let edges: Vec<[DVec2; 2]> = recorded.iter().flat_map(|p| p.edges()).map(|(a, b)| [a, b]).collect();
        let mut cameras: HashMap<[i64; 2], Vec<DVec2>> = HashMap::new();
        for exposure in around.place.drive.keyframes.iter().flat_map(|k| &k.exposures) {
            let eye = exposure.world_from_ego.point(exposure.ego_from_camera.translation).truncate();
            if eye.is_finite() {
                cameras.entry(bucket(eye, BUCKET_M)).or_default().push(eye);
            }
        }
        Self {
            library,
            around,
            clearance,
            locale: around.place.locale,
            placed: Vec::new(),
            seed,
            plans: BTreeMap::new(),
            crossings: SegmentIndex::new(crossings.iter().map(Vec::as_slice)),
            crossing_edges: SegmentIndex::new(edges.iter().map(|e| e.as_slice())),
            cameras,
            by_place: HashMap::new(),
        }
    }

    /// Whether it found room.
    pub(super) fn place(&mut self, wish: &Wish, report: &Report) -> bool {
        let Some(asset) = self.model(wish, report) else { return false };
        if !self.take(asset, wish) {
            return false;
        }
        let foot_world = wish.position.extend(self.foot_m(asset, wish));
        // Lamps of a model are painted alike.
        let alike = wish.kind == Kind::StreetLamp;
        let seed = self.seed;
        let seed = if alike { seed.child(&wish.name()) } else { seed.child("piece").nth(self.placed.len() as u64) };
        self.placed.push(Scenery { asset, foot_world, yaw_rad: wish.yaw_rad, scale: DVec3::ONE, seed });
        true
    }

    /// Height at which a model stands: on a slope a wide one stands on its lower end, let in at the upper one.
    fn foot_m(&mut self, asset: &'a Asset, wish: &Wish) -> f64 {
        if wish.kind.is_on_pole() {
            return self.around.stand.surface_m(wish.position);
        }
        let (plan, turn) = (self.plan(asset), DVec2::from_angle(wish.yaw_rad));
        let corners = plan.spots.iter().flat_map(|s| [-1.0, 0.0, 1.0].map(|x| *s + DVec2::X * x * plan.radius_m));
        corners.map(|s| self.around.stand.surface_m(wish.position + turn.rotate(s))).fold(f64::INFINITY, f64::min)
    }

    /// At a kerb, as far behind it as the model is deep, looking the way that things of its kind do.
    pub(super) fn place_at_kerb(
        &mut self,
        kind: Kind,
        tags: &[&str],
        kerb: &KerbPoint,
        source: Source,
        report: &Report,
    ) -> bool {
        let wish = Wish { kind, tags, position: kerb.position, yaw_rad: facing(kind, kerb), source };
        let Some(asset) = self.model(&wish, report) else { return false };
        let off_m = (BEFORE_M + self.plan(asset).radius_m).max(OFF_KERB_M);
        self.place(&Wish { position: kerb.position + kerb.outward * off_m, ..wish }, report)
    }

    /// Whether the library has a model with these tags.
    pub(super) fn has(&self, kind: Kind, tags: &[&str]) -> bool {
        self.library.tagged(kind, tags).next().is_some()
    }

    /// Takes the room for a model; whether there was any.
    pub(super) fn take(&mut self, asset: &'a Asset, wish: &Wish) -> bool {
        let plan = self.plan(asset);
        let turn = DVec2::from_angle(wish.yaw_rad);
        let spots: Vec<DVec2> = plan.spots.iter().map(|s| wish.position + turn.rotate(*s)).collect();
        let made_up = wish.source == Source::MadeUp;
        let radius_m = plan.radius_m;
        let room = Room {
            road_m: if radius_m > POLE_M { radius_m } else { 0.0 },
            buildings_m: radius_m + if made_up { FROM_WALLS_M } else { 0.1 },
            recorded_m: 0.35 + radius_m,
            radius_m: radius_m + 0.05,
        };
        let free = |&p: &DVec2| {
            self.around.place.bounds.contains(p)
                && self.clearance.is_free(p, &room)
                && !self.on_crossing(p, radius_m)
                && !(made_up && self.in_sight(p, if wish.kind.is_on_pole() { 0.0 } else { radius_m + POLE_M }))
        };
        if !spots.iter().all(free) {
            return false;
        }
        for spot in &spots {
            self.clearance.take(*spot, room.radius_m);
        }
        self.by_place.entry(bucket(wish.position, BUCKET_M)).or_default().push((wish.kind, wish.position));
        true
    }

    /// Whether a piece of a kind stands within `reach_m` (at most 30 m) already.
    pub(super) fn has_near(&self, kind: Kind, p: DVec2, reach_m: f64) -> bool {
        neighbours(&self.by_place, p).any(|(other, at)| *other == kind && at.distance(p) < reach_m)
    }

    /// Whether a camera would be filled by something at a position.
    pub(super) fn in_sight(&self, p: DVec2, radius_m: f64) -> bool {
        let reach_m = if radius_m > POLE_M { SIGHT_M + radius_m } else { POLE_SIGHT_M };
        neighbours(&self.cameras, p).any(|eye| eye.distance(p) < reach_m)
    }

    fn on_crossing(&self, p: DVec2, radius_m: f64) -> bool {
        self.crossings.nearest(p, CROSSING_M + radius_m).is_some()
            || self.crossing_edges.nearest(p, AROUND_CROSSING_M + radius_m).is_some()
    }

    /// A model with the tags that are wanted; of a library that has none any of the kind, but no sign for another.
    fn model(&self, wish: &Wish, report: &Report) -> Option<&'a Asset> {
        let library = self.library;
        let tagged: Vec<&'a Asset> = library.tagged(wish.kind, wish.tags).collect();
        let says_something = matches!(wish.kind, Kind::TrafficSign | Kind::TrafficSignal);
        let models = if tagged.is_empty() && !says_something { library.of_kind(wish.kind).collect() } else { tagged };
        let square = (wish.position / ALIKE_SQUARE_M).floor();
        let seed = self.seed.child("model").nth(square.x as i64 as u64).nth(square.y as i64 as u64);
        let found = seed.child(&wish.name()).random().pick(&models).copied();
        if found.is_none_or(|asset| !asset.tags.has_all(wish.tags)) {
            let outcome = if found.is_none() { Outcome::Dropped } else { Outcome::Substituted };
            report.note(outcome, "furniture whose model the asset library lacks", wish.name());
        }
        found
    }

    fn plan(&mut self, asset: &'a Asset) -> Plan {
        self.plans.entry(&asset.id).or_insert_with(|| plan(asset)).clone()
    }
}

/// Models, each as often as its share says.
pub(super) fn as_often(models: &[ModelShare]) -> Vec<&ModelShare> {
    models.iter().flat_map(|model| std::iter::repeat_n(model, model.share as usize)).collect()
}

/// Tags as they are asked for.
pub(super) fn words(tags: &[String]) -> Vec<&str> {
    tags.iter().map(String::as_str).collect()
}

/// Signs and signals look at the traffic that comes, racks lie along the kerb, everything else looks at the road.
pub(super) fn facing(kind: Kind, kerb: &KerbPoint) -> f64 {
    let look = match kind {
        Kind::TrafficSign | Kind::TrafficSignal => -kerb.traffic,
        Kind::BicycleRack => kerb.traffic,
        _ => -kerb.outward,
    };
    look.to_angle()
}

/// Circles along the longer side of what a model has below people's heads.
fn plan(asset: &Asset) -> Plan {
    let low = asset.mesh.positions.iter().filter(|p| p.z < HEADROOM_M).map(|p| p.truncate().as_dvec2());
    let Some(bounds) = trove_model::Bounds::around(low) else {
        return Plan { spots: vec![DVec2::ZERO], radius_m: 0.1 };
    };
    let size_m = bounds.size_m();
    let radius_m = size_m.min_element() / 2.0;
    let along = if size_m.x > size_m.y { DVec2::X } else { DVec2::Y };
    // Circles reach the corners but for a little.
    let free_m = (size_m.max_element() - 1.5 * radius_m).max(0.0);
    let steps = (free_m / (1.6 * radius_m).max(0.3)).ceil() as usize;
    let at = |i: usize| if steps == 0 { 0.0 } else { i as f64 / steps as f64 - 0.5 };
    let spots = (0..=steps).map(|i| bounds.centre() + along * free_m * at(i)).collect();
    Plan { spots, radius_m: radius_m * 1.1 }
}

fn lengthened(line: &[DVec2]) -> Vec<DVec2> {
    let mut line = line.to_vec();
    let n = line.len();
    if n > 1 {
        let [first, last] = [line[0] - line[1], line[n - 1] - line[n - 2]].map(DVec2::normalize_or_zero);
        line[0] += first * CROSSING_END_M;
        line[n - 1] += last * CROSSING_END_M;
    }
    line
}

/// What lies in the nine buckets around a position.
fn neighbours<T>(buckets: &HashMap<[i64; 2], Vec<T>>, p: DVec2) -> impl Iterator<Item = &T> {
    let [x, y] = bucket(p, BUCKET_M);
    (x - 1..=x + 1)
        .flat_map(move |x| (y - 1..=y + 1).map(move |y| [x, y]))
        .filter_map(|key| buckets.get(&key))
        .flatten()
}
