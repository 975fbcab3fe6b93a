#!/bin/sh
# check_no_exceptions.sh: compiles the runtime parts (all that is needed to decode a model and to
# go to its levels) without exceptions and run-time type information, links them with a small
# program and runs it.
set -eu
cd "$(dirname "$0")/.."
out=build/no_exceptions
mkdir -p "$out"

# Of base, mesh and simplify what the runtime uses; of each model everything but its build.
sources="src/varifold/base/checksum.cpp src/varifold/base/parallel.cpp"
sources="$sources src/varifold/mesh/triangle_mesh.cpp src/varifold/mesh/weld.cpp"
sources="$sources src/varifold/mesh/pose_blend.cpp src/varifold/mesh/vertex_arrays.cpp"
sources="$sources src/varifold/simplify/target_tree.cpp"
sources="$sources $(git ls-files 'src/varifold/simplify/sequence_*.cpp' | grep -v sequence_builder)"
sources="$sources $(git ls-files 'src/varifold/view/*.cpp')"
sources="$sources $(git ls-files 'src/varifold/models/*/*.cpp' | grep -v -E '([/_]build[a-z_]*|static_removal|frame_clusters|shape_bounds|step_bounds|watch_bounds)\.cpp$' |
  grep -v -E 'patch_tree/(assemble|border_[a-z]*|component_removal|level_[a-z]*|mean_value_map|patch_errors)\.cpp$')"
sources="$sources tests/runtime/no_exceptions.cpp"

compiler=g++
! command -v ccache >/dev/null 2>&1 || compiler="ccache g++"
objects=""
commands=""
for source in $sources; do
  object=$out/$(echo "$source" | tr '/' '_').o
  objects="$objects $object"
  commands="$commands$source $object
"
done
printf '%s' "$commands" | xargs -P "$(nproc)" -L 1 sh -c "$compiler -std=c++20 -O1 -Wall -Wextra -ffp-contract=off \
  -fno-exceptions -fno-rtti -Isrc -c \"\$0\" -o \"\$1\""
g++ -fno-exceptions -fno-rtti $objects -lxxhash -ltbb -o "$out/no_exceptions"
"$out/no_exceptions"
