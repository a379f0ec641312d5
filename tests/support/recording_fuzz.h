// What must hold for the recording reader whatever bytes it is given; shared
// by the libFuzzer target and by the test that runs it over the broken files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::test {

// Parses `data` as a recording, in one piece and byte by byte. Aborts when the
// two disagree, when an accepted row breaks a rule of engine/recording/recording.h, or
// when a message is not one line that starts with the name of the file.
void check_recording_bytes(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
