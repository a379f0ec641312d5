// The rows row_scale * (Phi G) of all sites in one triangle, and what becomes of the data
// along with them: the QR factorisation of a matrix that is never in memory as a whole.
// Thread guarantee: slow side; one object, one thread; it starts others itself.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "engine/base/fit_control.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/lapack.h"
#include "models/training/sites.h"

namespace palpate {

// R with its columns scaled to length 1, and its singular values.
struct ScaledTriangle {
  Eigen::VectorXd scale;
  Svd parts;
};

// Of each half of the rows block after block, then of both.
class RowFolder {
 public:
  // `sites` and `centres` outlive this.
  RowFolder(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres);

  // [R z; 0 rho], R of the QR factorisation of [row_scale * (Phi G f)], f the sites' data;
  // false if cancelled. `keep`: for `fold_again`, in as much memory as all rows take.
  bool fold(const FitControl& control, bool keep, Eigen::MatrixXd& triangle);
  // The same with the data that the sites have by now, after a `fold` that kept what it needs.
  void fold_again(Eigen::MatrixXd& triangle);

 private:
  // The rows are folded in two halves, one thread each. Fixed, not the number of
  // cores, so that the result is the same everywhere.
  static constexpr int kHalves = 2;

  struct Factor {
    Eigen::MatrixXd qr;  // a triangle above, `rows` rows from `first` on below
    Eigen::MatrixXd factors;
    Eigen::Index first = 0;
    Eigen::Index rows = 0;
  };

  struct Half {
    void begin(Eigen::Index columns) {
      data = Eigen::VectorXd::Zero(columns);
      rest_squared = 0.0;
    }

    Eigen::MatrixXd triangle;
    Eigen::VectorXd data;       // Q^T f along the triangle's rows
    double rest_squared = 0.0;  // of Q^T f, beyond them
    std::vector<Factor> kept;
  };

  Eigen::Index first_block(int half) const;
  Factor append(Eigen::Index block, Eigen::MatrixXd& triangle) const;
  void carry(const Factor& factor, Half& half) const;
  Eigen::MatrixXd joined() const;

  const Sites& sites_;
  KernelKind kernel_;
  const Eigen::MatrixXd& centres_;
  PointArrays points_;
  Eigen::Index columns_;
  Eigen::Index block_rows_;
  std::array<Half, kHalves> halves_;
  Factor both_;
};

}  // namespace palpate
