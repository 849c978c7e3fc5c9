//! An oracle of its own: whether a segment between integer points meets a ball, box or half-space, in integers that
//! cannot overflow.

/// a·b as (high, low), for comparing products of 128-bit numbers.
fn wide(a: u128, b: u128) -> (u128, u128) {
    let half = |x: u128| (x >> 64, x & u128::from(u64::MAX));
    let ((ah, al), (bh, bl)) = (half(a), half(b));
    let (low, cross1, cross2) = (al * bl, ah * bl, al * bh);
    let (middle, carry) = cross1.overflowing_add(cross2);
    let (low, carry_low) = low.overflowing_add(middle << 64);
    (ah * bh + (middle >> 64) + (u128::from(carry) << 64) + u128::from(carry_low), low)
}

/// Whether a·b ≤ c·d, all ≥ 0.
fn at_most(a: i128, b: i128, c: i128, d: i128) -> bool {
    wide(a.unsigned_abs(), b.unsigned_abs()) <= wide(c.unsigned_abs(), d.unsigned_abs())
}

pub(super) type Place = [i128; 3];

fn dot(a: &Place, b: &Place) -> i128 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn minus(a: &Place, b: &Place) -> Place {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Whether a point of the segment is within `radius` of `centre`.
pub(super) fn meets_ball(a: &Place, b: &Place, centre: &Place, radius: i128) -> bool {
    let (u, v, d) = (minus(a, centre), minus(b, centre), minus(b, a));
    let rr = radius * radius;
    if dot(&u, &u) <= rr || dot(&v, &v) <= rr {
        return true;
    }
    let (along, square) = (dot(&u, &d), dot(&d, &d));
    // Nearest inside the segment: |u|² − (u·d)²/|d|² ≤ r².
    along < 0 && dot(&v, &d) > 0 && at_most(dot(&u, &u) - rr, square, along, along)
}

/// Whether the segment meets the closed box between two corners: the fractions of t that every slab leaves, compared
/// crosswise.
pub(super) fn meets_box(a: &Place, b: &Place, low: &Place, high: &Place) -> bool {
    let (mut from, mut to) = ((0, 1), (1, 1));
    for k in 0..3 {
        let d = b[k] - a[k];
        if d == 0 {
            if a[k] < low[k] || a[k] > high[k] {
                return false;
            }
            continue;
        }
        let (enter, leave) = if d > 0 { (low[k], high[k]) } else { (high[k], low[k]) };
        let (enter, leave) = (((enter - a[k]) * d.signum(), d.abs()), ((leave - a[k]) * d.signum(), d.abs()));
        if enter.0 * from.1 > from.0 * enter.1 {
            from = enter;
        }
        if leave.0 * to.1 < to.0 * leave.1 {
            to = leave;
        }
    }
    from.0 * to.1 <= to.0 * from.1
}

/// Whether an end has normal·p ≤ offset.
pub(super) fn meets_half_space(a: &Place, b: &Place, normal: &Place, offset: i128) -> bool {
    dot(a, normal).min(dot(b, normal)) <= offset
}

/// Whether every point is within `radius` of `centre`.
pub(super) fn stays_inside(a: &Place, b: &Place, centre: &Place, radius: i128) -> bool {
    [a, b].into_iter().all(|p| dot(&minus(p, centre), &minus(p, centre)) <= radius * radius)
}

#[test]
fn wide_products_compare_as_numbers() {
    let big = i128::MAX / 3;
    assert!(at_most(big, 5, big, 5) && at_most(big, 4, 5, big) && !at_most(big, 6, 5, big));
    assert_eq!(wide(u128::MAX, u128::MAX), (u128::MAX - 1, 1));
    assert!(meets_ball(&[-5, 3, 0], &[5, 3, 0], &[0, 0, 0], 3) && !meets_ball(&[-5, 4, 0], &[5, 4, 0], &[0, 0, 0], 3));
    assert!(meets_box(&[-5, -5, 0], &[5, 5, 0], &[1, 1, 0], &[2, 2, 1]));
    assert!(
        meets_box(&[0, 2, 0], &[2, 0, 0], &[1, 1, 0], &[2, 2, 1])
            && !meets_box(&[0, 1, 0], &[1, 0, 0], &[1, 1, 0], &[2, 2, 1])
    );
}
