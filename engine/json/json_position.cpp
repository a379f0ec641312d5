#include "engine/json/json_position.h"

#include <algorithm>

namespace palpate {
namespace {

// Walks through valid JSON; it never reads past the end, even if the text is not valid.
class Walker {
 public:
  explicit Walker(std::string_view text) : text_(text) { skip_blanks(); }

  std::size_t offset() const { return at_; }

  // Moves from the container at the current position to its member or element `step`. If there is none, returns false
  // and does not move.
  bool enter(std::string_view step) {
    const std::size_t start = at_;
    const bool object = peek() == '{';
    if (!object && peek() != '[') return false;
    take();
    for (std::size_t index = 0; peek() != '}' && peek() != ']' && at_ < text_.size(); ++index) {
      const std::string_view name = object ? key() : std::string_view();
      if (object ? name == step : std::to_string(index) == step) return true;
      skip_value();
      if (peek() == ',') take();
    }
    at_ = start;
    return false;
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_blanks() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }

  void take() {
    if (at_ < text_.size()) ++at_;
    skip_blanks();
  }

  std::string_view string() {
    const std::size_t first = at_ + 1;
    std::size_t end = first;
    while (end < text_.size() && text_[end] != '"') end += text_[end] == '\\' ? 2u : 1u;
    end = std::min(end, text_.size());
    at_ = end;
    take();
    return text_.substr(std::min(first, end), end - std::min(first, end));
  }

  std::string_view key() {
    const std::string_view name = string();
    take();  // the colon
    return name;
  }

  // Counts brackets without recursion, so that deep nesting cannot overflow the stack.
  void skip_value() {
    std::size_t open = 0;
    do {
      const char next = peek();
      if (next == '"') {
        string();
        continue;
      }
      if (next == '{' || next == '[') ++open;
      if ((next == '}' || next == ']') && open > 0) --open;
      take();
    } while (at_ < text_.size() && (open > 0 || std::string_view(",}]").find(peek()) == std::string_view::npos));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string position_prefix(const std::string& path, TextPosition position) {
  return path + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) + ": ";
}

TextPosition position_of_offset(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  const auto newlines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  return {newlines + 1, before.size() - line_start + 1};
}

TextPosition position_of_value(std::string_view text, std::string_view pointer) {
  Walker walker(text);
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    if (!walker.enter(pointer.substr(0, end))) break;
    pointer.remove_prefix(end);
  }
  return position_of_offset(text, walker.offset());
}

}  // namespace palpate
