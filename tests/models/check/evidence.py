#!/usr/bin/env python3
"""Compares the findings of palpate about recordings with known values.

Usage: evidence.py [--planted] PALPATE [FOLDER...]

Virtual recordings get a known shift, lag, zero, tool mass, adhesion or no free air;
recordings in the FOLDERs get a known shift or lag on top of what they have. Prints one
row for each: found, true, error, and whether it is right. Dropouts, repeated positions, repeated time stamps and
offsets of the force are added to both (--planted: only these). "not identified" is right if the recording does not
determine the value, and harmless otherwise. The last lines are a table with the numbers of right, wrong and missing
findings. The exit code is 1 if an identified value is wrong.
"""
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np

ARGUMENTS = [argument for argument in sys.argv[1:] if argument != "--planted"]
PALPATE = ARGUMENTS[0]
FOLDERS = ARGUMENTS[1:]
WORK = pathlib.Path(tempfile.mkdtemp())
STIFF_MM, SOFT_MM, LAG_MS, ZERO_N = 0.1, 0.3, 2.0, 0.01
counts = {}  # finding: how many right, wrong, silent
COLUMN = {"right": 0, "rightly not identified": 0, "WRONG": 1, "not identified": 2}


def run(*arguments):
    done = subprocess.run([PALPATE, *map(str, arguments)], capture_output=True, text=True)
    try:
        return json.loads(done.stdout)
    except ValueError:
        return {"error": done.stderr.strip()}


def read(path):
    with open(path, encoding="utf-8") as file:
        return np.genfromtxt([line for line in file if not line.startswith("#")], delimiter=",", names=True)


def write(name, rows):
    path = WORK / (name + ".csv")
    np.savetxt(path, rows, fmt="%.17g", delimiter=",", header=",".join(rows.dtype.names), comments="")
    return path


def row(case, what, found, true, tolerance, unit):
    """`found`: None if not identified; `true`: None if it cannot be identified."""
    if found is None:
        verdict = "rightly not identified" if true is None else "not identified"
    elif true is None:
        verdict = "WRONG" if abs(found) > tolerance else "right"
    else:
        verdict = "right" if abs(found - true) <= tolerance else "WRONG"
    counts.setdefault(what, [0, 0, 0])[COLUMN[verdict]] += 1
    say = lambda x: "-" if x is None else f"{x:+.3f}"
    error = "-" if None in (found, true) else f"{found - true:+.3f}"
    print(f"{case:44} {what:10} {say(found):>9} {say(true):>9} {error:>8} {unit:3} {verdict}", flush=True)


def checked(path):
    one = run("check", path, "--json")["recordings"][0]
    codes = {finding["code"]: finding["value"] for finding in one["findings"]}
    return one, codes


def row_check(case, path, true_mm, tolerance_mm=SOFT_MM, zero_N=0.0, lag_ms=0.0):
    one, codes = checked(path)
    identified = one.get("surface_identified", True)
    row(case, "surface", 1e3 * one["surface_offset_m"] if identified else None, true_mm, tolerance_mm, "mm")
    row(case, "zero", one["force_zero_N"] if identified else None, zero_N, ZERO_N, "N")
    # No finding counts as 0. It is right if the true lag is so small that the material may cause it.
    lag = 1e3 * codes["lag"] if "lag" in codes else (0.0 if abs(lag_ms) <= LAG_MS else None)
    row(case, "lag", lag, lag_ms, LAG_MS, "ms")


def row_pair(case, paths, true_mm, tolerance_mm):
    """The offset of the second recording relative to the first, by a fit of both."""
    model = WORK / "m.json"
    found = run("fit", "--recording", *paths, "--method", "random", "--features", "scene", "--out", model, "--force",
                "--json")
    if "error" in found:
        print(f"{case:44} {found['error'][:80]}")
        return
    by_name = {one["name"].rsplit(".csv", 1)[0].split("/")[-1]: one for one in found["recordings"]}
    first, second = (by_name[path.stem] for path in paths)
    identified = second.get("identified", True) and first.get("identified", True)
    shift = 1e3 * (second["surface_offset_m"] - first["surface_offset_m"])
    if not identified and abs(shift) > 1e-6:
        row(case + " (not identified, moved)", "shift", shift, true_mm, 0.0, "mm")
    else:
        row(case, "shift", shift if identified else None, true_mm, tolerance_mm, "mm")


def changed(rows, shift_mm=0.0, zero_N=0.0, mass_kg=0.0, lag_ms=0.0):
    rows = rows.copy()
    rows["position_m"] += 1e-3 * shift_mm
    rows["force_N"] += zero_N
    if mass_kg:
        rows["force_N"] += mass_kg * rows["acceleration_m_per_s2"]
    if lag_ms:
        rows["force_N"] = np.interp(rows["time_s"] - 1e-3 * lag_ms, rows["time_s"], rows["force_N"])
    return rows


def synth(material, seed, seconds=14):
    path = WORK / f"{material}{seed}.csv"
    if not path.exists():
        subprocess.run([PALPATE, "synth", "--material", material, "--seed", str(seed), "--seconds", str(seconds + seed),
                        "--out", path], check=True, capture_output=True)
    return read(path)


def block(seed, low_mm, high_mm, adhesion_N=0.0, rate_Hz=500.0, seconds=20.0):
    """A nonlinear spring and two Maxwell branches, pressed between two depths."""
    rng = random.Random(seed)
    rows, held_m = [], [0.0, 0.0]
    phase, touched = 0.0, False
    for i in range(int(rate_Hz * seconds)):
        if i % int(2 * rate_Hz) == 0:
            speed = rng.uniform(0.3, 1.5)
        phase += speed * 2 * math.pi / rate_Hz * 0.7
        position = 1e-3 * (low_mm + (high_mm - low_mm) * 0.5 * (1 - math.cos(phase)))
        depth = max(0.0, position)
        force = 250.0 * depth + 4e4 * depth * depth
        for k, (time_s, stiffness_N_per_m) in enumerate(((0.15, 120.0), (1.2, 80.0))):
            held_m[k] = held_m[k] * math.exp(-1.0 / (rate_Hz * time_s)) + (depth - last_depth if rows else 0.0)
            force += stiffness_N_per_m * held_m[k]
        force = max(0.0, force)
        touched = position > 0 or (touched and position >= -1.5e-3)
        if touched and adhesion_N and position < last_position:
            force -= adhesion_N * min(1.0, max(0.0, (position + 1.5e-3) / 1.5e-3)) * math.exp(-depth / 1e-3)
        last_position, last_depth = position, depth
        rows.append((i / rate_Hz, position, force + rng.gauss(0.0, 0.005)))
    return np.array(rows, [(name, float) for name in ("time_s", "position_m", "force_N")])


def virtual():
    for material in ("silicone", "foam", "maxwell", "stiff"):
        near = STIFF_MM if material == "stiff" else SOFT_MM
        base, other = synth(material, 1), synth(material, 2)
        first = write("first", base)
        for shift in (0.0, 0.2, -0.2, 3.0, -15.0):
            row_check(f"{material} shifted {shift:+g} mm", write("shifted", changed(base, shift_mm=shift)), shift, near)
        for shift in (0.0, 0.2, -0.5, 2.0, -6.0, 15.0):
            second = write("second", changed(other, shift_mm=shift))
            row_pair(f"{material} pair {shift:+g} mm", [first, second], shift, near)
        for lag in (-10.0, 4.0, 8.0, 15.0, 30.0):
            row_check(f"{material} lag {lag:+g} ms", write("late", changed(base, lag_ms=lag)), 0.0, near, lag_ms=lag)
        row_check(f"{material} zero +0.3 N", write("zero", changed(base, zero_N=0.3)), 0.0, near, 0.3)
        row_check(f"{material} tool 60 g", write("heavy", changed(base, mass_kg=0.06)), 0.0, near)
    for seed, low, high in ((1, 3.0, 8.0), (2, 1.0, 4.0), (3, 2.0, 6.0)):
        row_check(f"no free air, {low:g} to {high:g} mm", write("pressed", block(seed, low, high)), None, 0.0, None)
    for case, shift, near in (("both to 3-8 mm", 0.0, 0.1), ("second moved 4 mm", 4.0, SOFT_MM)):
        second = changed(block(5, 3, 8, seconds=15.0), shift_mm=shift)
        row_pair("no free air, " + case, [write("a", block(4, 3, 8)), write("b", second)], shift, near)
    for adhesion in (0.25, 0.6):
        row_check(f"adhesion {adhesion:g} N", write("adhesive", block(6, -3, 6, adhesion)), 0.0, SOFT_MM)


def real():
    for folder in FOLDERS:
        for root, _, files in sorted(os.walk(folder)):
            names = sorted(f for f in files if f.endswith(".csv"))
            for name in names:
                path = os.path.join(root, name)
                _, codes = checked(path)
                case = f"{os.path.basename(root)}/{name[:-4]}"
                row(case, "lag", 1e3 * codes.get("lag", 0.0), None, 0.0, "ms")
                for code in ("force_sign", "position_sign"):
                    row(case, code[:10], 1.0 if code in codes else None, None, 0.0, "")
            if len(names) < 2:
                continue
            # The same recording twice, one shifted: the offset is known for every rig.
            rows = read(os.path.join(root, names[-1]))
            for shift in (0.4, -2.0, 6.0):
                paths = [write("first", rows), write("second", changed(rows[:-1], shift_mm=shift))]
                row_pair(f"{os.path.basename(root)}/{names[-1][:-4]} twice {shift:+g}", paths, shift, SOFT_MM)


def present(case, what, found, planted):
    """A finding that is present or absent, without a value."""
    row(case, what, 1.0 if found else (None if planted else 0.0), 1.0 if planted else 0.0, 0.0, "")


def codes_of(*paths):
    found = run("check", *paths, "--json")
    return {one["code"]: one for file in found.get("recordings", []) for one in file["findings"]}


def plant(case, rows):
    path = write("clean", rows)
    clean = codes_of(path)
    for code in ("dropouts", "repeated_positions", "force_unit", "position_unit"):
        present(case, code, code in clean, False)
    for column in ("position_m", "force_N"):
        for share in (0.005, 0.01, 0.03, 0.05):
            rng = random.Random(1)
            dropped = rows.copy()
            dropped[column][[rng.random() < share for _ in rows]] = 0.0
            present(f"{case} {column[:5]} {100 * share:g} % at 0", "dropouts",
                    "dropouts" in codes_of(write("dropped", dropped)), True)
    for step in (2, 5, 19, 44, 100):
        if len(rows) < 50 * step:
            continue  # too few updates to see them
        kept = rows.copy()
        kept["position_m"] = np.repeat(rows["position_m"][::step], step)[:len(rows)]
        present(f"{case} positions of every {step} rows", "repeated_positions",
                "repeated_positions" in codes_of(write("kept", kept)), True)
    repeated = np.repeat(rows, np.where(np.arange(len(rows)) % 50 == 7, 2, 1))
    done = run("import", write("stamps", repeated), "--units", "s,m,N", "--out", WORK / "imported.csv", "--force",
               "--json")
    present(f"{case} repeated stamps", "stamps", done.get("rows") == len(rows), True)


# Sets whose recordings have different forces at the same depth, according to their provenance.
CONTRADICTIONS = {("textile_stretch", "train_31", "train_32"), ("ecoflex_static", "_0T", "_100T")}


def contradicts(folder, a, b):
    return any(folder == name and ((one in a and other in b) or (one in b and other in a))
               for name, one, other in CONTRADICTIONS)


def pairs(folder, paths):
    for i, path in enumerate(paths):
        for other in paths[:i]:
            if not any(kind in path and kind in other for kind in ("train", "test")):
                continue
            a, b = os.path.basename(path)[:-4], os.path.basename(other)[:-4]
            present(f"{folder}/{a} and {b}", "contradiction", "contradiction" in codes_of(other, path),
                    contradicts(folder, a, b))


def force_offsets():
    """A press without free air, twice, one with a force offset: a contradiction from two JND on, never a surface."""
    base = write("strokes", block(4, 3, 8))
    for offset in (0.1, 0.3, 1.0, 3.0):
        other = write("offset", changed(block(5, 3, 8), zero_N=offset))
        model = WORK / "offset.json"
        run("fit", "--recording", base, "--method", "trend", "--out", model, "--force", "--json")
        done = run("replay", "--recording", other, "--model", model, "--json")
        row(f"no free air, force +{offset:g} N", "offset as surface", 1e3 * done["surface_offset_m"], 0.0, SOFT_MM, "mm")


def planted():
    for material in ("silicone", "friction", "stiff"):
        plant(material, synth(material, 1))
    force_offsets()
    for folder in FOLDERS:
        for root, _, files in sorted(os.walk(folder)):
            paths = sorted(os.path.join(root, name) for name in files if name.endswith(".csv"))
            if paths:
                plant(os.path.basename(root) + "/" + os.path.basename(paths[-1])[:-4], read(paths[-1]))
                pairs(os.path.basename(root), paths)


print(f"{'case':44} {'what':10} {'found':>9} {'true':>9} {'error':>8}")
if "--planted" not in sys.argv:
    virtual()
    real()
planted()
print(f"{'finding':20} {'right':>6} {'wrong':>6} {'silent':>6}")
for what, figures in counts.items():
    print(f"{what:20} " + " ".join(f"{figure:6}" for figure in figures))
sys.exit(1 if any(figures[1] for figures in counts.values()) else 0)
