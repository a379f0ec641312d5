"""json_page.py PALPATE [--write]: the fields of every verb's --json, as assets/formats/JSON.md lists them.

Runs each verb that measures and compares the fields of its output with the page. --write makes the page, and also runs
the verbs that take minutes (SLOW), whose part is not compared."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

PAGE = pathlib.Path(__file__).resolve().parents[3] / "assets" / "formats" / "JSON.md"
SYNTH = [["synth", "--material", "silicone", "--seed", seed, "--seconds", "8", "--out", name + ".csv"]
         for seed, name in (("1", "rec"), ("2", "test"))]
# In this order, because some read the files of others.
VERBS = {
    "import": ["import", "rig.csv", "--out", "imported.csv"],
    "check": ["check", "rec.csv"],
    "fit": ["fit", "--recording", "rec.csv", "--method", "trend+greedy", "--out", "model.json"],
    "replay": ["replay", "--recording", "test.csv", "--model", "model.json"],
    "report": ["report", "--quick", "--train", "rec.csv", "--test", "test.csv", "--out", "report"],
    "paper": ["paper", "--quick", "--out", "paper"],
    "hard": ["hard"],
    "study simulate": ["study", "simulate", "--subjects", "3", "--out", "study"],
    "study simulate --discriminate": ["study", "simulate", "--discriminate", "rec.csv", "--model", "model.json",
                                      "--subjects", "2", "--out", "strokes"],
}
SLOW = ("paper", "hard")
ALSO = {"check": "`palpate record --json` prints the same object, for its recording.",
        "fit": "`palpate.Model.report` in Python is this object.",
        "replay": "An array of such objects for several recordings.",
        "study simulate": "`palpate study analyse` prints the same objects."}
# By the last name of a field; a field without an entry says what it is.
MEANING = {
    "accelerometer": "whether accelerations were measured",
    "advice": "what to do; may be empty",
    "beyond_units": "units with an error above one JND",
    "began": "the memory of the material at the first row: at rest, or as the end of another recording",
    "beginning_moved": "figures with its beginning, under a preload, where a training recording with the same one begins: "
                       "no prediction; null where there is none",
    "bound_95_held": "share of the errors below the 95 % bound, as recorded",
    "bound_95_held_moved": "the same, aligned",
    "centres": "number of centres or of nodes; 0: the trend alone",
    "code": "stable name of the finding",
    "condition_number": "of the equations for the weights; null where there are none",
    "count": "samples",
    "criterion": "share of correct answers at one JND",
    "data_line": "line of the first numbers, from 1",
    "difference_p99": "99 % error above the lowest one, in JND",
    "energy_J": "largest energy that the loop gave to the hand",
    "expected": "whether the outcome is the expected one",
    "fit_seconds": "time of the fit",
    "flips": "roles whose sign was reversed",
    "folds": "of the cross-validation over several training recordings; 0: there is none",
    "force_zero_N": "to be subtracted from force_N",
    "force_zeroed": "figures with force_zero_N subtracted from this recording; null where that is 0",
    "guessed": "whether the name decided, and not an option",
    "header_line": "line of the column names, from 1; 0: none",
    "identified": "whether the recording determines its surface",
    "jnd_N": "the just noticeable difference at this force",
    "max_abs_error_N": "largest |error|",
    "max_error_over_jnd": "largest error, in JND",
    "median_bound_N": "median of the 95 % bound",
    "missed": "what is not as expected; empty if nothing",
    "force_noise_N": "null where it could not be determined (`force_noise_unknown` of check)",
    "noise_floor_within_jnd": "share within one JND of a perfect model, because of the noise of the force; 1 with the "
                              "finding `force_noise_unknown`: the noise could not be determined",
    "notes": "what was selected or assumed; of a fit with a grid, the error is that before it",
    "out_of_domain_samples": "samples in contact away from the training data",
    "p99_error_over_jnd": "99 % of the errors are below, in JND",
    "rank": "number of independent equations for the weights; null where there are none",
    "reason": "of a refusal",
    "samples_after_reduction": "after thinning",
    "severity": "note, warning or fatal",
    "share": "of correct answers; share_low and share_high are its 95 % interval",
    "standard_error_m": "of the surface; null: not known",
    "standard_error_N": "of the mean of the subjects; not there with one subject",
    "status": "fitted or refused",
    "surface_moved": "figures with the surface aligned to the forces of this recording: no prediction",
    "surface_offset_m": "to be subtracted from position_m, so that 0 is the surface",
    "training_within_jnd": "share of the training within one JND",
    "units": "recordings where there are several, else strokes; resampled for the intervals",
    "unusable": "trials whose forces were not rendered",
    "verdict": "usable, care or unusable; of a study, the result in words",
    "weight_above_0": "whether the regression uses the term",
    "within_at_least": "lower end of the 95 % interval of within_jnd",
    "within_jnd": "share of the samples in contact within one JND, 0 to 1",
    "worst_step_N": "largest change of force from one site to the next",
}
HEAD = """# Output for programs

Verbs that measure print one JSON object with `--json`. `[]` marks an array. Units end the names; a number that does not
exist is null. In the tables of `report` and `paper` each object is a row of the CSV file of that name. Made by
`python3 tests/scenes/cli/json_page.py build/palpate --write`.
"""


def fields(value, path=""):
    """The paths of all members, in order, without repetition."""
    if isinstance(value, dict):
        found = [one for name, member in value.items() for one in fields(member, path + "." * bool(path) + name)]
    elif isinstance(value, list):
        found = [one for member in value for one in fields(member, path + "[]")] or [path + "[]"]
    else:
        found = [path]
    return list(dict.fromkeys(found))


def meaning(path):
    names = [name.removesuffix("[]") for name in path.split(".")]
    return MEANING.get(names[-1], "") or (MEANING["surface_moved"] if "surface_moved" in names else "")


def part(verb, value):
    rows = [("| `%s` | %s |" % (path, meaning(path))).replace("|  |", "| |") for path in fields(value)]
    return "\n".join(["", "## palpate " + verb, "", *([ALSO[verb], ""] if verb in ALSO else []), "| field | meaning |",
                      "|---|---|", *rows, ""])


def run(palpate, arguments, folder):
    done = subprocess.run([palpate, *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit("palpate %s: %s" % (" ".join(arguments), done.stderr))
    return done.stdout


def main(palpate, write):
    with tempfile.TemporaryDirectory() as folder:
        for command in SYNTH:
            run(palpate, command, folder)
        with open(folder + "/rec.csv", newline="") as source, open(folder + "/rig.csv", "w") as table:
            table.write("time (s);position (mm);force (N)\n")
            for row in csv.DictReader(line for line in source if not line.startswith("#")):
                table.write("%s;%.6f;%s\n" % (row["time_s"], 1e3 * float(row["position_m"]), row["force_N"]))
        parts = {verb: part(verb, json.loads(run(palpate, [*arguments, "--json"], folder)))
                 for verb, arguments in VERBS.items() if write or verb not in SLOW}
    if write:
        PAGE.write_text(HEAD + "".join(parts.values()))
        return
    page = PAGE.read_text()
    for verb, text in parts.items():
        if text not in page:
            sys.exit("%s: the part of palpate %s is not that of the program; run this script with --write. Now:\n%s"
                     % (PAGE, verb, text))


if __name__ == "__main__":
    main(str(pathlib.Path(sys.argv[1]).resolve()), "--write" in sys.argv)
