"""The command line as a user meets it: exit codes, messages, and what is left on the disk.

Usage: command_line_test.py PATH_OF_PIPERUN
"""

import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PIPERUN = ""

SCENARIO = """\
schema: piperun.scenario/1
name: tiny
network:
  nodes:
    - {id: A, position_m: [0, 0, 0]}
    - {id: B, position_m: [3, 0, 0]}
  pipes:
    - {id: P1, from: A, to: B, diameter_mm: 150, wall_thickness_mm: 7.5, material: pvc_u}
flow: {inlet_L_s: 8.5, inlet_pressure_bar: 3}
leaks:
  - {id: L1, pipe: P1, s_m: 1.5, hole_diameter_mm: 2}
mission: {launch: A, retrieve: B, time_limit_s: 60}
sensors:
  imu0: {kind: imu, rate_Hz: 400}
  hydrophone0: {kind: hydrophone}
estimators:
  ekf: {kind: quaternion_ekf}
"""


def piperun(*arguments, **options):
    return subprocess.run([PIPERUN, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=120, check=False, **options)


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        self.out = self.folder / "out"

    def tearDown(self):
        self.scratch.cleanup()

    def scenario(self, text=SCENARIO, name="tiny.yaml"):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def changed(self, old, new):
        self.assertIn(old, SCENARIO)
        return self.scenario(SCENARIO.replace(old, new))

    def assert_refused(self, path, *parts, code=2):
        """The run must fail with every part in its message and leave only the scenario behind."""
        before = set(self.folder.iterdir())
        done = piperun("run", path, "--out", self.out)
        self.assertEqual(done.returncode, code, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)
        self.assertEqual(set(self.folder.iterdir()), before, "nothing half-written")
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, "one clear line: " + done.stderr)

    # ---- good runs

    def test_run_and_replay(self):
        done = piperun("run", self.scenario(), "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("L1", done.stdout)
        again = piperun("estimate", self.out, "--estimators", "ekf", "--out", self.folder / "replayed")
        self.assertEqual(again.returncode, 0, again.stderr)
        for name in ("track.csv", "leaks.csv", "trajectory.tum"):
            self.assertEqual((self.out / "estimates/ekf" / name).read_bytes(),
                             (self.folder / "replayed/estimates/ekf" / name).read_bytes())

    def test_json_is_run_json(self):
        done = piperun("run", self.scenario(), "--out", self.out, "--json")
        self.assertEqual(json.loads(done.stdout), json.loads((self.out / "run.json").read_text()))

    def test_seed_and_run_stand_in_the_effective_scenario(self):
        piperun("run", self.scenario(), "--out", self.out, "--seed", 12, "--run", 34)
        text = (self.out / "scenario.yaml").read_text()
        self.assertIn("seed: 12\n", text)
        self.assertIn("run: 34\n", text)

    def test_quiet_prints_nothing(self):
        done = piperun("run", self.scenario(), "--out", self.out, "--quiet")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_every_command_has_help(self):
        for command in ([], ["run"], ["check"], ["estimate"], ["scenario"], ["scenario", "new"]):
            done = piperun(*command, "--help")
            self.assertEqual(done.returncode, 0)
            self.assertIn("Usage", done.stdout)

    def test_scenario_commands(self):
        self.assertIn("quickstart", piperun("scenario", "list").stdout)
        self.assertIn("mission.time_limit_s", piperun("scenario", "reference").stdout)
        self.assertEqual(piperun("scenario", "validate", self.scenario()).returncode, 0)
        new = self.folder / "mine.yaml"
        self.assertEqual(piperun("scenario", "new", new).returncode, 0)
        self.assertEqual(piperun("scenario", "validate", new).returncode, 0)
        self.assertEqual(piperun("scenario", "new", new).returncode, 2, "must not overwrite")
        shown = self.scenario(piperun("scenario", "show", "quickstart").stdout, "shown.yaml")
        self.assertEqual(piperun("scenario", "validate", shown).returncode, 0)

    def test_check_says_what_failed(self):
        good = self.scenario(SCENARIO + "expect: [{path: /status, equals: ok}]\n")
        bad = self.scenario(SCENARIO + "expect: [{path: /route/length_m, max: 2}]\n", "bad.yaml")
        junit = self.folder / "junit.xml"
        self.assertEqual(piperun("check", good).returncode, 0)
        done = piperun("check", good, bad, "--junit", junit)
        self.assertEqual(done.returncode, 1)
        self.assertIn("1 passed, 1 failed", done.stdout)
        self.assertIn('failures="1"', junit.read_text())

    # ---- wrong usage and bad input

    def test_wrong_usage(self):
        for arguments in ([], ["fly"], ["run"], ["run", "quickstart"], ["run", "quickstart", "--out"],
                          ["run", "quickstart", "--out", self.out, "--seed", "x"], ["run", "--nonsense"]):
            self.assertEqual(piperun(*arguments).returncode, 2, arguments)
        self.assertFalse(self.out.exists())

    def test_missing_file(self):
        self.assert_refused(self.folder / "none.yaml", "none.yaml")

    def test_not_yaml(self):
        self.assert_refused(self.scenario("a: [1, 2\nb: }"), "tiny.yaml:", "not YAML")
        self.assert_refused(self.scenario("words"), "tiny.yaml", "not a YAML map")
        path = self.folder / "binary.yaml"
        path.write_bytes(bytes(range(256)) * 20)
        self.assert_refused(path, "binary.yaml")

    def test_unknown_key(self):
        self.assert_refused(self.changed("diameter_mm: 150", "diametre_mm: 150"), "tiny.yaml:8:", "diametre_mm",
                            "did you mean 'diameter_mm'?")

    def test_unknown_kind(self):
        self.assert_refused(self.changed("kind: imu", "kind: inu"), "sensors.imu0.kind", "'inu'", "imu")

    def test_wrong_type(self):
        self.assert_refused(self.changed("inlet_L_s: 8.5", "inlet_L_s: much"), "tiny.yaml:9:", "flow.inlet_L_s",
                            "expected a number")

    def test_values_out_of_range(self):
        self.assert_refused(self.scenario(SCENARIO + "ball: {radius_mm: 80}\n"), "ball.radius_m", "0.08", "0.075")
        self.assert_refused(self.changed("inlet_L_s: 8.5", "inlet_L_s: -1"), "flow.inlet_L_s", "-1", "[0, 100]")
        self.assert_refused(self.changed("s_m: 1.5", "s_m: 3.5"), "tiny.yaml:11:", "leaks[0].s_m", "3.5", "[0, 3]")
        self.assert_refused(self.changed("rate_Hz: 400", "rate_Hz: 0"), "sensors.imu0.rate_Hz", "0")
        self.assert_refused(self.changed("rate_Hz: 400", "rate_Hz: .nan"), "sensors.imu0.rate_Hz", ".nan")
        self.assert_refused(self.changed("rate_Hz: 400", "rate_Hz: 5000"), "imu0", "5000", "1000")

    def test_sensor_name_used_twice(self):
        self.assert_refused(self.changed("  hydrophone0: {kind: hydrophone}\n",
                                         "  imu0: {kind: imu}\n"), "tiny.yaml:15:", "sensors.imu0", "given twice")

    def test_unknown_node(self):
        self.assert_refused(self.changed("retrieve: B", "retrieve: C"), "mission.retrieve", "'C'")

    def test_output_folder_exists(self):
        self.out.mkdir()
        self.assert_refused(self.scenario(), "exists", "--force")
        (self.out / "mine.txt").write_text("precious")
        done = piperun("run", self.scenario(), "--out", self.out, "--force")
        self.assertEqual(done.returncode, 2, "a folder that is no run folder is not replaced")
        self.assertEqual((self.out / "mine.txt").read_text(), "precious")

    def test_force_replaces_a_run_folder(self):
        path = self.scenario()
        self.assertEqual(piperun("run", path, "--out", self.out).returncode, 0)
        self.assertEqual(piperun("run", path, "--out", self.out).returncode, 2)
        self.assertEqual(piperun("run", path, "--out", self.out, "--force").returncode, 0)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["out", "tiny.yaml"])

    def test_disk_full(self):
        """Every write beyond 64 KiB of a file fails, as on a full disk."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, 1 << 16))
        path = self.scenario()
        done = piperun("run", path, "--out", self.out, preexec_fn=limit)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("cannot write", done.stderr)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["tiny.yaml"], "nothing half-written")

    def test_interrupt(self):
        long = self.scenario(SCENARIO.replace("position_m: [3, 0, 0]", "position_m: [3000, 0, 0]")
                             .replace("time_limit_s: 60", "time_limit_s: 20000"))
        with subprocess.Popen([PIPERUN, "run", str(long), "--out", str(self.out)], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            deadline = time.monotonic() + 60
            while not any(p.name.startswith(".out.partial") for p in self.folder.iterdir()):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn(b"interrupted", errors)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["tiny.yaml"])

    def test_ball_that_stops(self):
        path = self.scenario(SCENARIO.replace("inlet_L_s: 8.5", "inlet_L_s: 0.1").replace(
            "time_limit_s: 60", "time_limit_s: 60, stuck_after_s: 5"), "stuck.yaml")
        done = piperun("run", path, "--out", self.out, "--set", "leaks=[]")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("ball_stuck", done.stderr)
        self.assertEqual(json.loads((self.out / "run.json").read_text())["status"], "ball_stuck")
        again = piperun("estimate", self.out, "--out", self.folder / "replayed")
        self.assertEqual(again.returncode, 0, "its data are readable: " + again.stderr)

    def test_broken_run_folder(self):
        self.assertEqual(piperun("run", self.scenario(), "--out", self.out).returncode, 0)
        data = self.out / "mav0/imu0/data.csv"
        lines = data.read_text().splitlines()
        lines[100] = lines[100].replace(",", ";", 1)
        data.write_text("\n".join(lines) + "\n")
        done = piperun("estimate", self.out, "--out", self.folder / "replayed")
        self.assertEqual(done.returncode, 2)
        self.assertIn("data.csv:101", done.stderr)
        self.assertFalse((self.folder / "replayed").exists())
        done = piperun("estimate", self.out, "--out", self.folder / "replayed", "--estimators", "quaternion_efk")
        self.assertIn("did you mean 'quaternion_ekf'?", done.stderr)


if __name__ == "__main__":
    PIPERUN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
