#!/bin/sh
# Sets everything up, builds with warnings as errors and runs all tests.
#   scripts/test.sh [arguments for ctest...]
# DELTAZ_TEST_DATA may name a folder of further real files (with dem/ below it); without it samples/ alone is used.
# JOBS is the number of compilers and tests at a time (all processors).
set -eu
cd "$(dirname "$0")/.."
jobs=${JOBS:-$(nproc)}

scripts/setup.sh test
cmake --preset ci
cmake --build --preset ci -j "$jobs"

# ctest's own verdict is kept while its log is searched for the tests' "real files" lines.
log=build/ci/test.log
status=0
ctest --test-dir build/ci --output-on-failure --no-tests=error -j "$jobs" "$@" || status=$?
cp build/ci/Testing/Temporary/LastTest.log "$log"
echo "real files: $(sed -n 's/^real file: //p' "$log" | sort -u | wc -l)"
sed -n 's/^real file: /  /p' "$log" | sort -u
exit $status
