#!/usr/bin/env bash
# Compiles crates/trove-trace for graphics cards: `packaging/ptx.sh` writes crates/trove-render/src/card/trace.ptx, and with
# `--check` compares. It takes stock rustc and the source of core: `rustup component add rust-src`, or RUST_SRC, the folder
# `library` of the same version's source.
set -euo pipefail
cd "$(dirname "$0")/.."
kept=crates/trove-render/src/card/trace.ptx

compiler="$(rustc --version | cut -d' ' -f2)"
source="${RUST_SRC:-$(rustc --print sysroot)/lib/rustlib/src/rust/library}"
if [ "${1:-}" = --check ]; then
    why=
    [ -d "$source/core" ] || why="the source of core is not here"
    grep -q "^// rustc $compiler\$" "$kept" || why="it was made by another rustc than $compiler"
    if [ -n "$why" ]; then
        echo "$kept: not compiled again, since $why"
        exit 0
    fi
fi

out="$(mktemp -d)"
trap 'rm -rf "$out"' EXIT
# A card multiplies and adds in one step where it may: without that its answers are the processor's to the last bit.
RUSTC_BOOTSTRAP=1 __CARGO_TESTS_ONLY_SRC_ROOT="$source" CARGO_TARGET_DIR="${PTX_TARGET:-$out}" \
RUSTFLAGS="-Clinker=true -Ctarget-cpu=sm_75 -Cpanic=immediate-abort -Zunstable-options -Zcross-crate-inline-threshold=always -Cllvm-args=-nvptx-fma-level=0" \
    cargo rustc --quiet --locked --release -p trove-trace --target nvptx64-nvidia-cuda -Zbuild-std=core \
    --crate-type cdylib -- --emit=asm="$out/trace.s"
{
    echo "// crates/trove-trace for graphics cards, written by \`make ptx\`."
    echo "// rustc $compiler"
    echo "// glam $(grep -A1 '^name = "glam"' Cargo.lock | sed -n 's/^version = "\(.*\)"/\1/p')"
    echo "// sources $(find crates/trove-trace -name Cargo.toml -o -name "*.rs" ! -name tests.rs | LC_ALL=C sort | xargs cat | sha256sum | cut -c1-16)"
    sed 's/[[:space:]]*$//' "$out/trace.s" | cat -s
} > "$out/trace.ptx"
if [ "${1:-}" = --check ]; then
    cmp "$out/trace.ptx" "$kept" || { echo "$kept is not what crates/trove-trace gives: run make ptx"; exit 1; }
else
    cp "$out/trace.ptx" "$kept"
fi
