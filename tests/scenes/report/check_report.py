#!/usr/bin/env python3
"""Recomputes the first screen of a report from FORCES.csv of `palpate replay`.

  check_report.py REPORT_DIR MODEL=FORCES.csv[,FORCES.csv ...] [MODEL=...]

Shares no code with the program. It reads the forces of one test recording, applies the definitions of the page and
compares
  - the numbers of the answer, as printed; times, which FORCES.csv does not contain, are compared with
    tables/times.csv,
  - the rows of each model and of one that always returns 0 N: in tables/models.csv, and in
    tables/force_bins.csv, to one part in a million; of several files, one for each seed, the median of each figure.
Intervals of the 99 % error come from random draws: their ends must lie between the quantiles of this script's own draws
of strokes at half and at twice the probability.
All models of the tables must be given.
"""
import bisect
import collections
import csv
import json
import math
import random
import re
import sys

STROKE_PAUSE_S = 0.05
LEAST_UNITS = 3
DRAWS = 10000
OFFSET_N, WEBER = 0.065, 0.0633


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def strokes_of(path, model):
    """[[(error, error / JND, measured force)]]: the samples in contact, one list per stroke. Without a
    model, the errors of one that always returns 0 N."""
    strokes = []
    last_contact = -math.inf
    in_air = True
    for row in rows_of(path):
        # Here the JND at 0 N exceeds five standard deviations of the force noise.
        if float(row["depth_m"]) <= 0.0 and abs(float(row["force_N"])) <= OFFSET_N:
            in_air = True
            continue
        time = float(row["time_s"])
        if (in_air and time - last_contact > STROKE_PAUSE_S) or not strokes:
            strokes.append([])
        in_air = False
        last_contact = time
        measured = float(row["force_N"])
        error = abs((float(row[model + "_N"]) if model else 0.0) - measured)
        strokes[-1].append((error, error / (OFFSET_N + WEBER * abs(measured)), measured))
    return strokes


def p99(ratios):
    ordered = sorted(ratios)
    return ordered[math.ceil(0.99 * len(ordered)) - 1]


def student_t(above, degrees):
    """The value that Student's t exceeds with this probability, from its density."""
    scale = math.exp(math.lgamma((degrees + 1) / 2) - math.lgamma(degrees / 2)) / math.sqrt(degrees * math.pi)
    density = lambda t: scale * (1 + t * t / degrees) ** (-(degrees + 1) / 2)
    t, passed, step = 0.0, 0.5, 1e-4
    while passed < 1.0 - above:
        passed += step * (density(t) + 4 * density(t + step / 2) + density(t + step)) / 6
        t += step
    return t - (passed - 1.0 + above) / density(t)


def draws(count):
    """Lists of the strokes that are drawn, the same for every model."""
    source = random.Random(5)
    return [[source.randrange(count) for _ in range(count)] for _ in range(DRAWS)]


def resampled(strokes):
    ranked = sorted(((r, i) for i, stroke in enumerate(strokes) for _, r, _ in stroke), reverse=True)
    errors = []
    for drawn in draws(len(strokes)):
        times = collections.Counter(drawn)
        beyond = sum(len(strokes[i]) for i in drawn) // 100
        count = 0
        for ratio, stroke in ranked:
            count += times[stroke]
            if count > beyond:
                errors.append(ratio)
                break
    return errors


def check_interval(check, what, low, high, drawn, units):
    """`drawn`: the 99 % errors of the draws, or their differences. Expanded percentiles, Hesterberg (2015)."""
    t = student_t(0.025, units - 1)
    below = 0.5 * math.erfc(math.sqrt(units / (units - 1)) * t / math.sqrt(2))
    ordered = sorted(drawn)
    at = lambda share: ordered[min(int(share * len(ordered)), len(ordered) - 1)]
    # The report has 2,000 draws: of rare ones a few more or less.
    few, many = max(0.0, below / 2 - 3 / 2000), 2 * below + 5 / 2000
    for name, value, least, most in (("low", low, at(few), at(many)), ("high", high, at(1 - many), at(1 - few))):
        check.done += 1
        if not least - 1e-5 <= value <= most + 1e-5:
            print(f"{what}: {name} is {value} in the report, expected {least} to {most}")
            check.wrong += 1


def figures(strokes):
    samples = [s for stroke in strokes for s in stroke]
    ratios = sorted(r for _, r, _ in samples)
    n = len(samples)
    units = len(strokes)
    beyond = sum(any(r > 1.0 for _, r, _ in stroke) for stroke in strokes)
    values = {
        "contact_samples": n,
        "rms_error_N": math.sqrt(sum(e * e for e, _, _ in samples) / n),
        "max_error_N": max(e for e, _, _ in samples),
        "within_jnd": bisect.bisect_right(ratios, 1.0) / n,
        "p99_error_over_jnd": p99(ratios),
        "max_error_over_jnd": ratios[-1],
        "units": units,
        "beyond_units": beyond,
    }
    if units < LEAST_UNITS:
        return values
    if beyond:
        share = values["within_jnd"]
        rest = [sum(r <= 1.0 for _, r, _ in stroke) - share * len(stroke) for stroke in strokes]
        error = math.sqrt(units / (units - 1) * sum(r * r for r in rest)) / n
        values["within_at_least"] = max(0.0, share - student_t(0.05, units - 1) * error)
    else:
        values["within_at_least"] = 0.05 ** (1 / units)
    return values


class Check:
    def __init__(self):
        self.wrong = 0
        self.done = 0

    def near(self, what, found, expected, tolerance):
        self.done += 1
        if not abs(found - expected) <= tolerance:
            print(f"{what} is {found} in the report, {expected} here")
            self.wrong += 1


def spread(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))


def check_bins(check, folder, name, strokes):
    samples = [s for stroke in strokes for s in stroke]
    bins = [row for row in rows_of(folder + "/tables/force_bins.csv") if row["model"] == name]
    held = [[] for _ in bins]
    ends = [float(row["force_to_N"]) for row in bins]
    for sample in samples:
        held[min(bisect.bisect_right(ends, sample[2]), len(bins) - 1)].append(sample)
    for row, inside in zip(bins, held):
        low, high = float(row["force_from_N"]), float(row["force_to_N"])
        jnds = math.log((OFFSET_N + WEBER * high) / (OFFSET_N + WEBER * low)) / WEBER
        check.near(f"width of the bin from {low} N, in JND,", jnds, 2.0, 1e-6)
        error, deviation = spread([e for e, _, _ in inside])
        ratio, ratio_deviation = spread([r for _, r, _ in inside])
        for key, value in {"count": len(inside), "mean_abs_error_N": error, "std_abs_error_N": deviation,
                           "max_abs_error_N": max(e for e, _, _ in inside), "mean_error_over_jnd": ratio,
                           "std_error_over_jnd": ratio_deviation, "max_error_over_jnd": max(r for _, r, _ in inside)}.items():
            check.near(f"{name} to {high} N: {key}", float(row[key]), value, 1e-6 * abs(value) + 1e-12)


def median(values):
    return sorted(values)[len(values) // 2]


def check_answer(check, report, known, times):
    said = re.search(r"(?P<model>\S+): (?P<within>[\d.]+) % of the test is within one JND, a tick takes (?P<tick>\S+) us",
                     report["answer"])
    if not said or said["model"] != report["recommended"]:
        sys.exit("error: the answer of the report is not as expected: " + report["answer"])
    # Shares are rounded down, and times to two digits.
    share = 100.0 * known[said["model"]][0]["within_jnd"]
    check.near("answer: share", float(said["within"]), share - (0.05 if share >= 99.0 else 0.5),
               0.0501 if share >= 99.0 else 0.501)
    tick = 1e-3 * float(times[said["model"]]["tick_ns"])
    check.near("answer: tick", float(said["tick"]), tick, 0.051 * tick)


def main():
    folder = sys.argv[1]
    check = Check()
    rows = {row["model"]: row for row in rows_of(folder + "/tables/models.csv")}
    times = {row["model"]: row for row in rows_of(folder + "/tables/times.csv")}
    with open(folder + "/report.json", encoding="utf-8", errors="replace") as file:
        report = json.load(file)["timings"]
    known = {}
    given = [argument.split("=", 1) for argument in sys.argv[2:]]
    if not given:
        sys.exit("error: no FORCES.csv was given: NAME=FILE for each model of the tables")
    for name, paths in [("no force", given[0][1].split(",")[0])] + given:
        seeds = [strokes_of(path, None if name == "no force" else name) for path in paths.split(",")]
        each = [figures(strokes) for strokes in seeds]
        # The bound of the share comes from medians by unit.
        of_median = {key: median([one[key] for one in each]) for key in each[0] if len(seeds) == 1 or key != "within_at_least"}
        drawn = [median(draws) for draws in zip(*map(resampled, seeds))] if each[0]["units"] >= LEAST_UNITS else []
        known[name] = (of_median, drawn)
        for key, value in of_median.items():
            check.near(f"{name}: {key}", float(rows[name][key]), value, 1e-6 * abs(value) + 1e-12)
        if name != "no force" and len(seeds) == 1:
            check_bins(check, folder, name, seeds[0])
    best, of_best = known[report["best"]]
    for name, (expected, drawn) in known.items():
        row = rows[name]
        difference = expected["p99_error_over_jnd"] - best["p99_error_over_jnd"]
        check.near(f"{name}: difference", float(row["difference_p99"]), difference, 1e-6)
        if not drawn:
            continue
        check_interval(check, f"{name}: 99 % error", float(row["p99_error_over_jnd_low"]),
                       float(row["p99_error_over_jnd_high"]), drawn, expected["units"])
        check_interval(check, f"{name}: difference", float(row["difference_p99_low"]), float(row["difference_p99_high"]),
                       [one - other for one, other in zip(drawn, of_best)], expected["units"])
    check_answer(check, report, known, times)
    if not check.wrong:
        print(f"{check.done} numbers agree")
    return 1 if check.wrong else 0


sys.exit(main())
