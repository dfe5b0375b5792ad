//! Covers in the road and gratings along the kerb.

use glam::{DVec2, Vec2};
use trove_model::{FurnitureKind, Mesh, Polygon, Random, StreetMap};

use super::stretches::Region;
use crate::geometry::path::Path;
use crate::geometry::plane::rectangle;
use crate::ground::Drape;

/// Metres of road for one cover, and of kerb for one grating.
const COVER_EVERY_M: f64 = 32.0;
const GRATING_EVERY_M: f64 = 27.0;
/// A mapped cover has one beside it drawn nowhere nearer than this.
const APART_M: f64 = 4.0;

/// A cover that lies in the road.
pub(super) struct Cover {
    pub(super) kind: CoverKind,
    at: DVec2,
    /// Unit: its texture's u.
    along: DVec2,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum CoverKind {
    Round,
    Square,
    Grating,
}

impl CoverKind {
    pub(super) const ALL: [Self; 3] = [Self::Round, Self::Square, Self::Grating];

    /// Tag of its surface.
    pub(super) fn tag(self) -> &'static str {
        match self {
            Self::Round => "round",
            Self::Square => "square",
            Self::Grating => "grating",
        }
    }

    /// Length and width, which its texture covers.
    pub(super) fn size_m(self) -> DVec2 {
        match self {
            Self::Round => DVec2::splat(0.68),
            Self::Square => DVec2::new(0.9, 0.6),
            Self::Grating => DVec2::new(0.5, 0.4),
        }
    }

    /// Its outline about the origin.
    fn outline(self) -> Vec<DVec2> {
        let half = self.size_m() / 2.0;
        if self == Self::Round {
            return (0..24).map(|i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 24.0) * half).collect();
        }
        rectangle(trove_model::Bounds { min: -half, max: half }).exterior
    }
}

impl Cover {
    pub(super) fn area(&self) -> Polygon {
        let place = |p: DVec2| self.at + self.along * p.x + self.along.perp() * p.y;
        Polygon::simple(self.kind.outline().into_iter().map(place).collect())
    }
}

/// Covers of some regions: the map's, and where it has none some by chance; gratings along the kerbs. None overlap.
pub(super) fn covers(regions: &[Region], map: Option<&StreetMap>, kerbs: &[Polygon], near: &[Polygon]) -> Vec<Cover> {
    let mut covers: Vec<Cover> = Vec::new();
    let add = |covers: &mut Vec<Cover>, cover: Cover| {
        if covers.iter().all(|c| c.at.distance(cover.at) > APART_M) {
            covers.push(cover);
        }
    };
    let mapped = map.iter().flat_map(|m| &m.furniture).filter(|f| f.kind == FurnitureKind::Manhole);
    for at in mapped.map(|f| f.position).filter(|&p| regions.iter().any(|r| r.area.iter().any(|a| a.contains(p)))) {
        add(&mut covers, Cover { kind: CoverKind::Round, at, along: DVec2::X });
    }
    for region in regions {
        let mut random = region.seed.child("covers").random();
        for lane in &region.lanes {
            let path = Path::new(lane);
            let mut s_m = random.range(2.0, 2.0 * COVER_EVERY_M);
            while s_m < path.length_m() {
                let cover = drawn(&path, s_m, &mut random);
                let inside = |p: &DVec2| region.area.iter().any(|a| a.contains(*p));
                if cover.area().exterior.iter().all(inside) {
                    add(&mut covers, cover);
                }
                s_m += random.range(0.5, 1.5) * COVER_EVERY_M;
            }
        }
    }
    for ring in kerbs.iter().flat_map(Polygon::rings) {
        let mut ahead_m = GRATING_EVERY_M / 2.0;
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let length_m = a.distance(b);
            let along = (b - a).normalize_or(DVec2::X);
            while ahead_m < length_m {
                // Rings run with the carriageway on their left.
                let at = a + along * ahead_m + along.perp() * (CoverKind::Grating.size_m().y / 2.0 + 0.03);
                // A grating stands on a straight piece of kerb.
                let straight = (0.5..length_m - 0.5).contains(&ahead_m);
                if straight && near.iter().any(|n| n.contains(at)) {
                    add(&mut covers, Cover { kind: CoverKind::Grating, at, along });
                }
                ahead_m += GRATING_EVERY_M;
            }
            ahead_m -= length_m;
        }
    }
    covers
}

fn drawn(path: &Path<'_>, s_m: f64, random: &mut Random) -> Cover {
    let kind = if random.chance(0.75) { CoverKind::Round } else { CoverKind::Square };
    // Sewers run under the middle of lanes, cables nearer to their edge.
    let offset_m = if kind == CoverKind::Round { 0.3 * random.normal() } else { random.range(-1.1, 1.1) };
    let along = path.at(s_m).1;
    let turn = if kind == CoverKind::Round { random.range(0.0, 6.3) } else { 0.0 };
    Cover { kind, at: path.beside(s_m, offset_m.clamp(-1.2, 1.2)), along: along.rotate(DVec2::from_angle(turn)) }
}

/// The covers of a kind as one mesh, each with its whole texture.
pub(super) fn mesh(covers: &[Cover], kind: CoverKind, drape: &Drape<'_>, lift_m: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for cover in covers.iter().filter(|c| c.kind == kind) {
        let mut one = drape.surface(&[cover.area()], lift_m);
        for (uv, p) in one.uvs.iter_mut().zip(&one.positions) {
            let from = p.truncate().as_dvec2() - cover.at;
            let local = DVec2::new(from.dot(cover.along), from.dot(cover.along.perp())) + kind.size_m() / 2.0;
            *uv = Vec2::new(local.x as f32, local.y as f32);
        }
        mesh.append(&one, 0);
    }
    mesh
}
