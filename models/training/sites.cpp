#include "models/training/sites.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace palpate {
namespace {

Error wrong_size(const std::string& name, Eigen::Index found, Eigen::Index expected) {
  return Error{"sites: " + name + " has " + std::to_string(found) + " entries, expected " + std::to_string(expected) +
               ", one per point"};
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
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool finite = sites.points.col(i).allFinite() && std::isfinite(sites.target_N[i]) &&
                        std::isfinite(sites.row_scale[i]) && sites.row_scale[i] >= 0.0;
    if (!finite)
      return Error{"sites: site " + std::to_string(i) +
                   " is not finite or has a negative row_scale; expected finite points, forces and factors"};
  }
  return {};
}

Sites even_subset(const Sites& sites, Eigen::Index most) {
  const Eigen::Index count = std::min(sites.count(), most);
  Sites subset;
  subset.smoothing = sites.smoothing;
  subset.strength = sites.strength;
  subset.as_2009 = sites.as_2009;
  subset.points.resize(sites.dimension(), count);
  subset.target_N.resize(count);
  subset.row_scale.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index i = k * sites.count() / count;
    subset.points.col(k) = sites.points.col(i);
    subset.target_N[k] = sites.target_N[i];
    subset.row_scale[k] = sites.row_scale[i];
  }
  return subset;
}

std::vector<Eigen::Index> distinct_sites(const Sites& sites) {
  const auto count = static_cast<std::size_t>(sites.count());
  std::vector<Eigen::Index> distinct;
  distinct.reserve(count);
  // A hash table with open addressing: index + 1 of a point, 0: free. At least twice as many slots as points.
  std::vector<Eigen::Index> slots(std::bit_ceil(2 * count + 1), 0);
  for (Eigen::Index i = 0; i < sites.count(); ++i) {
    const auto point = sites.points.col(i);
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (const double value : point) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9E3779B97F4A7C15ULL;  // -0 is 0
      hash ^= hash >> 29;
    }
    std::size_t slot = hash & (slots.size() - 1);
    while (slots[slot] != 0 && sites.points.col(slots[slot] - 1) != point) slot = (slot + 1) & (slots.size() - 1);
    if (slots[slot] != 0) continue;
    slots[slot] = i + 1;
    distinct.push_back(i);
  }
  return distinct;
}

}  // namespace palpate
