use super::*;

/// A map of `columns` × `rows` cells of `cell` metres sampled from `height`, south-west cell's centre at `first`.
fn map(
    columns: usize,
    rows: usize,
    cell: f64,
    first: [f64; 2],
    height: impl Fn(f64, f64) -> f64,
) -> Result<ElevationMap, MapError> {
    let mut heights = Vec::new();
    for row in (0..rows).rev() {
        for column in 0..columns {
            heights.push(height(first[0] + column as f64 * cell, first[1] + row as f64 * cell) as f32);
        }
    }
    ElevationMap::new(Grid { columns, rows, first_center: first, cell: [cell, cell] }, &heights, HoleRule::KeepOut)
}

#[test]
fn a_plane_is_a_plane_to_its_border_and_row_0_is_north() {
    let map = map(12, 9, 0.25, [3.0, -2.0], |x, y| 0.5 * x - 0.25 * y).expect("a map");
    let (low, high) = map.extent();
    assert_eq!((low, high), ([3.0, -2.0], [5.75, 0.0]));
    for (x, y) in [(3.0, -2.0), (5.75, 0.0), (3.0, 0.0), (4.4, -1.3), (5.7, -1.99)] {
        let patch = map.patch(x, y).expect("ground");
        assert!((patch.height - (0.5 * x - 0.25 * y)).abs() < 1e-6, "{patch:?} at ({x}, {y})");
        assert!((patch.slope[0] - 0.5).abs() < 1e-5 && (patch.slope[1] + 0.25).abs() < 1e-5, "{patch:?}");
        assert!(patch.bend.iter().all(|b| b.abs() < 1e-4), "{patch:?}");
    }
}

#[test]
fn derivatives_are_those_of_the_height() {
    let map = map(30, 30, 0.1, [0.0, 0.0], |x, y| (3.0 * x).sin() * (2.0 * y).cos()).expect("a map");
    let h = 1e-5;
    for i in 0..200 {
        let (x, y) = (0.3 + 0.0117 * f64::from(i), 2.6 - 0.0113 * f64::from(i));
        let at = |x: f64, y: f64| map.patch(x, y).expect("ground");
        assert_eq!(map.height(x, y).expect("ground").to_bits(), at(x, y).height.to_bits(), "({x}, {y})");
        let (p, e, w, n, s) = (at(x, y), at(x + h, y), at(x - h, y), at(x, y + h), at(x, y - h));
        assert!((p.slope[0] - (e.height - w.height) / (2.0 * h)).abs() < 2e-5, "slope at ({x}, {y})");
        assert!((p.slope[1] - (n.height - s.height) / (2.0 * h)).abs() < 2e-5, "slope at ({x}, {y})");
        // Second derivatives jump at cell centres, where the difference straddles two pieces.
        let fraction = |v: f64| (v * 10.0).fract().min(1.0 - (v * 10.0).fract());
        if fraction(x) > 1e-3 && fraction(y) > 1e-3 {
            assert!((p.bend[0] - (e.slope[0] - w.slope[0]) / (2.0 * h)).abs() < 1e-5, "bend at ({x}, {y})");
            assert!((p.bend[1] - (n.slope[0] - s.slope[0]) / (2.0 * h)).abs() < 1e-5, "bend at ({x}, {y})");
            assert!((p.bend[2] - (n.slope[1] - s.slope[1]) / (2.0 * h)).abs() < 1e-5, "bend at ({x}, {y})");
        }
    }
}

#[test]
fn height_and_tangent_are_the_patchs_to_the_bit() {
    let map = map(9, 7, 0.5, [0.0, 0.0], |x, y| (3.0 * x).sin() + x * y - y * y).expect("a map");
    for i in 0..200 {
        let (x, y) = (f64::from(i) * 0.0199, (f64::from(i) * 0.37) % 3.0);
        let patch = map.patch(x, y);
        assert_eq!(map.tangent(x, y), patch.map(|patch| (patch.height, patch.slope)), "({x}, {y})");
        assert_eq!(map.height(x, y), patch.map(|patch| patch.height), "({x}, {y})");
    }
    assert_eq!(map.tangent(-0.1, 0.0), Err(NoGround::OffMap { x: -0.1, y: 0.0 }));
}

#[test]
fn slopes_are_continuous_across_cells_and_heights_met_at_their_centres() {
    let map = map(10, 10, 0.5, [0.0, 0.0], |x, y| (7.0 * x * y).sin()).expect("a map");
    let before = map.patch(2.0 - 1e-12, 1.3).expect("ground");
    let after = map.patch(2.0 + 1e-12, 1.3).expect("ground");
    assert!((before.slope[0] - after.slope[0]).abs() < 1e-9 && (before.slope[1] - after.slope[1]).abs() < 1e-9);
    let center = map.patch(2.0, 1.5).expect("ground");
    assert!((center.height - f64::from(map.cell_height(3, 4))).abs() < 1e-7);
}

#[test]
fn holes_are_refused_kept_out_or_filled_as_asked() {
    let grid = Grid { columns: 40, rows: 40, first_center: [0.0, 0.0], cell: [0.1, 0.1] };
    let mut heights = vec![0.0_f32; 1600];
    for (i, h) in heights.iter_mut().enumerate() {
        *h = 0.1 * (i % 40) as f32;
        if (10..20).contains(&(i / 40)) && (10..20).contains(&(i % 40)) {
            *h = f32::NAN;
        }
    }
    let error = ElevationMap::new(grid, &heights, HoleRule::Error).expect_err("holes");
    assert_eq!(error, MapError::Holes { count: 100, row: 10, column: 10 });
    let kept = ElevationMap::new(grid, &heights, HoleRule::KeepOut).expect("a map");
    assert!(matches!(kept.patch(1.5, 2.5), Err(NoGround::Hole { .. })));
    assert!(kept.patch(0.5, 0.5).is_ok());
    // Unknown from two cells before the first hole to two behind the last: x 0.8 … 2.1 m, y 1.8 … 3.1 m.
    for (place, wanted) in [([0.5, 2.5], 0.3), ([0.5, 0.4], 0.4), ([0.4, 3.0], 0.4), ([0.1, 2.0], 0.1)] {
        let found = kept.edge_distance(place, 10.0);
        assert!((found - wanted).abs() < 1e-9, "{found} at {place:?}");
    }
    let corner = kept.edge_distance([2.4, 1.4], 10.0);
    assert!((corner - 0.5).abs() < 1e-9, "{corner}");
    assert!(kept.edge_distance([1.5, 2.5], 1.0) < 0.0 && kept.edge_distance([-0.2, 1.0], 1.0) < 0.0);
    // Farther holes are not looked for, and what is told then is no more than asked.
    assert!((kept.edge_distance([0.5, 2.5], 0.2) - 0.2).abs() < 1e-9);
    let filled = ElevationMap::new(grid, &heights, HoleRule::Fill).expect("a map");
    // The membrane over a hole in a plane is the plane.
    let patch = filled.patch(1.5, 2.45).expect("ground");
    assert!((patch.height - 1.5).abs() < 0.02, "{patch:?}");
    assert!(filled.is_filled(1.5, 2.45) && !filled.is_filled(0.5, 0.5) && filled.holes() == 100);
    let empty = ElevationMap::new(grid, &[f32::NAN; 1600], HoleRule::Fill).expect_err("nothing known");
    assert_eq!(empty, MapError::Empty);
}

#[test]
fn what_is_no_map_is_refused_by_name() {
    let grid = Grid { columns: 3, rows: 3, first_center: [0.0, 0.0], cell: [0.1, 0.1] };
    let heights = [0.0; 9];
    let refused =
        |grid: Grid, heights: &[f32]| ElevationMap::new(grid, heights, HoleRule::Fill).expect_err("no map").to_string();
    assert!(refused(Grid { cell: [0.0, 0.1], ..grid }, &heights).contains("cell width = 0"));
    assert!(refused(Grid { cell: [0.1, f64::NAN], ..grid }, &heights).contains("cell height = NaN"));
    assert!(refused(Grid { columns: 1, ..grid }, &heights[..3]).contains("columns = 1"));
    assert!(refused(Grid { first_center: [f64::INFINITY, 0.0], ..grid }, &heights).contains("origin x"));
    assert!(refused(grid, &heights[..8]).contains("8 heights for 3 rows of 3"));
    assert!(refused(Grid { columns: usize::MAX, ..grid }, &heights).contains("heights for"));
}

#[test]
fn outside_the_outermost_centres_there_is_no_ground() {
    let map = map(5, 5, 1.0, [0.0, 0.0], |_, _| 1.0).expect("a map");
    for (x, y) in [(-1e-9, 2.0), (4.0 + 1e-9, 2.0), (2.0, f64::NAN), (f64::INFINITY, 0.0)] {
        assert!(matches!(map.patch(x, y), Err(NoGround::OffMap { .. })), "({x}, {y})");
    }
}

#[test]
fn a_map_is_as_steep_as_its_neighbouring_cells() {
    let plane = map(12, 9, 0.25, [3.0, -2.0], |x, y| 0.5 * x - 0.25 * y).expect("a map");
    assert!(plane.is_steeper_than(0.49) && !plane.is_steeper_than(0.51));
    let along_y = map(12, 9, 0.25, [3.0, -2.0], |_, y| 0.3 * y).expect("a map");
    assert!(along_y.is_steeper_than(0.29) && !along_y.is_steeper_than(0.31));
    let hole = map(12, 9, 0.25, [0.0, 0.0], |x, _| if x > 1.0 && x < 1.5 { f64::NAN } else { 0.0 }).expect("a map");
    assert!(hole.holes() > 0 && !hole.is_steeper_than(0.0));
}
