#!/usr/bin/env python3
"""Fits and replays every available set of recordings. Changes of the fit are decided by its results.

  python3 tests/labs.py [--palpate build/palpate] [--recordings DIR ...] [--models NAME ...]
                        [--sets WORD ...] [--no-virtual] [--json FILE] [--against FILE] [--write]

Recorded sets come first: every folder with train*.csv and test*.csv in ../shared/data and ../shared/labs (if present)
or in DIR. Virtual materials follow. All use positions only, without the accelerometer column of the virtual rig.
Columns: the share [%] of the samples in contact within the JND, as recorded (aligned), for 0 N and every model; then,
for the last model that is no baseline, the 99 % quantile and the maximum of the error in JND as recorded, the coverage
of the 95 % bound and its median in JND, and the seconds of the fit. A test marked * continues a training recording, and the
program is told so (replay --after). "Aligned" fits the surface of the test (also force
zero and lag) to the forces of the test. It shows the error after registration of the rig and is not a prediction.

The sets of one folder are one rig. Means are over rigs, each the mean of its tests, with a 95 % interval from a
bootstrap over rigs; two models are compared by the mean of their differences, in the same way. Models are named as in
palpate fit --list-methods; of methods with a seed the medians of some seeds are shown. GP, forest and ridge
are the baselines of baselines.py. --json saves the figures; --against prints the differences from such a file;
--baselines FILE keeps those of the baselines, which do not depend on the program. --write puts the tables into
bench/RESULTS.md, and the means into README.md together with the sentence and the figure of a report on a material on
which the methods differ. Takes minutes on two cores. Needs python3-numpy and python3-sklearn.
"""
import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # a job a core, and times of one thread
import numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "models" / "library" / "python"))
import baselines
import palpate

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- results: python3 tests/labs.py --write -->", "<!-- end of results -->"
RESULTS = ROOT / "tests" / "bench" / "RESULTS.md"
FIGURE = "assets/figures/speed_error.png"
SHOWN = "layered"  # material of that figure; on others, such as silicone, all methods may equal the trend
MODELS = ["voxel", "random", "kdtree", "greedy", "trend", "trend+greedy"]
OURS = "trend+greedy"
SEEDED = ("random", "kdtree", "greedy")  # methods on the measured force with a seed: random draws, or digits of the sites
RECORDED, VIRTUAL = "Recorded sets", "Virtual materials"
LEAK_ROWS = 20  # equal forces in a row, with some different values, that two recordings do not have by chance
# Additional sets that do not follow from the file names of a folder.
# name: training recordings, test recordings.
MORE = {
    "aurora_skin, one press": (["aurora_skin/train_600mN"], ["aurora_skin/test_400mN", "aurora_skin/test_800mN"]),
    "zwick_silicone, one trial": (["zwick_silicone/train_trial3"], ["zwick_silicone/test_trial9"]),
    "zwick_trial1": ([f"zwick_silicone/train_trial{i}" for i in (3, 4, 7, 10, 12)], ["zwick_trial1/trial1"]),
    "dome_snap, one stroke": (["dome_snap/train1"], ["dome_snap/test3"]),
    "ecoflex 0T": (["ecoflex_static/EF10_0T_train_A1"], ["ecoflex_static/EF10_0T_test_A3", "ecoflex_static/EF10_0T_test_B2"]),
    "ecoflex 100T": (["ecoflex_static/EF10_100T_train_A1"],
                     ["ecoflex_static/EF10_100T_test_A3", "ecoflex_static/EF10_100T_test_B2"]),
}
# Tests that are the next part of a training recording, so that a person would say: replay --after.
AFTER = {"test_cycle2": "train_cycle1", "test_cycle3": "train_cycles1_2", "rearfoot_test_c96_100": "rearfoot_train_c90_95"}


def run(palpate, *arguments):
    done = subprocess.run([palpate, *map(str, arguments)], capture_output=True, encoding="utf-8")
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    return done.stdout


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Set:
    """Recordings to train on and to test on, and what the models are asked beyond them."""

    def __init__(self, name, train, tests, folder, palpate):
        self.name, self.rig, self.paths = name, train[0].parent.name, (train, tests)
        # All models have the surface that a fit finds, so that the same samples count.
        found = folder / f"{name.replace(' ', '_')}_surface.json"
        run(palpate, "fit", "--recording", *train, "--method", "trend", "--out", found)
        surface_m = json.loads(found.read_text())["features"][0].get("surface_position_m", 0.0)
        self.after = [next((path for path in train if path.stem == AFTER.get(test.stem)), None) for test in tests]
        # As a fit does, the training counts forces from its free air; tests are as recorded.
        checked = json.loads(run(palpate, "check", *train, "--json"))["recordings"]
        self.train = [baselines.Recording(path, surface_m, one["force_zero_N"]) for path, one in zip(train, checked)]
        self.tests = [baselines.Recording(path, surface_m) for path in tests]
        self.refuse_leaks()
        self.deepest_m = max(one.position.max() for one in self.train)
        self.largest_N = max(abs(one.force).max() for one in self.train)
        speeds = numpy.concatenate([self.speed(one)[one.contact()] for one in self.train])
        self.fastest_m_per_s = max(1e-6, numpy.quantile(speeds, 0.99))
        self.phases = [self.phases_of(test) for test in self.tests]
        # Presses half as deep again as the training, three times as fast.
        time_s = numpy.arange(4000) * 1e-3
        deep_m = 1.5 * self.deepest_m
        press = surface_m + deep_m * (0.5 - 0.5 * numpy.cos(2.0 * 3.0 * self.fastest_m_per_s / deep_m * time_s))
        self.beyond_path = folder / f"{name.replace(' ', '_')}_beyond.csv"
        self.beyond_path.write_text("time_s,position_m,force_N\n" + "".join(
            f"{at:.4f},{position:.9f},{(position - surface_m) / deep_m:.9f}\n" for at, position in zip(time_s, press)))
        self.beyond = baselines.Recording(self.beyond_path, surface_m)

    def refuse_leaks(self):
        trained = {window for one in self.train for window in self.windows(one)}
        for test, path in zip(self.tests, self.paths[1]):
            if not trained.isdisjoint(self.windows(test)):
                raise SystemExit(f"error: {path}: {LEAK_ROWS} of its forces in a row are in the training of {self.name}")

    def windows(self, recording):
        windows = numpy.lib.stride_tricks.sliding_window_view(recording.force, LEAK_ROWS)
        return {window.tobytes() for window in windows if len(set(window)) > LEAK_ROWS // 2}

    def speed(self, recording):
        return self.deepest_m * abs(recording.columns(self.deepest_m)[:, 1])

    def phases_of(self, test):
        """Which samples are where nothing was trained, or where a memory has just begun."""
        contact = test.contact()
        first, last = numpy.zeros_like(contact), numpy.zeros_like(contact)
        for stroke in test.strokes():
            tenth = len(stroke) // 10
            first[stroke[:tenth]] = last[stroke[len(stroke) - tenth:]] = True
        return {"first tenth of a contact": first, "last tenth of a contact": last,
                "deeper than the training": contact & (test.position > self.deepest_m),
                "faster than 99 % of the training": contact & (self.speed(test) > self.fastest_m_per_s)}

    def by_phase(self, index, forces, limit_N=None):
        """Share of the errors within the JND, or another limit."""
        test = self.tests[index]
        near = abs(forces - test.force) <= (baselines.jnd(test.force) if limit_N is None else limit_N)
        return {phase: 100 * near[rows].mean() for phase, rows in self.phases[index].items() if rows.sum() >= 20}


def share_of_nothing(test):
    """Share of the samples in contact within the JND, for a model that always returns 0 N."""
    forces = abs(test.force[test.contact()])
    return 100 * float((forces <= baselines.jnd(forces)).mean())


def of_baseline(one, kind):
    began = time.perf_counter()
    model = baselines.Baseline(baselines.KINDS[kind], one.train, one.deepest_m)
    seconds = time.perf_counter() - began
    tests = []
    for index, test in enumerate(one.tests):
        forces = model.forces(test)
        errors = (abs(forces - test.force) / baselines.jnd(test.force))[test.contact()]
        tests.append({"share": 100 * float((errors <= 1.0).mean()), "moved": None, "p99": float(numpy.quantile(errors, 0.99)),
                      "worst": float(errors.max()), "held": None, "bound": None, "phases": one.by_phase(index, forces)})
    rows = one.beyond.columns(model.greatest_m)[:1000]
    began = time.thread_time()
    model.model.predict(rows)  # in one call, in its favour
    return {"tests": tests, "seconds": seconds, "ns": 1e9 * (time.thread_time() - began) / len(rows),
            "beyond": float(abs(model.forces(one.beyond)).max() / one.largest_N)}


def of_model(options, folder, one, model):
    if model in baselines.KINDS:
        return of_baseline(one, model)
    try:
        seeds = [of_seed(options, folder, one, model, seed + 1)
                 for seed in range(options.seeds if model.split("-")[0] in SEEDED else 1)]
    except RuntimeError as error:
        return {"error": str(error)}
    tests = []
    for draws in zip(*(seed["tests"] for seed in seeds)):
        shares = [draw["share"] for draw in draws]
        tests.append({figure: value if isinstance(value, dict) else median([draw[figure] for draw in draws])
                      for figure, value in draws[0].items()} | {"range": (min(shares), max(shares))})
    return seeds[0] | {"tests": tests}


def median(values):
    known = sorted(value for value in values if value is not None)
    return known[len(known) // 2] if known else None


def replayed(palpate, folder, path, recording, after=None):
    """The figures of one model, and its forces."""
    forces = folder / (path.stem + "_forces.csv")
    found = json.loads(run(palpate, "replay", "--recording", recording, "--model", path, "--json", "--force", "--out", forces,
                           *(["--after", after] if after else [])))
    rows = numpy.loadtxt(forces, delimiter=",", skiprows=1)
    return found["models"][0], rows[:, -1]


def bounds_along(path, test, after):
    """The 95 % bound of a model at every row of a test; NaN without one."""
    model = palpate.load(path)
    if after is None:
        return model.render(test.time, test.recorded_m)[1]
    stream, bounds = palpate.Stream(model, after=after), []
    for time_s, position_m in zip(test.time, test.recorded_m):
        stream.force(time_s, position_m)
        bounds.append(stream.bound())
    return numpy.array(bounds)


def of_seed(options, folder, one, model, seed):
    train, tests = one.paths
    path = folder / f"{one.name} {model} {seed}.json".replace(" ", "_")
    began = time.perf_counter()
    fitted = json.loads(run(options.palpate, "fit", "--recording", *train, "--method", model, *options.fit.split(),
                            *(["--seed", seed] if seed > 1 else []), "--out", path, "--json"))
    seconds = time.perf_counter() - began
    figures = []
    for index, test in enumerate(tests):
        entry, forces = replayed(options.palpate, folder, path, test, one.after[index])
        bound = entry["predicted_error"] or {}
        held = bound.get("bound_95_held")
        figures.append({"share": 100 * entry["within_jnd"], "moved": 100 * entry["surface_moved"]["within_jnd"],
                        "p99": entry["p99_error_over_jnd"], "worst": entry["max_error_over_jnd"],
                        "held": None if held is None else 100 * held, "bound": bound.get("median_bound_over_jnd"),
                        "phases": one.by_phase(index, forces), "held_in": {}})
        if held is not None:
            figures[-1]["held_in"] = one.by_phase(index, forces, bounds_along(path, one.tests[index], one.after[index]))
    entry, forces = replayed(options.palpate, folder, path, one.beyond_path)
    return {"tests": figures, "seconds": seconds, "training": 100 * fitted["training_within_jnd"],
            "features": fitted["features"], "rank": fitted.get("rank"), "centres": fitted["centres"],
            "ns": entry["evaluation_ns"]["median"], "beyond": float(abs(forces).max() / one.largest_N)}


def recorded(options):
    folders = [path for base in options.recordings for path in sorted(pathlib.Path(base).glob("*")) if path.is_dir()]
    by_name = {folder.name: folder for folder in folders}
    for name, folder in by_name.items():
        # A name may have a part before the kind, and another kind in its rest: rearfoot_test_c1, train_test3.
        files = {path: min((path.stem.find(kind) % 1000, kind) for kind in ("train", "test"))[1]
                 for path in sorted(folder.glob("*.csv")) if "train" in path.stem or "test" in path.stem}
        train, tests = ([path for path, its in files.items() if its == kind] for kind in ("train", "test"))
        if train and tests and name != "ecoflex_static":
            yield name, train, tests
    for name, lists in MORE.items():
        train, tests = ([by_name.get(one.split("/")[0], pathlib.Path()) / (one.split("/")[1] + ".csv") for one in some]
                        for some in lists)
        if all(path.exists() for path in train + tests):
            yield name, train, tests
        else:
            print(f"skipped: {name}: not in {' or '.join(map(str, options.recordings))}", file=sys.stderr)


def virtual(options, folder):
    for line in run(options.palpate, "synth", "--list").splitlines():
        material = line.split()[0]
        if not options.wanted(material):
            continue
        (folder / material).mkdir()
        paths = [folder / material / f"{seed}.csv" for seed in (1, 2)]
        for path, seed, seconds in zip(paths, (1, 2), (41.499, 45.272)):
            run(options.palpate, "synth", "--material", material, "--seed", seed, "--seconds", seconds, "--out", path)
            rows = rows_of(path)
            with open(path, "w", newline="") as file:
                kept = [column for column in rows[0] if column != "acceleration_m_per_s2"]
                plain = csv.DictWriter(file, fieldnames=kept, extrasaction="ignore", lineterminator="\n")
                plain.writeheader()
                plain.writerows(rows)
        yield material, paths[:1], paths[1:]


def interval(values):
    """Mean over rigs, and its 95 % interval by a bootstrap (percentiles of 10,000 draws); None without values."""
    values = numpy.array(values)
    if len(values) == 0:
        return None
    draws = numpy.random.default_rng(1).choice(values, (10000, len(values))).mean(axis=1)
    return float(values.mean()), *map(float, numpy.quantile(draws, (0.025, 0.975)))


def by_rig(sets, results, model, figure):
    """For each rig the mean over its tests. `figure`: of a test, None where it is not known."""
    rigs = {}
    for one in sets:
        for test in results.get((one.name, model), {}).get("tests", []):
            if figure(test) is not None:
                rigs.setdefault(one.rig, []).append(figure(test))
    return {rig: sum(values) / len(values) for rig, values in rigs.items()}


def difference(sets, results, model, other, figure=lambda test: test["share"]):
    """Interval of the difference of two models, over the rigs that have both."""
    one, two = (by_rig(sets, results, name, figure) for name in (model, other))
    return interval([one[rig] - two[rig] for rig in one if rig in two])


def text(found, sign=""):
    return "" if found is None else "{0:{3}.1f} ({1:{3}.1f} to {2:{3}.1f})".format(*found, sign)


def cells(entry, value):
    return "refused" if "error" in entry else ", ".join(value(one) for one in entry["tests"])


def share(one):
    aligned = one["moved"] is not None and abs(one["share"] - one["moved"]) >= 0.05
    return f"{one['share']:.1f} ({one['moved']:.1f})" if aligned else f"{one['share']:.1f}"


def number(value, digits):
    return "none" if value is None else f"{value:{digits}}"


def table(sets, results, models):
    lines = ["| | 0 N | " + " | ".join(models) + " | 99 % up to [JND] | worst [JND] | within the bound | bound [JND] | fit [s] |",
             "|---|" + "---:|" * (len(models) + 6)]
    detailed = next((model for model in reversed(models) if model not in baselines.KINDS), models[-1])
    for one in sets:
        last = results[one.name, detailed]
        nothing = ", ".join(f"{share_of_nothing(test):.1f}" + "*" * bool(after) for test, after in zip(one.tests, one.after))
        lines.append(f"| {one.name} | {nothing} | "
                     + " | ".join(cells(results[one.name, model], share) for model in models) + " | "
                     + " | ".join(cells(last, lambda test, key=key, digits=digits: number(test[key], digits)) for key, digits in
                                  (("p99", ".2f"), ("worst", ".2f"), ("held", ".1f"), ("bound", ".2f")))
                     + f" | {number(last.get('seconds'), '.2f')} |")
    return lines


def means(kinds, results, models):
    """One line a model: mean share as recorded, and what OURS has more. With several rigs, with intervals."""
    heads = [f"{kind} ({sum(len(one.tests) for one in sets)} tests, {len({one.rig for one in sets})} rigs) | {OURS} minus it"
             for kind, sets in kinds.items()]
    yield "| model | " + " | ".join(heads) + " |"
    yield "|---|" + "---:|" * 2 * len(heads)
    for model in models:
        row = []
        for sets in kinds.values():
            row.append(text(interval(list(by_rig(sets, results, model, lambda test: test["share"]).values()))))
            row.append(text(difference(sets, results, OURS, model), "+") if OURS in models and model != OURS else "")
        yield f"| {model} | " + " | ".join(row) + " |"


def verdict(kind, sets, results, models):
    """Which models OURS is ahead of, and from which these rigs do not tell it."""
    ahead, equal, behind = [], [], []
    for model in models:
        found = difference(sets, results, OURS, model) if model != OURS else None
        if found:
            (ahead if found[1] > 0 else behind if found[2] < 0 else equal).append(model)
    parts = [f"ahead of {', '.join(ahead)} by more than the interval" if ahead else "",
             f"behind {', '.join(behind)} by more than the interval" if behind else "",
             f"not told from {', '.join(equal)}: the difference is within its interval" if equal else ""]
    return f"{kind}: {OURS} is " + "; ".join(filter(None, parts)) + "."


def hard(kinds, results, models):
    """Share within the JND where a model has little to go by, the force beyond the data, and the time of a sample."""
    every = [one for sets in kinds.values() for one in sets]
    yield f"| {len({one.rig for one in every})} rigs, recorded and virtual | " + " | ".join(models) + " |"
    yield "|---|" + "---:|" * len(models)
    for phase in every[0].phases[0]:
        figures = [by_rig(every, results, model, lambda test: test["phases"].get(phase)) for model in models]
        yield f"| {phase} ({len(figures[0])} rigs) | " + " | ".join(text(interval(list(one.values()))) for one in figures) + " |"
    known = {model: [results[one.name, model] for one in every if "beyond" in results[one.name, model]] for model in models}
    for what, value in (("largest force of presses half as deep again and three times as fast, over that of the training: "
                         "the worst set", lambda some: f"{max(one['beyond'] for one in some):.1f}"),
                        ("one force [ns], median", lambda some: f"{median([one['ns'] for one in some]):.0f}"),
                        ("fit [s], median", lambda some: f"{median([one['seconds'] for one in some]):.1f}")):
        yield f"| {what} | " + " | ".join(value(known[model]) if known[model] else "" for model in models) + " |"


def by_seed(kinds, results, models, seeds, points=5.0):
    """Which shares depend on the seed; the intervals leave this out."""
    named = []
    for model in models:
        wide = [(high - low, f"{low:.1f} to {high:.1f} on {one.name}") for sets in kinds.values() for one in sets for low, high in
                [test.get("range", (0.0, 0.0)) for test in results[one.name, model].get("tests", [])] if high - low >= points]
        named += [f"{model} {len(wide)} times ({max(wide)[1]})"] if wide else []
    return [f"Tests with {points:.0f} points or more between {seeds} seeds, whose median is shown: {', '.join(named)}."] if named else []


def beyond_data(kinds, results, models):
    """What a loop needs and a table of shares does not show, of OURS and of the standard models."""
    known = {model: [results[one.name, model] for sets in kinds.values() for one in sets if "beyond" in results[one.name, model]]
             for model in (OURS, *baselines.KINDS) if model in models}
    if len(known) > 1 and all(known.values()):
        yield ("Pressed half as deep again and three times as fast as in the training, the largest force over that of the training "
               "in the worst set: " + ", ".join(f"{model} {max(one['beyond'] for one in some):.1f}" for model, some in known.items())
               + ". One force takes, in the median of the sets: "
               + ", ".join(f"{model} {median([one['ns'] for one in some]):.0f} ns" for model, some in known.items()) + ".")


def bounds(kinds, results):
    for kind, sets in kinds.items():
        held = by_rig(sets, results, OURS, lambda test: test["held"])
        if held:
            width = median([test["bound"] for one in sets for test in results[one.name, OURS].get("tests", [])])
            yield (f"{kind}: the 95 % bound of {OURS} covers {text(interval(list(held.values())))} % of the samples, mean of {len(held)}"
                   f" rigs that have one; least {min(held.values()):.1f} %; median width {number(width, '.2f')} JND. By phase: "
                   + "; ".join(f"{phase} {text(interval(list(some.values())))} ({len(some)} rigs)" for phase in sets[0].phases[0]
                               if (some := by_rig(sets, results, OURS, lambda test: test["held_in"].get(phase)))) + ".")


def front_page(options, folder, parts, kinds, results):
    """Writes all sets to RESULTS.md; the means, and the sentence and figure of a report on SHOWN, to README.md."""
    rows, summary, beyond, sentences = parts
    RESULTS.write_text("\n".join(["# Results", "", "Made by `python3 tests/labs.py --write`, whose header describes the columns. Recorded sets",
                                  "come first; the source and licence of each are in a PROVENANCE.md beside it, outside this repository.",
                                  "Seconds of a fit are wall time beside another fit, and whatever else the machine did.",
                                  "", *rows, "", "Means by rig, with their 95 % intervals:", "", *summary, "", *sentences, "",
                                  "Where a model has little to go by (share [%] within the JND), and its cost:", "", *beyond, ""]))
    report = folder / "report"
    run(options.palpate, "report", "--train", folder / SHOWN / "1.csv", "--test", folder / SHOWN / "2.csv", "--out", report)
    answer = json.loads((report / "report.json").read_text())["timings"]["answer"]
    shutil.copyfile(report / "figures" / "speed_error.png", ROOT / FIGURE)
    short = [one.split("; median width")[0].rstrip(".") + "." for one in sentences]  # the phases are in RESULTS.md
    wrapped = [line for one in [*short, f"The report on the virtual {SHOWN} block: {answer}"]
               for line in textwrap.wrap(one, 118, initial_indent="- ", subsequent_indent="  ")] + [""]
    block = "\n".join([*summary, "", *wrapped,
                       f"![Time of a whole tick against error on the virtual {SHOWN} block: the methods of 2009 hollow, this program filled]({FIGURE})"])
    readme = ROOT / "README.md"
    before, rest = readme.read_text().split(BEGIN)
    readme.write_text(before + BEGIN + "\n" + block + "\n" + END + rest.split(END)[1])


def compare(kinds, results, path):
    """Prints tests that differ from an earlier file by 0.3 points, and the mean differences by rig."""
    before = json.loads(pathlib.Path(path).read_text())
    for kind, sets in kinds.items():
        for model in dict.fromkeys(key[1] for key in results):
            gains = {}
            for one in sets:
                pairs = zip(results[one.name, model].get("tests", []), before.get(f"{one.name}/{model}", {}).get("tests", []))
                for now, then in pairs:
                    gains.setdefault(one.rig, []).append(now["share"] - then["share"])
                    if abs(gains[one.rig][-1]) >= 0.3:
                        print(f"{one.name}/{model}: {then['share']:.2f} -> {now['share']:.2f}")
            if gains:
                print(f"{kind}, {model}: {text(interval([sum(some) / len(some) for some in gains.values()]), '+')}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--palpate", default=str(ROOT / "build" / "palpate"))
    parser.add_argument("--recordings", nargs="*", default=[ROOT.parent / "shared" / "data", ROOT.parent / "shared" / "labs"])
    parser.add_argument("--models", nargs="*", default=[*MODELS, *baselines.KINDS])
    parser.add_argument("--sets", nargs="*", default=[])
    parser.add_argument("--no-virtual", action="store_true")
    parser.add_argument("--seeds", type=int, default=5, help="fits of methods with a seed, as in a report")
    parser.add_argument("--fit", default="", help="more options of every fit, e.g. '--kernel linear'")
    parser.add_argument("--json")
    parser.add_argument("--against")
    parser.add_argument("--baselines", type=pathlib.Path, help="results of the baselines: read if there, else written")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    options.wanted = lambda name: not options.sets or any(word in name for word in options.sets)
    kept = json.loads(options.baselines.read_text()) if options.baselines and options.baselines.exists() else {}
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(scratch)
        build = pathlib.Path(options.palpate).resolve().parent
        os.environ["PALPATE_LIBRARY"] = str(build / "models" / "library" / "libpalpate_fit.so")
        real = [Set(*one, folder, options.palpate) for one in recorded(options) if options.wanted(one[0])]
        made = [Set(*one, folder, options.palpate) for one in virtual(options, folder)] if not options.no_virtual else []
        kinds = {kind: sets for kind, sets in ((RECORDED, real), (VIRTUAL, made)) if sets}
        jobs = {(one.name, model): pool.submit(of_model, options, folder, one, model)
                for one in real + made for model in options.models if f"{one.name}/{model}" not in kept}
        results = {}
        for one in real + made:
            for model in options.models:
                key = f"{one.name}/{model}"
                results[one.name, model] = jobs[one.name, model].result() if (one.name, model) in jobs else kept[key]
                if options.baselines and model in baselines.KINDS:
                    kept[key] = results[one.name, model]
                    options.baselines.write_text(json.dumps(kept, indent=1))
        rows = table(real + made, results, options.models)
        summary = list(means(kinds, results, options.models))
        beyond = list(hard(kinds, results, options.models))
        sentences = [verdict(kind, sets, results, options.models) for kind, sets in kinds.items() if OURS in options.models]
        sentences += [*bounds(kinds, results), *beyond_data(kinds, results, options.models),
                      *by_seed(kinds, results, options.models, options.seeds)]
        print("\n".join([*rows, "", *summary, "", *beyond, "", *sentences]))
        if options.write:
            front_page(options, folder, (rows, summary, beyond, sentences), kinds, results)
    for key, entry in results.items():
        if "error" in entry:
            print(f"{' '.join(key)}: {entry['error']}")
    saved = {"/".join(key): entry for key, entry in results.items()}
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(saved, indent=1))
    if options.against:
        compare(kinds, results, options.against)


if __name__ == "__main__":
    main()
