#!/usr/bin/env bash
# usage: install_optional.sh SOURCE-FOLDER
# tools/setup.sh on a machine of which apt has all optional packages but one: the others are installed, the one is named.
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
export work

# Stand-ins: dpkg knows what apt has installed here; apt installs nothing at all where one of the packages is not to be had.
cat > "$work/bin/dpkg-query" <<'END'
#!/bin/sh
grep -qx "$3" "$work/installed" 2>/dev/null && echo installed
END
cat > "$work/bin/apt-get" <<'END'
#!/bin/sh
[ "$1" = install ] || exit 0
shift
for word; do [ "$word" != chromium ] || exit 100; done
for word; do case "$word" in -*) ;; *) echo "$word" >> "$work/installed" ;; esac; done
END
printf '#!/bin/sh\necho 0\n' > "$work/bin/id"
chmod +x "$work/bin/"*

said=$(PATH=$work/bin:$PATH bash -c ". '$source/tools/setup.sh'; install_optional '$source/tools/packages-optional.txt'" 2>&1)
echo "$said"
wanted=$(grep -v '^#' "$source/tools/packages-optional.txt" | grep -vx chromium | sort)
[ "$(sort "$work/installed")" = "$wanted" ] || { echo "installed:"; cat "$work/installed"; exit 1; }
echo "$said" | grep -qx '== Not installed, so that tests which need them will be skipped: chromium'

# And what a log of tests says of skipped ones, and of what others left out, each reason once; the command of a test that ran, and what another one
# printed in the middle of a line, are none.
printf '  skipped: no zsh program\nfine\n  skipped: no zsh program\n' > "$work/log"
printf 'Command: "sh" "-c" "echo skipped: no room"\n== Not installed, tests will be skipped: tac\n' >> "$work/log"
printf '  not run: sparse.py, no pysindy\nthis was not run: a command\n' >> "$work/log"
[ "$(bash -c ". '$source/tools/setup.sh'; skipped_in '$work/log'")" = "not run: sparse.py, no pysindy
skipped: no zsh program" ]
