// Reads a file that the user named.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/result.h"

namespace palpate {

// Opens a regular file for reading; a pipe or a device could block or never end.
// `expected`: "a model file", for messages; `or_else`: further advice if there is no such file, ", or ...". Errors: no
// such file, a folder, a pipe or a device, no permission.
Result<std::unique_ptr<std::istream>> open_plain_file(const std::string& path, const std::string& expected,
                                                      const std::string& or_else = "");
// The error of a stream that cannot be read, by errno.
Error unreadable(const std::string& path);
// The limit for all files except models and recordings.
inline constexpr std::size_t kSmallFileBytes = std::size_t{64} << 20;
// Reads all bytes. Errors: as above, a file that cannot be read, and a file beyond `most_bytes`.
Result<std::string> read_plain_file(const std::string& path, const std::string& expected,
                                    const std::string& or_else = "", std::size_t most_bytes = kSmallFileBytes);
// Reads all bytes; none if the file cannot be read for any reason.
std::optional<std::string> read_whole_file(const std::string& path);

}  // namespace palpate
