#!/usr/bin/env python3
"""A device for Palpate's `--device bridge:`. Replace two functions to connect your own.

  palpate record --device "bridge:exec:python3 assets/examples/bridge/bridge.py" --out rec.csv --seconds 20
  python3 bridge.py tcp 5050         then bridge:tcp:127.0.0.1:5050
  python3 bridge.py unix /tmp/tool   then bridge:unix:/tmp/tool

It simulates a tool that a hand moves in and out of a spring of 400 N/m.
devices/README.md#bridge describes the frames.
"""
import math, os, select, socket, struct, sys, time, zlib

RATE_HZ = 1000
WATCHDOG_S = 0.05


def read_sample(t_s):
    """First function: returns the position in metres, positive inside the block, and the measured
    force in newtons, positive outward (None: no sensor)."""
    depth_m = 0.002 + 0.0012 * math.sin(0.31 * t_s)
    position_m = depth_m * math.sin(2 * math.pi * (1.6 * t_s + 7.5 * (1 - math.cos(0.2 * t_s))))
    return position_m, 400.0 * max(0.0, position_m)


def apply_force(force_N):
    """Second function: push the tool with `force_N`, positive out of the block. Palpate limits it;
    limit it here as well to the rated force of your motor."""


def open_line():
    """Descriptors to read from and to write to."""
    if len(sys.argv) != 3:
        return 0, 1
    unix = sys.argv[1] == "unix"
    server = socket.socket(socket.AF_UNIX if unix else socket.AF_INET)
    server.bind(sys.argv[2] if unix else ("127.0.0.1", int(sys.argv[2])))
    server.listen(1)
    line = server.accept()[0].detach()
    return line, line


def main():
    source, sink = open_line()
    pending, sequence, confirmed, heartbeat, heard, drive = b"", 0, 0, None, False, False
    start_s = due_s = valid_s = beat_s = time.monotonic()
    while True:
        now_s = time.monotonic()
        position_m, force_N = read_sample(now_s - start_s)
        silent = now_s - valid_s > WATCHDOG_S or now_s - beat_s > WATCHDOG_S
        if silent:
            drive = False
            apply_force(0.0)
        frame = struct.pack("<4BIIiiBBH", 0x50, 0x42, 1, 0x49, sequence, int(now_s * 1e6) & 0xFFFFFFFF,
                            round(position_m * 1e9), -2**31 if force_N is None else round(force_N * 1e6),
                            drive + 2 * (heard and silent), 0, confirmed & 0xFFFF)
        os.write(sink, frame + struct.pack("<I", zlib.crc32(frame)))
        sequence = (sequence + 1) & 0xFFFFFFFF
        due_s = max(due_s + 1 / RATE_HZ, now_s)  # missed samples are not sent later
        while select.select([source], [], [], max(0.0, due_s - time.monotonic()))[0]:
            came = os.read(source, 4096)
            if not came:
                return
            pending += came
            while (at := pending.find(b"\x50\x42\x01\x4f")) >= 0 and len(pending) >= at + 20:
                frame, crc = pending[at:at + 16], struct.unpack_from("<I", pending, at + 16)[0]
                good = zlib.crc32(frame) == crc
                pending = pending[at + (20 if good else 1):]
                if good:
                    _, confirmed, force_uN, beat, flags, _ = struct.unpack("<4sIiHBB", frame)
                    heard, drive, valid_s = True, flags & 1 == 1, time.monotonic()
                    beat_s, heartbeat = (valid_s, beat) if beat != heartbeat else (beat_s, heartbeat)
                    apply_force(force_uN * 1e-6 if drive else 0.0)
            pending = pending[-20:]


try:
    main()
finally:
    apply_force(0.0)
