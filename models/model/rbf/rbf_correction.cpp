#include "models/model/rbf/rbf_correction.h"

#include "engine/json/json_fields.h"
#include "models/model/file/json_arrays.h"

namespace palpate {
namespace {

CorrectionPtr read_rbf(JsonFields& fields, const JsonNode& top, int dimension) {
  const auto kernel = fields.choice(fields.member(top, "kernel", "a text"), kernel_names());
  if (!kernel) return nullptr;
  RbfFunction function;
  function.kernel = kKernelKinds[*kernel];
  function.tail = read_vector(fields, top, "tail", tail_size(tail_degree(function.kernel), dimension), "coefficients");
  function.centres = read_points(fields, top, "centres", dimension);
  function.weights = read_vector(fields, top, "weights", function.centre_count(), "numbers, one per centre");
  if (fields.error()) return nullptr;
  return std::make_shared<const RbfCorrection>(std::move(function));
}

}  // namespace

extern const CorrectionKind kRbfCorrectionKind;
const CorrectionKind kRbfCorrectionKind{"centres", read_rbf};

RbfCorrection::RbfCorrection(RbfFunction function) : function_(std::move(function)), evaluator_(function_) {}

FileFields RbfCorrection::file_fields() const {
  std::vector<std::string> weights;
  for (const double weight : function_.weights) weights.push_back(json_number(weight));
  return {{"kernel", json_quoted(std::string(kernel_name(function_.kernel)))},
          {"tail", json_list(function_.tail)},
          {"centres", json_columns(function_.centres)},
          {"weights", json_lines(weights)}};
}

const RbfFunction* rbf_of(const CorrectionPtr& correction) {
  const auto* rbf = dynamic_cast<const RbfCorrection*>(correction.get());
  return rbf == nullptr ? nullptr : &rbf->function();
}

}  // namespace palpate
