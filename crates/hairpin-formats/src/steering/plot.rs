//! Drives seen from above, as SVG.

use plotters::prelude::*;

/// A stretch in one gear.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// x, y in m.
    pub points: Vec<[f64; 2]>,
    /// Driven backwards.
    pub reverse: bool,
}

/// Pixels of the picture's sides.
const SIDE: u32 = 720;
/// Blue and vermilion of Okabe and Ito: told apart by all eyes.
const FORWARD: RGBColor = RGBColor(0, 114, 178);
const REVERSE: RGBColor = RGBColor(213, 94, 0);

/// A picture of `stretches`, x to the right and y up at one scale, forward in blue and reverse in vermilion, and of
/// `poses` (x, y, yaw) as arrows.
///
/// # Errors
/// What the drawing library says.
pub fn svg(stretches: &[Stretch], poses: &[[f64; 3]]) -> Result<String, String> {
    let mut text = String::new();
    draw(&mut text, stretches, poses).map_err(|error| error.to_string())?;
    Ok(text)
}

fn draw(text: &mut String, stretches: &[Stretch], poses: &[[f64; 3]]) -> Result<(), Box<dyn std::error::Error>> {
    let all = stretches.iter().flat_map(|s| s.points.iter().copied()).chain(poses.iter().map(|p| [p[0], p[1]]));
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in all {
        for axis in 0..2 {
            (low[axis], high[axis]) = (low[axis].min(point[axis]), high[axis].max(point[axis]));
        }
    }
    let size = (high[0] - low[0]).max(high[1] - low[1]).max(0.1);
    let half = 0.58 * size;
    let center = [0, 1].map(|axis| if low[axis] <= high[axis] { 0.5 * (low[axis] + high[axis]) } else { 0.0 });
    let range = |axis: usize| center[axis] - half..center[axis] + half;
    let area = SVGBackend::with_string(text, (SIDE, SIDE)).into_drawing_area();
    area.fill(&WHITE)?;
    // Equal label areas on all sides keep the scales equal.
    let mut chart =
        ChartBuilder::on(&area).margin(10).set_all_label_area_size(40).build_cartesian_2d(range(0), range(1))?;
    chart.configure_mesh().x_desc("x, m").y_desc("y, m").light_line_style(WHITE).draw()?;
    for stretch in stretches {
        let colour = if stretch.reverse { REVERSE } else { FORWARD };
        chart.draw_series(LineSeries::new(stretch.points.iter().map(|p| (p[0], p[1])), colour.stroke_width(2)))?;
    }
    for &[x, y, yaw] in poses {
        let reach = 0.05 * size;
        let at = |angle: f64, share: f64| {
            let (sin, cos) = libm::sincos(yaw + angle);
            (x + share * reach * cos, y + share * reach * sin)
        };
        let head = vec![at(0.0, 1.0), at(2.5, 0.6), (x, y), at(-2.5, 0.6), at(0.0, 1.0)];
        chart.draw_series(std::iter::once(PathElement::new(head, BLACK.stroke_width(1))))?;
    }
    area.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_gears_and_both_poses_are_drawn_to_one_scale() {
        let there = Stretch { points: vec![[0.0, 0.0], [4.0, 0.0]], reverse: false };
        let back = Stretch { points: vec![[4.0, 0.0], [4.0, 1.0]], reverse: true };
        let picture = svg(&[there, back], &[[0.0, 0.0, 0.0], [4.0, 1.0, 1.0]]).unwrap();
        assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
        assert!(picture.contains("#0072B2") && picture.contains("#D55E00"), "{picture}");
        let nothing = svg(&[], &[]).unwrap();
        assert!(nothing.starts_with("<svg") && !nothing.contains("NaN"));
    }
}
