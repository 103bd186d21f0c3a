#include "scenarios/inp_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/check.h"
#include "scenarios/network_params.h"
#include "tests/support/networks.h"

namespace piperun::scenarios {
namespace {

/// Drawn at 2 m a unit, lower left corner at (500, 700): a pump from a reservoir, a climb of 30 m over 50 m
/// (40 m in plan, 20 units), a level street of 100 m with a corner, valves, a tank. Metric (LPS).
constexpr const char* kText = R"([JUNCTIONS]
A 10
B 40
C 40
D 40
E 40
[RESERVOIRS]
R 60
[TANKS]
T 43 2 0 5 10 0
[PIPES]
climb A B 50 300 140 0 Open
street B C 100 200 100 0 Open
shut D E 30 200 120 0 Closed
main E T 50 200 120 0 CV
[PUMPS]
lift R A POWER 10
[VALVES]
gate C D 150 TCV 0.2 0.2
brake B D 150 PRV 20 0
[COORDINATES]
R 500 700
A 501 700
B 521 700
C 521 750
D 522 750
E 537 750
T 562 750
[VERTICES]
street 531 710
street 531 740
[TAGS]
LINK main "DI 1987"
[OPTIONS]
UNITS LPS
HEADLOSS H-W
[END]
)";

sim::HydraulicModel Read(std::string text = kText, const std::string& from = "", const std::string& to = "") {
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return sim::ReadInp(text, "small.inp");
}

const PipeEntry& Find(const NetworkParams& network, const std::string& id) {
  return *std::find_if(network.pipes.begin(), network.pipes.end(), [&](const auto& p) { return p.id == id; });
}

TEST(DrawNetwork, NumbersNodesAndPipesAsTheModelDoes) {
  const sim::HydraulicModel model = Read();
  const NetworkParams network = DrawNetwork(model, {}).network;
  ASSERT_EQ(network.nodes.size(), static_cast<std::size_t>(model.node_count()));
  ASSERT_EQ(network.pipes.size(), static_cast<std::size_t>(model.link_count()));
  for (int i = 0; i < model.node_count(); ++i)
    EXPECT_EQ(network.nodes[static_cast<std::size_t>(i)].id, model.NodeId(i));
  for (int i = 0; i < model.link_count(); ++i) {
    const PipeEntry& pipe = network.pipes[static_cast<std::size_t>(i)];
    EXPECT_EQ(pipe.id, model.LinkId(i));
    EXPECT_EQ(pipe.from, model.NodeId(model.From(i)));
    EXPECT_EQ(pipe.to, model.NodeId(model.To(i)));
  }
}

// climb: sqrt(50^2 - 30^2) / 20 = 2; shut: 30 / 15 = 2; main: sqrt(50^2 - 3^2) / 25 = 1.9964;
// street: 100 / (2 sqrt(200) + 30) = 1.7157; the median of the four is (1.9964 + 2) / 2
TEST(DrawNetwork, FitsTheMapToTheStatedLengths) {
  const InpDrawing drawing = DrawNetwork(Read(), {});
  const double unit_m = 0.5 * (std::sqrt(2491.0) / 25 + 2);
  EXPECT_NEAR((drawing.network.nodes[0].position_m - Vector3d(unit_m, 0, 10)).norm(), 0, 1e-12);
  EXPECT_NEAR((drawing.network.nodes[2].position_m - Vector3d(21 * unit_m, 50 * unit_m, 40)).norm(), 0,
              1e-12);
  ASSERT_FALSE(drawing.notes.empty());
  EXPECT_NE(drawing.notes[0].find("1.998 m: the median of stated over drawn length of 4 pipes"),
            std::string::npos)
      << drawing.notes[0];
}

TEST(DrawNetwork, TakesTheScaleItIsGiven) {
  DrawingParams params;
  params.map_unit_m = 3;
  const InpDrawing drawing = DrawNetwork(Read(), params);
  EXPECT_EQ(drawing.network.nodes[1].position_m, Vector3d(63, 0, 40));
  for (const std::string& note : drawing.notes) EXPECT_EQ(note.find("median"), std::string::npos);
}

// a sixth of the way is drawn before the first vertex, the rest after; the street is level, the climb is not
TEST(DrawNetwork, LaysVerticesOnASlope) {
  DrawingParams params;
  params.map_unit_m = 2;
  const NetworkParams network =
      DrawNetwork(Read(kText, "street 531 710\nstreet 531 740", "climb 506 700\nclimb 516 700"), params)
          .network;
  const auto& v = Find(network, "climb").vertices_m;
  ASSERT_EQ(v.size(), 6u);
  EXPECT_NEAR((Vector3d(v[0], v[1], v[2]) - Vector3d(12, 0, 17.5)).norm(), 0, 1e-12);
  EXPECT_NEAR((Vector3d(v[3], v[4], v[5]) - Vector3d(32, 0, 32.5)).norm(), 0, 1e-12);
}

TEST(DrawNetwork, LaysAReservoirsPipesAtTheLowestNeighbour) {
  const auto z_of_reservoir = [](const sim::HydraulicModel& model) {
    return DrawNetwork(model, {}).network.nodes[5].position_m.z();
  };
  EXPECT_EQ(z_of_reservoir(Read()), 10);
  EXPECT_EQ(z_of_reservoir(Read(kText, "R 60", "R 7")), 7);
}

TEST(DrawNetwork, OnlyReservoirsAndTanksAreOpenWater) {
  for (const NodeEntry& node : DrawNetwork(Read(), {}).network.nodes) {
    EXPECT_EQ(node.open_water, node.id == "R" || node.id == "T") << node.id;
  }
}

TEST(DrawNetwork, ABallPassesWhatIsWideOpen) {
  const NetworkParams network = DrawNetwork(Read(), {}).network;
  for (const auto& [id, passable] : {std::pair{"climb", true},
                                     {"street", true},
                                     {"shut", false},
                                     {"main", false},
                                     {"lift", false},
                                     {"gate", true},
                                     {"brake", false}}) {
    EXPECT_EQ(Find(network, id).passable, passable) << id;
  }
  const NetworkParams throttled = DrawNetwork(Read(kText, "TCV 0.2 0.2", "TCV 8 0.2"), {}).network;
  EXPECT_FALSE(Find(throttled, "gate").passable);
}

// gate and lift are level: 2 D; brake is level, too; a pump that lifts 3 m: 1.2 x 3 m
TEST(DrawNetwork, GivesPumpsAndValvesALength) {
  const NetworkParams network = DrawNetwork(Read(), {}).network;
  EXPECT_DOUBLE_EQ(*Find(network, "gate").length_m, 0.3);
  EXPECT_DOUBLE_EQ(*Find(network, "lift").length_m, 0.6);
  EXPECT_EQ(Find(network, "lift").diameter_m, 0.3);
  EXPECT_DOUBLE_EQ(*Find(DrawNetwork(Read(kText, "R 60", "R 7"), {}).network, "lift").length_m, 3.6);
}

// C = 140 at 300 mm: PVC-U of SDR 26, e = 300 / 24; C = 100 at 200 mm: grey iron; the tag says ductile iron,
// K9: 9 (0.5 + 0.2) = 6.3 mm
TEST(DrawNetwork, AsksTheRulesForTheWall) {
  const NetworkParams network = DrawNetwork(Read(), {}).network;
  EXPECT_EQ(Find(network, "climb").material, "pvc_u");
  EXPECT_NEAR(Find(network, "climb").wall_thickness_m, 0.0125, 1e-15);
  EXPECT_EQ(Find(network, "street").material, "cast_iron");
  EXPECT_EQ(Find(network, "main").material, "ductile_iron");
  EXPECT_NEAR(Find(network, "main").wall_thickness_m, 0.0063, 1e-15);
  EXPECT_EQ(Find(network, "main").wall.density_kg_m3, 7050);
}

// with Darcy-Weisbach the file gives the sand roughness in mm, and it is the bore's
TEST(DrawNetwork, TakesSandRoughnessFromTheFile) {
  std::string text = kText;
  text.replace(text.find("HEADLOSS H-W"), 12, "HEADLOSS D-W");
  text.replace(text.find("50 300 140"), 10, "50 300 0.9");
  text.replace(text.find("100 200 100"), 11, "100 200 0.01");
  const NetworkParams network = DrawNetwork(Read(text), {}).network;
  EXPECT_EQ(Find(network, "climb").material, "cast_iron");
  EXPECT_NEAR(Find(network, "climb").wall.roughness_m, 0.9e-3, 1e-15);
  EXPECT_EQ(Find(network, "street").material, "pvc_u");
  EXPECT_NEAR(Find(network, "street").wall.roughness_m, 0.01e-3, 1e-15);
}

TEST(DrawNetwork, NodesWithoutCoordinatesAreCountedAndNamed) {
  try {
    DrawNetwork(Read(kText, "C 521 750\nD 522 750\n", ""), {});
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(e.problem().find("2 of 7 nodes have no coordinates, the first is 'C'"), std::string::npos)
        << e.what();
  }
}

TEST(DrawNetwork, MakesANetworkWhosePipesAreAsLongAsStated) {
  const sim::HydraulicModel model = Read();
  const Network network = MakeNetwork(DrawNetwork(model, {}).network);
  for (int i = 0; i < model.first_pump(); ++i) {
    EXPECT_NEAR(network.pipe(i).length_m, model.pipes[static_cast<std::size_t>(i)].length_m, 1e-12);
  }
}

/// What must hold for any file: stated lengths, unit tangents that go on, smooth joints where they are
/// smooth.
void ExpectSound(const sim::HydraulicModel& model, const Network& network) {
  for (int i = 0; i < model.first_pump(); ++i) {
    const double stated_m = model.pipes[static_cast<std::size_t>(i)].length_m;
    EXPECT_NEAR(network.pipe(i).length_m / stated_m, 1, 1e-12) << model.LinkId(i);
  }
  for (const Pipe& pipe : network.pipes()) {
    for (std::size_t i = 0; i < pipe.centreline.size(); ++i) {
      const CentrelinePiece& piece = pipe.centreline[i];
      EXPECT_GT(piece.length_m, 0) << pipe.id;
      // no bend is tighter than 0.6 D
      EXPECT_LE(piece.curvature_1_m * pipe.diameter_m, (1 + 1e-9) / 0.6) << pipe.id;
      if (i == 0) continue;
      const CentrelinePoint before = EvalCentreline(pipe.centreline[i - 1], piece.s_begin_m);
      EXPECT_LE((before.p_W - piece.p_begin_W).norm(), 1e-10) << pipe.id;
      EXPECT_LE((before.tangent_W - piece.tangent_begin_W).norm(), 1e-12) << pipe.id;
    }
    for (const Cone& cone : {pipe.cone_from, pipe.cone_to}) {
      EXPECT_TRUE(cone.length_m == 0 || cone.end_radius_m > pipe.radius_m()) << pipe.id;
    }
  }
}

/// Two pipes alone at a node go over into each other smoothly, or at an angle that shows.
void CountJoints(const Network& network, int& smooth, int& mitred) {
  for (std::size_t node = 0; node < network.nodes().size(); ++node) {
    const auto& ends = network.EndsAt(static_cast<int>(node));
    if (ends.size() != 2) continue;
    const Vector3d a = network.pipe(ends[0].pipe).Inward(ends[0].at_to);
    const Vector3d b = network.pipe(ends[1].pipe).Inward(ends[1].at_to);
    const double turn_rad = CalcTurn_rad(-a, b);
    EXPECT_TRUE(turn_rad <= 1e-12 || turn_rad > 1e-3) << network.nodes()[node].id << " " << turn_rad;
    ++(turn_rad <= 1e-12 ? smooth : mitred);
  }
}

TEST(PublicNetworks, AreLaidWithEveryPipeAsLongAsStated) {
  int found = 0;
  for (const char* name : {"Net1.inp", "Net2.inp", "Net3.inp", "Hanoi.inp", "ky4.inp"}) {
    const auto model = testing::FindPublicNetwork(name);
    if (!model) continue;
    ++found;
    const InpDrawing drawing = DrawNetwork(*model, {});
    const Network network = MakeNetwork(drawing.network);
    SCOPED_TRACE(name);
    ExpectSound(*model, network);
    int smooth = 0, mitred = 0;
    CountJoints(network, smooth, mitred);
    std::printf("%s: %zu pipes; %d joints of two pipes smooth, %d mitred; %s\n", name, network.pipes().size(),
                smooth, mitred, drawing.notes.front().c_str());
  }
  if (found == 0) GTEST_SKIP() << "../shared/networks is not at hand";
}

TEST(OwnNetworks, WithADrawingAreLaid) {
  const sim::HydraulicModel model = testing::ReadOwnNetwork("town.inp");
  ExpectSound(model, MakeNetwork(DrawNetwork(model, {}).network));
}

}  // namespace
}  // namespace piperun::scenarios
