//! How fast a card's functions are, and whether they answer what they do on the processor.

use std::ffi::CStr;
use std::time::Instant;

use glam::Vec3;
use trove_model::Shot;
use trove_trace::path::Sample;
use trove_trace::{Asked, Hit, NONE};

use super::Card;
use super::follow::follow_here;
use super::memory::{BLOCK, Uploaded, UploadedWave};
use super::world::{flat, world};
use crate::PreparedScene;
use crate::accel::{Flat, Here, asked};
use crate::path::{ray_sorts, starts};
use crate::remote::RemoteWave;

/// The best of so many runs counts: the first ones warm the card up.
const RUNS: usize = 9;

/// What a function takes for all that it is asked.
#[derive(Clone, Debug)]
pub struct CardRate {
    /// Which rays.
    pub sort: &'static str,
    /// How many.
    pub asked: usize,
    /// How many of them meet something.
    pub met: usize,
    /// On the card, seconds; of paths, with sending where they start and receiving what they bring.
    pub card_s: f64,
    /// On one thread of the processor by the same functions, seconds.
    pub processor_s: f64,
    /// How many of the card's answers are others than the processor's, in any bit.
    pub differ: usize,
    /// Registers of a thread on the card, and bytes of its own memory.
    pub takes: [u32; 2],
    /// Threads that the card runs at the same time.
    pub at_once: u32,
}

/// Rates for the rays of one sample a pixel, and bytes of the scene on the card.
pub(crate) fn card_rates(scene: &PreparedScene, shot: &Shot, card: &Card) -> Result<(Vec<CardRate>, usize), String> {
    let shapes = flat(scene)?;
    let mut memory = Here::default();
    let Ok((here, _)) = shapes.scene(&mut memory);
    let uploaded = card.upload(&shapes, scene)?;
    let there = card.device.hold(&[uploaded.world])?;
    let nothing = Hit { t: f32::INFINITY, instance: NONE, triangle: NONE, u: 0.0, v: 0.0 };
    // SAFETY: the tables are as `Flat` makes them, and the memory lives on.
    let closest = |ray: &Asked| unsafe { here.closest(ray) }.unwrap_or(nothing);
    // SAFETY: as above.
    let blocked = |ray: &Asked| u32::from(unsafe { here.is_blocked(ray) });

    let mut rates = Vec::new();
    for (sort, rays, is_shadow) in ray_sorts(scene, shot) {
        let rays: Vec<Asked> = rays.iter().map(asked).collect();
        let among = there.address();
        rates.push(if is_shadow {
            let question = Question { sort, function: c"blocked", among, asked: &rays };
            question.rate(card, 2, blocked, |is| *is == 1, |is| [*is])?
        } else {
            let question = Question { sort, function: c"closest", among, asked: &rays };
            let bits = |hit: &Hit| [hit.t.to_bits(), hit.instance, hit.triangle, hit.u.to_bits(), hit.v.to_bits()];
            question.rate(card, Hit { instance: NONE - 1, ..nothing }, closest, |hit| hit.instance != NONE, bits)?
        });
    }
    rates.push(of_paths(scene, shot, card, (&shapes, &uploaded))?);
    Ok((rates, uploaded.bytes))
}

/// Whole paths, one a pixel, and what they bring.
fn of_paths(
    scene: &PreparedScene,
    shot: &Shot,
    card: &Card,
    (shapes, uploaded): (&Flat, &Uploaded),
) -> Result<CardRate, String> {
    let starts = starts(scene, shot);
    let mut memory = Here::default();
    let Ok(world) = world(scene, shapes, &mut memory);
    let mut there = UploadedWave::new(uploaded, None, starts.len())?;
    let (mut card_s, mut samples) = (f64::INFINITY, vec![Sample::default(); starts.len()]);
    for _ in 0..RUNS {
        card_s = card_s.min(card.device.timed(|| there.follow(&starts, &mut samples).map(drop))?);
    }
    let started = Instant::now();
    // SAFETY: the tables are as `world` makes them, and the memory lives on.
    let (here, _) = unsafe { follow_here(&world, &starts) };
    let processor_s = started.elapsed().as_secs_f64();
    let bits =
        |sample: &Sample| [sample.radiance, sample.albedo, sample.normal].map(|v| v.to_array().map(f32::to_bits));
    let function = card.device.function(c"ask")?;
    Ok(CardRate {
        sort: "paths",
        asked: starts.len(),
        met: here.iter().filter(|sample| sample.radiance != Vec3::ZERO).count(),
        card_s,
        processor_s,
        differ: samples.iter().zip(&here).filter(|(a, b)| bits(a) != bits(b)).count(),
        takes: function.takes()?,
        at_once: function.threads_at_once(BLOCK)? * card.device.multiprocessors,
    })
}

/// What one function is asked.
struct Question<'a, A> {
    sort: &'static str,
    function: &'static CStr,
    /// Where on the card the tables lie that it needs.
    among: u64,
    asked: &'a [A],
}

impl<A: Copy> Question<'_, A> {
    /// Answers on the card, where `unwritten` would be told from what has been written, and `here`.
    fn rate<B: Copy, const N: usize>(
        &self,
        card: &Card,
        unwritten: B,
        here: impl Fn(&A) -> B,
        met: impl Fn(&B) -> bool,
        bits: impl Fn(&B) -> [u32; N],
    ) -> Result<CardRate, String> {
        let &Self { sort, function, among, asked } = self;
        let function = card.device.function(function)?;
        let sent = card.device.hold(asked)?;
        let mut answers = vec![unwritten; asked.len()];
        let room = card.device.hold(&answers)?;
        let mut card_s = f64::INFINITY;
        for _ in 0..RUNS {
            let addresses = [among, sent.address(), room.address()];
            // SAFETY: the tables are what the function needs, and there are as many questions and places for answers as it
            // is told.
            let launch = || unsafe { function.launch(&addresses, &[asked.len() as u32], BLOCK) };
            card_s = card_s.min(card.device.timed(launch)?);
        }
        room.read(&mut answers)?;

        let started = Instant::now();
        let answers_here: Vec<B> = asked.iter().map(here).collect();
        let processor_s = started.elapsed().as_secs_f64();
        Ok(CardRate {
            sort,
            asked: asked.len(),
            met: answers_here.iter().filter(|answer| met(answer)).count(),
            card_s,
            processor_s,
            differ: answers.iter().zip(&answers_here).filter(|(a, b)| bits(a) != bits(b)).count(),
            takes: function.takes()?,
            at_once: function.threads_at_once(BLOCK)? * card.device.multiprocessors,
        })
    }
}
