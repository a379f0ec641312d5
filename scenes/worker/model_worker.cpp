#include "scenes/worker/model_worker.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "models/linear/lapack.h"
#include "models/samples/recording_faults.h"
#include "scenes/evaluation/model_timing.h"
#include "scenes/material/rig.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

// Niceness of fits, so that graphics and haptics have priority where there are few cores.
constexpr int kNice = 10;
// Progress of a fit when the recording, and when the preparation is done; both are done once.
constexpr double kRecorded = 0.3;
constexpr double kPrepared = 0.7;

// Additional time of the trend, with its selection of features, so that the methods on the force come first.
constexpr double kTrend_s = 1.0;

// Approximate time to make a model; only the order matters. It puts a method after its base, from which it starts.
double expected_cost_s(const ModelRequest& request) {
  if (request.loaded != nullptr) return 0.0;
  return expected_seconds(*request.plan.method) + (request.plan.base == Base::trend ? kTrend_s : 0.0);
}

}  // namespace

Timing time_of_tick(const std::shared_ptr<const FittedModel>& model) {
  std::size_t feature = 0;
  const double depth_m = std::min(0.8 * deepest_in_domain_m(model->data(), feature), 0.01);
  SensorSpec sensor;
  sensor.has_velocity = true;
  std::vector<ToolSample> samples;
  for (int i = 0; i < 1024; ++i) {
    const double phase = 0.01 * i;
    ToolSample tool;
    tool.time_s = 1e-3 * i;
    tool.position_m = 0.5 * depth_m * (1.02 - std::cos(phase));
    tool.velocity_m_per_s = 5.0 * depth_m * std::sin(phase);
    samples.push_back(tool);
  }
  return time_models({model}, {{sensor, std::move(samples)}}).front().tick;
}

// On Linux, the niceness of one thread is set by its thread id.
void lower_thread_priority() noexcept { setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice); }

ModelWorker::ModelWorker(Scene scene, std::uint64_t seed) : scene_(std::move(scene)), seed_(seed) {}

ModelWorker::~ModelWorker() {
  cancel();
  {
    const std::lock_guard lock(mutex_);
    wake_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

Status ModelWorker::start() {
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error& error) {
    return Error{std::string("cannot start the thread that fits models: ") + error.what() + "; close other programs"};
  }
  return {};
}

void ModelWorker::add_job(std::size_t job_id, const ModelRequest& request, bool at_once) {
  const std::lock_guard lock(mutex_);
  std::erase_if(jobs_, [&](const auto& other) { return other.second.job_id == job_id; });
  jobs_.emplace(at_once ? -1.0 : expected_cost_s(request), Job{job_id, request});
  wake_.notify_all();
}

std::vector<FinishedModel> ModelWorker::read_finished() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, {});
}

ModelWorker::Progress ModelWorker::progress() const {
  const std::lock_guard lock(mutex_);
  return {working_on_.has_value(), working_on_.value_or(0), share_.load(std::memory_order_relaxed)};
}

void ModelWorker::work() {
  lower_thread_priority();
  for (std::unique_lock lock(mutex_);;) {
    working_on_.reset();
    wake_.wait(lock, [&] { return !jobs_.empty() || cancelled_.load(std::memory_order_relaxed); });
    if (cancelled_.load(std::memory_order_relaxed)) return;
    const Job job = std::move(jobs_.extract(jobs_.begin()).mapped());
    working_on_ = job.job_id;
    share_.store(0.0, std::memory_order_relaxed);
    lock.unlock();
    FinishedModel made{job.job_id, job.request.plan.centres, make(job.request), {}};
    if (made.model) made.tick = time_of_tick(*made.model);
    lock.lock();
    finished_.push_back(std::move(made));
  }
}

Result<std::shared_ptr<const FittedModel>> ModelWorker::make(const ModelRequest& request) {
  if (request.loaded != nullptr) return request.loaded;
  Result<ModelData> data = fit(request.plan);
  if (!data) return data.error();
  return std::make_shared<const FittedModel>(std::move(*data));
}

FitControl ModelWorker::control(double from, double to) {
  return {[this, from, to](double fraction) {
    share_.store(from + (to - from) * fraction, std::memory_order_relaxed);
    return !cancelled_.load(std::memory_order_relaxed);
  }};
}

Status ModelWorker::prepare_recordings() {
  if (fits_) return {};
  if (!scene_.has_material())
    return Error{"the scene \"" + scene_.name + "\" has no virtual material to fit a model to"};
  std::vector<PreparedRecordingPointer> recordings;
  for (const std::string& path : scene_.recordings) {
    Result<Recording> recording = read_usable_recording(path);
    if (!recording) return recording.error();
    recordings.push_back(prepare_recording(std::move(*recording)));
  }
  if (recordings.empty()) {
    Result<Recording> recording = record_sensors({*scene_.material, seed_}, control(0.0, kRecorded).progress);
    if (!recording) return recording.error();
    recordings.push_back(prepare_recording(std::move(*recording)));
  }
  fits_.emplace(std::move(recordings), training_scene(scene_));
  return {};
}

Result<ModelData> ModelWorker::fit(const ModelPlan& asked) {
  if (const Status status = prepare_recordings(); !status) return status.error();
  ModelPlan plan = asked;
  plan.seed = seed_;
  if (const auto prepared = fits_->prepare(plan, control(kRecorded, kPrepared)); !prepared) return prepared.error();
  // The progress of the preparation, or 0 if it was done before.
  const double done = share_.load(std::memory_order_relaxed);
  auto fitted = fits_->fit(plan, control(done, 1.0));
  if (!fitted) return fitted.error();
  return std::move(fitted->data);
}

void prepare_to_fit() { prepare_blas(); }

}  // namespace palpate
