#!/usr/bin/env python3
"""Recomputes the first screen of a report from FORCES.csv of `palpate replay`.

  check_report.py REPORT_DIR MODEL=FORCES.csv [MODEL=FORCES.csv ...]

Shares no code with the program. It reads the forces of one test recording, applies the definitions of the page and
compares
  - every number of the sentence, as printed (index.html marks each with its model and figure); times, which
    FORCES.csv does not contain, are compared with tables/times.csv,
  - the rows of each model and of one that always returns 0 N: in tables/models.csv with intervals by Student's t
    over strokes, and in tables/force_bins.csv, to one part in a million.
All models of the sentence must be given. A number of the sentence that is not recomputed is an error.
"""
import bisect
import csv
import html.parser
import json
import math
import re
import sys

STROKE_PAUSE_S = 0.05
LEAST_UNITS = 3
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


def standard_error(values):
    mean = sum(values) / len(values)
    return math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))


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
    error = standard_error([p99([r for _, r, _ in stroke]) for stroke in strokes])
    two, one = student_t(0.025, units - 1), student_t(0.05, units - 1)
    p = values["p99_error_over_jnd"]
    values.update({"p99_error_over_jnd_low": max(0.0, p - two * error), "p99_error_over_jnd_high": p + two * error,
                   "p99_at_most": p + one * error})
    if beyond:
        share = values["within_jnd"]
        rest = [sum(r <= 1.0 for _, r, _ in stroke) - share * len(stroke) for stroke in strokes]
        error = math.sqrt(units / (units - 1) * sum(r * r for r in rest)) / n
        values["within_at_least"] = max(0.0, share - one * error)
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


def check_sentence(check, folder, known, times, recommended):
    sentence = Marked()
    with open(folder + "/index.html", encoding="utf-8", errors="replace") as page:
        sentence.feed(page.read())
    for (model, figure), text in sentence.found.items():
        value, half = printed(text)
        if figure in ("tick_ns", "tick_share", "time_ratio"):
            tick = float(times[model]["tick_ns"])
            expected = {"tick_ns": tick, "tick_share": tick / 1e4, "time_ratio": tick / float(times[recommended]["tick_ns"])}
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
                   "within_at_least": lambda: floored(expected["within_at_least"]),
                   "units_at_most": lambda: floored(1.0 - expected["within_at_least"]),
                   "beyond_units": lambda: expected["beyond_units"],
                   "p99_error_over_jnd": lambda: expected["p99_error_over_jnd"],
                   "p99_at_most": lambda: expected["p99_at_most"],
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
        strokes = strokes_of(path, None if name == "no force" else name.removeprefix("2009-"))
        known[name] = (figures(strokes), strokes)
        for key, value in known[name][0].items():
            check.near(f"{name}: {key}", float(rows[name][key]), value, 1e-6 * abs(value) + 1e-12)
        if name != "no force":
            check_bins(check, folder, name, strokes)
    best = min((name for name in report["candidates"] if name in known), key=lambda name: known[name][0]["p99_error_over_jnd"])
    for name, (expected, strokes) in known.items():
        difference = expected["p99_error_over_jnd"] - known[best][0]["p99_error_over_jnd"]
        check.near(f"{name}: difference", float(rows[name]["difference_p99"]), difference, 1e-6)
        if len(strokes) < LEAST_UNITS:
            continue
        pairs = [p99([r for _, r, _ in one]) - p99([r for _, r, _ in other]) for one, other in zip(strokes, known[best][1])]
        half = student_t(0.025, len(pairs) - 1) * standard_error(pairs)
        check.near(f"{name}: difference, low", float(rows[name]["difference_p99_low"]), difference - half, 1e-5)
        check.near(f"{name}: difference, high", float(rows[name]["difference_p99_high"]), difference + half, 1e-5)
    check_sentence(check, folder, known, times, report["recommended"])
    if not check.wrong:
        print(f"{check.done} numbers agree")
    return 1 if check.wrong else 0


sys.exit(main())
