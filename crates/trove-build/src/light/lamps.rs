//! Lamps that people switch on in the dark.

use std::sync::Arc;

use glam::{Vec3, vec3};
use trove_model::{Beam, Class, DrivingSide, Environment, Material, Mesh, Role};

use crate::assembly::{Actor, Stock, UNIT_CD_M2};

/// Lamps go on when the sun is this high, sine: street lamps do a quarter of an hour before sunset.
const LAMPS_ON_BELOW: f64 = 0.04;
/// Photographed skies that give a level surface less than this are those of the night; day's give about π.
const DARK_IRRADIANCE: f32 = 0.5;
/// Signals are dimmed in the dark.
const DIMMED: f32 = 0.15;
const LOW_BEAM: &str = include_str!("low_beam.tsv");

/// Radiance of lamps of houses, and between which hours by the sun they are on if it is dark: a lampshade of 0.7 m² that
/// gives 1,800 lm and looks like 2,700 K; a panel of 0.36 m² that gives 3,600 lm and looks like 4,000 K; a bar that gives
/// 300 lm a metre to the sign below it.
const HOUSES: [(Role, [f64; 2], Vec3); 5] = [
    (Role::WallLamp, [0.0, 24.0], vec3(0.14, 0.1, 0.06)),
    (Role::RoomLamp, [0.0, 24.0], vec3(0.042, 0.022, 0.007)),
    (Role::LightPanel, [0.0, 24.0], vec3(0.122, 0.096, 0.067)),
    (Role::ShopPanel, [7.0, 20.0], vec3(0.122, 0.096, 0.067)),
    (Role::SignLamp, [5.0, 23.0], vec3(0.061, 0.048, 0.0335)),
];

/// Colours of vehicles' lamps, of luminance 1: white, and red behind glass or lens.
const WHITE: Vec3 = vec3(1.12, 0.98, 0.83);
const RED: Vec3 = vec3(4.3, 0.1, 0.1);
/// What all lamps of a sort on a vehicle give together, candelas straight ahead or back: low beams by their table, a bicycle's
/// lamp, tail lamps (UN Regulation 148: 4 to 17 each), brake lamps (60 to 260 each).
const LOW_BEAMS: f32 = 2.0;
const CYCLE_CD: f32 = 60.0;
const TAIL_CD: f32 = 12.0;
const BRAKE_CD: f32 = 220.0;
/// No lamp is smaller, m².
const SMALLEST_M2: f32 = 1e-3;

/// Switches lights of houses on, by the hour, where street lamps are; where vehicles are driven with their lights on, those
/// of the actors that are told to be driven; and brake lamps where vehicles brake, day and night.
pub(crate) fn switch_on<'a>(
    solar_hour: f64,
    side: DrivingSide,
    drives_lit: bool,
    stock: &mut Stock,
    actors: impl Iterator<Item = (bool, &'a mut Actor)>,
) {
    if stock.is_dark {
        // Street lamps are lit already.
        for material in stock.materials.iter_mut().filter(|material| material.role != Some(Role::StreetLamp)) {
            material.emission = glow(material, solar_hour).unwrap_or(material.emission * DIMMED);
        }
    }
    let low_beam = drives_lit.then(|| low_beam(side));
    let tail = Lamp { role: Role::TailLamp, along: -1.0, candelas: TAIL_CD, color: RED, beam: None };
    for (is_driven, actor) in actors {
        let Some(mesh) = actor.mesh().map(|mesh| stock.meshes[mesh].clone()) else { continue };
        let is_bicycle = actor.class() == Class::CycleRider;
        if let Some((beam, most_cd)) = low_beam.as_ref().filter(|_| is_driven) {
            let (candelas, beam) =
                if is_bicycle { (CYCLE_CD, None) } else { (LOW_BEAMS * most_cd, Some(beam.clone())) };
            let head = Lamp { role: Role::Headlamp, along: 1.0, candelas, color: WHITE, beam };
            actor.materials = tail.lit(&mesh, &head.lit(&mesh, &actor.materials, stock), stock);
        }
        if actor.brakes() && !is_bicycle {
            let brake = Lamp { candelas: BRAKE_CD, ..tail.clone() };
            actor.braking = Some(brake.lit(&mesh, &actor.materials, stock));
        }
    }
}

/// Lamps of a sort on a vehicle.
#[derive(Clone)]
struct Lamp {
    role: Role,
    /// 1: they look ahead, −1: back.
    along: f32,
    /// All of them together.
    candelas: f32,
    color: Vec3,
    beam: Option<Arc<Beam>>,
}

impl Lamp {
    /// Materials of a vehicle of this shape on which they are lit.
    fn lit(&self, mesh: &Mesh, materials: &[usize], stock: &mut Stock) -> Vec<usize> {
        let is_lamp: Vec<bool> = materials.iter().map(|&m| stock.materials[m].role == Some(self.role)).collect();
        let area_m2 = area_m2(mesh, self.along, |slot| is_lamp[usize::from(slot)]).max(SMALLEST_M2);
        let emission = self.color * (self.candelas / area_m2 / UNIT_CD_M2);
        let change = |(&material, &is_lamp): (&usize, &bool)| {
            if !is_lamp {
                return material;
            }
            let lamp = Material { emission, beam: self.beam.clone(), ..stock.materials[material].clone() };
            stock.material(&lamp)
        };
        materials.iter().zip(&is_lamp).map(change).collect()
    }
}

/// What a lamp of a house gives at an hour; `None` for what is none.
fn glow(material: &Material, solar_hour: f64) -> Option<Vec3> {
    let (_, [from, until], emission) = HOUSES.iter().find(|(role, _, _)| material.role == Some(*role))?;
    Some(if (*from..*until).contains(&solar_hour) { *emission } else { Vec3::ZERO })
}

/// Of triangles of some slots, what faces along x, or against it where `along` is −1, as seen from there.
fn area_m2(mesh: &Mesh, along: f32, is_meant: impl Fn(u16) -> bool) -> f32 {
    let facing = |(_, corners): (usize, &[u32; 3])| {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        (0.5 * (b - a).cross(c - a).x * along).max(0.0)
    };
    mesh.triangles.iter().enumerate().filter(|(t, _)| is_meant(mesh.slot(*t))).map(facing).sum()
}

/// The low beam of a car that keeps to a side, and the candelas of which it tells shares.
fn low_beam(side: DrivingSide) -> (Arc<Beam>, f32) {
    // Its first row is headed by a word.
    let numbers = |line: &str| -> Vec<f32> { line.split('\t').filter_map(|n| n.parse().ok()).collect() };
    let mut rows = LOW_BEAM.lines().filter(|line| !line.starts_with('#')).map(numbers);
    let mut azimuths_deg = rows.next().unwrap_or_default();
    let (elevations_deg, mut candelas): (Vec<f32>, Vec<Vec<f32>>) =
        rows.filter_map(|row| row.split_first().map(|(elevation, candelas)| (*elevation, candelas.to_vec()))).unzip();
    if side == DrivingSide::Left {
        azimuths_deg = azimuths_deg.into_iter().rev().map(|azimuth| -azimuth).collect();
        candelas.iter_mut().for_each(|row| row.reverse());
    }
    let candelas = candelas.concat();
    let most = candelas.iter().copied().fold(0.0, f32::max);
    let shares = candelas.into_iter().map(|n| n / most).collect();
    (Arc::new(Beam::new(azimuths_deg, elevations_deg, shares).expect("the built-in table is one")), most)
}

/// Whether lamps are on under a sky.
pub(crate) fn is_dark(environment: &Environment) -> bool {
    match environment {
        Environment::Sky(sky) => sky.to_sun.z < LAMPS_ON_BELOW,
        Environment::Map(map) => {
            let (width, rows) = (map.width as usize, map.height as usize / 2);
            let level = |y: usize| {
                let row = &map.rgb[y * width..(y + 1) * width];
                let mean = row.iter().flatten().sum::<f32>() / (3 * width) as f32;
                // ∫ cos sin over a row's zenith angles, all around.
                let sin_squared = |y: usize| (std::f32::consts::FRAC_PI_2 * y as f32 / rows as f32).sin().powi(2);
                mean * std::f32::consts::PI * (sin_squared(y + 1) - sin_squared(y))
            };
            (0..rows).map(level).sum::<f32>() < DARK_IRRADIANCE
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use trove_model::{
        AssetLibrary, EnvironmentMap, Fog, Form, Kind, Origin, PhysicalSky, Precipitation, Report, Seed, State,
    };

    use super::*;
    use crate::testing;
    use crate::{BuildSettings, Traffic, Weather, build};

    /// Its cars are lamps of a sort.
    fn library_of_lamps(role: Role) -> AssetLibrary {
        let mut library = testing::library();
        let cars = library.assets.iter_mut().filter(|asset| asset.kind == Kind::Car);
        cars.for_each(|asset| asset.slots[0].material.role = Some(role));
        library
    }

    fn fog(visibility_m: f64) -> Weather {
        Weather { fog: Some(Fog { visibility_m, height_m: 300.0, ground_z_m: 0.0 }), ..Weather::default() }
    }

    /// Emission of a street lamp, of a lampshade and of a signal under a sky.
    fn shining(environment: Environment) -> [Vec3; 3] {
        let mut stock = Stock::default();
        stock.is_dark = is_dark(&environment);
        let mut lamp = testing::asset("lamp/a", Kind::StreetLamp, [2.0, 0.3, 8.0]);
        lamp.slots[0].material.role = Some(Role::StreetLamp);
        stock.painted(&lamp, Seed(1));
        stock.material(&Material { role: Some(Role::RoomLamp), ..Material::default() });
        stock.material(&Material { emission: Vec3::X, ..Material::default() });
        switch_on(19.0, DrivingSide::Right, true, &mut stock, std::iter::empty());
        [0, 1, 2].map(|i| stock.materials[i].emission)
    }

    /// Candelas of the low beam, by degrees to the right and up.
    fn candelas(side: DrivingSide, right_deg: f64, up_deg: f64) -> f32 {
        let (beam, most) = low_beam(side);
        let (a, e) = (-right_deg.to_radians(), up_deg.to_radians());
        most * beam.share(DVec3::new(a.cos() * e.cos(), a.sin() * e.cos(), e.sin()).as_vec3())
    }

    #[test]
    fn the_low_beam_is_as_the_regulation_asks() {
        // UN Regulation 112, class B, for traffic on the right: least and most candelas at the points of its screen.
        for (name, right_deg, up_deg, least, most) in [
            ("B50L", -3.43, 0.57, 0.0, 350.0),
            ("75R", 1.15, -0.57, 10_100.0, f32::MAX),
            ("75L", -3.43, -0.57, 0.0, 10_600.0),
            ("50L", -3.43, -0.86, 0.0, 13_200.0),
            ("50R", 1.72, -0.86, 10_100.0, f32::MAX),
            ("50V", 0.0, -0.86, 5_100.0, f32::MAX),
            ("25L", -9.0, -1.72, 1_700.0, f32::MAX),
            ("25R", 9.0, -1.72, 1_700.0, f32::MAX),
            ("HV", 0.0, 0.0, 0.0, 625.0),
        ] {
            let found = candelas(DrivingSide::Right, right_deg, up_deg);
            assert!((least..=most).contains(&found), "{name}: {found}");
            assert!((candelas(DrivingSide::Left, -right_deg, up_deg) / found - 1.0).abs() < 1e-3, "{name}");
        }
    }

    #[test]
    fn street_lamps_shine_in_the_dark_and_signals_are_dimmed_then() {
        let sky = |z: f64| {
            let to_sun = DVec3::new(1.0, 0.0, z).normalize();
            let [turbidity, ground_albedo, cloud_cover] = [3.0, 0.2, 0.3];
            Environment::Sky(PhysicalSky { to_sun, moon: None, turbidity, ground_albedo, cloud_cover, cloud_seed: 1 })
        };
        let map = |radiance: f32| {
            let rgb = vec![[radiance; 3]; 32];
            Environment::Map(Arc::new(EnvironmentMap { name: String::new(), width: 8, height: 4, rgb }))
        };
        for dark in [sky(-0.2), sky(0.0), map(0.1)] {
            let [street, room, signal] = shining(dark);
            assert_eq!([room, signal], [HOUSES[1].2, Vec3::X * DIMMED]);
            assert!(street.min_element() > 0.0, "{street}");
        }
        for bright in [sky(0.5), map(0.6)] {
            assert_eq!(shining(bright), [Vec3::ZERO, Vec3::ZERO, Vec3::X]);
        }
    }

    #[test]
    fn shops_are_lit_while_they_are_open_and_their_signs_until_late() {
        let lit = |role: Role, solar_hour: f64| {
            let mut stock = Stock::default();
            stock.is_dark = true;
            stock.material(&Material { role: Some(role), emission: Vec3::ONE, ..Material::default() });
            switch_on(solar_hour, DrivingSide::Right, true, &mut stock, std::iter::empty());
            stock.materials[0].emission != Vec3::ZERO
        };
        let hours = [3.0, 6.0, 18.0, 22.0, 23.5];
        assert_eq!(hours.map(|hour| lit(Role::ShopPanel, hour)), [false, false, true, false, false]);
        assert_eq!(hours.map(|hour| lit(Role::SignLamp, hour)), [false, true, true, true, false]);
        assert!(hours.iter().all(|hour| lit(Role::RoomLamp, *hour)));
    }

    #[test]
    fn vehicles_are_driven_with_their_lights_on_in_fog_and_while_it_rains_or_snows() {
        let drive = testing::drive();
        let library = library_of_lamps(Role::Headlamp);
        let lit = |weather: Weather| {
            let settings = BuildSettings { weather, ..testing::settings() };
            let scene = build(&drive, None, &library, &settings, &Report::default()).unwrap().scene(&drive, 0);
            let cars = scene.instances.iter().filter(|i| i.class == Class::Car);
            cars.filter(|car| car.materials.iter().any(|&m| scene.materials[m].is_emitter())).count()
        };
        let falling =
            |form: Form| Weather { falling: Some(Precipitation { form, rate_mm_h: 1.0 }), ..Weather::default() };
        let wet = Weather { wetness: 1.0, ..Weather::default() };
        assert_eq!([Weather::default(), wet, fog(1500.0)].map(lit), [0; 3]);
        let [in_fog, in_rain, in_snow] = [fog(200.0), falling(Form::Rain), falling(Form::Snow)].map(lit);
        assert!(in_fog > 0 && in_fog == in_rain && in_rain == in_snow, "{in_fog} {in_rain} {in_snow}");
    }

    #[test]
    fn made_up_vehicles_are_driven_with_their_lights_on_where_each_is_seen_but_once() {
        let mut drive = testing::drive();
        drive.tracks.clear();
        drive.keyframes.truncate(1);
        drive.keyframes[0].boxes.clear();
        let library = library_of_lamps(Role::Headlamp);
        let traffic = Traffic { density: 3.0, ..Traffic::default() };
        let settings = BuildSettings { weather: fog(200.0), traffic, ..testing::settings() };
        let scene = build(&drive, None, &library, &settings, &Report::default()).unwrap().scene(&drive, 0);
        let mut counts = [0, 0];
        for car in scene.instances.iter().filter(|i| i.class == Class::Car) {
            let Some(object) = car.object.as_ref().filter(|object| object.origin == Origin::Added) else { continue };
            let moves = object.states.contains(&State::Moving);
            let is_lit = car.materials.iter().any(|&m| scene.materials[m].is_emitter());
            assert_eq!(is_lit, moves, "{:?}", car.id);
            counts[usize::from(moves)] += 1;
        }
        assert!(counts.iter().all(|&n| n > 0), "{counts:?}");
    }

    #[test]
    fn brake_lamps_are_lit_where_a_vehicle_brakes_and_nowhere_else() {
        let mut drive = testing::drive();
        // The car ahead comes to a stand with 3 m/s² from the fifth keyframe on.
        let way_m = |k: usize| {
            let braking_s = (0.5 * (k as f64 - 4.0)).clamp(0.0, 10.0 / 3.0);
            5.0 * k.min(4) as f64 + 10.0 * braking_s - 1.5 * braking_s * braking_s
        };
        for (k, cuboid) in &mut drive.tracks[1].boxes {
            cuboid.world_from_body.translation.x = 15.0 + way_m(*k);
            let annotated = drive.keyframes[*k].boxes.iter_mut().find(|b| b.track == 1).unwrap();
            annotated.cuboid = *cuboid;
        }
        let library = library_of_lamps(Role::TailLamp);
        let site = build(&drive, None, &library, &testing::settings(), &Report::default()).unwrap();
        let mut braking = Vec::new();
        for k in 0..drive.keyframes.len() {
            let scene = site.scene(&drive, k);
            for car in scene.instances.iter().filter(|i| i.class == Class::Car) {
                let brakes = car.object.as_ref().is_some_and(|object| object.states.contains(&State::Braking));
                let is_lit = car.materials.iter().any(|&m| scene.materials[m].is_emitter());
                assert_eq!(is_lit, brakes, "{:?} at {k}", car.id);
                braking.extend(brakes.then_some(k));
            }
        }
        assert!((2..7).contains(&braking.len()) && braking.iter().all(|k| (3..10).contains(k)), "{braking:?}");
    }
}
