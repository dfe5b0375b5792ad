//! Photographs beside renders of the same views → by how much their colours differ, and what would make them alike.

use std::collections::BTreeMap;

use glam::Vec3;
use trove_model::{Class, InstanceId, Labels, Looks, Raster, ToneCurve, luminance};

use crate::recolor::{Space, linear};

/// A photograph and a render of its view, of one size, with the render's labels.
pub struct Pair<'a> {
    /// The camera's name.
    pub camera: &'a str,
    /// 8-bit sRGB.
    pub photograph: &'a Raster<[u8; 3]>,
    /// 8-bit sRGB.
    pub render: &'a Raster<[u8; 3]>,
    /// Of the film on which the render is ([`trove_model::Film::contrast`]).
    pub contrast: f64,
    /// What the render shows.
    pub labels: &'a Labels,
}

/// What has a colour of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Thing {
    Class(Class),
    Building(InstanceId),
    /// A vehicle or a person.
    Individual(InstanceId),
}

/// Fewer pixels of something tell nothing.
const LEAST_PX: usize = 40;
/// Of what a photograph shows where something is in the render so much at either end is likely something else.
const TRIMMED: f64 = 0.15;
/// Below this light is the camera's own, exposed.
const DARK: f32 = 0.004;
/// Shares of the pixels of surfaces between which contrast is measured.
const CONTRAST_BETWEEN: [f64; 2] = [0.1, 0.9];
/// Pictures in which these are less apart, stops, tell no contrast.
const LEAST_STOPS: f64 = 1.0;
/// Contrasts that films have.
const CONTRASTS: [f64; 2] = [0.5, 3.0];
/// Lightness changes by at most so much, as a logarithm: that of surfaces by 2.7, that of paint and clothes, of which there
/// are any, by more.
const SURFACE: f32 = 1.0;
const PAINT: f32 = 2.3;
/// A channel of a surface leaves the others by at most so much: what is seen in its place may be of any colour.
const HUE: f32 = 0.12;
/// An exposure changes by at most so many stops.
const MOST_EV: f64 = 2.0;
/// Rounds of turns between exposures and colours.
const ROUNDS: usize = 12;

/// What would make renders look like photographs: the film's contrast, each camera's exposure, and then the colours of
/// vehicles, people, buildings and of the other classes. All are medians over what they are seen in, so that a photograph
/// that shows something else at a place has little say.
pub fn looks(pairs: &[Pair]) -> Looks {
    let contrast = contrast(pairs);
    // By camera and thing: to how much more light the photograph was exposed, as a logarithm, and the weight of that.
    let mut seen: BTreeMap<(&str, Thing), Vec<(Vec3, f64)>> = BTreeMap::new();
    for pair in pairs {
        for (thing, pixels) in things(pair) {
            let film = [(pair.photograph, contrast.unwrap_or(pair.contrast)), (pair.render, pair.contrast)];
            let [photograph, render] = film.map(|(picture, contrast)| exposed(picture, contrast, &pixels));
            let lighter = ((photograph + DARK) / (render + DARK)).map(f32::ln);
            seen.entry((pair.camera, thing)).or_default().push((lighter, (pixels.len() as f64).sqrt()));
        }
    }
    let mut exposures: BTreeMap<&str, f32> = seen.keys().map(|(camera, _)| (*camera, 0.0)).collect();
    let mut colours: BTreeMap<Thing, Vec3> = seen.keys().map(|(_, thing)| (*thing, Vec3::ZERO)).collect();
    for _ in 0..ROUNDS {
        for (camera, exposure) in &mut exposures {
            let of_camera = seen.iter().filter(|((c, _), _)| c == camera);
            // Paint may be any; of the rest the library's colours are a fair guess.
            let rest = of_camera.filter(|((_, thing), _)| matches!(thing, Thing::Class(_)));
            let lighter =
                rest.flat_map(|((_, thing), seen)| seen.iter().map(|(l, w)| (luminance(*l - colours[thing]), *w)));
            *exposure = median(lighter.collect()).clamp(-MOST_EV as f32, MOST_EV as f32);
        }
        for (thing, colour) in &mut colours {
            let of_thing: Vec<_> = seen.iter().filter(|((_, t), _)| t == thing).collect();
            let channel = |i: usize| {
                let lighter =
                    of_thing.iter().flat_map(|((c, _), seen)| seen.iter().map(|(l, w)| (l[i] - exposures[c], *w)));
                median(lighter.collect())
            };
            let found = Vec3::new(channel(0), channel(1), channel(2));
            let (most, hue) = if matches!(thing, Thing::Individual(_)) { (PAINT, PAINT) } else { (SURFACE, HUE) };
            let lighter = luminance(found).clamp(-most, most);
            *colour = lighter + (found - luminance(found)).clamp(Vec3::splat(-hue), Vec3::splat(hue));
        }
    }
    let mut looks = Looks { contrast, ..Looks::default() };
    for (thing, colour) in colours {
        match thing {
            Thing::Class(class) => drop(looks.classes.insert(class, colour.map(f32::exp))),
            Thing::Building(id) | Thing::Individual(id) => drop(looks.things.insert(id, colour.map(f32::exp))),
        }
    }
    let stops = |(camera, exposure): (&str, f32)| (camera.to_owned(), f64::from(exposure) / std::f64::consts::LN_2);
    looks.exposure_ev = exposures.into_iter().map(stops).collect();
    looks
}

/// CIE 1976 difference of the mean colours of each class between photographs and renders, as a mean over photographs.
pub fn distances(pairs: &[Pair]) -> BTreeMap<Class, f64> {
    let mut found: BTreeMap<Class, Vec<f64>> = BTreeMap::new();
    for pair in pairs {
        let mut pixels: BTreeMap<Class, Vec<usize>> = BTreeMap::new();
        for i in inside(&pair.labels.class, |a, b| a == b) {
            pixels.entry(pair.labels.class.data[i]).or_default().push(i);
        }
        for (class, pixels) in pixels.into_iter().filter(|(_, pixels)| pixels.len() >= LEAST_PX) {
            let mean = |picture: &Raster<[u8; 3]>| {
                let sum: Vec3 = pixels.iter().map(|&i| Vec3::from(Space::Lab.from_srgb(picture.data[i]))).sum();
                sum / pixels.len() as f32
            };
            found.entry(class).or_default().push(f64::from(mean(pair.photograph).distance(mean(pair.render))));
        }
    }
    found.into_iter().map(|(class, all)| (class, all.iter().sum::<f64>() / all.len() as f64)).collect()
}

/// The pixels of everything that has a colour of its own.
fn things(pair: &Pair) -> BTreeMap<Thing, Vec<usize>> {
    let Labels { class, instance, .. } = pair.labels;
    let mut pixels: BTreeMap<Thing, Vec<usize>> = BTreeMap::new();
    let both = Raster {
        width: class.width,
        height: class.height,
        data: class.data.iter().copied().zip(instance.data.iter().copied()).collect(),
    };
    for i in inside(&both, |a, b| a == b || a.0 == b.0 && !is_thing(a.0)) {
        let (class, instance) = both.data[i];
        let thing = match class {
            Class::Building => Thing::Building(InstanceId(instance)),
            _ if is_thing(class) => Thing::Individual(InstanceId(instance)),
            _ => Thing::Class(class),
        };
        if !matches!(class, Class::Void | Class::Sky) {
            pixels.entry(thing).or_default().push(i);
        }
        // What is seen little of is painted as its class.
        if class == Class::Building {
            pixels.entry(Thing::Class(class)).or_default().push(i);
        }
    }
    for (thing, pixels) in &mut pixels {
        if matches!(thing, Thing::Class(Class::Tree | Class::Bush)) {
            pixels.retain(|&i| is_green(pair.photograph.data[i]));
        }
    }
    pixels.retain(|_, pixels| pixels.len() >= LEAST_PX);
    pixels.into_iter().map(|(thing, pixels)| (thing, trimmed(pair.photograph, pixels))).collect()
}

/// Whether something may be leaves; beside them walls and the sky are seen.
fn is_green([red, green, blue]: [u8; 3]) -> bool {
    green > red && green > blue
}

/// Whether each of a class has a colour of its own.
fn is_thing(class: Class) -> bool {
    use Class::{Building, Bus, Car, Human, Jeep, Truck, Van};
    matches!(class, Building | Car | Jeep | Van | Truck | Bus | Human)
}

/// Pixels whose four neighbours are alike.
fn inside<T>(raster: &Raster<T>, alike: impl Fn(&T, &T) -> bool) -> Vec<usize> {
    let (width, height) = (raster.width as usize, raster.height as usize);
    let is_inside = |&i: &usize| {
        let (x, y) = (i % width, i / width);
        let is_edge = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
        !is_edge && [i - 1, i + 1, i - width, i + width].iter().all(|&j| alike(&raster.data[i], &raster.data[j]))
    };
    (0..raster.data.len()).filter(is_inside).collect()
}

/// Without what is darkest and brightest in the photograph.
fn trimmed(photograph: &Raster<[u8; 3]>, mut pixels: Vec<usize>) -> Vec<usize> {
    let light = |i: &usize| photograph.data[*i].iter().map(|&v| u32::from(v)).sum::<u32>();
    pixels.sort_by_key(|i| (light(i), *i));
    let away = (pixels.len() as f64 * TRIMMED) as usize;
    pixels[away..pixels.len() - away].to_vec()
}

/// Mean light to which a picture was exposed.
fn exposed(picture: &Raster<[u8; 3]>, contrast: f64, pixels: &[usize]) -> Vec3 {
    let film = ToneCurve::new(contrast);
    let sum: Vec3 = pixels.iter().map(|&i| Vec3::from(film.exposed_rgb(picture.data[i]))).sum();
    sum / pixels.len().max(1) as f32
}

/// Brightness of 8-bit sRGB, linear.
fn brightness(srgb: [u8; 3]) -> f32 {
    luminance(linear(srgb).into())
}

/// The contrast of film at which the light of the photographs' surfaces lies as far apart as that of the renders'. What a
/// single street has that its twin has not widens or narrows it; over all photographs that evens out.
fn contrast(pairs: &[Pair]) -> Option<f64> {
    let shown: Vec<[[[u8; 3]; 2]; 2]> = pairs
        .iter()
        .map(|pair| [pair.photograph, pair.render].map(|picture| dark_and_bright(picture, &pair.labels.class)))
        .collect();
    let stops = |shown: [[u8; 3]; 2], contrast: f64| {
        let film = ToneCurve::new(contrast);
        let [dark, bright] = shown.map(|rgb| f64::from(luminance(film.exposed_rgb(rgb).into()).max(DARK)));
        (bright / dark).log2()
    };
    let renders: f64 = pairs.iter().zip(&shown).map(|(pair, [_, render])| stops(*render, pair.contrast)).sum();
    // The steeper the film, the less light makes the same picture.
    let is_wider =
        |contrast: f64| shown.iter().map(|[photograph, _]| stops(*photograph, contrast)).sum::<f64>() > renders;
    let [mut low, mut high] = CONTRASTS;
    if renders < LEAST_STOPS * pairs.len() as f64 || !is_wider(low) || is_wider(high) {
        return None;
    }
    while high - low > 1e-4 {
        let middle = (low + high) / 2.0;
        *if is_wider(middle) { &mut low } else { &mut high } = middle;
    }
    Some(low)
}

/// A dark pixel and a bright one of the surfaces that a picture shows.
fn dark_and_bright(picture: &Raster<[u8; 3]>, class: &Raster<Class>) -> [[u8; 3]; 2] {
    let is_surface = |class: Class| !matches!(class, Class::Void | Class::Sky) && !is_thing(class);
    let surfaces = picture.data.iter().zip(&class.data).filter(|(_, class)| is_surface(**class));
    let mut surfaces: Vec<[u8; 3]> = surfaces.map(|(rgb, _)| *rgb).collect();
    surfaces.sort_by(|a, b| brightness(*a).total_cmp(&brightness(*b)));
    CONTRAST_BETWEEN.map(|share| surfaces.get((share * surfaces.len() as f64) as usize).copied().unwrap_or_default())
}

/// The weighted median; 0 of nothing.
fn median(mut values: Vec<(f32, f64)>) -> f32 {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = values.iter().map(|(_, w)| w).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    for (value, weight) in &values {
        sum += weight;
        if sum >= half {
            return *value;
        }
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Labels;

    const SIZE: u32 = 40;

    /// Road to the left, to the right a car whose id is 3, and grass in the lowest quarter.
    fn classes() -> Raster<Class> {
        Raster::from_fn(SIZE, SIZE, |x, y| match (x, y) {
            (_, 30..) => Class::Ground,
            (..20, _) => Class::Road,
            _ => Class::Car,
        })
    }

    fn labels() -> Labels {
        let grey = |v: f32| Raster::from_fn(SIZE, SIZE, |_, _| v);
        let none = || Raster::from_fn(SIZE, SIZE, |_, _| [0.0; 2]);
        let seen = || Raster::from_fn(SIZE, SIZE, |_, _| trove_model::Occlusion::Seen);
        Labels {
            class: classes(),
            instance: classes().map(|class| if *class == Class::Car { 3 } else { 0 }),
            depth_m: grey(1.0),
            normal: Raster::from_fn(SIZE, SIZE, |_, _| [0.0; 3]),
            flow_forward: none(),
            flow_backward: none(),
            occluded_forward: seen(),
            occluded_backward: seen(),
            extra: trove_model::ExtraLabels::default(),
            objects: Vec::new(),
        }
    }

    /// A picture by the light of road and car, exposed by a factor, on film of a contrast.
    fn on_film(road: [f32; 3], car: [f32; 3], gain: f32, contrast: f64) -> Raster<[u8; 3]> {
        classes().map(|class| {
            let light = match class {
                Class::Ground => [0.02; 3],
                Class::Road => road,
                _ => car,
            };
            ToneCurve::new(contrast).srgb(light.map(|c| gain * c))
        })
    }

    fn picture(road: [f32; 3], car: [f32; 3]) -> Raster<[u8; 3]> {
        on_film(road, car, 1.0, 1.0)
    }

    fn near(found: Vec3, expected: [f32; 3]) -> bool {
        (found / Vec3::from(expected)).map(f32::ln).abs().max_element() < 0.06
    }

    #[test]
    fn exposures_are_the_cameras_and_paint_is_the_vehicle_s() {
        let (labels, render) = (labels(), picture([0.2; 3], [0.3; 3]));
        // The second camera exposes a stop more; the car is red in both.
        let dim = picture([0.2; 3], [0.4, 0.05, 0.05]);
        let bright = on_film([0.2; 3], [0.4, 0.05, 0.05], 2.0, 1.0);
        let pair = |camera, photograph| Pair { camera, photograph, render: &render, contrast: 1.0, labels: &labels };
        let pairs = [pair("a", &dim), pair("b", &bright)];
        let found = looks(&pairs);
        let apart = found.exposure_ev["b"] - found.exposure_ev["a"];
        assert!((apart - 1.0).abs() < 0.05, "{found:?}");
        let seen = |thing: Vec3, camera: &str| thing * found.exposure_ev[camera].exp2() as f32;
        assert!(near(seen(found.classes[&Class::Road], "b"), [2.0; 3]), "{found:?}");
        assert!(near(seen(found.things[&InstanceId(3)], "a"), [1.33, 0.167, 0.167]), "{found:?}");
        let distances = distances(&pairs);
        assert!(distances[&Class::Road] > 5.0 && distances[&Class::Car] > 40.0, "{distances:?}");
        let alike = [pair("a", &render), pair("b", &render)];
        assert!(super::distances(&alike).values().all(|d| *d == 0.0));
        assert!(near(looks(&alike).things[&InstanceId(3)], [1.0; 3]));
    }

    #[test]
    fn what_one_photograph_alone_shows_changes_no_surface_and_a_surface_keeps_its_hue() {
        let (labels, render) = (labels(), picture([0.2; 3], [0.3; 3]));
        let [alike, other] = [picture([0.2; 3], [0.3; 3]), picture([0.02, 0.3, 0.02], [0.3; 3])];
        let pair = |camera, photograph| Pair { camera, photograph, render: &render, contrast: 1.0, labels: &labels };
        let pairs = [pair("a", &alike), pair("b", &alike), pair("c", &other)];
        assert!(near(looks(&pairs).classes[&Class::Road], [1.0; 3]), "{:?}", looks(&pairs));
        let only = looks(&[pair("c", &other)]);
        let [red, green] = [only.classes[&Class::Road].x, only.classes[&Class::Road].y];
        assert!(green / red < 1.3, "{only:?}");
    }
    #[test]
    fn contrast_is_the_film_s_and_changes_no_colour() {
        let labels = labels();
        let found = |photograph: &_, render: &_, contrast| {
            looks(&[Pair { camera: "a", photograph, render, contrast, labels: &labels }])
        };
        let (road, car) = ([0.2; 3], [0.4, 0.1, 0.1]);
        // The photograph is exposed by half a stop more.
        let brighter = std::f32::consts::SQRT_2;
        for (of_render, of_photograph) in [(1.4, 0.9), (0.9, 1.4), (1.4, 1.4)] {
            let render = on_film(road, car, 1.0, of_render);
            let found = found(&on_film(road, car, brighter, of_photograph), &render, of_render);
            assert!((found.contrast.unwrap() / of_photograph - 1.0).abs() < 0.05, "{found:?}");
            let gain = found.exposure_ev["a"].exp2() as f32;
            for colour in [found.classes[&Class::Road], found.things[&InstanceId(3)]] {
                assert!(near(gain * colour, [brighter; 3]), "{found:?}");
            }
        }
        let even = Raster::filled(SIZE, SIZE, [90; 3]);
        assert_eq!((found(&even, &even, 1.0).contrast, looks(&[]).contrast), (None, None));
    }
}
