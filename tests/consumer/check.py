"""check.py PALPATE BUILD SOURCE COMPILER LAUNCHER KIND: builds the consumer project and
compares its forces with those of `palpate replay`, bit for bit.
KIND: shared or static (the installed tree, moved to another folder), pkg-config (also for a C
program with the static library), source (add_subdirectory, then FetchContent in the same
folder), or system (installed below BUILD). Uses a temporary folder, which is removed."""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile


def run(*command, **more):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, **more)
    if done.returncode != 0:
        sys.exit("failed: %s\n%s" % (" ".join(str(word) for word in command), done.stdout))
    return done.stdout


def model_and_forces(palpate, folder):
    """A model, a recording without an accelerometer, and its forces."""
    whole, recording, model, forces = (folder / name for name in ("whole.csv", "rec.csv", "model.json", "forces.csv"))
    run(palpate, "synth", "--material", "silicone", "--seed", 3, "--seconds", 6, "--out", whole)
    with open(whole, newline="") as source, open(recording, "w") as target:
        columns = ("time_s", "position_m", "force_N")
        target.write(",".join(columns) + "\n")
        for row in csv.DictReader(line for line in source if not line.startswith("#")):
            target.write(",".join(row[name] for name in columns) + "\n")
    run(palpate, "fit", "--recording", recording, "--method", "random", "--centres", 40, "--out", model)
    run(palpate, "replay", "--recording", recording, "--model", model, "--out", forces)
    return model, recording, forces


def installed(build, folder):
    """Installs the library and development files, and moves the installed tree."""
    for component in ("lib", "dev"):
        run("cmake", "--install", build, "--component", component, "--prefix", folder / "first")
    os.rename(folder / "first", folder / "root")
    return folder / "root"


def build_consumer(source, folder, compiler, launcher, options):
    run("cmake", "-S", source / "tests" / "consumer", "-B", folder / "consumer", "-G", "Ninja",
        "-DCMAKE_CXX_COMPILER=" + compiler, "-DCMAKE_CXX_COMPILER_LAUNCHER=" + launcher, *options)
    run("cmake", "--build", folder / "consumer", "--target", "consumer", "-j", "2")
    return folder / "consumer" / "consumer"


def build_by_pkg_config(source, folder, compiler, root):
    pc = next(root.rglob("palpate_model.pc"))

    def flags(*options):
        return run("pkg-config", "--cflags", "--libs", *options, "palpate_model",
                   env={**os.environ, "PKG_CONFIG_PATH": str(pc.parent)}).split()

    run(compiler, "-std=c++17", source / "tests" / "consumer" / "main.cpp", "-o", folder / "consumer", *flags(),
        "-Wl,-rpath," + str(pc.parent.parent))
    # A C program gets the C++ runtime only from the .pc file.
    static = folder / "static"
    static.mkdir()
    os.symlink(next(root.rglob("libpalpate_model.a")), static / "libpalpate_model.a")
    run("cc", "-std=c99", source / "tests" / "models" / "library" / "c_program.c", "-o", folder / "c_program",
        "-L" + str(static), *flags("--static"))
    return folder / "consumer"


def build_by_source(source, folder, compiler, launcher):
    options = ["-DPALPATE_SOURCE=" + str(source)]
    program = build_consumer(source, folder, compiler, launcher, options + ["-DPALPATE_FETCH=OFF"])
    os.rename(program, folder / "added")
    built = build_consumer(source, folder, compiler, launcher, options + ["-DPALPATE_FETCH=ON"])
    return [folder / "added", built]


def compare(program, model, recording, forces):
    with open(forces) as motion:
        printed = run(program, model, recording, stdin=motion).splitlines()
    with open(forces, newline="") as table:
        rows = list(csv.DictReader(table))
    column = [key for key in rows[0] if key.startswith("random")][0]
    if len(rows) != len(printed):
        sys.exit("replay gave %d forces, the consumer %d" % (len(rows), len(printed)))
    for number, (row, line) in enumerate(zip(rows, printed)):
        if float(row[column]).hex() != float(line.split(",")[0]).hex():
            sys.exit("row %d: replay %s N, the consumer %s N" % (number, row[column], line))
    print("%d forces equal" % len(rows))


def main(palpate, build, source, compiler, launcher, kind):
    source = pathlib.Path(source)
    with tempfile.TemporaryDirectory(prefix="palpate-consumer-") as name:
        folder = pathlib.Path(name)
        if kind == "source":
            programs = build_by_source(source, folder, compiler, launcher)
        elif kind == "system":
            programs = [build_consumer(source, folder, compiler, launcher, ["-DCMAKE_PREFIX_PATH=" + build])]
        elif kind == "pkg-config":
            programs = [build_by_pkg_config(source, folder, compiler, installed(build, folder))]
        else:
            options = ["-DCMAKE_PREFIX_PATH=" + str(installed(build, folder))]
            programs = [build_consumer(source, folder, compiler, launcher,
                                       options + (["-Dpalpate_STATIC=ON"] if kind == "static" else []))]
        model, recording, forces = model_and_forces(palpate, folder)
        for program in programs:
            compare(program, model, recording, forces)


if __name__ == "__main__":
    main(*sys.argv[1:])
