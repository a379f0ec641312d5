#include "models/model/grid/grid_correction.h"

#include <nlohmann/json.hpp>

#include "engine/json/json_fields.h"
#include "models/model/file/json_arrays.h"

namespace palpate {
namespace {

bool read_grid_axis(JsonFields& fields, const JsonNode& node, VoxelGrid& grid) {
  const std::string expected = "at least 2 numbers, each above the last";
  if (!node.value->is_array() || node.value->size() < 2) {
    fields.complain(node.pointer, found(*node.value) + ", expected " + expected);
    return false;
  }
  std::vector<double> axis(node.value->size());
  if (!fields.fill(node, axis.size(), "numbers", axis.data())) return false;
  for (std::size_t i = 1; i < axis.size(); ++i) {
    if (axis[i - 1] < axis[i]) continue;
    fields.complain(node.pointer + "/" + std::to_string(i), found((*node.value)[i]) + ", expected " + expected);
    return false;
  }
  grid.nodes.push_back(std::move(axis));
  return true;
}

CorrectionPtr read_grid(JsonFields& fields, const JsonNode& top, int dimension) {
  VoxelGrid grid;
  const JsonNode node = fields.member(top, "grid", "an object");
  const JsonNode axes = fields.list(node, "nodes", "a list of axes");
  if (axes.value == nullptr) return nullptr;
  if (axes.value->size() != static_cast<std::size_t>(dimension)) {
    fields.complain(axes.pointer,
                    found(*axes.value) + " axes, expected " + std::to_string(dimension) + ", one per feature");
    return nullptr;
  }
  const JsonNode values = fields.list(node, "values_N", "a list of numbers");
  if (values.value == nullptr) return nullptr;
  std::size_t product = 1;
  for (std::size_t k = 0; k < axes.value->size(); ++k) {
    if (!read_grid_axis(fields, JsonFields::entry(axes, k), grid)) return nullptr;
    product *= grid.nodes.back().size();
    // Checked at every step, because the product of eight sizes may overflow.
    if (product > values.value->size()) break;
  }
  if (product != values.value->size()) {
    fields.complain(values.pointer, found(*values.value) + ", expected as many as the grid has nodes");
    return nullptr;
  }
  grid.values_N.resize(product);
  if (!fields.fill(values, product, "numbers", grid.values_N.data())) return nullptr;
  return std::make_shared<const GridCorrection>(std::move(grid));
}

}  // namespace

extern const CorrectionKind kGridCorrectionKind;
const CorrectionKind kGridCorrectionKind{"grid", read_grid};

GridCorrection::GridCorrection(VoxelGrid grid) : grid_(std::move(grid)), lookup_(grid_) {}

FileFields GridCorrection::file_fields() const {
  std::string axes;
  for (const std::vector<double>& axis : grid_.nodes) axes += (axes.empty() ? "" : ", ") + json_list(axis);
  std::string values;
  const std::size_t run = grid_.nodes.back().size();
  for (std::size_t i = 0; i < grid_.values_N.size(); ++i) {
    values += i == 0 ? "\n    " : (i % run == 0 ? ",\n    " : ", ");
    values += json_number(grid_.values_N[i]);
  }
  return {{"grid", "{\n    \"nodes\": [" + axes + "],\n    \"values_N\": [" + values + "\n  ]}"}};
}

const VoxelGrid* grid_of(const CorrectionPtr& correction) {
  const auto* grid = dynamic_cast<const GridCorrection*>(correction.get());
  return grid == nullptr ? nullptr : &grid->grid();
}

}  // namespace palpate
