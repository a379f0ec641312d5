// A libFuzzer program, built once for each function of fuzz_checks.h. To build and run, in an empty folder CORPUS:
//   cmake -S . -B build-fuzz -DPALPATE_FUZZ=ON -DPALPATE_SANITIZE=address,undefined
//     -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1
//   cmake --build build-fuzz --target hid_reports_fuzz
//   build-fuzz/hid_reports_fuzz -max_len=512 -runs=10000000 CORPUS
//   build-fuzz/recording_fuzz -dict=tests/fuzz/recording.dict -max_len=4096 CORPUS
#include "tests/support/fuzz_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::test::PALPATE_FUZZ_CHECK(data, size);
  return 0;
}
