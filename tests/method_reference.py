"""method_reference.py PALPATE: computes the forces of model files in numpy, from the equations of models/METHOD.md
alone, and compares them with those of `palpate replay`. Symbols are those of that page."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

TOLERANCE_N = 1e-6  # below the resolution of force sensors; rounding leaves some 1e-12
MATERIALS = ("layered", "sponge")  # with a correction; with slowing
METHODS = ("trend+greedy", "greedy", "voxel", "trend")


def quiet_deviation(y):
    """Standard deviation of white noise, from second differences in the quietest windows of 50 rows."""
    second = y[2:] - 2 * y[1:-1] + y[:-2]
    means = sorted(np.mean(second[50 * k:50 * k + 48] ** 2) for k in range(len(y) // 50))
    return np.sqrt(means[int(0.2 * (len(means) - 1))] / 6) if means else 0.0


def quantum(y):
    change = np.abs(np.diff(y))
    if not (change > 1e-9).any():
        return 0.0
    smallest = change[change > 1e-9].min()
    n = change / smallest
    uneven = np.sum(np.abs(np.diff(np.concatenate([[0], n]))) > 0.5)
    moved = n[n >= 0.5]
    multiple = np.abs(moved - np.round(moved)) < np.minimum(0.02 * np.maximum(1, 0.1 * moved), 0.25)
    ok = len(moved) >= 3 and multiple.sum() >= 0.99 * len(moved) and uneven >= 0.05 * len(moved)
    return smallest if ok else 0.0


def identify_sensor(rec):
    """delta and sigma."""
    p = rec["position_m"][:30000]
    delta = float("%.8e" % quantum(p))
    sigma = np.sqrt(max(0.0, quiet_deviation(p) ** 2 - delta ** 2 / 12))
    if sigma > 0:
        decade = int(np.floor(np.log10(sigma)))
        sigma = min((float("%de%d" % (digit, decade)) for digit in (1, 2, 5, 10)), key=lambda one: abs(np.log(one / sigma)))
    return 0.0 if delta < 0.5 * sigma else delta, sigma


def truncated(e, b):
    """Mean and 1 - variance of a standard normal variable within b of e."""
    def density(x):
        return np.exp(-x * x / 2) / np.sqrt(2 * np.pi)

    def tail(x):  # Abramowitz & Stegun 26.2.17
        t = 1 / (1 + 0.2316419 * x)
        return density(x) * np.polyval([1.330274429, -1.821255978, 1.781477937, -0.356563782, 0.319381530, 0], t)

    low, high = abs(e) - b, abs(e) + b
    if low > 5:
        mean, lost = low, 1.0
    elif b > 0.02:
        inside = (tail(low) if low >= 0 else 1 - tail(-low)) - tail(high)
        mean = (density(low) - density(high)) / inside
        lost = min(1.0, max(0.0, mean ** 2 - (low * density(low) - high * density(high)) / inside))
    else:
        mean, lost = abs(e), 1 - b * b / 3
    return np.copysign(mean, e), lost


def motion(rec):
    """The estimates p_hat and v at every row."""
    delta, sigma = identify_sensor(rec)
    R = sigma ** 2 + (0.02 * delta) ** 2 + 1e-18
    last_p, last_t, skipped, started, out = 0.0, 0.0, 0.0, False, []
    for t, p in zip(rec["time_s"], rec["position_m"]):
        step = t - last_t
        last_t = t
        h = skipped + step if started else 0.25
        jump = started and abs(p - last_p) > max(0.02, 10 * step)
        if jump and (h < 0.1 or skipped == 0):
            skipped = h
            out.append(out[-1])
            continue
        if not started or jump or h > 0.25:
            m = np.array([p, 0 if jump or not started else (p - last_p) / h, 0])
            P, N, chi = np.diag([1e-8, 1e-2, 1.0]), 10.0, 0.0
        else:
            F = np.array([[1, h, h * h / 2], [0, 1, h], [0, 0, 1]])
            Q = [[h ** 5 / 20, h ** 4 / 8, h ** 3 / 6], [h ** 4 / 8, h ** 3 / 3, h * h / 2], [h ** 3 / 6, h * h / 2, h]]
            m, P = F @ m, F @ P @ F.T + N * np.array(Q)
        repeated, skipped = started and p == last_p, 0.0
        last_p, started = p, True
        share = min(1.0, np.sqrt(250 * h)) if repeated and delta > 0 else 1.0
        c, V = P[0].copy(), R + 1e-10 * P[0, 0]
        S = c[0] + V
        mean, lost = truncated((p - m[0]) / np.sqrt(S), delta / 2 / np.sqrt(S))
        m = m + share * mean * c / np.sqrt(S)
        P = P - share * lost * np.outer(c, c) / S
        P[0, 0] = c[0] * ((1 - share * lost) * c[0] + V) / S
        excess = mean ** 2 - lost
        N *= 1 + 0.05 * share * (excess if mean * chi > 0 else min(excess, 0))
        N, chi = min(1000.0, max(1.0, N)), 0.7 * chi + share * mean
        reach = delta / 2 + 3 * sigma
        out.append((min(p + reach, max(p - reach, m[0])), m[1]))
    return np.array(out)


def curve(drive, d):
    """G(d) of one drive curve."""
    u = d / drive["reference_depth_m"]
    r = min(u, 1.0)
    value = sum(c * r ** (k + 1) for k, c in enumerate(drive["coefficient_N"]))
    slope = sum((k + 1) * c for k, c in enumerate(drive["coefficient_N"]))
    return value + slope * max(0.0, u - 1)


class Features:
    def __init__(self, model):
        self.specs, domain = model["features"], model["domain"]
        kinds = [one["kind"] for one in self.specs]
        i = kinds.index("depth")
        self.p0 = self.specs[i].get("surface_position_m", 0.0)
        self.deepest = domain["upper"][i] + 0.15 * (domain["upper"][i] - domain["lower"][i])
        self.branches = [(part, one.get("slowing", 0.0), one["parts"][0]["drive"]["reference_depth_m"])
                         for one in self.specs if one["kind"] == "maxwell_spectrum" for part in one["parts"]]
        self.z, self.G, self.lowpass = np.zeros(len(self.branches)), np.zeros(len(self.branches)), {}
        self.bend, self.d, self.t = {}, 0.0, None

    def update(self, t, p_hat, v):
        present = max(0.0, p_hat - self.p0)
        d, h = min(present, self.deepest), 0.0 if self.t is None else t - self.t
        half = (self.d + d) / 2
        G = np.array([curve(part["drive"], d) for part, _, _ in self.branches])
        if h > 0:
            tau = np.array([part["relaxation_time_s"] * np.exp(slowing * min(half / D, 1))
                            for part, slowing, D in self.branches])
            keep = np.exp(-h / tau)
            self.z = keep * self.z + tau * (1 - keep) / h * (G - self.G)
        self.G = G
        x, first = [], 0
        for i, one in enumerate(self.specs):
            kind, value = one["kind"], 0.0
            if kind == "depth":
                value = present
            elif kind == "velocity":
                value = v if d > 0 else 0.0
            elif kind == "lowpass_velocity" and h > 0:
                e = np.exp(-h / one["relaxation_time_s"])
                value = self.lowpass[i] = e * self.lowpass.get(i, 0.0) + (1 - e) * (d - self.d) / h
            elif kind == "maxwell_spectrum":
                value = self.z[first:first + len(one["parts"])].sum()
                first += len(one["parts"])
            elif kind in ("stops", "creep"):
                for k, part in enumerate(one["parts"]):
                    r, b = part["threshold_m"], self.bend.get((i, k), 0.0)
                    half_creep = h / 2 / part["relaxation_time_s"] if kind == "creep" else 0.0
                    b /= np.sqrt(1 + 2 * half_creep * (b / r) ** 2)
                    b += d - self.d if h > 0 else 0.0
                    b /= np.sqrt(1 + 2 * half_creep * (b / r) ** 2)
                    if kind == "stops":
                        b = min(r, max(-r, b)) if d > 0 else 0.0
                    self.bend[i, k] = b
                    value += curve(part["drive"], d) * b / r
            x.append(value)
        self.d, self.t = d, t
        return np.array(x)


def trend(model, x):
    T, kinds = model["trend"], [one["kind"] for one in model["features"]]
    u = x[kinds.index("depth")] / T["reference_depth_m"]
    v = x[kinds.index("velocity")] if "velocity" in kinds else 0.0
    v = max(-T["velocity_limit_m_per_s"], min(T["velocity_limit_m_per_s"], v))
    r = min(u, 1.0)
    i = min(int(32 * r), 31)
    c = T["elastic_pieces_N"][4 * i:4 * i + 4]
    s = 32 * r - i
    E = np.polyval(c[::-1], s) + max(0.0, 32 * (u - 1)) * (c[1] + 2 * c[2] + 3 * c[3])
    eta, mu = (np.polyval(T[key][::-1], r) for key in ("viscosity_Ns_per_m", "thinning_Ns_per_m"))
    memory = sum(value for value, kind in zip(x, kinds) if kind in ("maxwell_spectrum", "stops", "creep"))
    return E + eta * v + mu * v / (1 + abs(v) / T["thinning_velocity_m_per_s"]) + memory


def correction(model, u):
    if model.get("trend_alone"):
        return 0.0
    if "grid" not in model:
        r = np.sqrt(((np.array(model["centres"]) - u) ** 2).sum(1))
        with np.errstate(divide="ignore", invalid="ignore"):
            phi = {"cubic": r ** 3, "linear": r, "thin-plate": np.where(r > 0, r * r * np.log(r), 0.0)}[model["kernel"]]
        tail = np.concatenate([[1.0], u if len(model["tail"]) > 1 else []])
        return model["weights"] @ phi + model["tail"] @ tail
    values = np.reshape(model["grid"]["values_N"], [len(nodes) for nodes in model["grid"]["nodes"]])
    for nodes, at in zip(model["grid"]["nodes"], u):
        at = min(max(at, nodes[0]), nodes[-1])
        k = min(int(np.searchsorted(nodes, at, "right")) - 1, len(nodes) - 2)
        share = (at - nodes[k]) / (nodes[k + 1] - nodes[k])
        values = values[k] + share * (values[k + 1] - values[k])
    return float(values)


def forces(model, rec, estimates):
    features, domain, out = Features(model), model["domain"], []
    points = np.array(domain["points"], np.float32)
    for t, p, (p_hat, v) in zip(rec["time_s"], rec["position_m"], estimates):
        x = features.update(t, p_hat, v)
        if not p > features.p0:
            out.append(0.0)
            continue
        u = (x - model["normalisation"]["offset"]) / model["normalisation"]["scale"]
        away = np.sqrt(((points - u.astype(np.float32)) ** 2).sum(1).min())
        R1, R2 = domain["inner_radius"], domain["outer_radius"]
        s = min(1.0, max(0.0, (R2 - away) / (R2 - R1)))
        limit = model["correction_limit_N"]
        F = trend(model, x) + s * s * (3 - 2 * s) * min(limit, max(-limit, correction(model, u)))
        out.append(min(1.2 * model["largest_force_N"], max(model.get("lowest_force_N", 0.0), F)))
    return np.array(out)


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0] if key != "acceleration_m_per_s2"}


def main(palpate):
    def run(*words):
        subprocess.run([palpate, *map(str, words)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    worst = 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        train, test, made = (folder / (name + ".csv") for name in ("train", "test", "forces"))
        for material in MATERIALS:
            for seed, seconds, path in ((1, 8, train), (2, 2.5, test)):
                run("synth", "--material", material, "--seed", seed, "--seconds", seconds, "--out", path, "--force")
                rec = read(path)
                np.savetxt(path, np.column_stack(list(rec.values())), "%.17g", ",", header=",".join(rec), comments="")
            models = [folder / f"{method}.json" for method in METHODS]
            for method, path in zip(METHODS, models):
                run("fit", "--recording", train, "--method", method, "--out", path, "--force")
            run("replay", "--recording", test, "--model", *models, "--out", made, "--force")
            rec, found = read(test), read(made)
            estimates = motion(rec)
            for method, path, column in zip(METHODS, models, list(found)[-len(models):]):
                model = json.loads(path.read_text())
                off = np.abs(forces(model, rec, estimates) - found[column]).max()
                print(f"{material} {model['name']}: differs by at most {off:.1e} N; features:",
                      *(one["kind"] for one in model["features"]))
                worst = max(worst, off)
    if not worst <= TOLERANCE_N:
        sys.exit(f"the equations of models/METHOD.md differ from palpate replay by {worst:.1e} N")


if __name__ == "__main__":
    main(sys.argv[1])
