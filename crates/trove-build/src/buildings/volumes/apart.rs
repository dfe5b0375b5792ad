//! Buildings and parts that overlap: the higher one stands, the others are cut around and below it.

use rayon::prelude::*;
use trove_model::{Bounds, Outcome, Polygon, Report, RoofShape};

use super::house::{House, LEAST_M2, Volume, name};
use crate::geometry::near::Near;
use crate::geometry::plane::{difference, intersection};

/// Overlaps that reach no deeper are left: walls that touch are told apart later, metres.
const DEEP_M: f64 = 0.05;
/// What is left of a volume is at least this wide on average, and this high, metres.
const NARROWEST_M: f64 = 0.5;
const LOWEST_M: f64 = 0.4;
/// Between one volume and another on top of it, metres.
const GAP_M: f64 = 0.01;

/// Cuts volumes that overlap in space, so that none is inside another.
pub(super) fn apart(houses: &mut [House<'_>], report: &Report) {
    let all: Vec<(usize, &Volume<'_>, f64)> = houses
        .iter()
        .enumerate()
        .flat_map(|(h, house)| house.volumes.iter().map(move |v| (h, v, house.floor_m)))
        .collect();
    let boxes: Vec<Option<Bounds>> = all.iter().map(|(_, v, _)| v.footprint.bounds()).collect();
    let near = Near::new(boxes.iter().copied());
    // The higher one comes first, then the earlier one.
    let before = |i: usize, j: usize| {
        let top_m = |k: usize| all[k].1.top_m + all[k].2;
        top_m(i).total_cmp(&top_m(j)).reverse().then(i.cmp(&j)).is_lt()
    };
    let mut cut: Vec<Option<Vec<Volume<'_>>>> = (0..all.len())
        .into_par_iter()
        .map(|i| {
            let (house, volume, floor_m) = all[i];
            let winners = near.at(boxes[i]?).filter(|&j| j != i && before(j, i) && overlap(volume, all[j].1));
            let mut left = vec![volume.clone()];
            let mut is_cut = false;
            for j in winners {
                let (other_house, other, other_floor_m) = all[j];
                let bottom_m = other.bottom_m + other_floor_m - floor_m;
                // Canopies over low houses, bridges over streets: one above the other.
                let is_beside = bottom_m > volume.top_m + LOWEST_M;
                if is_beside || intersection_m2(volume, other) < DEEP_M * DEEP_M {
                    continue;
                }
                is_cut = true;
                left = left.into_iter().flat_map(|v| around_and_below(v, other, bottom_m)).collect();
                if other_house != house {
                    let what = "building cut where it overlaps another";
                    report.note(Outcome::Substituted, what, name(volume.building));
                }
            }
            if is_cut && left.is_empty() {
                report.note(Outcome::Dropped, "building or part inside another", name(volume.building));
            }
            is_cut.then_some(left)
        })
        .collect();
    let mut next = 0;
    let mut new: Vec<Vec<Volume<'_>>> = Vec::with_capacity(houses.len());
    for house in houses.iter() {
        let mut volumes = Vec::new();
        for volume in &house.volumes {
            match cut[next].take() {
                Some(pieces) => volumes.extend(pieces),
                None => volumes.push(volume.clone()),
            }
            next += 1;
        }
        new.push(volumes);
    }
    for (house, volumes) in houses.iter_mut().zip(new) {
        house.volumes = volumes;
    }
}

fn intersection_m2(a: &Volume<'_>, b: &Volume<'_>) -> f64 {
    let shared = intersection(std::slice::from_ref(&a.footprint), std::slice::from_ref(&b.footprint));
    shared.iter().map(Polygon::area_m2).sum()
}

/// Whether no edge of either tells two footprints apart: cheap, and right for most neighbours.
fn overlap(a: &Volume<'_>, b: &Volume<'_>) -> bool {
    let parts = |a: &Polygon, b: &Polygon| {
        let ring = &a.exterior;
        (0..ring.len()).any(|i| {
            let (p, q) = (ring[i], ring[(i + 1) % ring.len()]);
            let inward = (q - p).normalize_or_zero().perp();
            b.exterior.iter().all(|&r| (r - p).dot(inward) < DEEP_M)
        })
    };
    !parts(&a.footprint, &b.footprint) && !parts(&b.footprint, &a.footprint)
}

/// What another volume, which starts at `bottom_m`, leaves of a volume.
fn around_and_below<'a>(volume: Volume<'a>, other: &Volume<'_>, bottom_m: f64) -> Vec<Volume<'a>> {
    let whole = std::slice::from_ref(&volume.footprint);
    let taken = std::slice::from_ref(&other.footprint);
    let is_wide = |p: &Polygon| {
        let around_m: f64 = p.edges().map(|(a, b)| a.distance(b)).sum();
        p.area_m2() >= LEAST_M2.min(0.5 * volume.footprint.area_m2()) && 2.0 * p.area_m2() > NARROWEST_M * around_m
    };
    let mut left: Vec<Volume<'a>> = Vec::new();
    for footprint in difference(whole, taken).into_iter().filter(is_wide) {
        left.push(Volume { footprint, ..volume.clone() });
    }
    let top_m = volume.top_m.min(bottom_m - GAP_M);
    if top_m > volume.bottom_m + LOWEST_M {
        for footprint in intersection(whole, taken).into_iter().filter(is_wide) {
            let below = Volume { eaves_m: top_m, top_m, roof: RoofShape::Flat, is_built_on: true, ..volume.clone() };
            left.push(Volume { footprint, ..below });
        }
    }
    left
}
