#!/bin/sh
# Formats every C++ file of the repository; with --check only says which files differ, and fails if any does.
set -eu
cd "$(dirname "$0")/.."
mode="-i"
[ "${1:-}" = "--check" ] && mode="--dry-run --Werror"
find formats libdb librender tools tests -name '*.h' -o -name '*.cpp' | sort | xargs clang-format $mode
