#!/usr/bin/env bash
# usage: build_example.sh BUILD-FOLDER SOURCE-FOLDER
# Installs the build into a folder of its own, builds examples/predict with nothing but that, and runs it.
set -euo pipefail
build=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/installed" > "$work/log" || { cat "$work/log"; exit 1; }
for file in bin/glidelab share/man/man1/glidelab.1.gz share/bash-completion/completions/glidelab \
            share/glidelab/scenarios/paper/inclined.toml; do
  [ -s "$work/installed/$file" ] || { echo "not installed: $file"; exit 1; }
done
cp -r "$source/examples/predict" "$work/predict"  # away from the tree: it finds no header there
cmake -S "$work/predict" -B "$work/built" -DCMAKE_PREFIX_PATH="$work/installed" -DCMAKE_BUILD_TYPE=Release > "$work/log" 2>&1 &&
  cmake --build "$work/built" >> "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/built/predict" > "$work/said"
cat "$work/said"
# The kernel's bias is taken off up to some 1e-4 of K/m (docs/guide/estimators.md); without noise nothing else is left.
awk '/^true K\/m/ { truth = $3 } /^recovered K\/m/ { found = $3 }
     END { exit !(truth > 0 && found > 0 && (found / truth - 1) ^ 2 < 0.0005 ^ 2) }' "$work/said"
