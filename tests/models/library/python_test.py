"""Tests the package palpate: the same figures as the programs, wrong arguments.

PYTHONPATH: its folder; PALPATE_LIBRARY: the library; PALPATE: the program."""
import csv
import json
import os
import pathlib
import pydoc
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import palpate


def program(*arguments):
    done = subprocess.run([os.environ["PALPATE"], *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        raise AssertionError(done.stderr.decode())
    return done.stdout.decode()


def setUpModule():
    """Makes one fit for all cases. The scratch folder is removed at exit."""
    Case.scratch = tempfile.TemporaryDirectory()
    Case.folder = pathlib.Path(Case.scratch.name)
    Case.files = [Case.folder / (name + ".csv") for name in "ab"]
    for seed, file in enumerate(Case.files, 1):
        program("synth", "--material", "silicone", "--seed", seed, "--seconds", 6, "--out", file)
    Case.recordings = [palpate.read_recording(file) for file in Case.files]
    Case.rec = Case.recordings[0]
    Case.model = palpate.fit([Case.rec], method="trend+random", centres=30, seed=4)


class Case(unittest.TestCase):
    def refused(self, part, function, *arguments, **options):
        with self.assertRaises(palpate.Error) as caught:
            function(*arguments, **options)
        self.assertIn(part, str(caught.exception))

    def motion(self, rec):
        return {name: rec[name] for name in rec.dtype.names if name != "force_N"}


class AsThePrograms(Case):
    def test_a_recording_has_the_rows_of_its_file(self):
        with open(self.files[0], newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.assertEqual(len(rows), len(self.rec))
        self.assertEqual(self.rec.name, "a")
        for name in self.rec.dtype.names:
            self.assertEqual([float(row[name]) for row in rows], self.rec[name].tolist())

    def test_a_fit_writes_the_bytes_of_the_program(self):
        for options in (dict(method="random", centres=30, seed=4),
                        dict(method="voxel", grid=[9, 5], features=["depth", "velocity"]),
                        dict(method="greedy", centres=10, candidates="all", features=["depth", "maxwell:0.1+0.5"]),
                        dict(method="trend+random"), dict(method="trend")):
            path, expected = self.folder / "model.json", self.folder / "expected.json"
            words = []
            for name, value in options.items():
                joined = ("x" if name == "grid" else ",").join(map(str, value)) if isinstance(value, list) else value
                words += ["--" + name, joined]
            printed = program("fit", "--recording", *self.files, *words, "--out", expected, "--force", "--json")
            model = palpate.fit(self.recordings, **options)
            model.save(path, overwrite=True)
            self.assertEqual(path.read_bytes(), expected.read_bytes(), options)
            report = {**model.report, "fit_seconds": 0.0}
            self.assertEqual(report, {**json.loads(printed), "fit_seconds": 0.0})

    def test_forces_and_features_are_those_of_replay(self):
        path, forces = self.folder / "replayed.json", self.folder / "forces.csv"
        self.model.save(path)
        test = self.recordings[1]
        figures = json.loads(program("replay", "--recording", self.files[1], "--model", path, "--out", forces,
                                     "--json"))
        with open(forces, newline="") as file:
            rows = list(csv.DictReader(file))
        force_N, bound_N = self.model.render(**self.motion(test))
        features = self.model.features(**self.motion(test))
        self.assertEqual([float(row[self.model.name + "_N"]) for row in rows], force_N.tolist())
        self.assertTrue(np.all(bound_N >= 0.0))
        for index, name in enumerate(self.model.feature_names):
            self.assertEqual([float(row[name]) for row in rows], features[:, index].tolist())
        share = palpate.within_jnd(force_N, test["force_N"],
                                   palpate.in_contact(test["position_m"], test["force_N"]))
        self.assertAlmostEqual(share, figures["models"][0]["within_jnd"], 12)

    def test_a_file_is_read_back(self):
        path = self.folder / "saved.json"
        self.model.save(path)
        loaded = palpate.load(path)
        np.testing.assert_array_equal(loaded.render(**self.motion(self.rec)),
                                      self.model.render(**self.motion(self.rec)))
        self.assertEqual(loaded.report, {})


class Loop(Case):
    def test_a_stream_gives_the_forces_of_a_batch(self):
        t, x = self.rec["time_s"][:2000], self.rec["position_m"][:2000]
        force_N, bound_N = self.model.render(t, x, sensor=30e-6)
        stream = palpate.Stream(self.model, 30e-6)
        self.assertFalse(stream.accepted)
        for i in range(len(t)):
            self.assertEqual(stream.force(t[i], x[i]), force_N[i])
            np.testing.assert_equal(stream.bound(), bound_N[i])
            self.assertTrue(stream.accepted)
        self.assertEqual(stream.force(t[-1], 0.002), 0.0)
        self.assertFalse(stream.accepted)
        stream.reset()
        self.assertEqual([stream.force(t[i], x[i]) for i in range(100)], force_N[:100].tolist())
        theirs = palpate.Stream(self.model)
        for sensor in (0, 0.0, None):  # the encoder of the recordings, as in C
            same = palpate.Stream(self.model, sensor)
            self.assertEqual([same.force(t[i], x[i]) for i in range(500)], [theirs.force(t[i], x[i]) for i in range(500)])
            theirs.reset()
        exact = palpate.Stream(self.model, palpate.Sensor())
        self.assertNotEqual([exact.force(t[i], x[i]) for i in range(500)],
                            [theirs.force(t[i], x[i]) for i in range(500)])

    def test_a_loop_holds_a_repeated_sample_and_changes_by_2_N_per_ms(self):
        stream, limiter = palpate.Stream(self.model, 30e-6), palpate.Limiter(largest_N=5, ramp_s=0.1)
        last_N = 0.0
        for i in range(1000):
            force_N = limiter.render(stream, (i - (i == 700)) / 1000.0, 0.002, 1e-3)
            self.assertLessEqual(abs(force_N - last_N), 2.0 + 1e-9)
            if i == 700:
                self.assertGreater(force_N, 0.9 * last_N)
            last_N = force_N
        self.assertGreater(last_N, 0.1)
        limiter.stop()
        limiter.render(stream, 2.0, 0.002, 1e-3)
        self.assertEqual(limiter.flags & 64, 64)
        slow = palpate.Limiter(lag_s=0.02)
        for i in range(200):
            slow.render(stream, 3.0 + 0.001 * i, 0.002, 1e-3)
        self.assertLess(slow.stiffness_share, min(0.95, limiter.stiffness_share))
        self.assertEqual(slow.flags & 128, 128)
        alone = palpate.Limiter(ramp_s=0)
        self.assertEqual([alone.force(9.0, 1e-3) for _ in range(3)], [0.0, 2.0, 4.0])
        self.refused("fastest_N_per_s", palpate.Limiter, fastest_N_per_s=-1)
        self.refused("found the limit 'peak_N', expected lag_s, largest_N", palpate.Limiter, peak_N=5)
        for lag_s in (float("nan"), -1):
            self.refused("lag_s: found", palpate.Limiter, lag_s=lag_s)


class WrongArguments(Case):
    def test_errors_name_what_was_found_and_expected(self):
        rec, model = self.rec, self.model
        self.refused("no such file", palpate.load, self.folder / "none.json")
        self.refused("time_s: found %d values, expected 3" % len(rec), model.render, rec["time_s"],
                     rec["position_m"][:3])
        self.refused("found dtype <U1, expected numbers", model.render, ["a"], ["b"])
        self.refused("method: found \"nothing\"", palpate.fit, [rec], method="nothing")
        self.refused("centres: found \"0\"", palpate.fit, [rec], centres=0)
        self.refused("row 5", palpate.fit, [palpate.make_recording(
            np.append(np.arange(5.0), 1.0) / 1000, np.zeros(6), np.zeros(6))])
        self.refused("with a name of method, centres", palpate.fit, [rec], scene="nowhere")
        self.refused("expected a path or columns", palpate.fit, [np.zeros((9, 3))])
        self.refused("in_contact of dtype float64", palpate.within_jnd, [1.0], [1.0], [1.0])

    def test_a_wrong_type_is_a_type_error_of_this_package(self):
        stream, limiter = palpate.Stream(self.model), palpate.Limiter()
        for function, *arguments in ((palpate.Stream, "model.json"), (palpate.Stream, self.model, "30e-6"),
                                     (palpate.Stream, self.model, [30e-6]), (limiter.render, self.model, 0, 0, 1e-3),
                                     (limiter.render, stream, "0", 0, 1e-3), (limiter.force, None, 1e-3),
                                     (limiter.set_lag, "5 ms"), (stream.force, 0, [0]), (palpate.load, 7),
                                     (lambda: palpate.Limiter(largest_N="5"),), (palpate.fit, [3.0]),
                                     (self.model.render, ["a"], ["b"])):
            with self.assertRaises(TypeError) as caught:
                function(*arguments)
            self.assertIsInstance(caught.exception, palpate.Error)
            self.assertIn("found", str(caught.exception))
        for path in ("a\0b", b"a\0b"):
            self.refused("zero byte", palpate.load, path)
            self.refused("zero byte", palpate.read_recording, path)
        self.refused("zero byte", palpate.fit, [self.rec], method="trend\0")

    def test_arrays_of_any_type_and_stride(self):
        time_s, position_m = np.arange(400) / 1000.0, np.linspace(0.0, 0.004, 400)
        expected = self.model.render(time_s, position_m)[0]
        strided = np.repeat(position_m, 2)[::2]
        self.assertFalse(strided.flags.c_contiguous)
        np.testing.assert_array_equal(self.model.render(list(time_s), strided)[0], expected)
        self.model.render(time_s.astype(np.float32) + np.arange(400), np.zeros(400, int))

    def test_what_is_missing_is_refused(self):
        t, x = np.arange(50) / 1000.0, np.full(50, 0.001)
        self.refused("position_m: found None", self.model.render, t, None)
        self.refused("time_s: found None", self.model.render, None, x)
        self.refused("position_m: found None", self.model.features, t, None)
        self.refused("force_N: found None", palpate.in_contact, x, None)
        self.refused("position_m: found None", palpate.in_contact, None, x)

    def test_forces_that_are_not_numbers_are_refused(self):
        measured = np.where(np.arange(10) % 2, np.nan, 1.0)
        self.refused("measured_N: found 5 of 10 values that are not finite", palpate.within_jnd, np.ones(10), measured)
        self.refused("force_N: found 1 of 1", palpate.within_jnd, [np.inf], [1.0])
        masked = np.ma.masked_array(np.ones(10), np.arange(10) < 3)
        self.refused("measured_N: found masked values", palpate.within_jnd, np.ones(10), masked)
        t, x = np.arange(10) / 1000.0, np.ma.masked_array(np.full(10, 0.001), np.arange(10) < 3)
        self.refused("position_m: found masked values", self.model.render, t, x)
        self.refused("time_s: found masked values", self.model.render, np.ma.masked_less(t, 0.004), np.ones(10))
        self.assertEqual(len(self.model.render(t, np.ma.masked_array(np.full(10, 0.001)))[0]), 10)

    def test_an_option_is_one_word(self):
        for options in (dict(kernel="cubic seed=3"), dict(method="random\tseed=3"), dict(features=["depth seed=3"]),
                        {"kernel=cubic seed": 3}, dict(kernel="")):
            self.refused("expected one word", palpate.fit, [self.rec], **options)

    def test_a_sensor_may_be_the_step_of_an_encoder(self):
        t, x = self.rec["time_s"], self.rec["position_m"]
        expected = self.model.render(t, x, sensor=palpate.Sensor(30e-6))[0]
        for sensor in (30e-6, np.float64(30e-6), np.array(30e-6)[()]):
            np.testing.assert_array_equal(self.model.render(t, x, sensor=sensor)[0], expected)
        self.model.render(t, x, sensor=0)
        for sensor in ("30e-6", [30e-6], True):
            self.refused("sensor: found", self.model.render, t, x, sensor=sensor)

    def test_times_that_stand_still_are_refused(self):
        t, x = 1.7e9 + np.arange(1000) / 1000.0, np.full(1000, 0.002)
        self.assertTrue(np.any(self.model.render(t, x)[0] > 0.0))
        self.refused("float32 cannot tell", self.model.render, t.astype(np.float32), x)
        self.refused("expected increasing seconds", self.model.render, np.floor(t), x)
        self.refused("expected increasing seconds", self.model.render, t[::-1], x)

    def test_a_fit_stops_when_progress_says_so(self):
        self.refused("interrupted", palpate.fit, [self.rec], progress=lambda fraction: False)

        def fails(_):
            raise KeyError("mine")
        self.assertRaises(KeyError, palpate.fit, [self.rec], progress=fails)

    def test_the_manual_has_every_name(self):
        manual = pydoc.render_doc(palpate, renderer=pydoc.plaintext)
        self.assertLess(len(manual.splitlines()), 900)
        self.assertRegex(palpate.__version__, r"^\d+\.\d+\.\d+$")
        for name in palpate.__all__:
            self.assertIn(name, manual)
            self.assertTrue(getattr(palpate, name).__doc__, name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "--quiet"])
