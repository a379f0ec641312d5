// Properties of the readers of device reports for arbitrary bytes. Used by the
// libFuzzer target and by the test that runs it on synthetic reports.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::test {

// `data`: the kind of device, then reports, each preceded by its length and the
// time since the previous one. Decodes each and feeds it to a DeviceEndpoint. Aborts
// if an accepted reading cannot have been written by the encoder of that protocol,
// time does not increase, a value for the haptics thread is not finite, or a force
// above the peak would be sent. Returns the number of reports.
std::size_t check_hid_reports(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
