"""The command line as a user meets it: exit codes, messages, and what is left on the disk.

Usage: command_line_test.py PATH_OF_PIPERUN
"""

import csv
import io
import json
import math
import os
import pathlib
import random
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

NETWORK = """\
[JUNCTIONS]
 A 10 4 day
 B 12 6 day
 C 12 0
[RESERVOIRS]
 R 50
[PIPES]
;id from to length bore C
 P R A 200 150 130
 Q B A 50 80 130 0 Open
 S B C 50 80 130 0 Closed
[OPTIONS]
Units LPS
Accuracy 0.00001
[PATTERNS]
day 1 0.5 1
[TIMES]
Duration 3:00
[END]
"""

TOWN = str(pathlib.Path(__file__).resolve().parents[2] / "assets/networks/town.inp")


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
        for command in ([], ["run"], ["check"], ["estimate"], ["scenario"], ["scenario", "new"], ["network"],
                        ["simulate-static"], ["allan"], ["convert-units"]):
            done = piperun(*command, "--help")
            self.assertEqual(done.returncode, 0)
            self.assertIn("Usage", done.stdout)

    def test_simulate_static_records_hours(self):
        board = self.folder / "board.yaml"
        board.write_text("sensors: {imu0: {kind: imu, rate_Hz: 200, gyro: {noise_deg_s_sqrtHz: 0.01}}}\n")
        done = piperun("simulate-static", board, "--duration", "0.1 h", "--rate", 100, "--out", self.out, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout), {"imu0": {"samples": 36000, "lost": 0}})
        self.assertEqual(len((self.out / "mav0/imu0/data.csv").read_text().splitlines()), 36001)
        self.assertEqual(json.loads((self.out / "run.json").read_text())["duration_s"], 360)

    def test_simulate_static_takes_presets(self):
        done = piperun("simulate-static", "bmi088", "--duration", "10s", "--out", self.out, "--json")
        self.assertEqual(json.loads(done.stdout), {"imu0": {"samples": 2000, "lost": 0}}, done.stderr)
        again = self.folder / "again"
        done = piperun("simulate-static", self.out / "scenario.yaml", "--duration", "10s", "--out", again)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("scenario.yaml", "mav0/imu0/data.csv"):
            self.assertEqual((self.out / name).read_bytes(), (again / name).read_bytes(), name)

    def test_simulate_static_refuses_what_is_no_duration(self):
        for duration in ("h", "-1s", "2 weeks", "0", "400d"):
            done = piperun("simulate-static", self.scenario(), "--duration=" + duration, "--out", self.out)
            self.assertEqual(done.returncode, 2, duration)
            self.assertIn("--duration", done.stderr)
            self.assertFalse(self.out.exists())

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

    def test_validate_finds_physics_without_meaning(self):
        base = SCENARIO + "ball: {preset: foam_2.5in, added_mass_coefficient: 0.62, contact_stiffness_N_m: 20000}\n"
        line = base.count("\n")
        for text, parts in [
                (base + "motion: {kind: ball_in_pipe, rate_Hz: 100}\n",
                 [f":{line}: ball.contact_stiffness_N_m", "within 2.16 steps", "raise motion.rate_Hz to 146"]),
                (SCENARIO + "ball: {radius_mm: 80}\n", [f":{line}: ball.radius_m", "(0, 0.07125] m"]),
                (SCENARIO + "ball: {density_kg_m3: -5}\n", [f":{line}: ball.density_kg_m3", "out of range"]),
                (SCENARIO + "ball: {preset: foam_2.5}\n", [f":{line}: ball.preset", "did you mean 'foam_2.5in'?"])]:
            done = piperun("scenario", "validate", self.scenario(text))
            self.assertEqual(done.returncode, 2, text)
            for part in parts:
                self.assertIn(part, done.stderr)

    def test_warnings_stand_in_run_json_and_on_the_screen(self):
        # a ball of 40 mm at 1.1 m/s spins at 55 rad/s: half a radian in steps of 10 ms
        text = (SCENARIO.replace("inlet_L_s: 8.5", "inlet_L_s: 20").replace("rate_Hz: 400", "rate_Hz: 100") +
                "ball: {radius_mm: 20}\nmotion: {kind: ball_in_pipe, rate_Hz: 100}\n")
        done = piperun("run", self.scenario(text), "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        warnings = json.loads((self.out / "run.json").read_text())["warnings"]
        self.assertTrue(any(w.startswith("spin: ") and "raise motion.rate_Hz to" in w for w in warnings), warnings)
        for warning in warnings:
            self.assertIn("Warning: " + warning, done.stdout)

    def test_scenario_new_on_an_epanet_file(self):
        new = self.folder / "mine.yaml"
        start = ("scenario", "new", new, "--inp", TOWN)
        for options, parts in [(("--from", "L0O", "--to", "L20"), ["--from", "did you mean 'L00'?"]),
                               (("--from", "L00", "--to", "L2"), ["--to", "did you mean 'L20'?"]),
                               (("--from", "L20", "--to", "L00"), ["--to", "no water leads from 'L20' to 'L00'"])]:
            done = piperun(*start, *options)
            self.assertEqual(done.returncode, 2)
            for part in parts:
                self.assertIn(part, done.stderr)
        self.assertFalse(new.exists())
        done = piperun(*start, "--from", "L00", "--to", "L20")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(piperun("scenario", "validate", new).returncode, 0)

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
        self.assert_refused(self.scenario(SCENARIO + "ball: {radius_mm: 80}\n"), "ball.radius_m", "0.08", "0.07125")
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

    # ---- noise of a sensor at rest

    def allan(self, *arguments, rows=20000, change=None, unit="deg/s"):
        """A gyroscope of 0.1 deg/s white noise at 100 Hz, N = 0.01 deg/s/sqrt(Hz); `change(k, value)` on top."""
        noise = random.Random(3)
        lines = ["t,w"]
        for k in range(rows):
            value = noise.gauss(0, 0.1)
            lines.append(f"{k / 100:.2f},{change(k, value) if change else value}")
        path = self.folder / "rest.csv"
        path.write_text("\n".join(lines) + "\n")
        return piperun("allan", path, "--columns", "gyro=w", "--unit", "gyro=" + unit, *arguments)

    def test_allan_finds_the_noise_that_was_put_in(self):
        files = [self.folder / name for name in ("a.json", "imu.yaml", "a.svg")]
        done = self.allan("--json", "--json-file", files[0], "--preset", files[1], "--svg", files[2])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout), json.loads(files[0].read_text()))
        terms = json.loads(done.stdout)["channels"][0]["terms"]
        # sd of N from 20,000 samples is below 1 %
        self.assertAlmostEqual(math.degrees(terms["N"]["value"]) / 0.01, 1, delta=0.04)
        self.assertIsNone(terms["K"]["value"])
        self.assertIn("not identifiable from this record", self.allan().stdout)
        done = piperun("simulate-static", files[1], "--duration", "20s", "--out", self.out, "--json")
        self.assertEqual(json.loads(done.stdout), {"imu0": {"samples": 2000, "lost": 0}}, done.stderr)
        self.assertIn("<svg", files[2].read_text())
        self.assertEqual(self.allan("--quiet").stdout, "")

    def test_allan_says_what_is_wrong_with_a_record(self):
        done = self.allan(change=lambda k, value: value + (5 if k > 9000 else 0))
        self.assertEqual(done.returncode, 1)
        self.assertIn("not at rest", done.stderr)
        done = self.allan(change=lambda k, value: "nan" if k == 77 else "?" if k == 99 else value)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 rows with an empty, nan or infinite value", done.stdout)
        self.assertIn("rest.csv:101", done.stdout)
        for unit, part in [("dge", "'dge' is not a known unit"), ("g", "rad/s")]:
            done = self.allan(rows=2000, unit=unit)
            self.assertEqual(done.returncode, 2)
            self.assertIn(part, done.stderr)
        for arguments, rows, parts in [(("--unit", "gyro=rad/s"), 2000, ["--unit", "given twice"]),
                                       (("--unit", "accel=g"), 2000, ["--unit", "no 'accel'"]),
                                       (("--time-column", "x"), 2000, ["--time-column", "'x'"]),
                                       (("--kalibr", self.folder / "k"), 2000, ["--kalibr", "accel"]),
                                       (("--rate", "-1"), 2000, ["--rate"]), ((), 10, ["10 samples"])]:
            done = self.allan(*arguments, rows=rows)
            self.assertEqual(done.returncode, 2, (arguments, done.stdout))
            for part in parts:
                self.assertIn(part, done.stderr)
        self.assertEqual(piperun("allan", self.folder / "none.csv").returncode, 2)
        self.assertFalse((self.folder / "k").exists())

    def test_units_are_converted(self):
        done = piperun("convert-units", "0.15", "deg/sqrt(h)", "--json")
        self.assertAlmostEqual(json.loads(done.stdout)["value"], math.radians(0.15) / 60, 15)
        done = piperun("convert-units", "1", "LSB", "--range", "2000deg/s", "--bits", "16", "--json")
        self.assertAlmostEqual(json.loads(done.stdout)["value"], math.radians(4000) / 65536, 15)
        for arguments, part in [(("1", "furlong"), "'furlong'"), (("x", "m"), "'x'"), (("1", "LSB"), "--range"),
                                (("1", "LSB", "--range", "2g"), "--bits")]:
            done = piperun("convert-units", *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(part, done.stderr)

    # ---- networks

    def network(self, *arguments, text=NETWORK, name="net.inp"):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return piperun("network", path, *arguments)

    def test_network_json_has_exactly_the_fields_promised(self):
        done = self.network("--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual(list(result), ["converged", "iterations", "steps"])
        self.assertIs(result["converged"], True)
        step, = result["steps"]
        self.assertEqual(list(step), ["time_s", "nodes", "links"])
        self.assertEqual(step["time_s"], 0)
        self.assertEqual(sorted(step["nodes"]), ["A", "B", "C", "R"])
        for node in step["nodes"].values():
            self.assertEqual(list(node), ["head_m", "demand_m3_s"])
        for link in step["links"].values():
            self.assertEqual(list(link), ["flow_m3_s", "velocity_m_s", "status"])
        self.assertEqual({k: v["status"] for k, v in step["links"].items()}, {"P": "open", "Q": "open", "S": "closed"})

    def test_network_numbers_are_those_of_continuity_and_hazen_williams(self):
        step = json.loads(self.network("--json").stdout)["steps"][0]
        # a litre of EPANET is a cubic foot / 28.317; A takes 4 L/s, B 6 L/s, C is cut off
        litre = 0.3048 ** 3 / 28.317
        self.assertAlmostEqual(step["links"]["P"]["flow_m3_s"], 10 * litre, 12)
        self.assertAlmostEqual(step["links"]["Q"]["flow_m3_s"], -6 * litre, 12)
        self.assertEqual(step["links"]["S"]["flow_m3_s"], 0)
        self.assertAlmostEqual(step["nodes"]["R"]["demand_m3_s"], -10 * litre, 12)
        self.assertAlmostEqual(step["links"]["Q"]["velocity_m_s"], 6 * litre / (math.pi / 4 * 0.08 ** 2), 9)
        loss = 10.667 * 200 * 0.01 ** 1.852 / (130 ** 1.852 * 0.15 ** 4.871)
        self.assertAlmostEqual(step["nodes"]["R"]["head_m"] - step["nodes"]["A"]["head_m"], loss, 3)

    def test_network_extended_tells_every_reporting_step(self):
        steps = json.loads(self.network("--json", "--extended").stdout)["steps"]
        self.assertEqual([step["time_s"] for step in steps], [0, 3600, 7200, 10800])
        flows = [step["links"]["P"]["flow_m3_s"] for step in steps]
        self.assertAlmostEqual(flows[1] / flows[0], 0.5, 9)
        self.assertIn("The period, 4 instants", self.network("--extended").stdout)

    def test_network_csv_is_a_table(self):
        rows = list(csv.DictReader(io.StringIO(self.network("--csv", "--extended").stdout)))
        self.assertEqual(len(rows), 4 * (4 + 3))
        self.assertTrue(all(None not in row and None not in row.values() for row in rows))
        row, = (r for r in rows if r["time_s"] == "3600" and r["id"] == "Q")
        self.assertEqual((row["element"], row["kind"], row["from"], row["to"], row["head_m"]),
                         ("link", "pipe", "B", "A", ""))

    def test_network_tells_what_a_ball_passes_and_where_water_takes_it(self):
        done = self.network("--json", "--ball-mm", 77, "--from", "R", "--to", "B")
        self.assertEqual(done.returncode, 1, "77 mm is more than 0.95 of 80 mm")
        self.assertIn("no way from 'R' to 'B'", done.stderr)
        self.assertEqual(json.loads(done.stdout)["ball"]["links"],
                         {"P": "passes", "Q": "too narrow", "S": "closed"})
        done = self.network("--json", "--ball-mm", 76, "--from", "R", "--to", "B")
        self.assertEqual(done.returncode, 0, done.stderr)
        routes = json.loads(done.stdout)["routes"]
        self.assertEqual([p["node"] for p in routes["fastest"]], ["R", "A", "B"])
        litre = 0.3048 ** 3 / 28.317
        time_s = math.pi / 4 * (200 * 0.15 ** 2 / (10 * litre) + 50 * 0.08 ** 2 / (6 * litre))
        self.assertAlmostEqual(routes["fastest"][-1]["time_s"], time_s, 6)
        self.assertEqual(list(routes["reachable"]), ["R", "A", "B"])
        self.assertIn("it ends at 'B': no water flows on", self.network("--from", "R").stdout)

    def test_network_accuracy_overrides_the_file(self):
        loose, tight = (json.loads(piperun("network", TOWN, "--json", "--accuracy", a).stdout)["iterations"]
                        for a in (0.1, 1e-8))
        self.assertLess(loose, tight)

    def test_network_that_does_not_converge_is_told_with_its_worst_link(self):
        text = pathlib.Path(TOWN).read_text().replace("Trials    100", "Trials 2").replace("Continue 10", "Stop")
        done = self.network("--json", text=text)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"at 0 s: did not converge in 2 iterations.*link '\w+' is off by [0-9.e-]+ m")
        self.assertIs(json.loads(done.stdout)["converged"], False)

    def test_network_long_tables_are_cut_and_say_so(self):
        self.assertRegex(piperun("network", TOWN).stdout, r"\.\.\. and 83 more nodes; --all prints them")
        self.assertNotIn("--all", piperun("network", TOWN, "--all").stdout)
        self.assertEqual(piperun("network", TOWN, "--quiet").stdout, "")

    def test_network_bad_input(self):
        noise = self.folder / "noise.inp"
        with open(noise, "wb") as file:
            file.write(random.Random(1).randbytes(1 << 20) * 100)
        cases = [(("network", noise), ["noise.inp", "100 MiB"]),
                 (("network", self.folder), ["folder"]),
                 (("network", self.folder / "none.inp"), ["none.inp", "cannot read"]),
                 (("network", TOWN, "--accuracy", "0"), ["--accuracy", "(0, 0.1]"]),
                 (("network", TOWN, "--ball-mm", "big"), ["--ball-mm", "'big'"]),
                 (("network", TOWN, "--from", "L0O"), ["--from", "did you mean 'L00'?"]),
                 (("network", TOWN, "--to", "L00"), ["--from"]),
                 (("network", TOWN, "--json", "--csv"), ["--csv"])]
        for arguments, parts in cases:
            begin = time.monotonic()
            done = piperun(*arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            self.assertLess(time.monotonic() - begin, 5, arguments)
            for part in parts:
                self.assertIn(part, done.stderr)
        for old, new, parts in [(" P R A", " P R X", ["net.inp:9", "[PIPES] 'P'", "no node 'X'"]),
                                ("200 150", "0 150", ["net.inp:9", "length"]),
                                ("200 150", "200 0", ["net.inp:9", "diameter"]),
                                (" Q B A", " P B A", ["net.inp:10", "used twice"]),
                                ("Units LPS", "Units FURLONGS", ["net.inp:13", "FURLONGS"])]:
            self.assertIn(old, NETWORK)
            done = self.network(text=NETWORK.replace(old, new))
            self.assertEqual(done.returncode, 2)
            for part in parts:
                self.assertIn(part, done.stderr)


if __name__ == "__main__":
    PIPERUN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
