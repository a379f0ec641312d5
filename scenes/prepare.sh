# Sourced by scenes/run.sh, tests/run.sh and .ci/: installs missing packages and builds.
# Prints nothing if nothing is missing. Sets `root`, the source tree.
# The caller must have `set -euo pipefail`.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# The only list of Debian packages. These are needed to build and run.
packages=(g++ cmake ninja-build libeigen3-dev libopenblas-dev liblapacke-dev libhwy-dev
  libcli11-dev nlohmann-json3-dev gnuplot-nox libjs-dygraphs
  pkg-config libglfw3-dev libglm-dev libepoxy-dev libimgui-dev libpng-dev libgl1-mesa-dri
  fonts-dejavu-core libhidapi-dev)
# Needed by the tests and benchmarks: a virtual display for the window (xvfb-run needs
# xauth), a browser for the pages, an emulated HID device, an emulated AVR board with its compiler, and a German
# locale for number formats.
test_packages=(libgtest-dev libbenchmark-dev chromium python3 python3-numpy python3-jsonschema
  python3-matplotlib locales xvfb xauth xkb-data
  x11-xkb-utils libx11-dev libxrandr-dev libumockdev-dev umockdev
  gcc-avr avr-libc simavr libsimavr-dev)
# Needed by .ci/run to make empty roots. Its steps install their own packages there.
ci_packages=(mmdebstrap debian-archive-keyring lintian git)

say() { printf '== %s\n' "$*"; }

# Runs a command whose output matters only when it fails.
quietly() {
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 || status=$?
  if [ "$status" -ne 0 ]; then
    cat "$log" >&2
    printf 'error: failed (exit code %s): %s\n' "$status" "$*" >&2
  fi
  rm -f "$log"
  return "$status"
}

# One line for each architecture of the package.
is_installed() { dpkg-query -W -f='${db:Status-Status}\n' "$1" 2>/dev/null | grep -x installed >/dev/null; }

# install_packages NAME...: installs the missing ones, as root or with sudo.
install_packages() {
  local name missing=() as_root=()
  command -v dpkg-query >/dev/null || return 0  # not Debian: the build says what it lacks
  for name in "$@"; do is_installed "$name" || missing+=("$name"); done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      printf 'error: missing packages, and neither root nor sudo here; as root: apt-get install %s\n' \
        "${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  quietly "${as_root[@]}" apt-get update -q || return
  quietly "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# Prints the number of parallel jobs: one per core, and at least 1.5 GB of memory per job.
job_count() {
  local cores memory_kb limit
  cores=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  if [ "$limit" != max ] && [ $((limit / 1024)) -lt "$memory_kb" ]; then memory_kb=$((limit / 1024)); fi
  local by_memory=$((memory_kb / 1500000))
  [ "$by_memory" -ge 1 ] || by_memory=1
  echo $((by_memory < cores ? by_memory : cores))
}

# build_in FOLDER TARGETS [CMAKE OPTION...]: builds the targets. First runs cmake if the
# folder is new or options are given, with PALPATE_CMAKE_OPTIONS added. TARGETS is one
# argument; several targets are separated by spaces.
build_in() {
  local folder=$1 targets more
  read -r -a targets <<<"$2"
  shift 2
  if [ ! -f "$folder/build.ninja" ]; then say "building in ${folder#"$root"/}, a few minutes the first time"; fi
  if [ ! -f "$folder/build.ninja" ] || [ $# -gt 0 ]; then
    if command -v ccache >/dev/null; then set -- -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "$@"; fi
    read -r -a more <<<"${PALPATE_CMAKE_OPTIONS:-}"
    quietly cmake -S "$root" -B "$folder" -G Ninja "$@" "${more[@]}" || return
  fi
  cmake --build "$folder" --target "${targets[@]}" -j "$(job_count)" -- --quiet | sed '/^ninja: no work to do/d'
}
