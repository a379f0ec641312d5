#!/usr/bin/env python3
"""Recomputes a row of the report's main table from FORCES.csv of `palpate replay`.

  check_tables.py REPORT_DIR FORCES.csv MODEL

Shares no code with the program: it reads the forces, applies the definitions of
the README and compares with tables/speed_error.csv to one part in a million. The
intervals are bootstrapped anew over strokes cut into pieces of at most 2 s, with
other random numbers: their ends must agree to a quarter of the interval's width.
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
    """Blocks of (error, error / JND) of the samples in contact."""
    blocks = []
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
            if stroke or time - begin > LONGEST_BLOCK_S or not blocks:
                blocks.append([])
                begin = time
            measured = float(row["force_N"])
            error = abs(float(row[model + "_N"]) - measured)
            blocks[-1].append((error, error / (0.065 + 0.0633 * abs(measured))))
    return blocks


def figures(samples):
    ratios = sorted(r for _, r in samples)
    n = len(samples)
    return {
        "contact_samples": n,
        "rms_error_N": math.sqrt(sum(e * e for e, _ in samples) / n),
        "max_error_N": max(e for e, _ in samples),
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


def main():
    folder, forces, model = sys.argv[1:]
    blocks = read(forces, model)
    expected = figures([s for block in blocks for s in block])
    with open(folder + "/tables/speed_error.csv", newline="") as file:
        row = next(r for r in csv.DictReader(file) if r["model"] == model)
    wrong = 0
    for name, value in expected.items():
        found = float(row[name])
        if abs(found - value) > 1e-6 * max(abs(value), 1e-9):
            print(f"{model}: {name} is {found} in the report, {value} from {forces}")
            wrong += 1
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
