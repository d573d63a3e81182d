#!/bin/sh
# Installs the Debian 12 packages that are missing, and no others.
#   scripts/setup.sh build    what building and running the tools needs
#   scripts/setup.sh test     that, and what the tests need (the default)
#   scripts/setup.sh style    what scripts/format.sh and scripts/tidy.sh need
# Runs as root, or with sudo; never asks. Where everything is there it touches nothing and needs no rights.
set -eu

build_packages="g++ cmake ninja-build pkg-config libgdal-dev libproj-dev libcgal-dev libgeographiclib-dev libpng-dev libtiff-dev libcli11-dev
  libtbb-dev libhwy-dev libxxhash-dev libzstd-dev nlohmann-json3-dev libtomlplusplus-dev libopenmesh-dev libassimp-dev libfmt-dev scdoc"
test_packages="libgtest-dev librapidcheck-dev gdal-bin python3 python3-gdal python3-jsonschema"
style_packages="clang-format clang-tidy"

case "${1:-test}" in
  build) wanted="$build_packages" ;;
  test) wanted="$build_packages $test_packages" ;;
  style) wanted="$build_packages $style_packages" ;;
  *) echo "setup.sh: error: '$1' is none of build, test, style" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null 2>&1; then
  echo "setup.sh: not a Debian system; wanted are the equivalents of:" $wanted >&2
  exit 0
fi

missing=""
for package in $wanted; do
  status=$(dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | sort -u | head -n 1) || status=""
  [ "$status" = "installed" ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
  as_root=""
elif command -v sudo >/dev/null 2>&1; then
  as_root="sudo -n"
else
  echo "setup.sh: error: missing packages, and neither root nor sudo; install:$missing" >&2
  exit 3
fi

echo "setup.sh: installing:$missing"
$as_root apt-get update -q
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
