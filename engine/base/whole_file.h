// The bytes of a file that the user named.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <optional>
#include <string>

#include "engine/base/result.h"

namespace palpate {

// Of a small file. Nothing when it cannot be opened or read to its end.
std::optional<std::string> read_whole_file(const std::string& path);

// Opens a file to be read, a plain one: a pipe or a device could block for ever or never end.
// Returns the descriptor. `expected`, in messages: "a model file"; `or_else`: what else to do
// where there is none, ", or ...". Errors: no such file, a folder, a pipe or a device, no permission.
Result<int> open_plain_file(const std::string& path, const std::string& expected, const std::string& or_else = "");
// All of its bytes. Errors: the same, and those of DescriptorSource.
Result<std::string> read_plain_file(const std::string& path, const std::string& expected,
                                    const std::string& or_else = "");

}  // namespace palpate
