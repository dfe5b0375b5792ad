//! Who is on the road.

use std::fmt;

use glam::DVec3;
use trove_model::{Asset, AssetLibrary, Kind, Posture, Random, TrafficMix};

/// What a made-up road user does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Doing {
    /// Along the sidewalk.
    Walking,
    /// On the sidewalk.
    Standing,
    /// At a crossing, for a gap.
    Waiting,
    Cycling,
    Motorcycling,
    Driving,
    Parked,
    /// An animal beside the road or on its edge.
    Straying,
}

impl fmt::Display for Doing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

/// How often each is met.
fn doings(mix: &TrafficMix) -> [(Doing, f64); 8] {
    [
        (Doing::Walking, mix.walking),
        (Doing::Standing, mix.standing),
        (Doing::Waiting, mix.waiting),
        (Doing::Cycling, mix.cycling),
        (Doing::Motorcycling, mix.motorcycling),
        (Doing::Driving, mix.driving),
        (Doing::Parked, mix.parked),
        (Doing::Straying, mix.straying),
    ]
}

/// Kinds of those who do something, with how many of a hundred they are.
fn kinds(doing: Doing) -> &'static [(Kind, f64)] {
    match doing {
        Doing::Walking => &[(Kind::Adult, 88.0), (Kind::Child, 9.0), (Kind::Stroller, 3.0)],
        Doing::Standing | Doing::Waiting => &[(Kind::Adult, 92.0), (Kind::Child, 8.0)],
        Doing::Cycling => &[(Kind::BicycleWithRider, 100.0)],
        Doing::Motorcycling => &[(Kind::MotorcycleWithRider, 100.0)],
        Doing::Driving => &[(Kind::Car, 86.0), (Kind::Truck, 9.0), (Kind::Bus, 5.0)],
        Doing::Parked => &[(Kind::Car, 95.0), (Kind::Truck, 5.0)],
        Doing::Straying => &[(Kind::Animal, 100.0)],
    }
}

/// Who there may be at a place, as far as the library has them.
pub(super) struct Shares<'a> {
    library: &'a AssetLibrary,
    doings: Vec<(Doing, f64)>,
}

impl<'a> Shares<'a> {
    pub(super) fn of(mix: &TrafficMix, library: &'a AssetLibrary, cyclists: f64) -> Self {
        let has = |doing: Doing| kinds(doing).iter().any(|(kind, _)| library.of_kind(*kind).next().is_some());
        let lots = |doing, share| if doing == Doing::Cycling { share * cyclists } else { share };
        let doings = doings(mix).into_iter().filter(|(doing, _)| has(*doing));
        Self { library, doings: doings.map(|(doing, share)| (doing, lots(doing, share))).collect() }
    }

    /// What the next one does; `None` where the library has nobody.
    pub(super) fn draw(&self, random: &mut Random) -> Option<Doing> {
        drawn(&self.doings, random)
    }

    /// Who does it, and how large they are: as one of the library's models is.
    pub(super) fn someone(&self, doing: Doing, random: &mut Random) -> Option<(Kind, DVec3)> {
        let known: Vec<(Kind, f64)> =
            kinds(doing).iter().filter(|(kind, _)| self.library.of_kind(*kind).next().is_some()).copied().collect();
        let kind = drawn(&known, random)?;
        let fits = |posture: Posture| match doing {
            Doing::Walking => matches!(posture, Posture::Walking { .. }),
            _ => posture == Posture::Standing,
        };
        let sizes: Vec<(DVec3, f64)> = self
            .library
            .of_kind(kind)
            .filter(|asset| asset.figure.as_ref().is_none_or(|figure| fits(figure.posture)))
            .map(|asset| (asset.size_m, commonness(asset)))
            .collect();
        Some((kind, drawn(&sizes, random)?))
    }
}

/// Lots of an asset.
fn commonness(asset: &Asset) -> f64 {
    f64::from(asset.commonness.max(0.0))
}

/// One of some, by their weights; `None` where nothing weighs anything.
fn drawn<T: Copy>(weighted: &[(T, f64)], random: &mut Random) -> Option<T> {
    random.weighted(weighted.iter().map(|(_, weight)| *weight)).map(|i| weighted[i].0)
}
