#!/usr/bin/env python3
"""Recomputes a row of the report's main table from FORCES.csv of `palpate replay`.

  check_tables.py REPORT_DIR FORCES.csv MODEL

Shares no code with the program: it reads the forces, applies the definitions of
the README and compares with tables/speed_error.csv and, bin by bin, with
tables/force_bins.csv to one part in a million; the row of a model that always says 0 N too. The
intervals are bootstrapped anew over strokes cut into pieces of at most 2 s or a tenth
of the recording, with other random numbers: their ends must agree to a quarter of the interval's width.
(The ends of 1,000 resamplings themselves scatter by some 5 % of it.)
"""
import bisect
import csv
import math
import random
import sys

RESAMPLES = 1000
LONGEST_BLOCK_S = 2.0
STROKE_PAUSE_S = 0.05


def read(path, model):
    """Blocks of (error, error / JND, measured force) of the samples in contact; without a
    model, of one that always says 0 N."""
    blocks = []
    with open(path, newline="") as file:
        times = [float(row["time_s"]) for row in csv.DictReader(file)]
    longest = min(LONGEST_BLOCK_S, 0.1 * (times[-1] - times[0]))
    last_contact = begin = -math.inf
    in_air = True
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if float(row["depth_m"]) <= 0.0:
                in_air = True
                continue
            time = float(row["time_s"])
            stroke = in_air and time - last_contact > STROKE_PAUSE_S
            in_air = False
            last_contact = time
            if stroke or time - begin > longest or not blocks:
                blocks.append([])
                begin = time
            measured = float(row["force_N"])
            error = abs((float(row[model + "_N"]) if model else 0.0) - measured)
            blocks[-1].append((error, error / (0.065 + 0.0633 * abs(measured)), measured))
    return blocks


def figures(samples):
    ratios = sorted(r for _, r, _ in samples)
    n = len(samples)
    return {
        "contact_samples": n,
        "rms_error_N": math.sqrt(sum(e * e for e, _, _ in samples) / n),
        "max_error_N": max(e for e, _, _ in samples),
        "within_jnd": bisect.bisect_right(ratios, 1.0) / n,
        "p99_error_over_jnd": ratios[math.ceil(0.99 * n) - 1],
        "max_error_over_jnd": ratios[-1],
    }


def intervals(blocks):
    draw = random.Random(7)
    values = {}
    for _ in range(RESAMPLES):
        drawn = [s for _ in blocks for s in draw.choice(blocks)]
        for name, value in figures(drawn).items():
            values.setdefault(name, []).append(value)
    result = {}
    for name in ("rms_error_N", "within_jnd", "p99_error_over_jnd"):
        ordered = sorted(values[name])
        result[name] = (ordered[int(0.025 * (RESAMPLES - 1))], ordered[math.ceil(0.975 * (RESAMPLES - 1))])
    return result


def differences(what, row, expected):
    """How many of `expected` are not in `row`, each said."""
    wrong = 0
    for name, value in expected.items():
        found = float(row[name])
        if abs(found - value) > 1e-6 * max(abs(value), 1e-9):
            print(f"{what}: {name} is {found} in the report, {value} here")
            wrong += 1
    return wrong


def spread(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))


def wrong_bins(folder, model, samples):
    with open(folder + "/tables/force_bins.csv", newline="") as file:
        bins = [row for row in csv.DictReader(file) if row["model"] == model]
    held = [[] for _ in bins]
    ends = [float(row["force_to_N"]) for row in bins]
    for sample in samples:
        held[min(bisect.bisect_right(ends, sample[2]), len(bins) - 1)].append(sample)
    wrong = 0
    for row, inside in zip(bins, held):
        error, deviation = spread([e for e, _, _ in inside])
        ratio, ratio_deviation = spread([r for _, r, _ in inside])
        wrong += differences(f"{model} to {row['force_to_N']} N", row, {
            "count": len(inside), "mean_abs_error_N": error, "std_abs_error_N": deviation,
            "max_abs_error_N": max(e for e, _, _ in inside), "mean_error_over_jnd": ratio,
            "std_error_over_jnd": ratio_deviation, "max_error_over_jnd": max(r for _, r, _ in inside)})
    return wrong


def main():
    folder, forces, model = sys.argv[1:]
    with open(folder + "/tables/speed_error.csv", newline="") as file:
        rows = {r["model"]: r for r in csv.DictReader(file)}
    wrong = 0
    for name, column in (("no-force", None), (model, model)):
        blocks = read(forces, column)
        samples = [s for block in blocks for s in block]
        expected = figures(samples)
        wrong += differences(name, rows[name], expected) + wrong_bins(folder, name, samples)
    row = rows[model]
    for name, (low, high) in intervals(blocks).items():
        found = float(row[name + "_low"]), float(row[name + "_high"])
        tolerance = 0.25 * (high - low) + 1e-9
        if abs(found[0] - low) > tolerance or abs(found[1] - high) > tolerance:
            print(f"{model}: {name} from {found[0]} to {found[1]} in the report, from {low} to {high} here")
            wrong += 1
    if not wrong:
        print(f"{model}: {len(expected)} figures and their intervals agree over {expected['contact_samples']} "
              f"samples in {len(blocks)} blocks")
    return 1 if wrong else 0


sys.exit(main())
