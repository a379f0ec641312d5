#include "models/samples/samples.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <tuple>

#include "engine/base/statistics.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {
std::vector<Sample> thinned_rows(const Recording& recording, std::size_t most) {
  std::vector<Sample> rows;
  MotionEstimator estimator(identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns));
  const std::size_t stride = recording.rows.size() / most + 1;
  rows.reserve(recording.rows.size() / stride + 1);
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const ToolSample sample = tool_sample(recording.rows[i]);
    const MotionEstimate motion = estimator.update(sample);
    if (i % stride == 0) rows.push_back({sample, motion, recording.rows[i].force_N});
  }
  return rows;
}

std::pair<double, double> position_range_m(const std::vector<Sample>& rows) {
  const auto [low, high] = std::minmax_element(rows.begin(), rows.end(), [](const Sample& a, const Sample& b) {
    return a.motion.position_m < b.motion.position_m;
  });
  return {low->motion.position_m, high->motion.position_m};
}

std::vector<std::size_t> blocks_by_path(const std::vector<Sample>& rows) {
  std::vector<double> path_m(rows.size(), 0.0);
  for (std::size_t i = 1; i < rows.size(); ++i)
    path_m[i] = path_m[i - 1] + std::abs(rows[i].motion.position_m - rows[i - 1].motion.position_m);
  std::vector<std::size_t> block(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size() && path_m.back() > 0.0; ++i) {
    block[i] =
        std::min(kBlocks - 1, static_cast<std::size_t>(path_m[i] / path_m.back() * static_cast<double>(kBlocks)));
  }
  return block;
}

namespace {

// The offsets of the recordings from the surface of the table.
void set_offsets(Samples& samples, const std::vector<PreparedRecordingPointer>& recordings) {
  std::vector<double> surfaces_m;
  for (const PreparedRecordingPointer& one : recordings)
    if (one->surface.identified()) surfaces_m.push_back(one->surface.raw_offset_m);
  const double middle_m = median_of(surfaces_m);
  if (std::abs(middle_m) > kLeastSurface_m) samples.surface_m = middle_m;
  for (const PreparedRecordingPointer& one : recordings) {
    RecordingOffset& offset = samples.offsets.emplace_back();
    offset.name = one->recording.name;
    offset.content_hash = one->content_hash;
    offset.force_zero_N = one->surface.force_zero_N;
    offset.standard_error_m = one->surface.standard_error_m;
    if (!one->surface.identified()) continue;
    const double away_m = one->surface.raw_offset_m - samples.surface_m;
    if (std::abs(away_m) > std::max(kLeastSurface_m, kSignificantErrors * offset.standard_error_m))
      offset.offset_m = away_m;
  }
}

// Every `stride`-th row of one recording, with its offset.
Status add_rows(Samples& samples, const PreparedRecording& prepared, std::size_t stride, const FitControl& control) {
  const auto index = static_cast<std::size_t>(samples.recording.empty() ? 0 : samples.recording.back() + 1);
  const RecordingOffset& offset = samples.offsets[index];
  const double surface_m = samples.surface_m + offset.offset_m;
  const std::vector<RecordingRow>& recorded = prepared.recording.rows;
  for (std::size_t i = 0; i < recorded.size(); i += stride) {
    if (i % kRowsPerQuestion < stride && !control.may_continue()) return interrupted();
    Sample sample{tool_sample(recorded[i]), prepared.motion[i], recorded[i].force_N - offset.force_zero_N};
    sample.tool.position_m -= surface_m;
    sample.motion.position_m -= surface_m;
    samples.rows.push_back(sample);
    samples.recording.push_back(static_cast<int>(index));
  }
  return {};
}

// Moves the surface of the table, before `measure`.
void move_surface(Samples& samples, double by_m) {
  samples.surface_m += by_m;
  for (Sample& row : samples.rows) {
    row.tool.position_m -= by_m;
    row.motion.position_m -= by_m;
  }
}

// Strokes, rows in contact and their ranges.
void measure(Samples& samples, const JndLine& jnd) {
  double squares = 0.0, lowest_N = 0.0, pulls = 0.0, start_s = 0.0, duration_s = 0.0, steps = 0.0;
  int stroke = 0;
  bool was_in_contact = false;
  for (std::size_t i = 0; i < samples.rows.size(); ++i) {
    const Sample& row = samples.rows[i];
    const bool first = samples.begins_recording(i), contact = in_contact(row.tool, 0.0);
    if (first) {
      start_s = row.tool.time_s;
    } else {
      duration_s += row.tool.time_s - samples.rows[i - 1].tool.time_s;
      steps += 1.0;
    }
    if (contact && (first || !was_in_contact)) ++stroke;
    was_in_contact = contact;
    samples.stroke.push_back(stroke);
    samples.longest_recording_s = std::max(samples.longest_recording_s, row.tool.time_s - start_s);
    if (!contact) continue;
    samples.contact.push_back(i);
    samples.depth_m = std::max({samples.depth_m, row.motion.position_m, 1e-9});
    samples.force_N = std::max(samples.force_N, row.force_N);
    if (row.force_N < -jnd.at(0.0)) ++pulls;
    lowest_N = std::min(lowest_N, row.force_N);
    squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
  }
  const auto count = static_cast<double>(samples.contact.size());
  const bool pulling = pulls >= std::max(10.0, 1e-3 * count);
  if (pulling && lowest_N < -certain_force_N(samples.force_noise_N)) samples.lowest_force_N = lowest_N;
  samples.sample_s = duration_s / std::max(1.0, steps);
  // A tool that never moved still needs a scale: 1 um/s.
  samples.rms_velocity_m_per_s = std::max(1e-6, count > 0.0 ? std::sqrt(squares / count) : 0.0);
}

// The surface of recordings that press or pull at every position, m, < 0; 0 if there is none: outside of all positions
// by a twentieth of their range, where at least ten of the rows at p <= 0, and a hundredth of them, have a force above
// the JND, and the lowest position is a fiftieth of the range below 0. (2 % and 20 % give the same forces.)
double outer_surface_m(const Samples& samples, const JndLine& jnd) {
  const auto [lowest, highest] =
      std::ranges::minmax(samples.rows, {}, [](const Sample& row) { return row.tool.position_m; });
  const double lowest_m = lowest.tool.position_m, range_m = highest.tool.position_m - lowest_m;
  if (!(lowest_m < -0.02 * range_m)) return 0.0;
  double outside = 0.0, loaded = 0.0;
  for (const Sample& row : samples.rows) {
    if (in_contact(row.tool, 0.0)) continue;
    ++outside;
    if (std::abs(row.force_N) > jnd.at(row.force_N)) ++loaded;
  }
  return loaded >= std::max(10.0, 0.01 * outside) ? lowest_m - 0.05 * range_m : 0.0;
}

// The surface of recordings that begin under a preload at position 0, m, <= 0; 0 if there is none. A straight line is
// fitted to the samples above a hundredth of the greatest depth, a third of the first piece of the trend's elastic
// response; the surface is where its force is 0. The line is used if its force at position 0 exceeds the JND and two
// standard errors, its slope exceeds two standard errors, and the surface is nearer than the greatest depth.
double preload_surface_m(const Samples& samples, const JndLine& jnd) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;  // sums, of depth x and force y
  for (const std::size_t i : samples.contact) {
    const double depth_m = samples.rows[i].motion.position_m, force_N = samples.rows[i].force_N;
    if (!(depth_m > 0.0) || depth_m > 0.01 * samples.depth_m) continue;
    n += 1.0, x += depth_m, y += force_N;
    xx += depth_m * depth_m, xy += depth_m * force_N, yy += force_N * force_N;
  }
  const double spread = n * xx - x * x;
  if (n < 3.0 || !(spread > 0.0)) return 0.0;
  const double slope = (n * xy - x * y) / spread, force_N = (y - slope * x) / n;
  const double variance = std::max(0.0, yy - force_N * y - slope * xy) / (n - 2.0);
  const double noticeable_N = std::max(jnd.at(0.0), 2.0 * std::sqrt(variance * xx / spread));
  const bool identified = force_N > noticeable_N && slope > 2.0 * std::sqrt(variance * n / spread);
  const double out_m = force_N / slope;
  return identified && out_m < samples.depth_m ? -out_m : 0.0;
}

// Whether the tool moves outwards in contact by more than a tenth of its motion inwards.
bool has_unloading(const Samples& samples) {
  double inward_m = 0.0, outward_m = 0.0;
  for (const std::size_t i : samples.contact) {
    if (samples.begins_recording(i)) continue;
    const double travel_m = samples.rows[i].motion.position_m - samples.rows[i - 1].motion.position_m;
    (travel_m > 0.0 ? inward_m : outward_m) += std::abs(travel_m);
  }
  return outward_m > 0.1 * inward_m;
}

void split_into_folds(Samples& samples) {
  const std::size_t count = samples.rows.size();
  samples.fold.assign(count, 0);
  if (samples.offsets.size() >= 3) {
    samples.folds = static_cast<int>(std::min<std::size_t>(samples.offsets.size(), 6));
    for (std::size_t i = 0; i < count; ++i) samples.fold[i] = samples.recording[i] % samples.folds;
    return;
  }
  samples.folds = 5;
  // At least two pieces of a long stroke for each fold, so that no fold consists of a single phase.
  const std::size_t longest = samples.contact.size() / (has_unloading(samples) ? 10 : 50) + 1;
  std::size_t in_piece = 0;
  int piece = -1;
  for (std::size_t i = 0; i < count; ++i) {
    if (in_contact(samples.rows[i].tool, 0.0)) {
      const bool begins = samples.stroke[i] > (i > 0 ? samples.stroke[i - 1] : 0);
      if (begins || in_piece >= longest) {
        ++piece;
        in_piece = 0;
      }
      ++in_piece;
    }
    samples.fold[i] = std::max(piece, 0) % samples.folds;
  }
}

void find_units(Samples& samples) {
  samples.unit = samples.recording;
  samples.units = static_cast<int>(samples.offsets.size());
  if (samples.units > 1) return;
  std::vector<double> depth_m;
  for (const Sample& row : samples.rows) depth_m.push_back(std::max(0.0, row.motion.position_m));
  const auto [lowest, highest] = std::ranges::minmax(depth_m);
  const double half_m = 0.5 * (highest - lowest);
  bool inward = true;
  std::size_t extreme = 0;  // the row of the last extreme position in this direction
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double away_m = inward ? depth_m[extreme] - depth_m[i] : depth_m[i] - depth_m[extreme];
    samples.unit[i] = samples.units - 1;
    if (away_m > half_m) {
      inward = !inward;
      if (inward)
        std::fill(samples.unit.begin() + static_cast<std::ptrdiff_t>(extreme),
                  samples.unit.begin() + static_cast<std::ptrdiff_t>(i) + 1, samples.units++);
    }
    if (away_m <= 0.0 || away_m > half_m) extreme = i;
  }
}

}  // namespace

double Samples::no_force_N() const {
  return lowest_force_N < 0.0 ? -std::numeric_limits<double>::infinity() : palpate::no_force_N(force_noise_N);
}

Result<Samples> make_samples(std::vector<PreparedRecordingPointer> recordings, const JndLine& jnd,
                             const FitControl& control, std::size_t most_rows) {
  // By descending length, then by the hash of the content, then by name: the order in which they are given is
  // irrelevant.
  std::ranges::stable_sort(recordings, {}, [](const PreparedRecordingPointer& one) {
    const Recording& recording = one->recording;
    return std::tuple(-static_cast<std::ptrdiff_t>(one->recorded_rows), one->content_hash, recording.name);
  });
  Samples samples;
  std::size_t kept_rows = 0;
  for (const PreparedRecordingPointer& one : recordings) {
    samples.recorded_rows += one->recorded_rows;
    kept_rows += one->recording.rows.size();
    const SensorSpec sensor{one->sensor.encoder_step_m, one->sensor.position_noise_m};
    samples.sensor = std::max(samples.sensor, sensor, [](const SensorSpec& a, const SensorSpec& b) {
      return std::tie(a.encoder_step_m, a.position_noise_m) < std::tie(b.encoder_step_m, b.position_noise_m);
    });
    samples.force_noise_N = std::max(samples.force_noise_N, one->force_noise_N);
  }
  set_offsets(samples, recordings);
  const std::size_t stride = std::max<std::size_t>(1, (kept_rows + most_rows - 1) / most_rows);
  samples.rows.reserve(kept_rows / stride + recordings.size());
  for (const PreparedRecordingPointer& one : recordings)
    if (Status status = add_rows(samples, *one, stride, control); !status) return status.error();
  const bool clear = std::ranges::any_of(recordings, [](const auto& one) { return one->surface.identified(); });
  const bool air = std::ranges::any_of(recordings, [](const auto& one) { return one->surface.air.found; });
  if (!clear && !air) {
    const double out_m = outer_surface_m(samples, jnd);
    samples.surface_outside = out_m < 0.0;
    move_surface(samples, out_m);
  }
  measure(samples, jnd);
  if (samples.contact.empty()) {
    return Error{
        "no sample of the training recordings is in contact (position_m > 0): there is nothing to fit; record a press, "
        "check the sign of position_m, or set its origin (palpate import FILE --zero contact)"};
  }
  if (const double out_m = clear ? 0.0 : preload_surface_m(samples, jnd); out_m != 0.0) {
    move_surface(samples, out_m);
    samples.stroke.clear();
    samples.contact.clear();
    measure(samples, jnd);
  }
  std::vector<double> forces_N;
  for (const Sample& row : samples.rows) forces_N.push_back(row.force_N);
  samples.always_N = nth_smallest(std::move(forces_N), samples.rows.size() / 1000);
  split_into_folds(samples);
  find_units(samples);
  return samples;
}

namespace {

// Whether a row begins a recording or is at least `least_step_s` after the time `last_s`, which then becomes its own.
bool is_apart(const Samples& samples, std::size_t row, double least_step_s, double& last_s) {
  const double time_s = samples.rows[row].tool.time_s;
  if (!samples.begins_recording(row) && time_s - last_s < least_step_s) return false;
  last_s = time_s;
  return true;
}

// The `values` of filters of these features at the rows, one column a row. `size_of`: their number for some features.
Result<Eigen::MatrixXd> at_rows(const Samples& samples, const std::vector<FeatureSpec>& features,
                                const std::vector<std::size_t>& rows, const FitControl& control, double least_step_s,
                                const auto& size_of, const auto& values) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < samples.rows.size(); ++i)
    if (samples.begins_recording(i)) begins.push_back(i);
  // A filter for each recording, and of a single one for each of two threads, or more; a feature does not depend on the
  // others of its filter.
  const std::size_t count = features.size(), recordings = begins.size();
  const std::size_t parts =
      std::min(count, std::max<std::size_t>(recordings > 1 ? 1 : 2, (count + kMaxFeatures - 1) / kMaxFeatures));
  Eigen::MatrixXd all(static_cast<Eigen::Index>(size_of(features)), static_cast<Eigen::Index>(rows.size()));
  std::atomic<bool> stopped = false;
  std::mutex asking;
  parallel_for(static_cast<int>(parts * recordings), [&](int item) {
    const std::size_t at = static_cast<std::size_t>(item) % parts,
                      from = begins[static_cast<std::size_t>(item) / parts];
    const auto begin = features.begin() + static_cast<std::ptrdiff_t>(count * at / parts);
    const auto end = features.begin() + static_cast<std::ptrdiff_t>(count * (at + 1) / parts);
    const auto first = static_cast<Eigen::Index>(size_of({features.begin(), begin}));
    FeatureFilter filter({begin, end});
    auto row = std::ranges::lower_bound(rows, from);
    double last_s = 0.0;
    for (std::size_t i = from; row != rows.end() && i < samples.rows.size(); ++i) {
      if (i > from && samples.begins_recording(i)) return;
      if ((i - from) % kRowsPerQuestion == 0 && at == 0) {
        const std::scoped_lock lock(asking);
        stopped = stopped || !control.may_continue();
      }
      if (stopped) return;
      if (!is_apart(samples, i, least_step_s, last_s)) continue;
      filter.update(samples.rows[i].tool, samples.rows[i].motion);
      if (i != *row) continue;
      std::ranges::copy(values(filter), all.col(row++ - rows.begin()).begin() + first);
    }
  });
  if (stopped) return interrupted();
  return all;
}

}  // namespace

std::vector<std::size_t> contact_apart(const Samples& samples, double least_step_s) {
  std::vector<std::size_t> rows;
  double last_s = 0.0;
  for (std::size_t i = 0; i < samples.rows.size(); ++i)
    if (is_apart(samples, i, least_step_s, last_s) && in_contact(samples.rows[i].tool, 0.0)) rows.push_back(i);
  return rows;
}

Result<Eigen::MatrixXd> features_at(const Samples& samples, const std::vector<FeatureSpec>& features,
                                    const std::vector<std::size_t>& rows, const FitControl& control) {
  return at_rows(
      samples, features, rows, control, 0.0, [](const std::vector<FeatureSpec>& some) { return some.size(); },
      [](const FeatureFilter& filter) {
        return std::span(filter.vector().values).first(filter.plan().specs().size());
      });
}

Result<Eigen::MatrixXd> memory_at(const Samples& samples, const std::vector<FeatureSpec>& features,
                                  const std::vector<std::size_t>& rows, const FitControl& control,
                                  double least_step_s) {
  return at_rows(samples, features, rows, control, least_step_s, &memory_size,
                 [](const FeatureFilter& filter) { return filter.plan().memory_of(filter.state()); });
}

std::vector<RecordingEnds> recording_ends(const Samples& samples, const std::vector<FeatureSpec>& features) {
  std::vector<std::size_t> first, last;
  for (std::size_t i = 0; i < samples.rows.size(); ++i) {
    if (samples.begins_recording(i)) first.push_back(i);
    if (i + 1 == samples.rows.size() || samples.begins_recording(i + 1)) last.push_back(i);
  }
  const Eigen::MatrixXd memory = *memory_at(samples, features, last);
  std::vector<RecordingEnds> all;
  for (std::size_t k = 0; k < last.size(); ++k) {
    const RecordingOffset& offset = samples.offsets[k];
    const auto recorded_m = [&](std::size_t i) {
      return samples.rows[i].tool.position_m + samples.surface_m + offset.offset_m;
    };
    const auto of_end = memory.col(static_cast<Eigen::Index>(k));
    all.push_back({recorded_m(first[k]),
                   recorded_m(last[k]),
                   {of_end.begin(), of_end.end()},
                   samples.rows[first[k]].force_N + offset.force_zero_N});
  }
  return all;
}

}  // namespace palpate
