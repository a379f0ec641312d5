// Model files on disk; models/model/file/model_json.h says what is in them.
// Thread guarantee: slow side only (allocates, does I/O).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "models/model/fitted_model.h"

namespace palpate {

// Larger files are refused before they are read. The largest model anyone can
// want, a grid of ten million nodes, needs about half of it.
inline constexpr std::uintmax_t kMaximumModelFileBytes = std::uintmax_t{512} << 20;

// Writes a model file, whole or not at all. Errors: data that breaks validate_model;
// the file exists and `overwrite` is false; the disk refuses.
Status save_model(const std::string& path, const ModelData& data, bool overwrite);

// Reads a model file and makes it ready to evaluate; its forces are
// bit-identical to those of the model that was saved. Errors: no such file, not
// a plain file, larger than kMaximumModelFileBytes, or as read_model_text.
Result<std::shared_ptr<const FittedModel>> load_model(const std::string& path);

}  // namespace palpate
