"""compare.py [RECORDING.csv [FIGURE.png]]: plots the forces of three models of one recording, and their errors with
the just noticeable difference (JND). Needs matplotlib (Debian: python3-matplotlib).

The models are fitted to the first half of the recording and compared on the second. They get the motion of the
whole recording, so that their state at the start of the second half is right."""
import pathlib
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    sys.exit("skipped: matplotlib is not there")

import palpate

EXAMPLE = pathlib.Path(__file__).resolve().parents[1] / "silicone_press.csv"
# Options of palpate.fit, and the colour-blind-safe colours of Okabe & Ito.
MODELS = {"depth alone": (dict(method="trend", features="depth"), "#0072B2"),
          "greedy of 2009": (dict(method="greedy", centres=60), "#D55E00"),
          "trend+greedy": (dict(method="trend+greedy", centres=60), "#CC79A7")}


def main(recording=EXAMPLE, figure="compare.png"):
    rec = palpate.read_recording(recording)
    half = len(rec) // 2
    test = rec[half:]
    contact = palpate.in_contact(rec["position_m"], rec["force_N"])[half:]
    jnd_N = palpate.jnd_N(test["force_N"])

    pyplot.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    shown, (forces, errors) = pyplot.subplots(2, 1, sharex=True, figsize=(8, 5), layout="constrained")
    forces.plot(test["time_s"], test["force_N"], color="black", linewidth=2.5, alpha=0.35, label="measured")
    errors.fill_between(test["time_s"], -jnd_N, jnd_N, color="0.88", linewidth=0, label="JND")
    for name, (options, colour) in MODELS.items():
        model = palpate.fit([rec[:half]], **options)
        force_N = model.render(rec["time_s"], rec["position_m"])[0][half:]
        share = palpate.within_jnd(force_N, test["force_N"], contact)
        print("%-15s %5.1f %% within the JND" % (name, 100 * share))
        forces.plot(test["time_s"], force_N, color=colour, linewidth=1, label="%s: %.1f %%" % (name, 100 * share))
        errors.plot(test["time_s"], force_N - test["force_N"], color=colour, linewidth=1)
    forces.set_ylabel("force [N]")
    errors.set_ylabel("error [N]")
    errors.set_xlabel("time [s]")
    for axes in (forces, errors):
        axes.legend(frameon=False, loc="upper left", ncols=4)
        axes.margins(x=0.01, y=0.2)
    shown.savefig(figure, dpi=150)


if __name__ == "__main__":
    main(*sys.argv[1:])
