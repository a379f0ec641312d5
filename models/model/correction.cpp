#include "models/model/correction.h"

#include <string_view>

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

std::vector<CorrectionKind>& kind_table() {
  static std::vector<CorrectionKind> table = {kRbfCorrectionKind, kGridCorrectionKind, {"trend_alone", read_none}};
  return table;
}

}  // namespace

const std::vector<CorrectionKind>& correction_kinds() { return kind_table(); }

void add_correction_kind(const CorrectionKind& kind) { kind_table().push_back(kind); }

void remove_correction_kind(const char* key) {
  std::erase_if(kind_table(), [&](const CorrectionKind& kind) { return std::string_view(kind.key) == key; });
}

}  // namespace palpate
