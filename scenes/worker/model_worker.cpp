#include "scenes/worker/model_worker.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/parallel.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "engine/tick/haptics_tick.h"
#include "models/correction/methods.h"
#include "models/linear/lapack.h"
#include "models/model/file/model_io.h"
#include "models/samples/samples.h"
#include "scenes/material/rig.h"

namespace palpate {
namespace {

Result<ModelRequest> request_of(const Scene& scene, const std::string& asked) {
  const auto plan = parse_plan(asked);
  std::error_code missing;
  if (plan && scene.has_material()) return ModelRequest{*plan};
  if (plan) {
    return Error{"the scene \"" + scene.name +
                 "\" has no virtual material to fit models to; pass model files, made by palpate fit --scene " +
                 scene.name};
  }
  if (!std::filesystem::exists(asked, missing)) {
    return Error{"found no model \"" + asked + "\", expected the name of a model (" + family_names() +
                 ") or a model file that exists"};
  }
  auto model = load_model(asked);
  if (!model) return model.error();
  return ModelRequest{.plan = {}, .path = asked, .loaded = std::move(*model)};
}

// The name of a model of this method.
std::string named(const Method& method, int centres, Base base = Base::force) {
  return plan_name({.base = base, .method = &method, .centres = centres});
}

// The names of all plans on this base but that of the interpolation of every sample; on the force also the default.
std::vector<std::string> plans_on(Base base) {
  std::vector<std::string> names;
  for (const ModelPlan& plan : all_plans())
    if (plan.base == base && plan.method != &kDirectMethod) names.push_back(plan_name(plan));
  if (base == Base::force) names.push_back(plan_name(ModelPlan{}));
  return names;
}

const std::vector<int> kOfferedCentres{10, 20, 50, 100, 200};

std::vector<std::string> sizes_of(const Method& method) {
  std::vector<std::string> names;
  for (const int centres : kOfferedCentres) names.push_back(named(method, centres));
  return names;
}

// Niceness of fits, so that graphics and haptics have priority where there are few cores.
constexpr int kNice = 5;
// Progress of a fit when the virtual recording is done, which is done once.
constexpr double kRecorded = 0.2;

// Additional time of the first fit of a Base.
constexpr double kPreparation_s = 1.0;

constexpr std::uint64_t kReadySeed = 1;
constexpr const char* kInputs = "/inputs.txt";

std::string inputs_of(const Scene& scene, std::uint64_t seed) {
  return "material " + scene.material.value_or("none") + "\nseed " + std::to_string(seed) + "\nfeatures " +
         describe_features(scene) + "\nJND " + general(scene.jnd.offset_N, 17) + " N + " +
         general(scene.jnd.weber_fraction, 17) + " F\n";
}

// Empty if the inputs of the ready models are others.
std::string ready_folder(const std::string& folder, const Scene& scene, std::uint64_t seed) {
  const std::string of_scene = folder + "/" + scene.name;
  return read_whole_file(of_scene + kInputs) == inputs_of(scene, seed) ? of_scene : "";
}

std::string file_in(const std::string& folder, const ModelPlan& plan) {
  return folder + "/" + plan_name(plan) + ".json";
}

}  // namespace

std::string request_name(const ModelRequest& request) {
  return request.is_file() ? std::filesystem::path(request.path).stem().string() : plan_name(request.plan);
}

const std::vector<MethodChoice>& method_choices() {
  static const std::vector<MethodChoice> all = [] {
    std::vector<MethodChoice> choices;
    for (const ModelPlan& plan : all_plans())
      choices.push_back({family_name(plan), plan.selects_centres() ? kOfferedCentres : std::vector<int>{0}});
    return choices;
  }();
  return all;
}

const std::vector<LineUp>& line_ups() {
  static const std::vector<LineUp> all = {
      {"Comparison", "the methods of Hoever & Harders (2009) with 100 centres, and this program's default",
       plans_on(Base::force)},
      {"Sizes", "the greedy method with 10 to 200 centres", sizes_of(kGreedyMethod)},
      {"Corrections", "the trend alone, and with the correction of each method", plans_on(Base::trend)},
      {"Direct",
       "the interpolation of every sample",
       {named(kDirectMethod, 0), named(kVoxelMethod, 0), named(kDirectMethod, 0, Base::trend),
        plan_name(ModelPlan{})}}};
  return all;
}

const LineUp* find_line_up(const std::string& name) {
  const auto found = std::ranges::find(line_ups(), name, &LineUp::name);
  return found == line_ups().end() ? nullptr : &*found;
}

const std::vector<std::string>& exhibit_models() {
  static const std::vector<std::string> all{named(kKdTreeMethod, 2), named(kRandomMethod, 20), plan_name(ModelPlan{})};
  return all;
}

Result<std::vector<ModelRequest>> requested_models(const Scene& scene, const std::vector<std::string>& models) {
  std::vector<ModelRequest> requests;
  // Without a material and without named models, the session waits for a file.
  if (models.empty() && !scene.has_material()) return requests;
  for (const std::string& asked : models.empty() ? line_ups().front().models : models) {
    auto request = request_of(scene, asked);
    if (!request) return request.error();
    requests.push_back(std::move(*request));
  }
  if (requests.size() <= kMaxModels) return requests;
  return Error{"found " + std::to_string(requests.size()) + " models, expected at most " + std::to_string(kMaxModels) +
               "; leave some out"};
}

// On Linux, the niceness of one thread is set by its thread id.
void lower_thread_priority() noexcept { setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice); }

ModelWorker::ModelWorker(Scene scene, std::uint64_t seed, std::vector<Recording> training, const std::string& ready)
    : scene_(std::move(scene)),
      seed_(seed),
      ready_(training.empty() && !ready.empty() ? ready_folder(ready, scene_, seed) : ""),
      training_(std::move(training)) {}

Status ModelWorker::start() {
  try {
    thread_ = std::jthread([this] { work(); });
  } catch (const std::system_error& error) {
    return Error{std::string("cannot start a thread that fits models: ") + error.what() + "; close other programs"};
  }
  return {};
}

// Approximate time to make a model; only the order matters. It puts a method after its base, from which it starts.
double ModelWorker::expected_cost_s(const ModelRequest& request) const {
  if (request.loaded != nullptr || !ready_file(request.plan).empty()) return 0.0;
  return expected_seconds(*request.plan.method);
}

void ModelWorker::add_job(std::size_t job_id, const ModelRequest& request, bool at_once) {
  const std::lock_guard lock(mutex_);
  std::erase_if(jobs_, [&](const auto& other) { return other.second.job_id == job_id; });
  jobs_.emplace(at_once ? -1.0 : expected_cost_s(request), Job{job_id, request});
  end_s_ = 0.0;
  wake_.notify_all();
}

void ModelWorker::cancel_job(std::size_t job_id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(jobs_, [&](const auto& other) { return other.second.job_id == job_id; });
  if (working_on_ == job_id) interrupted_.store(true, std::memory_order_relaxed);
}

// The name of a plan says nothing of options beside its base, method and size.
std::string ModelWorker::ready_file(const ModelPlan& plan) const {
  if (ready_.empty()) return "";  // asked once a frame for each waiting model
  const auto named = parse_plan(plan_name(plan));
  const std::string file = file_in(ready_, plan);
  return named && *named == plan && std::filesystem::exists(file) ? file : "";
}

std::vector<FinishedModel> ModelWorker::read_finished() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, {});
}

std::optional<ModelWorker::Progress> ModelWorker::progress() const {
  const std::lock_guard lock(mutex_);
  if (!working_on_) return std::nullopt;
  return Progress{*working_on_, share_.load(std::memory_order_relaxed)};
}

double ModelWorker::left_s() const {
  const std::lock_guard lock(mutex_);
  double waiting_s = 0.0, running_s = 0.0;
  for (const auto& [key, job] : jobs_) waiting_s += expected_cost_s(job.request);
  const double now_s = steady_now_s();
  if (working_on_) {
    const double share = share_.load(std::memory_order_relaxed);
    if (share > 0.1) running_s = (now_s - began_s_) * (1.0 - share) / share;
    running_s = std::max(running_s, (1.0 - share) * expected_s_);
  }
  // The pace of the jobs before, beside other programs; a careful guess before there is one, so that the estimate does
  // not have to grow.
  const double pace = done_expected_s_ > 0.0 ? std::max(1.0, done_s_ / done_expected_s_) : 1.5;
  const double end_s = now_s + running_s + pace * waiting_s;
  end_s_ = end_s_ > 0.0 ? std::min(end_s_, end_s) : end_s;
  return std::max(0.0, end_s_ - now_s);
}

void ModelWorker::work() {
  lower_thread_priority();
  for (std::unique_lock lock(mutex_);;) {
    working_on_.reset();
    wake_.wait(lock, stop_.get_token(), [&] { return !jobs_.empty(); });
    if (stop_.stop_requested()) return;
    const Job job = std::move(jobs_.extract(jobs_.begin()).mapped());
    working_on_ = job.job_id;
    began_s_ = steady_now_s();
    expected_s_ = expected_cost_s(job.request) + (fits_ ? 0.0 : kPreparation_s);
    share_.store(0.0, std::memory_order_relaxed);
    interrupted_.store(false, std::memory_order_relaxed);
    lock.unlock();
    FinishedModel made{job.job_id, job.request.plan.centres, make(job.request)};
    lock.lock();
    done_s_ += steady_now_s() - began_s_;
    done_expected_s_ += expected_s_;
    if (!interrupted_.load(std::memory_order_relaxed)) finished_.push_back(std::move(made));
  }
}

Result<std::shared_ptr<const FittedModel>> ModelWorker::make(const ModelRequest& request) {
  if (request.loaded != nullptr) return request.loaded;
  if (const std::string ready = ready_file(request.plan); !ready.empty()) {
    if (auto model = load_model(ready)) return model;
  }
  if (const Status status = prepare_recordings(); !status) return status.error();
  ModelPlan plan = request.plan;
  plan.seed = seed_;
  // The progress of the virtual recording, or 0 if it was done before.
  const double done = share_.load(std::memory_order_relaxed);
  auto fitted = fits_->fit(plan, control(done, 1.0));
  if (!fitted) return fitted.error();
  return fitted->model;
}

FitControl ModelWorker::control(double from, double to) {
  return {[this, from, to](double fraction) {
    share_.store(from + (to - from) * fraction, std::memory_order_relaxed);
    return !stop_.stop_requested() && !interrupted_.load(std::memory_order_relaxed);
  }};
}

Status ModelWorker::prepare_recordings() {
  if (fits_) return {};
  if (!scene_.has_material())
    return Error{"the scene \"" + scene_.name + "\" has no virtual material to fit a model to"};
  if (training_.empty()) {
    Result<Recording> recording = record_sensors({*scene_.material, seed_}, control(0.0, kRecorded).progress);
    if (!recording) return recording.error();
    training_.push_back(std::move(*recording));
  }
  std::vector<PreparedRecordingPointer> recordings(training_.size());
  parallel_for(static_cast<int>(recordings.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    recordings[at] = prepare_recording(std::move(training_[at]));
  });
  training_.clear();
  fits_.emplace(std::move(recordings), training_scene(scene_));
  return {};
}

Status make_ready_models(const std::string& folder, const std::string& scene_name) {
  const auto scene = load_scene(scene_name);
  if (!scene) return scene.error();
  const std::string of_scene = folder + "/" + scene_name;
  std::error_code problem;
  std::filesystem::remove_all(of_scene, problem);
  if (!problem) std::filesystem::create_directories(of_scene, problem);
  if (problem) return Error{of_scene + ": " + problem.message()};
  ModelWorker worker(*scene, kReadySeed);
  for (const std::vector<std::string>& names : {line_ups().front().models, exhibit_models()}) {
    const auto requests = requested_models(*scene, names);
    if (!requests) return requests.error();
    for (const ModelRequest& request : *requests) {
      const auto model = worker.make(request);
      if (!model) return model.error();
      if (const Status status = save_model(file_in(of_scene, request.plan), (*model)->data(), true); !status)
        return status;
    }
  }
  return write_file_atomically(of_scene + kInputs, inputs_of(*scene, kReadySeed), true);
}

void prepare_to_fit() { prepare_blas(); }

}  // namespace palpate
