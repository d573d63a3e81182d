#!/bin/sh
# Builds with optimisation and holds stored errors against ten million samples an area: about an hour.
#   scripts/soak.sh [arguments for ctest...]
# DELTAZ_TEST_DATA may name a folder of real files (with dem/ below it); without it synthetic areas alone are sampled.
set -eu
cd "$(dirname "$0")/.."
cmake --preset release -DDELTAZ_BUILD_TESTS=ON
cmake --build --preset release --target dense_sampling_test -j "${JOBS:-$(nproc)}"
exec ctest --test-dir build/release -C Soak -L soak --no-tests=error --verbose "$@"
