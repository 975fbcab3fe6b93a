#!/bin/sh
# tidy.sh [FILE...]: clang-tidy over the sources of the library and the tool, or over FILEs, with
# the rules of .clang-tidy.
set -eu
cd "$(dirname "$0")/.."
generator=""
[ -f build/tidy/CMakeCache.txt ] || ! command -v ninja >/dev/null 2>&1 || generator="-G Ninja"
cmake --preset tidy $generator >/dev/null
exec python3 cmake/run_tidy.py build/tidy "$@"
