//! The kernels one by one: `cargo bench -p hairpin`, or one room of them with its name behind it. Tests run each
//! once, so that none goes stale.

mod closed_loop;
mod reach;
mod search;
mod steer;
mod verification;
mod witness;
mod world;

fn main() {
    divan::main();
}
