//! What a sensor's rays bring back: the first surface of each.

use rayon::prelude::*;
use trove_model::{Points, Return, Sensor, SensorRay, luminance};

use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::Carrier;
use crate::sight::{self, Seen};

/// Computed with the current thread pool; every return depends on its ray and its packet alone.
pub(crate) fn scan(scene: &PreparedScene, sensor: &dyn Sensor) -> Points {
    let carrier = Carrier::new(scene, sensor.carrier());
    let n = sensor.ray_count();
    let packet = |first: usize| {
        let rays: Vec<Option<SensorRay>> = (first..n.min(first + PACKET)).map(|i| sensor.ray(i)).collect();
        let sent: Vec<SensorRay> = rays.iter().flatten().copied().collect();
        let mut seen = sight::seen(scene, &carrier, &sent).into_iter();
        let back = |ray: &Option<SensorRay>| ray.and_then(|_| seen.next().flatten()).map(|seen| told(scene, &seen));
        rays.iter().map(back).collect::<Vec<_>>()
    };
    let packets: Vec<_> = (0..n).into_par_iter().step_by(PACKET).map(packet).collect();
    Points { returns: packets.into_iter().flatten().collect() }
}

fn told(scene: &PreparedScene, seen: &Seen) -> Return {
    let (surface, material) = scene.surface(&seen.hit, &seen.ray);
    Return {
        range_m: seen.range_m,
        class: scene.instances[seen.hit.instance as usize].class,
        instance: scene.placed(seen.hit.instance).id,
        normal: seen.normal,
        base_color_luminance: luminance(material.base_color(&surface)),
    }
}
