//! Which version of the kernels runs. They are compiled for several SIMD levels and chosen from when they are called.
//!
//! Kernels are the few loops that a search spends its time in: half-space tests, monomials, distances. Each is written
//! once, as plain Rust over lanes of `f64`, and compiled for each level; nothing is `unsafe` and no `target-cpu` is set
//! for the whole program.

/// The version of the kernels to run.
///
/// All versions give the same bits: no product is fused with a sum, lanes have the same number everywhere, and sums
/// keep their order. Tests hold every kernel to it.
///
/// `Portable` rests on the compiler's baseline alone and not on that promise: with it a result can be held against
/// another machine's level by level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Simd {
    /// The widest that this machine has.
    #[default]
    Widest,
    /// The one that every machine of its architecture has.
    Portable,
}

impl Simd {
    /// `portable`, or what the widest is on this machine: `avx512`, `avx2`, `neon` or `baseline`.
    pub fn level(self) -> &'static str {
        match self {
            Simd::Widest => widest(),
            Simd::Portable => "portable",
        }
    }
}

/// Compiles a function for every level, and takes the widest at run time.
macro_rules! at_every_level {
    ($function:item) => {
        #[multiversion::multiversion(targets(
            "x86_64+avx512f+avx512vl+avx512dq+avx512bw+bmi1+popcnt",
            "x86_64+avx2+bmi1+popcnt",
            "aarch64+neon",
        ))]
        $function
    };
}

at_every_level! {
    fn widest() -> &'static str {
        multiversion::target::match_target! {
            "x86_64+avx512f" => "avx512",
            "x86_64+avx2" => "avx2",
            "aarch64+neon" => "neon",
            _ => "baseline",
        }
    }
}

/// A function of these arguments and body, with the [`Simd`] to run it at before them.
macro_rules! kernel {
    ($(#[$attribute:meta])* fn $name:ident($($argument:ident: $type:ty),* $(,)?) { $($body:tt)* }) => {
        $(#[$attribute])*
        fn $name(simd: $crate::math::simd::Simd, $($argument: $type),*) {
            $crate::math::simd::at_every_level! {
                fn widest($($argument: $type),*) { $($body)* }
            }
            fn portable($($argument: $type),*) { $($body)* }
            match simd {
                $crate::math::simd::Simd::Widest => widest($($argument),*),
                $crate::math::simd::Simd::Portable => portable($($argument),*),
            }
        }
    };
}

pub(crate) use {at_every_level, kernel};
