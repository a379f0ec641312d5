#include "models/model/correction.h"

#include "engine/json/json_fields.h"

namespace palpate {

// The table of kinds. A row is defined beside its class.
extern const CorrectionKind kRbfCorrectionKind;
extern const CorrectionKind kGridCorrectionKind;

namespace {

CorrectionPtr read_none(JsonFields& fields, const JsonNode& top, int) {
  if (fields.boolean(top, "trend_alone")) return std::make_shared<const NoCorrection>();
  fields.complain("/trend_alone", "found false, expected true, or another correction");
  return nullptr;
}

}  // namespace

const std::vector<CorrectionKind>& correction_kinds() {
  static const std::vector<CorrectionKind> table = {
      kRbfCorrectionKind, kGridCorrectionKind, {"trend_alone", read_none}};
  return table;
}

}  // namespace palpate
