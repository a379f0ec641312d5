// FORCES.csv of `palpate replay`: motion, measured force, features and every
// model's force, one row per sample.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/result.h"
#include "engine/tick/replay.h"

namespace palpate::cli {

// Columns: time_s, position_m, force_N, depth_m, each distinct feature of the
// models once, then "<model name>_N" per model. Features that differ but share a
// name get the suffix -2, -3 ... Numbers read back as the same doubles.
class ForcesFile {
 public:
  // Errors: as AtomicFile::create.
  static Result<ForcesFile> create(const std::string& path, bool overwrite, const ForceModels& models,
                                   const std::vector<std::string>& names);

  void add(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick);
  Status commit() { return file_.commit(); }

 private:
  struct FeatureColumn {
    std::size_t model;  // the first that has it
    std::size_t index;  // in that model's feature vector
  };

  explicit ForcesFile(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
  std::vector<FeatureColumn> columns_;
  std::string line_;
};

// `names` with -2, -3 ... behind those that came before, so that all differ.
std::vector<std::string> distinct_names(const std::vector<std::string>& names);

}  // namespace palpate::cli
