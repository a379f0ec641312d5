// Assigns the samples of the training recordings to the folds of every cross-validation.
//
// Neighbouring samples of a stroke have correlated errors, so a fold never consists of single samples. With three
// recordings or more a fold is made of whole recordings, otherwise of whole strokes (contacts). A stroke with more
// than a tenth of the samples in contact is cut into pieces in time. A recording without unloading visits each depth
// once and is cut into pieces of a fiftieth.
// Thread guarantee: value type, slow side.
#pragma once

#include <cstddef>

namespace palpate {

inline constexpr int kMaximumFolds = 6;

class FoldAssignment {
 public:
  // `contact_samples`, `strokes`: totals of all recordings. `has_unloading`: whether the recordings contain unloading.
  FoldAssignment(std::size_t recordings, std::size_t strokes, std::size_t contact_samples, bool has_unloading = true);

  int folds() const noexcept { return folds_; }
  // The fold of the next row, 0 to folds() - 1. To be called for every row of every recording in order.
  int next(int recording, int stroke, bool in_contact) noexcept;

 private:
  int folds_;
  bool by_recording_;
  std::size_t longest_piece_;
  int stroke_ = -1;
  std::size_t in_piece_ = 0;
  int piece_ = -1;
};

}  // namespace palpate
