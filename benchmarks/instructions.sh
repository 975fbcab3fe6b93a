#!/bin/sh
# instructions.sh [update]: counts the instructions of a small fixed job under callgrind and fails
# where a part of it needs over 5 % more than benchmarks/instructions.txt says. With `update` the
# counts are written there. Counts depend on the compiler, so others than the one that is named
# there are only shown.
set -eu
cd "$(dirname "$0")/.."
counts=benchmarks/instructions.txt
mode=${1:-}
command -v valgrind >/dev/null 2>&1 || { echo "no valgrind: instructions not counted"; exit 0; }
sh cmake/build_preset.sh bench varifold_instructions >/dev/null

compiler="g++ $(g++ -dumpfullversion), $(uname -m)"
known=$(sed -n 's/^# compiler: //p' "$counts" 2>/dev/null || true)
out=build/bench/instructions
mkdir -p "$out"
status=0
echo "# compiler: $compiler" >"$out/counts.txt"

# count NAME FUNCTION: the instructions inside of all calls of FUNCTION.
count() {
  valgrind --tool=callgrind --collect-atstart=no --toggle-collect="$2" \
    --callgrind-out-file="$out/$1.callgrind" build/bench/bin/varifold_instructions \
    >"$out/$1.log" 2>&1 || { cat "$out/$1.log"; exit 1; }
  now=$(sed -n 's/^\(summary\|totals\): //p' "$out/$1.callgrind" | head -1)
  echo "$1 $now" >>"$out/counts.txt"
  before=$(sed -n "s/^$1 //p" "$counts" 2>/dev/null || true)
  echo "$1: $now instructions, known: ${before:-nothing}"
  [ "${now:-0}" -gt 0 ] || { echo "$1: nothing was counted" >&2; status=1; return 0; }
  [ "$compiler" = "$known" ] && [ -n "$before" ] || return 0
  if [ "$mode" != update ] && [ $((now * 100)) -gt $((before * 105)) ]; then
    echo "$1 needs over 5 % more instructions than $counts says" >&2
    status=1
  fi
}

count simplify 'varifold::simplify(*const&)'
count measure_deviation 'varifold::measure_deviation(*const&)'
count build_progressive_mesh 'varifold::build_progressive_mesh(*const&)'
count go_to_level 'varifold::ProgressiveMeshInstance::go_to_level(unsigned int)'
count build_block_form 'varifold::build_block_form(*)'
count lod_strips_go_to_level 'varifold::LodStripsInstance::go_to_level(unsigned int)'
count build_view_dependent_mesh 'varifold::build_view_dependent_mesh(*)'
count adapt_front 'varifold::ViewFront::adapt(*)'
count build_patch_tree 'varifold::build_patch_tree(*)'
count adapt_patch_front 'varifold::PatchFront::adapt(*)'
[ "$compiler" = "$known" ] || echo "$counts is of another compiler: ${known:-none}"
if [ "$mode" = update ]; then
  cp "$out/counts.txt" "$counts"
  exit 0
fi
[ $status -eq 0 ] || echo "if that is meant: sh benchmarks/instructions.sh update" >&2
exit $status
