//! The colours in which labels are shown.

use trove_model::Class;

/// Depth at which the colours end, metres; they fall off with the logarithm.
const FAR_M: f32 = 120.0;

/// The colour of a class in its table; black for an id that no class has.
pub fn of_class(id: u8) -> [u8; 3] {
    Class::from_id(id).map_or([0; 3], |class| class.row().rgb)
}

/// Bright colours that differ between neighbouring ids: the hue goes round by the golden angle.
pub fn of_instance(id: u16) -> [u8; 3] {
    if id == 0 {
        return [18, 18, 20];
    }
    let hue = (f32::from(id) * 0.618_034).fract() * 6.0;
    let value = [1.0, 0.8, 0.62][usize::from(id % 3)];
    tents(hue).map(|full| (255.0 * value * (0.2 + 0.8 * full)) as u8)
}

/// Yellow near, violet far, black sky.
pub fn of_depth(depth_m: f32) -> [u8; 3] {
    const STOPS: [[f32; 3]; 5] =
        [[252.0, 230.0, 100.0], [250.0, 150.0, 60.0], [200.0, 70.0, 90.0], [110.0, 30.0, 130.0], [25.0, 15.0, 60.0]];
    if !depth_m.is_finite() {
        return [0; 3];
    }
    let t = ((1.0 + depth_m.max(0.0)).ln() / (1.0 + FAR_M).ln()).clamp(0.0, 1.0) * 4.0;
    let i = (t as usize).min(3);
    let f = t - i as f32;
    [0, 1, 2].map(|c| (STOPS[i][c] * (1.0 - f) + STOPS[i + 1][c] * f) as u8)
}

/// The usual colours of normals: x red, up green, towards the camera blue.
pub fn of_normal(normal: [f32; 3]) -> [u8; 3] {
    if normal == [0.0; 3] {
        return [70, 130, 180];
    }
    [normal[0], -normal[1], -normal[2]].map(|n| (127.5 * (n + 1.0)).clamp(0.0, 255.0) as u8)
}

/// Normals in World: east red, north green, up blue.
pub fn of_normal_world(normal: [f32; 3]) -> [u8; 3] {
    // Of Camera's axes, up and towards the camera are turned round.
    of_normal([normal[0], -normal[1], -normal[2]])
}

/// Ways in World as seen from above: the wheel of directions, east red and north between yellow and green.
pub fn of_scene_flow([east, north, up]: [f32; 3], most_m: f32) -> [u8; 3] {
    of_flow([east, if up.is_finite() { -north } else { up }], most_m)
}

/// Linear colours as a screen shows them; black where there is none.
pub fn of_albedo(albedo: [f32; 3]) -> [u8; 3] {
    let encoded = |v: f32| if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    // NaN becomes 0.
    albedo.map(|v| (255.0 * encoded(v)).round() as u8)
}

/// Three shares as red, green and blue; black where there are none.
pub fn of_shares(shares: [f32; 3]) -> [u8; 3] {
    shares.map(|share| (255.0 * share).round() as u8)
}

/// The wheel of directions, white where nothing moves and full at `most_px` pixels: red to the right, then yellow, green
/// (up and to the left), cyan, blue and violet against the clock; black where flow is not defined.
pub fn of_flow(flow_px: [f32; 2], most_px: f32) -> [u8; 3] {
    let [u, v] = flow_px;
    if !(u.is_finite() && v.is_finite()) {
        return [0; 3];
    }
    let strength = (u.hypot(v) / most_px.max(f32::MIN_POSITIVE)).min(1.0);
    // Rows grow downwards, and the wheel turns against the clock.
    let hue = (-v).atan2(u).rem_euclid(std::f32::consts::TAU) / std::f32::consts::TAU * 6.0;
    tents(hue).map(|full| (255.0 * (1.0 - strength * (1.0 - full))) as u8)
}

/// Red, green and blue of a hue from 0 to 6: three tents, a third of the circle apart.
fn tents(hue: f32) -> [f32; 3] {
    [0.0, 2.0, 4.0].map(|offset: f32| (2.0 - ((hue - offset + 9.0) % 6.0 - 3.0).abs()).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_instances_have_colours_that_can_be_told_apart() {
        for id in 1..2000u16 {
            let distance = |a: [u8; 3], b: [u8; 3]| (0..3).map(|i| a[i].abs_diff(b[i]) as u32).sum::<u32>();
            assert!(distance(of_instance(id), of_instance(id + 1)) > 120, "{id}");
            assert!(distance(of_instance(id), [0; 3]) > 150, "{id}");
        }
    }

    #[test]
    fn flow_has_the_colours_of_the_wheel() {
        let of = |u: f32, v: f32| of_flow([u, v], 10.0);
        assert_eq!([of(0.0, 0.0), of(10.0, 0.0), of(50.0, 0.0)], [[255; 3], [255, 0, 0], [255, 0, 0]]);
        let [up, down, left] = [of(0.0, -10.0), of(0.0, 10.0), of(-10.0, 0.0)];
        assert!(up[1] == 255 && up[2] == 0, "{up:?} is yellow to green");
        assert!(down[2] == 255 && down[1] == 0, "{down:?} is violet");
        assert_eq!(left, [0, 255, 255]);
        assert_eq!(of(f32::NAN, 0.0), [0; 3]);
    }

    #[test]
    fn ways_and_normals_of_world_have_the_colours_of_the_compass() {
        assert_eq!(of_normal_world([0.0, 0.0, 1.0]), [127, 127, 255]);
        assert_eq!(of_normal_world([1.0, 0.0, 0.0]), [255, 127, 127]);
        assert_eq!(of_scene_flow([2.0, 0.0, 0.0], 2.0), [255, 0, 0]);
        assert_eq!(of_scene_flow([0.0, 2.0, 0.0], 2.0), of_flow([0.0, -2.0], 2.0));
        assert_eq!(
            [of_scene_flow([f32::NAN; 3], 2.0), of_albedo([f32::NAN; 3]), of_shares([f32::NAN; 3])],
            [[0; 3]; 3]
        );
        assert_eq!(of_albedo([0.0, 0.214, 1.0]), [0, 127, 255]);
        assert_eq!(of_shares([0.0, 0.5, 1.2]), [0, 128, 255]);
    }

    #[test]
    fn classes_have_the_colours_of_their_table() {
        assert_eq!([of_class(1), of_class(9), of_class(200)], [[70, 130, 180], [128, 64, 128], [0; 3]]);
    }
}
