//! Cabs of lorries: over the engine, or behind a bonnet.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::{Prism, Shape, arc, pane, rect, shrunk};
use crate::vehicles::hull::{Hull, Row, Section, arch, gap, lying};
use crate::vehicles::workshop::{Workshop, block};

/// A cab to build; x = 0 is the vehicle's front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cab {
    /// From the vehicle's front to the cab's back.
    pub(crate) length_m: f32,
    /// Top of the roof.
    pub(crate) height_m: f32,
    pub(crate) width_m: f32,
    /// Lower edge of the bumper.
    pub(crate) floor_m: f32,
    pub(crate) axle_m: f32,
    pub(crate) wheel_m: f32,
    /// Length of the bonnet; 0: the cab is over the engine.
    pub(crate) bonnet_m: f32,
    /// A second row of seats with doors of its own.
    pub(crate) crew: bool,
    /// Bumper, grille and steps of black plastic rather than painted.
    pub(crate) plain: bool,
    /// The grille's bars, its height as a share of the room there is, and whether the bars are painted.
    pub(crate) grille: (usize, f32, bool),
    /// On which side the driver sits: 1 left, −1 right.
    pub(crate) driver_side: f32,
}

impl Cab {
    fn half(&self) -> f32 {
        self.width_m / 2.0 - 0.03
    }

    fn tall(&self) -> f32 {
        self.height_m - self.floor_m
    }

    /// Lower edge of the windscreen.
    fn belt(&self) -> f32 {
        self.floor_m + (self.tall() * 0.52).min(1.42)
    }

    /// Upper edge of the windscreen.
    fn header(&self) -> f32 {
        (self.height_m - 0.1 * self.tall()).min(self.belt() + 0.92)
    }

    fn rake(&self) -> f32 {
        if self.bonnet_m > 0.0 || self.tall() < 2.1 { 0.34 } else { 0.17 }
    }

    fn hull(&self) -> Hull {
        let (floor, belt, header, top) = (self.floor_m, self.belt(), self.header(), self.height_m);
        let nose = -self.bonnet_m;
        let d = (top - header).min(0.24);
        // Above the windscreen a high roof leans back like an air deflector.
        let lean = (top - d - header) * 0.5 + 0.03;
        let row = |z: f32, set_back: f32, inset: f32| Row {
            z,
            front: nose - set_back,
            back: -self.length_m,
            half: self.half() - inset,
            corner: [0.24, 0.05],
            bow: [0.09, 0.0],
        };
        let rake = self.rake();
        Hull::new(vec![
            row(floor, 0.12, 0.07),
            row(floor + 0.03, 0.05, 0.025),
            row(floor + 0.1, 0.0, 0.0),
            row(floor + (belt - floor) * 0.38, 0.0, 0.0),
            row(floor + (belt - floor) * 0.75, 0.02, 0.0),
            row(belt, 0.05, 0.0),
            row(belt + (header - belt) * 0.5, 0.05 + rake * 0.45, 0.012),
            row(header, 0.05 + rake, 0.04),
            row(top - d, 0.05 + rake + lean, 0.05),
            row(top - d * 0.55, 0.09 + rake + lean, 0.075),
            row(top - d * 0.22, 0.18 + rake + lean, 0.13),
            row(top - d * 0.06, 0.32 + rake + lean, 0.22),
            row(top, 0.55 + rake + lean, 0.4),
        ])
    }

    /// Where the driver's hips are.
    fn hips(&self) -> Vec3 {
        let back = self.door_end() + 0.02;
        vec3(-back, self.half() * 0.55 * self.driver_side, self.belt() - 0.2)
    }

    /// Where the front door ends, from the vehicle's front.
    fn door_end(&self) -> f32 {
        self.bonnet_m + (if self.crew { 1.3 } else { self.length_m - self.bonnet_m - 0.22 }).min(1.42)
    }

    pub(crate) fn build(&self, work: &mut Workshop) {
        let (belt, header) = (self.belt(), self.header());
        let (half, slots) = (self.half(), work.slots);
        let hull = self.hull();
        let mut skin = hull.skin().slot(slots.paint);
        // Doors, windows.
        let front = self.bonnet_m + 0.05;
        let arch_top = self.wheel_m * 2.0 + 0.14;
        let door_foot = if self.bonnet_m > 0.0 { self.floor_m + 0.12 } else { arch_top.max(self.floor_m + 0.35) };
        let (screen, end) = (front + self.rake() + 0.22, self.door_end());
        let mut doors = vec![(front + 0.24, screen + 0.02, end)];
        if self.crew {
            doors.push((end + 0.04, end + 0.04, (end + 1.05).min(self.length_m - 0.1)));
        }
        for (i, &(low, high, end)) in doors.iter().enumerate() {
            let outline = [
                vec2(-low, door_foot),
                vec2(-end, door_foot),
                vec2(-end, header + 0.03),
                vec2(-high, header + 0.03),
                vec2(-low, belt + 0.02),
            ];
            skin = gap(skin, &pane(&outline, 0.05), slots.paint, slots.seam);
            let dip = if i == 0 { 0.16 } else { 0.03 };
            let glass = [
                vec2(-low - 0.1, belt - dip),
                vec2(-end + 0.1, belt + 0.02),
                vec2(-end + 0.1, header - 0.03),
                vec2(-high - 0.12, header - 0.03),
            ];
            let side = |polygon: &[Vec2]| Prism::side(polygon, 0.4..=3.0);
            skin = skin.mark_both(&side(&pane(&glass, 0.09)), slots.trim);
            skin = skin.mark_both(&side(&pane(&shrunk(&glass, 0.028), 0.08)), slots.glass);
            let handle = block([0.17, 0.03, 0.035], [-end + 0.2, half + 0.012, belt - 0.16], 0.012);
            work.pair(slots.trim, handle);
        }
        let ahead = |polygon: &[Vec2]| Prism::front(polygon, -self.bonnet_m - 1.2..=0.2);
        let screen = rect(-half + 0.045, half - 0.045, belt + 0.02, header - 0.01);
        skin = skin.mark(&ahead(&pane(&screen, 0.14)), slots.trim);
        skin = skin.mark(&ahead(&pane(&shrunk(&screen, 0.05), 0.12)), slots.glass);
        for pivot in [-0.12, half * 0.72] {
            work.wiper(&hull, vec2(pivot, belt - 0.01), vec2(pivot - half * 0.78, belt + 0.12));
        }
        if self.bonnet_m > 0.0 {
            self.bonnet(work);
        } else {
            skin = self.face(work, &hull, skin);
        }
        let (well, lip) = if self.bonnet_m > 0.0 {
            (Shape::default(), Shape::default())
        } else {
            arch(&mut skin, vec2(-self.axle_m, self.wheel_m), self.wheel_m + 0.11, half, 0.5)
        };
        work.add(slots.seam, well);
        work.add(slots.trim, lip);
        work.model.add_marked(skin);
        self.outside(work, &hull);
        self.inside(work);
    }

    /// Grille, bumper, lamps and steps of a cab over the engine.
    fn face(&self, work: &mut Workshop, hull: &Hull, skin: Shape) -> Shape {
        let (half, floor, belt, slots) = (self.half(), self.floor_m, self.belt(), work.slots);
        let front = |polygon: &[Vec2]| Prism::front(polygon, -0.5..=0.2);
        let k = ((belt - floor) / 1.3).min(1.0);
        let bumper = floor + 0.44 * k;
        let body = if self.plain { slots.trim } else { slots.paint };
        let mut skin = skin;
        if self.plain {
            let low = rect(-3.0, 3.0, floor - 0.1, bumper);
            skin = skin.mark(&front(&low), slots.trim).mark_both(
                &Prism::side(&rect(-self.length_m - 1.0, 1.0, floor - 0.1, floor + 0.12), 0.4..=3.0),
                slots.trim,
            );
        }
        // Line between bumper and grille, grille with bars.
        skin = skin.mark(&front(&rect(-3.0, 3.0, bumper, bumper + 0.014)), slots.seam);
        let (bars, tall, painted) = self.grille;
        let grille =
            rect(-half * 0.7, half * 0.7, bumper + 0.06, bumper + 0.06 + (belt - bumper - 0.06 - 0.12 * k) * tall);
        skin = skin.mark(&front(&pane(&grille, 0.07)), slots.seam);
        let step = (grille[2].y - grille[0].y) / bars as f32;
        for i in 0..bars {
            let z = grille[0].y + step * (i as f32 + 0.18);
            let slot = if i + 1 == bars {
                slots.chrome
            } else if painted {
                body
            } else {
                slots.trim
            };
            let width = half * (0.66 + 0.008 * i as f32);
            let share = if painted { 0.62 } else { 0.4 };
            work.add(slot, hull.front_panel(vec2(-width, z), vec2(width, z + step * share), 0.018));
        }
        // A handle and a step to wash the windscreen from.
        let bar = |y: f32| vec3(hull.front_at(y, belt - 0.05) + 0.03, y, belt - 0.06);
        work.add(slots.trim, Shape::tube(&[bar(-half * 0.5), bar(0.0), bar(half * 0.5)], 0.013, 6));
        // Lower intake, plate, lamps.
        let intake = rect(-half * 0.52, half * 0.52, floor + 0.06, floor + 0.06 + 0.15 * k);
        skin = skin.mark(&front(&pane(&intake, 0.03)), slots.seam);
        work.add(
            slots.trim,
            hull.front_panel(vec2(-half * 0.5, floor + 0.11 * k), vec2(half * 0.5, floor + 0.14 * k), 0.012),
        );
        let z = floor + 0.3 * k;
        let outline = rect(half * 0.6, half * 0.985, z - 0.105 * k, z + 0.115 * k);
        skin = work.headlamps(skin, hull, &outline, &[(half * 0.7, z, 0.085 * k), (half * 0.86, z, 0.08 * k)]);
        let blinker = rect(half * 0.955, half * 1.02, z - 0.09 * k, z + 0.1 * k);
        skin = skin.mark_both(&front(&blinker), slots.amber);
        for y in [0.62, 0.76] {
            let fog = vec3(hull.front_at(half * y, floor + 0.1) + 0.006, half * y, floor + 0.11 * k);
            work.pair(slots.lamp, Shape::ellipsoid(vec3(0.015, 0.055 * k, 0.045 * k), 14).moved(fog));
        }
        work.number_plate(vec3(hull.front_at(0.0, z) + 0.012, 0.0, floor + 0.33 * k), true);
        // Steps up to the door, in front of the wheel.
        let back = -self.axle_m + self.wheel_m + 0.14;
        if back < -0.42 {
            let recess = rect(back, -0.27, floor + 0.05, floor + 0.5 * k);
            skin = skin.mark_both(&Prism::side(&pane(&recess, 0.03), 0.4..=3.0), slots.seam);
            for z in [0.16, 0.38] {
                let tread =
                    block([-0.29 - back, 0.1, 0.035], [(back - 0.27) / 2.0, self.half() - 0.04, floor + z * k], 0.012);
                work.pair(slots.steel, tread);
            }
        }
        skin
    }

    /// Engine cover with grille, wings over the wheels, bumper.
    fn bonnet(&self, work: &mut Workshop) {
        let (half, floor, belt, slots) = (self.half(), self.floor_m, self.belt(), work.slots);
        let length = self.bonnet_m;
        let (waist, nose) = (half * 0.74, half * 0.58);
        let low = self.wheel_m * 1.45;
        let section = |x: f32, half: f32, top: f32, bottom: f32, corner: f32| Section {
            x,
            z: (top + bottom) / 2.0,
            half: vec2(half, (top - bottom) / 2.0),
            corner,
        };
        let top = belt + 0.02;
        let cover = lying(&[
            section(-length - 0.3, waist + 0.12, top, low, 0.16),
            section(-length, waist + 0.03, top - 0.01, low, 0.17),
            section(-length * 0.6, (waist + nose) / 2.0 + 0.02, top - 0.07, low, 0.18),
            section(-0.32, nose + 0.01, top - 0.15, low, 0.17),
            section(-0.16, nose - 0.015, top - 0.2, low, 0.15),
            section(-0.1, nose - 0.06, top - 0.26, low + 0.03, 0.12),
        ]);
        let mut cover = cover.slot(slots.paint);
        let grille = rect(-nose + 0.1, nose - 0.1, low + 0.06, top - 0.34);
        let face = |polygon: &[Vec2]| Prism::front(polygon, -0.15..=0.1);
        cover = cover.mark(&face(&pane(&grille, 0.09)), slots.chrome);
        cover = cover.mark(&face(&pane(&shrunk(&grille, 0.035), 0.07)), slots.seam);
        let slats = 7;
        for i in 0..slats {
            let z = grille[0].y + 0.06 + (grille[2].y - grille[0].y - 0.12) * i as f32 / (slats - 1) as f32;
            work.add(slots.chrome, block([0.03, (nose - 0.145) * 2.0, 0.026], [-0.09, 0.0, z], 0.008));
        }
        // Air intakes and the line where the cover opens.
        for i in 0..4 {
            let x = -length + 0.16 + 0.07 * i as f32;
            let vent = rect(x, x + 0.028, top - 0.52, top - 0.3);
            cover = cover.mark_both(&Prism::side(&vent, 0.3..=2.0), slots.seam);
        }
        let line = rect(-length - 0.02, -length - 0.008, low, top + 0.1);
        cover = cover.mark_both(&Prism::side(&line, 0.2..=2.0), slots.seam);
        work.model.add_marked(cover);

        // Wings: an arch that is rounded outwards, its front drawn down to the bumper.
        let (axle, r) = (vec2(-self.axle_m, self.wheel_m), self.wheel_m + 0.13);
        let span = (axle.x + 0.13).abs() + 0.02;
        let squash =
            |p: Vec3| if p.x > axle.x { vec3(axle.x + (p.x - axle.x) * (span / r).max(1.0), p.y, p.z) } else { p };
        let row = |y: f32, drop: f32| -> Vec<Vec3> {
            arc(axle, r + 0.09 - drop, 0.02, 3.3, 18, y).into_iter().map(squash).collect()
        };
        let wing = Shape::sheet(&[
            row(half - 0.02, 0.16),
            row(half - 0.02, 0.09),
            row(half - 0.045, 0.035),
            row(half - 0.11, 0.0),
            row(nose - 0.1, -0.02),
        ]);
        work.pair(slots.paint, wing.smooth(0.9));
        let under = Shape::sheet(&[row(half - 0.6, 0.12), row(half - 0.02, 0.12)]);
        work.pair(slots.seam, under);
        // Lamps in the wings, bumper across.
        let z = low + 0.17;
        let pod = Shape::ellipsoid(vec3(0.26, 0.22, 0.2), 20).moved(vec3(-0.36, half * 0.78, z));
        work.pair(slots.paint, pod);
        let glass = Shape::ellipsoid(vec3(0.07, 0.165, 0.125), 20).moved(vec3(-0.125, half * 0.76, z));
        work.pair(slots.lamp, glass);
        let rim: Vec<Vec3> = arc(Vec2::ZERO, 1.0, 0.0, std::f32::consts::TAU, 20, 0.0)
            .iter()
            .map(|p| vec3(-0.13, half * 0.76 + p.x * 0.165, z + p.z * 0.125))
            .collect();
        work.pair(slots.chrome, Shape::tube(&rim, 0.014, 6));
        work.pair(slots.amber, block([0.1, 0.05, 0.12], [-0.26, half - 0.05, z], 0.03));
        let bumper = |z: f32, inset: f32| Row {
            z,
            front: -inset,
            back: -0.34 + inset,
            half: half - 0.01 - inset,
            corner: [0.15, 0.05],
            bow: [0.07, 0.0],
        };
        let bumper = Hull::new(vec![
            bumper(floor, 0.03),
            bumper(floor + 0.05, 0.0),
            bumper(floor + 0.26, 0.0),
            bumper(floor + 0.31, 0.03),
        ]);
        work.add(if self.plain { slots.trim } else { slots.chrome }, bumper.skin());
        work.number_plate(vec3(0.012, 0.0, floor + 0.15), true);
        for y in [0.5, 0.62] {
            let fog = vec3(bumper.front_at(y, floor + 0.15), y, floor + 0.15);
            work.pair(slots.lamp, Shape::ellipsoid(vec3(0.02, 0.05, 0.05), 14).moved(fog));
        }
        // Tank and battery box below the doors are steps.
        let back = -self.axle_m - r - 0.1;
        let room = (self.length_m + back).min(1.3);
        if room > 0.35 {
            for (z, out) in [(floor + 0.02, 0.02), (floor + 0.24, 0.1)] {
                let tread = block([room, 0.34, 0.2], [back - room / 2.0, half - 0.15 - out, z], 0.05);
                work.pair(if out > 0.05 { slots.alu } else { slots.trim }, tread);
            }
        }
    }

    /// Mirrors, sun visor, marker lamps, air intake.
    fn outside(&self, work: &mut Workshop, hull: &Hull) {
        let (half, belt, header, slots) = (self.half(), self.belt(), self.header(), work.slots);
        let front = -self.bonnet_m - 0.16;
        let tall = (self.tall() / 2.5).min(1.0);
        let size = vec3(0.1, 0.2 * tall, 0.4 * tall);
        let at = vec3(front + 0.02, half + 0.03 + 0.14 * tall, belt + 0.42 * tall);
        let hold = |z: f32| vec3(front - 0.16, half - 0.04, z);
        work.mirror([hold(header - 0.08), hold(belt + 0.1)], at, size);
        let wide = vec3(0.09, 0.18 * tall, 0.15 * tall);
        work.mirror([hold(belt + 0.05), hold(belt + 0.08)], at - Vec3::Z * 0.3 * tall, wide);
        if self.tall() > 2.1 {
            let visor = hull.front_panel(vec2(-half * 0.86, header - 0.03), vec2(half * 0.86, header + 0.1), 0.07);
            work.add(slots.trim, visor);
            let rows = if self.height_m - header > 0.5 { header + 0.3 } else { self.height_m - 0.12 };
            for k in -2_i32..=2 {
                let y = k as f32 * half * 0.36;
                let at = vec3(hull.front_at(y, rows) + 0.01, y, rows);
                work.add(slots.amber, Shape::ellipsoid(vec3(0.045, 0.055, 0.025), 12).moved(at));
            }
        }
        if self.bonnet_m == 0.0 && self.tall() > 2.1 {
            let x = -self.length_m - 0.1;
            work.add(
                slots.trim,
                block([0.16, 0.24, self.belt() - 0.5], [x, half - 0.25, self.belt() * 0.5 + 0.35], 0.04),
            );
            work.add(slots.trim, block([0.22, 0.3, 0.3], [x, half - 0.25, self.belt() + 0.2], 0.06));
        }
        work.pair(slots.amber, block([0.1, 0.02, 0.04], [front - 0.06, half + 0.005, belt - 0.3], 0.008));
    }

    /// Dashboard, seats, rear wall, who drives.
    fn inside(&self, work: &mut Workshop) {
        let (half, belt, slots) = (self.half() - 0.05, self.belt(), work.slots);
        let nose = -self.bonnet_m - 0.12;
        let dash = lying(&[
            Section { x: nose - 0.55, z: belt - 0.12, half: vec2(half, 0.06), corner: 0.05 },
            Section { x: nose - 0.4, z: belt - 0.1, half: vec2(half, 0.12), corner: 0.08 },
            Section { x: nose - 0.02, z: belt - 0.12, half: vec2(half - 0.12, 0.1), corner: 0.05 },
        ]);
        work.add(slots.interior, dash);
        let hips = self.hips();
        for side in [1.0, -1.0] {
            work.seat(hips * vec3(1.0, side, 1.0) - Vec3::Z * 0.1, 0.5);
            if self.crew {
                work.seat(vec3(-self.length_m + 0.42, side * half * 0.5, hips.z - 0.1), 0.9);
            }
        }
        let wheel = vec3(hips.x + 0.46, hips.y, hips.z + 0.24);
        work.steering_wheel(wheel, 0.22, 0.5);
        work.driver(hips, wheel);
        let top = self.header() - 0.02;
        let wall =
            block([0.03, half * 1.98, top - belt + 0.9], [-self.length_m + 0.07, 0.0, (top + belt - 0.9) / 2.0], 0.01);
        let floor = block(
            [self.length_m - self.bonnet_m - 0.3, half * 1.98, 0.04],
            [(nose - self.length_m) / 2.0, 0.0, hips.z - 0.45],
            0.01,
        );
        let ceiling = block(
            [self.length_m - self.bonnet_m - 0.8, half * 1.7, 0.03],
            [(nose - self.length_m - 0.5) / 2.0, 0.0, top + 0.02],
            0.01,
        );
        work.add(slots.interior, Shape::join([wall, floor, ceiling]));
    }
}
