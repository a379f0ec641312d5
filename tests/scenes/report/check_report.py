#!/usr/bin/env python3
"""Recomputes the first screen of a report from FORCES.csv of `palpate replay`.

  check_report.py REPORT_DIR MODEL=FORCES.csv [MODEL=FORCES.csv ...]

Shares no code with the program. It reads the forces of one test recording, applies the definitions of the page and
compares
  - every number of the sentence, as printed (index.html marks each with its model and figure); times, which
    FORCES.csv does not contain, are compared with tables/times.csv,
  - the rows of each model and of one that always returns 0 N: in tables/models.csv, and in
    tables/force_bins.csv, to one part in a million.
Intervals of the 99 % error come from random draws: their ends must lie between the quantiles of this script's own draws
of strokes at half and at twice the probability.
All models of the sentence must be given. A number of the sentence that is not recomputed is an error.
"""
import bisect
import collections
import csv
import html.parser
import json
import math
import random
import re
import sys

STROKE_PAUSE_S = 0.05
LEAST_UNITS = 3
DRAWS = 10000
OFFSET_N, WEBER = 0.065, 0.0633


class Marked(html.parser.HTMLParser):
    """(model, figure) -> printed text."""

    def __init__(self):
        super().__init__()
        self.found = {}
        self.inside = None

    def handle_starttag(self, tag, attributes):
        names = dict(attributes)
        if tag == "span" and "data-figure" in names:
            self.inside = (names["data-model"], names["data-figure"])
            self.found[self.inside] = ""

    def handle_endtag(self, tag):
        if tag == "span":
            self.inside = None

    def handle_data(self, data):
        if self.inside:
            self.found[self.inside] += data


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


def printed(text):
    """The printed number, and half a unit of its last digit."""
    digits = re.search(r"[-−+]?[\d,]*\.?\d+(e-?\d+)?", text).group(0).replace(",", "").replace("−", "-")
    mantissa, _, exponent = digits.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(digits), 0.5 * 10.0 ** (int(exponent or 0) - decimals)


def check_sentence(check, folder, known, rows, times, recommended):
    sentence = Marked()
    with open(folder + "/index.html", encoding="utf-8", errors="replace") as page:
        sentence.feed(page.read())
    for (model, figure), text in sentence.found.items():
        value, half = printed(text)
        if figure in ("tick_ns", "time_ratio"):
            tick = float(times[model]["tick_ns"])
            expected = {"tick_ns": tick, "time_ratio": tick / float(times[recommended]["tick_ns"])}
            # Printed with three significant digits.
            check.near(f"sentence: {figure} of {model}", value, expected[figure], max(1.001 * half, 0.006 * value))
            continue
        if model not in known:
            print(f"the sentence speaks of {model}, whose forces were not given")
            check.wrong += 1
            continue
        expected = known[model][0]
        floored = lambda share: math.floor(1e4 * share) / 100.0
        numbers = {"within_jnd": lambda: floored(expected["within_jnd"]),
                   "p99_error_over_jnd": lambda: expected["p99_error_over_jnd"],
                   "p99_low": lambda: float(rows[model]["p99_error_over_jnd_low"]),
                   "p99_high": lambda: float(rows[model]["p99_error_over_jnd_high"]),
                   "difference": lambda: abs(expected["p99_error_over_jnd"] - known[recommended][0]["p99_error_over_jnd"])}
        if figure not in numbers:
            print(f"the sentence has a {figure} that is not recomputed")
            check.wrong += 1
            continue
        # Shares are rounded down, and a number on the edge may be rounded either way.
        check.near(f"sentence: {figure} of {model}", value, numbers[figure](), 1.001 * half + (0.0101 if "%" in text else 0))


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
    for name, path in [("no force", given[0][1])] + given:
        strokes = strokes_of(path, None if name == "no force" else name)
        known[name] = (figures(strokes), strokes)
        for key, value in known[name][0].items():
            check.near(f"{name}: {key}", float(rows[name][key]), value, 1e-6 * abs(value) + 1e-12)
        if name != "no force":
            check_bins(check, folder, name, strokes)
    best = min((name for name in report["candidates"] if name in known), key=lambda name: known[name][0]["p99_error_over_jnd"])
    of_best = resampled(known[best][1])
    for name, (expected, strokes) in known.items():
        row = rows[name]
        difference = expected["p99_error_over_jnd"] - known[best][0]["p99_error_over_jnd"]
        check.near(f"{name}: difference", float(row["difference_p99"]), difference, 1e-6)
        if len(strokes) < LEAST_UNITS:
            continue
        drawn = resampled(strokes)
        check_interval(check, f"{name}: 99 % error", float(row["p99_error_over_jnd_low"]),
                       float(row["p99_error_over_jnd_high"]), drawn, len(strokes))
        check_interval(check, f"{name}: difference", float(row["difference_p99_low"]), float(row["difference_p99_high"]),
                       [one - other for one, other in zip(drawn, of_best)], len(strokes))
    check_sentence(check, folder, known, rows, times, report["recommended"])
    if not check.wrong:
        print(f"{check.done} numbers agree")
    return 1 if check.wrong else 0


sys.exit(main())
