#include "scenes/cli/forces_file.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace palpate::cli {
namespace {

void append(std::string& line, double value) {
  std::array<char, 32> text;  // the shortest form of a double has at most 24
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  if (!line.empty()) line += ',';
  line.append(text.data(), end.ptr);
}

}  // namespace

std::vector<std::string> distinct_names(const std::vector<std::string>& names) {
  std::vector<std::string> distinct;
  const auto taken = [&](const std::string& name) {
    return std::find(distinct.begin(), distinct.end(), name) != distinct.end();
  };
  for (const std::string& name : names) {
    std::string candidate = name;
    for (int i = 2; taken(candidate); ++i) candidate = name + "-" + std::to_string(i);
    distinct.push_back(candidate);
  }
  return distinct;
}

Result<ForcesFile> ForcesFile::create(const std::string& path, bool overwrite, const ForceModels& models,
                                      const std::vector<std::string>& names) {
  Result<AtomicFile> file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  ForcesFile forces(std::move(*file));
  std::vector<FeatureSpec> specs;
  std::vector<std::string> feature_names;
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::size_t i = 0; i < models[m]->features().size(); ++i) {
      const FeatureSpec& spec = models[m]->features()[i];
      if (std::find(specs.begin(), specs.end(), spec) != specs.end()) continue;
      specs.push_back(spec);
      feature_names.push_back(feature_name(spec));
      forces.columns_.push_back({m, i});
    }
  }
  std::string header = "time_s,position_m,force_N,depth_m";
  for (const std::string& name : distinct_names(feature_names)) header += "," + name;
  for (const std::string& name : names) header += "," + name + "_N";
  forces.file_.write(header + "\n");
  return forces;
}

void ForcesFile::add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
  line_.clear();
  for (const double value : {row.time_s, row.position_m, row.force_N, snapshot.depth_m}) append(line_, value);
  for (const FeatureColumn& column : columns_) {
    append(line_, tick.features_of(column.model).values[column.index]);
  }
  for (std::size_t m = 0; m < tick.model_count(); ++m) append(line_, snapshot.force_N[m]);
  line_ += '\n';
  file_.write(line_);
}

}  // namespace palpate::cli
