//! A convex polytope as half-spaces: made from points, and asked whether it holds others.
//!
//! Membership is what a search spends its time in: half-spaces in groups of eight lanes, ordered so that what is
//! outside is refused by the first group mostly.

use nalgebra::Vector3;
use thiserror::Error;

use super::cloud::{Plane, beyond};
use super::convex_hull::{Found, convex_hull};
use super::growing::Triangle;
use super::refusal::refusal_order;
use crate::math::simd::{Simd, kernel};

/// Half-spaces per group of the membership test.
const GROUP: usize = 8;

/// Thinner than this share of its extent, a polytope is flat.
const FLAT: f64 = 1e-6;

/// Triangles whose corners all lie this near to a plane, as a share of the extent, are of that plane's facet.
const COPLANAR: f64 = 1e-8;

/// Why points span no polytope.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoPolytope {
    /// Fewer than four points, or a coordinate that is not finite.
    #[error("{points} points (four finite ones are needed) span no reach set")]
    Points {
        /// How many were given.
        points: usize,
    },
    /// All points in one plane, line or point, up to a millionth of their extent.
    #[error("the reach set is flat: {thickness:.3e} m thick over {extent:.3e} m, so it has no inside")]
    Flat {
        /// Smallest extent found over axes and facet normals, m.
        thickness: f64,
        /// Diagonal of the bounding box, m.
        extent: f64,
    },
}

/// Rows (nx, ny, nz, b) of eight half-spaces n · x ≤ b.
type Group = [[f64; GROUP]; 4];

/// {x : n_i · x ≤ b_i for every facet i}, |n_i| = 1, with everything asked of it precomputed.
///
/// m. Every point that it was made of is inside, by a last digit if need be.
#[derive(Debug, Clone, PartialEq)]
pub struct Polytope {
    /// Padded with half-spaces that hold everywhere.
    groups: Vec<Group>,
    facets: usize,
    vertices: Vec<Vector3<f64>>,
    min: Vector3<f64>,
    max: Vector3<f64>,
    volume: f64,
}

impl Polytope {
    /// The convex hull of `points`, m. Coplanar triangles are merged into facets, and every facet is moved out by the
    /// last digits it takes to hold all the points.
    ///
    /// Interior points cost a scan each. Thinner than 10⁻⁶ of its diagonal a set counts as flat.
    ///
    /// ```
    /// use hairpin::feasibility::reach::Polytope;
    /// use hairpin::math::simd::Simd;
    /// use nalgebra::Vector3;
    ///
    /// // The corners of a cube of 2 m: twelve triangles, merged into six facets.
    /// let corners: Vec<Vector3<f64>> =
    ///     (0..8).map(|i| Vector3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0).collect();
    /// let cube = Polytope::hull(Simd::default(), &corners)?;
    /// assert!(cube.facets() == 6 && (cube.volume() - 8.0).abs() < 1e-9);
    /// assert!(cube.contains(&Vector3::repeat(1.0)) && !cube.contains(&Vector3::repeat(2.1)));
    /// # Ok::<(), hairpin::feasibility::reach::NoPolytope>(())
    /// ```
    ///
    /// # Errors
    /// [`NoPolytope`].
    pub fn hull(simd: Simd, points: &[Vector3<f64>]) -> Result<Self, NoPolytope> {
        if points.len() < 4 || points.iter().any(|p| !p.iter().all(|c| c.is_finite())) {
            return Err(NoPolytope::Points { points: points.len() });
        }
        let (min, max) = bounds(points);
        let extent = (max - min).norm();
        if (max - min).min() <= FLAT * extent {
            return Err(NoPolytope::Flat { thickness: (max - min).min(), extent });
        }
        let Some(Found { triangles, shell }) = convex_hull(simd, points, extent) else {
            return Err(NoPolytope::Flat { thickness: FLAT * extent, extent });
        };
        let mut planes = facets(points, &triangles, COPLANAR * extent);
        let spans = shell.spans(&planes);
        let thickness = spans.iter().map(|(low, high)| high - low).fold(f64::INFINITY, f64::min);
        if planes.len() < 4 || thickness < FLAT * extent {
            return Err(NoPolytope::Flat { thickness, extent });
        }
        for (plane, (_, high)) in planes.iter_mut().zip(spans) {
            plane[3] = high + 1e-13 * extent;
        }
        let vertices = vertices(points, &triangles);
        let centre = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
        // Each triangle is the base of a pyramid with its top in the centre.
        let volume = triangles.iter().map(|t| -beyond(&t.plane, &centre) * t.area / 6.0).sum();
        Ok(Self { groups: grouped(simd, &planes, &min, &max), facets: planes.len(), vertices, min, max, volume })
    }

    /// Whether n_i · x ≤ b_i for all facets.
    #[inline]
    pub fn contains(&self, x: &Vector3<f64>) -> bool {
        holds(&self.groups, x)
    }

    /// Clears bit i of `bits` (64 a word) where `points[i]` − `from` lies outside.
    pub(crate) fn select(&self, simd: Simd, from: &Vector3<f64>, points: &[Vector3<f64>], bits: &mut [u64]) {
        select(simd, &self.groups, from, points, bits);
    }

    /// max n · x over the polytope, m: its support in direction `n`.
    ///
    /// `n` need not be of length 1; O(vertices).
    pub fn support(&self, n: &Vector3<f64>) -> f64 {
        self.vertices.iter().map(|v| n.dot(v)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Number of facets after merging.
    ///
    /// What one membership test costs at most, in groups of eight.
    pub fn facets(&self) -> usize {
        self.facets
    }

    /// The facets' outer normals and offsets.
    pub fn planes(&self) -> impl Iterator<Item = (Vector3<f64>, f64)> + '_ {
        (0..self.facets).map(|i| {
            let group = &self.groups[i / GROUP];
            let [nx, ny, nz, b] = [0, 1, 2, 3].map(|row| group[row][i % GROUP]);
            (Vector3::new(nx, ny, nz), b)
        })
    }

    /// The hull's vertices, m.
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// Corners of the bounding box, m.
    pub fn bounding_box(&self) -> (Vector3<f64>, Vector3<f64>) {
        (self.min, self.max)
    }

    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        self.volume
    }
}

/// A loop and not [`Iterator::all`], which the kernels' vector instructions are not handed down to where it is not
/// inlined.
#[inline(always)]
fn holds(groups: &[Group], x: &Vector3<f64>) -> bool {
    for [nx, ny, nz, b] in groups {
        let mut holds = true;
        for i in 0..GROUP {
            holds &= nx[i] * x.x + ny[i] * x.y + nz[i] * x.z <= b[i];
        }
        if !holds {
            return false;
        }
    }
    true
}

kernel! {
    fn select(groups: &[Group], from: &Vector3<f64>, points: &[Vector3<f64>], bits: &mut [u64]) {
        for (word, points) in bits.iter_mut().zip(points.chunks(64)) {
            let mut asked = *word;
            while asked != 0 {
                let lane = asked.trailing_zeros();
                asked &= asked - 1;
                if !holds(groups, &(points[lane as usize] - from)) {
                    *word &= !(1 << lane);
                }
            }
        }
    }
}

/// Least and greatest coordinates.
fn bounds(points: &[Vector3<f64>]) -> (Vector3<f64>, Vector3<f64>) {
    let mut min = Vector3::repeat(f64::INFINITY);
    let mut max = -min;
    for p in points {
        min = min.inf(p);
        max = max.sup(p);
    }
    (min, max)
}

/// The points that are corners of a triangle, in rising order.
fn vertices(points: &[Vector3<f64>], triangles: &[Triangle]) -> Vec<Vector3<f64>> {
    let mut corner = vec![false; points.len()];
    for number in triangles.iter().flat_map(|triangle| triangle.corners) {
        corner[number as usize] = true;
    }
    points.iter().zip(corner).filter(|(_, corner)| *corner).map(|(point, _)| *point).collect()
}

/// One plane per set of neighbouring triangles whose corners lie within `near` (m) of it.
fn facets(points: &[Vector3<f64>], triangles: &[Triangle], near: f64) -> Vec<Plane> {
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    // Large triangles have the best normals, so they stand for their plane.
    order.sort_unstable_by(|a, b| triangles[*b as usize].area.total_cmp(&triangles[*a as usize].area).then(a.cmp(b)));
    let mut taken = vec![false; triangles.len()];
    let (mut planes, mut open) = (Vec::new(), Vec::new());
    for seed in order {
        if taken[seed as usize] {
            continue;
        }
        let plane = triangles[seed as usize].plane;
        planes.push(plane);
        taken[seed as usize] = true;
        open.push(seed);
        while let Some(triangle) = open.pop() {
            for other in triangles[triangle as usize].neighbours {
                let corners = triangles[other as usize].corners.iter();
                let mut corners = corners.map(|corner| beyond(&plane, &points[*corner as usize]).abs());
                if !taken[other as usize] && corners.all(|distance| distance <= near) {
                    taken[other as usize] = true;
                    open.push(other);
                }
            }
        }
    }
    planes
}

/// The half-spaces in the order that refuses soonest.
fn grouped(simd: Simd, planes: &[Plane], min: &Vector3<f64>, max: &Vector3<f64>) -> Vec<Group> {
    let mut groups = vec![[[0.0; GROUP], [0.0; GROUP], [0.0; GROUP], [1.0; GROUP]]; planes.len().div_ceil(GROUP)];
    for (place, next) in refusal_order(simd, planes, min, max).into_iter().enumerate() {
        for (row, value) in planes[next as usize].into_iter().enumerate() {
            groups[place / GROUP][row][place % GROUP] = value;
        }
    }
    groups
}
