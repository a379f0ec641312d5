// The options of a fit as text, for `palpate fit`, the C interface and Python; palpate_fit.h describes them.
//
// A list of features:
//   depth,velocity,maxwell:0.17,maxwell:0.4+1.27,stops:0.05mm+0.1mm,creep:0.1+1
// Items in any order, each except maxwell at most once; depth is always included:
//   maxwell:T[+T...]     one feature, the sum of the branches with these times (s)
//   stops:Rmm[+Rmm...]   the sum of stop operators with these thresholds
//   creep:T[+T...]       the sum of creeping bristles with these times (s) at the greatest depth
// Thread guarantee: pure functions, slow side.
#pragma once

#include <string>

#include "engine/base/result.h"
#include "models/fit/fit.h"
#include "models/training/trend_rows.h"

namespace palpate {

inline constexpr const char* kFeatureListExample =
    "depth,velocity,maxwell:0.17,maxwell:0.4+1.27,stops:0.1mm,creep:0.1+1";

// The time to select centres grows with the square of their number, to half a minute at this limit. The method
// `direct`, with every site as a centre, hardly has more centres.
inline constexpr int kMostFittedCentres = 2000;

inline constexpr const char* kRecipe2009 = "paper-2009";

// Empty: none, or the default.
struct FitOptions {
  std::string method = "greedy";
  std::string centres = "100";
  std::string candidates = "100";
  std::string kernel = "cubic";
  std::string weighting = "jnd";
  std::string reduction = "coverage";
  std::string recipe;
  std::string features = "auto";
  std::string relaxation;
  std::string surface = "auto";
  std::string grid;
  std::string seed = "1";
};

// Checks of one option each: empty, or "found ..., expected ...".
std::string check_centres(const std::string& text);
std::string check_candidates(const std::string& text);
std::string check_features(const std::string& text);
std::string check_relaxation(const std::string& text);
std::string check_grid(const std::string& text);
std::string check_seed(const std::string& text);

// Reads "method=random centres=40": pairs separated by blanks, with the names of FitOptions. Errors: an unknown name;
// the first value that is not allowed: "name: found ..., expected ...".
Result<FitOptions> parse_fit_options(const std::string& text);

// Errors: the item, the value found and the value expected.
Result<FeatureList> parse_feature_list(const std::string& text);

// The request of a fit. `scene`: a request with the scene's name, features and JND line. The options must be valid.
TrainingRequest training_request(const FitOptions& options, TrainingRequest scene);
MethodRequest method_request(const FitOptions& options);

}  // namespace palpate
