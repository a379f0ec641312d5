#include "models/export/correction_c.h"

#include <string>

#include "models/model/grid/voxel_grid.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {
namespace {

std::string tail_text(const RbfFunction& function) {
  const int degree = tail_degree(function.kernel);
  std::string text = "  real sum = tail[0];\n  int i, k;\n";
  if (degree >= 1) text += "  for (k = 0; k < FEATURES; ++k) sum += tail[1 + k] * u[k];\n";
  if (degree >= 2) {
    text +=
        "  {\n    const real *quadratic_tail = tail + 1 + FEATURES;\n    for (i = 0; i < FEATURES; ++i) {\n"
        "      real row = R(0.0);\n      for (k = i; k < FEATURES; ++k) row += *quadratic_tail++ * u[k];\n"
        "      sum += row * u[i];\n    }\n  }\n";
  }
  return text;
}

void emit_rbf(CText& out, const RbfFunction& function) {
  const auto n = static_cast<std::size_t>(function.centre_count());
  const std::string kernel = kernel_facts(function.kernel).c_text;
  Eigen::MatrixXd rows(function.dimension() + 1, function.centre_count());
  rows << function.centres, function.weights.transpose();
  out.add("\n/* ---- correction: radial basis functions; a row: the centre, then its weight ---- */\n\n");
  out.list("tail", function.tail);
  out.table("centres", rows);
  out.add("\nstatic real correction_of(const real *u) {\n" + tail_text(function) + "  for (i = 0; i < " +
          std::to_string(n) +
          "; ++i) {\n    real squared = R(0.0);\n    for (k = 0; k < FEATURES; ++k) {\n"
          "      const real difference = u[k] - centres[i][k];\n      squared += difference * difference;\n    }\n"
          "    squared = larger(squared, R(1e-36));\n    sum += centres[i][FEATURES] * (" +
          kernel + ");\n  }\n  return sum;\n}\n");
}

constexpr const char* kGridC = R"C(
static real correction_of(const real *u) {
  real corner[CORNERS];
  real fraction[FEATURES];
  int base = 0;
  int k, c, half;
  for (k = 0; k < FEATURES; ++k) {
    const real *const axis = axes + axis_begin[k];
    const real at = clamped(u[k], axis[0], axis[axis_size[k] - 1]);
    int cell = 0;
    while (cell + 2 < axis_size[k] && axis[cell + 1] <= at) ++cell;
    base += cell * axis_stride[k];
    fraction[k] = (at - axis[cell]) / (axis[cell + 1] - axis[cell]);
  }
  for (c = 0; c < CORNERS; ++c) {
    int node = base;
    for (k = 0; k < FEATURES; ++k) node += ((c >> k) & 1) * axis_stride[k];
    corner[c] = grid_values[node];
  }
  for (k = FEATURES - 1, half = CORNERS / 2; k >= 0; --k, half /= 2) {
    for (c = 0; c < half; ++c) corner[c] += fraction[k] * (corner[c + half] - corner[c]);
  }
  return corner[0];
}
)C";

void emit_grid(CText& out, const VoxelGrid& grid) {
  const std::size_t d = grid.nodes.size();
  const std::size_t corners = std::size_t{1} << d;
  std::vector<double> nodes;
  std::string sizes;
  std::string begins;
  std::string strides;
  std::size_t stride = grid.values_N.size();
  for (const std::vector<double>& axis : grid.nodes) {
    const std::string comma = sizes.empty() ? "" : ", ";
    stride /= axis.size();
    begins += comma + std::to_string(nodes.size());
    sizes += comma + std::to_string(axis.size());
    strides += comma + std::to_string(stride);
    nodes.insert(nodes.end(), axis.begin(), axis.end());
  }
  out.add("\n/* ---- correction: a grid, the last axis fastest ---- */\n\n#define CORNERS " + std::to_string(corners) +
          "\nstatic const int axis_begin[FEATURES] = {" + begins + "};\nstatic const int axis_size[FEATURES] = {" +
          sizes + "};\nstatic const int axis_stride[FEATURES] = {" + strides + "};\n");
  out.list("axes", Eigen::Map<const Eigen::VectorXd>(nodes.data(), static_cast<Eigen::Index>(nodes.size())));
  out.list("grid_values",
           Eigen::Map<const Eigen::VectorXd>(grid.values_N.data(), static_cast<Eigen::Index>(grid.values_N.size())));
  out.add(kGridC);
}

constexpr const char* kTrustC = R"C(
static real trust_in(const real *u) {
  float query[FEATURES];
  float smallest = 3.402823466e+38F;
  double squared;
  double t;
  int i, k;
  for (k = 0; k < FEATURES; ++k) {
    if (!(absolute(u[k]) < R(1e19))) return R(0.0);
    query[k] = absolute(u[k]) < R(1e-11) ? 0.0F : (float)u[k];
  }
  for (i = 0; i < COVER_POINTS; ++i) {
    float sum = 0.0F;
    for (k = 0; k < FEATURES; ++k) {
      const float difference = query[k] - cover[i][k];
      ADD_SQUARE(sum, difference);
    }
    if (sum < smallest) smallest = sum;
  }
  squared = (double)smallest;
  if (!(squared < OUTER_RADIUS * OUTER_RADIUS)) return R(0.0);
  if (squared <= INNER_RADIUS * INNER_RADIUS) return R(1.0);
  t = (OUTER_RADIUS - (double)SQRT((real)squared)) / (OUTER_RADIUS - INNER_RADIUS);
  return (real)(t * t * (3.0 - 2.0 * t));
}
)C";

}  // namespace

Status write_correction(CText& out, const CorrectionPtr& correction) {
  if (correction->is_none()) {
    out.add(
        "\n/* no correction: the model is its trend */\n\nstatic real correction_of(const real *u) {\n"
        "  (void)u;\n  return R(0.0);\n}\n");
    return {};
  }
  if (const RbfFunction* function = rbf_of(correction)) {
    emit_rbf(out, *function);
    return {};
  }
  if (const VoxelGrid* grid = grid_of(correction)) {
    emit_grid(out, *grid);
    return {};
  }
  return Error{"this kind of correction cannot be exported, expected radial basis functions, a grid or none"};
}

void write_trust(CText& out, const DomainCover& cover) {
  const auto n = static_cast<std::size_t>(cover.points.cols());
  // Compared in single precision, as in the library, whose instructions add a square with one rounding; a sum in double
  // precision with one rounding to single gives the same.
  out.add("\n/* ---- trust: the distance to the nearest of the data ---- */\n\n#define COVER_POINTS " +
          std::to_string(n) + "\n#define INNER_RADIUS ");
  const CText exact(false);
  out.add(exact.number(cover.inner_radius) + "\n#define OUTER_RADIUS " + exact.number(cover.outer_radius) + "\n");
  out.add(out.single() ? "#define ADD_SQUARE(sum, x) sum += (x) * (x)\n"
                       : "#define ADD_SQUARE(sum, x) sum = (float)((double)(x) * (double)(x) + (double)sum)\n");
  out.table("cover", cover.points.unaryExpr([](double x) { return std::abs(x) < 1e-11 ? 0.0 : x; }), "float");
  out.add(kTrustC);
}

}  // namespace palpate
