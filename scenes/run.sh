#!/usr/bin/env bash
# Builds and runs Palpate, on a fresh Debian 12 too. With a display: starts the
# window program with all arguments. Without one: compares the methods of the
# paper and the default of Palpate on the virtual silicone block, as a table and a
# figure of speed against error; with a verb as first argument (`bash scenes/run.sh scenes`), runs `palpate`.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

compare_methods() {
  local out=$root/build/run palpate=$root/build/palpate
  mkdir -p "$out"
  say "fitting the models to a recording of the virtual silicone block, replaying another"
  "$palpate" synth --material silicone --seed 1 --seconds 41.499 --out "$out/train.csv" --force
  "$palpate" synth --material silicone --seed 2 --seconds 45.272 --out "$out/test.csv" --force
  "$palpate" report --quick --train "$out/train.csv" --test "$out/test.csv" --out "$out/report" --force
}

install_packages "${packages[@]}"
# Builds only the two programs, and for the window the models of its first scene. tests/run.sh installs and configures
# what the tests need.
options=() targets="palpate palpate-demo"
[ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || targets+=" ready_silicone_block"
[ -f "$root/build/build.ninja" ] || options=(-DBUILD_TESTING=OFF)
build_in "$root/build" "$targets" "${options[@]}"

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && [ -x "$root/build/palpate-demo" ]; then
  exec "$root/build/palpate-demo" "$@"
fi
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  say "this build has no window program; the comparison without it"
else
  say "no display (DISPLAY and WAYLAND_DISPLAY are empty); the comparison without a window"
fi
case "${1:-}" in
  "") compare_methods ;;
  -*) say "not used without a window: $*" && compare_methods ;;
  *) exec "$root/build/palpate" "$@" ;;
esac
