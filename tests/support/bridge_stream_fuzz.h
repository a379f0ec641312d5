// What must hold for the finder of frames and for what follows it, whatever bytes come;
// shared by the libFuzzer target and by the test that runs it over made-up streams.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::test {

// `data`: bytes of a device's stream; 0x00 0xF5 in it stands for a whole frame, of the next
// sequence and of a position that the byte behind says. Feeds all of it to the finders of
// both ends and its frames to a DeviceEndpoint. Aborts when a frame is found that has no right
// checksum, when one that was whole is not found, when bytes are counted wrongly, or when
// what is handed over is not finite or a force above the peak would be sent. Returns how
// many frames were found.
std::size_t check_bridge_stream(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
