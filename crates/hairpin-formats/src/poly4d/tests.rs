use hairpin::math::polynomial::septic;
use hairpin::trajectory::{Channel, Profile, ProfileLeg, Track};
use nalgebra::Isometry3;

use super::*;

fn profile() -> Profile {
    let leg = |from: [f64; 3], to: [f64; 3], duration: f64| ProfileLeg {
        duration,
        coefficients: std::array::from_fn(|axis| {
            septic(&[from[axis], 0.5, 0.1, 0.0], &[to[axis], 0.5, 0.1, 0.0], duration)
        }),
    };
    Profile {
        legs: vec![leg([1.0, 2.0, 1.5], [4.0, -2.0, 2.5], 2.3457), leg([4.0, -2.0, 2.5], [-6.0, 3.0, 1.0], 7.1113)],
    }
}

/// A compressed trajectory as the documentation of the firmware has it: pieces of Bézier control points, mm and 0.1°.
fn decoded(bytes: &[u8]) -> Vec<(f64, [Vec<f64>; 4])> {
    let int = |at: usize| f64::from(i16::from_le_bytes([bytes[at], bytes[at + 1]]));
    let mut place = [int(0), int(2), int(4), int(6)];
    let (mut at, mut pieces) = (8, Vec::new());
    while at < bytes.len() {
        let (kinds, duration) = (bytes[at], int(at + 1) / 1e3);
        at += 3;
        let mut curves: [Vec<f64>; 4] = Default::default();
        for (axis, curve) in curves.iter_mut().enumerate() {
            let more = [0, 1, 3, 7][usize::from(kinds >> (2 * axis) & 3)];
            *curve = std::iter::once(place[axis]).chain((0..more).map(|k| int(at + 2 * k))).collect();
            at += 2 * more;
            place[axis] = *curve.last().unwrap();
        }
        pieces.push((duration, curves));
    }
    pieces
}

/// By Bernstein's polynomials.
fn bezier(points: &[f64], share: f64) -> f64 {
    let degree = points.len() - 1;
    let choose = |k: usize| (0..k).fold(1.0, |c, i| c * (degree - i) as f64 / (i + 1) as f64);
    let term =
        |(k, point): (usize, &f64)| choose(k) * share.powi(k as i32) * (1.0 - share).powi((degree - k) as i32) * point;
    points.iter().enumerate().map(term).sum()
}

#[test]
fn rows_are_the_profile() {
    let fitted = fit_profile(&profile());
    assert!(fitted.error <= TOLERANCE, "{}", fitted.error);
    let text = text(&fitted.pieces);
    let mut lines = text.lines();
    assert!(lines.next().unwrap().starts_with("Duration,x^0,x^1,x^2,x^3,x^4,x^5,x^6,x^7,y^0"));
    let mut begins = 0.0;
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(row.len(), 33);
        for k in 0..=20 {
            let tau = row[0] * f64::from(k) / 20.0;
            let (leg, own) = profile().locate(begins + tau - 1e-9).unwrap();
            let meant = profile().legs[leg].position(own);
            for axis in 0..3 {
                let value: f64 = (0..8).map(|i| row[1 + 8 * axis + i] * tau.powi(i as i32)).sum();
                assert!((value - meant[axis]).abs() < TOLERANCE, "{begins} + {tau}: {value} {meant}");
            }
            assert!(row[25..].iter().all(|value| *value == 0.0));
        }
        begins += row[0];
    }
    assert!((begins - profile().duration()).abs() < 1e-5);
}

#[test]
fn what_is_compressed_is_read_back_near_the_pieces() {
    let pieces = fit_profile(&profile()).pieces;
    let compressed = compress(&pieces).unwrap();
    // Half a millimetre of each coordinate of a control point, and as much of a clock.
    assert!(compressed.error < 1e-3 && compressed.clock <= 5.1e-4, "{compressed:?}");
    let read = decoded(&compressed.bytes);
    assert_eq!(read.len(), pieces.len());
    for ((duration, curves), piece) in read.iter().zip(&pieces) {
        assert!((duration - piece.duration).abs() <= 1.1e-3);
        for k in 0..=10 {
            let share = f64::from(k) / 10.0;
            let meant = piece.at(share * piece.duration);
            for (curve, meant) in curves.iter().zip(meant).take(3) {
                assert!((bezier(curve, share) / 1e3 - meant).abs() < 1e-3);
            }
            assert_eq!(curves[3], [0.0], "yaw is constant and takes no room");
        }
    }
}

#[test]
fn lower_degrees_take_less_room_and_what_does_not_fit_is_refused() {
    let piece = |x: [f64; 4]| {
        let mut coefficients = [[0.0; 8]; 4];
        coefficients[0][..4].copy_from_slice(&x);
        Piece { duration: 2.0, coefficients }
    };
    let bytes = |x| compress(&[piece(x)]).unwrap().bytes.len();
    assert_eq!([bytes([1.0, 0.0, 0.0, 0.0]), bytes([1.0, 0.5, 0.0, 0.0]), bytes([1.0, 0.5, 0.2, -0.1])], [11, 13, 17]);
    let [far, long] = [piece([40.0, 0.0, 0.0, 0.0]), Piece { duration: 40.0, ..piece([0.0; 4]) }];
    assert!(compress(&[far]).unwrap_err().contains("32.767 m") && compress(&[long]).unwrap_err().contains("32.767 s"));
}

#[test]
fn a_track_becomes_cubics_within_a_millimetre() {
    let times: Vec<f64> = (0..=600).map(|i| f64::from(i) / 100.0).collect();
    let poses = times.iter().map(|t| Isometry3::translation(2.0 * t.cos(), 2.0 * t.sin(), 0.3 * t)).collect();
    let column =
        |name: &str, of: fn(&f64) -> f64| Channel { name: name.into(), values: times.iter().map(of).collect() };
    let channels =
        vec![column("vx_m_s", |t| -2.0 * t.sin()), column("vy_m_s", |t| 2.0 * t.cos()), column("vz_m_s", |_| 0.3)];
    let fitted = fit_track(&Track::new(times, poses, channels).unwrap()).unwrap();
    assert!(
        fitted.error <= TOLERANCE && (4..40).contains(&fitted.pieces.len()),
        "{} {}",
        fitted.error,
        fitted.pieces.len()
    );
    let end: f64 = fitted.pieces.iter().map(|piece| piece.duration).sum();
    assert!((end - 6.0).abs() < 1e-9);
}
