// libFuzzer target for the readers of device reports. To build and run, in an empty
// folder CORPUS:
//   cmake -S . -B build-fuzz -DPALPATE_FUZZ=ON -DPALPATE_SANITIZE=address,undefined
//     -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1
//   cmake --build build-fuzz --target hid_reports_fuzz
//   build-fuzz/hid_reports_fuzz -max_len=512 -runs=10000000 CORPUS
#include "tests/support/hid_reports_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::test::check_hid_reports(data, size);
  return 0;
}
