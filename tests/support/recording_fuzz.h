// Properties of the recording reader for arbitrary bytes. Used by the libFuzzer
// target and by the test that runs it on the broken files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::test {

// Parses `data` as a recording, in one piece and in small pieces. Aborts if the
// results differ, an accepted row violates a rule of engine/recording/recording.h,
// or a message is not one line that starts with the file name.
void check_recording_bytes(const std::uint8_t* data, std::size_t size);

}  // namespace palpate::test
