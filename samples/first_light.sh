#!/bin/sh
# First light: from nothing to a database of Mount Rainier, a picture of it and a proof that it is right.
#   samples/first_light.sh [OUTPUT_FOLDER]      (default: build/first_light)
# Installs what is missing, builds the three tools (release) if they are not built, then runs each once.
set -eu
cd "$(dirname "$0")/.."
output=${1:-build/first_light}
tools=build/release/tools

scripts/setup.sh build
if [ ! -f build/release/CMakeCache.txt ]; then
  cmake --preset release -DDELTAZ_BUILD_TESTS=OFF -DDELTAZ_BUILD_BENCHMARKS=OFF
fi
cmake --build --preset release --target dbbuild dbview dbcheck

mkdir -p "$output"
$tools/dbbuild/dbbuild terrain samples/mt_rainier.tif -o "$output/mt_rainier.dz" --overwrite
$tools/dbview/dbview "$output/mt_rainier.dz" -o "$output/mt_rainier.png" --overwrite
$tools/dbcheck/dbcheck "$output/mt_rainier.dz" --level all --against samples/mt_rainier.tif

echo
echo "database: $output/mt_rainier.dz"
echo "picture:  $output/mt_rainier.png"
echo "tools:    $tools/dbbuild/dbbuild, $tools/dbview/dbview, $tools/dbcheck/dbcheck"
