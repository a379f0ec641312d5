#include "scenes/scene/jnd_file.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

// The largest depth of nesting; the format needs three levels.
constexpr int kJndNesting = 8;
constexpr const char* kAdvice = "; write it again with palpate study analyse";

}  // namespace

Result<JndLine> parse_jnd_file(std::string_view text, const std::string& path) {
  const Result<nlohmann::json> document = parse_json(text, path, kJndNesting, {kAdvice, kAdvice});
  if (!document) return document.error();
  JsonFields fields(text, path, kAdvice);
  const JsonNode top{&*document, ""};
  const JsonNode format = fields.optional_member(top, "format");
  if (format.value == nullptr || *format.value != "palpate-jnd") {
    fields.complain("", "found no \"format\": \"palpate-jnd\", expected a JND file");
    return *fields.error();
  }
  const JsonNode version = fields.member(top, "version", "1");
  if (version.value != nullptr && *version.value != 1) {
    fields.complain(version.pointer, found(*version.value) + ", expected version 1");
    return *fields.error();
  }
  const JndLine line{fields.number(top, "offset_N", {0.0, 100.0, true}),
                     fields.number(top, "weber_fraction", {0.0, 1.0})};
  for (const char* ignored : {"criterion", "subjects", "fitted", "points"}) fields.optional_member(top, ignored);
  fields.refuse_unknown(top);
  if (const std::optional<Error> error = fields.error()) return *error;
  return line;
}

Result<JndLine> read_jnd_file(const std::string& path) {
  const Result<std::string> text = read_plain_file(path, "a JND file", ", or make one with palpate study analyse");
  if (!text) return text.error();
  return parse_jnd_file(*text, path);
}

}  // namespace palpate
