#!/usr/bin/env python3
"""Recomputes a row of the report's main table from FORCES.csv of `palpate replay`.

  check_tables.py REPORT_DIR FORCES.csv MODEL

Shares no code with the program: it reads the forces, applies the definitions of
the README and compares with tables/speed_error.csv to one part in a million.
"""
import csv
import math
import sys


def recompute(path, model):
    errors, ratios = [], []
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if float(row["depth_m"]) <= 0.0:
                continue
            measured = float(row["force_N"])
            error = abs(float(row[model + "_N"]) - measured)
            errors.append(error)
            ratios.append(error / (0.065 + 0.0633 * abs(measured)))
    ratios.sort()
    n = len(errors)
    return {
        "contact_samples": n,
        "rms_error_N": math.sqrt(sum(e * e for e in errors) / n),
        "max_error_N": max(errors),
        "within_jnd": sum(r <= 1.0 for r in ratios) / n,
        "p99_error_over_jnd": ratios[math.ceil(0.99 * n) - 1],
        "max_error_over_jnd": ratios[-1],
    }


def main():
    folder, forces, model = sys.argv[1:]
    expected = recompute(forces, model)
    with open(folder + "/tables/speed_error.csv", newline="") as file:
        row = next(r for r in csv.DictReader(file) if r["model"] == model)
    wrong = 0
    for name, value in expected.items():
        found = float(row[name])
        if abs(found - value) > 1e-6 * max(abs(value), 1e-9):
            print(f"{model}: {name} is {found} in the report, {value} from {forces}")
            wrong += 1
    if not wrong:
        print(f"{model}: {len(expected)} figures agree over {expected['contact_samples']} samples")
    return 1 if wrong else 0


sys.exit(main())
