#!/usr/bin/env python3
"""Recomputes the first screen of a report from FORCES.csv of `palpate replay`.

  check_report.py REPORT_DIR MODEL=FORCES.csv [MODEL=FORCES.csv ...]

Shares no code with the program: it reads the forces, applies the definitions of the page and
compares
  - every number of the sentence (index.html marks each with its model and its figure), as it is
    printed; times, which no FORCES.csv holds, with tables/times.csv,
  - the row of each model and of one that always says 0 N in tables/models.csv, and its bins in
    tables/force_bins.csv, to one part in a million.
Intervals are bootstrapped anew over strokes cut into pieces of at most 2 s or a tenth of the
recording, with other random numbers. Their ends are the 2.5 and 97.5 % of 1,000 resamplings here and
there, so that each end must lie among the resamplings here that are within three standard errors of
that share, and to 5 %, since the errors of a sensor with steps are few different numbers. (Compared
by their values, the ends of a test of ten pieces may differ by a third: that none of its three
strongest is drawn, where the 99 % error jumps, has a chance of 0.7^10 = 2.8 %.) The sentence's
models must all be given; a number of it that is not recomputed fails.
"""
import bisect
import csv
import html.parser
import math
import random
import re
import sys

RESAMPLES = 1000
LONGEST_BLOCK_S = 2.0
STROKE_PAUSE_S = 0.05
OFFSET_N, WEBER = 0.065, 0.0633
ATOM = 0.05


class Marked(html.parser.HTMLParser):
    """(model, figure) -> what is printed."""

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


def blocks_of(path, model):
    """[stroke, [(error, error / JND, measured force)]] a block, of the samples in contact; without a
    model, of one that always says 0 N."""
    rows = rows_of(path)
    longest = min(LONGEST_BLOCK_S, 0.1 * (float(rows[-1]["time_s"]) - float(rows[0]["time_s"])))
    blocks = []
    last_contact = begin = -math.inf
    in_air = True
    strokes = 0
    for row in rows:
        # Five deviations of the force noise are less than the JND at 0 N here.
        if float(row["depth_m"]) <= 0.0 and abs(float(row["force_N"])) <= OFFSET_N:
            in_air = True
            continue
        time = float(row["time_s"])
        stroke = in_air and time - last_contact > STROKE_PAUSE_S
        in_air = False
        last_contact = time
        if stroke or time - begin > longest or not blocks:
            strokes += stroke or not blocks
            blocks.append([strokes, []])
            begin = time
        measured = float(row["force_N"])
        error = abs((float(row[model + "_N"]) if model else 0.0) - measured)
        blocks[-1][1].append((error, error / (OFFSET_N + WEBER * abs(measured)), measured))
    return blocks


def p99(ratios):
    ordered = sorted(ratios)
    return ordered[math.ceil(0.99 * len(ordered)) - 1]


def figures(blocks):
    samples = [s for _, block in blocks for s in block]
    ratios = sorted(r for _, r, _ in samples)
    n = len(samples)
    return {
        "contact_samples": n,
        "rms_error_N": math.sqrt(sum(e * e for e, _, _ in samples) / n),
        "max_error_N": max(e for e, _, _ in samples),
        "within_jnd": bisect.bisect_right(ratios, 1.0) / n,
        "p99_error_over_jnd": p99(ratios),
        "max_error_over_jnd": ratios[-1],
        "strokes": len({stroke for stroke, _ in blocks}),
        "beyond_strokes": len({stroke for stroke, block in blocks if any(r > 1.0 for _, r, _ in block)}),
    }


class Bootstrap:
    """The same resamplings of blocks for every model."""

    def __init__(self, count):
        draw = random.Random(7)
        self.draws = [[draw.randrange(count) for _ in range(count)] for _ in range(RESAMPLES)]

    def values(self, blocks):
        ratios = [[r for _, r, _ in block] for _, block in blocks]
        counts = [(sum(r <= 1.0 for r in block), len(block), sum(s[0] ** 2 for s in whole[1]))
                  for block, whole in zip(ratios, blocks)]
        # Of every resampling only the largest per cent decides the 99 % error.
        order = sorted(((r, b) for b, block in enumerate(ratios) for r in block), reverse=True)
        result = {"within_jnd": [], "p99_error_over_jnd": [], "rms_error_N": []}
        for draw in self.draws:
            times = [0] * len(blocks)
            for b in draw:
                times[b] += 1
            n = sum(t * counts[b][1] for b, t in enumerate(times))
            above = n - math.ceil(0.99 * n)
            passed = 0
            for ratio, b in order:
                passed += times[b]
                if passed > above:
                    break
            result["p99_error_over_jnd"].append(ratio)
            result["within_jnd"].append(sum(t * counts[b][0] for b, t in enumerate(times)) / n)
            result["rms_error_N"].append(math.sqrt(sum(t * counts[b][2] for b, t in enumerate(times)) / n))
        return result


def at(values, share):
    place = share * (len(values) - 1)
    return sorted(values)[math.floor(place) if share < 0.5 else math.ceil(place)]


class Check:
    def __init__(self):
        self.wrong = 0
        self.done = 0

    def end(self, what, found, drawn, share, tolerance):
        """The end of an interval, beyond which lies `share` of the resamplings."""
        self.done += 1
        margin = 3.0 * math.sqrt(2.0 * share * (1.0 - share) / RESAMPLES)
        low, high = at(drawn, max(0.0, share - margin)), at(drawn, min(1.0, share + margin))
        if not low - tolerance <= found <= high + tolerance:
            print(f"{what} is {found} in the report, {low} to {high} here")
            self.wrong += 1

    def near(self, what, found, expected, tolerance):
        self.done += 1
        if not abs(found - expected) <= tolerance:
            print(f"{what} is {found} in the report, {expected} here")
            self.wrong += 1


def spread(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))


def check_bins(check, folder, name, blocks):
    samples = [s for _, block in blocks for s in block]
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


def check_row(check, row, name, expected, values):
    for key, value in expected.items():
        check.near(f"{name}: {key}", float(row[key]), value, 1e-6 * abs(value) + 1e-12)
    for key, drawn in values.items():
        for end, share in (("low", 0.025), ("high", 0.975)):
            check.end(f"{name}: {end} end of {key}", float(row[f"{key}_{end}"]), drawn, share, ATOM * abs(at(drawn, share)))


def printed(text):
    """The number that is printed, and half a unit of its last digit."""
    digits = re.search(r"[-−+]?[\d,]*\.?\d+(e-?\d+)?", text).group(0).replace(",", "").replace("−", "-")
    mantissa, _, exponent = digits.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(digits), 0.5 * 10.0 ** (int(exponent or 0) - decimals)


def check_sentence(check, folder, known, times):
    page = Marked()
    with open(folder + "/index.html") as file:
        page.feed(file.read())
    chosen = next(model for model, figure in page.found if figure == "tick_ns")
    for (model, figure), text in page.found.items():
        value, half = printed(text)
        if figure in ("tick_ns", "tick_share", "time_ratio"):
            tick = float(times[model]["tick_ns"])
            expected = {"tick_ns": tick, "tick_share": tick / 1e4, "time_ratio": tick / float(times[chosen]["tick_ns"])}[figure]
            check.near(f"sentence: {figure} of {model}", value, expected, 1.001 * half)
            continue
        if model not in known:
            print(f"the sentence speaks of {model}, whose forces were not given")
            check.wrong += 1
            continue
        expected, values, _ = known[model]
        tolerance = 1.001 * half
        if figure == "within_jnd":
            number = math.floor(1e4 * expected["within_jnd"]) / 100.0
        elif figure == "beyond_strokes":
            number = expected["beyond_strokes"]
            check.near("sentence: strokes", printed(text.split(" of ")[1])[0], expected["strokes"], 0.0)
        elif figure == "strokes_at_most":
            number = math.floor(1e4 * min(1.0, 3.0 / expected["strokes"])) / 100.0
            tolerance = 0.0101
        elif figure == "within_at_least":
            drawn = values["within_jnd"]
            number, tolerance = 100.0 * at(drawn, 0.05), 25.0 * (at(drawn, 0.975) - at(drawn, 0.025)) + half + 0.01
        elif figure == "p99_error_over_jnd":
            number = expected["p99_error_over_jnd"]
        elif figure == "p99_at_most":
            drawn = values["p99_error_over_jnd"]
            number = max(expected["p99_error_over_jnd"], at(drawn, 0.95))
            tolerance = 0.25 * (at(drawn, 0.975) - at(drawn, 0.025)) + ATOM * number + half
        elif figure == "difference":
            number = abs(expected["p99_error_over_jnd"] - known[chosen][0]["p99_error_over_jnd"])
        else:
            print(f"the sentence has a {figure} that nobody recomputes")
            check.wrong += 1
            continue
        check.near(f"sentence: {figure} of {model}", value, number, tolerance)


def main():
    folder = sys.argv[1]
    check = Check()
    rows = {row["model"]: row for row in rows_of(folder + "/tables/models.csv")}
    times = {row["model"]: row for row in rows_of(folder + "/tables/times.csv")}
    known = {}
    given = [argument.split("=", 1) for argument in sys.argv[2:]]
    bootstrap = None
    if not given:
        sys.exit("error: no FORCES.csv was given: NAME=FILE for each model of the tables")
    for name, path in [("no force", given[0][1])] + given:
        blocks = blocks_of(path, None if name == "no force" else name.removeprefix("2009-"))
        bootstrap = bootstrap or Bootstrap(len(blocks))
        known[name] = (figures(blocks), bootstrap.values(blocks), blocks)
        check_row(check, rows[name], name, known[name][0], known[name][1])
        if name != "no force":
            check_bins(check, folder, name, blocks)
    chosen = next(name for name, row in rows.items() if float(row["difference_p99"]) == 0.0 and
                  float(row["difference_p99_low"]) == 0.0 == float(row["difference_p99_high"]) and name in known)
    for name, (expected, values, _) in known.items():
        differences = [a - b for a, b in zip(values["p99_error_over_jnd"], known[chosen][1]["p99_error_over_jnd"])]
        for end, share in (("low", 0.025), ("high", 0.975)):
            check.end(f"{name}: paired difference, {end}", float(rows[name][f"difference_p99_{end}"]), differences, share,
                      ATOM * abs(at(differences, share)) + 1e-6)
    check_sentence(check, folder, known, times)
    if not check.wrong:
        print(f"{check.done} numbers agree")
    return 1 if check.wrong else 0


sys.exit(main())
