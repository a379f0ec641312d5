#include "scenes/scene/jnd_file.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

using OrderedJson = nlohmann::ordered_json;

// The format needs three.
constexpr int kJndNesting = 8;
constexpr const char* kAdvice = "; write it anew with palpate study analyse";

}  // namespace

std::string jnd_file_text(const JndLines& lines, const std::vector<JndPoint>& points, double criterion,
                          const std::vector<std::string>& subjects) {
  OrderedJson list = OrderedJson::array();
  for (const JndPoint& point : points) {
    OrderedJson entry = {{"reference_N", point.reference_N}, {"jnd_N", point.jnd_N}};
    if (point.standard_error_N > 0.0) entry["standard_error_N"] = point.standard_error_N;
    entry["source"] = point.source;
    list.push_back(entry);
  }
  const OrderedJson document = {
      {"format", "palpate-jnd"},
      {"version", 1},
      {"offset_N", lines.conservative.offset_N},
      {"weber_fraction", lines.conservative.weber_fraction},
      {"criterion", criterion},
      {"subjects", subjects},
      {"fitted", {{"offset_N", lines.fitted.offset_N}, {"weber_fraction", lines.fitted.weber_fraction}}},
      {"points", list}};
  return document.dump(2) + "\n";
}

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
    fields.complain(version.pointer, found(*version.value) + ", expected the version 1");
    return *fields.error();
  }
  const JndLine line{fields.number(top, "offset_N", {0.0, 100.0, true}),
                     fields.number(top, "weber_fraction", {0.0, 1.0})};
  for (const char* told : {"criterion", "subjects", "fitted", "points"}) fields.optional_member(top, told);
  fields.refuse_unknown(top);
  if (const std::optional<Error> error = fields.error()) return *error;
  return line;
}

Result<JndLine> read_jnd_file(const std::string& path) {
  const std::optional<std::string> text = read_whole_file(path);
  if (!text) return Error{"cannot read the JND file " + path + "; does it exist?"};
  return parse_jnd_file(*text, path);
}

}  // namespace palpate
