"""cost.py BUILD: compares the time of an exported model with a call of the library. Prints one
line of Markdown for each method, in double and single precision. Fits a virtual recording,
compiles the exported file with cc -O2 for this machine, and times ticks of one recording, each
depending on the previous one. Times are processor time, the median of nine passes. Sizes are
.text of the compiled file, including constants."""
import csv
import pathlib
import subprocess
import sys
import tempfile

METHODS = ("trend", "random", "kdtree", "greedy", "voxel", "direct")

# `TICK` is what is timed; `START` comes before each pass.
TIMER = """
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
HEAD
static double time_s[20000], position_m[20000];
static int by_time(const void *a, const void *b) {
  return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}
int main(int count, char **argument) {
  double pass_ns[9], last = 0.0;
  int n = 0, k, i;
  (void)count;
  (void)argument;
  SETUP
  while (n < 20000 && scanf("%lf,%lf", &time_s[n], &position_m[n]) == 2) ++n;
  for (k = 0; k < 9; ++k) {
    clock_t begin;
    START
    begin = clock();
    for (i = 0; i < n; ++i) last = TICK;
    pass_ns[k] = 1e9 * (double)(clock() - begin) / CLOCKS_PER_SEC / n;
  }
  qsort(pass_ns, 9, sizeof pass_ns[0], by_time);
  printf("%g\\n", pass_ns[4] + 0.0 * last);
  return 0;
}
"""


def run(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def timed(folder, name, head, setup, start, tick, flags, motion, arguments=()):
    text = TIMER.replace("HEAD", head).replace("SETUP", setup).replace("START", start).replace("TICK", tick)
    (folder / (name + ".c")).write_text(text)
    run("cc", "-std=c99", "-O2", folder / (name + ".c"), *flags, "-o", folder / name, "-lm")
    return float(run(folder / name, *arguments, input=motion))


def exported(folder, palpate, model, motion, single):
    real = "float" if single else "double"
    source = folder / (model.stem + "_" + real + ".c")
    run(palpate, "export", model, "--c", source, *(["--float"] if single else []))
    run("cc", "-std=c99", "-O2", "-c", source, "-o", source.with_suffix(".o"))
    text_bytes = int(run("size", source.with_suffix(".o")).splitlines()[1].split()[0])
    tick = ("(double)palpate_force_after((%s)(time_s[i] - (i > 0 ? time_s[i - 1] : 0.0)), "
            "(%s)(position_m[i] + 1e-200 * last))" % (real, real))
    ns = timed(folder, source.stem + "_timer", "%s palpate_force_after(%s, %s);\nvoid palpate_reset(void);" % ((real,) * 3), "",
               "palpate_reset();", tick, [source.with_suffix(".o")], motion)
    return text_bytes, ns


def called(folder, build, model, motion):
    source = pathlib.Path(__file__).resolve().parents[3]
    library = build / "models" / "library"
    return timed(folder, model.stem + "_library", "#include <palpate/palpate.h>",
                 "palpate_stream *s = palpate_stream_new(palpate_model_load(argument[1], NULL, 0), 0, NULL, 0);",
                 "palpate_stream_reset(s);", "palpate_stream_force(s, time_s[i], position_m[i] + 1e-200 * last)",
                 ["-I", source / "models" / "library", "-L", library, "-lpalpate_model", "-Wl,-rpath," + str(library)],
                 motion, [model])


def main(build):
    build = pathlib.Path(build).resolve()
    palpate = build / "palpate"
    print("| method | code and tables, double | float | one tick, library | exported, double | exported, float |")
    print("|---|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        recording = folder / "rec.csv"
        run(palpate, "synth", "--material", "silicone", "--seed", 1, "--seconds", 20, "--out", recording)
        with open(recording, newline="") as file:
            rows = csv.DictReader(line for line in file if not line.startswith("#"))
            motion = "".join("%s,%s\n" % (row["time_s"], row["position_m"]) for row in rows)
        for method in METHODS:
            model = folder / (method + ".json")
            run(palpate, "fit", "--recording", recording, "--method", method, "--features", "scene", "--out", model)
            double, single = (exported(folder, palpate, model, motion, single) for single in (False, True))
            print("| %s | %.1f kB | %.1f kB | %.0f ns | %.0f ns | %.0f ns |" % (
                method, double[0] / 1e3, single[0] / 1e3, called(folder, build, model, motion), double[1], single[1]))
            sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
