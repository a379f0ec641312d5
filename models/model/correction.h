// The correction h(u) of the trend, a function of the normalised features. Its kinds (radial basis functions, a grid,
// none) are classes with one interface, so that evaluation, model files and fits need no list of them: a new kind is
// one source file and one row in correction.cpp.
//
// Thread guarantee: a Correction is immutable and may be shared by any threads;
// `evaluate` and `size` as in ForceModel, the rest slow side.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

class JsonFields;  // engine/json/json_fields.h
struct JsonNode;

// Fields of a model file: the key and its value as JSON text, in the file's order.
using FileFields = std::vector<std::pair<std::string, std::string>>;

class Correction {
 public:
  virtual ~Correction() = default;

  // h(u) in newtons. `u`: one normalised value per feature. Haptics thread, wait-free, no allocation.
  virtual double evaluate(const double* u) const noexcept = 0;
  // The number of centres, or of nodes of a grid; 0 for neither.
  virtual int size() const noexcept = 0;
  // True if the model is its trend alone; `evaluate` is then not called.
  virtual bool is_none() const noexcept { return false; }

  // The fields of a model file; `read` of the kind makes a bit-identical correction from them.
  virtual FileFields file_fields() const = 0;
};

// The correction of a model that is its trend alone.
class NoCorrection final : public Correction {
 public:
  double evaluate(const double*) const noexcept override { return 0.0; }
  int size() const noexcept override { return 0; }
  bool is_none() const noexcept override { return true; }
  FileFields file_fields() const override { return {{"trend_alone", "true"}}; }
};

using CorrectionPtr = std::shared_ptr<const Correction>;

// The identification of a kind in a model file and its reader.
struct CorrectionKind {
  const char* key;  // the top-level field that only this kind has
  // Reports errors to `fields`, and then returns null. `top`: the whole document; `dimension`: number of features.
  CorrectionPtr (*read)(JsonFields& fields, const JsonNode& top, int dimension);
};

// All kinds, in the order of the table in correction.cpp.
const std::vector<CorrectionKind>& correction_kinds();

}  // namespace palpate
