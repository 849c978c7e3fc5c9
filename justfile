# Short names for the commands of the README and of CONTRIBUTING.

# Everything a change must pass.
test:
    tests/run

# The quick part of it.
check:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
    cargo test --workspace
    cargo deny check

demo:
    cargo run --release -p hairpin-cli -- demo

# The table of targets, measured on one core.
bench:
    cargo run --release -p hairpin-cli -- bench

# The kernels, one by one.
kernels:
    cargo bench -p hairpin
