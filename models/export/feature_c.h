// Writes the features (engine/tick/features.h) and the trend (models/model/trend.h) as C99 text.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <vector>

#include "engine/tick/features.h"
#include "models/export/c_text.h"
#include "models/model/trend.h"

namespace palpate {

// "static void update_features(real step_s, int first)": computes value[] from the motion estimate.
void write_features(CText& out, const std::vector<FeatureSpec>& features);

// "static real trend_of(void)": computes newtons from value[].
void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features);

}  // namespace palpate
