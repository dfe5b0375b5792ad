//! Facades with depth, by split rules (after Müller, Wonka, Haegler, Ulmer, Van Gool: Procedural Modeling of Buildings,
//! 2006): a wall is split into storeys, storeys into bays, bays into openings, and each opening is filled. Near walls
//! get frames, panes, rooms and all that stands out; walls further off have holes with the flat texture in them.

mod fixtures;
mod ink;
mod ornament;
mod scaffold;
mod shop;
mod skin;
mod window;

use glam::{DVec2, DVec3};
use trove_model::{FacadeDesign, Filling, Interior, Opening, Random, Seed};

use super::shell::{Shell, Slot};
use super::sight::Detail;
use super::wall::{Band, Wall};
use ink::{Ink, WallFrame};
use skin::{Cell, Row, Vertex, skin};
use window::{Hole, Room};

/// Floors of rooms lie this much above the storey's, and so clear of the ground.
const FLOOR_M: f64 = 0.02;
/// Floors and ceilings differ by up to this much from wall to wall, metres.
const LEVELS_M: f64 = 0.04;
/// Rows, cells and holes keep this far from each other and from the wall's edges, metres.
const SEAM_M: f64 = 0.012;
/// Smaller holes are left out, metres.
const LEAST_HOLE_M: f64 = 0.3;
/// Floors between rooms are this thick, metres.
const SLAB_M: f64 = 0.22;
/// Rooms take at most this share of what is behind a wall.
const ROOM_SHARE: f64 = 0.42;
/// Windows no further apart than this may share a room, up to a width, metres.
const NARROW_PIER_M: f64 = 0.5;
const WIDEST_ROOM_M: f64 = 9.5;
/// Shallower walks behind columns are not built, metres.
const LEAST_ARCADE_M: f64 = 1.2;
/// Bays that stand out do so by this, metres.
const ORIEL_M: f64 = 0.65;

/// A part of a wall between two heights under construction.
struct Work<'a, 'b> {
    ink: Ink<'a>,
    wall: &'b Wall,
    band: &'b Band<'b>,
    design: &'b FacadeDesign,
    full: bool,
    /// Storeys, their first floor and height.
    storeys: usize,
    storey_m: f64,
    bays: usize,
}

/// An opening on the wall's plane, its bay and storey counted on this wall.
#[derive(Clone, Copy)]
struct Placed<'a> {
    opening: &'a Opening,
    low: DVec2,
    high: DVec2,
    /// What of the building is its own, as seen from the front.
    room: [DVec2; 2],
    bay_x: [f64; 2],
    storey: usize,
}

/// Builds a straight wall between a band's bottom and top.
pub(super) fn relief(shell: &mut Shell, wall: &Wall, band: &Band<'_>, design: &FacadeDesign, seed: Seed) {
    let (a, b) = (wall.line[0], wall.line[wall.line.len() - 1]);
    let mut frame = WallFrame::between(a, b);
    frame.mitre = wall.mitre;
    let storeys = band.storeys.round().max(1.0) as usize;
    let mut work = Work {
        bays: band.grid.bays(frame.length_m),
        ink: Ink { shell, frame },
        wall,
        band,
        design,
        full: wall.detail == Detail::Full,
        storeys,
        storey_m: (band.top_m - band.floor_m) / storeys as f64,
    };
    work.build(&mut seed.nth(wall.number).child(if band.is_uppermost { "upper" } else { "ground" }).random());
}

impl<'b> Work<'_, 'b> {
    fn length_m(&self) -> f64 {
        self.ink.frame.length_m
    }

    fn floor(&self, storey: usize) -> f64 {
        self.band.floor_m + self.storey_m * storey as f64
    }

    fn build(&mut self, random: &mut Random) {
        let length_m = self.length_m();
        let whole = [SEAM_M, length_m - SEAM_M];
        let arcade_m = f64::from(self.design.arcade_m).min(ROOM_SHARE * self.wall.thick_m);
        let has_arcade = arcade_m >= LEAST_ARCADE_M && self.wall.is_front && self.bays > 0;
        // Behind openings nearer to a corner the reveals of both walls would cross.
        let reveal_m = f64::from(self.design.recess_m) + window::INNER_REVEAL_M + SEAM_M;
        let [from, to] = self.wall.corner.map(|cot| cot * reveal_m + SEAM_M);
        let within = [from, length_m - to];
        let oriels = self.oriels(random);
        let (mut rows, mut pits, mut placed) = (Vec::new(), Vec::new(), Vec::new());
        for storey in 0..self.storeys {
            let y = [self.floor(storey) + SEAM_M, self.floor(storey) + self.storey_m - SEAM_M];
            let mut openings = self.openings(storey, within);
            if has_arcade {
                let [from, to] = self.wall.corner.map(|cot| 0.45 + cot * (arcade_m + 0.3));
                let (low, high) =
                    (DVec2::new(from, y[0] + 0.02), DVec2::new(length_m - to, y[1] - 0.16 * self.storey_m));
                if high.x - low.x > 1.5 {
                    pits.push((low, high, arcade_m, openings));
                    rows.push(Row { y, cells: vec![Cell { x: whole, hole: Some([low, high]) }] });
                    continue;
                }
            }
            let mut cells = self.cells(&openings, whole);
            for &bay in oriels.iter().filter(|_| storey + 1 < self.storeys || self.storeys == 1) {
                let [x0, x1] = self.bay(bay);
                if x1 - x0 < 1.9 || cells.iter().filter(|c| c.x[0] < x1 - 0.1 && c.x[1] > x0 + 0.1).count() != 1 {
                    continue;
                }
                let (low, high) = (DVec2::new(x0 + 0.2, y[0] + 0.04), DVec2::new(x1 - 0.2, y[1] - 0.04));
                let inside = |o: &Placed<'_>| o.low.x > low.x && o.high.x < high.x;
                let (in_oriel, rest): (Vec<_>, Vec<_>) = openings.iter().copied().partition(inside);
                openings = rest;
                for cell in cells.iter_mut().filter(|c| c.x[0] < x1 - 0.1 && c.x[1] > x0 + 0.1) {
                    cell.hole = Some([low, high]);
                }
                pits.push((low, high, -ORIEL_M, in_oriel));
            }
            rows.push(Row { y, cells });
            placed.extend(openings);
        }
        self.skin(&self.outline(), &rows);
        for (low, high, depth_m, openings) in pits {
            self.pit(low, high, depth_m, &openings, random);
        }
        self.fill_all(&placed, random);
        if self.full {
            self.decorate(&placed, random);
        }
    }

    /// Bays that stand out, on fronts of at least three storeys.
    fn oriels(&self, random: &mut Random) -> Vec<usize> {
        let share = f64::from(self.design.fixtures.oriels);
        if share <= 0.0 || !self.wall.is_front || self.storeys < 2 || self.wall.thick_m < 6.0 {
            return Vec::new();
        }
        let mut found: Vec<usize> = Vec::new();
        for bay in 0..self.bays {
            if random.chance(share) && found.last().is_none_or(|last| last + 1 < bay) {
                found.push(bay);
            }
        }
        found
    }

    fn bay(&self, bay: usize) -> [f64; 2] {
        let wide = self.length_m() / self.bays as f64;
        [wide * bay as f64, wide * (bay + 1) as f64]
    }

    /// Openings of a storey between two places along the wall, from left to right.
    fn openings(&self, storey: usize, within: [f64; 2]) -> Vec<Placed<'b>> {
        let design: &'b FacadeDesign = self.design;
        let mut found: Vec<Placed<'b>> = Vec::new();
        for bay in 0..self.bays {
            let [x0, x1] = self.bay(bay);
            let scale = DVec2::new((x1 - x0) / self.band.grid.bay_m, self.storey_m / self.band.grid.storey_m);
            let origin = DVec2::new(x0, self.floor(storey));
            for opening in design.openings(self.wall.first_bay + bay, self.band.first_storey + storey) {
                let least = DVec2::new(x0.max(within[0]) + SEAM_M, origin.y + 2.0 * SEAM_M + 0.01);
                let most = DVec2::new(x1.min(within[1]) - SEAM_M, origin.y + self.storey_m - 2.0 * SEAM_M - 0.01);
                let low = origin + opening.low_m.as_dvec2() * scale;
                let high = (low + opening.size_m.as_dvec2() * scale).min(most);
                let low = low.max(least);
                if (high - low).min_element() > LEAST_HOLE_M {
                    let top = origin.y + self.storey_m - SLAB_M;
                    let room = [DVec2::new(x0 + 0.02, origin.y + 0.03), DVec2::new(x1 - 0.02, top)];
                    found.push(Placed { opening, low, high, room, bay_x: [x0, x1], storey });
                }
            }
        }
        found.sort_by(|p, q| p.low.x.total_cmp(&q.low.x));
        for i in 1..found.len() {
            let middle = (found[i - 1].high.x + found[i].low.x) / 2.0;
            found[i - 1].room[1].x = found[i - 1].room[1].x.min(middle - 0.02);
            found[i].room[0].x = found[i].room[0].x.max(middle + 0.02);
        }
        found
    }

    /// Cells around openings, which fill a stretch of the wall.
    fn cells(&self, openings: &[Placed<'_>], [from, to]: [f64; 2]) -> Vec<Cell> {
        let mut cells: Vec<Cell> = Vec::new();
        let mut at = from;
        for (i, placed) in openings.iter().enumerate() {
            let until = match openings.get(i + 1) {
                Some(next) => (placed.high.x + next.low.x) / 2.0,
                None => to,
            };
            cells.push(Cell { x: [at, until], hole: Some([placed.low, placed.high]) });
            at = until;
        }
        if cells.is_empty() {
            cells.push(Cell { x: [from, to], hole: None });
        }
        cells
    }

    /// The wall's own outline, with the corners that it has in common with its neighbours.
    fn outline(&self) -> [Vec<Vertex>; 4] {
        let line = &self.wall.line;
        let along = |p: DVec2| (p - line[0]).dot((line[line.len() - 1] - line[0]).normalize_or_zero());
        let (bottom, top) = (self.band.bottom_m, self.band.top_m);
        let vertex = |p: DVec2, y: f64| Vertex { world: p.extend(y), local: DVec2::new(along(p), y) };
        let across = |y: f64| line.iter().map(|&p| vertex(p, y)).collect::<Vec<_>>();
        let upright = |p: DVec2| {
            let mut heights = vec![bottom];
            if bottom < self.band.floor_m {
                heights.push(self.band.floor_m);
            }
            heights.push(top);
            heights.into_iter().map(|y| vertex(p, y)).collect::<Vec<_>>()
        };
        let reversed = |mut side: Vec<Vertex>| {
            side.reverse();
            side
        };
        [across(bottom), upright(line[line.len() - 1]), reversed(across(top)), reversed(upright(line[0]))]
    }

    /// Texture coordinates on the wall's plane.
    fn uv(&self, p: DVec2) -> DVec2 {
        if self.full {
            return p;
        }
        let (u0, u1) = self.band.grid.along(self.length_m(), self.wall.first_bay as f64);
        DVec2::new(u0 + (u1 - u0) * p.x / self.length_m(), self.band.v(p.y))
    }

    fn skin(&mut self, outline: &[Vec<Vertex>; 4], rows: &[Row]) {
        let slot = if self.full { self.band.wall } else { self.band.slot };
        let frame = self.ink.frame;
        let mut faces: Vec<Vec<(DVec3, DVec2)>> = Vec::new();
        skin(
            outline,
            rows,
            |p| frame.world(p.extend(0.0)),
            |face| {
                faces.push(face.iter().map(|v| (v.world, self.uv(v.local))).collect());
            },
        );
        for face in faces {
            self.ink.shell.face(slot, &face);
        }
    }

    /// A part of the wall that lies behind it, or before it where the depth is negative, with openings of its own.
    fn pit(&mut self, low: DVec2, high: DVec2, depth_m: f64, openings: &[Placed<'b>], random: &mut Random) {
        let behind = depth_m > 0.0;
        let wall = self.band.wall;
        let slots = if behind { [Slot::Slab, wall, Slot::Slab, wall] } else { [wall; 4] };
        // Its sides look inwards, or outwards where it stands before the wall.
        self.ink.tube(slots, low, high, [-depth_m, 0.0]);
        let ring = ink::ring(low, high);
        let own = self.ink.frame;
        self.ink.frame.set_back_m = depth_m;
        let frame = self.ink.frame;
        let at = |p: DVec2| Vertex { world: frame.world(p.extend(0.0)), local: p };
        let outline = [0, 1, 2, 3].map(|k| vec![at(ring[k]), at(ring[(k + 1) % 4])]);
        let margin = 2.0 * SEAM_M;
        let inside = |p: &Placed<'b>| {
            // Rooms of what stands before the wall stay in it.
            let room = if behind { p.room } else { [p.room[0].max(low + margin), p.room[1].min(high - margin)] };
            let (low, high) = (p.low.max(low + 2.0 * margin), p.high.min(high - 2.0 * margin));
            ((high - low).min_element() > LEAST_HOLE_M).then_some(Placed { low, high, room, ..*p })
        };
        let openings: Vec<Placed<'b>> = openings.iter().filter_map(inside).collect();
        let cells = self.cells(&openings, [low.x + SEAM_M, high.x - SEAM_M]);
        self.skin(&outline, &[Row { y: [low.y + SEAM_M, high.y - SEAM_M], cells }]);
        self.fill_all(&openings, random);
        self.ink.frame = own;
        if behind {
            self.columns(low, high);
        } else {
            let (from, to) = (low - DVec2::new(0.05, 0.14), DVec2::new(high.x + 0.05, low.y - 0.001));
            self.ink.block(Slot::Stone, from.extend(-0.02), to.extend(0.05 - depth_m));
        }
    }

    /// Columns before a walk, at the borders of bays.
    fn columns(&mut self, low: DVec2, high: DVec2) {
        for bay in 1..self.bays {
            let x = self.bay(bay)[0];
            if x > low.x + 0.9 && x < high.x - 0.9 {
                let (from, to) =
                    (DVec3::new(x - 0.25, low.y - 0.04, -0.5), DVec3::new(x + 0.25, high.y + 0.04, -0.015));
                self.ink.solid(self.band.wall, from, to);
            }
        }
    }

    /// Closes openings, which lie storey by storey from left to right, with rooms behind the glazed ones.
    fn fill_all(&mut self, placed: &[Placed<'_>], random: &mut Random) {
        for opening in placed {
            self.fill(opening, random);
        }
        if !self.full {
            return;
        }
        // Offices and shops have one room behind windows that hardly a pier parts.
        let is_glazed = |p: &Placed<'_>| matches!(p.opening.filling, Filling::Window | Filling::GlassDoor);
        let glazed: Vec<Placed<'_>> = placed.iter().copied().filter(is_glazed).collect();
        let mut first = 0;
        for i in 1..=glazed.len() {
            let goes_on = glazed.get(i).is_some_and(|next| {
                let (from, last) = (&glazed[first], &glazed[i - 1]);
                matches!(self.design.interior, Interior::Office | Interior::Shop)
                    && next.storey == last.storey
                    && next.low.x - last.high.x < NARROW_PIER_M
                    && next.high.x - from.low.x < WIDEST_ROOM_M
            });
            if goes_on {
                continue;
            }
            let holes: Vec<Hole<'_>> = glazed[first..i].iter().map(|p| self.hole(p)).collect();
            let room = self.room(&glazed[first..i]);
            window::room(&mut self.ink, &holes, room, self.design, random);
            first = i;
        }
    }

    fn hole<'c>(&self, placed: &Placed<'c>) -> Hole<'c> {
        Hole {
            opening: placed.opening,
            low: placed.low,
            high: placed.high,
            floor: self.floor(placed.storey),
            bay_x: placed.bay_x,
            wall: self.band.wall,
            frame: if self.band.slot == Slot::GroundFloor { Slot::ShopFrame } else { Slot::Frame },
        }
    }

    /// Closes an opening and puts around it what belongs there.
    fn fill(&mut self, placed: &Placed<'_>, random: &mut Random) {
        let recess_m = f64::from(self.design.recess_m).min(ROOM_SHARE * self.wall.thick_m);
        let (low, high) = (placed.low, placed.high);
        if !self.full {
            self.ink.tube([self.band.wall; 4], low, high, [-recess_m, 0.0]);
            let pane = ink::ring(low, high).map(|p| (p.extend(-recess_m), self.uv(p)));
            return self.ink.mapped(self.band.slot, &pane);
        }
        let hole = self.hole(placed);
        window::fill(&mut self.ink, &hole, self.design, random);
        let rise_m = low.y - self.band.floor_m;
        if placed.opening.filling == Filling::Door && rise_m > 0.1 && self.ink.frame.set_back_m <= 0.0 {
            let foot = DVec3::new(low.x - 0.15, self.band.bottom_m + 0.01, -0.02);
            self.ink.block(Slot::Slab, foot, DVec3::new(high.x + 0.15, low.y - 0.006, 0.38));
        }
        let plain = !self.wall.is_front;
        ornament::surround(&mut self.ink, &hole, self.design, plain, random);
        if placed.opening.is_shop(self.design.interior) {
            let top = self.floor(placed.storey) + self.storey_m;
            shop::front(&mut self.ink, &hole, &self.design.fixtures, top, random);
        } else if placed.opening.is_french() && placed.storey == 0 && self.band.bottom_m < self.band.floor_m {
            // It leads to the ground.
        } else if placed.opening.filling == Filling::Window {
            fixtures::fixtures(&mut self.ink, &hole, &self.design.fixtures, random);
        } else if random.chance(f64::from(self.design.fixtures.lamps)) {
            fixtures::lamp(&mut self.ink, DVec2::new(high.x + 0.25, (low.y + 2.1).min(high.y)));
        }
    }

    /// The room behind openings: as wide as their cells, within the building.
    fn room(&self, placed: &[Placed<'_>]) -> Room {
        let low = |p: &Placed<'_>| p.room[0].min(p.low - SEAM_M / 2.0);
        let high = |p: &Placed<'_>| p.room[1].max(p.high + SEAM_M / 2.0);
        let mut low = placed.iter().map(low).fold(DVec2::INFINITY, DVec2::min);
        let mut high = placed.iter().map(high).fold(DVec2::NEG_INFINITY, DVec2::max);
        let front_m = f64::from(self.design.recess_m) + self.ink.frame.set_back_m.max(0.0) + window::INNER_REVEAL_M;
        let ends = |depth_m: f64| self.wall.corner.map(|cot| cot * depth_m + 0.04);
        // Short of the bisectors of the building's corners and clear of the ground below, as far as the openings let it.
        let openings = |at: fn(&Placed<'_>) -> f64| placed.iter().map(at);
        let [from, to] = ends(front_m);
        let [left, foot] = [openings(|p| p.low.x), openings(|p| p.low.y)].map(|at| at.fold(f64::INFINITY, f64::min));
        let right = openings(|p| p.high.x).fold(f64::NEG_INFINITY, f64::max);
        low.x = low.x.max(from.min(left - SEAM_M / 2.0));
        high.x = high.x.min((self.length_m() - to).max(right + SEAM_M / 2.0));
        // Rooms behind two walls may meet: their floors and ceilings are never level.
        let own_m = self.ink.frame.heading() * LEVELS_M;
        low.y = (low.y + FLOOR_M + own_m).min(foot - SEAM_M / 2.0 + own_m * 0.08);
        high.y = (high.y - own_m)
            .max(openings(|p| p.high.y).fold(f64::NEG_INFINITY, f64::max) + SEAM_M / 2.0 - own_m * 0.08);
        let wanted_m = match self.design.interior {
            Interior::Home => 2.8,
            Interior::Office => 3.8,
            Interior::Shop => 3.4,
            Interior::Bare => 3.0,
        };
        let thick_m = self.wall.thick_behind_m(low.x, high.x, self.length_m());
        let mut depth_m = f64::min(wanted_m, ROOM_SHARE * thick_m - front_m);
        for _ in 0..4 {
            let [from, to] = ends(front_m + depth_m);
            let back_x = [low.x.max(from), high.x.min(self.length_m() - to)];
            if depth_m > 0.2 && back_x[1] - back_x[0] > 0.3 {
                return Room { low, high, depth_m, back_x };
            }
            depth_m *= 0.55;
        }
        Room { low, high, depth_m: 0.0, back_x: [low.x, high.x] }
    }

    /// What runs along the wall and what is fixed to it here and there.
    fn decorate(&mut self, placed: &[Placed<'_>], random: &mut Random) {
        let (design, length_m) = (self.design, self.length_m());
        let front = self.wall.is_front;
        let scale = self.storey_m / self.band.grid.storey_m;
        for storey in 0..self.storeys {
            let on_it = placed.iter().filter(|p| p.storey == storey);
            let holes: Vec<[f64; 4]> = on_it.map(|p| [p.low.x, p.high.x, p.low.y, p.high.y]).collect();
            let floor = self.floor(storey);
            ornament::courses(&mut self.ink, design, floor, scale, &holes, !front);
        }
        let [foot, top] = [self.band.floor_m, self.band.top_m];
        if self.bays > 0 && design.arcade_m <= 0.0 {
            let borders: Vec<f64> = (0..=self.bays).map(|bay| length_m * bay as f64 / self.bays as f64).collect();
            ornament::piers(&mut self.ink, design, &borders, [foot + 0.01, top - 0.03], self.band.wall);
        }
        if self.band.is_uppermost {
            if front {
                ornament::cornice(&mut self.ink, design, top);
            }
            if length_m > 5.0 && design.interior == Interior::Home {
                fixtures::downpipe(&mut self.ink, 0.16, [foot + 0.05, top - 0.05]);
            }
            if design.interior == Interior::Home && random.chance(0.25) {
                let at = DVec2::new(random.range(0.4, length_m - 0.4), foot + self.storey_m * random.range(0.3, 0.6));
                if placed.iter().all(|p| at.x < p.low.x - 0.5 || at.x > p.high.x + 0.5) {
                    fixtures::dish(&mut self.ink, at);
                }
            }
        } else if !front && length_m > 4.0 && random.chance(0.6) {
            let at = DVec2::new(random.range(0.3, length_m - 1.0), foot + 0.6);
            if placed.iter().all(|p| at.x + 0.6 < p.low.x || at.x > p.high.x + 0.1) {
                fixtures::meter_box(&mut self.ink, at);
            }
        }
        self.fire_escape(random);
        if self.band.design.is_some_and(|d| d.fixtures.scaffold) {
            scaffold::scaffold(&mut self.ink, [self.band.bottom_m + 0.5, top], random);
        }
    }

    /// Iron stairs over two bays of an old front.
    fn fire_escape(&mut self, random: &mut Random) {
        let share = f64::from(self.design.fixtures.fire_escapes);
        if share <= 0.0 || self.bays < 3 || self.storeys < 3 || !self.band.is_uppermost || !random.chance(share) {
            return;
        }
        let first = random.index(self.bays - 1);
        let floors: Vec<f64> = (0..self.storeys).map(|s| self.floor(s) + 0.12).collect();
        let x = [self.bay(first)[0] + 0.2, self.bay(first + 1)[1] - 0.2];
        fixtures::fire_escape(&mut self.ink, x, &floors);
    }
}
