#include "engine/json/json_position.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

namespace palpate {
namespace {

// A bracket, a comma, a colon, a text with its quotes, or another value.
struct Token {
  char kind = '\0';  // its first character; 0 at the end
  std::size_t begin = 0;
  std::string_view content;

  bool opens() const { return kind == '{' || kind == '['; }
  bool closes() const { return kind == '}' || kind == ']'; }
};

// The first token from `at` on. The text need not be valid.
Token token_at(std::string_view text, std::size_t at) {
  constexpr std::string_view kMarks = "{}[],:";
  const std::size_t begin = text.find_first_not_of(" \t\r\n", at);
  if (begin == std::string_view::npos) return {'\0', text.size(), {}};
  std::size_t end = begin + 1;
  if (text[begin] == '"') {
    while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2u : 1u;
    ++end;
  } else if (kMarks.find(text[begin]) == std::string_view::npos) {
    end = text.find_first_of("{}[],:\" \t\r\n", end);
  }
  return {text[begin], begin, text.substr(begin, end - begin)};
}

Token token_after(std::string_view text, const Token& token) {
  return token_at(text, token.begin + token.content.size());
}

// The last token of the value that begins with `token`.
Token last_of_value(std::string_view text, Token token) {
  std::size_t open = token.opens() ? 1 : 0;
  while (open > 0 && token.kind != '\0') {
    token = token_after(text, token);
    if (token.opens()) ++open;
    if (token.closes()) --open;
  }
  return token;
}

// The first token of the member or element `step` of the value that begins with `container`.
std::optional<Token> enter(std::string_view text, const Token& container, std::string_view step) {
  if (!container.opens()) return std::nullopt;
  Token token = token_after(text, container);
  for (std::size_t index = 0; token.kind != '\0' && !token.closes(); ++index) {
    std::string name = std::to_string(index);
    if (container.kind == '{') {
      name = token.content.substr(1, token.content.size() - 2);  // without quotes
      token = token_after(text, token_after(text, token));       // behind the colon
    }
    if (name == step) return token;
    token = token_after(text, last_of_value(text, token));
    if (token.kind == ',') token = token_after(text, token);
  }
  return std::nullopt;
}

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
  Token token = token_at(text, 0);
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    const std::optional<Token> member = enter(text, token, pointer.substr(0, end));
    if (!member) break;
    token = *member;
    pointer.remove_prefix(end);
  }
  return position_of_offset(text, token.begin);
}

std::optional<std::size_t> too_deep_at(std::string_view text, int nesting) {
  int depth = 0;
  for (Token token = token_at(text, 0); token.kind != '\0'; token = token_after(text, token)) {
    if (token.opens() && ++depth > nesting) return token.begin;
    if (token.closes()) --depth;
  }
  return std::nullopt;
}

std::optional<std::size_t> repeated_name_at(std::string_view text) {
  std::vector<std::set<std::string_view>> open;  // names of each object or list
  for (Token token = token_at(text, 0); token.kind != '\0'; token = token_after(text, token)) {
    if (token.opens()) open.emplace_back();
    if (token.closes()) open.pop_back();
    const bool is_name = token.kind == '"' && token_after(text, token).kind == ':';
    if (is_name && !open.back().insert(token.content).second) return token.begin;
  }
  return std::nullopt;
}

std::string_view too_large_number(std::string_view text) {
  for (Token token = token_at(text, 0); token.kind != '\0'; token = token_after(text, token)) {
    const bool is_number = token.kind == '-' || (token.kind >= '0' && token.kind <= '9');
    if (is_number && nlohmann::json::parse(token.content, nullptr, false).is_discarded()) return token.content;
  }
  return {};
}

}  // namespace palpate
