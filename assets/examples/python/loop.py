"""loop.py [MODEL.json [SECONDS]]: a loop of your own with the emulated device of ../bridge/bridge.py: unwraps the clock of
the device, measures the lag, renders the model. Without a model it fits the recording of the examples."""
import math
import pathlib
import struct
import subprocess
import sys
import zlib

import palpate

EXAMPLES = pathlib.Path(__file__).resolve().parents[1]


def samples(pipe):
    """Time [s], position [m] and the last command that acted, of each valid frame (devices/README.md)."""
    pending, time_us, last_us = b"", 0, None
    while chunk := pipe.read1(4096):
        pending += chunk
        while (at := pending.find(b"PB\x01I")) >= 0 and len(pending) >= at + 28:
            frame, crc = pending[at:at + 24], struct.unpack_from("<I", pending, at + 24)[0]
            good = zlib.crc32(frame) == crc
            pending = pending[at + (28 if good else 1):]
            if good:
                _, _, stamp_us, position_nm, _, _, _, acted = struct.unpack("<4sIIiiBBH", frame)
                time_us += 0 if last_us is None else (stamp_us - last_us) & 0xFFFFFFFF  # it wraps after 71 minutes
                last_us = stamp_us
                yield 1e-6 * time_us, 1e-9 * position_nm, acted


def main(model=None, seconds=5.0):
    model = palpate.load(model) if model else palpate.fit([EXAMPLES / "silicone_press.csv"], method="trend")
    stream, limiter = palpate.Stream(model), palpate.Limiter(largest_N=5)
    device = subprocess.Popen([sys.executable, str(EXAMPLES / "bridge" / "bridge.py")], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, bufsize=0)

    def send(sequence, force_N, drive):
        frame = struct.pack("<4sIiHBB", b"PB\x01O", sequence, round(1e6 * force_N), sequence & 0xFFFF, drive, 0)
        device.stdin.write(frame + struct.pack("<I", zlib.crc32(frame)))

    sampled_s, before_s = {}, -1e-3
    send(0, 0.0, 0)
    for sequence, (time_s, position_m, acted) in enumerate(samples(open(device.stdout.fileno(), "rb", closefd=False)), 1):
        # From which sample the force came that acted at this one, in the clock of the device; unknown at first.
        acted_s = sampled_s.get(acted, math.nan)
        limiter.acted(acted_s)
        force_N = limiter.render(stream, time_s, position_m, time_s - before_s)
        sampled_s[sequence & 0xFFFF], before_s = time_s, time_s
        send(sequence, force_N, 1)
        if sequence % 600 == 0:
            print("force %.3f N, lag %.1f ms, stiffness share %.2f, flags %d"
                  % (force_N, 1e3 * (time_s - acted_s), limiter.stiffness_share, limiter.flags))
        if time_s > float(seconds):
            break
    send(sequence + 1, 0.0, 0)
    device.terminate()


if __name__ == "__main__":
    main(*sys.argv[1:])
