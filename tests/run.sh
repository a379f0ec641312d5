#!/usr/bin/env bash
# Builds and runs every test, on a fresh Debian 12 too. Arguments go to ctest
# (`bash tests/run.sh -R Scene`); PALPATE_CMAKE_OPTIONS to cmake. The last lines
# are ctest's own count.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../scenes/prepare.sh"

install_packages "${packages[@]}" "${test_packages[@]}"
read -r -a options <<<"${PALPATE_CMAKE_OPTIONS:-}"
build_in "${PALPATE_BUILD_FOLDER:-$root/build}" all "${options[@]}"
exec ctest --test-dir "${PALPATE_BUILD_FOLDER:-$root/build}" --output-on-failure -j "$(job_count)" "$@"
