#!/usr/bin/env python3
"""What a frame of the window costs where the processor draws: processor time of the thread
that draws and of the graphics driver's, a frame. Unlike a frame rate it hardly depends on
what else the machine does.

  python3 tests/bench/frame_cost.py build/palpate-demo [OTHER_DEMO ...] [--seconds 20] [--rounds 2]

What starts once (the driver compiles its shaders) is left out: two runs, one of a quarter of
the time, and their difference. Every program draws 1280 x 720 under Xvfb with four blocks and with one, in turns; without
--models the scene fits its own models beside it, whose threads are not counted.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time


def thread_seconds(pid):
    """(thread, name): processor seconds so far."""
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


def run(program, blocks, seconds, options, display):
    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder, "config/palpate")
        config.mkdir(parents=True)
        (config / "window.json").write_text(json.dumps({"blocks": blocks}))
        stats = pathlib.Path(folder, "stats.json")
        environment = dict(os.environ, DISPLAY=display, XDG_CONFIG_HOME=f"{folder}/config", XDG_DATA_HOME=f"{folder}/data")
        command = [program, "--seconds", str(seconds), "--stats", str(stats)]
        for model in options.models:
            command += ["--model", model]
        process = subprocess.Popen(command, env=environment)
        spent = {}
        while process.poll() is None:
            spent.update(thread_seconds(process.pid))
            time.sleep(0.1)
        graphics = json.loads(stats.read_text())["graphics"]
    drawing = sum(s for (task, name), s in spent.items() if task == str(process.pid) or "llvmpipe" in name)
    return graphics, drawing


def figures_of(program, blocks, options, display):
    first, first_s = run(program, blocks, options.seconds / 4, options, display)
    both, both_s = run(program, blocks, options.seconds, options, display)
    frames = both["frames"] - first["frames"]
    return {"frames": frames, "fps": both["fps"], "frame_ms": both["frame_ms"]["p50"],
            "processor_ms": 1e3 * (both_s - first_s) / max(frames, 1)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--models", nargs="*", default=[], help="files or methods in place of the scene's own")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    number = next(n for n in range(90, 990) if not os.path.exists(f"/tmp/.X11-unix/X{n}"))
    server = subprocess.Popen(["Xvfb", f":{number}", "-screen", "0", "1280x720x24", "-nolisten", "tcp"],
                              stderr=subprocess.DEVNULL)
    while not os.path.exists(f"/tmp/.X11-unix/X{number}"):
        time.sleep(0.05)
    try:
        print("blocks,program,frames,fps,frame_ms_p50,processor_ms_per_frame")
        for _ in range(options.rounds):
            for blocks in (4, 1):
                for program in options.programs:
                    figures = figures_of(program, blocks, options, f":{number}")
                    print(f"{blocks},{program},{figures['frames']},{figures['fps']:.1f},{figures['frame_ms']:.1f},"
                          f"{figures['processor_ms']:.2f}", flush=True)
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
