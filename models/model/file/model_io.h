// Model files on disk; models/model/file/model_json.h describes their content.
// Thread guarantee: slow side only (allocates, does I/O).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "models/model/fitted_model.h"

namespace palpate {

// Larger files are rejected unread. A grid of ten million nodes, the largest that is saved, needs about half of it.
inline constexpr std::uintmax_t kMaximumModelFileBytes = std::uintmax_t{512} << 20;

// Writes a model file atomically. Errors: data that the reader would refuse; the file exists and `overwrite` is false;
// input/output errors.
Status save_model(const std::string& path, const ModelData& data, bool overwrite);

// Reads a model file; the forces are bit-identical to those of the saved model. Errors: no such file, not a regular
// file, larger than kMaximumModelFileBytes, or those of read_model_text.
Result<std::shared_ptr<const FittedModel>> load_model(const std::string& path);

}  // namespace palpate
