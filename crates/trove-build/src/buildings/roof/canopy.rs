//! Roofs on posts: carports, petrol stations, shelters.

use glam::DVec2;
use trove_model::{Random, Report};

use super::roof;
use crate::buildings::shell::{Shell, Slot};
use crate::buildings::volumes::{House, Volume};

/// Thickness of a post, and how far it reaches into the ground and the slab, metres.
const POST_M: f64 = 0.22;
const POST_FOOT_M: f64 = 0.5;
const POST_HEAD_M: f64 = 0.05;

/// A slab under its roof, and the posts that carry it.
pub(in crate::buildings) fn canopy(
    shell: &mut Shell,
    volume: &Volume<'_>,
    house: &House<'_>,
    random: &mut Random,
    report: &Report,
) {
    let top = roof(shell, volume, house, random, report);
    let bottom = house.floor_m + volume.bottom_m;
    for (a, b) in volume.footprint.edges() {
        shell.slope(Slot::Boards, &[a.extend(bottom), b.extend(bottom), b.extend(top), a.extend(top)]);
    }
    shell.cover(Slot::Boards, std::slice::from_ref(&volume.footprint), |_| bottom, false);
    for &foot in &volume.posts {
        let low = house.floor_m - POST_FOOT_M;
        let size_m = DVec2::splat(POST_M).extend(bottom + POST_HEAD_M - low);
        shell.block(Slot::Metal, foot.extend(low), DVec2::X, size_m);
    }
}
