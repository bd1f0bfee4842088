#!/usr/bin/env bash
# usage: build_deb.sh BUILD-FOLDER SOURCE-FOLDER
# Packs the build as a Debian package, reads what dpkg says of it, and runs the program from where it was unpacked.
set -euo pipefail
build=$1
source=$2
has() { command -v "$1" > /dev/null; }
skip() { echo "$1"; exit 77; }
has cpack || skip "skipped: no cpack program"
has dpkg-deb || skip "skipped: no dpkg-deb program"
has dpkg-shlibdeps || skip "skipped: no dpkg-shlibdeps program"
has file || skip "skipped: no file program"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }

cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/packed" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
packages=("$work"/packed/glidelab_*.deb)
[ "${#packages[@]}" -eq 1 ] || fail "not one package of the program: $(ls "$work/packed")"
deb=${packages[0]}

# What apt reads: the build's own version, this machine's architecture, what the program is linked to and what it runs.
version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")/\1/p' "$build/CPackConfig.cmake")
architecture=$(dpkg --print-architecture)
field() { dpkg-deb --field "$deb" "$1"; }
[ "$(field Package) $(field Version) $(field Architecture)" = "glidelab $version $architecture" ] ||
  fail "the package says it is $(field Package) $(field Version) $(field Architecture)"
[ "$(basename "$deb")" = "glidelab_${version}_$architecture.deb" ] || fail "named $(basename "$deb")"
for needed in gnuplot libopencv-core libsundials libosmesa libc6; do
  field Depends | grep -q "$needed" || fail "does not depend on $needed: $(field Depends)"
done

# Nothing that is not root's, that others may write, or that lies outside /usr.
dpkg-deb --contents "$deb" > "$work/contents"
awk '$2 != "root/root" || substr($1, 9, 1) == "w" && substr($1, 1, 1) != "l" || $6 !~ /^\.\/(usr\/.*)?$/' "$work/contents" > "$work/bad"
[ ! -s "$work/bad" ] || { cat "$work/bad"; exit 1; }

dpkg-deb --extract "$deb" "$work/root"
usr=$work/root/usr
for name in bin/glidelab share/man/man1/glidelab.1.gz share/bash-completion/completions/glidelab \
            share/zsh/vendor-completions/_glidelab share/glidelab/scenarios/tutorial.toml share/doc/glidelab/README.md \
            share/doc/glidelab/copyright share/doc/glidelab/docs/guide/tutorial.md share/doc/glidelab/docs/evidence/peers.svg; do
  [ -s "$usr/$name" ] || fail "not in the package: $name"
done
diff -r "$source/scenarios" "$usr/share/glidelab/scenarios" || fail "the scenarios are not those of the source"

# Every file that a page of the documentation points to or shows lies where it says.
while read -r page; do
  while read -r target; do
    [ -e "$(dirname "$page")/$target" ] || fail "${page#"$usr"/} points to $target, which is not in the package"
  done < <(grep -o '](\([^)]*\))' "$page" | sed 's/^](//; s/)$//; s/#.*//' | grep -v '^[a-z]*:' | grep . || true)
done < <(find "$usr/share/doc/glidelab" -name '*.md')

# From elsewhere, with nothing of the source or the build in sight.
cd "$work"
program=$usr/bin/glidelab
"$program" --version > said
grep -q "^glidelab $version" said || { cat said; fail "its --version is not $version"; }
"$program" pattern -q -o sheets
[ "$(head -c 5 sheets/chessboard.pdf)" = "%PDF-" ] || fail "no chessboard"
"$program" simulate "$usr/share/glidelab/scenarios/tutorial.toml" -q -o simulated
ls simulated/trajectory-*.csv > /dev/null
gunzip -c "$usr/share/man/man1/glidelab.1.gz" | grep -q '^\.TH GLIDELAB 1' || fail "no manual page"
completed=$(bash -c 'source "$1"; COMP_WORDS=(glidelab simul) COMP_CWORD=1; _glidelab; echo "${COMPREPLY[*]}"' - \
            "$usr/share/bash-completion/completions/glidelab")
[ "$completed" = simulate ] || fail "bash completes simul to $completed"

# The Python module is a package of its own, where it was built: it is imported from where it was unpacked, and nothing of it is
# in the program's.
module=("$build"/python/glidelab/_glidelab*.so)
[ -e "${module[0]}" ] || exit 0
! grep -q dist-packages contents || fail "the program's package holds the module"
deb=$work/packed/python3-glidelab_${version}_$architecture.deb
[ -e "$deb" ] || fail "no package of the module: $(ls "$work/packed")"
for needed in python3 python3-numpy libopencv-core libsundials libosmesa libc6; do
  field Depends | grep -q "$needed" || fail "the module does not depend on $needed: $(field Depends)"
done
dpkg-deb --extract "$deb" "$work/module"
cd /
said=$(PYTHONPATH=$work/module/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c "
import glidelab
print(glidelab.__file__, len(glidelab.simulate('$usr/share/glidelab/scenarios/tutorial.toml').clips))")
[ "$said" = "$work/module/usr/lib/python3/dist-packages/glidelab/__init__.py 4" ] || fail "the module says $said"
# Without the program's package there are no scenarios; with it, the first cell of a notebook runs, and what the others name is there.
cat > "$work/notebooks.py" <<'end'
import json, re, sys
from pathlib import Path
import glidelab
for path in sorted(Path(sys.argv[1]).glob("*.ipynb")):
    cells = ["".join(cell["source"]) for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    named = re.findall(r'"([\w/-]+\.toml)"', "\n".join(cells))
    assert all((glidelab.scenarios_folder() / name).is_file() for name in named), (path, named)
    if path.stem == "paper_in_ten_lines":
        exec(cells[0])
        print(len(simulation.clips), glidelab.scenarios_folder())
end
[ -n "$(field Recommends | grep glidelab)" ] || fail "the module does not recommend the program: $(field Recommends)"
if [ ! -e /usr/share/glidelab/scenarios ]; then
  said=$(PYTHONPATH=$work/module/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c "
import glidelab
try:
    print(glidelab.scenarios_folder())
except glidelab.InputError as error:
    print(error)")
  [[ $said = *"found no such folder, expected"*/usr/share/glidelab/scenarios* ]] || fail "without the scenarios it says $said"
fi
dpkg-deb --extract "$work/packed/glidelab_${version}_$architecture.deb" "$work/module"
cd "$work/module/usr/share/doc/glidelab/examples/notebooks"
said=$(PYTHONPATH=$work/module/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$work/notebooks.py" . 2>&1) ||
  fail "a notebook says $said"
[ "$said" = "6 $work/module/usr/share/glidelab/scenarios" ] || fail "a notebook says $said"
cd /
[ -e "$work/module/usr/lib/python3/dist-packages/glidelab/py.typed" ] || fail "the module has no py.typed"
