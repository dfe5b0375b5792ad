//! How fast a card's functions are, and whether they answer what they do on the processor.

use std::ffi::CStr;
use std::time::Instant;

use glam::Vec3;
use trove_model::Shot;
use trove_trace::{Asked, Hit, NONE, Scattered, Vertex};

use super::{BLOCK, Card};
use crate::PreparedScene;
use crate::accel::{Flat, Here, asked};
use crate::material::flat;
use crate::path::{ray_sorts, vertices};

/// The best of so many runs counts: the first ones warm the card up.
const RUNS: usize = 9;

/// What a function takes for all that it is asked.
#[derive(Clone, Debug)]
pub struct CardRate {
    /// Rays of which sort, or what else.
    pub sort: &'static str,
    /// How many.
    pub asked: usize,
    /// How many of the rays meet something, or vertices scatter light on.
    pub met: usize,
    /// On the card, seconds.
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

/// Rates for the rays of one sample a pixel and what they meet, and bytes of the scene on the card.
pub(crate) fn card_rates(scene: &PreparedScene, shot: &Shot, card: &Card) -> Result<(Vec<CardRate>, usize), String> {
    let shapes = Flat::new(&scene.shapes).ok_or("nothing is in the scene")?;
    let mut memory = Here::default();
    let (Ok(here), Ok(materials)) = (shapes.scene(&mut memory), flat(&scene.materials, &mut memory));
    let uploaded = card.upload(&shapes, &scene.materials)?;
    let nothing = Hit { t: f32::INFINITY, instance: NONE, triangle: NONE, u: 0.0, v: 0.0 };
    // SAFETY: the tables are as `Flat` makes them, and the memory lives on.
    let closest = |ray: &Asked| unsafe { here.closest(ray) }.unwrap_or(nothing);
    // SAFETY: as above.
    let blocked = |ray: &Asked| u32::from(unsafe { here.is_blocked(ray) });

    let mut rates = Vec::new();
    for (sort, rays, is_shadow) in ray_sorts(scene, shot) {
        let rays: Vec<Asked> = rays.iter().map(asked).collect();
        let among = uploaded.scene.address();
        rates.push(if is_shadow {
            let question = Question { sort, function: c"blocked", among, asked: &rays };
            question.rate(card, 2, blocked, |is| *is == 1, |is| [*is])?
        } else {
            let question = Question { sort, function: c"closest", among, asked: &rays };
            let bits = |hit: &Hit| [hit.t.to_bits(), hit.instance, hit.triangle, hit.u.to_bits(), hit.v.to_bits()];
            question.rate(card, Hit { instance: NONE - 1, ..nothing }, closest, |hit| hit.instance != NONE, bits)?
        });
    }
    let vertices = vertices(scene, shot);
    let (sort, among) = ("vertices", uploaded.materials.address());
    let question = Question { sort, function: c"scatter", among, asked: &vertices };
    // SAFETY: the tables are as `flat` makes them, and the memory lives on.
    let scatter = |vertex: &Vertex| unsafe { materials.scatter(vertex) };
    let unwritten = Scattered { light_pdf: f32::NAN, ..Scattered::default() };
    rates.push(question.rate(card, unwritten, scatter, |on| on.wi != Vec3::ZERO, bits_of)?);
    Ok((rates, uploaded.bytes()))
}

fn bits_of(on: &Scattered) -> [u32; 15] {
    let Scattered { light, light_pdf, wi, pdf, weight, spread_rad, albedo } = on;
    let [[a, b, c], [d, e, f], [g, h, i], [j, k, l]] = [light, wi, weight, albedo].map(Vec3::to_array);
    [a, b, c, d, e, f, g, h, i, j, k, l, *light_pdf, *pdf, *spread_rad].map(f32::to_bits)
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
            card_s = card_s.min(unsafe { function.run(addresses, asked.len() as u32, BLOCK)? });
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
