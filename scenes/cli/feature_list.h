// The list behind `palpate fit --features LIST`:
//   depth,velocity,maxwell:0.17,maxwell:0.4+1.27,stops:0.05mm+0.1mm,creep:0.1+1
// Items in any order, each but maxwell at most once; depth is always there:
//   maxwell:T[+T...]     one feature, the sum of the branches with these times (s)
//   stops:Rmm[+Rmm...]   the sum of stop operators with these thresholds
//   creep:T[+T...]       the sum of bristles that creep, with these times (s) at the greatest depth
// Thread guarantee: pure function.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "models/training/trend_dictionary.h"

namespace palpate::cli {

inline constexpr const char* kFeatureListExample =
    "depth,velocity,maxwell:0.17,maxwell:0.4+1.27,stops:0.1mm,creep:0.1+1";

// Errors: the item, what was found and what was expected.
Result<FeatureList> parse_feature_list(const std::string& text);

// "0.17+1.27" as positive numbers, each followed by `unit`; empty when it is anything else.
std::vector<double> parse_values(std::string_view text, char separator, std::string_view unit = "");

// For --features: nothing for "auto", "scene" or a list as above, what is wrong otherwise.
std::string check_features(const std::string& text);

}  // namespace palpate::cli
