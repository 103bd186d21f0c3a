#!/usr/bin/env python3
"""The architecture checks against small trees with planted violations: each must be found, and nothing else."""

import tempfile
import unittest
from pathlib import Path

import check_includes
import check_text


class PlantedTree(unittest.TestCase):
    """A temporary tree with given files."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def plant(self, name, *lines):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")


class Includes(PlantedTree):
    def found(self, name, include):
        """Problems of a tree that holds one file with one #include."""
        self.plant(name, "#pragma once", f"#include {include}")
        problems = check_includes.check(self.root)
        (self.root / name).unlink()
        return problems

    def assert_refused(self, name, include, words):
        problems = self.found(name, include)
        self.assertEqual(len(problems), 1, (name, include, problems))
        self.assertTrue(problems[0].startswith(f"{name}:2: "), problems[0])
        self.assertIn(words, problems[0])

    def test_arrows_of_the_table_are_accepted(self):
        for name, include in [
            ("base/a.cc", '"base/pose.h"'),
            ("base/a.cc", "<vector>"),
            ("base/random.cc", "<Random123/philox.h>"),
            ("sim/a.h", '"base/pose.h"'),
            ("sim/a.h", "<Eigen/Core>"),
            ("sim/motions/ball_in_pipe.cc", '"sim/bullet/world.h"'),
            ("sim/bullet/world.h", "<btBulletDynamicsCommon.h>"),
            ("sim/bullet/shape.h", '"sim/bullet/world.h"'),
            ("acoustics/audio_file.cc", "<sndfile.h>"),
            ("estimator/spectrum.cc", "<kissfft/kissfft.hh>"),
            ("estimator/spectrum.cc", "<kiss_fftr.h>"),
            ("scenarios/run.cc", '"estimator/estimator.h"'),
            ("scenarios/yaml_reader.cc", "<yaml-cpp/yaml.h>"),
            ("scenarios/output_file.cc", "<unistd.h>"),
            ("tools/piperun/main.cc", "<CLI/CLI.hpp>"),
            ("tests/sim/world_test.cc", '"sim/bullet/world.h"'),
            ("tests/base/pose_test.cc", "<rapidcheck/gtest.h>"),
            ("tests/scenarios/run_test.cc", "<nlohmann/json.hpp>"),
        ]:
            self.assertEqual(self.found(name, include), [], (name, include))

    def test_arrows_against_the_floors_are_refused(self):
        for name, include in [
            ("base/a.h", '"sim/truth.h"'),
            ("sim/a.cc", '"acoustics/source.h"'),
            ("sim/a.cc", '"estimator/estimator.h"'),
            ("acoustics/leaks/jet.cc", '"sim/truth.h"'),
            ("estimator/filters/ekf.cc", '"sim/truth.h"'),
            ("estimator/filters/ekf.cc", '"scenarios/run.h"'),
            ("scenarios/run.cc", '"tools/progress.h"'),
            ("scenarios/run.cc", '"tests/support/any.h"'),
        ]:
            self.assert_refused(name, include, "may not include")

    def test_third_parties_outside_their_place_are_refused(self):
        for name, include, words in [
            ("sim/world.h", "<btBulletDynamicsCommon.h>", "Bullet"),
            ("sim/motions/ball_in_pipe.cc", "<LinearMath/btVector3.h>", "Bullet"),
            ("acoustics/audio_file.h", "<sndfile.hh>", "libsndfile"),
            ("scenarios/run.cc", "<sndfile.h>", "libsndfile"),
            ("estimator/spectrum.h", "<kissfft/kissfft.hh>", "kissfft"),
            ("scenarios/yaml_document.h", "<yaml-cpp/yaml.h>", "yaml-cpp"),
            ("scenarios/score.h", "<nlohmann/json_fwd.hpp>", "nlohmann-json"),
            ("estimator/ekf.cc", "<nlohmann/json.hpp>", "nlohmann-json"),
            ("scenarios/sha256.h", "<openssl/evp.h>", "OpenSSL"),
            ("scenarios/report.cc", "<fmt/format.h>", "fmt"),
            ("sim/noise.cc", "<Random123/philox.h>", "Random123"),
            ("sim/noise.cc", "<gtest/gtest.h>", "GoogleTest"),
            ("base/a.cc", "<boost/optional.hpp>", "not one of our third parties"),
            ("estimator/log.cc", "<unistd.h>", "operating system"),
        ]:
            self.assert_refused(name, include, words)

    def test_private_headers_stay_private(self):
        self.assert_refused("sim/motion.h", '"sim/bullet/world.h"', "is private to sim/")
        self.assert_refused("scenarios/run.cc", '"sim/bullet/world.h"', "is private to sim/")

    def test_headers_are_named_from_the_root(self):
        self.assert_refused("base/pose.cc", '"pose.h"', "from the root")
        self.assert_refused("sim/a.cc", '"../base/pose.h"', "from the root")

    def test_a_third_party_of_one_file_is_refused_in_two(self):
        self.plant("acoustics/fft.cc", "#include <kiss_fftr.h>")
        self.plant("acoustics/noise.cc", "#include <kiss_fft.h>")
        problems = check_includes.check(self.root)
        self.assertEqual(len(problems), 1)
        self.assertIn("acoustics/fft.cc and acoustics/noise.cc: kissfft", problems[0])


class Text(PlantedTree):
    def assert_refused(self, name, line):
        self.plant(name, "harmless", line)
        problems = check_text.check(self.root)
        (self.root / name).unlink()
        self.assertEqual(len(problems), 1, (name, line, problems))
        self.assertTrue(problems[0].startswith(f"{name}:2: "), problems[0])

    # the words are put together here, or the check would find them in this file
    def test_forbidden_words_are_found(self):
        for name, line in [
            ("README.md", "see /" + "home/me/notes"),
            ("docs/a.md", "(/" + "work/main)"),
            ("tools/test", "cd /" + "root/x"),
            ("CMakeLists.txt", "add_compile_options(-ffast" + "-math)"),
            ("CMakePresets.json", '"-march=' + 'native"'),
            ("sim/a.cc", "#include <" + "random>"),
            ("sim/a.cc", "std::random_" + "device seed;"),
            ("sim/a.cc", "std::normal_" + "distribution<double> n;"),
            ("tests/a.cc", "std::shuff" + "le(a, b, g);"),
            ("base/a.cc", "std::has" + "h<int>{}(3)"),
            ("estimator/a.cc", "Vector3d::Ran" + "dom()"),
            ("estimator/a.cc", "v.setRan" + "dom();"),
            ("acoustics/a.cc", "int x = ra" + "nd();"),
            ("acoustics/a.cc", "sra" + "nd(1);"),
            ("sim/a.cc", "std::chrono::steady_" + "clock::now()"),
            ("sim/a.cc", "t +" + "= dt;"),
        ]:
            self.assert_refused(name, line)

    def test_harmless_words_are_not(self):
        self.plant(
            "sim/a.cc",
            "// no fast-math here",
            "operand(3);",
            "grid.rand(3);",
            "random.Uniforms(k, 0);",
            '#include "base/random.h"',
            "docs/homework/a.md",
            "the framework/ folder",
        )
        self.plant("scenarios/a.cc", "std::chrono::steady_" + "clock::now()")
        self.plant("build/a.cc", "/" + "root/x")
        (self.root / "sound.wav").write_bytes(b"\0/" + b"root/\0")
        self.assertEqual(check_text.check(self.root), [])


if __name__ == "__main__":
    unittest.main()
