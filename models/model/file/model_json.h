// The model file's text: ModelData to JSON and back.
//
// One object; "format": "palpate-model", "version": 1; then
//   name, method, features [{kind, relaxation_time_s, drive}, the depth with its
//   surface_position_m where that is not 0], normalisation
//   {offset, scale}, domain {lower, upper, inner_radius, outer_radius, points},
//   trend, corrects_trend, correction_limit_N, largest_force_N, lowest_force_N [0], jnd,
//   provenance, and the correction: kernel, tail, centres and weights, or grid
//   {nodes, values_N}, or trend_alone, or what another kind in the table of
//   models/model/correction.h writes.
// Every field is required but error_bound, sensor, provenance.surfaces (and the
// standard_error_m of one), a feature's slowing and surface_position_m, and the knots of a
// curve. Others are refused (but provenance.fit_seconds, which older files have).
// Centres, weights and cover points stand one to a line, so that two models can
// be compared line by line. Numbers are the shortest decimals that read back as
// the same double, so a model read back gives bit-identical forces. "filters" in
// the file are their constants only: no state is stored.
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
// Longest name of a model, in bytes; it becomes part of column and file names.
inline constexpr std::size_t kModelNameBytes = 100;
// Lists and objects inside each other; the format itself needs four levels.
inline constexpr int kModelNesting = 16;

// The text of a model file. Folders in recording names are left out. Errors:
// what validate_model refuses, a method's or a model's name that the reader would refuse.
Result<std::string> write_model_text(const ModelData& data);

// Reads what `write_model_text` wrote. `path` names the file in messages:
//   path:line:column: field[index]: found X, expected Y; what to do
// Errors: text that is not JSON, a number beyond the range of a double, nesting
// beyond kModelNesting, another format or version, a field that is missing,
// unknown, of the wrong type, size or sign: all of them, a line each.
Result<ModelData> read_model_text(std::string_view text, const std::string& path);

}  // namespace palpate
