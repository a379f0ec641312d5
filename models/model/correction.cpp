#include "models/model/correction.h"

#include <string_view>

// The table of kinds: one line each. A row is defined beside its class.
#define PALPATE_CORRECTION_KINDS(ROW) \
  ROW(kRbfCorrectionKind)             \
  ROW(kGridCorrectionKind)            \
  ROW(kNoCorrectionKind)

namespace palpate {

#define PALPATE_DECLARE_KIND(row) extern const CorrectionKind row;
PALPATE_CORRECTION_KINDS(PALPATE_DECLARE_KIND)
#undef PALPATE_DECLARE_KIND

namespace {

std::vector<CorrectionKind>& kind_table() {
#define PALPATE_LIST_KIND(row) row,
  static std::vector<CorrectionKind> table = {PALPATE_CORRECTION_KINDS(PALPATE_LIST_KIND)};
#undef PALPATE_LIST_KIND
  return table;
}

}  // namespace

const std::vector<CorrectionKind>& correction_kinds() { return kind_table(); }

void add_correction_kind(const CorrectionKind& kind) { kind_table().push_back(kind); }

void remove_correction_kind(const char* key) {
  std::erase_if(kind_table(), [&](const CorrectionKind& kind) { return std::string_view(kind.key) == key; });
}

}  // namespace palpate
