// libFuzzer target for the recording reader. To build and run, from the root
// of the repository, in an empty folder CORPUS:
//   clang++ -std=c++20 -O1 -g -fsanitize=fuzzer,address,undefined
//     -fno-sanitize-recover=all -I. tests/fuzz/recording_fuzz.cpp
//     tests/support/recording_fuzz.cpp engine/recording/recording_reader.cpp
//     engine/recording/recording_rules.cpp engine/base/text.cpp
//     engine/base/csv_scanner.cpp engine/base/whole_file.cpp -o recording_fuzz
//   ./recording_fuzz -dict=tests/fuzz/recording.dict -max_len=4096 CORPUS
#include "tests/support/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::test::check_recording_bytes(data, size);
  return 0;
}
