//! Polygons, painted.

use trove_files::{Budget, Exceeded};
use trove_model::Raster;

/// Paints the pixels whose centres lie in a polygon, by the even-odd rule; corners are in pixels, with (0, 0) in the
/// corner of the image.
///
/// # Errors
/// A polygon that takes more steps than are left: a small file may hold many that cover everything.
pub(super) fn paint<T: Copy>(
    canvas: &mut Raster<T>,
    polygon: &[[f64; 2]],
    value: T,
    steps: &Budget,
) -> Result<(), Exceeded> {
    if polygon.iter().flatten().any(|number| !number.is_finite()) || polygon.len() < 3 {
        return Ok(());
    }
    let (low, high) = polygon.iter().fold((f64::MAX, f64::MIN), |(low, high), [_, y]| (low.min(*y), high.max(*y)));
    let rows = (low - 0.5).ceil().max(0.0) as u32..((high + 0.5).floor().max(0.0) as u32).min(canvas.height);
    steps.take(rows.len(), polygon.len() + canvas.width as usize)?;
    let mut crossings = Vec::new();
    for row in rows {
        let y = f64::from(row) + 0.5;
        crossings.clear();
        for (i, [x0, y0]) in polygon.iter().enumerate() {
            let [x1, y1] = polygon[(i + 1) % polygon.len()];
            if (*y0 <= y) != (y1 <= y) {
                crossings.push(x0 + (y - y0) / (y1 - y0) * (x1 - x0));
            }
        }
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.as_chunks::<2>().0 {
            let [first, last] = pair.map(|x| ((x - 0.5).ceil().max(0.0) as u32).min(canvas.width));
            (first..last).for_each(|x| *canvas.at_mut(x, row) = value);
        }
    }
    Ok(())
}

/// Paints a polygon whose corners are pixels, with its rim, as Cityscapes' tools do.
///
/// # Errors
/// As for [`paint`].
pub(super) fn paint_with_rim<T: Copy>(
    canvas: &mut Raster<T>,
    polygon: &[[f64; 2]],
    value: T,
    steps: &Budget,
) -> Result<(), Exceeded> {
    let centres: Vec<[f64; 2]> = polygon.iter().map(|corner| corner.map(|at| at + 0.5)).collect();
    paint(canvas, &centres, value, steps)?;
    let most = f64::from(canvas.width.max(canvas.height));
    for (i, [x0, y0]) in polygon.iter().enumerate() {
        let [x1, y1] = polygon[(i + 1) % polygon.len()];
        let length = (x1 - x0).abs().max((y1 - y0).abs()).ceil();
        // Outlines far outside of the image are nobody's.
        if !(0.0..=4.0 * most).contains(&length) {
            continue;
        }
        steps.take(length as usize + 1, 1)?;
        for step in 0..=length as u32 {
            let share = f64::from(step) / length.max(1.0);
            let (x, y) = ((x0 + share * (x1 - x0)).round(), (y0 + share * (y1 - y0)).round());
            if x >= 0.0 && y >= 0.0 && x < f64::from(canvas.width) && y < f64::from(canvas.height) {
                *canvas.at_mut(x as u32, y as u32) = value;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &[[f64; 2]]) -> usize {
        let mut canvas = Raster::filled(20, 10, false);
        paint(&mut canvas, polygon, true, &Budget::of_file(0)).unwrap();
        canvas.data.iter().filter(|painted| **painted).count()
    }

    #[test]
    fn a_polygon_covers_the_pixels_whose_centres_it_holds() {
        assert_eq!(area(&[[2.0, 1.0], [6.0, 1.0], [6.0, 4.0], [2.0, 4.0]]), 12);
        assert_eq!(area(&[[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]]), 45);
        // Beyond the image there is nothing to paint.
        assert_eq!(area(&[[-9.0, -9.0], [90.0, -9.0], [90.0, 90.0], [-9.0, 90.0]]), 200);
        assert_eq!(area(&[[0.5, 0.5], [1.0, 1.0]]), 0);
        assert_eq!(area(&[[1.0, 1.0], [f64::NAN, 2.0], [3.0, 3.0]]), 0);
    }

    #[test]
    fn corners_that_are_pixels_are_painted_with_the_rim() {
        let mut canvas = Raster::filled(20, 10, 0);
        let square = [[2.0, 1.0], [6.0, 1.0], [6.0, 4.0], [2.0, 4.0]];
        paint_with_rim(&mut canvas, &square, 1, &Budget::of_file(0)).unwrap();
        assert_eq!(canvas.data.iter().sum::<u32>(), 5 * 4);
        // A single pixel, and a line.
        paint_with_rim(&mut canvas, &[[9.0, 9.0]], 1, &Budget::of_file(0)).unwrap();
        paint_with_rim(&mut canvas, &[[10.0, 0.0], [13.0, 0.0]], 1, &Budget::of_file(0)).unwrap();
        assert_eq!(canvas.data.iter().sum::<u32>(), 5 * 4 + 1 + 4);
    }

    #[test]
    fn polygons_do_not_choose_how_long_they_take() {
        let everything = [[0.0, 0.0], [8192.0, 0.0], [8192.0, 8192.0], [0.0, 8192.0]];
        let (mut canvas, steps) = (Raster::filled(8192, 8192, false), Budget::of_file(1000));
        let painted = (0..1000).take_while(|_| paint(&mut canvas, &everything, true, &steps).is_ok()).count();
        assert_eq!(painted, 3);
    }
}
