use super::*;

fn figure(y: Scale, marks: Vec<Marks>) -> Figure {
    let axis = |label: &str, scale| Axis { label: label.into(), scale };
    let series = marks.into_iter().enumerate().map(|(index, marks)| Series { name: format!("kind {index}"), marks });
    Figure { title: "A < B".into(), x: axis("points", Scale::Linear), y: axis("time, s", y), series: series.collect() }
}

/// Numbers of attribute `name` of every element `element`, in order.
fn attributes(svg: &str, element: &str, name: &str) -> Vec<f64> {
    let elements = svg.split('<').filter(|part| part.starts_with(&format!("{element} ")));
    let value = |part: &str| part.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse().ok();
    elements.filter_map(value).collect()
}

#[test]
fn decades_are_equally_far_apart_and_what_has_no_logarithm_is_left_out() {
    let points = [1e-3, 1e-2, 0.0, 0.1, f64::NAN, 1.0].iter().enumerate();
    let points: Vec<Point> = points.map(|(i, y)| Point::new(i as f64, *y)).collect();
    let svg = figure(Scale::Logarithmic, vec![Marks::Scatter(points)]).svg().unwrap();
    let heights = attributes(&svg, "circle", "cy");
    assert_eq!(heights.len(), 4, "{svg}");
    let steps: Vec<f64> = heights.windows(2).map(|pair| pair[0] - pair[1]).collect();
    assert!(steps.iter().all(|step| *step > 50.0 && (step - steps[0]).abs() <= 1.0), "{steps:?}");
    assert!(svg.contains("0.001") && svg.contains("A &lt; B") && !svg.contains("NaN"), "{svg}");
}

#[test]
fn bars_stand_on_zero_beside_each_other_and_are_as_high_as_their_values() {
    let bars = |scale: f64| Marks::Bars((0..3).map(|i| Point::new(f64::from(i), scale * f64::from(i + 1))).collect());
    let svg = figure(Scale::Linear, vec![bars(1.0), bars(2.0)]).svg().unwrap();
    let of = |colour: &str, name: &str| -> Vec<f64> {
        let rectangles: Vec<&str> =
            svg.split('<').filter(|part| part.starts_with("rect") && part.contains(colour)).collect();
        // The last one is the key in the legend.
        attributes(&format!("<{}", rectangles[..3].join("<")), "rect", name)
    };
    let (one, two) = (of("#0072B2", "height"), of("#D55E00", "height"));
    for i in 0..3 {
        assert!(
            (two[i] - 2.0 * one[i]).abs() <= 3.0 && (one[i] - one[0] * (i + 1) as f64).abs() <= 3.0,
            "{one:?} {two:?}"
        );
    }
    let (left, width, right) = (of("#0072B2", "x"), of("#0072B2", "width"), of("#D55E00", "x"));
    assert!((0..3).all(|i| left[i] + width[i] <= right[i]), "{left:?} {width:?} {right:?}");
}

#[test]
fn quartiles_are_those_of_the_definition() {
    let spread = Spread::of(2.0, &[4.0, 1.0, f64::NAN, 3.0, 2.0]).unwrap();
    assert_eq!(spread, Spread { x: 2.0, five: [1.0, 1.75, 2.5, 3.25, 4.0] });
    assert_eq!(Spread::of(0.0, &[7.0]).unwrap().five, [7.0; 5]);
    assert_eq!(Spread::of(0.0, &[f64::NAN]), None);
    let svg = figure(Scale::Linear, vec![Marks::Boxes(vec![spread])]).svg().unwrap();
    assert!(svg.ends_with("</svg>\n") || svg.ends_with("</svg>"), "{svg}");
}

#[test]
fn nothing_and_single_values_have_axes_too() {
    for scale in [Scale::Linear, Scale::Logarithmic, Scale::Range(0.0, 0.0), Scale::Names(Vec::new())] {
        for points in [Vec::new(), vec![Point::new(3.0, 3.0)], vec![Point::between(1.0, f64::NAN, 0.0, 1.0)]] {
            let both = vec![Marks::Line(points.clone()), Marks::Bars(points)];
            let svg = figure(scale.clone(), both).svg().unwrap();
            assert!(svg.starts_with("<svg") && !svg.contains("NaN") && !svg.contains("inf"), "{scale:?}: {svg}");
        }
    }
}

#[test]
fn tables_keep_all_digits_in_files_and_three_on_screens() {
    let mut table = Table::new(&["points", "mean_s", "note"]);
    table.push(vec![10usize.into(), 0.000123456.into(), "a, \"b\"".into()]);
    table.push(vec![11usize.into(), None::<f64>.into(), Cell::Empty]);
    assert_eq!(table.csv(), "points,mean_s,note\n10,0.000123456,\"a, \"\"b\"\"\"\n11,,\n");
    assert_eq!(
        table.shown()[1..],
        [["10", "1.23e-4", "a, \"b\""], ["11", "–", "–"]].map(|row| row.map(String::from).to_vec())
    );
    assert_eq!(table.objects()[1]["mean_s"], serde_json::Value::Null);
    assert_eq!(table.objects()[0]["points"], 10);
    for (number, shown) in [(1234.5, "1234"), (12.345, "12.3"), (0.5, "0.500"), (0.0, "0"), (-99.96, "-100.0")] {
        assert_eq!(table::three_digits(number), shown);
    }
}
