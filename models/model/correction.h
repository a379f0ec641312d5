// What a fitted model adds to its trend: h(u) of the normalised features. The
// kinds (radial basis functions, a grid, nothing) are classes with one interface,
// so that evaluation, the model file and the fits need no list of them: a new kind
// is one source file and one line in correction.cpp.
//
// Thread guarantee: a Correction is immutable and may be shared by any threads;
// `evaluate` and `size` as in ForceModel, the rest slow side.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

class JsonFields;  // engine/json/json_fields.h
struct JsonNode;

// Fields of a model file: the key and its value as JSON text, in the file's order.
using FileFields = std::vector<std::pair<std::string, std::string>>;

class Correction {
 public:
  virtual ~Correction() = default;

  // h(u) in newtons. `u`: one normalised value per feature; the correction must
  // have passed `validate`. Haptics thread, wait-free, no allocation.
  virtual double evaluate(const double* u) const noexcept = 0;
  // Centres, or nodes of a grid; 0 when it has neither.
  virtual int size() const noexcept = 0;
  // The model is its trend alone, and `evaluate` is not asked.
  virtual bool is_none() const noexcept { return false; }

  // Checks sizes and finiteness for `dimension` features. Errors: names the
  // field, what was found and what was expected.
  virtual Status validate(int dimension) const = 0;
  // Everything that `read` needs to make the same correction, bit by bit.
  virtual FileFields file_fields() const = 0;
};

// That of a model which is its trend alone.
class NoCorrection final : public Correction {
 public:
  double evaluate(const double*) const noexcept override { return 0.0; }
  int size() const noexcept override { return 0; }
  bool is_none() const noexcept override { return true; }
  Status validate(int) const override { return {}; }
  FileFields file_fields() const override { return {{"trend_alone", "true"}}; }
};

using CorrectionPtr = std::shared_ptr<const Correction>;

// How a kind is found in a model file and read from it.
struct CorrectionKind {
  const char* key;  // the top-level field that only this kind has
  // Complains to `fields` about what is wrong, and may then return null. `top`: the
  // whole document. The result is validated by the caller.
  CorrectionPtr (*read)(JsonFields& fields, const JsonNode& top, int dimension);
};

// All kinds, in the order of the table in correction.cpp.
const std::vector<CorrectionKind>& correction_kinds();

// One more kind, for a program with a method of its own. Before other threads use
// models; `kind.key` must be new. And its end.
void add_correction_kind(const CorrectionKind& kind);
void remove_correction_kind(const char* key);

}  // namespace palpate
