// Deals the samples of the training recordings to folds, for everything that is
// decided by leaving data out: features, the strength of the correction, the
// predicted error. Neighbouring samples of a stroke share their errors, so single
// samples are never left out: with three recordings or more a fold is made of
// whole recordings, otherwise of whole strokes (contacts); a stroke that holds
// more than a tenth of the contact is cut into pieces in time. A recording that only
// goes in has no second sample at any depth, and is cut into many small pieces.
// Thread guarantee: a value type, slow side.
#pragma once

#include <cstddef>

namespace palpate {

inline constexpr int kMaximumFolds = 6;

class FoldDealer {
 public:
  // `contact_samples`, `strokes`: over all recordings.
  // `turns_round`: whether the tool comes back in contact.
  FoldDealer(std::size_t recordings, std::size_t strokes, std::size_t contact_samples, bool turns_round = true);

  int folds() const noexcept { return folds_; }
  // The fold of a row; every row of every recording in order, from the beginning.
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
