#!/bin/sh
# Runs clang-tidy over the sources (all, or those named) with the compile commands of the dev preset (clang cannot read GCC's
# precompiled headers).
set -eu
cd "$(dirname "$0")/.."
[ -f build/dev/compile_commands.json ] || cmake --preset dev
if [ $# -gt 0 ]; then
  printf '%s\n' "$@"
else
  find formats libdb librender tools -name '*.cpp' | sort
fi | xargs -P "$(nproc)" -n 1 clang-tidy --quiet --extra-arg=-Wno-unknown-warning-option -p build/dev
