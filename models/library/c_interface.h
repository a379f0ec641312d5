// The model handle of the C interface, the conversion of recordings, and error reports: text in the caller's buffer,
// never an exception.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "models/library/palpate/palpate.h"
#include "models/model/fitted_model.h"

struct palpate_model {
  explicit palpate_model(std::shared_ptr<const palpate::FittedModel> fitted, std::string report_json = {})
      : model(std::move(fitted)), report(std::move(report_json)) {
    for (const palpate::FeatureSpec& spec : model->features()) feature_names.push_back(palpate::feature_name(spec));
  }

  std::shared_ptr<const palpate::FittedModel> model;
  std::string report;
  std::vector<std::string> feature_names;
};

namespace palpate::library {

// The rows of a recording in columns; a column that is missing is 0.
inline Recording recording_of(const palpate_recording& given) {
  const auto at = [](const double* column, std::size_t i) { return column == nullptr ? 0.0 : column[i]; };
  Recording recording{given.name == nullptr ? "" : given.name,
                      {given.velocity_m_per_s != nullptr, given.acceleration_m_per_s2 != nullptr},
                      std::vector<RecordingRow>(given.size)};
  for (std::size_t i = 0; i < given.size; ++i) {
    recording.rows[i] = {at(given.time_s, i), at(given.position_m, i), at(given.force_N, i),
                         at(given.velocity_m_per_s, i), at(given.acceleration_m_per_s2, i)};
  }
  return recording;
}

// Writes as much of `message` as fits into the caller's buffer, which may be null, in whole UTF-8 characters and with a
// terminating zero.
inline void write_text(char* text, std::size_t size, std::string_view message) noexcept {
  if (text == nullptr || size == 0) return;
  std::size_t count = std::min(message.size(), size - 1);
  const auto in_character = [&] { return (static_cast<unsigned char>(message[count]) & 0xC0U) == 0x80U; };
  while (count > 0 && count < message.size() && in_character()) --count;
  message.copy(text, count);
  text[count] = '\0';
}

// Returns the value of the Result that `work` returns. If it has an error or `work` throws, returns `failed` and writes
// the error to `error`, which is otherwise empty.
template <typename T, typename Work>
T made(T failed, char* error, std::size_t error_size, Work&& work) noexcept {
  write_text(error, error_size, "");
  try {
    const Result<T> done = work();
    if (done) return *done;
    write_text(error, error_size, done.error().message);
  } catch (const std::exception& exception) {
    write_text(error, error_size, exception.what());
  } catch (...) {
    write_text(error, error_size, "an exception that is not a std::exception");
  }
  return failed;
}

}  // namespace palpate::library
