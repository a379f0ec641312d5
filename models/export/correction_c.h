// Writes the correction of a model (models/model/correction.h) and the trust in it (models/model/domain_guard.h) as
// C99 text, with one function for each kind.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include "engine/base/result.h"
#include "models/export/c_text.h"
#include "models/model/correction.h"
#include "models/model/domain_guard.h"

namespace palpate {

// "static real correction_of(const real *u)": newtons, from normalised features. Errors: a kind that cannot be
// exported.
Status write_correction(CText& out, const CorrectionPtr& correction);

// "static real trust_in(const real *u)": 1 near the data, 0 out of domain.
void write_trust(CText& out, const DomainCover& cover);

}  // namespace palpate
