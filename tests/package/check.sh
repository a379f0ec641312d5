#!/usr/bin/env bash
# check.sh FOLDER: tests the packages in FOLDER (cmake --build build --target package) on a
# bare Debian 12. Lintian must report no errors. The packages are installed into an empty
# Debian 12 root with only their declared dependencies; there the programs must run and the
# consumer project must give the forces of `palpate replay`. Without mmdebstrap or root the
# packages are unpacked into a folder instead, and the source tree is hidden if the kernel
# allows that. All files are made below a temporary folder and removed.
set -euo pipefail
source_folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
packages=$(cd "$1" && pwd)
debs=("$packages"/palpate_*.deb "$packages"/libpalpate3_*.deb "$packages"/libpalpate-dev_*.deb
  "$packages"/python3-palpate_*.deb)
for deb in "${debs[@]}"; do
  [ -f "$deb" ] || { echo "error: found no $deb; make the packages first: cmake --build build --target package" >&2; exit 1; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

say() { printf '== %s\n' "$*"; }

if command -v lintian >/dev/null; then
  lintian --fail-on error "${debs[@]}"
  say "lintian: no errors"
else
  say "skipped: lintian is not there (apt install lintian)"
fi

# The files for the root: the consumer project, its check, and use.sh.
mkdir -p "$scratch/palpate-check/tests"
cp -r "$source_folder/tests/consumer" "$scratch/palpate-check/tests/"
cp "$source_folder/tests/package/use.sh" "$source_folder/tests/models/library/python_test.py" "${debs[@]}" "$scratch/palpate-check/"

if [ "$(id -u)" -eq 0 ] && command -v mmdebstrap >/dev/null && [ -f /usr/share/keyrings/debian-archive-keyring.gpg ]; then
  say "an empty Debian 12 root"
  sources=/etc/apt/sources.list.d/debian.sources
  [ -f "$sources" ] || sources=
  # /dev/null: the root is not kept.
  mmdebstrap --quiet --variant=apt --format=null \
    --include=g++,cmake,ninja-build,pkg-config,python3,xvfb,xauth,libgl1-mesa-dri \
    --customize-hook="copy-in $scratch/palpate-check /" \
    --customize-hook='chroot "$1" sh -c "apt-get update -q -q && apt-get install -q -q -y --no-install-recommends /palpate-check/*.deb"' \
    --customize-hook='chroot "$1" bash /palpate-check/use.sh /palpate-check ""' \
    bookworm /dev/null $sources
else
  say "skipped: an empty Debian 12 root (needs root and mmdebstrap); unpacked into a folder instead"
  for deb in "${debs[@]}"; do dpkg-deb -x "$deb" "$scratch/root"; done
  if unshare --map-root-user --mount true 2>/dev/null; then
    unshare --map-root-user --mount bash -c 'mount -t tmpfs none "$1" && exec bash "$2/palpate-check/use.sh" "$2/palpate-check" "$2/root"' \
      - "$source_folder" "$scratch"
  else
    say "skipped: hiding the source tree (no mount namespace here)"
    bash "$scratch/palpate-check/use.sh" "$scratch/palpate-check" "$scratch/root"
  fi
fi
say "the packages are good"
