//! What stands in a scene and who moves in it, in few triangles and plain colours.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DAffine3, DVec3, Vec3, Vec4};
use meshopt::{SimplifyOptions, VertexDataAdapter};
use rayon::prelude::*;
use serde::Serialize;
use trove_model::{Material, Mesh, Texture};
use trove_write::colors::of_albedo;

use super::pose::{Pose, pose};

/// Triangles of what stands still, as often as they are placed.
const MOST_TRIANGLES: usize = 240_000;
/// Of the same while it moves, on machines that draw slowly.
const MOST_COARSE: usize = 3_500;
/// Their detail, radians.
const COARSE_RAD: f32 = 0.03;
/// Of a road user.
const MOST_OF_BODY: usize = 1_200;
/// Detail that a viewer on the recorded way sees, radians, to begin with and by how much it grows until all fits.
const FINEST_RAD: f32 = 0.0012;
const COARSER: f32 = 1.5;
/// Nearer than this nothing stands to the way, metres.
const NEAREST_M: f64 = 6.0;
/// Distances of one level of detail, as a power of 2.
const LEVELS: i32 = 7;
/// Side of a tile of the ground, metres.
const TILE_M: f32 = 40.0;
/// Detail of a road user, metres.
const BODY_DETAIL_M: f32 = 0.012;
/// Triangles a separate piece, below which a part is foliage: it is thinned out, since its pieces have no edges to collapse.
const OF_FOLIAGE: usize = 12;

/// The shapes of a scene.
#[derive(Default, Serialize)]
pub(super) struct Shapes {
    meshes: Vec<Packed>,
    /// What stands still.
    stands: Vec<Placed>,
    /// The same in few triangles.
    coarse: Vec<Placed>,
    /// Who moves, by the number in the labels, in axes of its box.
    bodies: BTreeMap<u32, Vec<Placed>>,
}

/// A mesh, little-endian, in Base64.
#[derive(Serialize)]
struct Packed {
    /// Smallest corner and size, metres.
    from: [f32; 3],
    size: [f32; 3],
    /// Three numbers a vertex, 0 to 65,535 from one end to the other.
    positions: String,
    /// Three bytes a vertex, sRGB.
    colors: String,
    /// Three numbers of vertices each, 16 bits where there are no more than 65,536 vertices, else 32.
    triangles: String,
    vertices: usize,
}

/// A mesh somewhere.
#[derive(Serialize)]
struct Placed {
    mesh: usize,
    pose: Pose,
}

/// A mesh in its materials, or a tile of a wide one, at a level of detail.
type Key = (usize, Vec<usize>, Option<[i32; 2]>, i32);

/// A mesh that is to be shown somewhere.
#[derive(Clone, Copy)]
pub(super) struct Stand<'a> {
    pub(super) mesh: usize,
    /// The material of each of its slots.
    pub(super) materials: &'a [usize],
    /// From the mesh to World, or of who moves to its box.
    pub(super) place: DAffine3,
}

/// Meshes and materials that are looked up by their indices.
#[derive(Clone, Copy)]
pub(super) struct Stock<'a> {
    pub(super) meshes: &'a [Arc<Mesh>],
    pub(super) materials: &'a [Material],
}

impl Shapes {
    /// Of what stands still, seen from a way.
    pub(super) fn of(stock: Stock, stands: &[Stand], way: &[DVec3]) -> Self {
        let looks = Looks::of(stock.materials);
        let mut places: BTreeMap<Key, Vec<DAffine3>> = BTreeMap::new();
        let mut tiles_of: BTreeMap<usize, Tiles> = BTreeMap::new();
        for Stand { mesh, materials, place } in stands {
            for (tile, (bounds, _)) in tiles_of.entry(*mesh).or_insert_with(|| tiles(&stock.meshes[*mesh])) {
                let key = (*mesh, materials.to_vec(), *tile, level(*bounds, place, way));
                places.entry(key).or_default().push(*place);
            }
        }
        let whole = |(mesh, materials, tile, _): &Key| {
            Few::of(&stock.meshes[*mesh], &tiles_of[mesh][tile].1, materials, &looks, tile.is_some())
        };
        let keys: Vec<&Key> = places.keys().collect();
        let mut few: BTreeMap<&Key, Few> = keys.into_par_iter().map(|key| (key, whole(key))).collect();
        let mut shapes = Self::default();
        let mut detail_rad = FINEST_RAD;
        let placed = |key: &Key, mesh: &Few| mesh.triangles() * places[key].len();
        loop {
            few = reduced(few, &places, detail_rad, Edges::Kept);
            if few.iter().map(|(key, mesh)| placed(key, mesh)).sum::<usize>() <= MOST_TRIANGLES {
                break;
            }
            detail_rad *= COARSER;
        }
        shapes.stands = shapes.place(few.iter().map(|(key, mesh)| (mesh, &places[*key])));
        few = reduced(few, &places, COARSE_RAD, Edges::Free);
        // First what is large in the picture for what it costs.
        let worth = |key: &Key, mesh: &Few| (mesh.size() / distance_m(key.3)).powi(2) / mesh.triangles().max(1) as f32;
        let mut ranked: Vec<_> = few.iter().map(|(key, mesh)| (worth(key, mesh), *key, mesh)).collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut left = MOST_COARSE;
        ranked.retain(|(_, key, mesh)| {
            let triangles = placed(key, mesh);
            let fits = triangles <= left;
            left -= if fits { triangles } else { 0 };
            fits
        });
        shapes.coarse = shapes.place(ranked.into_iter().map(|(_, key, mesh)| (mesh, &places[key])));
        shapes
    }

    fn place<'a>(&mut self, meshes: impl Iterator<Item = (&'a Few, &'a Vec<DAffine3>)>) -> Vec<Placed> {
        let mut placed = Vec::new();
        for (mesh, places) in meshes {
            let Some(mesh) = self.add(mesh) else { continue };
            placed.extend(places.iter().map(|place| Placed { mesh, pose: pose(place) }));
        }
        placed
    }

    /// Adds who is not yet known, by numbers; places are in axes of their boxes.
    pub(super) fn add_bodies(&mut self, stock: Stock, bodies: &[(u32, Stand)]) {
        let looks = Looks::of(stock.materials);
        let known: BTreeSet<u32> = self.bodies.keys().copied().collect();
        let mut meshes: BTreeMap<(usize, &[usize]), Option<usize>> = BTreeMap::new();
        for (id, Stand { mesh, materials, place }) in bodies.iter().filter(|(id, _)| !known.contains(id)) {
            let mesh = *meshes.entry((*mesh, materials)).or_insert_with(|| {
                let all: Vec<usize> = (0..stock.meshes[*mesh].triangles.len()).collect();
                let mut few = Few::of(&stock.meshes[*mesh], &all, materials, &looks, false);
                let mut detail_m = BODY_DETAIL_M / scale(place).max(1e-6);
                loop {
                    few = few.reduced(detail_m, Edges::Kept);
                    if few.triangles() <= MOST_OF_BODY {
                        break self.add(&few);
                    }
                    detail_m *= COARSER;
                }
            });
            let placed = mesh.map(|mesh| Placed { mesh, pose: pose(place) });
            self.bodies.entry(*id).or_default().extend(placed);
        }
    }

    fn add(&mut self, few: &Few) -> Option<usize> {
        self.meshes.push(few.packed()?);
        Some(self.meshes.len() - 1)
    }
}

/// Meshes with the details left out that are smaller than this from the way.
fn reduced<'k>(
    few: BTreeMap<&'k Key, Few>,
    places: &BTreeMap<Key, Vec<DAffine3>>,
    detail_rad: f32,
    edges: Edges,
) -> BTreeMap<&'k Key, Few> {
    let coarser = |(key, mesh): (&'k Key, Few)| {
        let largest = places[key].iter().map(scale).fold(1e-6, f32::max);
        (key, mesh.reduced(detail_rad * distance_m(key.3) / largest, edges))
    };
    few.into_par_iter().map(coarser).collect()
}

/// Bounds and triangles.
type Tiles = BTreeMap<Option<[i32; 2]>, ((Vec3, Vec3), Vec<usize>)>;

/// A mesh as a whole, and a wide one tile by tile, since it is near to the way in one place and far elsewhere.
fn tiles(mesh: &Mesh) -> Tiles {
    let is_wide = mesh.bounds().is_some_and(|(lo, hi)| (hi - lo).truncate().max_element() > 2.0 * TILE_M);
    let mut tiles = Tiles::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        let middle = corners.into_iter().sum::<Vec3>() / 3.0;
        let tile = is_wide.then(|| [middle.x, middle.y].map(|at| (at / TILE_M).floor() as i32));
        let (bounds, triangles) = tiles.entry(tile).or_insert_with(|| ((corners[0], corners[0]), Vec::new()));
        *bounds = corners.iter().fold(*bounds, |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        triangles.push(t);
    }
    tiles
}

/// How fine something is to be for the nearest point of the way, of [`LEVELS`].
fn level((lo, hi): (Vec3, Vec3), world_from_mesh: &DAffine3, way: &[DVec3]) -> i32 {
    let centre = world_from_mesh.transform_point3(((lo + hi) * 0.5).as_dvec3());
    let radius = 0.5 * f64::from((hi - lo).length()) * f64::from(scale(world_from_mesh));
    let nearest_m = way.iter().map(|p| p.distance(centre)).fold(f64::INFINITY, f64::min) - radius;
    ((nearest_m.max(NEAREST_M) / NEAREST_M).log2().floor() as i32).min(LEVELS)
}

fn distance_m(level: i32) -> f32 {
    NEAREST_M as f32 * 2f32.powi(level)
}

fn scale(affine: &DAffine3) -> f32 {
    let axes = affine.matrix3;
    axes.x_axis.length().max(axes.y_axis.length()).max(axes.z_axis.length()) as f32
}

/// Whether the edges of tiles stay where their neighbours' are.
#[derive(Clone, Copy, PartialEq)]
enum Edges {
    Kept,
    Free,
}

/// A mesh as it is drawn, part by part: each of one slot, its vertices welded where they meet.
struct Few {
    parts: Vec<Part>,
}

struct Part {
    positions: Vec<Vec3>,
    colors: Vec<Vec3>,
    triangles: Vec<u32>,
    is_foliage: bool,
    /// A tile, whose edges stay where its neighbours' are.
    is_tile: bool,
}

impl Few {
    fn of(mesh: &Mesh, triangles: &[usize], materials: &[usize], looks: &Looks, is_tile: bool) -> Self {
        let mut parts = Vec::new();
        for slot in 0..mesh.slot_count() {
            let Some(look) = materials.get(slot).map(|m| &looks.0[*m]) else { continue };
            let mut part =
                Part { positions: Vec::new(), colors: Vec::new(), triangles: Vec::new(), is_foliage: false, is_tile };
            let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
            for t in triangles.iter().filter(|t| usize::from(mesh.slot(**t)) == slot) {
                for corner in mesh.triangles[*t] {
                    let position = mesh.positions[corner as usize];
                    let index = *known.entry(position.to_array().map(f32::to_bits)).or_insert_with(|| {
                        part.positions.push(position);
                        let tint = mesh.tints.get(corner as usize).copied().unwrap_or(Vec3::ONE);
                        part.colors.push(look.color * tint);
                        part.positions.len() as u32 - 1
                    });
                    part.triangles.push(index);
                }
            }
            part.settle(look.coverage);
            parts.push(part);
        }
        Self { parts }
    }

    fn reduced(self, detail: f32, edges: Edges) -> Self {
        Self { parts: self.parts.into_iter().filter_map(|part| part.reduced(detail, edges)).collect() }
    }

    /// The longest side of what holds it.
    fn size(&self) -> f32 {
        let points = self.parts.iter().flat_map(|part| part.triangles.iter().map(|i| part.positions[*i as usize]));
        let (lo, hi) = points.fold((Vec3::MAX, Vec3::MIN), |(lo, hi), p| (lo.min(p), hi.max(p)));
        (hi - lo).max_element().max(0.0)
    }

    fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len() / 3).sum()
    }

    fn packed(&self) -> Option<Packed> {
        let (mut positions, mut colors, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        for part in &self.parts {
            let mut new: BTreeMap<u32, u32> = BTreeMap::new();
            for corner in &part.triangles {
                triangles.push(*new.entry(*corner).or_insert_with(|| {
                    positions.push(part.positions[*corner as usize]);
                    colors.push(part.colors[*corner as usize]);
                    positions.len() as u32 - 1
                }));
            }
        }
        let first = *positions.first()?;
        let (from, to) = positions.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let size = to - from;
        let steps = size.map(|side| if side > 0.0 { 65_535.0 / side } else { 0.0 });
        let positions_b: Vec<u8> = positions
            .iter()
            .flat_map(|p| ((*p - from) * steps).to_array())
            .flat_map(|step| (step.round() as u16).to_le_bytes())
            .collect();
        let colors_b: Vec<u8> = colors.iter().flat_map(|color| of_albedo(color.to_array())).collect();
        let triangles_b: Vec<u8> = if positions.len() <= 65_536 {
            triangles.iter().flat_map(|i| (*i as u16).to_le_bytes()).collect()
        } else {
            triangles.iter().flat_map(|i| i.to_le_bytes()).collect()
        };
        Some(Packed {
            from: from.to_array(),
            size: size.to_array(),
            positions: STANDARD.encode(positions_b),
            colors: STANDARD.encode(colors_b),
            triangles: STANDARD.encode(triangles_b),
            vertices: positions.len(),
        })
    }
}

impl Part {
    /// Tells foliage apart, and makes its cards as large as what of them is there.
    fn settle(&mut self, coverage: f32) {
        let pieces = self.pieces();
        self.is_foliage = pieces.len() > 50 && self.triangles.len() / 3 < OF_FOLIAGE * pieces.len();
        if self.is_foliage && coverage < 1.0 {
            self.grow(&pieces, coverage.sqrt());
        }
    }

    /// Triangles that hang together, as the places of their first corners.
    fn pieces(&self) -> Vec<Vec<usize>> {
        let mut root: Vec<u32> = (0..self.positions.len() as u32).collect();
        fn find(root: &mut [u32], mut i: u32) -> u32 {
            while root[i as usize] != i {
                root[i as usize] = root[root[i as usize] as usize];
                i = root[i as usize];
            }
            i
        }
        for t in self.triangles.chunks_exact(3) {
            let first = find(&mut root, t[0]);
            for corner in &t[1..] {
                let other = find(&mut root, *corner);
                root[other as usize] = first;
            }
        }
        let mut pieces: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for at in (0..self.triangles.len()).step_by(3) {
            pieces.entry(find(&mut root, self.triangles[at])).or_default().push(at);
        }
        pieces.into_values().collect()
    }

    /// Makes pieces larger or smaller about their middles.
    fn grow(&mut self, pieces: &[Vec<usize>], factor: f32) {
        for piece in pieces {
            let corners: BTreeSet<u32> = piece.iter().flat_map(|at| &self.triangles[*at..at + 3]).copied().collect();
            let middle = corners.iter().map(|i| self.positions[*i as usize]).sum::<Vec3>() / corners.len() as f32;
            for i in corners {
                let position = &mut self.positions[i as usize];
                *position = middle + (*position - middle) * factor;
            }
        }
    }

    /// With details smaller than this left out; `None` where nothing is left.
    fn reduced(mut self, detail: f32, edges: Edges) -> Option<Self> {
        let (lo, hi) = self.positions.iter().fold((Vec3::MAX, Vec3::MIN), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        if (hi - lo).max_element() < 2.0 * detail {
            return None;
        }
        if self.is_foliage {
            return self.thinned(detail);
        }
        let bytes: Vec<u8> = self.positions.iter().flat_map(|p| p.to_array()).flat_map(f32::to_ne_bytes).collect();
        let vertices = VertexDataAdapter::new(&bytes, 12, 0).ok()?;
        let of_edges =
            if self.is_tile && edges == Edges::Kept { SimplifyOptions::LockBorder } else { SimplifyOptions::Prune };
        let options = SimplifyOptions::ErrorAbsolute | of_edges;
        self.triangles = meshopt::simplify(&self.triangles, &vertices, 0, detail, options, None);
        (!self.triangles.is_empty()).then_some(self)
    }

    /// Fewer pieces of the same area together, once they are smaller than the detail (after Cook et al. 2007).
    fn thinned(mut self, detail: f32) -> Option<Self> {
        let pieces = self.pieces();
        let area: f32 = self.triangles.chunks_exact(3).map(|t| self.area(t)).sum();
        let side = (area / pieces.len().max(1) as f32).sqrt();
        // Twice the detail is still seen as a leaf.
        let stride =
            ((2.0 * detail / side.max(1e-6)).powi(2).floor() as usize).clamp(1, pieces.len().div_ceil(8).max(1));
        if stride == 1 {
            return Some(self);
        }
        let kept: Vec<Vec<usize>> = pieces.into_iter().step_by(stride).collect();
        self.grow(&kept, (stride as f32).sqrt());
        self.triangles = kept.iter().flatten().flat_map(|at| self.triangles[*at..at + 3].to_vec()).collect();
        Some(self)
    }

    fn area(&self, triangle: &[u32]) -> f32 {
        let at = |i: usize| self.positions[triangle[i] as usize];
        0.5 * (at(1) - at(0)).cross(at(2) - at(0)).length()
    }
}

/// What is left of materials where no maps are drawn.
struct Looks(Vec<Look>);

struct Look {
    color: Vec3,
    /// Share of a cut-out map that is there.
    coverage: f32,
}

impl Looks {
    fn of(materials: &[Material]) -> Self {
        let mut means: BTreeMap<*const Texture, (Vec4, f32)> = BTreeMap::new();
        let mut look = |material: &Material| {
            let map = material.base_color_map.as_ref();
            let (mean, coverage) = map.map_or((Vec4::ONE, 1.0), |map| {
                *means.entry(Arc::as_ptr(map)).or_insert_with(|| map.mean(material.alpha_cutoff))
            });
            let seen = material.base_color * mean.truncate();
            // Glass is dark from outside.
            let color = seen * (1.0 - 0.85 * material.transmission) + material.emission.min(Vec3::ONE);
            Look { color, coverage }
        };
        Self(materials.iter().map(&mut look).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looks() -> Looks {
        Looks::of(&[Material { base_color: Vec3::new(1.0, 0.2, 0.0), ..Material::default() }])
    }

    fn whole(mesh: &Mesh) -> Few {
        let all: Vec<usize> = (0..mesh.triangles.len()).collect();
        Few::of(mesh, &all, &[0], &looks(), false)
    }

    /// Squares of a metre, side by side in a plane that is bent up by a metre at one edge.
    fn field(side: u32) -> Mesh {
        let at = |i: u32| Vec3::new((i % (side + 1)) as f32, (i / (side + 1)) as f32, 0.0);
        let positions = (0..(side + 1) * (side + 1)).map(at);
        let lifted = positions.map(|p| if p.x >= side as f32 { p + Vec3::Z } else { p });
        let square = |i: u32| {
            let a = i / side * (side + 1) + i % side;
            [[a, a + 1, a + side + 1], [a + 1, a + side + 2, a + side + 1]]
        };
        Mesh { positions: lifted.collect(), triangles: (0..side * side).flat_map(square).collect(), ..Mesh::default() }
    }

    #[test]
    fn what_is_flat_takes_few_triangles_and_what_is_not_keeps_its_shape() {
        let few = whole(&field(60)).reduced(0.05, Edges::Kept);
        assert!(few.triangles() < 500, "{} of 7,200 triangles", few.triangles());
        let packed = few.packed().unwrap();
        assert_eq!((packed.from, packed.size), ([0.0; 3], [60.0, 60.0, 1.0]));
        let colors = STANDARD.decode(&packed.colors).unwrap();
        assert!(colors.chunks(3).all(|rgb| rgb == [255, 124, 0]), "sRGB of the material's colour, IEC 61966-2-1");
        assert_eq!(STANDARD.decode(&packed.positions).unwrap().len(), 6 * packed.vertices);
        assert_eq!(whole(&field(60)).reduced(40.0, Edges::Kept).triangles(), 0, "smaller than the detail");
    }

    #[test]
    fn fewer_leaves_cover_the_same_area() {
        let mut leaves = Mesh::default();
        for i in 0..4000u32 {
            let middle = Vec3::new((i % 20) as f32, (i / 20 % 20) as f32, (i / 400) as f32);
            let leaf = [Vec3::ZERO, Vec3::X * 0.1, Vec3::Y * 0.1].map(|corner| middle + corner);
            leaves.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
            leaves.positions.extend(leaf);
        }
        let area = |few: &Few| -> f32 {
            let of = |part: &Part| -> f32 { part.triangles.chunks_exact(3).map(|t| part.area(t)).sum() };
            few.parts.iter().map(of).sum()
        };
        let all = whole(&leaves);
        let before = area(&all);
        let few = all.reduced(0.2, Edges::Kept);
        assert!((8..1000).contains(&few.triangles()), "{} leaves", few.triangles());
        assert!((area(&few) / before - 1.0).abs() < 0.05, "{} of {before} m²", area(&few));
    }

    #[test]
    fn a_wide_ground_is_fine_beside_the_way_alone() {
        let mut ground = field(400);
        ground.positions.iter_mut().for_each(|p| p.z = 0.3 * (p.x * 0.7).sin() * (p.y * 0.9).cos());
        let stock = Stock { meshes: &[Arc::new(ground)], materials: &[Material::default()] };
        let stands = [Stand { mesh: 0, materials: &[0], place: DAffine3::IDENTITY }];
        let shapes = Shapes::of(stock, &stands, &[DVec3::new(20.0, 20.0, 1.0)]);
        let triangles = |at: f32| -> usize {
            let here =
                |mesh: &&Packed| mesh.from[0].max(mesh.from[1]) <= at && at <= mesh.from[0].max(mesh.from[1]) + 40.0;
            let stands = shapes.stands.iter().map(|placed| &shapes.meshes[placed.mesh]);
            stands.filter(here).map(|mesh| STANDARD.decode(&mesh.triangles).unwrap().len() / 6).max().unwrap()
        };
        assert!(triangles(20.0) > 4 * triangles(380.0), "{} near, {} far", triangles(20.0), triangles(380.0));
        let coarse: usize = shapes
            .coarse
            .iter()
            .map(|placed| STANDARD.decode(&shapes.meshes[placed.mesh].triangles).unwrap().len() / 6)
            .sum();
        assert!(coarse > 0 && coarse <= MOST_COARSE, "{coarse}");
    }
}
