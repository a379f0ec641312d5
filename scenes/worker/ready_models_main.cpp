// Fits the models with which the window of a scene starts: palpate-ready-models FOLDER SCENE. The build runs it.
#include <cstdio>

#include "scenes/worker/model_worker.h"

int main(int count, char** arguments) {
  palpate::prepare_to_fit();
  if (count != 3) return std::fputs("error: expected FOLDER SCENE\n", stderr), 2;
  const palpate::Status status = palpate::make_ready_models(arguments[1], arguments[2]);
  if (!status) std::fprintf(stderr, "error: %s\n", status.error().message.c_str());
  return status ? 0 : 1;
}
