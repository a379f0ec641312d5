// The cases of each kind: sites, recordings, and materials (motions, and a hand in closed loop).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/hard/hard.h"
#include "scenes/material/material_laws.h"
#include "scenes/material/rig.h"

namespace palpate {

// Tables of samples with any depth, velocity and force: the two features have no memory, so that each sample is a site
// of its own, and the thinning is off. The training is otherwise that of `palpate fit`.

namespace {

constexpr Eigen::Index kSites = 160;
constexpr int kFolds = 5;
constexpr double kDepth_m = 6e-3;
constexpr double kVelocity_m_per_s = 0.1;
constexpr double kNoise_N = 0.005;
constexpr int kTicks = 4000;
constexpr double kSample_s = 1e-3;

// Points of the unit square, one a column: the depth over kDepth_m, and half of 1 + the velocity over its largest.
using Points = Eigen::Matrix2Xd;
using Point = Eigen::Vector2d;

// Not a sum of an elastic and a viscous part, so that the trend needs its correction. Up to 3 N.
double unit_force_N(double u, double v) {
  const double w = 2.0 * v - 1.0;
  return u * (2.0 + u + 0.3 * w + 0.4 * std::sin(5.0 * u) * std::sin(2.0 * w));
}

Points random_points(Eigen::Index count, std::uint64_t stream) {
  RandomStream random(7, stream);
  Points points(2, count);
  for (double& value : points.reshaped()) value = random.uniform(0.0, 1.0);
  return points;
}

// A closed curve that comes near every point of the square.
Points path() {
  Points points(2, kTicks);
  for (int i = 0; i < kTicks; ++i) {
    const double t = 2.0 * std::numbers::pi * kSample_s * i;
    points.col(i) << 0.5 + 0.46 * std::sin(0.75 * t), 0.5 + 0.46 * std::sin(1.25 * t + 0.3);
  }
  return points;
}

struct SiteSet {
  Points points = random_points(kSites, 1);
  Points tested = path();   // where the true force is compared
  Point unit{1.0, 1.0};     // factors of depth and velocity
  double force_unit = 1.0;  // factor of the forces
  std::function<void(Eigen::VectorXd& force_N)> fault{};
};

double depth_m(const SiteSet& set, double u) { return kDepth_m * set.unit.x() * u; }
double velocity_m_per_s(const SiteSet& set, double v) { return kVelocity_m_per_s * set.unit.y() * (2.0 * v - 1.0); }

SamplesPointer samples_of(const SiteSet& set) {
  const Eigen::Index count = set.points.cols();
  Eigen::VectorXd force_N(count);
  RandomStream noise(7, 3);
  for (Eigen::Index i = 0; i < count; ++i)
    force_N(i) = set.force_unit * (unit_force_N(set.points(0, i), set.points(1, i)) + kNoise_N * noise.normal());
  if (set.fault) set.fault(force_N);
  Samples samples;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    Sample row;
    row.tool.time_s = kSample_s * static_cast<double>(i);
    row.motion = {depth_m(set, set.points(0, i)), velocity_m_per_s(set, set.points(1, i))};
    row.tool.position_m = row.motion.position_m;
    row.force_N = force_N(i);
    squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
    samples.depth_m = std::max(samples.depth_m, row.motion.position_m);
    samples.force_N = std::max(samples.force_N, row.force_N);
    samples.fold.push_back(static_cast<int>(kFolds * i / count));
    samples.stroke.push_back(samples.fold.back() + 1);
    samples.unit.push_back(samples.fold.back());
    samples.recording.push_back(0);
    samples.contact.push_back(static_cast<std::size_t>(i));
    samples.rows.push_back(row);
  }
  samples.folds = kFolds;
  samples.units = kFolds;
  samples.offsets.emplace_back().name = "sites";
  samples.recorded_rows = static_cast<std::size_t>(count);
  samples.force_noise_N = kNoise_N * set.force_unit;
  samples.rms_velocity_m_per_s = std::sqrt(squares / static_cast<double>(count));
  samples.sample_s = kSample_s;
  samples.longest_recording_s = kSample_s * static_cast<double>(count);
  return std::make_shared<const Samples>(std::move(samples));
}

HardFigures measure(const SiteSet& set, const FittedModel& model) {
  const auto force_at = [&](double u, double v) {
    const double features[] = {depth_m(set, u), velocity_m_per_s(set, v)};
    return model.force(features);
  };
  const auto measure_at = [&](const Points& points) {
    HardMeasure measured;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const double u = points(0, i), v = points(1, i);
      measured.add(force_at(u, v), set.force_unit * unit_force_N(u, v), true);
    }
    return measured.figures();
  };
  HardFigures figures = measure_at(set.tested);
  // Steps count along the whole path, also where no site determines the force.
  const HardFigures along_path = measure_at(path());
  figures.worst_step_N = along_path.worst_step_N;
  figures.step_over_N = along_path.step_over_N;
  return figures;
}

// The sites form 40 clusters of this radius; the force is compared at their middles.
void in_clusters(SiteSet& set, double radius, Eigen::Index count = kSites) {
  constexpr Eigen::Index kClusters = 40;
  const Points middles = set.points.leftCols(kClusters);
  const Points around = random_points(count, 4);
  set.points = around;
  for (Eigen::Index i = 0; i < count; ++i)
    set.points.col(i) = middles.col(i % kClusters) + radius * (around.col(i) - Point(0.5, 0.5));
  set.tested = middles;
}

// Sites and path on the image of the square.
void mapped(SiteSet& set, Point (*to)(double u, double v)) {
  for (Points* points : {&set.points, &set.tested})
    for (auto point : points->colwise()) point = to(point.x(), point.y());
}

void first_sites(SiteSet& set, Eigen::Index count) {
  set.points = set.points.leftCols(count).eval();
  set.tested = set.points;
}

void sites_twice(SiteSet& set) { set.points.rightCols(kSites / 2) = set.points.leftCols(kSites / 2).eval(); }

HardCase site_case(const char* name, void (*shape)(SiteSet& set)) {
  return {
      name, "sites", [shape] {
        const auto set = std::make_shared<SiteSet>();
        shape(*set);
        const TrainingScene scene{"hard case", {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}}, {}};
        const ModelPlan plan{.thinning = Thinning::none, .features = FeatureChoice::scene};
        return HardTrial{std::make_shared<HardTraining>(ModelFits(samples_of(*set), scene), plan),
                         [set](const auto& model) { return measure(*set, *model); }};
      }};
}

}  // namespace

// Noise of 5 mN, a change of the true force of 10 mN from tick to tick. The trend alone cannot describe these forces.
std::vector<HardCase> site_cases() {
  return {
      site_case("sites, nothing wrong", [](SiteSet&) {}),
      site_case("repeated sites", sites_twice),
      site_case("repeated sites that disagree",
                [](SiteSet& set) {
                  sites_twice(set);
                  set.fault = [](Eigen::VectorXd& force_N) {
                    force_N.tail(kSites / 2).array() += 0.05;
                    force_N.head(kSites / 2).array() -= 0.05;
                  };
                }),
      site_case("clusters of 1e-9", [](SiteSet& set) { in_clusters(set, 1e-9); }),
      site_case("clusters of 1e-6", [](SiteSet& set) { in_clusters(set, 1e-6); }),
      site_case("clusters of 1e-3", [](SiteSet& set) { in_clusters(set, 1e-3); }),
      site_case("one force per cluster",
                [](SiteSet& set) {
                  in_clusters(set, 5e-3, 1000);
                  set.fault = [](Eigen::VectorXd& force_N) {
                    for (Eigen::Index i = 40; i < force_N.size(); ++i) force_N(i) = force_N(i % 40);
                  };
                }),
      site_case("sites on a line",
                [](SiteSet& set) { mapped(set, [](double u, double) { return Point(u, 0.8 * u + 0.1); }); }),
      site_case("sites on a curve",
                [](SiteSet& set) { mapped(set, [](double u, double) { return Point(u, 4.0 * u * (1.0 - u)); }); }),
      site_case("a feature that is constant",
                [](SiteSet& set) { mapped(set, [](double u, double) { return Point(u, 0.7); }); }),
      site_case("all sites at one point",
                [](SiteSet& set) { mapped(set, [](double, double) { return Point(0.6, 0.45); }); }),
      site_case("a dense and a sparse part",
                [](SiteSet& set) {
                  for (Eigen::Index i = 0; i < kSites; ++i)
                    if (i % 8 != 0) set.points.col(i) = Point(0.5, 0.5) + 1e-5 * set.points.col(i);
                  set.tested = set.points;
                }),
      site_case("scales of 1e-6 and 1e6",
                [](SiteSet& set) {
                  set.unit = {1e-6, 1e6};
                }),
      site_case("scales of 1e6 and 1e-6",
                [](SiteSet& set) {
                  set.unit = {1e6, 1e-6};
                }),
      site_case("forces of 1e-6", [](SiteSet& set) { set.force_unit = 1e-6; }),
      site_case("forces of 1e6", [](SiteSet& set) { set.force_unit = 1e6; }),
      site_case("outliers",
                [](SiteSet& set) {
                  set.fault = [](Eigen::VectorXd& force_N) {
                    for (Eigen::Index i = 7; i < force_N.size(); i += 20) force_N(i) += 20.0;
                  };
                }),
      site_case("a gap",
                [](SiteSet& set) {
                  for (Eigen::Index i = 0; i < kSites; ++i) {
                    double& u = set.points(0, i);
                    u = u < 0.5 ? 0.7 * u : 1.0 - 0.7 * (1.0 - u);
                  }
                }),
      site_case("1 site", [](SiteSet& set) { first_sites(set, 1); }),
      site_case("3 sites", [](SiteSet& set) { first_sites(set, 3); }),
      site_case("sizes above the number of sites", [](SiteSet& set) { first_sites(set, 40); }),
      site_case("10,000 sites", [](SiteSet& set) { set.points = random_points(10000, 1); }),
      site_case("all forces zero", [](SiteSet& set) { set.force_unit = 0.0; }),
  };
}

// What sensors and hands do wrong, on a soft block that the features describe: the true force of another press decides.

namespace {

constexpr double kRecordedSeconds = 6.0;
constexpr double kRecordedRate_Hz = 125.0;

// Up to about 2.5 N at 6 mm.
constexpr MaxwellParameters kSoft = {.elastic_linear_N_per_m = 300.0,
                                     .elastic_quadratic_N_per_m2 = 2e4,
                                     .viscosity_Ns_per_m2 = 500.0,
                                     .branches = {{{0.17, 100.0, 0.0}}}};
constexpr double kLargest_N = 2.5;

// The recording of a case and the press that it is tested on.
struct FaultyPress {
  Path training = training_path(0);
  Path tested = training_path(1);
  std::vector<double> times_s = even_times(kRecordedSeconds, kRecordedRate_Hz);
  PressSensors sensors{};
  std::function<void(std::vector<RecordingRow>&)> fault{};

  void move(double factor, double offset_m) {
    training = scaled(training, factor, offset_m);
    tested = scaled(tested, factor, offset_m);
  }
  // Changes each force.
  template <typename Change>
  void change(Change to) {
    fault = [to](std::vector<RecordingRow>& rows) {
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].force_N = to(i, rows[i].force_N);
    };
  }
};

HardTrial build(const FaultyPress& presses) {
  MaxwellBlock block(kSoft);
  Recording recording = press_into(block, presses.training, presses.times_s, presses.sensors).recording;
  if (presses.fault) presses.fault(recording.rows);
  const auto tested = std::make_shared<const Press>(press_into(block, presses.tested, even_times(4.0, 1000.0)));
  return {train_on(std::move(recording)), [tested](const auto& model) { return measure_press(*tested, model); }};
}

std::vector<double> jittered_times() {
  RandomStream random(7, 5);
  std::vector<double> times_s = even_times(kRecordedSeconds, kRecordedRate_Hz);
  for (double& time_s : times_s) time_s += random.uniform(-0.45, 0.45) / kRecordedRate_Hz;
  return times_s;
}

// The times outside of these intervals; one in `one_in` of the others is lost, too (0: none).
std::vector<double> times_without(std::initializer_list<std::pair<double, double>> gaps_s, std::size_t one_in) {
  RandomStream random(7, 6);
  std::vector<double> kept_s;
  for (const double time_s : even_times(kRecordedSeconds, kRecordedRate_Hz)) {
    const bool lost = one_in > 0 && random.index(one_in) == 0;
    const bool gap = std::ranges::any_of(gaps_s, [&](const auto& g) { return time_s > g.first && time_s < g.second; });
    if (!lost && !gap) kept_s.push_back(time_s);
  }
  return kept_s;
}

// In and out between the air and the full depth, at one speed.
Path at_one_speed(double speed_m_per_s) {
  return [=](double time_s) {
    constexpr double kWay_m = kTrainingDepth_m - kInAir_m;
    const double phase = std::fmod(speed_m_per_s * time_s / kWay_m, 2.0);
    return kInAir_m + kWay_m * (phase < 1.0 ? phase : 2.0 - phase);
  };
}

HardCase recording_case(const char* name, void (*shape)(FaultyPress& press)) {
  return {name, "recording", [shape] {
            FaultyPress presses;
            shape(presses);
            return build(presses);
          }};
}

}  // namespace

std::vector<HardCase> recording_cases() {
  return {
      recording_case("recording, nothing wrong", [](FaultyPress&) {}),
      recording_case("forces near zero", [](FaultyPress& p) { p.move(0.02, 0.0); }),
      recording_case("all forces read zero", [](FaultyPress& p) { p.change([](std::size_t, double) { return 0.0; }); }),
      recording_case("one outlier of 100 N",
                     [](FaultyPress& p) {
                       p.fault = [](std::vector<RecordingRow>& rows) {
                         std::ranges::max_element(rows, {}, &RecordingRow::position_m)->force_N = 100.0;
                       };
                     }),
      recording_case("noise of a fifth",
                     [](FaultyPress& p) {
                       p.change([random = std::make_shared<RandomStream>(7, 4)](std::size_t, double f) {
                         return f * (1.0 + 0.2 * random->normal());
                       });
                     }),
      recording_case("noise 10 times the signal", [](FaultyPress& p) { p.sensors.force_noise_N = 10.0 * kLargest_N; }),
      recording_case("a force sensor that drifts",
                     [](FaultyPress& p) {
                       p.change([](std::size_t i, double f) {
                         return f + 0.2 * static_cast<double>(i) / (kRecordedSeconds * kRecordedRate_Hz);
                       });
                     }),
      recording_case("a saturated sensor",
                     [](FaultyPress& p) { p.change([](std::size_t, double f) { return std::min(f, 1.0); }); }),
      recording_case("drop-outs of the force",
                     [](FaultyPress& p) { p.change([](std::size_t i, double f) { return i % 75 < 5 ? 0.0 : f; }); }),
      recording_case("quantised positions", [](FaultyPress& p) { p.sensors.encoder_step_m = 0.25e-3; }),
      recording_case("strokes that contradict",
                     [](FaultyPress& p) {
                       p.change([](std::size_t i, double f) {
                         return 2 * static_cast<double>(i) < kRecordedSeconds * kRecordedRate_Hz ? f : 1.3 * f;
                       });
                     }),
      recording_case("the force is late",
                     [](FaultyPress& p) {
                       p.fault = [](std::vector<RecordingRow>& rows) {
                         for (std::size_t i = rows.size(); i-- > 3;) rows[i].force_N = rows[i - 3].force_N;
                       };
                     }),
      recording_case("one constant speed", [](FaultyPress& p) { p.training = at_one_speed(0.02); }),
      recording_case("slow training, fast test",
                     [](FaultyPress& p) {
                       p.training = at_one_speed(0.001);
                       p.times_s = even_times(3.0 * kRecordedSeconds, kRecordedRate_Hz);
                       p.tested = [path = p.tested](double t) { return path(3.0 * t); };
                     }),
      recording_case("a shorter range than the test",
                     [](FaultyPress& p) { p.training = scaled(p.training, 0.5, 0.0); }),
      recording_case("lost samples", [](FaultyPress& p) { p.times_s = times_without({}, 10); }),
      recording_case("gaps in time",
                     [](FaultyPress& p) {
                       p.times_s = times_without({{1.2, 1.45}, {2.6, 2.85}, {3.9, 4.4}}, 0);
                     }),
      recording_case("10 Hz", [](FaultyPress& p) { p.times_s = even_times(30.0, 10.0); }),
      recording_case("20 kHz", [](FaultyPress& p) { p.times_s = even_times(0.6, 20000.0); }),
      recording_case("jittered time stamps", [](FaultyPress& p) { p.times_s = jittered_times(); }),
      recording_case("never leaves the surface", [](FaultyPress& p) { p.move(0.4, 0.004); }),
      recording_case("never touches", [](FaultyPress& p) { p.move(1.0, -0.02); }),
      recording_case("the tool stands still", [](FaultyPress& p) { p.training = [](double) { return 0.003; }; }),
  };
}

// Motions unlike the training, and a hand in closed loop, on virtual materials with automatically selected features.

namespace {

// Long enough to identify every feature.
constexpr double kMaterialSeconds = 12.0;
constexpr double kMaterialRate_Hz = 250.0;

// The training on a material, and its greatest depth and force.
struct Training {
  std::shared_ptr<HardTraining> fits;
  double depth_m = 0.0, force_N = 0.0;
};
using Trainings = std::map<std::string, Training>;

// Makes the training when it is first needed.
const Training& training_on(const std::string& material, Trainings& made) {
  Training& one = made[material];
  if (one.fits) return one;
  Recording recording =
      std::move(*record_sensors({.material = material, .seconds = kMaterialSeconds, .rate_Hz = kMaterialRate_Hz}));
  one.depth_m = std::ranges::max_element(recording.rows, {}, &RecordingRow::position_m)->position_m;
  one.force_N = std::ranges::max_element(recording.rows, {}, &RecordingRow::force_N)->force_N;
  one.fits = train_on(std::move(recording));
  return one;
}

constexpr double kSlow_m_per_s = 0.05;  // of the sudden stop and of the endless press, at the size of the training

Path sine(double amplitude_m, double rate_Hz) {
  return [=](double t) { return amplitude_m * std::sin(2.0 * std::numbers::pi * rate_Hz * t); };
}

struct Motion {
  const char* name;
  Path (*path)(double size);  // `size`: greatest depth of the training over kTrainingDepth_m
  double seconds = 4.0;
};
const Motion kMotions[] = {
    {"half as deep again", [](double size) { return scaled(scaled(training_path(1), size, 0.0), 1.5, 0.0); }},
    {"three times as fast",
     [](double size) -> Path {
       return [path = scaled(training_path(1), size, 0.0)](double t) { return path(3.0 * t); };
     }},
    {"a hold ten times as long",
     [](double size) -> Path { return [=](double t) { return size * 0.004 * std::tanh(5.0 * t); }; }, 20.0},
    {"contact made and broken at 20 Hz", [](double size) { return sine(size * 0.003, 20.0); }},
    {"a sudden stop",
     [](double size) -> Path { return [=](double t) { return size * kSlow_m_per_s * std::min(t, 0.1); }; }, 1.0},
    {"deeper without end", [](double size) -> Path { return [=](double t) { return size * kSlow_m_per_s * t; }; },
     0.36},
    {"small cycles at depth",
     [](double size) -> Path {
       return [=, cycles = sine(size * 0.0002, 7.0)](double t) {
         return minimum_jerk(kInAir_m, size * 0.004, 0.4, t).aim_m + cycles(t);
       };
     }},
};

// Springs and dashpots, dry friction, a fluid in pores, a stiff inclusion at 6 mm.
void add_motions(std::vector<HardCase>& cases, const std::shared_ptr<Trainings>& trainings) {
  for (const std::string material : {"maxwell", "friction", "sponge", "layered"}) {
    for (const Motion& motion : kMotions) {
      cases.push_back(
          {material + ": " + motion.name, "motion", [=] {
             const Training& one = training_on(material, *trainings);
             const auto block = find_material(material)->make_block();
             const auto press = std::make_shared<const Press>(
                 press_into(*block, motion.path(one.depth_m / kTrainingDepth_m), even_times(motion.seconds, 1000.0)));
             return HardTrial{one.fits, [press](const auto& model) { return measure_press(*press, model); }};
           }});
    }
  }
}

constexpr double kPress = 0.3;  // of the largest force of the training

HardCase hand_case(const std::shared_ptr<Trainings>& trainings, const std::string& material, const std::string& name,
                   const HandTrial& trial) {
  return {material + ": " + name, "loop", [=] {
            const Training& one = training_on(material, *trainings);
            HandTrial at = trial;
            at.depth_m = std::sqrt(kPress) * one.depth_m;
            at.force_N = kPress * one.force_N;
            if (at.exchange_s > 0.0) at.other = one.fits->fit({"trend", *parse_plan("trend")}, {})->model;
            return HardTrial{one.fits, [=](const auto& model) {
                               const auto block = find_material(material)->make_block();
                               return measure_hand(at, *block, model);
                             }};
          }};
}

// A late or slow line reduces the force to what is stable (engine/live/force_guard.h), so that the hand goes deeper
// than it was recorded, and is not within the JND: steps and energy count.
struct Line {
  const char* name;
  double delay_s = 1e-3;
  double sample_s = 0.0;
};
constexpr Line kLines[] = {{"10 kHz, no delay", 0.0, 1e-4},  {"1 kHz, no delay", 0.0, 1e-3},
                           {"1 kHz, 3 ms late", 3e-3, 1e-3}, {"1 kHz, 10 ms late", 10e-3, 1e-3},
                           {"100 Hz, no delay", 0.0, 10e-3}, {"100 Hz, 10 ms late", 10e-3, 10e-3}};

// A finger in light contact, and a clenched fist (hard.h).
void add_hands(std::vector<HardCase>& cases, const std::shared_ptr<Trainings>& trainings, const std::string& material,
               const Line& line) {
  for (const auto& [hand, grip] :
       {std::pair{"light hand, ", Grip{"a light hand", 0.05, 100.0, 2.2}}, {"heavy hand, ", kGrips[2]}}) {
    HandTrial trial{{grip, kHardEncoder_m, line.delay_s}};
    trial.settings.sample_s = line.sample_s;
    cases.push_back(hand_case(trainings, material, std::string(hand) + line.name, trial));
  }
}

}  // namespace

std::vector<HardCase> material_cases() {
  const auto trainings = std::make_shared<Trainings>();
  std::vector<HardCase> cases;
  add_motions(cases, trainings);
  for (const char* material : {"maxwell", "stiff"})
    for (const Line& line : kLines) add_hands(cases, trainings, material, line);
  for (const char* material : {"friction", "sponge", "layered"})  // with memory
    add_hands(cases, trainings, material, {"1 kHz, 1 ms late"});
  for (const char* material : {"maxwell", "stiff"}) {
    cases.push_back(
        hand_case(trainings, material, "a pressed mass is released", {{mass_alone(), kHardEncoder_m, 1e-3}}));
    cases.push_back(hand_case(trainings, material, "swap while pressing", {{kGrips[1], kHardEncoder_m, 1e-3}, 0.1}));
    // What lines and devices do beside a constant delay.
    ClosedLoopSettings line{kGrips[1], kHardEncoder_m, 1e-3};
    line.sample_s = 1e-3;
    const auto add = [&](const char* name, const auto& change) {
      HandTrial trial{line};
      change(trial.settings);
      cases.push_back(hand_case(trainings, material, name, trial));
    };
    add("a delay of 1 to 4 ms", [](ClosedLoopSettings& at) { at.jitter_s = 3e-3; });
    add("one packet in ten is lost", [](ClosedLoopSettings& at) { at.lost_in = 10; });
    add("samples in groups of four", [](ClosedLoopSettings& at) { at.grouped = 4; });
    add("a device of 1 N", [](ClosedLoopSettings& at) { at.limits.largest_N = 1.0; });
  }
  return cases;
}

}  // namespace palpate
