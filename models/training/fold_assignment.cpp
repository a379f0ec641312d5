#include "models/training/fold_assignment.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr std::size_t kFewestRecordings = 3;
constexpr std::size_t kStrokeFolds = 5;
// The number of pieces of one long stroke, two for each fold, so that no fold consists of a single phase.
constexpr std::size_t kPieces = 10;
constexpr std::size_t kPiecesOneWay = 50;

}  // namespace

FoldAssignment::FoldAssignment(std::size_t recordings, std::size_t strokes, std::size_t contact_samples,
                               bool has_unloading)
    : folds_(0),
      by_recording_(recordings >= kFewestRecordings),
      longest_piece_(contact_samples / (has_unloading ? kPieces : kPiecesOneWay) + 1) {
  const std::size_t pieces = by_recording_ ? recordings : std::max(strokes, kStrokeFolds);
  folds_ = static_cast<int>(std::min(pieces, by_recording_ ? static_cast<std::size_t>(kMaximumFolds) : kStrokeFolds));
}

int FoldAssignment::next(int recording, int stroke, bool in_contact) noexcept {
  if (by_recording_) return recording % folds_;
  if (in_contact) {
    if (stroke != stroke_ || in_piece_ >= longest_piece_) {
      stroke_ = stroke;
      in_piece_ = 0;
      ++piece_;
    }
    ++in_piece_;
  }
  return std::max(piece_, 0) % folds_;
}

}  // namespace palpate
