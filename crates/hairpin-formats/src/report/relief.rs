//! Ground as light falls on it: shading for the 3D view, and a picture for the views without JavaScript.

use hairpin::campaign::kind::Relief;

/// Direction to the sun, by the cartographers' custom from the north-west, and how much steeper slopes are drawn.
const SUN: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
const STEEPER: f64 = 1.5;

/// Light on each point, 0 dark to 1 bright: the cosine of the angle between the ground's normal and the sun (Lambert).
/// 0.5 where nothing is known.
pub(super) fn shading(relief: &Relief) -> Vec<Vec<f64>> {
    let heights = &relief.heights;
    let height = |row: usize, column: usize| heights.get(row).and_then(|row| row.get(column)).copied();
    let slope = |low: Option<f64>, high: Option<f64>, apart: f64| match (low, high) {
        (Some(low), Some(high)) => STEEPER * (high - low) / apart,
        _ => f64::NAN,
    };
    (0..heights.len())
        .map(|row| {
            (0..heights[row].len())
                .map(|column| {
                    let (west, east) = (column.saturating_sub(1), (column + 1).min(heights[row].len() - 1));
                    let (south, north) = (row.saturating_sub(1), (row + 1).min(heights.len() - 1));
                    let x = slope(height(row, west), height(row, east), (east - west).max(1) as f64 * relief.step);
                    let y = slope(
                        height(south, column),
                        height(north, column),
                        (north - south).max(1) as f64 * relief.step,
                    );
                    let light = (SUN[2] - SUN[0] * x - SUN[1] * y) / (1.0 + x * x + y * y).sqrt();
                    if light.is_finite() { light.clamp(0.0, 1.0) } else { 0.5 }
                })
                .collect()
        })
        .collect()
}

/// The shaded ground as PNG, north up, eight bits of grey; `None` for no ground at all.
pub(super) fn picture(relief: &Relief) -> Option<Vec<u8>> {
    let shades = shading(relief);
    let (rows, columns) = (shades.len(), shades.first()?.len());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, u32::try_from(columns).ok()?, u32::try_from(rows).ok()?);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let grey = |shade: &f64| (110.0 + 145.0 * shade).round() as u8;
    let pixels: Vec<u8> = shades.iter().rev().flat_map(|row| row.iter().map(grey)).collect();
    encoder.write_header().ok()?.write_image_data(&pixels).ok()?;
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn relief(height: impl Fn(f64, f64) -> f64) -> Relief {
        let heights = (0..5).map(|row| (0..7).map(|column| height(column as f64, row as f64)).collect()).collect();
        Relief { low: [0.0, 0.0], step: 1.0, heights }
    }

    #[test]
    fn slopes_towards_the_sun_are_brighter() {
        let at = |height: fn(f64, f64) -> f64| shading(&relief(height))[2][3];
        let (level, lit, dark) = (at(|_, _| 4.0), at(|x, y| 0.2 * (x - y)), at(|x, y| 0.2 * (y - x)));
        assert!(dark < level && level < lit, "{dark} {level} {lit}");
        assert!((level - SUN[2]).abs() < 1e-12);
        assert_eq!(at(|_, _| f64::NAN), 0.5);
    }

    #[test]
    fn a_picture_is_a_png_of_the_grounds_size() {
        let bytes = picture(&relief(|x, _| x)).expect("a picture");
        let decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        let info = decoder.read_info().expect("a PNG").info().clone();
        assert_eq!((info.width, info.height), (7, 5));
        assert!(picture(&Relief { low: [0.0, 0.0], step: 1.0, heights: Vec::new() }).is_none());
    }
}
