#include "scenes/cli/feature_list.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace palpate::cli {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

Error wrong(std::string_view item, const std::string& expected) {
  return Error{"found \"" + std::string(item) + "\", expected " + expected};
}

// What may stand behind a kind's colon: one to eight values.
struct ListedKind {
  std::string_view kind;
  std::string_view unit;
  const char* expected;
};
constexpr ListedKind kListed[] = {
    {"maxwell", "", "maxwell: with one to eight times in seconds such as maxwell:0.4+1.27"},
    {"stops", "mm", "stops: with one to eight thresholds such as stops:0.05mm+0.1mm"},
    {"creep", "", "creep: with one to eight times in seconds such as creep:0.1+1"}};

Status add_item(std::string_view item, FeatureList& list) {
  const std::size_t colon = item.find(':');
  const std::string_view rest = colon == std::string_view::npos ? std::string_view() : item.substr(colon + 1);
  if (item == "depth") return {};
  if (item == "velocity" && !list.velocity) {
    list.velocity = true;
    return {};
  }
  for (const ListedKind& one : kListed) {
    const bool again = (one.kind == "stops" && !list.stop_thresholds_m.empty()) ||
                       (one.kind == "creep" && !list.creep_times_s.empty());
    if (item.substr(0, colon) != one.kind || again) continue;
    auto values = parse_values(rest, '+', one.unit);
    if (values.empty() || values.size() > kMaxFeatureParts) return wrong(item, one.expected);
    if (one.kind == "maxwell") list.relaxation_times_s.push_back(values);
    if (one.kind == "creep") list.creep_times_s = values;
    if (one.kind != "stops") return {};
    for (const double threshold_mm : values) list.stop_thresholds_m.push_back(1e-3 * threshold_mm);
    return {};
  }
  return wrong(item, "depth, velocity, maxwell:, stops: and creep:, of which only maxwell: may come again");
}

std::size_t feature_count(const FeatureList& list) {
  return 1 + (list.velocity ? 1 : 0) + list.relaxation_times_s.size() + (list.stop_thresholds_m.empty() ? 0 : 1) +
         (list.creep_times_s.empty() ? 0 : 1);
}

}  // namespace

std::vector<double> parse_values(std::string_view text, char separator, std::string_view unit) {
  std::vector<double> values;
  for (std::string_view part : split(text, separator)) {
    if (!part.ends_with(unit)) return {};
    part.remove_suffix(unit.size());
    double value = 0.0;
    const auto [next, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || next != part.data() + part.size() || !(value > 0.0) || !std::isfinite(value)) return {};
    values.push_back(value);
  }
  return values;
}

Result<FeatureList> parse_feature_list(const std::string& text) {
  FeatureList list;
  for (const std::string_view item : split(text, ',')) {
    if (const Status status = add_item(item, list); !status) return status.error();
  }
  if (feature_count(list) > kMaxFeatures) {
    return Error{"found " + std::to_string(feature_count(list)) + " features, expected at most " +
                 std::to_string(kMaxFeatures) + "; join relaxation times with +"};
  }
  return list;
}

std::string check_features(const std::string& text) {
  if (text == "auto" || text == "scene") return "";
  const auto list = parse_feature_list(text);
  return list ? "" : list.error().message + "; or auto, or scene";
}

}  // namespace palpate::cli
