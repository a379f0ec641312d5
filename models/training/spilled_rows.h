// Rows of long recordings, read and estimated once, in a file without a name: on disk
// where memory is not meant to hold them, gone with the process.
// Thread guarantee: one object, one thread; slow side (does I/O).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/motion_estimator.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

class SpilledRows {
 public:
  struct Row {
    ToolSample sample;
    MotionEstimate motion;
    double force_N = 0.0;
  };

  // In $TMPDIR, or /var/tmp, which is on disk where /tmp is memory. None where no such
  // file can be made.
  static std::optional<SpilledRows> create();
  SpilledRows(SpilledRows&& other) noexcept;
  SpilledRows& operator=(SpilledRows&& other) noexcept;
  SpilledRows(const SpilledRows&) = delete;
  SpilledRows& operator=(const SpilledRows&) = delete;
  ~SpilledRows();

  // False: it could not be written, or the disk would be left with less than a
  // gigabyte; the object is of no use then.
  bool add(const Row& row);
  bool finish() { return flush(); }
  std::size_t count() const { return count_; }
  // Fills `rows` from row `first` on. Errors: names the operation and the system's reason.
  Status read(std::size_t first, std::span<Row> rows) const;

 private:
  explicit SpilledRows(int file) : file_(file) {}
  bool flush();

  int file_ = -1;
  std::size_t count_ = 0;
  std::vector<Row> waiting_;
};

}  // namespace palpate
