// Palpate's models in a C++ program (C++17 or later): palpate.h with owning classes, defaults and exceptions.
//
//   palpate::Model model("block.json");
//   palpate::Stream stream(model, 30e-6);                  // encoder step in metres
//   palpate::Limiter limiter;                              // or of a palpate::Limits
//   for (;;) push(limiter.render(stream, time_s, position_m, step_s));
//
// With palpate::fit linked also
//   palpate::fit({palpate::Recording("press.csv")}, "method=random centres=40").save("block.json");
//
// palpate.h describes the functions, which are inline here and call C, so that a program may use another compiler than
// the library. Errors: a Failure is thrown. Functions marked noexcept never fail and may run in a haptics loop. Threads
// may share a Model; all else belongs to one thread at a time.
#ifndef PALPATE_PALPATE_HPP
#define PALPATE_PALPATE_HPP

#include <palpate/palpate.h>
#include <palpate/palpate_fit.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate {
// Keeps these names apart from those of the library, whose sources use namespace palpate.
inline namespace api {

// A file, an argument or the library itself is not valid.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace detail {

inline bool failed(const void* handle) { return handle == nullptr; }
inline bool failed(int status) { return status != 0; }

// `text` for C, which ends a text at its first zero.
inline const char* c_text(const std::string& text) {
  if (text.find('\0') != std::string::npos) throw Failure("found a zero byte in a name, expected none");
  return text.c_str();
}

// Calls a function of palpate.h that can fail and returns its result; if it failed, throws its error.
template <typename Function, typename... Arguments>
auto checked(Function function, Arguments... arguments) {
  char error[1024];
  const auto result = function(arguments..., error, sizeof error);
  if (failed(result)) throw Failure(error);
  return result;
}

struct Free {
  void operator()(palpate_model* model) const noexcept { palpate_model_free(model); }
  void operator()(palpate_stream* stream) const noexcept { palpate_stream_free(stream); }
  void operator()(palpate_limiter* limiter) const noexcept { palpate_limiter_free(limiter); }
  void operator()(palpate_recording* recording) const noexcept { palpate_recording_free(recording); }
};

}  // namespace detail

// A fitted model, read from a file of `palpate fit`. Copies share it.
class Model {
 public:
  // Throws: no such file, not a model, damaged; a library of another ABI version.
  explicit Model(const std::string& path) {
    if (palpate_abi_version() != PALPATE_ABI_VERSION) {
      throw Failure("found ABI version " + std::to_string(palpate_abi_version()) +
                    " of the palpate library, expected " + std::to_string(PALPATE_ABI_VERSION) +
                    "; build the program again");
    }
    model_.reset(detail::checked(palpate_model_load, detail::c_text(path)), detail::Free{});
  }
  // Takes over a handle.
  explicit Model(palpate_model* model) : model_(model, detail::Free{}) {}

  // E.g. "greedy-100".
  std::string name() const { return palpate_model_name(model_.get()); }
  // Writes the model file atomically. Throws: the file exists and is not to be replaced; it cannot be written.
  void save(const std::string& path, bool overwrite = false) const {
    detail::checked(palpate_model_save, model_.get(), detail::c_text(path), overwrite);
  }
  const palpate_model* handle() const noexcept { return model_.get(); }

 private:
  std::shared_ptr<palpate_model> model_;
};

// A recording in memory. Copies share it.
class Recording {
 public:
  // Throws: not a recording; with file, line and column.
  explicit Recording(const std::string& path)
      : recording_(detail::checked(palpate_recording_load, detail::c_text(path)), detail::Free{}) {}

  // Size and columns.
  const palpate_recording& operator*() const noexcept { return *recording_; }
  const palpate_recording* operator->() const noexcept { return recording_.get(); }

 private:
  std::shared_ptr<palpate_recording> recording_;
};

// The sensor of the tool; fields as in palpate.h, initially 0: exact positions.
struct Sensor : palpate_sensor {
  Sensor() noexcept : palpate_sensor{} {}
  // The sensor that `palpate replay` identifies.
  explicit Sensor(const Recording& recording) noexcept : palpate_sensor{} { palpate_sensor_of(&*recording, this); }
};

// One tool in one material. Movable; may outlive the model.
class Stream {
 public:
  // Positions in steps of so many metres; 0: the sensor of the training recordings. Throws: below 0 or not finite.
  explicit Stream(const Model& model, double encoder_step_m = 0.0)
      : stream_(detail::checked(palpate_stream_new, model.handle(), encoder_step_m)) {}
  // Throws: a number of the sensor is out of its range or not finite.
  Stream(const Model& model, const Sensor& sensor)
      : stream_(detail::checked(palpate_stream_new_with_sensor, model.handle(), &sensor)) {}

  // Resets; the next samples continue this recording of the same rig. Slow side.
  void start_after(const Recording& recording) {
    detail::checked(palpate_stream_start_after, stream_.get(), &*recording);
  }

  double force(double time_s, double position_m) noexcept {
    return palpate_stream_force(stream_.get(), time_s, position_m);
  }
  double force(double time_s, double position_m, double velocity_m_per_s, double acceleration_m_per_s2) noexcept {
    return palpate_stream_force_with_motion(stream_.get(), time_s, position_m, velocity_m_per_s, acceleration_m_per_s2);
  }
  bool accepted() const noexcept { return palpate_stream_accepted(stream_.get()) != 0; }
  bool out_of_domain() const noexcept { return palpate_stream_out_of_domain(stream_.get()) != 0; }
  double predicted_error_N() const noexcept { return palpate_stream_predicted_error(stream_.get()); }
  void reset() noexcept { palpate_stream_reset(stream_.get()); }
  palpate_stream* handle() noexcept { return stream_.get(); }

 private:
  std::unique_ptr<palpate_stream, detail::Free> stream_;
};

// Fields as in palpate.h, initially its defaults.
struct Limits : palpate_limits {
  Limits() noexcept : palpate_limits{} { palpate_limits_default(this); }
};

// The stages before an actuator: stability limit and passivity controller (with `render`), force limiter.
class Limiter {
 public:
  // Throws: a limit is out of its range.
  explicit Limiter(const Limits& limits = {}) : limiter_(detail::checked(palpate_limiter_new, &limits)) {}

  double render(Stream& stream, double time_s, double position_m, double step_s) noexcept {
    return palpate_limiter_render(limiter_.get(), stream.handle(), time_s, position_m, step_s);
  }
  // False, and no change: below 0 or not finite.
  bool set_lag(double lag_s) noexcept { return palpate_limiter_set_lag(limiter_.get(), lag_s) == 0; }
  void acted(double sampled_s) noexcept { palpate_limiter_acted(limiter_.get(), sampled_s); }
  double stiffness_share() const noexcept { return palpate_limiter_stiffness_share(limiter_.get()); }
  double force(double commanded_N, double step_s, double sample_age_s = 0.0) noexcept {
    return palpate_limiter_force(limiter_.get(), commanded_N, step_s, sample_age_s);
  }
  void stop() noexcept { palpate_limiter_stop(limiter_.get()); }
  // PALPATE_LIMIT_... bits of the last force.
  unsigned flags() const noexcept { return palpate_limiter_flags(limiter_.get()); }

 private:
  std::unique_ptr<palpate_limiter, detail::Free> limiter_;
};

// `palpate fit`: one model of all recordings; needs palpate::fit. `options`: as palpate_fit. Slow side. Throws: a
// recording that is not usable; an option that is not valid.
inline Model fit(const std::vector<Recording>& recordings, const std::string& options = "") {
  std::vector<palpate_recording> plain;
  for (const Recording& recording : recordings) plain.push_back(*recording);
  return Model(detail::checked(palpate_fit, plain.data(), plain.size(), detail::c_text(options), nullptr, nullptr));
}

}  // namespace api
}  // namespace palpate

#endif
