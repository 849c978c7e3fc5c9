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

# What a change is most likely to break, without network, in three minutes once all is built: of the whole workspace, for
# packages by themselves have dependencies with other features, built for minutes.
quick:
    cargo fmt --all --check
    cargo clippy --workspace --lib --bins --offline -- -D warnings
    cargo test --workspace --lib --test unit --test layers --offline

# A hundred thousand spoiled inputs for each reader; HAIRPIN_FUZZ_SEED makes them others.
fuzz:
    HAIRPIN_FUZZ=100000 cargo test --release -p hairpin-formats --test fuzz -p hairpin-jobs --test fuzz_certificates

# The pages of every kind of robot, of logs and of comparisons as pictures in FOLDER, to look at.
pictures FOLDER:
    tests/browser/pictures {{FOLDER}}

demo:
    cargo run --release -p hairpin-cli -- demo

# The table of targets, measured on one core.
bench:
    cargo run --release -p hairpin-cli -- bench

# The kernels, one by one.
kernels:
    cargo bench -p hairpin

# Wheels into target/wheels for Linux with glibc 2.17 and later; each architecture needs its `rustup target add`.
wheels *targets="x86_64-unknown-linux-gnu":
    python3 -m venv target/wheel-tools
    target/wheel-tools/bin/pip install --quiet 'maturin>=1.9,<2' 'ziglang<0.18' 'auditwheel<7'
    for target in {{targets}}; do \
      PATH="$PWD/target/wheel-tools/bin:$PATH" maturin build --release --zig --compatibility manylinux_2_17 --target "$target" --out target/wheels || exit 1; \
    done
    for wheel in target/wheels/*.whl; do target/wheel-tools/bin/auditwheel show "$wheel" || exit 1; done
