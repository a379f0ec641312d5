// The bytes of a small file that the user named.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <optional>
#include <string>

namespace palpate {

// Nothing when it cannot be opened or read to its end.
std::optional<std::string> read_whole_file(const std::string& path);

}  // namespace palpate
