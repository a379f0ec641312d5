#include "engine/base/whole_file.h"

#include <fstream>
#include <sstream>

namespace palpate {

std::optional<std::string> read_whole_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  // An empty file has nothing to copy, which a stream takes for a failure.
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  if (!file.is_open() || file.bad() || !text) return std::nullopt;
  return text.str();
}

}  // namespace palpate
