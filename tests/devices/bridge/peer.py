#!/usr/bin/env python3
"""A `bridge:` device with one fault: peer.py MODE AFTER_S LOG [unix PATH | tcp PORT | pty LINK].

It holds its tool 3 mm inside, with tremor. AFTER_S after the first force it starts the fault MODE and
writes "event SECONDS" to LOG. At the next force of 0 it writes "zero SECONDS". Times are CLOCK_MONOTONIC. With
clock-s, clock-ms, clock-ns, clock-0, uncounted and fast it is wrong from the start.
"""
import math, os, pty, select, socket, struct, sys, time, tty, zlib

MODE, AFTER_S, LOG = sys.argv[1], float(sys.argv[2]), open(sys.argv[3], "a", buffering=1)
RATE_HZ = 1000


def device_frame(sequence, time_us, position_nm, status, confirmed, version=1):
    frame = struct.pack("<4BIIiiBBH", 0x50, 0x42, version, 0x49, sequence & 0xFFFFFFFF, time_us & 0xFFFFFFFF,
                        position_nm, -2**31, status, 0, confirmed & 0xFFFF)
    return frame + struct.pack("<I", zlib.crc32(frame))


def open_line():
    if len(sys.argv) < 5:
        return 0, 1
    if sys.argv[4] == "pty":
        line, other = pty.openpty()
        tty.setraw(other)
        os.symlink(os.ttyname(other), sys.argv[5])
        return line, line
    unix = sys.argv[4] == "unix"
    server = socket.socket(socket.AF_UNIX if unix else socket.AF_INET)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    server.bind(sys.argv[5] if unix else ("127.0.0.1", int(sys.argv[5])))
    server.listen(1)
    line = server.accept()[0].detach()
    return line, line


def wrong(frame, sequence, held):
    """The bytes that are sent instead of `frame` after the event. MODE selects the fault."""
    if MODE == "corrupt":
        return bytes(b ^ 0x11 if i == 13 else b for i, b in enumerate(frame))
    if MODE == "cut":
        return frame[:17]
    if MODE == "reordered":
        held.append(frame)
        return b"" if len(held) % 2 else held.pop() + held.pop()
    if MODE == "text":
        return b"Segmentation fault, they say\n"
    if MODE == "late":
        held.append(frame)
        return held.pop(0) if len(held) > 60 else b""
    if MODE == "silent":
        return b""
    return frame


def main():
    source, sink = open_line()
    pending, sequence, confirmed, heard_s, pushed_s, event, zeroed = b"", 0, 0, 0.0, 0.0, False, False
    start_s, held, force_uN = time.monotonic(), [], 0
    while True:
        now_s = time.monotonic()
        if not event and pushed_s and now_s - pushed_s > AFTER_S:
            event = True
            LOG.write("event %.6f\n" % now_s)
            if MODE == "die":
                os._exit(3)
        tremor_m = 1e-4 * math.sin(2 * math.pi * 9 * now_s)
        position_nm = round((0.003 + tremor_m) * 1e9)
        if event and MODE == "jump":
            position_nm += 20_000_000 if sequence % 2 else 0
        if event and MODE == "nan":
            position_nm = -2**31
        if event and MODE == "repeated":
            sequence -= 1
        silent = now_s - heard_s > 0.05
        status = (2 if heard_s and silent else 0) | (8 if event and MODE == "own" else 0)
        version = 2 if event and MODE == "version" else 1
        count = 26 if MODE == "fast" else 1
        unit = {"clock-s": 1, "clock-ms": 1e3, "clock-ns": 1e9, "clock-0": 0}.get(MODE, 1e6)
        out = b"".join(device_frame(sequence + i, int((now_s + i / (count * RATE_HZ)) * unit), position_nm, status,
                                    confirmed, version) for i in range(count))
        out = wrong(out, sequence, held) if event else out
        while out:
            out = out[os.write(sink, out):]
        sequence += 0 if MODE == "uncounted" else count
        until_s = max(now_s, start_s + 1.0 / RATE_HZ)
        start_s = until_s
        while select.select([source], [], [], max(0.0, until_s - time.monotonic()))[0]:
            if event and MODE == "deaf":
                time.sleep(max(0.0, until_s - time.monotonic()))
                break
            came = os.read(source, 4096)
            if not came:
                return
            pending += came
            while (at := pending.find(b"\x50\x42\x01\x4f")) >= 0 and len(pending) >= at + 20:
                frame, crc = pending[at:at + 16], struct.unpack_from("<I", pending, at + 16)[0]
                pending = pending[at + 20:]
                if zlib.crc32(frame) != crc:
                    continue
                _, confirmed, force_uN, _, flags, _ = struct.unpack("<4sIiHBB", frame)
                heard_s = time.monotonic()
                force_uN = force_uN if flags & 1 else 0
                if force_uN > 2_000_000 and not pushed_s:
                    pushed_s = heard_s
                if event and force_uN == 0 and not zeroed:
                    zeroed = True
                    LOG.write("zero %.6f\n" % heard_s)


main()
