#!/usr/bin/env python3
"""Fits and replays every available set of recordings. Changes of the fit are decided by its results.

  python3 tests/labs.py [--palpate build/palpate] [--recordings DIR ...] [--models NAME ...]
                        [--sets WORD ...] [--no-virtual] [--json FILE] [--against FILE] [--write]

Recorded sets come first: every folder with train*.csv and test*.csv in ../shared/data and ../shared/labs (if present)
or in DIR. Virtual materials follow. All use positions only, without the accelerometer column of the virtual rig.
Columns: the share [%] of the samples in contact within the JND, as recorded (aligned), for 0 N and every model; then,
for the last model that is no baseline, the 99 % quantile and the maximum of the error in JND as recorded, the coverage
of the 95 % bound, and the seconds of the fit. "Aligned" fits the surface of the test (also force zero and lag) to the
forces of the test. It shows the error after registration of the rig and is not a prediction. Recorded sets and virtual
materials have separate means. Models are named as in palpate fit --list-methods; of methods that draw random numbers
the medians of five seeds are shown. bins and ridge are the baselines of baselines.py. --json saves the figures;
--against prints the differences from such a file. --write puts the table into bench/RESULTS.md, and its means into
README.md together with the sentence and the figure of a report on a material on which the methods differ. Takes minutes
on two cores. Needs python3-numpy.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time

import baselines

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- results: python3 tests/labs.py --write -->", "<!-- end of results -->"
RESULTS = ROOT / "tests" / "bench" / "RESULTS.md"
FIGURE = "assets/figures/speed_error.png"
SHOWN = "layered"  # material of that figure; on others, such as silicone, all methods may equal the trend
MODELS = ["voxel", "random", "kdtree", "greedy", "trend", "trend+greedy"]
PAPERS = "greedy"  # the most accurate method of Hoever & Harders (2009), with which others are compared
SEEDED = ("random", "greedy")  # methods on the measured force that draw random numbers
TIE = 0.3  # percentage points of a share that count as no difference
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


def run(palpate, *arguments):
    done = subprocess.run([palpate, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.decode().strip().splitlines()[-1])
    return done.stdout.decode()


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def share_of_nothing(test, surface_m):
    """Share of the samples in contact within the JND, for a model that always returns 0 N."""
    forces = abs(test.force[test.contact(surface_m)])
    return 100 * sum(forces <= baselines.jnd(forces)) / max(1, len(forces))


def of_baseline(key, train, tests):
    began = time.perf_counter()
    model = baselines.KINDS[key[1]]([baselines.Recording(path) for path in train])
    seconds = time.perf_counter() - began
    tests = [baselines.Recording(path) for path in tests]
    return key, {"tests": [{"nothing": share_of_nothing(test, 0.0), **baselines.figures(model, test)} for test in tests],
                 "seconds": seconds}


def of_model(options, folder, key, train, tests):
    name, model = key
    if model in baselines.KINDS:
        return of_baseline(key, train, tests)
    try:
        seeds = [of_seed(options, folder, key, train, tests, seed + 1)
                 for seed in range(options.seeds if model.split("-")[0] in SEEDED else 1)]
    except RuntimeError as error:
        return key, {"error": str(error)}
    middle = dict(seeds[0])
    middle["tests"] = [{figure: median([one["tests"][test][figure] for one in seeds]) for figure in seeds[0]["tests"][test]}
                       for test in range(len(tests))]
    return key, middle


def median(values):
    known = sorted(value for value in values if value is not None)
    return known[len(known) // 2] if known else None


def of_seed(options, folder, key, train, tests, seed):
    palpate = options.palpate
    path = folder / f"{abs(hash((key, seed)))}.json"
    began = time.perf_counter()
    fitted = json.loads(run(palpate, "fit", "--recording", *train, "--method", key[1], *options.fit.split(),
                            *(["--seed", seed] if seed > 1 else []), "--out", path, "--json"))
    seconds = time.perf_counter() - began
    found = json.loads(run(palpate, "replay", "--recording", *tests, "--model", path, "--json"))
    surface_m = json.loads(path.read_text()).get("surface_position_m", 0.0)
    figures = []
    for test, one in zip(tests, found if isinstance(found, list) else [found]):
        entry = one["models"][0]
        figures.append({"nothing": share_of_nothing(baselines.Recording(test), surface_m),
                        "share": 100 * entry["within_jnd"], "moved": 100 * entry["surface_moved"]["within_jnd"],
                        "p99": entry["p99_error_over_jnd"], "worst": entry["max_error_over_jnd"],
                        "held": 100 * (entry["predicted_error"]["bound_95_held"] or 0),
                        "offset_m": one["surface_offset_m"]})
    return {"tests": figures, "seconds": seconds, "training": 100 * fitted["training_within_jnd"],
            "features": fitted["features"]}


def wanted(options, name):
    return not options.sets or any(word in name for word in options.sets)


def recorded(options):
    folders = [path for base in options.recordings for path in sorted(pathlib.Path(base).glob("*")) if path.is_dir()]
    by_name = {folder.name: folder for folder in folders}
    for name, folder in by_name.items():
        train, tests = (sorted(folder.glob(f"*{kind}*.csv")) for kind in ("train", "test"))
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
        if not wanted(options, material):
            continue
        paths = [folder / f"{material}_{seed}.csv" for seed in (1, 2)]
        for path, seed, seconds in zip(paths, (1, 2), (41.499, 45.272)):
            run(options.palpate, "synth", "--material", material, "--seed", seed, "--seconds", seconds, "--out", path)
            rows = rows_of(path)
            with open(path, "w", newline="") as file:
                kept = [column for column in rows[0] if column != "acceleration_m_per_s2"]
                plain = csv.DictWriter(file, fieldnames=kept, extrasaction="ignore", lineterminator="\n")
                plain.writeheader()
                plain.writerows(rows)
        yield material, paths[:1], paths[1:]


def cells(entry, value):
    return "refused" if "error" in entry else ", ".join(value(one) for one in entry["tests"])


def share(one):
    return f"{one['share']:.1f} ({one['moved']:.1f})" if abs(one["share"] - one["moved"]) >= 0.05 else f"{one['share']:.1f}"


def table(names, results, models):
    lines = ["| | 0 N | " + " | ".join(models) + " | 99 % up to [JND] | worst [JND] | within the bound | fit [s] |",
             "|---|" + "---:|" * (len(models) + 5)]
    detailed = next((model for model in reversed(models) if model not in baselines.KINDS), models[-1])
    for name in names:
        entries = [results[name, model] for model in models]
        last = results[name, detailed]
        seconds = f"{last['seconds']:.2f}" if "seconds" in last else ""
        lines.append(f"| {name} | " + cells(last, lambda one: f"{one['nothing']:.1f}") + " | "
                     + " | ".join(cells(entry, share) for entry in entries) + " | "
                     + " | ".join(cells(last, lambda one, key=key, digits=digits: number(one[key], digits))
                                  for key, digits in (("p99", ".2f"), ("worst", ".2f"), ("held", ".1f")))
                     + f" | {seconds} |")
    return lines


def number(value, digits):
    return "none" if value is None else f"{value:{digits}}"


def means(kind, names, results, models):
    """For every model with tests in these sets: kind, model, mean shares as recorded and aligned, number
    of tests, and a sentence with the tests on which it differs from PAPERS."""
    for model in models:
        tests = {(name, index): one for name in names for index, one in enumerate(results[name, model].get("tests", []))}
        if not tests:
            continue
        recorded, moved = (sum(one[key] for one in tests.values()) / len(tests) for key in ("share", "moved"))
        text = ""
        if PAPERS in models and model != PAPERS:
            gains = [one["share"] - results[name, PAPERS]["tests"][index]["share"]
                     for (name, index), one in tests.items() if "tests" in results[name, PAPERS]]
            better, worse = sum(gain >= TIE for gain in gains), sum(gain <= -TIE for gain in gains)
            text = f"; against the greedy method of 2009 {better} better, {worse} worse, {len(gains) - better - worse} within {TIE} points"
        yield kind, model, f"{recorded:.2f}", f"{moved:.2f}", str(len(tests)), text


def sentence(row):
    return "%s, %s: mean %s %% as recorded, %s %% aligned, %s tests%s." % row


def front_page(options, folder, rows, summary):
    """Writes all sets to RESULTS.md; the means, and the sentence and figure of a report on SHOWN, to README.md."""
    RESULTS.write_text("\n".join(["# Results", "", "Made by `python3 tests/labs.py --write`, whose header describes",
                                  "the columns. Recorded sets come first; the source and licence of each are in a PROVENANCE.md beside it,",
                                  "outside this repository.", "", *rows, "", *map(sentence, summary), ""]))
    report = folder / "report"
    run(options.palpate, "report", "--train", folder / f"{SHOWN}_1.csv", "--test", folder / f"{SHOWN}_2.csv", "--out", report)
    answer = json.loads((report / "report.json").read_text())["timings"]["answer"]
    shutil.copyfile(report / "figures" / "speed_error.png", ROOT / FIGURE)
    kinds = list(dict.fromkeys(row[0] for row in summary))
    shares = {row[:2]: row[2:4] for row in summary}
    tests = {row[0]: row[4] for row in summary}
    text = "\n".join(["| model | " + " | ".join(f"{kind} ({tests[kind]} tests): as recorded | aligned" for kind in kinds) + " |",
                      "|---|" + "---:|" * 2 * len(kinds),
                      *("| " + " | ".join([model, *(cell for kind in kinds for cell in shares.get((kind, model), ("", "")))]) + " |"
                        for model in dict.fromkeys(row[1] for row in summary)), "", *textwrap.wrap(f"The report on the virtual {SHOWN} block: " + answer, 110), "",
                      f"![Time of a whole tick against error on the virtual {SHOWN} block: the methods of 2009 hollow, this program filled]({FIGURE})"])
    readme = ROOT / "README.md"
    before, rest = readme.read_text().split(BEGIN)
    readme.write_text(before + BEGIN + "\n" + text + "\n" + END + rest.split(END)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--palpate", default=str(ROOT / "build" / "palpate"))
    parser.add_argument("--recordings", nargs="*", default=[ROOT.parent / "shared" / "data", ROOT.parent / "shared" / "labs"])
    parser.add_argument("--models", nargs="*", default=[*MODELS, *baselines.KINDS])
    parser.add_argument("--sets", nargs="*", default=[])
    parser.add_argument("--no-virtual", action="store_true")
    parser.add_argument("--seeds", type=int, default=5, help="fits of methods that draw random numbers")
    parser.add_argument("--fit", default="", help="more options of every fit, e.g. '--kernel linear'")
    parser.add_argument("--json")
    parser.add_argument("--against")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(scratch)
        real = [one for one in recorded(options) if wanted(options, one[0])]
        sets = real + (list(virtual(options, folder)) if not options.no_virtual else [])
        jobs = [pool.submit(of_model, options, folder, (name, model), train, tests)
                for name, train, tests in sets for model in options.models]
        results = dict(job.result() for job in jobs)
        names = [name for name, _, _ in sets]
        rows = table(names, results, options.models)
        summary = [*means("Recorded sets", names[:len(real)], results, options.models),
                   *means("Virtual materials", names[len(real):], results, options.models)]
        print("\n".join([*rows, "", *map(sentence, summary)]))
        if options.write:
            front_page(options, folder, rows, summary)
    for key, entry in results.items():
        if "error" in entry:
            print(f"{' '.join(key)}: {entry['error']}")
    kept = {"/".join(key): entry for key, entry in results.items()}
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(kept, indent=1))
    if options.against:
        before = json.loads(pathlib.Path(options.against).read_text())
        for key, entry in kept.items():
            for now, then in zip(entry.get("tests", []), before.get(key, {}).get("tests", [])):
                for what in ("share", "moved"):
                    if abs(now[what] - then[what]) >= TIE:
                        print(f"{key} {what}: {then[what]:.2f} -> {now[what]:.2f}")


if __name__ == "__main__":
    main()
