#!/usr/bin/env bash
# usage: build_wheel.sh BUILD-FOLDER SOURCE-FOLDER PYTHON
# `pip install .` with what is installed here and no network, of a copy of the sources, with the module of the build; then the
# package is imported from where pip put it. And an sdist, which holds all that CMake needs.
set -euo pipefail
build=$1
source=$2
python=$3
for needed in pip setuptools wheel; do
  "$python" -c "import $needed" 2> /dev/null || { echo "skipped: no Python package $needed"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/source"
cp -r "$source"/{CMakeLists.txt,README.md,LICENSE,pyproject.toml,setup.py,python,scenarios} "$work/source"
GLIDELAB_BUILD=$build "$python" -m pip install --no-index --no-build-isolation --no-deps --disable-pip-version-check \
  --root-user-action=ignore --target "$work/installed" "$work/source" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cd "$work"
said=$(PYTHONPATH=$work/installed "$python" -c "
import glidelab, importlib.metadata
print(glidelab.__file__, importlib.metadata.version('glidelab'), len(glidelab.bandwidth_rules()) > 3)")
version=$(sed -n 's/^project(glidelab VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
[ "$said" = "$work/installed/glidelab/__init__.py $version True" ] || { echo "said $said"; exit 1; }
for file in py.typed _glidelab.pyi; do
  [ -e "$work/installed/glidelab/$file" ] || { echo "not installed: $file"; exit 1; }
done
said=$(PYTHONPATH=$work/installed "$python" -c "import glidelab; print(glidelab.scenarios_folder())")
[ "$said" = "$work/installed/glidelab/scenarios" ] || { echo "the scenarios are in $said"; exit 1; }
diff -r "$source/scenarios" "$said"
# The bound on numpy is that of the pybind11 that made the module.
PYTHONPATH=$work/installed "$python" -c "
import glidelab._glidelab, importlib.metadata
said = [one for one in importlib.metadata.requires('glidelab') if 'extra' not in one]
assert len(said) == 1 and said[0].startswith('numpy'), said
assert '>=1.24' in said[0] and ('<2' in said[0]) == (glidelab._glidelab.pybind11_version < (2, 12)), said"

# What CMake reads lies in the sdist, and is configured there.
mkdir "$work/whole"
cp -r "$source"/{CMakeLists.txt,CMakePresets.json,MANIFEST.in,README.md,CHANGELOG.md,CITATION.cff,LICENSE,pyproject.toml,setup.py} \
  "$source"/{cmake,scenarios,base,core,sim,render,fit,diagnose,validate,teach,report,app,python} "$work/whole"
cd "$work/whole"
GLIDELAB_BUILD=$build "$python" -c "from setuptools import build_meta; build_meta.build_sdist('$work/sdist')" > "$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
mkdir "$work/unpacked"
tar -xzf "$work"/sdist/glidelab-"$version".tar.gz -C "$work/unpacked" --strip-components=1
while read -r file; do
  cmp -s "$file" "$work/unpacked/$file" || { echo "not in the sdist: $file"; exit 1; }
done < <(find . -type f ! -path '*/__pycache__/*' ! -path '*.egg-info/*' -printf '%P\n')
cmake -S "$work/unpacked" -B "$work/configured" -DGLIDELAB_TESTS=OFF -DGLIDELAB_BENCH=OFF -DGLIDELAB_PYTHON=ON \
  -DPython_EXECUTABLE="$python" > "$work/log" 2>&1 || { tail -n 20 "$work/log"; exit 1; }
