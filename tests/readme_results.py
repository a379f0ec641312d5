#!/usr/bin/env python3
"""The results of README.md: its table, its ladder and its headline figure.

  python3 tests/readme_results.py [--palpate build/palpate] [--recordings DIR] [--quick] [--write]

All of it from positions alone: the accelerometer column of the virtual rig is left out.
Prints the section; --write puts it between the marks of README.md and the figure into
assets/figures. --recordings: the folder with the real recordings (aurora_skin, zwick_silicone,
ur3e_press_mit), which are not part of the repository; without it their rows are left out.
--quick makes the figure from a quick report. Minutes on two cores.
"""
import argparse
import csv
import json
import pathlib
import shutil
import subprocess
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN = "<!-- results: python3 tests/readme_results.py --write -->"
END = "<!-- end of results -->"
FIGURE = "assets/figures/speed_error.png"
MATERIALS = [("silicone", "silicone"), ("foam", "foam"), ("gel", "gel"), ("tissue", "tissue (power law)"),
             ("softening", "softening and healing foam"), ("layered", "stiff layer 6 mm down"),
             ("friction", "dry friction"), ("sponge", "poroelastic sponge")]
# Whose surface lies elsewhere in every recording is judged with the surface moved.
REAL = [("aurora_skin", "real skin, 400, 800, 900 mN, surface moved", True),
        ("zwick_silicone", "real silicone, 10 Hz, surface moved", True),
        ("ur3e_press_mit", "robot press, cycle 1 → 2, twice as fast", False)]
RECIPES = {"trend": ["--method", "trend"],
           "paper": ["--method", "greedy", "--reduction", "force", "--weighting", "relative"],
           "greedy": ["--method", "greedy"]}


def run(palpate, *arguments):
    done = subprocess.run([palpate, *map(str, arguments)], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return done.stdout.decode()


def synth(palpate, material, seed, seconds, path):
    """A recording of the virtual rig without its accelerometer."""
    run(palpate, "synth", "--material", material, "--seed", seed, "--seconds", seconds, "--out", path, "--force")
    with open(path, newline="") as file:
        comments = []
        for line in file:
            if not line.startswith("#"):
                break
            comments.append(line)
        names = line.strip().split(",")
        rows = list(csv.DictReader(file, fieldnames=names))
    kept = [name for name in names if name != "acceleration_m_per_s2"]
    with open(path, "w", newline="") as file:
        file.writelines(comments)
        table = csv.DictWriter(file, fieldnames=kept, extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def nothing_within(path):
    """Share of the samples in contact within the JND of a model that always says 0 N."""
    within = count = 0
    with open(path, newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if float(row["position_m"]) <= 0.0:
                continue
            force = abs(float(row["force_N"]))
            count += 1
            within += force <= 0.065 + 0.0633 * force
    return within / count


def row_of(palpate, folder, name, train, tests, moved):
    replayed = {}  # recipe -> model's part for each test; one by one: each says itself where the surface is
    for recipe, arguments in RECIPES.items():
        model = folder / f"{recipe}.json"
        run(palpate, "fit", "--recording", *train, *arguments, "--out", model, "--force")
        found = json.loads(run(palpate, "replay", "--recording", *tests, "--model", model, "--json"))
        replayed[recipe] = [one["models"][0] for one in (found if isinstance(found, list) else [found])]

    def cell(recipe, value):
        return ", ".join(value(entry) for entry in replayed[recipe])

    def figure(entry):
        return entry["surface_moved"] if moved else entry

    def share(entry):
        return f"{100 * figure(entry)['within_jnd']:.2f}"

    def rms(entry):
        return f"{1e3 * figure(entry)['rms_error_N']:.3g}"

    def held(entry):
        return f"{100 * entry['predicted_error']['bound_95_held']:.1f}"

    zero = ", ".join(f"{100 * nothing_within(test):.1f}" for test in tests)
    p99 = max(figure(entry)["p99_error_over_jnd"] for entry in replayed["greedy"])
    worst = max(figure(entry)["max_error_over_jnd"] for entry in replayed["greedy"])
    return (f"| {name} | {zero} | {cell('paper', share)} | {cell('trend', share)} | {cell('greedy', share)} "
            f"| {p99:.2f} | {worst:.2f} | {cell('greedy', rms)} | {cell('greedy', held)} |")


def section(options, folder):
    lines = ["| | 0 N | 2009 recipe, times fitted, greedy-100 | trend alone | Palpate, greedy-100 | 99 % up to [JND] | worst [JND] | RMS [mN] "
             "| inside the predicted 95 % bound |", "|---|" + "---:|" * 8]
    train, test = folder / "train.csv", folder / "test.csv"
    for material, name in MATERIALS:
        for path, seed, seconds in ((train, 1, 41.499), (test, 2, 45.272)):
            synth(options.palpate, material, seed, seconds, path)
        lines.append(row_of(options.palpate, folder, name, [train], [test], False))
        print(lines[-1], flush=True)
    for name, words, moved in REAL if options.recordings else []:
        here = pathlib.Path(options.recordings) / name
        lines.append(row_of(options.palpate, folder, words, sorted(here.glob("train_*.csv")), sorted(here.glob("test_*.csv")), moved))
        print(lines[-1], flush=True)
    train, test = folder / "silicone_1.csv", folder / "silicone_2.csv"
    for path, seed, seconds in ((train, 1, 41.499), (test, 2, 45.272)):
        synth(options.palpate, "silicone", seed, seconds, path)
    report = folder / "report"
    run(options.palpate, "report", "--train", train, "--test", test, "--out", report, "--force", *(["--quick"] if options.quick else []))
    numbers = json.loads((report / "report.json").read_text())
    lines += ["", *textwrap.wrap("The report on the silicone: " + numbers["timings"]["answer"], 90), "",
              f"![Time of a whole tick against error on the virtual silicone: the 2009 recipe hollow, Palpate filled]({FIGURE})"]
    if options.write:
        shutil.copyfile(report / "figures" / "speed_error.png", ROOT / FIGURE)
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--palpate", default=str(ROOT / "build" / "palpate"))
    parser.add_argument("--recordings")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = section(options, pathlib.Path(folder))
    print(text)
    if options.write:
        readme = ROOT / "README.md"
        old = readme.read_text()
        before, rest = old.split(BEGIN)
        after = rest.split(END)[1]
        readme.write_text(before + BEGIN + "\n" + text + "\n" + END + after)


if __name__ == "__main__":
    main()
