#!/bin/sh
# Sets everything up, builds with warnings as errors and runs all tests.
#   scripts/test.sh [arguments for ctest...]
# DELTAZ_TEST_DATA may name a folder of further real files (with dem/ below it); without it samples/ alone is used.
# JOBS is the number of compilers and tests at a time (as many as there are processors and gigabytes for them).
set -eu
cd "$(dirname "$0")/.."
# A compiler of several files takes up to a gigabyte; half as much again is left for the linker and the rest.
fits=$(awk '/^MemAvailable:/ { print int($2 / 1500000) }' /proc/meminfo 2>/dev/null) || fits=""
jobs=$(nproc)
if [ -n "$fits" ] && [ "$fits" -lt "$jobs" ]; then jobs=$fits; fi
if [ "$jobs" -lt 1 ]; then jobs=1; fi
jobs=${JOBS:-$jobs}

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
