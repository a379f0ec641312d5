"""Makes `import palpate` work, for the Python that runs this file:

  python3 models/library/python/install.py   builds the library in build/ and names this source tree in a .pth file
  pip install ./models/library/python        copies package and library (this file is the backend, PEP 517)

Needs cmake and the packages of scenes/prepare.sh, and of Python only the standard library. PALPATE_LIBRARY names a
library that is built already."""
import base64
import hashlib
import os
import pathlib
import re
import site
import subprocess
import sys
import sysconfig
import zipfile

FOLDER = pathlib.Path(__file__).resolve().parent
TREE = FOLDER.parents[2]
LIBRARY = "libpalpate_fit.so"


def built_library():
    given = os.environ.get("PALPATE_LIBRARY")
    if given:
        return pathlib.Path(given)
    build = TREE / "build"
    if not (build / "CMakeCache.txt").exists():
        subprocess.run(["cmake", "-S", TREE, "-B", build, "-DPALPATE_BUILD_TOOLS=OFF"], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "palpate_fit_shared"], check=True)
    return build / "models" / "library" / LIBRARY


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    version = re.search(r"project\(palpate VERSION ([0-9.]+)", (TREE / "CMakeLists.txt").read_text()).group(1)
    tag = "py3-none-" + re.sub(r"[-.]", "_", sysconfig.get_platform())
    info = "palpate-%s.dist-info/" % version
    files = {"palpate/" + path.name: path.read_bytes() for path in sorted((FOLDER / "palpate").glob("*.py"))}
    files["palpate/" + LIBRARY] = built_library().read_bytes()
    files[info + "METADATA"] = ("Metadata-Version: 2.1\nName: palpate\nVersion: %s\nRequires-Python: >=3.9\n"
                                "Requires-Dist: numpy\n" % version).encode()
    files[info + "WHEEL"] = ("Wheel-Version: 1.0\nGenerator: palpate\nRoot-Is-Purelib: false\nTag: %s\n" % tag).encode()
    record = "".join("%s,sha256=%s,%d\n" % (name, base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("="),
                                            len(data)) for name, data in files.items())
    files[info + "RECORD"] = (record + info + "RECORD,,\n").encode()
    wheel = "palpate-%s-%s.whl" % (version, tag)
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return wheel


def link():
    built_library()
    in_venv = sys.prefix != sys.base_prefix
    packages = pathlib.Path(sysconfig.get_paths()["purelib"] if in_venv else site.getusersitepackages())
    packages.mkdir(parents=True, exist_ok=True)
    (packages / "palpate.pth").write_text(str(FOLDER) + "\n")
    print("import palpate uses %s; to undo: rm %s" % (FOLDER, packages / "palpate.pth"))


if __name__ == "__main__":
    link()
