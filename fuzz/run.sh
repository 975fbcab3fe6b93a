#!/bin/sh
# run.sh [SECONDS [TARGET...]]: builds the fuzz targets and runs each for SECONDS (default 60) on
# seeds that the project writes itself and on what earlier runs have found. An input that breaks a
# target is left in build/fuzz/findings, and the exit status is 1.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:-60}
[ $# -eq 0 ] || shift
targets=${*:-ply obj stl gltf glb container progressive_mesh mts lodstrips framestrips strips vdpm patch_tree camera_path deformation}
sh cmake/build_preset.sh fuzz fuzz_seeds $(printf "fuzz_%s " $targets)

build=build/fuzz
"$build/bin/fuzz_seeds" "$build/seeds"
mkdir -p "$build/findings"
status=0
for target in $targets; do
  mkdir -p "$build/corpus/$target"
  echo "== $target, $seconds s"
  "$build/bin/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=3072 \
    -max_len=65536 -print_final_stats=1 -artifact_prefix="$build/findings/$target-" \
    "$build/corpus/$target" "$build/seeds/$target" >"$build/$target.log" 2>&1 || status=1
  grep -E 'ERROR|SUMMARY|stat::number_of_executed|Test unit written' "$build/$target.log" || true
done
exit $status
