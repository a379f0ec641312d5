#!/usr/bin/env bash
# Builds and runs every test, on a fresh Debian 12 too. Arguments go to ctest
# (`bash tests/run.sh -R Scene`), PALPATE_CMAKE_OPTIONS to cmake. Ends with the
# number of skipped tests and the reasons. In CI a skipped test fails the run,
# because scenes/prepare.sh installs all packages that tests need.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../scenes/prepare.sh"

install_packages "${packages[@]}" "${test_packages[@]}"
folder=${PALPATE_BUILD_FOLDER:-$root/build}
# Runs cmake every time, so that newly installed packages are found.
build_in "$folder" all -DBUILD_TESTING=ON

# A German locale, for tests that it does not change number formats.
if [ ! -d "$folder/locale/de_DE.UTF-8" ] && command -v localedef >/dev/null; then
  mkdir -p "$folder/locale"
  localedef -i de_DE -f UTF-8 "$folder/locale/de_DE.UTF-8" >/dev/null 2>&1 || true
fi
export LOCPATH=$folder/locale

status=0
report=$folder/tests.xml
rm -f "$report"
ctest --test-dir "$folder" --output-on-failure --output-junit "$report" -j "$(job_count)" "$@" || status=$?

[ -f "$report" ] || exit "$status"
skipped=$(python3 "$root/tests/skipped_tests.py" "$report")
if [ -z "$skipped" ]; then
  say "no test was skipped"
else
  say "skipped: $(wc -l <<<"$skipped") tests"
  printf '%s\n' "$skipped"
  # These two reasons to skip do not depend on packages.
  if [ -n "${CI:-}" ] && [ "$status" -eq 0 ] && grep -qvE 'sanitizer owns|root may read everything' <<<"$skipped"; then
    printf 'error: tests were skipped although everything they need is installed here\n' >&2
    status=1
  fi
fi
exit "$status"
