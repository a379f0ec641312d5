// Properties of the readers of untrusted bytes. Each function aborts if one does not hold. Used by
// the libFuzzer programs of tests/fuzz and by the test that runs them on made data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace palpate::test {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

// `data`: bytes of a bridge device's stream. The bytes 0x00 0xF5 P stand for a whole frame with the
// next sequence number and a position given by P. Both ends search the stream for frames; a
// DeviceEndpoint gets the frames. Aborts if a found frame has a wrong checksum, a whole frame
// other than the last is not found, bytes are counted wrongly, or the endpoint accepts or sends
// a value that check_hid_reports forbids. Returns the number of frames found.
std::size_t check_bridge_stream(const std::uint8_t* data, std::size_t size);

// `data`: the kind of device, then reports, each preceded by its length and the
// time since the previous one. Decodes each and feeds it to a DeviceEndpoint. Aborts
// if an accepted reading cannot have been written by the encoder of that protocol,
// time does not increase, a value for the haptics thread is not finite, or a force
// above the peak would be sent. Returns the number of reports.
std::size_t check_hid_reports(const std::uint8_t* data, std::size_t size);

// Parses `data` as a recording, in one piece and in small pieces. Aborts if the
// results differ, an accepted row violates a rule of engine/recording/recording.h,
// or a message is not one line that starts with the file name. Returns the number of rows.
std::size_t check_recording(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
