#!/usr/bin/env python3
"""Measures the processor time per frame of the window with software rendering. Unlike the frame rate, it hardly
depends on other load of the machine.

  python3 tests/bench/frame_cost.py build/palpate-demo [OTHER_DEMO ...] [--seconds 20] [--rounds 2]

The difference of two runs, one of a quarter of the time, excludes the cost of the start (the driver compiles
shaders). Programs run alternately under Xvfb, so that they see the same load. Columns: processor milliseconds per
frame of the main thread, of the driver's threads, and of the whole program (including the haptics loop and,
without --models, the fits of the scene's models); the lateness of its loop and of an idle loop beside it.
"""
import argparse
import ctypes
import json
import os
import pathlib
import subprocess
import tempfile
import threading
import time


def thread_seconds(pid):
    """Processor seconds so far, by (thread, name)."""
    seconds = {}
    for task in pathlib.Path(f"/proc/{pid}/task").glob("*"):
        try:
            text = (task / "stat").read_text()
        except OSError:  # it has ended
            continue
        name = text[text.index("(") + 1:text.rindex(")")]
        fields = text[text.rindex(")") + 2:].split()
        seconds[(task.name, name)] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds


class IdealLoop(threading.Thread):
    """An idle loop with absolute deadlines at 1 kHz (SCHED_FIFO if allowed): the lateness due to the machine."""

    def __init__(self):
        super().__init__(daemon=True)
        self.late_us, self.running = [], True

    def run(self):
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(80))
        except PermissionError:
            pass
        sleep = ctypes.CDLL(None).clock_nanosleep
        due = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
        while self.running:
            due = max(due + 1_000_000, time.clock_gettime_ns(time.CLOCK_MONOTONIC) - 1_000_000)
            sleep(1, 1, ctypes.byref((ctypes.c_long * 2)(due // 10**9, due % 10**9)), None)  # until that time
            self.late_us.append((time.clock_gettime_ns(time.CLOCK_MONOTONIC) - due) / 1e3)

    def p99_9(self):
        self.running = False
        self.join()
        return sorted(self.late_us)[int(0.999 * (len(self.late_us) - 1))]


def run(program, blocks, seconds, options, display):
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder, "stats.json")
        environment = dict(os.environ, DISPLAY=display, XDG_CONFIG_HOME=f"{folder}/config",
                           XDG_DATA_HOME=f"{folder}/data")
        command = [program, "--seconds", str(seconds), "--stats", str(stats)]
        if options.size != "1280x720":
            command += ["--fullscreen"]
        for model in options.models:
            command += ["--model", model]
        process = subprocess.Popen(command, env=environment)
        ideal = IdealLoop()
        ideal.start()
        spent = {}
        while process.poll() is None:
            spent.update(thread_seconds(process.pid))
            time.sleep(0.1)
        figures = json.loads(stats.read_text())
        figures["ideal_us"] = ideal.p99_9()
    parts = {"main": 0.0, "driver": 0.0, "whole": sum(spent.values())}
    for (task, name), seconds_spent in spent.items():
        if task == str(process.pid):
            parts["main"] += seconds_spent
        elif "llvmpipe" in name:
            parts["driver"] += seconds_spent
    return figures, parts


def row(program, blocks, options, display):
    first, first_s = run(program, blocks, options.seconds / 4, options, display)
    both, both_s = run(program, blocks, options.seconds, options, display)
    graphics = both["graphics"]
    frames = graphics["frames"] - first["graphics"]["frames"]
    cost = [1e3 * (both_s[part] - first_s[part]) / max(frames, 1) for part in both_s]
    haptics = both["haptics"]
    values = [blocks, program, frames, f"{graphics['fps']:.1f}", f"{graphics['frame_ms']['p50']:.1f}",
              f"{graphics['frame_ms']['p99']:.1f}",
              *(f"{ms:.2f}" for ms in cost), f"{haptics['lateness_us']['p99_9']:.0f}", f"{both['ideal_us']:.0f}",
              haptics["missed_deadlines"]]
    return ",".join(map(str, values))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--models", nargs="*", default=[], help="files or methods in place of the scene's own")
    parser.add_argument("--blocks", type=int, nargs="*", default=[5, 1],
                        help="1, 2, or more: a block of each model and of the truth")
    parser.add_argument("--size", default="1280x720", help="of the window")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    number = next(n for n in range(90, 990) if not os.path.exists(f"/tmp/.X11-unix/X{n}"))
    server = subprocess.Popen(["Xvfb", f":{number}", "-screen", "0", f"{options.size}x24", "-nolisten", "tcp"],
                              stderr=subprocess.DEVNULL)
    while not os.path.exists(f"/tmp/.X11-unix/X{number}"):
        time.sleep(0.05)
    try:
        print("blocks,program,frames,fps,frame_ms_p50,frame_ms_p99,main_processor_ms,driver_processor_ms,"
              "whole_processor_ms,lateness_us_p99_9,ideal_loop_us_p99_9,missed_deadlines")
        for _ in range(options.rounds):
            for blocks in options.blocks:
                for program in options.programs:
                    print(row(program, blocks, options, f":{number}"), flush=True)
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
