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

Status add_item(std::string_view item, FeatureList& list) {
  const std::size_t colon = item.find(':');
  const std::string_view kind = item.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? std::string_view() : item.substr(colon + 1);
  if (item == "depth") return {};
  if (item == "velocity" && !list.velocity) {
    list.velocity = true;
    return {};
  }
  if (kind == "maxwell") {
    auto times_s = parse_values(rest, '+');
    if (times_s.empty() || times_s.size() > kMaxFeatureParts) {
      return wrong(item, "maxwell: with one to eight times in seconds such as maxwell:0.4+1.27");
    }
    list.relaxation_times_s.push_back(std::move(times_s));
    return {};
  }
  if (kind == "stops" && list.stop_thresholds_m.empty()) {
    const auto thresholds_mm = parse_values(rest, '+', "mm");
    if (thresholds_mm.empty() || thresholds_mm.size() > kMaxFeatureParts) {
      return wrong(item, "stops: with one to eight thresholds such as stops:0.05mm+0.1mm");
    }
    for (const double threshold_mm : thresholds_mm) list.stop_thresholds_m.push_back(1e-3 * threshold_mm);
    return {};
  }
  if (kind == "creep" && list.creep_times_s.empty()) {
    list.creep_times_s = parse_values(rest, '+');
    if (list.creep_times_s.empty() || list.creep_times_s.size() > kMaxFeatureParts) {
      return wrong(item, "creep: with one to eight times in seconds such as creep:0.1+1");
    }
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
