//! A convex polytope as half-spaces, and the convex hull of points that it is made from.

use nalgebra::Vector3;
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;
use thiserror::Error;

/// Half-spaces per group of the membership test.
const GROUP: usize = 8;

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
        /// Smallest extent over all facet normals, m.
        thickness: f64,
        /// Diagonal of the bounding box, m.
        extent: f64,
    },
    /// The construction of the hull broke down.
    #[error("the convex hull of the end points could not be built: {reason}")]
    Broken {
        /// The library's reason.
        reason: String,
    },
}

/// {x : n_i · x ≤ b_i for every facet i}, |n_i| = 1, with everything asked of it precomputed.
#[derive(Debug, Clone, PartialEq)]
pub struct Polytope {
    /// Rows (nx, ny, nz, b) in groups of eight facets, padded with ones that hold everywhere.
    groups: Vec<[[f64; GROUP]; 4]>,
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
    /// # Errors
    /// [`NoPolytope`].
    pub fn hull(points: &[Vector3<f64>]) -> Result<Self, NoPolytope> {
        if points.len() < 4 || points.iter().any(|p| !p.iter().all(|c| c.is_finite())) {
            return Err(NoPolytope::Points { points: points.len() });
        }
        let (min, max) = bounds(points);
        let extent = (max - min).norm();
        if (max - min).min() < 1e-6 * extent || extent == 0.0 {
            return Err(NoPolytope::Flat { thickness: (max - min).min(), extent });
        }
        let candidates: Vec<Vector> = distinct(points).into_iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
        let (vertices, triangles) =
            try_convex_hull(&candidates).map_err(|error| NoPolytope::Broken { reason: error.to_string() })?;
        let vertices: Vec<Vector3<f64>> = vertices.into_iter().map(|v| Vector3::new(v.x, v.y, v.z)).collect();
        let planes = facets(&vertices, &triangles, points, extent);
        let thickness = planes
            .iter()
            .map(|(n, b)| b - points.iter().map(|p| n.dot(p)).fold(f64::INFINITY, f64::min))
            .fold(f64::INFINITY, f64::min);
        if planes.len() < 4 || thickness < 1e-6 * extent {
            return Err(NoPolytope::Flat { thickness, extent });
        }
        let centre = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
        let volume = triangles
            .iter()
            .map(|t| t.map(|i| vertices[i as usize] - centre))
            .map(|[a, b, c]| a.dot(&b.cross(&c)).abs() / 6.0)
            .sum();
        Ok(Self { groups: grouped(&planes, extent), facets: planes.len(), vertices, min, max, volume })
    }

    /// Whether n_i · x ≤ b_i for all facets.
    #[inline]
    pub fn contains(&self, x: &Vector3<f64>) -> bool {
        self.groups.iter().all(|[nx, ny, nz, b]| {
            let mut holds = true;
            for i in 0..GROUP {
                holds &= nx[i] * x.x + ny[i] * x.y + nz[i] * x.z <= b[i];
            }
            holds
        })
    }

    /// max n · x over the polytope, m: its support in direction `n`.
    pub fn support(&self, n: &Vector3<f64>) -> f64 {
        self.vertices.iter().map(|v| n.dot(v)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Number of facets after merging.
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

fn bounds(points: &[Vector3<f64>]) -> (Vector3<f64>, Vector3<f64>) {
    let mut min = Vector3::repeat(f64::INFINITY);
    let mut max = -min;
    for p in points {
        min = min.inf(p);
        max = max.sup(p);
    }
    (min, max)
}

/// The points, each once: symmetric runs end in the same place by the dozen.
fn distinct(points: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut kept: Vec<Vector3<f64>> = points.to_vec();
    kept.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    kept.dedup();
    kept
}

/// One plane per set of coplanar triangles, each holding all `points`.
fn facets(
    vertices: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    points: &[Vector3<f64>],
    extent: f64,
) -> Vec<(Vector3<f64>, f64)> {
    let mut with_area: Vec<(f64, Vector3<f64>, f64)> = triangles
        .iter()
        .filter_map(|t| {
            let [a, b, c] = t.map(|i| vertices[i as usize]);
            let normal = (b - a).cross(&(c - a));
            let area = normal.norm();
            // A sliver's normal is noise; its neighbours hold its edge.
            (area > 1e-12 * extent * extent).then(|| (area, normal / area, normal.dot(&a) / area))
        })
        .collect();
    // Large triangles have the best normals, so they stand for their plane.
    with_area.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut planes: Vec<(Vector3<f64>, f64)> = Vec::new();
    for (_, normal, offset) in with_area {
        if !planes.iter().any(|(n, b)| (n - normal).norm_squared() < 1e-14 && (b - offset).abs() < 1e-7 * extent) {
            planes.push((normal, offset));
        }
    }
    for (normal, offset) in &mut planes {
        *offset = points.iter().map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max);
    }
    planes
}

/// The planes in the order that refuses soonest: each the farthest in direction from all before it.
fn grouped(planes: &[(Vector3<f64>, f64)], extent: f64) -> Vec<[[f64; GROUP]; 4]> {
    let mut nearest = vec![f64::INFINITY; planes.len()];
    let mut groups = vec![[[0.0; GROUP], [0.0; GROUP], [0.0; GROUP], [1.0; GROUP]]; planes.len().div_ceil(GROUP)];
    let mut next = 0;
    for place in 0..planes.len() {
        let (normal, offset) = planes[next];
        let group = &mut groups[place / GROUP];
        for (row, value) in [normal.x, normal.y, normal.z, offset + 1e-13 * extent].into_iter().enumerate() {
            group[row][place % GROUP] = value;
        }
        nearest[next] = -1.0;
        for (distance, (other, _)) in nearest.iter_mut().zip(planes) {
            *distance = distance.min((other - normal).norm_squared());
        }
        next = (0..planes.len()).max_by(|a, b| nearest[*a].total_cmp(&nearest[*b]).then(b.cmp(a))).unwrap_or(0);
    }
    groups
}
