// Properties of the frame finder and its consumers for arbitrary bytes. Used by the
// libFuzzer target and by the test that runs it on synthetic streams.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::test {

// `data`: bytes of a device's stream. The bytes 0x00 0xF5 P stand for a whole frame with the
// next sequence number and a position given by P. Feeds the stream to the finders of both ends
// and the frames to a DeviceEndpoint. Aborts if a found frame has a wrong checksum, a whole
// frame is not found, bytes are counted wrongly, a sample is not finite, or a force above
// the peak would be sent. Returns the number of frames found.
std::size_t check_bridge_stream(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
