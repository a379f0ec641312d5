// A separate program that uses the C++ interface of palpate::fit: cpp_program RECORDING
// FOLDER fits the recording and replays it.
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

int run(const std::string& path, const std::string& folder) {
  const std::string file = folder + "/fitted.json";
  const palpate::Recording recording(path);
  palpate::fit({recording}, "method=random centres=40").save(file);
  const palpate::Model model(file);
  palpate::Stream stream(model, palpate::Sensor(recording));
  std::vector<double> forces_N(recording->size);
  palpate_stream_replay(stream.handle(), &*recording, forces_N.data(), nullptr, nullptr);
  for (const double force_N : forces_N) std::printf("%.17g\n", force_N);

  bool good = recording->size > 1000;
  good = fails([&] { model.save(file); }, "fitted.json") && good;
  good =
      fails([&] { palpate::fit({recording}, "method=nothing"); }, "method: found \"nothing\", expected one of") && good;
  good = fails([&] { palpate::fit({}); }, "found no recording") && good;
  good = fails([&] { palpate::Recording none(folder + "/none.csv"); }, "none.csv") && good;
  good = fails([&] { palpate::Stream none(model, -1.0); }, "encoder_step_m") && good;
  good = fails([&] { palpate::Model none(file + '\0'); }, "zero byte") && good;
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
