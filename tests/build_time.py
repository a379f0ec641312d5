#!/usr/bin/env python3
"""Prints the processor-seconds of a fresh build by target, largest first.

  python3 tests/build_time.py [TARGET ...]      default: palpate palpate-demo

Builds in a temporary folder without a compiler cache. This script is also
CMake's compiler launcher: it starts each compiler and reads its processor time,
which depends little on the load of the machine.
"""
import collections
import os
import re
import resource
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LOG = "PALPATE_BUILD_TIME_LOG"


def launch(command):
    status = subprocess.call(command)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    target = re.search(r"([\w-]+)\.dir/", " ".join(command))
    with open(os.environ[LOG], "a", encoding="utf-8") as log:
        log.write(f"{target.group(1) if target else 'other'} {spent.ru_utime + spent.ru_stime:.3f}\n")
    return status


def measure(targets):
    with tempfile.TemporaryDirectory() as folder:
        os.environ[LOG] = os.path.join(folder, "log")
        launcher = f"{sys.executable};{os.path.abspath(__file__)};--launch"
        subprocess.check_call(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja",
                               f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"], stdout=subprocess.DEVNULL)
        begin = time.monotonic()
        subprocess.check_call(["cmake", "--build", folder, "--target", *targets], stdout=subprocess.DEVNULL)
        elapsed = time.monotonic() - begin
        seconds, objects = collections.Counter(), collections.Counter()
        with open(os.environ[LOG], encoding="utf-8") as log:
            for line in log:
                target, spent = line.split()
                seconds[target] += float(spent)
                objects[target] += 1
    print(f"{'target':<28}{'objects':>8}{'processor-seconds':>20}")
    for target, spent in seconds.most_common():
        print(f"{target:<28}{objects[target]:>8}{spent:>20.1f}")
    print(f"{'all':<28}{sum(objects.values()):>8}{sum(seconds.values()):>20.1f}")
    print(f"{elapsed:.0f} s on {os.cpu_count()} cores")


if sys.argv[1:2] == ["--launch"]:
    sys.exit(launch(sys.argv[2:]))
measure(sys.argv[1:] or ["palpate", "palpate-demo"])
