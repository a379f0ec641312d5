// The text of a model file: ModelData to JSON and back.
//
// One object; "format": "palpate-model", "version": 1; then
//   name, method, features [{kind and its constants}], normalisation {offset, scale}, trend, corrects_trend,
//   correction_limit_N, largest_force_N, jnd, provenance, domain {lower, upper, inner_radius, outer_radius, points},
//   lowest_force_N [0], sensor, error_bound,
//   and the correction: kernel, tail, centres and weights, or grid {nodes, values_N}, or trend_alone, or the fields of
//   another kind (models/model/correction.h).
// Optional are lowest_force_N, sensor, error_bound, provenance.surfaces (and the standard_error_m and force_lag_s of
// one), a feature's slowing and surface_position_m, and the knots of a curve. Unknown fields are errors (except
// provenance.fit_seconds, which earlier files have). Centres, weights and cover points stand one to a line, so that
// models can be compared by lines. Numbers are the shortest decimals that read back as the same double, so the forces
// of a model that was read are bit-identical. The state of the features' filters is not stored.
//
// The same fit gives the same bytes: no time is stored.
//
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "models/model/fitted_model.h"

namespace palpate {

inline constexpr int kModelVersion = 1;
// Limit of the length of a model's name, bytes: it becomes part of column and file names.
inline constexpr std::size_t kModelNameBytes = 100;
// Limit of the nesting of lists and objects; the format itself needs four levels.
inline constexpr int kModelNesting = 16;

// The text of a model file, with recording names without their folders. Errors: those of read_model_text for this text.
Result<std::string> write_model_text(const ModelData& data);

// Reads the text of a model file. `path` is the file in messages:
//   path:line:column: field[index]: found X, expected Y; advice
// Errors: text that is not JSON, a number beyond the range of a double, nesting beyond kModelNesting, another format
// or version, a field that is missing, unknown, or of the wrong type, size or sign. All are reported, one a line.
Result<ModelData> read_model_text(std::string_view text, const std::string& path);

}  // namespace palpate
