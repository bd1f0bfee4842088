# Sourced by the other scripts: installs what is missing and builds. Needs bash and Debian's apt only.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(nproc)

say() { printf '\n== %s\n' "$*" >&2; }

# missing_of LIST…: the packages in these lists that dpkg does not know as installed.
missing_of() {
  local package
  while read -r package; do
    case "$package" in '' | '#'*) continue ;; esac
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || echo "$package"
  done < <(cat "$@")
}

# apt_install PACKAGE…
apt_install() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "these packages are missing and only root can install them: $*" >&2; return 3; }
    as_root=(sudo)
  fi
  say "Installing $# packages: $*"
  "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2
}

# install_missing LIST…: nothing goes on without these.
install_missing() {
  local missing
  mapfile -t missing < <(missing_of "$@")
  [ "${#missing[@]}" -eq 0 ] || apt_install "${missing[@]}" || exit 3
}

# install_optional LIST…: says so where they cannot be had, and goes on. One that apt does not have keeps no other out.
install_optional() {
  local missing package
  mapfile -t missing < <(missing_of "$@")
  [ "${#missing[@]}" -eq 0 ] || apt_install "${missing[@]}" || {
    for package in "${missing[@]}"; do apt_install "$package" || true; done
    mapfile -t missing < <(missing_of "$@")
    say "Not installed, so that tests which need them will be skipped: ${missing[*]}"
  }
}

# skipped_in LOG: what tests of ctest's log say that they were skipped for, or left out of what they tested, each once.
skipped_in() {
  grep -hoE '^[[:space:]]*(skipped|not run): .*' "$1" | sed 's/^ *//' | sort -u || true  # a line of its own: commands are in the log as well
}

# What the program alone is configured with: nothing is looked for that tests and benchmarks take (packages-test.txt).
program_only=(-DGLIDELAB_TESTS=OFF)
with=()

# build PRESET [TARGET…]: configures with the options in the array `with` and builds in build/PRESET.
build() {
  local preset=$1
  shift
  (cd "$root" && cmake --preset "$preset" "${with[@]}" --log-level=NOTICE >&2 && cmake --build "build/$preset" -j "$jobs" ${1:+--target "$@"} >&2)
}
