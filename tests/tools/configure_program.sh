#!/usr/bin/env bash
# usage: configure_program.sh SOURCE-FOLDER
# What tools/demo configures on a machine that has packages.txt alone: neither Catch2 nor Google Benchmark.
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
configure() {
  cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_FIND_PACKAGE_Catch2=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON "$@" > "$work/said" 2>&1
}

# The options are those of the script itself, and the demo does use them.
mapfile -t options < <(bash -c ". '$source/tools/setup.sh'; printf '%s\n' \"\${program_only[@]}\"")
grep -qx 'with=("${program_only\[@\]}")' "$source/tools/demo"
configure "${options[@]}" || { cat "$work/said"; exit 1; }
ninja -C "$work/build" -t query app/glidelab > /dev/null

# With the tests it cannot be, or this test would notice nothing.
! configure -DGLIDELAB_TESTS=ON
grep -q Catch2 "$work/said"
