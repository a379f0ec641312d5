#include "scenes/scene/jnd_file.h"

#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/json_message.h"

namespace palpate {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kAdvice = "; write it anew with palpate study analyse";

Error wrong(std::string_view text, const std::string& path, const std::string& pointer, const std::string& words) {
  return Error{position_prefix(path, position_of_value(text, pointer)) + words + kAdvice};
}

Result<double> number(const OrderedJson& document, std::string_view text, const std::string& path, const char* key,
                      const NumberRange& range) {
  const auto entry = document.find(key);
  if (entry == document.end()) {
    return wrong(text, path, "", std::string("found no \"") + key + "\", expected " + range.words());
  }
  if (entry->is_number() && range.holds(entry->get<double>())) return entry->get<double>();
  return wrong(text, path, std::string("/") + key, found(*entry) + ", expected " + range.words());
}

Result<JndLine> line_of(const OrderedJson& document, std::string_view text, const std::string& path) {
  if (!document.is_object() || document.value("format", OrderedJson()) != "palpate-jnd") {
    return wrong(text, path, "", "found no \"format\": \"palpate-jnd\", expected a JND file");
  }
  const OrderedJson version = document.value("version", OrderedJson());
  if (version != 1) return wrong(text, path, "/version", found(version) + ", expected the version 1");
  const Result<double> offset_N = number(document, text, path, "offset_N", {0.0, 100.0, true});
  if (!offset_N) return offset_N.error();
  const Result<double> weber_fraction = number(document, text, path, "weber_fraction", {0.0, 1.0});
  if (!weber_fraction) return weber_fraction.error();
  return JndLine{*offset_N, *weber_fraction};
}

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
  const Result<OrderedJson> document = parse_json_document<OrderedJson>(text, path);
  if (!document) return Error{document.error().message + kAdvice};
  try {
    return line_of(*document, text, path);
  } catch (const std::exception& error) {
    return Error{path + ": " + error.what() + kAdvice};
  }
}

Result<JndLine> read_jnd_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || !text) return Error{"cannot read the JND file " + path + "; does it exist?"};
  return parse_jnd_file(text.str(), path);
}

}  // namespace palpate
