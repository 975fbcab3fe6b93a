#!/bin/sh
# build_preset.sh PRESET [TARGET...]: configures and builds a preset, with Ninja where present.
set -eu
preset=$1
shift
generator=""
[ -f "build/$preset/CMakeCache.txt" ] || ! command -v ninja >/dev/null 2>&1 || generator="-G Ninja"
cmake --preset "$preset" $generator >/dev/null
if [ $# -gt 0 ]; then
  cmake --build --preset "$preset" --parallel "$(nproc)" --target "$@"
else
  cmake --build --preset "$preset" --parallel "$(nproc)"
fi
