// A separate program that uses the C++ interface of palpate::fit: cpp_program TABLE
// FOLDER imports the table, checks the recording, fits it and replays it.
#include <palpate/palpate.hpp>

#include <cstdio>

namespace {

template <typename Call>
bool fails(Call&& call, const char* part) {
  try {
    call();
  } catch (const palpate::Failure& failure) {
    const bool says = std::string(failure.what()).find(part) != std::string::npos;
    if (!says) std::fprintf(stderr, "expected \"%s\" in: %s\n", part, failure.what());
    return says;
  }
  std::fprintf(stderr, "nothing failed: expected \"%s\"\n", part);
  return false;
}

int run(const std::string& table, const std::string& folder) {
  const std::string recording = folder + "/imported.csv";
  const std::string file = folder + "/fitted.json";
  palpate::import_table(table, recording);
  const palpate::Check check(recording);
  palpate::FitOptions options;
  options.method = "random";
  options.centres = 40;
  palpate::fit({recording}, file, options);

  const palpate::Recording rows(recording);
  const palpate::Model model(file);
  const auto sensor = palpate::Sensor::of_recording(recording);
  for (const double force_N : palpate::replay(model, rows, sensor)) std::printf("%.17g\n", force_N);

  bool good = check.usable > 0 && check.noise_floor_within_jnd > 0.5 && rows.size() > 1000;
  good = fails([&] { palpate::import_table(table, recording); }, "imported.csv") && good;
  good = fails([&] { palpate::fit({recording}, file, options); }, "fitted.json") && good;
  options.overwrite = 1;
  options.method = "nothing";
  good = fails([&] { palpate::fit({recording}, file, options); }, "expected one of trend") && good;
  options.method = "random";
  options.centres = 0;
  good = fails([&] { palpate::fit({recording}, file, options); }, "centres: found 0") && good;
  options.centres = 40;
  options.progress = [](double, void*) { return 0; };
  good = fails([&] { palpate::fit({recording}, file, options); }, "interrupted") && good;
  good = fails([&] { palpate::fit({folder + "/none.csv"}, file, {}); }, "none.csv") && good;
  good = fails([&] { palpate::fit({}, file, {}); }, "found no path") && good;
  good = fails([&] { palpate::Recording none(folder + "/none.csv"); }, "none.csv") && good;
  good = fails([&] { palpate::Check none(folder + "/none.csv"); }, "none.csv") && good;
  good = fails([&] { palpate::Stream none(model, palpate::Sensor(-1.0)); }, "encoder_step_m") && good;
  palpate::Limits limits;
  limits.largest_N = 0.0;
  good = fails([&] { palpate::Limiter none(limits); }, "largest_N") && good;
  return good ? 0 : 1;
}

}  // namespace

int main(int, char** argument) {
  try {
    return run(argument[1], argument[2]);
  } catch (const palpate::Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
}
