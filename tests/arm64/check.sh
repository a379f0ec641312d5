#!/usr/bin/env bash
# Tests Palpate on arm64 in an emulator. Cross-compiles the library, `palpate` and the tests of
# the vectorised code. Checks that a model fitted natively gives the same forces on arm64 to
# 1e-9 N, that arm64 can fit a model, and that its exported C file compiles. For .ci/run: installs
# arm64 packages. Needs the native program build/palpate.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../scenes/prepare.sh"
folder=$root/build-arm64
machine=aarch64-linux-gnu

if ! dpkg --print-foreign-architectures | grep -qx arm64; then
  dpkg --add-architecture arm64
  quietly apt-get update -q
fi
install_packages g++-$machine qemu-user-static cmake ninja-build pkg-config python3 libeigen3-dev nlohmann-json3-dev \
  libcli11-dev libopenblas-dev:arm64 liblapacke-dev:arm64 libhwy-dev:arm64 libhidapi-dev:arm64 libgtest-dev:arm64

export PKG_CONFIG_LIBDIR=/usr/lib/$machine/pkgconfig:/usr/share/pkgconfig
build_in "$folder" "palpate palpate_simd_tests palpate_model_shared" -DBUILD_TESTING=ON -DPALPATE_BUILD_WINDOW=OFF \
  -DPALPATE_WERROR=ON -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_C_COMPILER=$machine-gcc -DCMAKE_CXX_COMPILER=$machine-g++

there() { qemu-aarch64-static "$@"; }
here=$root/build/palpate
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

there "$folder/palpate_simd_tests" --gtest_brief=1 --gtest_filter='*OnTarget*:Grid*:DomainGuard*:FeatureLanes*:Exponential*'
"$here" synth --material silicone --seed 1 --seconds 6 --out train.csv
"$here" synth --material silicone --seed 2 --seconds 6 --out test.csv
for method in trend voxel greedy; do
  "$here" fit --recording train.csv --method $method --out $method.json >fit.txt
  "$here" replay --recording test.csv --model $method.json --out here-$method.csv >replay.txt
  there "$folder/palpate" replay --recording test.csv --model $method.json --out there-$method.csv >replay.txt
  python3 "$root/tests/arm64/compare.py" here-$method.csv there-$method.csv
done
there "$folder/palpate" fit --recording train.csv --method random --out there.json
there "$folder/palpate" replay --recording test.csv --model there.json
there "$folder/palpate" export greedy.json --c model.c
$machine-gcc -std=c99 -Wall -Wextra -Werror -c model.c
say "arm64: the vector loops, fit, replay and export hold in the emulator"
