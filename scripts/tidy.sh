#!/bin/sh
# Runs clang-tidy over the sources (all, or those named) with the compile commands of the ci preset.
set -eu
cd "$(dirname "$0")/.."
[ -f build/ci/compile_commands.json ] || cmake --preset ci
if [ $# -gt 0 ]; then
  printf '%s\n' "$@"
else
  find formats libdb librender tools -name '*.cpp' | sort
fi | xargs -P "$(nproc)" -n 1 clang-tidy --quiet --extra-arg=-Wno-unknown-warning-option -p build/ci
