// Models and recordings without a fit, for tests that only need an example.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/recording/recording.h"
#include "models/model/correction.h"
#include "models/model/fitted_model.h"

namespace palpate::test {

// An elastic response whose slope, in N, grows evenly from `at_surface_N` to `at_depth_N` over the reference depth.
ElasticSpline even_spline(double at_surface_N, double at_depth_N);

// A model of a soft block, about 2 N at 6 mm, with a random correction: a grid for
// the `method` "voxel", none for "trend", else radial basis functions.
// The same arguments give the same model.
ModelData example_model(const std::string& method, KernelKind kernel, std::vector<FeatureSpec> features,
                        std::uint64_t seed);

// Replaces the correction by a changed copy. It must be of the kind of the function.
void change_rbf(ModelData& data, const std::function<void(RbfFunction&)>& change);
void change_grid(ModelData& data, const std::function<void(VoxelGrid&)>& change);

// These lists have, in order: depth; the paper's four features; depth, velocity and two
// Maxwell branches; depth, velocity, a spectrum, stops and creep.
std::vector<FeatureSpec> position_features();
std::vector<FeatureSpec> paper_features();
std::vector<FeatureSpec> maxwell_features();
std::vector<FeatureSpec> memory_features();

// Covers each method, kernel, feature kind and term of the trend, and a fit to the
// force, which has no trend. All names differ.
std::vector<ModelData> example_models();
ForceModels example_force_models();

// Strokes into the block and out of it, 6 mm deep at most, beginning in the air;
// with `encoder_step_m` above 0, positions in whole steps. Forces are those of
// a spring-damper: 300 N/m and 2 Ns/m, never negative.
Recording example_recording(std::size_t rows, double rate_Hz, double encoder_step_m = 0.0);

}  // namespace palpate::test
