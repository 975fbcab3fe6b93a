#!/bin/sh
# build_preset.sh PRESET [TARGET...]: configures and builds a preset, with Ninja where present.
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift
# Lets checkouts share what ccache has compiled.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1
generator=""
[ -f "build/$preset/CMakeCache.txt" ] || ! command -v ninja >/dev/null 2>&1 || generator="-G Ninja"
cmake --preset "$preset" $generator >/dev/null
if [ $# -gt 0 ]; then
  cmake --build --preset "$preset" --parallel "$(nproc)" --target "$@"
else
  cmake --build --preset "$preset" --parallel "$(nproc)"
fi
