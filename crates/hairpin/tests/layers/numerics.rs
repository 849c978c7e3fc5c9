//! What the numerics never touch, and what nothing that is counted may be computed with.

use super::floors::starts_with;
use super::house::File;
use super::seen::Seen;

/// What the numerics never touch outside tests: files, the clock, the process, threads, printing, global randomness.
const OUTSIDE: &[&str] = &[
    "std::fs",
    "std::env",
    "std::process",
    "std::net",
    "std::thread",
    "std::io",
    "std::time::Instant",
    "std::time::SystemTime",
    "rand::rng",
    "rand::random",
    "println!",
    "print!",
    "eprintln!",
    "eprint!",
    "dbg!",
];

/// What may give other bits on another machine: what the standard library leaves to the machine's C library or to the
/// compiler, and products that only some machines fuse with a sum. `libm` and `math::power` give the same everywhere.
const MACHINE_DEPENDENT: &[&str] = &[
    "sin", "cos", "sin_cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "powi", "cbrt", "hypot", "mul_add",
];

/// Functions of nalgebra and of other libraries that call those.
const MACHINE_DEPENDENT_ABOVE: &[&str] = &[
    ".angle",
    ".angle_to",
    ".euler_angles",
    ".scaled_axis",
    ".axis_angle",
    ".slerp",
    ".try_slerp",
    ".lerp_slerp",
    ".try_lerp_slerp",
    ".rotation_to",
    ".powf",
    ".svd",
    ".symmetric_eigen",
    "UnitQuaternion::new",
    "Rotation3::new",
    "UnitQuaternion::from_euler_angles",
    "UnitQuaternion::from_axis_angle",
    "UnitQuaternion::from_scaled_axis",
    "UnitQuaternion::rotation_between",
    "Rotation3::from_euler_angles",
    "Rotation3::from_axis_angle",
    "Rotation3::rotation_between",
    "statrs",
];

/// Modules whose numbers are only looked at.
pub(crate) const SHOWN: &[&str] =
    &["hairpin::campaign::kind::solid", "hairpin::campaign::report", "hairpin_formats::report", "hairpin_lab::bench"];

/// Why `file` must not have `path` outside of tests.
pub(crate) fn breach(file: &File, path: &Seen) -> Option<String> {
    if path.in_test {
        return None;
    }
    outside(file, path).or_else(|| machine_dependent(file, path))
}

fn outside(file: &File, path: &Seen) -> Option<String> {
    (starts_with(&file.module, "hairpin") && OUTSIDE.iter().any(|forbidden| starts_with(&path.path, forbidden)))
        .then(|| "the numerics know no files, clock, process, threads, printing or global randomness".to_owned())
}

fn machine_dependent(file: &File, path: &Seen) -> Option<String> {
    let shown = SHOWN.iter().any(|module| starts_with(&file.module, module));
    let name = path.path.strip_prefix('.').or(path.path.strip_prefix("f64::")).or(path.path.strip_prefix("f32::"));
    let wrong = name.is_some_and(|name| MACHINE_DEPENDENT.contains(&name))
        || MACHINE_DEPENDENT_ABOVE.iter().any(|above| starts_with(&path.path, above));
    (wrong && !shown).then(|| "its bits depend on the machine: take libm or math::power".to_owned())
}
