"""readme_commands.py SOURCE BUILD COMPILER: tests every command of every README.

Runs fenced `sh` blocks line by line in a scratch folder with the files that the text
assumes: build/, a table of a rig, recordings, models, answers of subjects. Lines that
would take minutes, or need a person, are listed below with the reason. Commands between
backticks within a sentence contain placeholders: their verb and options must occur in
--help, and their scripts must exist. The `cpp` block of the front page is compiled; `python`
blocks run in the scratch folder."""
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Commands that are not run here, and where they are run.
LEFT_OUT = {
    "bash scenes/run.sh": "builds and shows the window: the main job, a step of .ci/run",
    "bash tests/run.sh": "runs this very test",
}
# Options added to a command, so that it takes seconds or ends without a person.
ADDED = {
    "build/palpate report ": " --quick",
    "build/palpate-demo ": " --seconds 3",
}
# The name of the window program in a sentence.
WINDOW = "palpate-demo"


def run(command, folder, **more):
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          stdin=subprocess.DEVNULL, timeout=1500, **more)
    return done.returncode, done.stdout


def must(command, folder, **more):
    status, text = run(command, folder, **more)
    if status != 0:
        sys.exit("failed with %d: %s\n%s" % (status, command, text))
    return text


def fenced(text, language):
    return re.findall(r"^```%s\n(.*?)^```" % language, text, re.M | re.S)


def lines_of(block):
    for line in block.splitlines():
        command = re.sub(r"\s+#.*", "", line).strip()
        if command and not command.startswith("#"):
            yield command


def inline_commands(text):
    """Commands between backticks that start with a program; they may span lines."""
    without_blocks = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    for words in re.findall(r"`([^`]+)`", without_blocks):
        command = " ".join(words.split())
        if re.match(r"(build/)?palpate(-demo)? |(bash|python3) [a-z]", command):
            yield command.removeprefix("build/")


def make_scratch(folder, build):
    """Makes the files that the commands of the READMEs assume."""
    os.symlink(build, folder / "build")
    os.symlink(build.parent / "assets", folder / "assets")
    palpate = build / "palpate"
    # The test is longer: not every six seconds contain a stroke that a study can use.
    for name, seed, seconds in (("rec-of-the-rig", 1, 6), ("other", 2, 6), ("test", 3, 20)):
        must([palpate, "synth", "--material", "silicone", "--seed", str(seed), "--seconds", str(seconds), "--out",
              name + ".csv"], folder)
    # A table as another program writes it: millimetres, semicolons, other column names.
    with open(folder / "rec-of-the-rig.csv", newline="") as source, open(folder / "rig.csv", "w") as target:
        target.write("Time [s];Displacement [mm];Force [N]\n")
        for row in csv.DictReader(line for line in source if not line.startswith("#")):
            target.write("%s;%.5f;%s\n" % (row["time_s"], 1e3 * float(row["position_m"]), row["force_N"]))
    os.remove(folder / "rec-of-the-rig.csv")
    for name, method in (("a", "trend"), ("b", "random")):
        must([palpate, "fit", "--recording", "other.csv", "--method", method, "--out", name + ".json"], folder)
    must([palpate, "study", "simulate", "--discriminate", "--subjects", "2", "--out", "subjects"], folder)
    for subject in ("S01", "S02"):
        os.replace(folder / "subjects" / (subject + ".csv"), folder / ("discriminate-%s.csv" % subject))


def answers_of_subjects(folder):
    """Copies the answers of two simulated subjects, made by the previous command, for `analyse`."""
    for number, answers in enumerate(sorted((folder / "who").rglob("discriminate-*.csv"))[:2], 1):
        shutil.copy(answers, folder / ("discriminate-S%02d.csv" % number))


def run_blocks(readme, folder, build, environment):
    for block in fenced(readme.read_text(), "sh"):
        for command in lines_of(block):
            if command in LEFT_OUT:
                print("left out: %s (%s)" % (command, LEFT_OUT[command]))
                continue
            if command.startswith("build/palpate-demo") and not window_works(build):
                print("left out: %s (no window, or no xvfb-run, here)" % command)
                continue
            if "study analyse discriminate" in command:
                answers_of_subjects(folder)
            whole = command + "".join(more for begin, more in ADDED.items() if (command + " ").startswith(begin))
            if command.startswith("build/palpate-demo"):
                whole = "xvfb-run -a -s '-screen 0 1280x800x24' " + whole
            must(["bash", "-c", whole], folder, env=environment)
            print("ran: %s" % whole)


def window_works(build):
    return (build / WINDOW).exists() and shutil.which("xvfb-run") is not None


def check_inline(readme, source, build, helps):
    for command in inline_commands(readme.read_text()):
        words = command.split()
        if words[0] in ("bash", "python3"):
            if not (source / words[1]).is_file():
                sys.exit("%s: `%s`: there is no %s" % (readme, command, words[1]))
            continue
        program = build / words[0]
        if not program.exists():
            continue
        verb = [words[1]] if words[0] == "palpate" and re.fullmatch("[a-z]+", words[1]) else []
        if words[0] == "palpate" and words[1:2] == ["study"] and len(words) > 2 and not words[2].startswith("-"):
            verb.append(words[2])
        key = (words[0], *verb)
        if key not in helps:
            helps[key] = must([program, *verb, "--help"], build)
        for option in re.findall(r"--[a-z][a-z-]*", command):
            if option not in helps[key]:
                sys.exit("%s: `%s`: %s does not know %s" % (readme, command, " ".join(key), option))
        print("known: %s" % command)


def compile_snippet(readme, source, folder, compiler):
    for number, block in enumerate(fenced(readme.read_text(), "cpp")):
        heads = "".join(line + "\n" for line in block.splitlines() if line.startswith("#include"))
        body = "".join(line + "\n" for line in block.splitlines() if not line.startswith("#include"))
        program = folder / ("snippet%d.cpp" % number)
        program.write_text(heads + "struct Device { bool read(double&, double&); void push(double); };\n"
                           "void loop(Device& device) {\ndouble time_s = 0, position_m = 0;\n" + body + "}\n")
        must([compiler, "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror",
              "-I" + str(source / "models" / "library"), program], folder)
        print("compiles: the block of %s" % readme)


def run_python(readme, source, folder, build, environment):
    """Runs the blocks of one README in order, in one process."""
    blocks = fenced(readme.read_text(), "python")
    if not blocks:
        return
    (folder / "blocks.py").write_text("".join(blocks))
    must([sys.executable, "blocks.py"], folder, env={
        **environment, "PYTHONPATH": str(source / "models" / "library" / "python"),
        "PALPATE_LIBRARY": str(build / "models" / "library" / "libpalpate_fit.so")})
    print("ran: the Python of %s" % readme)


def main(source, build, compiler):
    source, build = pathlib.Path(source), pathlib.Path(build)
    listed = must(["find", ".", "-name", "README.md", "-not", "-path", "./build*"], source).split()
    readmes = [source / name for name in sorted(listed)]
    helps = {}
    with tempfile.TemporaryDirectory(prefix="palpate-readme-") as name:
        folder = pathlib.Path(name)
        make_scratch(folder, build)
        environment = {**os.environ, "HOME": name, "XDG_DATA_HOME": name + "/share", "XDG_CONFIG_HOME": name + "/config"}
        for readme in readmes:
            run_blocks(readme, folder, build, environment)
            check_inline(readme, source, build, helps)
            compile_snippet(readme, source, folder, compiler)
            run_python(readme, source, folder, build, environment)


if __name__ == "__main__":
    main(*sys.argv[1:])
