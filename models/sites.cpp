#include "models/sites.h"

#include <cmath>
#include <string>

namespace palpate {
namespace {

Error wrong_size(const std::string& name, Eigen::Index found, Eigen::Index expected) {
  return Error{"sites: " + name + " has " + std::to_string(found) + " entries, expected " +
               std::to_string(expected) + ", one per point"};
}

}  // namespace

Status validate_sites(const Sites& sites) {
  const Eigen::Index count = sites.count();
  if (count == 0) return Error{"sites: there are no points to fit; give at least one sample in contact"};
  if (sites.dimension() < 1 || sites.dimension() > kMaxDimension)
    return Error{"sites: points have " + std::to_string(sites.dimension()) + " coordinates, expected 1 to " +
                 std::to_string(kMaxDimension)};
  if (sites.target_N.size() != count) return wrong_size("target_N", sites.target_N.size(), count);
  if (sites.row_scale.size() != count) return wrong_size("row_scale", sites.row_scale.size(), count);
  const auto groups = static_cast<Eigen::Index>(sites.group.size());
  if (groups != 0 && groups != count) return wrong_size("group", groups, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool finite = sites.points.col(i).allFinite() && std::isfinite(sites.target_N[i]) &&
                        std::isfinite(sites.row_scale[i]) && sites.row_scale[i] >= 0.0;
    if (!finite)
      return Error{"sites: site " + std::to_string(i) +
                   " is not finite or has a negative row_scale; expected finite points, forces and factors"};
  }
  return {};
}

}  // namespace palpate
