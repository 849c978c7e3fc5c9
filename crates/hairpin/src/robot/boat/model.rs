//! Inertia, Coriolis and centripetal forces and damping of a boat.

use nalgebra::Vector3;

use crate::math::power::square;

/// M = [[a, 0, 0], [0, b, c], [0, c, d]]: rigid body and added mass, symmetric about the hull's middle plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// a = m − X_u̇, kg.
    pub surge: f64,
    /// b = m − Y_v̇, kg.
    pub sway: f64,
    /// c = m x_g − Y_ṙ, kg·m.
    pub sway_yaw: f64,
    /// d = I_z − N_ṙ, kg·m².
    pub yaw: f64,
}

/// The derivatives of damping, in the letters of the field: Y_{|r|v} is `y_rv`. All of them as they are published,
/// mostly negative.
///
/// ```text
/// X_D = (X_u + X_{|u|u} |u| + X_{uuu} u²) u
/// Y_D = (Y_v + Y_{|v|v} |v| + Y_{|r|v} |r|) v + (Y_r + Y_{|v|r} |v| + Y_{|r|r} |r|) r
/// N_D = (N_v + N_{|v|v} |v| + N_{|r|v} |r|) v + (N_r + N_{|v|r} |v| + N_{|r|r} |r|) r
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// X_u, X_{|u|u}, X_{uuu}: kg/s, kg/m, kg·s/m².
    pub surge: [f64; 3],
    /// Of v in Y: Y_v, Y_{|v|v}, Y_{|r|v}: kg/s, kg/m, kg.
    pub sway_by_sway: [f64; 3],
    /// Of r in Y: Y_r, Y_{|v|r}, Y_{|r|r}: kg·m/s, kg, kg·m.
    pub sway_by_yaw: [f64; 3],
    /// Of v in N: N_v, N_{|v|v}, N_{|r|v}: kg·m/s, kg, kg·m.
    pub yaw_by_sway: [f64; 3],
    /// Of r in N: N_r, N_{|v|r}, N_{|r|r}: kg·m²/s, kg·m, kg·m².
    pub yaw_by_yaw: [f64; 3],
}

impl Inertia {
    /// M ν.
    pub fn times(&self, nu: &Vector3<f64>) -> Vector3<f64> {
        let Self { surge, sway, sway_yaw, yaw } = self;
        Vector3::new(surge * nu.x, sway * nu.y + sway_yaw * nu.z, sway_yaw * nu.y + yaw * nu.z)
    }

    /// C(ν) ν, N and N·m: (−p_v r, p_u r, p_v u − p_u v) with the momenta p = M ν.
    pub fn coriolis(&self, nu: &Vector3<f64>) -> Vector3<f64> {
        let p = self.times(nu);
        Vector3::new(-p.y * nu.z, p.x * nu.z, p.y * nu.x - p.x * nu.y)
    }

    /// M⁻¹ τ.
    pub fn solve(&self, force: &Vector3<f64>) -> Vector3<f64> {
        let Self { surge, sway, sway_yaw, yaw } = self;
        let determinant = self.determinant();
        let v = (yaw * force.y - sway_yaw * force.z) / determinant;
        let r = (sway * force.z - sway_yaw * force.y) / determinant;
        Vector3::new(force.x / surge, v, r)
    }

    /// Of sway and yaw together, kg²·m²; > 0 where M is an inertia.
    pub(super) fn determinant(&self) -> f64 {
        self.sway * self.yaw - square(self.sway_yaw)
    }
}

impl Damping {
    /// D(ν) ν, N and N·m: what thrust has to overcome.
    pub fn force(&self, nu: &Vector3<f64>) -> Vector3<f64> {
        let of = |k: &[f64; 3]| k[0] + k[1] * nu.y.abs() + k[2] * nu.z.abs();
        Vector3::new(
            self.resistance(nu.x),
            -of(&self.sway_by_sway) * nu.y - of(&self.sway_by_yaw) * nu.z,
            -of(&self.yaw_by_sway) * nu.y - of(&self.yaw_by_yaw) * nu.z,
        )
    }

    /// Of surge alone, N.
    pub fn resistance(&self, u: f64) -> f64 {
        let [linear, quadratic, cubic] = self.surge;
        -(linear + quadratic * u.abs() + cubic * square(u)) * u
    }
}
