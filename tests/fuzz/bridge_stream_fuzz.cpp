// libFuzzer target for the frames of `bridge:`. To build and run: as hid_reports_fuzz.cpp.
#include "tests/support/bridge_stream_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  palpate::test::check_bridge_stream(data, size);
  return 0;
}
