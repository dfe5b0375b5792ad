//! Lorries and trailers: cab, frame, axles, and what they carry.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::palette::Palette;
use super::wheel::{Rim, upright, wheel};
use crate::shape::{Prism, Shape};

/// What is on the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Load {
    /// Closed box.
    Box,
    /// Drop sides under a canvas roof, its curtains drawn up, a tail lift behind.
    Canvas,
    /// Tipping body with sand.
    Tipper,
    /// Flat bed with sides and goods.
    Flatbed,
    /// A fifth wheel.
    Tractor,
}

/// A lorry to build; x = 0 is its front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TruckPlan {
    pub(crate) length_m: f32,
    pub(crate) width_m: f32,
    pub(crate) cab_length_m: f32,
    pub(crate) cab_height_m: f32,
    pub(crate) load_height_m: f32,
    /// Top of the frame.
    pub(crate) deck_m: f32,
    pub(crate) wheel_radius_m: f32,
    pub(crate) front_axle_m: f32,
    /// Distances of the rear axles, with twin tyres, from the front.
    pub(crate) rear_axles_m: &'static [f32],
    pub(crate) load: Load,
}

impl TruckPlan {
    pub(crate) fn build(&self, palette: &Palette) -> Shape {
        let gap = self.cab_length_m + 0.12;
        let bed =
            Bed { from: gap, to: self.length_m, half: self.width_m / 2.0, deck: self.deck_m, top: self.load_height_m };
        let load = match self.load {
            Load::Box => bed.closed(palette),
            Load::Canvas => bed.canvas(palette),
            Load::Tipper => bed.tipper(palette),
            Load::Flatbed => bed.flatbed(palette),
            Load::Tractor => bed.fifth_wheel(palette),
        };
        Shape::join([self.cab(palette), self.chassis(palette), load])
    }

    /// A cab over the engine: a rounded block, narrower and raked above the belt.
    fn cab(&self, palette: &Palette) -> Shape {
        let (half, floor, top) = (self.width_m / 2.0 - 0.02, self.deck_m * 0.62 - 0.12, self.cab_height_m);
        let belt = floor + (top - floor) * 0.48;
        let length = self.cab_length_m;
        let nose = 0.06;
        let rows = [
            (floor, nose + 0.03, half - 0.05),
            (floor + 0.08, nose, half),
            (belt, nose, half),
            (top - 0.28, nose + 0.16, half - 0.04),
            (top - 0.1, nose + 0.24, half - 0.08),
            (top, nose + 0.42, half - 0.22),
        ];
        let ring = |&(z, front, half): &(f32, f32, f32)| -> Vec<Vec3> {
            let back = length - if z > top - 0.05 { 0.1 } else { 0.0 };
            let corner = 0.16;
            // The front is bowed; counter-clockwise from above, starting at the left rear.
            let mut points = vec![vec3(-back, half, z), vec3(-back, -half, z)];
            for i in 0..=10 {
                let y = -half + 2.0 * half * i as f32 / 10.0;
                let bow = corner * (y.abs() / half).powi(4) + 0.05 * (y / half).powi(2);
                points.push(vec3(-front - bow, y, z));
            }
            points
        };
        let rings: Vec<Vec<Vec3>> = rows.iter().map(ring).collect();
        let mut cab = Shape::loft(&rings).smooth(0.55).slot(palette.paint);
        // Windscreen, side windows, grille, bumper, lamps.
        let front = |polygon: &[Vec2]| Prism::front(polygon, -nose - 0.4..=0.1);
        let rect = |y0: f32, y1: f32, z0: f32, z1: f32| [vec2(y0, z0), vec2(y1, z0), vec2(y1, z1), vec2(y0, z1)];
        let pane = |m: f32| {
            let (low, high) = (half - 0.1 - m, half - 0.14 - m);
            [vec2(-low, belt + m), vec2(low, belt + m), vec2(high, top - 0.26 - m), vec2(-high, top - 0.26 - m)]
        };
        cab = cab.mark(&front(&pane(0.0)), palette.trim).mark(&front(&pane(0.025)), palette.glass);
        let door = |m: f32| {
            let (a, b) = (-nose - 0.3 - m, -length + 0.38 + m);
            [vec2(a, belt + m - 0.05), vec2(b, belt + m), vec2(b, top - 0.26 - m), vec2(a - 0.12, top - 0.26 - m)]
        };
        cab = cab.mark_both(&Prism::side(&door(0.0), 0.5..=2.0), palette.trim);
        cab = cab.mark_both(&Prism::side(&door(0.022), 0.5..=2.0), palette.glass);
        let grille = belt - 0.14;
        cab = cab.mark(&front(&rect(-half * 0.62, half * 0.62, floor + 0.34, grille)), palette.trim);
        for k in 0..4 {
            let z = floor + 0.4 + (grille - floor - 0.44) * k as f32 / 3.0;
            cab = cab.mark(&front(&rect(-half * 0.6, half * 0.6, z, z + 0.022)), palette.chrome);
        }
        cab = cab.mark(&front(&rect(-2.0, 2.0, floor - 0.2, floor + 0.26)), palette.trim);
        cab = cab.mark_both(&front(&rect(half * 0.66, half * 0.95, floor + 0.08, floor + 0.22)), palette.lamp);
        cab = cab.mark_both(&front(&rect(half * 0.88, half * 0.97, floor + 0.1, floor + 0.2)), palette.amber);
        cab = cab.mark(&front(&rect(-0.26, 0.26, floor + 0.08, floor + 0.19)), palette.plate);
        for x in [-nose - 0.26, -length + 0.34] {
            let gap = [vec2(x, floor + 0.05), vec2(x + 0.01, floor + 0.05), vec2(x + 0.01, belt), vec2(x, belt)];
            cab = cab.mark_both(&Prism::side(&gap, 0.5..=2.0), palette.seam);
        }
        let radius = self.wheel_radius_m + 0.07;
        let arch = Prism::round_side(vec2(-self.front_axle_m, self.wheel_radius_m), radius, 28, 0.5..=2.0);
        cab = cab.without(&arch).without(&arch.mirrored());

        let mut parts = vec![cab, self.guard(self.front_axle_m, half, palette)];
        let mut side = Vec::new();
        let mirror = Shape::rounded_block(vec3(0.1, 0.2, 0.36), 0.04).moved(vec3(-0.16, half + 0.16, belt + 0.42));
        let arm = Shape::tube(
            &[
                vec3(-0.25, half - 0.05, top - 0.2),
                vec3(-0.16, half + 0.14, top - 0.25),
                vec3(-0.16, half + 0.16, belt + 0.5),
            ],
            0.014,
            6,
        );
        side.push(mirror.and(arm).slot(palette.trim));
        let handle =
            Shape::rounded_block(vec3(0.18, 0.03, 0.035), 0.01).moved(vec3(-length + 0.5, half + 0.01, belt - 0.12));
        side.push(handle.slot(palette.trim));
        let step =
            Shape::rounded_block(vec3(0.4, 0.14, 0.06), 0.02).moved(vec3(-nose - 0.5, half - 0.08, floor - 0.08));
        side.push(step.slot(palette.trim));
        parts.push(Shape::join(side).both_sides());
        // Inside: dashboard, seats, rear wall.
        let dash = Shape::rounded_block(vec3(0.4, half * 1.9, 0.2), 0.06).moved(vec3(-nose - 0.35, 0.0, belt - 0.1));
        let seat = |y: f32| {
            let x = -length + 0.55;
            Shape::rounded_block(vec3(0.16, 0.5, 0.75), 0.06)
                .moved(vec3(x, y, belt + 0.05))
                .and(Shape::rounded_block(vec3(0.5, 0.5, 0.16), 0.06).moved(vec3(x + 0.2, y, belt - 0.25)))
        };
        let wall = Shape::block(vec3(0.02, half * 1.94, top - floor - 0.3)).moved(vec3(
            -length + 0.06,
            0.0,
            (top + floor) / 2.0 - 0.1,
        ));
        parts.push(Shape::join([dash, seat(half * 0.55), seat(-half * 0.55), wall]).slot(palette.interior));
        Shape::join(parts)
    }

    /// A dark guard over a wheel.
    fn guard(&self, axle: f32, half: f32, palette: &Palette) -> Shape {
        let r = self.wheel_radius_m + 0.075;
        let row = |y: f32| -> Vec<Vec3> {
            let angles = (0..=14).map(|i| -0.1 + (TAU / 2.0 + 0.2) * i as f32 / 14.0);
            angles.map(|a| vec3(-axle + a.cos() * r, y, self.wheel_radius_m + a.sin() * r)).collect()
        };
        Shape::sheet(&[row(half - 0.5), row(half - 0.01)]).plate(0.01).slot(palette.trim).both_sides()
    }

    fn chassis(&self, palette: &Palette) -> Shape {
        let half = self.width_m / 2.0;
        let (from, to) = (0.3, self.length_m - 0.15);
        let mut parts = Vec::new();
        let beam = Shape::block(vec3(to - from, 0.09, 0.24)).moved(vec3(-(from + to) / 2.0, 0.4, self.deck_m - 0.16));
        parts.push(beam.both_sides().slot(palette.trim));
        let r = self.wheel_radius_m;
        let width = r * 0.54;
        let front = wheel(palette, r, width, Rim::Steel).moved(vec3(-self.front_axle_m, half - width / 2.0 - 0.02, r));
        parts.push(front.both_sides());
        for &axle in self.rear_axles_m {
            parts.push(twin(palette, r, width, axle, half));
            let shaft = upright(Shape::cylinder(0.09, half * 1.7, 10)).moved(vec3(-axle, -half * 0.85, r));
            let diff = Shape::ellipsoid(vec3(0.22, 0.2, 0.22), 14).moved(vec3(-axle, 0.0, r));
            parts.push(shaft.and(diff).slot(palette.trim));
            parts.push(self.guard(axle, half, palette));
        }
        // Tank and boxes between the axles.
        let back = self.rear_axles_m.first().copied().unwrap_or(to);
        let room = back - r - 0.2 - (self.front_axle_m + r + 0.35);
        if room > 0.6 {
            let x = -(self.front_axle_m + r + 0.35 + room * 0.4);
            let tank = Shape::rounded_block(vec3((room * 0.6).min(1.2), 0.5, 0.5), 0.12);
            parts.push(tank.moved(vec3(x, half - 0.32, self.deck_m - 0.42)).slot(palette.chrome));
            let boxes = Shape::rounded_block(vec3((room * 0.5).min(0.9), 0.45, 0.5), 0.03);
            parts.push(boxes.moved(vec3(x, -half + 0.3, self.deck_m - 0.42)).slot(palette.trim));
            for z in [0.45, 0.75] {
                let rail =
                    Shape::block(vec3(room, 0.03, 0.09)).moved(vec3(-(back - r - 0.25 - room / 2.0), half - 0.04, z));
                parts.push(rail.both_sides().slot(palette.rim));
            }
        }
        parts.push(rear_bar(palette, self.length_m, half, self.deck_m));
        Shape::join(parts)
    }
}

/// A pair of twin wheels.
fn twin(palette: &Palette, radius_m: f32, width_m: f32, axle: f32, half: f32) -> Shape {
    let outer =
        wheel(palette, radius_m, width_m, Rim::DeepSteel).moved(vec3(-axle, half - width_m / 2.0 - 0.02, radius_m));
    let inner = upright(Shape::cylinder(radius_m, width_m, 24));
    let inner = inner.moved(vec3(-axle, half - width_m * 2.1 - 0.02, radius_m)).slot(palette.rubber);
    outer.and(inner).both_sides()
}

/// Underrun bar with lamps, blinkers, stripes and a number plate.
fn rear_bar(palette: &Palette, length_m: f32, half: f32, deck: f32) -> Shape {
    let z = 0.5_f32.max(deck - 0.45);
    let mut bar = Shape::block(vec3(0.08, half * 1.9, 0.14)).moved(vec3(-length_m + 0.08, 0.0, z)).slot(palette.amber);
    for k in 0..8 {
        let y = -half * 0.95 + half * 1.9 * (k as f32 + 0.25) / 8.0;
        let stripe = [vec2(y, z - 0.1), vec2(y + 0.1, z - 0.1), vec2(y + 0.2, z + 0.1), vec2(y + 0.1, z + 0.1)];
        bar = bar.mark(&Prism::front(&stripe, -length_m - 0.1..=-length_m + 0.1), palette.seam);
    }
    let mut parts = vec![bar];
    let lamp =
        |y: f32, w: f32| Shape::rounded_block(vec3(0.05, w, 0.12), 0.015).moved(vec3(-length_m + 0.12, y, z + 0.2));
    for side in [1.0, -1.0] {
        parts.push(lamp(side * (half - 0.14), 0.22).slot(palette.red));
        parts.push(lamp(side * (half - 0.31), 0.12).slot(palette.amber));
        let flap = Shape::block(vec3(0.015, 0.5, 0.4)).moved(vec3(-length_m + 0.4, side * (half - 0.3), z - 0.05));
        parts.push(flap.slot(palette.rubber));
        let hanger = Shape::block(vec3(0.1, 0.06, 0.4)).moved(vec3(-length_m + 0.14, side * 0.4, z + 0.16));
        parts.push(hanger.slot(palette.trim));
    }
    parts.push(Shape::block(vec3(0.02, 0.4, 0.12)).moved(vec3(-length_m + 0.1, 0.0, z + 0.2)).slot(palette.plate));
    Shape::join(parts)
}

/// What lies on a frame: between two distances from the front, up to a height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bed {
    pub(crate) from: f32,
    pub(crate) to: f32,
    pub(crate) half: f32,
    pub(crate) deck: f32,
    pub(crate) top: f32,
}

impl Bed {
    fn span(&self, low: f32, high: f32, inset: f32) -> (Vec3, Vec3) {
        let size = vec3(self.to - self.from - inset * 2.0, (self.half - inset) * 2.0, high - low);
        (size, vec3(-(self.from + self.to) / 2.0, 0.0, (low + high) / 2.0))
    }

    fn floor(&self, palette: &Palette) -> Shape {
        let (size, middle) = self.span(self.deck - 0.04, self.deck + 0.1, 0.0);
        Shape::rounded_block(size, 0.015).moved(middle).slot(palette.trim)
    }

    /// Closed box with bright edges, doors and hinges.
    pub(crate) fn closed(&self, palette: &Palette) -> Shape {
        let (size, middle) = self.span(self.deck + 0.02, self.top, 0.0);
        let mut shell = Shape::rounded_block(size, 0.03).moved(middle).slot(palette.second);
        let rear = -self.to..=-self.to + 0.05;
        let edge = |y0: f32, y1: f32, z0: f32, z1: f32| [vec2(y0, z0), vec2(y1, z0), vec2(y1, z1), vec2(y0, z1)];
        let (low, high) = (self.deck + 0.02, self.top);
        let frame = [
            edge(-self.half, self.half, low, low + 0.09),
            edge(-self.half, self.half, high - 0.09, high),
            edge(-self.half, -self.half + 0.07, low, high),
            edge(self.half - 0.07, self.half, low, high),
            edge(-0.006, 0.006, low, high),
        ];
        for (i, polygon) in frame.iter().enumerate() {
            let slot = if i == 4 { palette.seam } else { palette.rim };
            shell = shell.mark(&Prism::front(polygon, rear.clone()), slot);
        }
        for (low, high) in [(low, low + 0.1), (high - 0.08, high)] {
            let (back, front) = (-self.to, -self.from);
            let strip = [vec2(back, low), vec2(front, low), vec2(front, high), vec2(back, high)];
            shell = shell.mark_both(&Prism::side(&strip, 0.5..=2.0), palette.rim);
        }
        let mut parts = vec![shell, self.floor(palette)];
        for y in [-0.5, -0.16, 0.16, 0.5] {
            let rod =
                Shape::tube(&[vec3(-self.to - 0.02, y, low + 0.04), vec3(-self.to - 0.02, y, high - 0.05)], 0.016, 6);
            let latch = Shape::block(vec3(0.03, 0.16, 0.03)).moved(vec3(-self.to - 0.03, y, low + 0.5));
            parts.push(rod.and(latch).slot(palette.rim));
        }
        Shape::join(parts)
    }

    /// Low sides, posts and a canvas roof whose curtains are drawn up; a tail lift closes the back.
    pub(crate) fn canvas(&self, palette: &Palette) -> Shape {
        let mut parts = vec![self.floor(palette), self.sides(0.62, palette, palette.rim)];
        let (size, middle) = self.span(self.top - 0.1, self.top, -0.02);
        parts.push(Shape::rounded_block(size, 0.045).moved(middle).slot(palette.second));
        // The rolled-up curtains sag between the posts.
        let bays = 4;
        for side in [1.0, -1.0] {
            let path: Vec<Vec3> = (0..=bays * 4)
                .map(|i| {
                    let t = i as f32 / (bays * 4) as f32;
                    let sag = 0.05 * (t * bays as f32 * TAU / 2.0).sin().abs();
                    vec3(-self.from - (self.to - self.from) * t, side * (self.half - 0.02), self.top - 0.18 - sag)
                })
                .collect();
            parts.push(Shape::tube(&path, 0.1, 8).slot(palette.second));
            for i in 0..=bays {
                let x = -self.from - 0.06 - (self.to - self.from - 0.12) * i as f32 / bays as f32;
                let post = Shape::block(vec3(0.08, 0.06, self.top - self.deck - 0.1));
                parts.push(
                    post.moved(vec3(x, side * (self.half - 0.05), (self.top + self.deck) / 2.0)).slot(palette.rim),
                );
            }
        }
        let wall = Shape::block(vec3(0.06, self.half * 1.96, self.top - self.deck - 0.1));
        parts.push(wall.moved(vec3(-self.from - 0.03, 0.0, (self.top + self.deck) / 2.0)).slot(palette.rim));
        parts.push(self.goods(0.55, 1.25, palette));
        parts.push(self.tail_lift(palette));
        Shape::join(parts)
    }

    /// The platform of a tail lift, folded up.
    fn tail_lift(&self, palette: &Palette) -> Shape {
        let (low, high) = (self.deck - 0.02, self.deck + 1.55_f32.min(self.top - self.deck - 0.5));
        let x = -self.to - 0.07;
        let panel = Shape::rounded_block(vec3(0.07, self.half * 1.98, high - low), 0.02).moved(vec3(
            x,
            0.0,
            (low + high) / 2.0,
        ));
        let mut panel = panel.slot(palette.rim);
        let back = |polygon: &[Vec2]| Prism::front(polygon, x - 0.2..=x);
        for side in [1.0, -1.0] {
            for k in 0..5 {
                let (y, z) = (side * self.half * 0.62, low + 0.15 + 0.16 * k as f32);
                let slot = if k % 2 == 0 { palette.amber } else { palette.plate };
                panel = panel.mark(
                    &back(&[vec2(y - 0.07, z), vec2(y + 0.07, z), vec2(y + 0.07, z + 0.16), vec2(y - 0.07, z + 0.16)]),
                    slot,
                );
            }
        }
        let mut parts = vec![panel];
        for side in [1.0, -1.0] {
            let arm = Shape::block(vec3(0.16, 0.1, 0.6)).moved(vec3(x + 0.1, side * self.half * 0.62, low - 0.2));
            parts.push(arm.slot(palette.trim));
        }
        let bar = Shape::block(vec3(0.1, self.half * 1.3, 0.1)).moved(vec3(x + 0.12, 0.0, low - 0.3));
        parts.push(bar.slot(palette.trim));
        Shape::join(parts)
    }

    /// Open body with tapering sides and a heap.
    pub(crate) fn tipper(&self, palette: &Palette) -> Shape {
        let (low, high) = (self.deck + 0.12, self.top);
        let ring = |z: f32, inset: f32| -> Vec<Vec3> {
            let (a, b, h) = (-self.from - inset, -self.to + inset * 0.5, self.half - inset);
            vec![vec3(a, -h, z), vec3(a, h, z), vec3(b, h, z), vec3(b, -h, z)]
        };
        let shell = Shape::loft(&[
            ring(low, 0.22),
            ring(low + 0.25, 0.05),
            ring(high, 0.0),
            ring(high, 0.07),
            ring(high - 0.3, 0.09),
        ]);
        let mut parts = vec![shell.smooth(0.2).slot(palette.second)];
        let ribs = ((self.to - self.from) / 0.7) as usize;
        for i in 0..=ribs {
            let x = -self.from - 0.1 - (self.to - self.from - 0.2) * i as f32 / ribs as f32;
            let rib = Shape::block(vec3(0.09, 0.07, high - low - 0.15)).moved(vec3(
                x,
                self.half - 0.01,
                (low + high) / 2.0 + 0.05,
            ));
            parts.push(rib.both_sides().slot(palette.second));
        }
        let heap = Shape::ellipsoid(vec3((self.to - self.from) * 0.46, self.half * 0.86, 0.55), 24);
        parts.push(heap.moved(vec3(-(self.from + self.to) / 2.0, 0.0, high - 0.28)).slot(palette.interior));
        let guard =
            Shape::rounded_block(vec3(0.7, self.half * 1.8, 0.06), 0.02).moved(vec3(-self.from + 0.3, 0.0, high + 0.1));
        parts.push(guard.slot(palette.second));
        parts.push(self.floor(palette));
        Shape::join(parts)
    }

    /// Sides that fold down, and goods.
    pub(crate) fn flatbed(&self, palette: &Palette) -> Shape {
        let front = Shape::block(vec3(0.06, self.half * 1.96, 1.1));
        let front = front.moved(vec3(-self.from - 0.03, 0.0, self.deck + 0.6)).slot(palette.rim);
        Shape::join([
            self.floor(palette),
            self.sides(0.42, palette, palette.rim),
            front,
            self.goods(0.5, self.top - self.deck, palette),
        ])
    }

    fn sides(&self, height_m: f32, palette: &Palette, slot: u16) -> Shape {
        let z = self.deck + 0.1 + height_m / 2.0;
        let length = self.to - self.from;
        let long = Shape::rounded_block(vec3(length, 0.04, height_m), 0.012).moved(vec3(
            -(self.from + self.to) / 2.0,
            self.half - 0.02,
            z,
        ));
        let back =
            Shape::rounded_block(vec3(0.04, self.half * 1.96, height_m), 0.012).moved(vec3(-self.to + 0.02, 0.0, z));
        let mut parts = vec![long.both_sides().slot(slot), back.slot(slot)];
        for i in 0..=4 {
            let x = -self.from - 0.06 - (length - 0.12) * i as f32 / 4.0;
            let post = Shape::block(vec3(0.09, 0.03, height_m + 0.06)).moved(vec3(x, self.half + 0.003, z - 0.02));
            parts.push(post.both_sides().slot(palette.trim));
        }
        Shape::join(parts)
    }

    /// Cartons and pallets of uneven height.
    fn goods(&self, share: f32, height_m: f32, palette: &Palette) -> Shape {
        let mut random = trove_model::Seed(0x60_0d5).nth((self.to * 100.0) as u64).random();
        let mut parts = Vec::new();
        let (rows, columns) = (((self.to - self.from) * share) as usize + 1, 2);
        for row in 0..rows {
            for column in 0..columns {
                let height = height_m * random.range(0.35, 0.9) as f32;
                let size = vec3(0.85 + random.range(0.0, 0.1) as f32, self.half * 0.85, height);
                let y = self.half * 0.46 * if column == 0 { 1.0 } else { -1.0 };
                let place = vec3(-self.to + 0.6 + row as f32 * 1.02, y, self.deck + 0.12 + height / 2.0);
                let turn = Quat::from_rotation_z(random.range(-0.04, 0.04) as f32);
                parts.push(Shape::rounded_block(size, 0.02).turned(turn).moved(place));
            }
        }
        Shape::join(parts).slot(palette.cargo)
    }

    /// Coupling plate, catwalk, hoses and guards of a tractor.
    fn fifth_wheel(&self, palette: &Palette) -> Shape {
        let x = -self.to + 1.35;
        let plate =
            Shape::cylinder(0.46, 0.06, 20).turned(Quat::from_rotation_y(-0.05)).moved(vec3(x, 0.0, self.deck + 0.1));
        let walk = Shape::block(vec3(0.9, 0.9, 0.03)).moved(vec3(-self.from - 0.5, 0.0, self.deck));
        let stack =
            Shape::tube(&[vec3(-self.from + 0.02, 0.7, self.deck), vec3(-self.from + 0.02, 0.7, self.top)], 0.07, 12);
        Shape::join([plate.slot(palette.trim), walk.slot(palette.rim), stack.slot(palette.chrome)])
    }
}

/// A semi-trailer; x = 0 is its front.
pub(crate) fn semi_trailer(palette: &Palette, curtain: bool) -> Shape {
    let (length, half, deck, r) = (12.2, 1.27, 1.15, 0.5);
    let bed = Bed { from: 0.0, to: length, half, deck, top: 3.95 };
    let mut parts = vec![bed.closed(palette), rear_bar(palette, length, half, deck)];
    if curtain {
        // Straps and folds of a curtain side.
        for i in 1..14 {
            let x = -length * i as f32 / 14.0;
            let strap = Shape::block(vec3(0.05, 0.012, 2.6)).moved(vec3(x, half + 0.004, 2.5));
            parts.push(strap.both_sides().slot(palette.trim));
        }
    }
    let beam = Shape::block(vec3(length - 0.4, 0.12, 0.3)).moved(vec3(-length / 2.0, 0.45, deck - 0.14));
    parts.push(beam.both_sides().slot(palette.trim));
    for axle in [8.3, 9.6, 10.9] {
        let wide = wheel(palette, r, 0.36, Rim::Steel).moved(vec3(-axle, half - 0.2, r));
        parts.push(wide.both_sides());
        parts.push(upright(Shape::cylinder(0.08, 2.0, 10)).moved(vec3(-axle, -1.0, r)).slot(palette.trim));
    }
    let mut leg = Shape::block(vec3(0.14, 0.14, deck - 0.12)).moved(vec3(-2.6, 0.8, deck / 2.0 + 0.06));
    leg = leg.and(Shape::block(vec3(0.34, 0.3, 0.05)).moved(vec3(-2.6, 0.8, 0.025)));
    parts.push(leg.both_sides().slot(palette.rim));
    for z in [0.5, 0.85] {
        let rail = Shape::block(vec3(4.2, 0.03, 0.1)).moved(vec3(-5.2, half - 0.03, z));
        parts.push(rail.both_sides().slot(palette.rim));
    }
    Shape::join(parts)
}
