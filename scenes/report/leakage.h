// Whether what is tested on was trained on.
//
// Compared are the measured forces, bit by bit: sensor noise makes every recording's
// own, whatever its name, its start time or a shift of its positions.
// Thread guarantee: pure functions, slow side.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

using SharedRecording = std::shared_ptr<const Recording>;

// FNV-1a over positions and forces, row by row. Times and names do not count.
std::uint64_t content_hash(const Recording& recording);
std::string hash_text(std::uint64_t hash);

// A stretch of at least this many rows with the same forces, and this many different
// ones among them, is no chance.
inline constexpr std::size_t kLeakRows = 50;
inline constexpr std::size_t kLeakValues = 12;

struct SharedStretch {
  std::size_t first_row = 0;    // of `tested`
  std::size_t trained_row = 0;  // of `trained`, likewise
  std::size_t rows = 0;
};

// The longest stretch of `tested` whose forces stand in `trained` as well; stretches of
// 2 kLeakRows and more are always found. rows == 0: none.
SharedStretch shared_stretch(const Recording& trained, const Recording& tested);

// `all`: the first `trained` of them to train on, the others to test on. Errors: a recording that
// is given twice under any names, or a stretch of a tested recording that was trained on; by name
// and rows.
Status refuse_leakage(const std::vector<SharedRecording>& all, std::size_t trained);

}  // namespace palpate
