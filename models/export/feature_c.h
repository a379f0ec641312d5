// The features (engine/tick/features.h) and the trend (models/model/trend.h) as C99
// text: one emitter for each feature kind and for each part of the trend.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <vector>

#include "engine/tick/features.h"
#include "models/export/c_text.h"
#include "models/model/trend.h"

namespace palpate {

// "static void update_features(real step_s, int first)": from the motion estimate to
// value[].
void write_features(CText& out, const std::vector<FeatureSpec>& features);

// "static real trend_of(void)": newtons, from value[].
void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features);

}  // namespace palpate
