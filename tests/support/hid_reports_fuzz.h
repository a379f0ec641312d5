// What must hold for the readers of device reports whatever bytes they are given;
// shared by the libFuzzer target and by the test that runs it over made-up reports.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::test {

// `data`: the kind of device, then reports, each behind its length and the time
// since the one before. Decodes each and feeds it to a DeviceEndpoint and a
// SpaceMouse. Aborts when a reading is accepted that its encoder would not have
// written, when time does not go on, when anything that is handed to the haptics
// thread is not finite, or when a force above the peak would be sent. Returns how
// many reports there were.
std::size_t check_hid_reports(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
