//! The SIMD level that the numerics choose on this machine: results carry it.

/// `avx512`, `avx2`, `neon` or `baseline`: the same choice as the kernels' in room `feasibility`.
pub(crate) fn level() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::is_x86_feature_detected as has;
        if has!("avx512f") && has!("avx512vl") && has!("avx512dq") && has!("avx512bw") {
            return "avx512";
        }
        if has!("avx2") {
            return "avx2";
        }
    }
    if cfg!(target_arch = "aarch64") { "neon" } else { "baseline" }
}
