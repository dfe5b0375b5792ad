//! What weather and use leave on the surfaces of a place.

use glam::DVec2;
use trove_model::{Class, Drive, Fog, Material, Precipitation, Season};

use crate::assembly::{Actor, Assembly};

/// Weather services speak of fog below this visibility (WMO No. 8), metres.
const FOGGY_BELOW_M: f64 = 1000.0;

/// How weather has treated a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weather {
    /// 0 (just washed) to 1: how much of the dirt that materials carry is there.
    pub dirt: f64,
    /// 0 (dry) to 1 (after heavy rain), but for what is sheltered.
    pub wetness: f64,
    /// What time of the year plants show; `None`: winter where snow lies, else that of the light, which is the recording's
    /// unless it was chosen.
    pub season: Option<Season>,
    /// Fog above the lowest point of the driven path, whatever its own ground; `None`: clear air.
    pub fog: Option<Fog>,
    /// Rain or snow that falls; `None`: none does.
    pub falling: Option<Precipitation>,
    /// Where the wind blows to, World, metres a second.
    pub wind_mps: DVec2,
    /// Share of level surfaces in the open that snow covers, 0 to 1, but for roads, where wheels have left less of it.
    pub snow: f64,
    /// Whether people respond to it: dress for what falls and lies, and drive with their lights on. They do not where nothing
    /// but the weather is to differ.
    pub people_respond: bool,
}

impl Default for Weather {
    /// Dry, as dirty as streets are, in the season of the recording and in clear air.
    fn default() -> Self {
        Self {
            dirt: 1.0,
            wetness: 0.0,
            season: None,
            fog: None,
            falling: None,
            wind_mps: DVec2::ZERO,
            snow: 0.0,
            people_respond: true,
        }
    }
}

impl Weather {
    /// The season that is chosen: where snow lies it is winter.
    pub(crate) fn season(self) -> Option<Season> {
        self.season.or((self.snow > 0.0).then_some(Season::Winter))
    }

    /// Its fog over the ground of a drive.
    pub(crate) fn fog_over(self, drive: &Drive) -> Option<Fog> {
        let path_z = drive.keyframes.iter().map(|k| k.world_from_ego.translation.z);
        let ground_z_m = path_z.reduce(f64::min).unwrap_or(0.0);
        self.fog.map(|fog| Fog { ground_z_m, ..fog })
    }

    /// Whether vehicles are driven with their lights on by day: in fog, and while their wipers run.
    pub(crate) fn asks_for_lights(self) -> bool {
        let is_foggy = self.fog.is_some_and(|fog| fog.visibility_m < FOGGY_BELOW_M);
        self.people_respond && (is_foggy || self.falling.is_some())
    }

    /// Treats the materials of a place that has been put together, and of its road users.
    pub(crate) fn treat<'a>(self, assembly: &mut Assembly, actors: impl Iterator<Item = &'a Actor>) {
        let materials = &mut assembly.stock.materials;
        for material in materials.iter_mut() {
            // Taken apart whole, so that a new layer does not compile before somebody has said what weather does to it.
            let Material {
                dirt,
                // Below, by what the material lies on.
                wetness: _,
                // What things are made of outlasts weather.
                name: _,
                base_color: _,
                base_color_map: _,
                alpha_cutoff: _,
                roughness: _,
                metalness: _,
                orm_map: _,
                normal_map: _,
                height_map: _,
                height_m: _,
                ior: _,
                coat: _,
                flakes: _,
                sheen: _,
                subsurface: _,
                transmission: _,
                translucency: _,
                retroreflection: _,
                emission: _,
                emission_map: _,
                beam: _,
                uv_scale: _,
                mapping: _,
                tiling: _,
                role: _,
            } = material;
            *dirt *= self.dirt as f32;
        }
        let fixed = assembly.fixed.iter().map(|instance| (instance.class, &instance.materials));
        for (class, used) in fixed.chain(actors.map(|actor| (actor.class(), &actor.materials))) {
            let share = match class {
                // Grass and soil swallow much of it, leaves let it drip, and people have umbrellas and hoods.
                Class::Ground | Class::Tree | Class::Bush | Class::Human => 0.5,
                _ => 1.0,
            };
            for &index in used {
                materials[index].wetness = (share * self.wetness) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use trove_model::{Report, Scene};

    use super::*;
    use crate::testing;
    use crate::{BuildSettings, build};

    fn scene(weather: Weather) -> Scene {
        let settings = BuildSettings { weather, ..testing::settings() };
        let drive = testing::drive();
        build(&drive, None, &testing::library(), &settings, &Report::default()).unwrap().scene(&drive, 0)
    }

    #[test]
    fn rain_wets_the_road_and_its_users() {
        let wetness = |class: Class, weather: Weather| -> Vec<f32> {
            let scene = scene(weather);
            let of_class = scene.instances.iter().filter(|i| i.class == class);
            of_class.flat_map(|i| &i.materials).map(|&m| scene.materials[m].wetness).collect()
        };
        let wet = Weather { wetness: 0.7, ..Weather::default() };
        assert!(wetness(Class::Road, wet).iter().all(|&w| w == 0.7) && !wetness(Class::Road, wet).is_empty());
        assert!(wetness(Class::Car, wet).iter().all(|&w| w == 0.7) && !wetness(Class::Car, wet).is_empty());
        assert!(wetness(Class::Road, Weather::default()).iter().all(|&w| w == 0.0));
    }
}
