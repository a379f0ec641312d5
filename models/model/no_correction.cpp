#include "models/model/no_correction.h"

#include "engine/json/json_fields.h"

namespace palpate {

// In the file: "trend_alone": true.
FileFields NoCorrection::file_fields() const { return {{"trend_alone", "true"}}; }

extern const CorrectionKind kNoCorrectionKind;
const CorrectionKind kNoCorrectionKind{
    "trend_alone", [](JsonFields& fields, const JsonNode& top, int) -> CorrectionPtr {
      if (!fields.boolean(top, "trend_alone")) {
        fields.complain("/trend_alone", "found false, expected true, or another correction");
        return nullptr;
      }
      return std::make_shared<const NoCorrection>();
    }};

}  // namespace palpate
