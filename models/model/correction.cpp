#include "models/model/correction.h"

#include <string_view>

namespace palpate {

// The table of kinds. A row is defined beside its class.
extern const CorrectionKind kRbfCorrectionKind;
extern const CorrectionKind kGridCorrectionKind;
extern const CorrectionKind kNoCorrectionKind;

namespace {

std::vector<CorrectionKind>& kind_table() {
  static std::vector<CorrectionKind> table = {kRbfCorrectionKind, kGridCorrectionKind, kNoCorrectionKind};
  return table;
}

}  // namespace

const std::vector<CorrectionKind>& correction_kinds() { return kind_table(); }

void add_correction_kind(const CorrectionKind& kind) { kind_table().push_back(kind); }

void remove_correction_kind(const char* key) {
  std::erase_if(kind_table(), [&](const CorrectionKind& kind) { return std::string_view(kind.key) == key; });
}

}  // namespace palpate
