#include "models/correction/fill_grid.h"

#include <algorithm>
#include <vector>

namespace palpate {

Status fill_grid(VoxelGrid& grid, const BatchFunction& function, const FitControl& control) {
  constexpr std::size_t kGridBatch = 8192;
  const std::size_t dimension = grid.nodes.size();
  std::size_t count = 1;
  for (const std::vector<double>& axis : grid.nodes) count *= axis.size();
  grid.values_N.resize(count);
  Eigen::VectorXd out;
  for (std::size_t first = 0; first < count; first += kGridBatch) {
    if (!control.may_continue(static_cast<double>(first) / static_cast<double>(count))) return interrupted();
    const std::size_t batch = std::min(kGridBatch, count - first);
    Eigen::MatrixXd points(static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(batch));
    for (std::size_t i = 0; i < batch; ++i) {
      std::size_t rest = first + i;
      for (std::size_t k = dimension; k-- > 0; rest /= grid.nodes[k].size())
        points(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = grid.nodes[k][rest % grid.nodes[k].size()];
    }
    out.resize(points.cols());
    function(points, out);
    std::copy(out.begin(), out.end(), grid.values_N.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return {};
}

}  // namespace palpate
