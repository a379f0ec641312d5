// The bytes of a file that the user named.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "engine/base/result.h"

namespace palpate {

// Opens a file to be read, a plain one: a pipe or a device could block for ever or never end.
// Returns the descriptor. `expected`, in messages: "a model file"; `or_else`: what else to do
// where there is none, ", or ...". Errors: no such file, a folder, a pipe or a device, no permission.
Result<int> open_plain_file(const std::string& path, const std::string& expected, const std::string& or_else = "");
// More than any file that a program of this kind writes for itself but a model or a recording.
inline constexpr std::size_t kSmallFileBytes = std::size_t{64} << 20;
// All of its bytes. Errors: the same, those of DescriptorSource, and a file beyond `most_bytes`.
Result<std::string> read_plain_file(const std::string& path, const std::string& expected,
                                    const std::string& or_else = "", std::size_t most_bytes = kSmallFileBytes);
// The same; nothing where it cannot be read, whatever the reason.
std::optional<std::string> read_whole_file(const std::string& path);

}  // namespace palpate
