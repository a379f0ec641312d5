#!/usr/bin/env python3
"""Every set of recordings that there is, fitted and replayed: the bench that decides about the fit.

  python3 tests/labs.py [--palpate build/palpate] [--recordings DIR ...] [--models NAME ...]
                        [--sets WORD ...] [--no-virtual] [--json FILE] [--against FILE] [--write]

Recorded sets first (every folder of ../shared/data and ../shared/labs, when they are there, with
train*.csv and test*.csv; or of other folders), then the virtual materials, all from positions alone: the
accelerometer column of the virtual rig is left out. Columns: share [%] of the samples in contact
within the JND, as recorded (surface moved), for 0 N and every model; then, of the last model, the 99 % and
the worst error in JND as recorded, how much of the test the 95 % bound held, and the seconds of its
fit. --json keeps the figures, --against prints what changed since such a file. --write puts the table
into README.md, with what a report says of the silicone and its figure. Minutes on two cores.
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

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- results: python3 tests/labs.py --models recipe trend greedy --write -->", "<!-- end of results -->"
FIGURE = "assets/figures/speed_error.png"
MODELS = {"trend": ["--method", "trend"],
          "recipe": ["--method", "greedy", "--reduction", "force", "--weighting", "relative", "--relaxation", "auto"],
          "direct": ["--method", "direct"], "voxel": ["--method", "voxel"], "random": ["--method", "random"],
          "kdtree": ["--method", "kdtree"], "greedy": ["--method", "greedy"]}
# Beside every folder with train*.csv and test*.csv: cases that a folder's names do not say.
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


def share_of_nothing(path, surface_m):
    """Share of the samples in contact within the JND of a model that always says 0 N. In contact
    is what lies behind the surface, or has a force that a hand notices (CONTRACT.md)."""
    forces = [(float(row["position_m"]), abs(float(row["force_N"]))) for row in rows_of(path)]
    within = [force <= 0.065 + 0.0633 * force for position, force in forces if position > surface_m or force > 0.065]
    return 100 * sum(within) / max(1, len(within))


def of_model(options, folder, key, train, tests):
    palpate = options.palpate
    name, model = key
    path = folder / f"{abs(hash(key))}.json"
    try:
        began = time.perf_counter()
        fitted = json.loads(run(palpate, "fit", "--recording", *train, *MODELS[model], *options.fit.split(), "--out", path, "--json"))
        seconds = time.perf_counter() - began
        found = json.loads(run(palpate, "replay", "--recording", *tests, "--model", path, "--json"))
    except RuntimeError as error:
        return key, {"error": str(error)}
    surface_m = json.loads(path.read_text()).get("surface_position_m", 0.0)
    figures = []
    for test, one in zip(tests, found if isinstance(found, list) else [found]):
        entry = one["models"][0]
        figures.append({"nothing": share_of_nothing(test, surface_m), "share": 100 * entry["within_jnd"], "moved": 100 * entry["surface_moved"]["within_jnd"],
                        "p99": entry["p99_error_over_jnd"], "worst": entry["max_error_over_jnd"],
                        "held": 100 * (entry["predicted_error"]["bound_95_held"] or 0),
                        "offset_m": one["surface_offset_m"]})
    return key, {"tests": figures, "seconds": seconds, "training": 100 * fitted["training_within_jnd"],
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
    last = models[-1]
    lines = ["| | 0 N | " + " | ".join(models) + " | 99 % up to [JND] | worst [JND] | bound held | fit [s] |",
             "|---|" + "---:|" * (len(models) + 5)]
    for name in names:
        entries = [results[name, model] for model in models]
        seconds = f"{entries[-1]['seconds']:.2f}" if "seconds" in entries[-1] else ""
        lines.append(f"| {name} | " + cells(entries[-1], lambda one: f"{one['nothing']:.1f}") + " | "
                     + " | ".join(cells(entry, share) for entry in entries) + " | "
                     + " | ".join(cells(entries[-1], lambda one, key=key, digits=digits: f"{one[key]:{digits}}")
                                  for key, digits in (("p99", ".2f"), ("worst", ".2f"), ("held", ".1f")))
                     + f" | {seconds} |")
    lines.append("")
    for model in models:
        values = [one["share"] for name in names for one in results[name, model].get("tests", [])]
        moved = [max(one["share"], one["moved"]) for name in names for one in results[name, model].get("tests", [])]
        lines.append(f"Mean of {model}: {sum(values) / len(values):.2f} % as recorded, "
                     f"{sum(moved) / len(moved):.2f} % moved ({len(values)} tests).")
    return lines


def front_page(options, folder, lines):
    """The table, what a report says of the silicone, and its figure, into README.md."""
    report = folder / "report"
    run(options.palpate, "report", "--train", folder / "silicone_1.csv", "--test", folder / "silicone_2.csv", "--out", report)
    answer = json.loads((report / "report.json").read_text())["timings"]["answer"]
    shutil.copyfile(report / "figures" / "speed_error.png", ROOT / FIGURE)
    text = "\n".join([*lines, "", *textwrap.wrap("The report on the silicone: " + answer, 90), "",
                      f"![Time of a whole tick against error on the virtual silicone: the 2009 recipe hollow, Palpate filled]({FIGURE})"])
    readme = ROOT / "README.md"
    before, rest = readme.read_text().split(BEGIN)
    readme.write_text(before + BEGIN + "\n" + text + "\n" + END + rest.split(END)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--palpate", default=str(ROOT / "build" / "palpate"))
    parser.add_argument("--recordings", nargs="*", default=[ROOT.parent / "shared" / "data", ROOT.parent / "shared" / "labs"])
    parser.add_argument("--models", nargs="*", default=list(MODELS))
    parser.add_argument("--sets", nargs="*", default=[])
    parser.add_argument("--no-virtual", action="store_true")
    parser.add_argument("--fit", default="", help="more options of every fit, e.g. '--surface recorded'")
    parser.add_argument("--json")
    parser.add_argument("--against")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(scratch)
        sets = [one for one in recorded(options) if wanted(options, one[0])]
        sets += virtual(options, folder) if not options.no_virtual else []
        jobs = [pool.submit(of_model, options, folder, (name, model), train, tests)
                for name, train, tests in sets for model in options.models]
        results = dict(job.result() for job in jobs)
        lines = table([name for name, _, _ in sets], results, options.models)
        print("\n".join(lines))
        if options.write:
            front_page(options, folder, lines)
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
                    if abs(now[what] - then[what]) >= 0.3:
                        print(f"{key} {what}: {then[what]:.2f} -> {now[what]:.2f}")


if __name__ == "__main__":
    main()
