// A fitted model in a user's program: consumer MODEL.json RECORDING.csv < FORCES.csv
// reads a table that starts with time and position, and prints the model's force and
// the limited force. The calls are those of the README.
#include <palpate/palpate.hpp>

#include <cstdio>

int main(int, char** argument) {
  const palpate::Model model(argument[1]);
  const auto sensor = palpate::Sensor(palpate::Recording(argument[2]));  // or its step: stream(model, 30e-6)
  palpate::Stream stream(model, sensor);
  palpate::Limiter limiter;
  double time_s = 0.0;
  double position_m = 0.0;
  std::scanf("%*[^\n]");  // the header
  while (std::scanf("%lf,%lf%*[^\n]", &time_s, &position_m) == 2) {
    const double force_N = stream.force(time_s, position_m);
    std::printf("%.17g,%.17g,%d\n", force_N, limiter.force(force_N, 1e-3), stream.out_of_domain());
  }
}
