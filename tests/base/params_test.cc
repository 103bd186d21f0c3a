#include "base/params.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/number.h"

namespace piperun {
namespace {

TEST(Range, SaysItselfAsInAHandbook) {
  EXPECT_EQ(Range::Any().Text(), "any number");
  EXPECT_EQ(Range::Positive().Text(), "> 0");
  EXPECT_EQ(Range::NonNegative().Text(), ">= 0");
  EXPECT_EQ(Range::Between(0, 60).Text(), "[0, 60]");
  EXPECT_EQ((Range{.min = 0, .max = 1, .max_open = true}).Text(), "[0, 1)");
  EXPECT_EQ((Range{.min = 0, .max = 0.5, .min_open = true}).Text(), "(0, 0.5]");
  EXPECT_EQ((Range{.max = 3}).Text(), "<= 3");
  EXPECT_EQ((Range{.max = 3, .max_open = true}).Text(), "< 3");
}

TEST(Range, ContainsItsEndsUnlessTheyAreOpen) {
  EXPECT_TRUE(Range::NonNegative().Contains(0));
  EXPECT_FALSE(Range::Positive().Contains(0));
  EXPECT_TRUE(Range::Between(1, 2).Contains(2));
  EXPECT_FALSE((Range{.min = 1, .max = 2, .max_open = true}).Contains(2));
  EXPECT_FALSE(Range::Between(1, 2).Contains(0.999));
}

TEST(Range, NeverContainsNotANumber) {
  for (const Range& range : {Range::Any(), Range::Positive(), Range::Between(-1, 1)}) {
    EXPECT_FALSE(range.Contains(std::nan("")));
  }
}

struct Mount : ParamsOf<Mount> {
  std::string name;
  double angle_rad = 0.25;
  void Visit(ParamVisitor& v) override { v.Number({"angle_rad", "Tilt."}, Range::Any(), angle_rad); }
};

/// One field of every sort.
struct Probe : ParamsOf<Probe> {
  double rate_Hz = 100;
  std::optional<double> heading_rad;
  std::int64_t bits = 24;
  bool enabled = true;
  std::string label = "probe";
  std::string mode = "fast";
  Vector3d offset_m{1, 2, 3};
  Matrix3d misalignment = (Matrix3d() << 1, 2, 3, 4, 5, 6, 7, 8, 9).finished();
  std::vector<double> table{1, 2, 3, 4};
  Mount mount;
  std::vector<Mount> list{{}, {}};
  std::vector<Mount> map;

  void Visit(ParamVisitor& v) override {
    static constexpr std::string_view kModes[] = {"fast", "slow"};
    v.Number({"rate_Hz", "Sampling rate."}, Range::Positive(), rate_Hz);
    v.NumberOr({"heading_rad", "Start heading."}, Range::Any(), "unknown", heading_rad);
    v.Integer({"bits", "Word length."}, 16, 24, bits);
    v.Flag({"enabled", "Whether it records."}, enabled);
    v.Text({"label", "Free text.", true}, label);
    v.Choice({"mode", "How."}, kModes, mode);
    v.Vector({"offset_m", "Lever arm."}, Range::Any(), offset_m);
    v.Matrix({"misalignment", "Axes."}, Range::Any(), misalignment);
    v.Table({"table", "Times and values."}, Range::Any(), 2, table);
    v.Struct({"mount", "Where."}, mount);
    VectorParamList items(list);
    v.List({"list", "Many."}, items);
    VectorParamMap named(map);
    v.Map({"map", "Many by name."}, named);
  }
};

/// Writes one line per field: what a reference page or a manifest does.
class Listing : public ParamVisitor {
 public:
  std::string text;

  void Number(const ParamInfo& i, const Range& range, double& x) override {
    Line(i, FormatNumber(x) + " in " + range.Text());
  }
  void NumberOr(const ParamInfo& i, const Range&, std::string_view none, std::optional<double>& x) override {
    Line(i, x ? FormatNumber(*x) : std::string(none));
  }
  void Integer(const ParamInfo& i, std::int64_t, std::int64_t, std::int64_t& x) override {
    Line(i, std::to_string(x));
  }
  void Flag(const ParamInfo& i, bool& x) override { Line(i, x ? "true" : "false"); }
  void Text(const ParamInfo& i, std::string& x) override { Line(i, x + (i.required ? " (required)" : "")); }
  void Choice(const ParamInfo& i, std::span<const std::string_view> allowed, std::string& x) override {
    Line(i, x + " of " + std::to_string(allowed.size()));
  }
  void Array(const ParamInfo& i, const Range&, std::span<double> x) override { Line(i, Row(x)); }
  void Table(const ParamInfo& i, const Range&, std::size_t columns, std::vector<double>& x) override {
    Line(i, Row(x) + " by " + std::to_string(columns));
  }
  void Group(const ParamInfo& i, const std::function<void(ParamVisitor&)>& visit) override {
    const std::string outer = path_;
    path_ += std::string(i.name) + ".";
    visit(*this);
    path_ = outer;
  }
  void List(const ParamInfo& i, ParamList& list) override {
    for (std::size_t k = 0; k < list.size(); ++k) {
      Group({std::string(i.name) + "[" + std::to_string(k) + "]", i.doc},
            [&](ParamVisitor& v) { list.VisitItem(k, v); });
    }
  }
  void Map(const ParamInfo& i, ParamMap& map) override {
    const auto names = map.Names();
    for (std::size_t k = 0; k < names.size(); ++k) {
      Group({std::string(i.name) + "." + names[k], i.doc}, [&](ParamVisitor& v) { map.VisitItem(k, v); });
    }
  }

 private:
  static std::string Row(std::span<const double> x) {
    std::string row;
    for (const double value : x) row += (row.empty() ? "" : " ") + FormatNumber(value);
    return row;
  }
  void Line(const ParamInfo& i, const std::string& value) {
    text += path_ + std::string(i.name) + ": " + value + "\n";
  }

  std::string path_;
};

TEST(ParamVisitor, MeetsEveryFieldOnceInOrderWithItsDefault) {
  Probe probe;
  probe.map.emplace_back().name = "left";
  Listing listing;
  probe.Visit(listing);
  EXPECT_EQ(listing.text,
            "rate_Hz: 100 in > 0\n"
            "heading_rad: unknown\n"
            "bits: 24\n"
            "enabled: true\n"
            "label: probe (required)\n"
            "mode: fast of 2\n"
            "offset_m: 1 2 3\n"
            "misalignment: 1 2 3 4 5 6 7 8 9\n"
            "table: 1 2 3 4 by 2\n"
            "mount.angle_rad: 0.25 in any number\n"
            "list[0].angle_rad: 0.25 in any number\n"
            "list[1].angle_rad: 0.25 in any number\n"
            "map.left.angle_rad: 0.25 in any number\n");
}

/// Adds one to every number it meets.
class Increment : public Listing {
 public:
  void Number(const ParamInfo&, const Range&, double& x) override { x += 1; }
  void Array(const ParamInfo&, const Range&, std::span<double> x) override {
    for (double& value : x) value += 1;
  }
};

TEST(ParamVisitor, WhatItWritesReachesTheFields) {
  Probe probe;
  Increment increment;
  probe.Visit(increment);
  EXPECT_EQ(probe.rate_Hz, 101);
  EXPECT_EQ(probe.mount.angle_rad, 1.25);
  EXPECT_EQ(probe.list[1].angle_rad, 1.25);
  EXPECT_EQ(probe.offset_m, Vector3d(2, 3, 4));
  EXPECT_EQ(probe.misalignment(0, 1), 3);  // row by row, not Eigen's columns
  EXPECT_EQ(probe.misalignment(1, 0), 5);
}

TEST(Params, ACloneIsEqualAndIndependent) {
  Probe probe;
  probe.rate_Hz = 250;
  const std::unique_ptr<Params> clone = probe.Clone();
  probe.rate_Hz = 1;
  EXPECT_EQ(dynamic_cast<const Probe&>(*clone).rate_Hz, 250);
}

TEST(ParamList, ResizesWithDefaults) {
  std::vector<Mount> items;
  VectorParamList list(items);
  list.Resize(3);
  EXPECT_EQ(list.size(), 3u);
  EXPECT_EQ(items[2].angle_rad, 0.25);
}

TEST(ParamMap, KeepsTheOrderInWhichNamesWereAdded) {
  std::vector<Mount> items;
  VectorParamMap map(items);
  map.Add("b");
  map.Add("a");
  EXPECT_EQ(map.Names(), (std::vector<std::string>{"b", "a"}));
  map.Clear();
  EXPECT_TRUE(map.Names().empty());
}

}  // namespace
}  // namespace piperun
