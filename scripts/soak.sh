#!/bin/sh
# Builds with optimisation, flips every bit of small databases, kills commands a hundred times, holds stored
# errors against more than ten million samples an area (five minutes), and 2,000 random views an area against
# cracks, the level contract and the reference engine (hours).
#   scripts/soak.sh [arguments for ctest...]
# DELTAZ_TEST_DATA may name a folder of real files (with dem/ below it); without it synthetic areas
# and the shipped sample alone are taken.
set -eu
cd "$(dirname "$0")/.."
cmake --preset release -DDELTAZ_BUILD_TESTS=ON
cmake --build --preset release --target ars_test dense_sampling_test check_fault_test librender_picture_test librender_test dbbuild dbview dbcheck reseal_area -j "${JOBS:-$(nproc)}"
exec ctest --test-dir build/release -C Soak -L soak --no-tests=error --verbose "$@"
