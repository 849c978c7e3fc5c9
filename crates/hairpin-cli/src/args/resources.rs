//! How the machine is used.

use clap::Args;
use hairpin_jobs::bounds;

/// Threads of the computation.
#[derive(Debug, Args)]
pub(crate) struct Threads {
    /// Threads; all cores if not given. The results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(bounds::THREADS))]
    pub(crate) threads: Option<u16>,
}

/// The version of the kernels.
#[derive(Debug, Args)]
pub(crate) struct Kernels {
    /// Run all kernels at one SIMD level that every machine has, and record `portable` as the campaign's level: it goes
    /// on on any machine. The results are those of every other level, bit for bit; it is only slower
    #[arg(long)]
    pub(crate) portable: bool,
}
