//! One variation of a scene: its seeds, and what was drawn for it.

use std::path::PathBuf;

use anyhow::Result;
use trove_build::{BuildSettings, LightChoice, Moment, Seeds, Site, SkyChoice, Traffic, ViewSettings, Weather};
use trove_format::{Factors, LightFactor};
use trove_model::{
    Drive, Environment, Fog, Form, Locale, MapProjection, Precipitation, Provenance, Random, Report, Season, Seed,
};
use trove_read::locale;

use crate::recipe::{Factor, Range, Recipe, covered_by, rain, snowfall, wet_by};
use crate::sources::Sources;

const HOUR_NS: f64 = 3.6e12;
const DAY_NS: i64 = 86_400_000_000_000;

/// What one variation of a scene differs in.
pub(crate) struct Variation {
    number: u32,
    seeds: Seeds,
    /// Latitude and longitude of the place whose customs, climate and sun it has, degrees.
    place: [f64; 2],
    locale: Locale,
    borders: Option<Provenance>,
    season: Option<Season>,
    wetness: f64,
    fog: Option<Fog>,
    falling: Option<Precipitation>,
    snow: f64,
    traffic: Traffic,
    light: Light,
    /// Added to the recipe's exposure, stops.
    exposure_ev: f64,
    lift_m: f64,
    pitch_deg: f64,
    other_vehicles: usize,
}

/// Where the light comes from.
enum Light {
    /// The recipe's picture of a sky.
    Recipe,
    /// Another one, turned counter-clockwise by so many degrees.
    Picture(PathBuf, f64),
    Sky(SkyChoice),
}

impl Light {
    /// Rain and snow fall from an overcast sky, unless somebody says how clouded it is.
    fn under(self, falling: Option<Precipitation>, recipe: &Recipe) -> Self {
        let is_told = recipe.light.clouds.or(recipe.variations.light.clouds.map(|[least, _]| least)).is_some();
        match self {
            Self::Sky(sky) if falling.is_some() && !is_told => Self::Sky(SkyChoice { clouds: Some(1.0), ..sky }),
            other => other,
        }
    }
}

impl Variation {
    /// Draws a variation of a scene; each factor that differs has a seed of its own, by its name and the variation's
    /// number, and one that does not has that of variation 0.
    pub(crate) fn draw(sources: &Sources, drive: &Drive, number: u32, report: &Report) -> Result<Self> {
        let recipe = sources.recipe();
        let section = &recipe.variations;
        let base = Seed(recipe.seed).child(&drive.id);
        let seed = |factor: Factor| base.nth(if section.varies(factor) { number.into() } else { 0 });
        let is_drawn = |factor: Factor| section.varies(factor) && (number > 0 || !section.first_as_recorded);
        let random = |factor: Factor| is_drawn(factor).then(|| seed(factor).child(factor.name()).random());

        let MapProjection { origin_lat_deg, origin_lon_deg, .. } = drive.projection;
        let recorded = sources.locale(origin_lat_deg, origin_lon_deg, report);
        let elsewhere = section
            .places
            .iter()
            .flatten()
            .map(|&[lat_deg, lon_deg]| ([lat_deg, lon_deg], sources.locale_elsewhere(lat_deg, lon_deg, report)));
        let same_side = |(_, locale): &([f64; 2], Locale)| locale.driving_side == recorded.driving_side;
        let places: Vec<([f64; 2], Locale)> = elsewhere.filter(same_side).collect();
        let drawn = random(Factor::Place).and_then(|mut random| random.pick(&places).cloned());
        let borders = if drawn.is_some() { Some(locale::provenance()) } else { sources.borders() };
        let (place, locale) = drawn.unwrap_or(([origin_lat_deg, origin_lon_deg], recorded));
        let weather = recipe.weather.weather();
        let season = random(Factor::Season).and_then(|mut random| random.pick(&section.seasons()).copied());
        let wetness = random(Factor::Wetness).map(|mut random| {
            let is_dry = random.chance(section.dry_share);
            if is_dry { 0.0 } else { within(section.wetness(), &mut random) }
        });
        let fog = random(Factor::Fog).map(|mut random| {
            let is_there = random.chance(section.fog_share);
            let visibility_m = within(section.visibility_m().map(f64::ln), &mut random).exp();
            is_there.then(|| recipe.weather.fog(visibility_m))
        });
        let falls = |factor: Factor, share: f64, range_mm_h: Range| {
            random(factor).map(|mut random| {
                let is_there = random.chance(share);
                let rate_mm_h = within(range_mm_h.map(f64::ln), &mut random).exp();
                is_there.then_some(rate_mm_h)
            })
        };
        let rains = falls(Factor::Rain, section.rain_share, section.rain_mm_h());
        let snows = falls(Factor::Snowfall, section.snowfall_share, section.snowfall_mm_h());
        // Where both are drawn, it snows.
        let drawn = rains.or(snows).map(|_| snows.flatten().map(snowfall).or(rains.flatten().map(rain)));
        let falling = drawn.unwrap_or(weather.falling);
        let snow = random(Factor::Snow).map(|mut random| {
            let is_there = random.chance(section.snow_share);
            let cover = within(section.snow(), &mut random);
            if is_there { cover } else { 0.0 }
        });
        let snow = falling.map_or(0.0, covered_by).max(snow.unwrap_or(weather.snow));
        let traffic = random(Factor::Traffic)
            .map(|mut random| Traffic { density: within(section.traffic(), &mut random), cyclists: section.cyclists });
        let exposure_ev = random(Factor::Exposure).map(|mut random| within(section.exposure_ev(), &mut random));
        let [lift_m, pitch_deg] =
            random(Factor::Camera).map_or([0.0; 2], |mut random| section.camera().map(|r| within(r, &mut random)));
        let other_vehicles = random(Factor::Rigs).zip(section.other_vehicles);
        Ok(Self {
            number,
            seeds: Seeds {
                place: base.nth(0),
                assets: seed(Factor::Assets),
                paint: seed(Factor::Paint),
                people: seed(Factor::People),
                facades: seed(Factor::Facades),
                materials: seed(Factor::Materials),
                furniture: seed(Factor::Furniture),
                vegetation: seed(Factor::Vegetation),
                traffic: seed(Factor::Traffic),
                light: seed(Factor::Light),
                rigs: seed(Factor::Rigs),
                noise: base.nth(if section.counterfactual.is_some() { 0 } else { number.into() }),
            },
            place,
            locale,
            borders,
            season: season.map_or(weather.season, Into::into),
            wetness: wet_by(falling, snow).max(wetness.unwrap_or(weather.wetness)),
            fog: fog.unwrap_or(weather.fog),
            falling,
            snow,
            traffic: traffic.unwrap_or_default(),
            light: light(recipe, drive, place[1], random(Factor::Light))?.under(falling, recipe),
            exposure_ev: exposure_ev.unwrap_or(0.0),
            lift_m,
            pitch_deg,
            other_vehicles: other_vehicles
                .map_or(recipe.views.other_vehicles, |(mut random, [few, many])| few + random.index(many - few + 1)),
        })
    }

    /// Where it is built as if it were there; distances stay.
    pub(crate) fn projection(&self, recorded: MapProjection) -> MapProjection {
        let [origin_lat_deg, origin_lon_deg] = self.place;
        MapProjection { origin_lat_deg, origin_lon_deg, ..recorded }
    }

    /// How its place is built.
    pub(crate) fn build_settings(&self, recipe: &Recipe, sources: &Sources) -> Result<BuildSettings> {
        let light = match &self.light {
            Light::Recipe => LightChoice::Map(sources.environment()?),
            Light::Picture(file, rotation_deg) => LightChoice::Map(sources.picture(file, *rotation_deg)?),
            Light::Sky(sky) => LightChoice::Sky(*sky),
        };
        Ok(BuildSettings {
            seeds: self.seeds,
            top_k: recipe.assets.top_k,
            traffic: self.traffic,
            light,
            weather: Weather {
                season: self.season,
                wetness: self.wetness,
                fog: self.fog,
                falling: self.falling,
                snow: self.snow,
                // Its pictures show the same people, who do the same.
                people_respond: recipe.variations.counterfactual.is_none(),
                ..recipe.weather.weather()
            },
            on_disagreement: recipe.map.on_disagreement.into(),
            invent: recipe.map.invent,
            locale: self.locale.clone(),
            borders: self.borders.clone(),
        })
    }

    /// Changes the recipe's views into its own.
    pub(crate) fn change(&self, views: &mut ViewSettings) {
        views.other_vehicles = self.other_vehicles;
        views.lift_m = self.lift_m;
        views.pitch_rad = self.pitch_deg.to_radians();
        views.film.exposure.brighten(self.exposure_ev);
    }

    /// Its row in the manifest: of a factor without a quantity the variation that its seed is of, of others what was
    /// drawn, or what stands in the recipe or the recording.
    pub(crate) fn factors(&self, recipe: &Recipe, site: &Site) -> Factors {
        let number = |factor: Factor| if recipe.variations.varies(factor) { self.number } else { 0 };
        Factors {
            assets: number(Factor::Assets),
            paint: number(Factor::Paint),
            people: number(Factor::People),
            facades: number(Factor::Facades),
            materials: number(Factor::Materials),
            furniture: number(Factor::Furniture),
            vegetation: number(Factor::Vegetation),
            place: self.place,
            season: site.season(),
            light: self.light_factor(recipe, site),
            traffic: self.traffic.density,
            wetness: self.wetness,
            visibility_m: self.fog.map(|fog| fog.visibility_m),
            rain_mm_h: self.falls(Form::Rain),
            snowfall_mm_h: self.falls(Form::Snow),
            snow: (self.snow > 0.0).then_some(self.snow),
            exposure_ev: self.exposure_ev,
            camera_height_m: self.lift_m,
            camera_pitch_deg: self.pitch_deg,
            other_vehicles: self.other_vehicles as u32,
        }
    }

    /// Millimetres an hour of what falls, where it is of a form.
    fn falls(&self, form: Form) -> Option<f64> {
        self.falling.filter(|falling| falling.form == form).map(|falling| falling.rate_mm_h)
    }

    fn light_factor(&self, recipe: &Recipe, site: &Site) -> LightFactor {
        match (&self.light, &site.light().environment) {
            (_, Environment::Sky(sky)) => LightFactor::Sky {
                environment: crate::recipe::COMPUTED_SKY.into(),
                sun_elevation_deg: sky.to_sun.z.clamp(-1.0, 1.0).asin().to_degrees(),
                sun_azimuth_deg: sky.to_sun.x.atan2(sky.to_sun.y).to_degrees().rem_euclid(360.0),
                turbidity: sky.turbidity,
                clouds: sky.cloud_cover,
            },
            (Light::Picture(file, rotation_deg), _) => {
                LightFactor::Picture { environment: file.to_string_lossy().into_owned(), rotation_deg: *rotation_deg }
            }
            _ => LightFactor::Picture {
                environment: recipe.light.environment.clone(),
                rotation_deg: recipe.light.rotation_deg,
            },
        }
    }
}

/// The light of a variation at a longitude; without a `random` it is the recipe's own.
fn light(recipe: &Recipe, drive: &Drive, lon_deg: f64, random: Option<Random>) -> Result<Light> {
    let of_recipe = |is_drawn: bool| match recipe.environment_file() {
        Some(_) => Ok(Light::Recipe),
        None => Ok(Light::Sky(recipe.light.sky(is_drawn)?)),
    };
    let Some(mut random) = random else { return of_recipe(false) };
    let varied = &recipe.variations.light;
    let environments: Vec<Option<PathBuf>> = varied.environments().collect();
    let mut sky = match random.pick(&environments) {
        Some(Some(file)) => return Ok(Light::Picture(file.clone(), random.range(0.0, 360.0))),
        Some(None) => recipe.light.sky(true)?,
        None => match of_recipe(true)? {
            Light::Sky(sky) => sky,
            other => return Ok(other),
        },
    };
    // All are drawn, so that a range that is given or left out changes nothing else.
    let [hour, clouds, turbidity] = [varied.hours, varied.clouds, varied.turbidity]
        .map(|range| (range.is_some(), within(range.unwrap_or([0.0, 1.0]), &mut random)));
    if hour.0 {
        let base_ns = recipe.light.time_ns()?.or(drive.keyframes.first().map(|k| k.time_ns)).unwrap_or_default();
        sky.moment = Moment::At(at_hour(base_ns, lon_deg, hour.1));
    }
    // At a time that is told the weather would be fair.
    if clouds.0 || (hour.0 && sky.clouds.is_none()) {
        sky.clouds = Some(clouds.1);
    }
    if turbidity.0 {
        sky.turbidity = Some(turbidity.1);
    }
    Ok(Light::Sky(sky))
}

/// The time on the same day by the sun at which it is some hour by the sun, nanoseconds since 1970 UTC.
fn at_hour(time_ns: i64, lon_deg: f64, hour: f64) -> i64 {
    let ahead_ns = (lon_deg / 15.0 * HOUR_NS) as i64;
    let midnight_ns = (time_ns + ahead_ns).div_euclid(DAY_NS) * DAY_NS - ahead_ns;
    midnight_ns + (hour * HOUR_NS) as i64
}

fn within([low, high]: Range, random: &mut Random) -> f64 {
    low + (high - low) * random.unit()
}
