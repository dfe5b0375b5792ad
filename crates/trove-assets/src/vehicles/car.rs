//! Passenger cars and vans: a smooth shell with windows, lamps, wheels and gaps cut into it, and a cabin inside.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::body::{Body, Profile, Skin};
use super::cabin;
use super::face::{Back, End, Face};
use super::fittings;
use super::grid::{clipped, hull, inset, outset, rect, simple, soft};
use super::palette::Palette;
use super::wheel::{Rim, wheel};
use crate::shape::{Prism, Shape};

/// Width of the gap around a door.
const GAP_M: f32 = 0.008;

/// A car to build.
#[derive(Clone, Debug)]
pub(crate) struct CarPlan {
    pub(crate) profile: Profile,
    /// Distances of the axles from the front.
    pub(crate) axles_m: [f32; 2],
    pub(crate) wheel_radius_m: f32,
    pub(crate) rim: Rim,
    /// Where the side windows are parted, from the front; doors end there too.
    pub(crate) pillars_m: Vec<f32>,
    /// Where the side windows end, at their lower and at their upper edge.
    pub(crate) glass_end_m: [f32; 2],
    /// Windows behind this distance are sheet metal (panel vans).
    pub(crate) blind_from_m: f32,
    /// Side windows behind this distance are dark.
    pub(crate) dark_from_m: f32,
    /// Black plastic around the lower edge and the wheels.
    pub(crate) cladding: bool,
    /// A bright line around the side windows.
    pub(crate) is_chromed: bool,
    pub(crate) face: Face,
    pub(crate) back: Back,
    /// Rails on the roof.
    pub(crate) roof_rails: bool,
    /// Rows of seats, as distances of their backs from the front.
    pub(crate) seats_m: Vec<f32>,
    /// Drives on the left: the steering wheel is on the right.
    pub(crate) right_hand_drive: bool,
}

impl CarPlan {
    /// The car, its front at x = 0.
    pub(crate) fn build(&self, palette: &Palette) -> Shape {
        let body = self.body();
        let skin = Skin {
            paint: palette.paint,
            glass: palette.glass,
            rear_glass: if self.dark_from_m < f32::INFINITY { palette.privacy } else { palette.glass },
            trim: palette.trim,
            under: palette.trim,
            lining: palette.lining,
            has_rear_window: self.blind_from_m > self.profile.length_m,
        };
        let end = End { profile: &self.profile, palette };
        let house = self.windows(body.greenhouse(&skin), &body, palette);
        let house = end.back(house, &self.back);

        let mut shell = self.cladding(body.shell(&skin), palette);
        shell = self.gaps(shell, &body, palette);
        shell = end.bumper(shell, &self.back);
        shell = end.back(shell, &self.back);
        let mut half = Vec::new();
        for &axle in &self.axles_m {
            let (cut, arch) = self.arch(shell, axle, palette);
            shell = cut;
            half.extend([arch, self.wheel(axle, palette)]);
        }
        half.push(fittings::on_the_side(self, &body, &shell, palette));
        half.push(end.front(shell, &self.face));
        half.push(house);
        let whole = Shape::join(half).both_sides();
        let cabin = cabin::interior(self, &body, palette);

        Shape::join([self.fuel_flap(whole, &body, palette), cabin, fittings::in_the_middle(self, &body, palette)])
    }

    /// The shell's shape before it is meshed.
    pub(crate) fn body(&self) -> Body {
        let arches = self.axles_m.map(|s| vec3(s, self.wheel_radius_m + 0.01, self.arch_radius_m()));
        Body::new(&self.profile, &arches)
    }

    pub(super) fn half_m(&self) -> f32 {
        self.profile.width_m / 2.0
    }

    fn arch_radius_m(&self) -> f32 {
        self.wheel_radius_m * 1.09 + 0.02
    }

    /// Where the front doors begin.
    fn first_gap_m(&self) -> f32 {
        (self.axles_m[0] + self.arch_radius_m() + 0.05).max(self.profile.cowl.0 + 0.05)
    }

    /// Where doors end: at every pillar but one that only parts off a small pane beside the windscreen.
    pub(super) fn door_ends_m(&self) -> impl Iterator<Item = f32> {
        let first = self.first_gap_m();
        self.pillars_m.iter().copied().filter(move |&s| s > first + 0.3)
    }

    fn windows(&self, house: Shape, body: &Body, palette: &Palette) -> Shape {
        // The opening: over the doors, under the roof's edge, from the windscreen's side edge to its end.
        let [low_end, high_end] = self.glass_end_m.map(|s| s.min(self.blind_from_m));
        let (low_start, high_start) = (body.screen_side_m(0.05) - 0.04, body.screen_side_m(0.93) - 0.03);
        let steps = 6;
        let points = (0..=steps).flat_map(|i| {
            let t = i as f32 / steps as f32;
            let (a, b) = (low_start + (low_end - low_start) * t, high_start + (high_end - high_start) * t);
            [vec2(-a, body.belt_m(a) + 0.022), vec2(-b, body.rail_m(b) - 0.035)]
        });
        let opening = soft(&simple(&hull(points.collect())), 0.06);
        let mut house = house;
        if self.is_chromed {
            house = house.mark(&Prism::side(&outset(&opening, 0.014), 0.2..=2.0), palette.chrome);
        }
        house = house.mark(&Prism::side(&opening, 0.2..=2.0), palette.trim);
        let opening = inset(&opening, 0.016);
        let mut posts = vec![low_start - 1.0];
        posts.extend(self.pillars_m.iter().copied().filter(|&s| s < low_end - 0.05));
        posts.push(low_end.max(high_end) + 1.0);
        for w in posts.windows(2) {
            let pane = clipped(&opening, Vec2::X, -w[0] - 0.028);
            let pane = clipped(&pane, -Vec2::X, w[1] - 0.028);
            if pane.len() > 2 {
                let slot = if w[0] + 0.1 > self.dark_from_m { palette.privacy } else { palette.glass };
                house = house.mark(&Prism::side(&pane, 0.2..=2.0), slot);
            }
        }
        house
    }

    fn cladding(&self, skin: Shape, palette: &Palette) -> Shape {
        let sill = self.profile.clearance_m;
        let high = sill + if self.cladding { 0.16 } else { 0.045 };
        let length = self.profile.length_m;
        let skin = skin.mark(&Prism::side(&rect(vec2(-length - 0.1, 0.0), vec2(0.2, high)), 0.2..=2.0), palette.trim);
        if !self.cladding {
            return skin;
        }
        let arch = |skin: Shape, &axle: &f32| {
            let centre = vec2(-axle, self.wheel_radius_m + 0.01);
            skin.mark(&Prism::round_side(centre, self.arch_radius_m() + 0.055, 16, 0.3..=2.0), palette.trim)
        };
        self.axles_m.iter().fold(skin, arch)
    }

    /// Gaps between doors, bonnet, boot and bumpers.
    fn gaps(&self, skin: Shape, body: &Body, palette: &Palette) -> Shape {
        let p = &self.profile;
        let sill = p.clearance_m + if self.cladding { 0.17 } else { 0.1 };
        let mut skin = skin;
        let mut line = |a: Vec2, b: Vec2| {
            let side = (b - a).perp().normalize_or_zero() * GAP_M / 2.0;
            let strip = [a - side, b - side, b + side, a + side];
            let shape = std::mem::take(&mut skin);
            skin = shape.mark(&Prism::side(&strip, 0.3..=2.0), palette.seam);
        };
        // Doors: the first gap leans with the windscreen, the last follows the wheel arch.
        let first = self.first_gap_m();
        let top = |s: f32| body.belt_m(s) + 0.03;
        let foot_m = sill + (top(first) - sill) * 0.62;
        line(vec2(-first, sill), vec2(-first, foot_m));
        line(vec2(-first, foot_m), vec2(-first - 0.05, top(first)));
        let mut last = first;
        for s in self.door_ends_m() {
            let (arch, radius) = (self.axles_m[1], self.arch_radius_m() + 0.05);
            let low = if s > arch - radius { vec2(-(arch - radius), sill) } else { vec2(-s, sill) };
            let bend = vec2(-s, (sill + (top(s) - sill) * 0.66).max(self.wheel_radius_m + radius * 0.75));
            line(low, if s > arch - radius { vec2(-(arch - radius * 0.86), bend.y - 0.22) } else { bend });
            if s > arch - radius {
                line(vec2(-(arch - radius * 0.86), bend.y - 0.22), bend);
            }
            line(bend, vec2(-s, top(s)));
            last = last.max(s.min(arch - radius));
        }
        if last > first {
            line(vec2(-last, sill), vec2(-first, sill));
        }
        // The front bumper meets the wing, the back bumper the quarter panel.
        let front = vec2(-self.axles_m[0] + self.arch_radius_m() * 0.85, self.wheel_radius_m + 0.24);
        line(front, vec2(front.x + 0.24, p.nose_m - 0.2));
        let rear = vec2(-self.axles_m[1] - self.arch_radius_m() * 0.95, self.wheel_radius_m + 0.17);
        line(rear, vec2(-p.length_m + 0.16, p.clearance_m + 0.44));
        self.lids(skin, body, palette)
    }

    /// Gaps around bonnet and boot lid, or tailgate.
    fn lids(&self, skin: Shape, body: &Body, palette: &Palette) -> Shape {
        let (p, half) = (&self.profile, self.half_m());
        let lines = |skin: Shape, points: &[Vec2], prism: &dyn Fn(&[Vec2]) -> Prism| {
            points.windows(2).fold(skin, |skin, w| {
                let side = (w[1] - w[0]).perp().normalize_or_zero() * GAP_M / 2.0;
                skin.mark(&prism(&[w[0] - side, w[1] - side, w[1] + side, w[0] + side]), palette.seam)
            })
        };
        let above = |polygon: &[Vec2]| Prism::top(polygon, p.nose_m - 0.14..=2.0);
        let nose = |share: f32| vec2(-body.nose_s(half * share) - 0.015, half * share);
        let bonnet = [
            nose(0.0) - vec2(0.0, 0.05),
            nose(0.2),
            nose(0.4),
            nose(0.56),
            nose(0.68) - vec2(0.05, 0.0),
            vec2(-p.cowl.0 * 0.6, half * 0.79),
            vec2(-p.cowl.0 - p.screen_bow_m[0] * 0.7, half * 0.84),
        ];
        let skin = lines(skin, &bonnet, &above);
        let low = p.tail_m + self.back.lid_m;
        let rear =
            [vec2(-0.05, low), vec2(half * 0.6, low), vec2(half * 0.74, low + 0.06), vec2(half * 0.76, p.tail_m)];
        let skin = lines(skin, &rear, &|polygon| Prism::front(polygon, -p.length_m - 0.1..=-p.length_m + 0.35));
        if p.has_bed || p.length_m - p.deck.0 < 0.3 {
            return skin;
        }
        let boot =
            [vec2(-p.length_m + 0.02, half * 0.76), vec2(-p.deck.0 + 0.02, half * 0.74), vec2(-p.deck.0 - 0.03, -0.05)];
        lines(skin, &boot, &|polygon| Prism::top(polygon, p.tail_m - 0.12..=2.0))
    }

    /// A cover on the right side.
    fn fuel_flap(&self, skin: Shape, body: &Body, palette: &Palette) -> Shape {
        let s = self.axles_m[1] + 0.08;
        let middle = vec2(-s, body.belt_m(s) - 0.17);
        let outline = soft(&rect(middle - 0.085, middle + vec2(0.085, 0.075)), 0.03);
        let closed = outline.iter().chain(outline.first()).copied().collect::<Vec<_>>();
        let (painted, other) = skin.split_slot(palette.paint);
        let marked = closed.windows(2).fold(painted, |skin, w| {
            let side = (w[1] - w[0]).perp().normalize_or_zero() * GAP_M / 2.0;
            let strip = [w[0] - side, w[1] - side, w[1] + side, w[0] + side];
            skin.mark(&Prism::side(&strip, 0.5..=2.0).mirrored(), palette.seam)
        });
        marked.and(other)
    }

    /// A wheel arch cut out of the left half, with a dark well and a lip that follows the skin.
    fn arch(&self, skin: Shape, axle: f32, palette: &Palette) -> (Shape, Shape) {
        let radius = self.arch_radius_m();
        let centre = vec2(-axle, self.wheel_radius_m + 0.01);
        let inner = self.half_m() * 0.5;
        let angles: Vec<f32> = (0..=20).map(|i| -0.5 + (PI + 1.0) * i as f32 / 20.0).collect();
        let floor = self.profile.clearance_m + 0.02;
        let rim: Vec<Vec3> = angles
            .iter()
            .map(|a| centre + Vec2::from_angle(*a) * radius)
            .map(|q| {
                let through = vec3(q.x, 0.0, q.y.max(floor));
                let y = skin.outermost(Vec3::Y, through).unwrap_or(self.half_m() * 0.95);
                vec3(q.x, y, q.y.max(floor))
            })
            .collect();
        let row = |y: f32| rim.iter().map(|&q| vec3(q.x, y, q.z)).collect::<Vec<_>>();
        let well = Shape::sheet(&[row(inner), rim.clone()]).slot(palette.seam);
        let back: Vec<Vec2> = rim.iter().map(|q| vec2(q.x, q.z)).collect();
        let wall = Shape::flat(&back).turned(Quat::from_rotation_x(FRAC_PI_2)).inside_out();
        let wall = wall.moved(Vec3::Y * inner).slot(palette.seam);
        let lip_slot = if self.cladding { palette.trim } else { palette.paint };
        let lip = Shape::tube(&rim, if self.cladding { 0.014 } else { 0.008 }, 4).slot(lip_slot);
        let cut = Prism::round_side(centre, radius, 24, inner..=2.0);
        (skin.without(&cut), well.and(wall).and(lip))
    }

    fn wheel(&self, axle: f32, palette: &Palette) -> Shape {
        let width = 0.17 + self.wheel_radius_m * 0.14;
        let y = self.half_m() - width / 2.0 - 0.012;
        wheel(palette, self.wheel_radius_m, width, self.rim).moved(vec3(-axle, y, self.wheel_radius_m))
    }
}
