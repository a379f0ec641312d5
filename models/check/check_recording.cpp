#include "models/check/check_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {
namespace {

// A range of positions below this is no motion: some steps of an encoder.
constexpr double kLeastTravel_m = 10e-6;
// A flat punch of 20 mm on the hardest rubber: 2 E a / (1 - nu^2) with E = 10 MPa, a = 10 mm (Johnson 1985, section
// 3.4). A stiffer material is not soft, or a unit is wrong; a testing machine may press as hard.
constexpr double kHardRubber_N_per_m = 270e3;
// The load cell of a bench testing machine.
constexpr double kLargestForce_N = 10e3;
// The height of a large specimen. Millimetres taken as metres exceed it from 0.05 mm on.
constexpr double kStrangeDepth_m = 0.05;
// A quick tap, four in a second: a longer gap may hide a stroke. In slow recordings, twenty missing rows.
constexpr double kGap_s = 0.25;
constexpr double kGapSteps = 20.0;
// A force proportional to the depth changes by 1.5 % of its peak over this share of the travel, four steps of an 8-bit
// converter.
constexpr double kClippedTravelShare = 0.015;
constexpr std::size_t kClippedRows = 5;
// The tool crosses the highest step of a quantised force in and out, and may turn there.
constexpr double kClippedSteps = 3.0;
// The share of the way in that the tool must move out to separate depth and memory.
constexpr double kMonotonicShare = 0.1;
// A shorter hold, as a share of a mean stroke, shows no more of the memory than the strokes.
constexpr double kHoldOfStroke = 0.5;
// Ten rows in a period of the fastest motion of a hand, 10 Hz.
constexpr double kSlowRate_Hz = 100.0;
// At 650 N/m this changes the force by the JND at 0 N.
constexpr double kSurfaceDrift_m = 0.1e-3;
// One to the full depth in each of the three bands of speed, and two shallower ones.
constexpr int kFewStrokes = 5;
// A recording with fewer rows is an attempt, and not that of a broken sensor.
constexpr std::size_t kShortRows = 100;
// The law of the force at the first touch is not known; in simulated materials the onset is off by 18 to 29 um.
constexpr const char* kOnsetLaw = "not counting up to 0.03 mm because the first force is small";

template <typename... Values>
std::string words(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// With three digits, and never with an exponent: 0.125, 36.3, 3600.
std::string plain(double value) { return value < 1000.0 ? general(value, 3) : fixed(value, 0); }

// A force that is later brings forces of presses into free air, which are no drift.
constexpr double kLateForce_s = 0.05;

class Checker {
 public:
  Checker(const PreparedRecording& prepared, const CheckRequest& request, const RecordingFaults& faults)
      : prepared_(prepared), request_(request), faults_(faults) {}

  RecordingCheck run() {
    measures_ = measure_recording(recording_, 0.0);
    check_faults();
    check_sampling();
    if (check_signal()) {
      check_signs();
      const bool right_way = check_.findings.back().severity != Severity::fatal;
      // With the wrong sign of position or force there is no surface to estimate.
      if (right_way) {
        check_lag();
        check_surface();
        if (check_.surface_offset_m != 0.0) measures_ = measure_recording(recording_, check_.surface_offset_m);
        check_zero();
        check_exploration();
        check_memory();
      }
      check_units();
      check_clipping();
      check_sensors();
    }
    check_.noise_floor_within_jnd = noise_floor({&prepared_}, request_.jnd).within_jnd;
    std::stable_sort(check_.findings.begin(), check_.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
    return std::move(check_);
  }

 private:
  void add(const char* code, Severity severity, double value, std::string text, std::string advice) {
    check_.findings.push_back({code, severity, value, std::move(text), std::move(advice)});
  }
  double force_range_N() const { return measures_.highest_force_N - measures_.lowest_force_N; }
  std::vector<double> positions_m() const {
    std::vector<double> positions;
    for (const RecordingRow& row : recording_.rows) positions.push_back(row.position_m);
    return positions;
  }
  double travel_m() const { return measures_.highest_position_m - measures_.lowest_position_m; }
  double depth_m() const { return measures_.highest_position_m - check_.surface_offset_m; }

  // Without force or motion all other checks are meaningless.
  bool check_signal() {
    const bool force = force_range_N() > std::max(kForceFloor_N, noise_known_ ? 5.0 * noise_N_ : 0.0);
    // A few rows elsewhere are faults of the encoder and no motion.
    const double rest_m = median_of(positions_m());
    const auto moved = static_cast<std::size_t>(std::ranges::count_if(
        recording_.rows, [&](const RecordingRow& row) { return std::abs(row.position_m - rest_m) > kLeastTravel_m; }));
    const bool motion = travel_m() > kLeastTravel_m && moved >= kRecordingMinimumRows;
    if (!force) {
      add("no_force", Severity::fatal, force_range_N(),
          words("the force changes by only %.3g N over the whole recording, and its noise is %.3g N", force_range_N(),
                noise_N_),
          "check the sensor's cable, and check that force_N has the right column");
    }
    if (!motion) {
      add("no_motion", Severity::fatal, travel_m(),
          travel_m() > kLeastTravel_m
              ? words("the tool moves in only %zu of %zu rows, fewer than %zu", moved, recording_.rows.size(),
                      kRecordingMinimumRows)
              : words("the position changes by only %.3g mm over the whole recording", 1e3 * travel_m()),
          recording_.rows.size() < kShortRows
              ? "record for longer: approach the material from free air, and press several times"
              : "check the encoder, and check that position_m has the right column");
    }
    return force && motion;
  }

  void check_faults() {
    const std::size_t dropouts = faults_.position_dropouts + faults_.force_dropouts;
    if (dropouts > 0) {
      const double share = static_cast<double>(dropouts) / static_cast<double>(faults_.rows);
      add("dropouts", Severity::warning, share,
          words("the position jumps away and back in %zu single rows and the force in %zu, %.2g %% of the rows: a fit "
                "leaves these rows out",
                faults_.position_dropouts, faults_.force_dropouts, 100.0 * share),
          "check cables, connectors and the interface of the sensor");
    }
    if (faults_.update_step_s == 0.0) return;
    const char* const held = faults_.held_force ? "force" : "position";
    add(faults_.held_force ? "repeated_forces" : "repeated_positions", Severity::warning, faults_.update_step_s,
        words("the %s changes only every %.3g ms and is repeated in the rows between: only the %zu rows with a new %s "
              "are used",
              held, 1e3 * faults_.update_step_s, faults_.updates, held),
        words("read the %s as often as the %s", held, faults_.held_force ? "position" : "force"));
  }

  void check_signs() {
    const PressDirection direction = find_press_direction(recording_.rows);
    const double change_N = direction.deep_force_N - direction.shallow_force_N;
    if (!direction.known || std::abs(change_N) < std::max(2.0 * kForceFloor_N, 5.0 * noise_N_)) return;
    const bool flipped = direction.position_flipped || direction.force_flipped;
    if (flipped && !direction.certain) {
      add("signs", Severity::warning, change_N,
          words("the force is %.3g N at the %s end of the positions and %.3g N at the other end: either the material "
                "softens or drags, or a sign is wrong",
                direction.deep_force_N, direction.position_flipped ? "low" : "high", direction.shallow_force_N),
          "if pressing decreases position_m or force_N, reverse its sign (palpate import --flip)");
      return;
    }
    // Advice for one sign must not undo the reversal of the other.
    const bool both = direction.position_flipped && direction.force_flipped;
    const auto advice = [&](const char* rule, const char* this_one, const char* other) {
      return std::string(rule) + (both ? ": reverse both signs (palpate import --flip both)"
                                       : std::string(": reverse its sign (palpate import --flip ") + this_one +
                                             ", or --flip both if it was imported with --flip " + other + ")");
    };
    if (direction.position_flipped) {
      add("position_sign", Severity::fatal, change_N,
          words("the force is %.3g N at the lowest positions and %.3g N at the highest positions, as in free air",
                direction.deep_force_N, direction.shallow_force_N),
          advice("position_m must be positive inside the block", "position", "force"));
    }
    if (direction.force_flipped) {
      add("force_sign", Severity::fatal, change_N,
          words("the force falls from %.3g N at the surface to %.3g N at the deepest position",
                direction.shallow_force_N, direction.deep_force_N),
          advice("force_N must be positive when the block pushes the tool out", "force", "position"));
    }
  }

  void check_units() {
    const double peak_N = std::max(std::abs(measures_.highest_force_N), std::abs(measures_.lowest_force_N));
    if (travel_m() > kStrangeDepth_m && depth_m() > kStrangeDepth_m) {
      add("position_unit", Severity::warning, depth_m(), words("the tool goes %.3g m deep", depth_m()),
          "position_m must be in metres: if it is in millimetres, divide it by 1000 (palpate import --units mm,N)");
    }
    const double stiffness_N_per_m = force_range_N() / std::max(travel_m(), kLeastTravel_m);
    if (peak_N <= kLargestForce_N && stiffness_N_per_m <= kHardRubber_N_per_m) return;
    add("force_unit", Severity::warning, peak_N,
        words("the force reaches %.4g N over %.3g mm: this stiffness of %.3g kN/m is above that of hard rubber under a "
              "punch of 20 mm",
              peak_N, 1e3 * travel_m(), 1e-3 * stiffness_N_per_m),
        "if the file is not in newtons and metres, import it with its units (palpate import --units)");
  }

  void check_sampling() {
    const double rate_Hz = static_cast<double>(prepared_.stride) / measures_.median_step_s;
    add("rate", Severity::note, rate_Hz,
        "the recording has " + (rate_Hz < 1e4 ? general(rate_Hz, 4) : fixed(rate_Hz, 0)) +
            " rows per second and lasts " + plain(measures_.duration_s) + " s",
        rate_Hz < kSlowRate_Hz ? "this rate suits only slow motion: record presses by hand at 500 Hz or more" : "");
    if (prepared_.stride > 1) {
      const auto every = static_cast<double>(prepared_.stride);
      add("thinned", Severity::note, every,
          words("1 in %.0f of %zu rows is used; the motion is estimated from all", every, prepared_.recorded_rows),
          "split the recording to replay every row");
    }
    if (measures_.largest_step_s <= std::max(kGap_s, kGapSteps * measures_.median_step_s)) return;
    add("gap", Severity::warning, measures_.largest_step_s,
        words("nothing was recorded for %.3g s from %.4g s on", measures_.largest_step_s, measures_.largest_step_at_s),
        "the state of the material after the gap is unknown: split the recording there");
  }

  void check_sensors() {
    const SensorSpec& sensor = prepared_.sensor;
    if (sensor.encoder_step_m > 0.0) {
      const bool coarse = sensor.encoder_step_m > 0.02 * std::max(depth_m(), kLeastTravel_m);
      add("encoder_step", coarse ? Severity::warning : Severity::note, sensor.encoder_step_m,
          words("the position has steps of %.3g um", 1e6 * sensor.encoder_step_m),
          coarse ? "the depth spans fewer than 50 steps: use a finer encoder or press deeper" : "");
    }
    const bool loud = noise_known_ && noise_N_ > 0.5 * request_.jnd.offset_N;
    add(noise_known_ ? "force_noise" : "force_noise_unknown", loud ? Severity::warning : Severity::note, noise_N_,
        noise_known_
            ? words("the force noise is %.3g mN RMS", 1e3 * noise_N_)
            : "the force noise could not be determined: from row to row the force does not change as white noise does, "
              "but by motion or a filter",
        loud ? "the noise hides small forces: shield or filter the sensor, and compare errors with the noise floor"
             : "");
  }

  // The command that corrects the zeros of this recording.
  std::string correction() const {
    const bool tare = std::abs(surface_.force_zero_N) > 0.5 * request_.jnd.offset_N;
    return std::string("palpate import FILE") + (tare ? " --tare auto" : "") +
           (surface_.offset_m != 0.0 ? " --zero contact" : "") + " --out REC.csv";
  }

  void check_zero() {
    check_.force_zero_N = surface_.force_zero_N;
    const double half_jnd_N = 0.5 * request_.jnd.offset_N;
    if (surface_.force_zero_N != 0.0) {
      const bool large = std::abs(surface_.force_zero_N) > half_jnd_N;
      add("force_zero", large ? Severity::warning : Severity::note, surface_.force_zero_N,
          words("the force is %.3g N in free air", surface_.force_zero_N),
          large ? "tare the sensor before recording, or subtract this: " + correction() : "");
    }
    if (std::abs(lag_s_) > kLateForce_s) return;
    const ZeroDrift drift = find_zero_drift(prepared_);
    if (!(drift.range_N > std::max(half_jnd_N, 6.0 * drift.standard_error_N))) return;
    std::string text = words("the force in free air covers a range of %.3g N", drift.range_N);
    if (std::abs(drift.line_N) > half_jnd_N) text += words(": it drifts by %+.3g N over the recording", drift.line_N);
    if (std::abs(drift.step_N) > half_jnd_N)
      text += words("%s jumps by %+.3g N at %.3g s", text.find(':') == std::string::npos ? ": it" : " and",
                    drift.step_N, drift.step_at_s);
    add("force_zero_drift", Severity::warning, drift.range_N, std::move(text),
        "let the sensor warm up, tare it again, and record in shorter parts");
  }

  void check_clipping() {
    // Zero force is no limit.
    if (!(measures_.highest_force_N > 0.0)) return;
    const double least_m = std::max(kClippedTravelShare * travel_m(), kClippedSteps * measures_.step_travel_m);
    if (measures_.flat_rows < kClippedRows || measures_.flat_travel_m < least_m) return;
    add("clipping", Severity::warning, measures_.highest_force_N,
        words("the force stays at exactly %.5g N for %zu rows while the tool moves by %.3g mm",
              measures_.highest_force_N, measures_.flat_rows, 1e3 * measures_.flat_travel_m),
        "the sensor or its amplifier is at its limit: press less or choose a larger range");
  }

  void check_lag() {
    const OffsetEstimate lag = find_force_lag(prepared_.rows, noise_N_);
    // Without an onset of force, a short lag or lead cannot be distinguished from the material's memory.
    if (lag.at == 0.0 || (!surface_.air.found && std::abs(lag.at) <= kNearLag_s)) return;
    lag_s_ = lag.at;
    if (!std::isfinite(lag.standard_error)) {
      add("lag", Severity::warning, lag.at,
          words("the force %s the position by about %.3g s or more, where the search ends",
                lag.at > 0.0 ? "lags" : "leads", std::abs(lag.at)),
          "record both with the same clock; a fit does not correct the lag");
      return;
    }
    add("lag", Severity::warning, lag.at,
        words("the force %s the position by %.3g ms (+- %.2g)", lag.at > 0.0 ? "lags" : "leads", 1e3 * std::abs(lag.at),
              1e3 * lag.standard_error),
        "record both with the same clock; a fit does not correct the lag");
  }

  void check_surface() {
    check_.surface_identified = surface_.identified();
    check_.surface_offset_m = surface_.offset_m;
    if (!surface_.identified()) {
      add("surface_unknown", Severity::note, 0.0,
          surface_.air.found
              ? "the position where the force begins cannot be identified: depth is measured from position 0"
              : "the tool may never leave the material, so the surface cannot be identified: depth is measured from "
                "position 0",
          "begin the recording 1 mm or more outside of the material, and pause there for 5 s before another touch");
    }
    if (surface_.offset_m != 0.0) {
      add("surface_offset", Severity::note, surface_.offset_m,
          words("the force begins at %+.3g mm (+- %.2g, %s), not at 0", 1e3 * surface_.offset_m,
                1e3 * surface_.standard_error_m, kOnsetLaw),
          "a model fitted to this recording has its surface there; to make this 0: " + correction());
    }
    if (!surface_.identified()) check_outside();
    // A model takes the material to be at rest at the first position.
    const double first_N = recording_.rows.front().force_N - surface_.force_zero_N;
    if (recording_.rows.front().position_m > 0.0 &&
        first_N > std::max(request_.jnd.at(0.0), certain_force_N(noise_N_))) {
      add("begins_in_contact", Severity::note, first_N,
          words("the recording begins in contact with %.3g N: what the material went through before is unknown, so the "
                "first forces may have larger errors than the bound of a model",
                first_N),
          "begin outside of the material, after it has rested");
    }
    if (surface_.air.tool_mass_kg > 0.0) {
      add("tool_mass", Severity::note, surface_.air.tool_mass_kg,
          words("the force sensor carries a mass of %.3g g: in free air the force follows the acceleration",
                1e3 * surface_.air.tool_mass_kg),
          "");
    }
    const double pull_N = surface_.force_zero_N - measures_.lowest_force_N;
    if (surface_.air.found && !(surface_.air.tool_mass_kg > 0.0) && pull_N > certain_force_N(noise_N_)) {
      add("adhesion", Severity::note, pull_N,
          words("the material pulls the tool with up to %.3g N: a fitted model renders this adhesion", pull_N), "");
    }
    if (std::isfinite(surface_.offset_drift_error_m) &&
        std::abs(surface_.offset_drift_m) > std::max(kSurfaceDrift_m, 3.0 * surface_.offset_drift_error_m)) {
      add("surface_drift", Severity::warning, surface_.offset_drift_m,
          words("the surface moves by %+.3g mm between the first touch and the last", 1e3 * surface_.offset_drift_m),
          "the specimen creeps or slips: fasten it, and let it recover between strokes");
    }
    if (measures_.contact_rows == 0) {  // as recorded, the surface at 0
      add("no_contact", Severity::fatal, measures_.highest_position_m,
          words("the highest position is %.3g mm, so the tool never touches the surface at 0",
                1e3 * measures_.highest_position_m),
          "set position_m to 0 where force begins (palpate import FILE --zero contact), and check its sign");
    }
  }

  // Where the surface is not identified, rows outside of 0 are no contact, whatever their force.
  void check_outside() {
    const auto outside = static_cast<std::size_t>(std::ranges::count_if(recording_.rows, [&](const RecordingRow& row) {
      return !(row.position_m > 0.0) && std::abs(row.force_N - surface_.force_zero_N) > certain_force_N(noise_N_);
    }));
    if (outside == 0) return;
    add("force_outside", Severity::warning, static_cast<double>(outside),
        words("%zu of %zu rows have a force at positions of 0 or less, which are outside of the material", outside,
              recording_.rows.size()),
        "set position_m to 0 where the force begins: palpate import FILE --zero VALUE_M --out REC.csv");
  }

  void check_exploration() {
    const double from_m = measures_.outermost_contact_m;
    add("strokes", Severity::note, measures_.strokes,
        words("the recording has %d %s with %s s in contact, from %.4g to %.4g mm", measures_.strokes,
              measures_.strokes == 1 ? "stroke" : "strokes",
              plain(static_cast<double>(measures_.contact_rows) * measures_.median_step_s).c_str(), 1e3 * from_m,
              1e3 * measures_.highest_position_m),
        measures_.strokes < kFewStrokes ? "record more strokes of different depths and speeds" : "");
    const double pressed_m = measures_.highest_position_m - from_m;
    if (!(pressed_m > 0.0)) return;
    int empty = 0;
    std::string where;
    const std::string low = at_most_three_decimals(1e3 * kSpeedEdges_per_s[0] * pressed_m);
    const std::string high = at_most_three_decimals(1e3 * kSpeedEdges_per_s[1] * pressed_m);
    const std::string bands[kSpeedBands] = {"below " + low + " mm/s", low + " to " + high + " mm/s",
                                            "above " + high + " mm/s"};
    for (std::size_t band = 0; band < kSpeedBands; ++band) {
      std::string quarters;
      for (std::size_t quarter = 0; quarter < kDepthQuarters; ++quarter) {
        if (measures_.seconds[quarter][band] >= kLeastCell_s) continue;
        ++empty;
        const auto edge_mm = [&](std::size_t i) { return 1e3 * (from_m + 0.25 * static_cast<double>(i) * pressed_m); };
        quarters += words("%s%.4g-%.4g", quarters.empty() ? "" : ", ", edge_mm(quarter), edge_mm(quarter + 1));
      }
      if (!quarters.empty()) where += (where.empty() ? "" : "; ") + bands[band] + " at " + quarters + " mm";
    }
    const int cells = static_cast<int>(kDepthQuarters * kSpeedBands);
    add("explored", empty < cells ? Severity::note : Severity::warning, static_cast<double>(cells - empty) / cells,
        words("the strokes cover %d of %d cells of depth and speed", cells - empty, cells),
        where.empty() ? "" : std::string("record next: ").append(where));
  }

  // Checks whether the recording shows how its force relaxes, by its own strokes and holds.
  void check_memory() {
    if (!request_.memory) return;
    if (measures_.outward_travel_m < kMonotonicShare * measures_.inward_travel_m) {
      add("monotonic", Severity::warning,
          measures_.outward_travel_m / std::max(measures_.inward_travel_m, kLeastTravel_m),
          "the tool moves in and hardly out, so the effects of depth and memory cannot be separated",
          "record releases and holds");
    }
    const double hold_s = measures_.longest_hold_s;
    const double stroke_s = static_cast<double>(measures_.contact_rows) * measures_.median_step_s /
                            static_cast<double>(std::max(1, measures_.strokes));
    if (hold_s < kHoldOfStroke * stroke_s) {
      add("no_hold", Severity::note, hold_s,
          words("the longest hold in contact is %.3g s, and a stroke lasts %.3g s on average", hold_s, stroke_s),
          "hold still at two or three depths until the force stays the same");
    } else if (std::abs(measures_.hold_change_N) > request_.jnd.at(measures_.hold_end_N)) {
      add("short_hold", Severity::note, hold_s,
          words("the force still changes by %+.3g N in the second half of the longest hold, which lasts %.3g s",
                measures_.hold_change_N, hold_s),
          words("hold still for %.3g s at two or three depths", 4.0 * hold_s));
    }
  }

  const PreparedRecording& prepared_;
  const CheckRequest& request_;
  const RecordingFaults& faults_;
  const Recording& recording_ = prepared_.recording;
  const SurfaceEstimate& surface_ = prepared_.surface;
  const double noise_N_ = white_force_noise_N(prepared_);
  const bool noise_known_ = is_force_noise_known(prepared_);
  double lag_s_ = 0.0;
  RecordingCheck check_;
  RecordingMeasures& measures_ = check_.measures;
};

}  // namespace

const char* severity_name(Severity severity) {
  constexpr const char* kNames[] = {"note", "warning", "fatal"};
  return kNames[static_cast<std::size_t>(severity)];
}

std::string finding_text(const Finding& finding) {
  return finding.code + ": " + finding.text + (finding.advice.empty() ? "" : "; " + finding.advice);
}

CheckRequest check_request(const JndLine& jnd, const std::vector<FeatureSpec>& features) {
  return {jnd, std::ranges::any_of(features, [](const FeatureSpec& one) { return one.relaxation_time_s > 0.0; })};
}

const char* RecordingCheck::verdict() const {
  constexpr const char* kVerdicts[] = {"usable", "care", "unusable"};
  const Severity gravest = findings.empty() ? Severity::note : findings.front().severity;
  return kVerdicts[static_cast<std::size_t>(gravest)];
}

RecordingCheck check_recording(const PreparedRecording& prepared, const CheckRequest& request,
                               const RecordingFaults& faults) {
  return Checker(prepared, request, faults).run();
}

}  // namespace palpate
