//! The road's surface as years have left it, in layers a millimetre or two above each other.
//!
//! The whole carriageway lies below in one piece. Near the driven path stretches of their own age and material lie on
//! it, with what wheels leave on them; then patches, sealed cracks and drips, coats, paint and iron covers. Layers are
//! apart by more than what rays take for one surface, and within a layer nothing overlaps.

pub(super) mod alignment;
mod damage;
mod ironwork;
mod stretches;
mod tone;

use std::collections::BTreeMap;

use glam::{DVec2, Vec3};
use rayon::prelude::*;
use trove_model::{
    Class, Drive, FurnitureKind, Material, Mesh, Paint, Polygon, RoadSurfaceCustoms, Seed, StreetMap, SurfaceKind,
};

use self::damage::{Damage, Spot, damage};
use self::ironwork::CoverKind;
use self::stretches::{Look, Region};
use self::tone::Tone;
use super::layout::Layout;
use super::markings::Markings;
use super::seed_name::seed_name;
use crate::geometry::plane::{difference, grown, intersection, rectangle, strip};
use crate::geometry::segments::SegmentIndex;
use crate::ground::Drape;
use crate::pieces::Palette;
use crate::pieces::Piece;

/// Up to this distance from the driven path the road is more than one surface.
const NEAR_M: f64 = 90.0;
/// How much the layers lie above the carriageway.
const STRETCH_M: f64 = 0.0015;
const PATCH_M: f64 = 0.003;
const TRACE_M: f64 = 0.0045;
const COAT_M: f64 = 0.006;
pub(super) const PAINT_M: f64 = 0.0075;
const COVER_M: f64 = 0.009;
/// A piece of kerb at least this long is straight enough to lay paving along.
const STRAIGHT_M: f64 = 3.0;
/// Bitumen in joints, as a factor on aged asphalt.
const JOINT_TONE: f64 = 0.3;
/// Red paint, as a factor on white.
const RED: Vec3 = Vec3::new(0.72, 0.09, 0.07);

/// The part of the plane near the driven path.
pub(super) fn near(drive: &Drive) -> Vec<Polygon> {
    let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let driven = strip(&path, 1.0);
    let standing = path.first().map(|&p| rectangle(trove_model::Bounds::square(p, 2.0)));
    grown(&if driven.is_empty() { standing.into_iter().collect() } else { driven }, NEAR_M)
}

/// What the surface of a place's roads is made from.
pub(super) struct Surfacing<'a> {
    pub drive: &'a Drive,
    pub map: Option<&'a StreetMap>,
    pub layout: &'a Layout<'a>,
    pub markings: &'a Markings,
    pub near: &'a [Polygon],
    pub customs: &'a RoadSurfaceCustoms,
    pub palette: &'a Palette<'a>,
    pub drape: &'a Drape<'a>,
    pub seed: Seed,
}

impl Surfacing<'_> {
    /// Everything that lies on the road, class road.
    pub(super) fn pieces(&self) -> Vec<Piece> {
        let tone = Tone::new(self.seed.child("tone"));
        let mut meshes: BTreeMap<(u8, Look), Mesh> = BTreeMap::new();
        let mut add = |layer: u8, look: Look, mesh: &Mesh| meshes.entry((layer, look)).or_default().append(mesh, 0);

        let mut whole = self.drape.surface(&self.layout.carriageway, 0.0);
        self.tint(&mut whole, Look::Aged, tone, |_| 1.0);
        add(0, Look::Aged, &whole);

        let (inner, gutter) = self.gutter();
        let mut strip = self.drape.surface(&gutter, STRETCH_M);
        self.tint(&mut strip, Look::Concrete, tone, |p| 0.86 + 0.14 * tone.at(p, 2.0));
        add(1, Look::Concrete, &strip);

        let regions = stretches::regions(
            self.drive,
            self.layout,
            &inner,
            self.customs.concrete_share,
            tone,
            self.seed.child("stretches"),
        );
        let stops: Vec<DVec2> = self.furniture(FurnitureKind::BusStop);
        let built: Vec<(Mesh, Vec<Polygon>, Damage)> =
            regions.par_iter().map(|r| (self.stretch(r, tone), stretches::joints(r), damage(r, &stops))).collect();
        for (region, (mesh, joints, damage)) in regions.iter().zip(&built) {
            add(1, region.look, mesh);
            let joints = [Spot { area: joints.clone(), look: Look::Aged, tone: JOINT_TONE }];
            let layers = [(2, PATCH_M, &damage.patches[..]), (3, TRACE_M, &damage.traces), (3, TRACE_M, &joints)];
            for (layer, lift_m, spots) in layers {
                for spot in spots {
                    let mut mesh = self.drape.surface(&spot.area, lift_m);
                    self.tint(&mut mesh, spot.look, tone, |_| spot.tone);
                    add(layer, spot.look, &mesh);
                }
            }
        }
        let mut pieces: Vec<Piece> = meshes
            .into_iter()
            .filter(|(_, mesh)| !mesh.triangles.is_empty())
            .map(|((_, look), mesh)| {
                let (kind, tags) = look.surface();
                Piece::stuff(mesh, Class::Road, self.material(kind, tags))
            })
            .collect();
        pieces.extend(self.painted(tone));
        let covers = ironwork::covers(&regions, self.map, &self.layout.carriageway, self.near);
        for kind in CoverKind::ALL {
            let mesh = ironwork::mesh(&covers, kind, self.drape, COVER_M);
            if !mesh.triangles.is_empty() {
                pieces.push(Piece::stuff(mesh, Class::Road, self.material(SurfaceKind::RoadCover, &[kind.tag()])));
            }
        }
        pieces
    }

    /// Turns paving along the straight kerbs of its street.
    pub(super) fn align(&self, mesh: &mut Mesh) {
        let edges = self.layout.carriageway.iter().flat_map(Polygon::edges);
        let straight: Vec<[DVec2; 2]> =
            edges.filter(|(a, b)| a.distance(*b) > STRAIGHT_M).map(|(a, b)| [a, b]).collect();
        alignment::align(mesh, &SegmentIndex::new(straight.iter().map(|edge| &edge[..])));
    }

    fn furniture(&self, kind: FurnitureKind) -> Vec<DVec2> {
        let all = self.map.iter().flat_map(|m| &m.furniture);
        all.filter(|f| f.kind == kind).map(|f| f.position).collect()
    }

    fn material(&self, kind: SurfaceKind, tags: &[&str]) -> Material {
        self.palette.fitting(kind, tags, &mut self.seed.child(seed_name(kind)).random()).material
    }

    /// The carriageway near the path within the gutters, and the gutters.
    fn gutter(&self) -> (Vec<Polygon>, Vec<Polygon>) {
        let gutter_m = self.customs.gutter_m;
        // A little more than is near, so that no gutter runs where only the path's surroundings end.
        let road = intersection(&self.layout.carriageway, &grown(self.near, 2.0));
        if gutter_m == 0.0 {
            return (intersection(&road, self.near), Vec::new());
        }
        let inner = grown(&road, -gutter_m);
        (intersection(&inner, self.near), intersection(&difference(&road, &inner), self.near))
    }

    fn stretch(&self, region: &Region, tone: Tone) -> Mesh {
        let lanes = SegmentIndex::new(region.lanes.iter().map(Vec::as_slice));
        let mut mesh = Mesh::default();
        for (i, part) in stretches::tracked(region).iter().enumerate() {
            let mut piece = self.drape.surface(part, STRETCH_M);
            // Slabs were not cast on one day.
            let own =
                if region.look == Look::Concrete { 0.06 * tone.at(DVec2::new(i as f64 * 7.3, 0.5), 1.0) } else { 0.0 };
            self.tint(&mut piece, region.look, tone, |p| (region.tone + own) * stretches::track_tone(&lanes, tone, p));
            mesh.append(&piece, 0);
        }
        if matches!(region.look, Look::Setts | Look::Stones) {
            alignment::align(&mut mesh, &SegmentIndex::new([region.line.as_slice()]));
        }
        mesh
    }

    /// Tints a surface by its own tone, what the country's roads reflect, and some variation from place to place.
    fn tint(&self, mesh: &mut Mesh, look: Look, tone: Tone, own: impl Fn(DVec2) -> f64) {
        let country = match look {
            Look::Aged | Look::Fresh => self.customs.road_tone * self.quarry(),
            // Roads are cast in paler concrete than yards.
            Look::Concrete => 1.12,
            _ => 1.0,
        };
        let at = |p: &Vec3| {
            let p = p.truncate().as_dvec2();
            let varied = 1.0 + 0.05 * tone.at(p, 23.0) + 0.04 * tone.at(p, 6.0);
            Vec3::splat((country * varied * own(p)) as f32)
        };
        mesh.tints = mesh.positions.iter().map(at).collect();
    }

    /// What a place's stones make of its asphalt: a factor of 0.7 to 1.4, mostly near 1.
    fn quarry(&self) -> f64 {
        (0.17 * self.seed.child("quarry").random().normal()).clamp(-0.35, 0.35).exp()
    }

    fn painted(&self, tone: Tone) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (tint, area) in &self.markings.coats {
            let mut mesh = self.drape.surface(area, COAT_M);
            mesh.tints = vec![*tint; mesh.positions.len()];
            let (kind, tags) = Look::Aged.surface();
            pieces.push(Piece::stuff(mesh, Class::Road, self.material(kind, tags)));
        }
        for (&paint, area) in &self.markings.paints {
            let mut mesh = self.drape.surface(area, PAINT_M);
            let (kind, color) = match paint {
                Paint::White => (SurfaceKind::MarkingWhite, Vec3::ONE),
                Paint::Yellow => (SurfaceKind::MarkingYellow, Vec3::ONE),
                Paint::Red => (SurfaceKind::MarkingWhite, RED),
            };
            // Paint is renewed street by street.
            let age = |p: &Vec3| (0.84 + 0.16 * tone.at(p.truncate().as_dvec2(), 31.0)) as f32;
            mesh.tints = mesh.positions.iter().map(|p| color * age(p)).collect();
            pieces.push(Piece::stuff(mesh, Class::Road, self.material(kind, &[])));
        }
        pieces.retain(|piece| !piece.mesh.triangles.is_empty());
        pieces
    }
}
