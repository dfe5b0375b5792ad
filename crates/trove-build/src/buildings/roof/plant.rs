//! What stands on flat roofs: stair heads, air handlers with their ducts, vents, tanks, antennas, solar panels,
//! railings. All of it is sunk a little into the deck, so that it shares no plane with it.

use glam::{DVec2, DVec3};
use trove_model::{BuildingCustoms, BuildingKind, Polygon, Random};

use crate::buildings::rectangle::base;
use crate::buildings::shell::{Shell, Slot};
use crate::buildings::volumes::{House, Volume};
use crate::geometry::plane::grown;

/// Smaller decks carry nothing, m².
const LEAST_M2: f64 = 30.0;
/// Everything reaches this far into the deck, metres.
const SUNK_M: f64 = 0.05;
/// From the parapet and from each other, metres.
const KEPT_M: f64 = 0.5;
/// Beyond this distance from the driven path only what is large is built, metres.
const SMALL_SEEN_M: f64 = 120.0;
/// A railing is this high, its posts this far apart, metres.
const RAILING_M: f64 = 1.0;
const RAILING_POSTS_M: f64 = 2.2;

/// A deck while it fills up.
struct Deck<'a> {
    polygon: &'a Polygon,
    z: f64,
    axis: DVec2,
    placed: Vec<(DVec2, f64)>,
}

impl Deck<'_> {
    /// A free place for a thing of some size, which is taken from then on.
    fn place(&mut self, size_m: DVec2, tries: usize, random: &mut Random) -> Option<DVec3> {
        let bounds = self.polygon.bounds()?;
        let radius_m = size_m.length() / 2.0;
        for _ in 0..tries {
            let at = bounds.min + bounds.size_m() * DVec2::new(random.unit(), random.unit());
            let is_free = self.placed.iter().all(|(p, r)| p.distance(at) > r + radius_m + KEPT_M);
            if is_free && self.polygon.contains(at) && self.polygon.edge_distance_m(at) > radius_m + KEPT_M {
                self.placed.push((at, radius_m));
                return Some(at.extend(self.z - SUNK_M));
            }
        }
        None
    }
}

/// Puts on a deck at level `z` what a building of its kind and size has there.
pub(super) fn plant(
    shell: &mut Shell,
    deck: &[Polygon],
    z: f64,
    volume: &Volume<'_>,
    house: &House<'_>,
    random: &mut Random,
) {
    let Some(polygon) = deck.iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2())) else { return };
    let area_m2 = polygon.area_m2();
    let height_m = volume.top_m - volume.bottom_m;
    if area_m2 < LEAST_M2
        || height_m < 3.0
        || house.building.kind.is_some_and(BuildingKind::is_house) && volume.top_m < 5.0
    {
        return;
    }
    let axis = base(polygon).map_or(DVec2::X, |b| b.axis);
    let mut deck = Deck { polygon, z, axis, placed: Vec::new() };
    if volume.top_m > 9.0 && area_m2 > 110.0 {
        stair_head(shell, &mut deck, area_m2 > 500.0, random);
    }
    use BuildingKind as K;
    let is_worked_in = matches!(
        house.building.kind,
        Some(
            K::Office
                | K::Commercial
                | K::Retail
                | K::Supermarket
                | K::Hotel
                | K::Hospital
                | K::University
                | K::Industrial
                | K::Warehouse
        )
    );
    let units = if is_worked_in { area_m2 / 180.0 } else { area_m2 / 450.0 };
    for _ in 0..(units + random.unit()).min(8.0) as usize {
        air_handler(shell, &mut deck, random);
    }
    if random.chance(0.14) && area_m2 > 90.0 {
        solar_rows(shell, &mut deck, random);
    }
    if house.path_m > SMALL_SEEN_M {
        return;
    }
    tank(shell, &mut deck, house.customs, volume.top_m, random);
    for _ in 0..(area_m2 / 60.0 + random.unit()).min(9.0) as usize {
        vent(shell, &mut deck, random);
    }
    if random.chance(0.4) {
        antenna(shell, &mut deck, random);
    }
    if random.chance(0.2) && volume.top_m > 6.0 {
        railing(shell, polygon, z);
    }
}

fn stair_head(shell: &mut Shell, deck: &mut Deck<'_>, is_large: bool, random: &mut Random) {
    let length_m = if is_large { random.range(4.5, 7.0) } else { random.range(2.6, 4.0) };
    let size = DVec3::new(length_m, random.range(2.4, 3.8), random.range(2.4, 3.2));
    let Some(at) = deck.place(size.truncate(), 12, random) else { return };
    shell.block(Slot::Gable, at, deck.axis, size);
    let roof = size.truncate() + 0.16;
    shell.block(Slot::Trim, at + DVec3::Z * (size.z - 0.04), deck.axis, roof.extend(0.16));
    let door = at + (deck.axis * size.x / 2.0).extend(SUNK_M);
    shell.block(Slot::Metal, door, deck.axis, DVec3::new(0.06, 0.95, 2.0));
}

fn air_handler(shell: &mut Shell, deck: &mut Deck<'_>, random: &mut Random) {
    let size = DVec3::new(random.range(1.4, 3.6), random.range(1.1, 2.2), random.range(0.9, 1.9));
    // A duct leads away from it along the roof.
    let duct_m = random.range(0.0, 4.0);
    let Some(at) = deck.place(size.truncate() + DVec2::new(duct_m, 0.0), 8, random) else { return };
    let along = deck.axis.extend(0.0);
    let body = at - along * duct_m / 2.0;
    shell.block(Slot::Metal, body, deck.axis, size);
    let fans = (size.x / 1.1).floor().max(1.0);
    for i in 0..fans as usize {
        let share = (i as f64 + 0.5) / fans - 0.5;
        let foot = body + along * share * size.x + DVec3::Z * (size.z - 0.02);
        shell.cylinder(Slot::Boards, foot, [0.36, 0.36], 0.2, 10);
    }
    if duct_m > 1.0 {
        let start = body + along * (size.x + duct_m) / 2.0 + DVec3::Z * 0.35;
        shell.block(Slot::Metal, start, deck.axis, DVec3::new(duct_m + 0.1, 0.5, 0.45));
    }
}

fn vent(shell: &mut Shell, deck: &mut Deck<'_>, random: &mut Random) {
    let (radius_m, height_m) = (random.range(0.06, 0.2), random.range(0.4, 1.0));
    let Some(at) = deck.place(DVec2::splat(radius_m * 2.0), 3, random) else { return };
    shell.cylinder(Slot::Metal, at, [radius_m; 2], height_m, 8);
    shell.cylinder(Slot::Metal, at + DVec3::Z * (height_m - 0.02), [radius_m * 1.6, radius_m * 0.9], 0.14, 8);
}

/// A water tank of wood on a stand, or tanks of steel or plastic, in numbers, where the mains are weak.
fn tank(shell: &mut Shell, deck: &mut Deck<'_>, customs: &BuildingCustoms, top_m: f64, random: &mut Random) {
    let has = |share: f64, random: &mut Random| share > 0.0 && random.chance(share);
    match () {
        () if top_m > 18.0 && has(customs.wooden_tank_share, random) => {
            let Some(at) = deck.place(DVec2::splat(3.4), 8, random) else { return };
            for turn in 0..4 {
                let leg = DVec2::from_angle(f64::from(turn) * std::f64::consts::FRAC_PI_2 + 0.8) * 1.2;
                shell.block(Slot::Metal, at + leg.extend(0.0), deck.axis, DVec3::new(0.16, 0.16, 2.6));
            }
            shell.cylinder(Slot::Boards, at + DVec3::Z * 2.5, [1.6, 1.6], 3.0, 14);
            shell.cylinder(Slot::Boards, at + DVec3::Z * 5.45, [1.75, 0.05], 1.1, 14);
        }
        () if has(customs.steel_tank_share, random) => {
            for _ in 0..1 + random.index(3) {
                let radius_m = random.range(0.5, 0.85);
                let Some(at) = deck.place(DVec2::splat(radius_m * 2.0), 6, random) else { return };
                let height_m = random.range(1.2, 2.0);
                shell.cylinder(Slot::Metal, at, [radius_m * 0.8; 2], 0.6, 10);
                shell.cylinder(Slot::Metal, at + DVec3::Z * 0.55, [radius_m; 2], height_m, 12);
                shell.cylinder(Slot::Metal, at + DVec3::Z * (0.53 + height_m), [radius_m, 0.2], 0.25, 12);
            }
        }
        () => {}
    }
}

fn antenna(shell: &mut Shell, deck: &mut Deck<'_>, random: &mut Random) {
    let height_m = random.range(2.5, 5.0);
    let Some(at) = deck.place(DVec2::splat(0.6), 4, random) else { return };
    shell.cylinder(Slot::Metal, at, [0.035, 0.025], height_m, 6);
    for i in 0..4 {
        let bar = at + DVec3::Z * (height_m - 0.15 - 0.22 * f64::from(i));
        shell.block(Slot::Metal, bar, deck.axis, DVec3::new(0.02, 0.9 - 0.12 * f64::from(i), 0.02));
    }
}

/// Rows of panels on stands, tilted along the roof.
fn solar_rows(shell: &mut Shell, deck: &mut Deck<'_>, random: &mut Random) {
    let (rows, length_m) = (2 + random.index(3), random.range(4.0, 9.0).round());
    let Some(middle) = deck.place(DVec2::new(length_m, rows as f64 * 1.8), 12, random) else { return };
    let (along, across) = (deck.axis.extend(0.0), deck.axis.perp().extend(0.0));
    for row in 0..rows {
        let foot = middle + across * ((row as f64 - (rows as f64 - 1.0) / 2.0) * 1.8);
        let ring = |p: DVec3| {
            [
                p - across * 0.55 + DVec3::Z * 0.15,
                p + across * 0.55 + DVec3::Z * 0.15,
                p + across * 0.5 + DVec3::Z * 0.62,
            ]
        };
        let ends = [foot - along * length_m / 2.0, foot + along * length_m / 2.0];
        shell.sweep([Slot::Metal, Slot::Metal, Slot::Glazing], &ends.map(ring));
    }
}

/// Posts and two rails along the parapet.
fn railing(shell: &mut Shell, deck: &Polygon, z: f64) {
    for (a, b) in grown(std::slice::from_ref(deck), -0.15).iter().flat_map(Polygon::edges) {
        let length_m = a.distance(b);
        if length_m < 0.3 {
            continue;
        }
        let axis = (b - a) / length_m;
        for height_m in [RAILING_M * 0.55, RAILING_M] {
            let size = DVec3::new(length_m, 0.04, 0.04);
            shell.block(Slot::Metal, ((a + b) / 2.0).extend(z + height_m), axis, size);
        }
        let posts = (length_m / RAILING_POSTS_M).ceil().max(1.0);
        for i in 0..posts as usize {
            let foot = a.lerp(b, i as f64 / posts).extend(z - SUNK_M);
            shell.block(Slot::Metal, foot, axis, DVec3::new(0.05, 0.05, RAILING_M + SUNK_M - 0.01));
        }
    }
}
