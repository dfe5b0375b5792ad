//! How fast a card traces rays, and whether it finds what the processor finds.

use std::time::Instant;

use trove_model::Shot;
use trove_trace::{Asked, Hit, NONE};

use super::{BLOCK, Card};
use crate::PreparedScene;
use crate::accel::{Flat, Here, asked};
use crate::path::ray_sorts;

/// The best of so many runs counts: the first ones warm the card up.
const RUNS: usize = 9;

/// What tracing rays of one sort takes.
#[derive(Clone, Debug)]
pub struct CardRate {
    /// Which rays.
    pub sort: &'static str,
    /// How many.
    pub rays: usize,
    /// How many of them meet something.
    pub met: usize,
    /// On the card, seconds.
    pub card_s: f64,
    /// On one thread of the processor by the same functions, seconds.
    pub processor_s: f64,
    /// How many of the card's answers are others than the processor's, in any bit.
    pub differ: usize,
    /// How many of those name another triangle.
    pub elsewhere: usize,
    /// Registers of a thread on the card, and bytes of its own memory.
    pub takes: [u32; 2],
    /// Threads that the card runs at the same time.
    pub at_once: u32,
    /// Bytes of the scene on the card.
    pub scene_bytes: usize,
}

/// Traces the rays of one sample a pixel on a card and on the processor.
pub(crate) fn card_rates(scene: &PreparedScene, shot: &Shot, card: &Card) -> Result<Vec<CardRate>, String> {
    let flat = Flat::new(&scene.shapes).ok_or("nothing is in the scene")?;
    let mut memory = Here::default();
    let Ok(here) = flat.scene(&mut memory);
    let uploaded = card.upload(&flat)?;
    let scene_bytes = uploaded.bytes();
    let mut rates = Vec::new();
    for (sort, rays, is_shadow) in ray_sorts(scene, shot) {
        let asked: Vec<Asked> = rays.iter().map(asked).collect();
        let function = card.device.function(if is_shadow { c"blocked" } else { c"closest" })?;
        let sent = card.device.hold(&asked)?;
        let nothing = Hit { t: f32::INFINITY, instance: NONE, triangle: NONE, u: 0.0, v: 0.0 };
        // What was not written would be told from what has been.
        let mut hits = vec![Hit { instance: NONE - 1, ..nothing }; asked.len()];
        let mut blocked = vec![2u32; asked.len()];
        let (room, flags) = (card.device.hold(&hits)?, card.device.hold(&blocked)?);
        let answers = if is_shadow { flags.address() } else { room.address() };
        let addresses = [uploaded.scene.address(), sent.address(), answers];
        let mut card_s = f64::INFINITY;
        for _ in 0..RUNS {
            // SAFETY: the tables are as `Flat` makes them, there are as many rays and places for answers as it is told.
            card_s = card_s.min(unsafe { function.run(addresses, asked.len() as u32, BLOCK)? });
        }
        room.read(&mut hits)?;
        flags.read(&mut blocked)?;

        let started = Instant::now();
        // SAFETY: the tables are as `Flat` makes them, and the memory lives on.
        let (hits_here, blocked_here): (Vec<Hit>, Vec<u32>) = unsafe {
            if is_shadow {
                (Vec::new(), asked.iter().map(|ray| u32::from(here.is_blocked(ray))).collect())
            } else {
                (asked.iter().map(|ray| here.closest(ray).unwrap_or(nothing)).collect(), Vec::new())
            }
        };
        let processor_s = started.elapsed().as_secs_f64();
        let bits = |hit: &Hit| [hit.t.to_bits(), hit.instance, hit.triangle, hit.u.to_bits(), hit.v.to_bits()];
        let pairs = || hits.iter().zip(&hits_here);
        let others = blocked.iter().zip(&blocked_here).filter(|(a, b)| a != b).count();
        rates.push(CardRate {
            sort,
            rays: asked.len(),
            met: hits_here.iter().filter(|hit| hit.instance != NONE).count()
                + blocked_here.iter().sum::<u32>() as usize,
            card_s,
            processor_s,
            differ: others + pairs().filter(|(a, b)| bits(a) != bits(b)).count(),
            elsewhere: others + pairs().filter(|(a, b)| (a.instance, a.triangle) != (b.instance, b.triangle)).count(),
            takes: function.takes()?,
            at_once: function.threads_at_once(BLOCK)? * card.device.multiprocessors,
            scene_bytes,
        });
    }
    Ok(rates)
}
