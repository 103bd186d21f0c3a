#include "sim/network/pipe_leak.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/number.h"
#include "base/params.h"

namespace piperun::sim {
namespace {

std::string Key(std::size_t i, const char* field) { return "leaks[" + std::to_string(i) + "]" + field; }

void RequireRange(double value, const Range& range, std::size_t i, const char* field) {
  if (range.Contains(value)) return;
  throw InputError("the value is " + FormatNumber(value) + "; allowed: " + range.Text(), Key(i, field));
}

void RequireLeak(const HydraulicModel& model, const PipeLeak& leak, std::size_t i) {
  if (leak.pipe < 0 || leak.pipe >= model.first_pump()) {
    throw InputError("there is no pipe number " + std::to_string(leak.pipe), Key(i, ".pipe"));
  }
  const double length = model.pipes[leak.pipe].length_m;
  RequireRange(leak.s_m, {.min = 0, .max = length, .min_open = true, .max_open = true}, i, ".s_m");
  RequireRange(leak.area_m2, Range::NonNegative(), i, ".area_m2");
  RequireRange(leak.head_area_slope_m, Range::NonNegative(), i, ".head_area_slope_m");
  RequireRange(leak.discharge_coefficient, {.min = 0, .max = 1, .min_open = true}, i,
               ".discharge_coefficient");
  if (leak.area_m2 == 0 && leak.head_area_slope_m == 0) {
    throw InputError("the hole has no area; give an area or a head-area slope > 0", Key(i, ".area_m2"));
  }
}

/// Leaks of each pipe, along it.
std::vector<std::vector<std::size_t>> SortLeaks(const HydraulicModel& model,
                                                std::span<const PipeLeak> leaks) {
  std::vector<std::vector<std::size_t>> order(model.pipes.size());
  for (std::size_t i = 0; i < leaks.size(); ++i) order[leaks[i].pipe].push_back(i);
  for (auto& of_pipe : order) {
    std::sort(of_pipe.begin(), of_pipe.end(),
              [&](std::size_t a, std::size_t b) { return leaks[a].s_m < leaks[b].s_m; });
    for (std::size_t k = 1; k < of_pipe.size(); ++k) {
      if (leaks[of_pipe[k]].s_m == leaks[of_pipe[k - 1]].s_m) {
        throw InputError("two leaks lie at the same place; make them one hole", Key(of_pipe[k], ".s_m"));
      }
    }
  }
  return order;
}

PipeLink CutPiece(const PipeLink& pipe, double s_begin_m, double s_end_m) {
  PipeLink piece = pipe;
  const double share = (s_end_m - s_begin_m) / pipe.length_m;
  piece.length_m = s_end_m - s_begin_m;
  piece.minor_loss *= share;
  piece.leakage.fixed_m25_s *= share;
  piece.leakage.variable_m15_s *= share;
  piece.vertices.clear();
  if (s_begin_m > 0) {
    piece.check_valve = false;
    piece.status = LinkStatus::kOpen;
  }
  return piece;
}

/// Builds the new model: old junctions first, then the leaks', so that old junctions keep their numbers.
class Cutter {
 public:
  Cutter(const HydraulicModel& model, std::span<const PipeLeak> leaks, double gravity_m_s2)
      : old_(model), leaks_(leaks), gravity_m_s2_(gravity_m_s2), order_(SortLeaks(model, leaks)) {
    result_.model = model;
    result_.leaks.resize(leaks.size());
    result_.pipes.resize(model.pipes.size());
  }

  LeakyModel Cut() {
    AddJunctions();
    AddPieces();
    ShiftReferences();
    return std::move(result_);
  }

 private:
  int added() const { return static_cast<int>(leaks_.size()); }
  int NewNode(int node) const { return node < old_.junction_count() ? node : node + added(); }
  /// First pieces keep the numbers of their pipes; the others come after them.
  int NewLink(int link) const { return link < old_.first_pump() ? link : link + added(); }

  void AddJunctions() {
    for (std::size_t i = 0; i < leaks_.size(); ++i) {
      const PipeLeak& leak = leaks_[i];
      const PipeLink& pipe = old_.pipes[leak.pipe];
      const double from = old_.Elevation_m(pipe.from), to = old_.Elevation_m(pipe.to);
      JunctionNode junction;
      junction.id = pipe.id + ":" + leak.id;
      junction.elevation_m = from + (to - from) * leak.s_m / pipe.length_m;
      junction.leak = CalcLeakCoefficients(leak, gravity_m_s2_);
      result_.leaks[i].junction = result_.model.junction_count();
      result_.model.junctions.push_back(std::move(junction));
    }
  }

  void AddPieces() {
    for (std::size_t p = 0; p < old_.pipes.size(); ++p) {
      const PipeLink& pipe = old_.pipes[p];
      double s = 0;
      int from = NewNode(pipe.from);
      for (const std::size_t i : order_[p]) {
        AddPiece(p, s, leaks_[i].s_m, from, result_.leaks[i].junction);
        s = leaks_[i].s_m;
        from = result_.leaks[i].junction;
      }
      AddPiece(p, s, pipe.length_m, from, NewNode(pipe.to));
    }
  }

  void AddPiece(std::size_t p, double s_begin_m, double s_end_m, int from, int to) {
    PipeLink piece = s_begin_m == 0 && s_end_m == old_.pipes[p].length_m
                         ? old_.pipes[p]
                         : CutPiece(old_.pipes[p], s_begin_m, s_end_m);
    piece.from = from;
    piece.to = to;
    auto& pipes = result_.model.pipes;
    int link = static_cast<int>(p);
    if (s_begin_m > 0) {
      piece.id = result_.model.junctions[from].id;
      link = static_cast<int>(pipes.size());
      pipes.push_back(std::move(piece));
    } else {
      pipes[p] = std::move(piece);
    }
    result_.pipes[p].push_back({link, s_begin_m, s_end_m});
  }

  void ShiftReferences() {
    HydraulicModel& model = result_.model;
    const auto shift_ends = [&](auto& link) {
      link.from = NewNode(link.from);
      link.to = NewNode(link.to);
    };
    for (PumpLink& pump : model.pumps) shift_ends(pump);
    for (ValveLink& valve : model.valves) shift_ends(valve);
    for (SimpleControl& control : model.controls) {
      control.action.link = NewLink(control.action.link);
      if (control.node >= 0) control.node = NewNode(control.node);
    }
    for (Rule& rule : model.rules) ShiftRule(rule);
  }

  void ShiftRule(Rule& rule) const {
    for (RulePremise& premise : rule.premises) {
      if (premise.subject == RulePremise::Subject::kNode) premise.index = NewNode(premise.index);
      if (premise.subject == RulePremise::Subject::kLink) premise.index = NewLink(premise.index);
    }
    for (LinkAction& action : rule.then_actions) action.link = NewLink(action.link);
    for (LinkAction& action : rule.else_actions) action.link = NewLink(action.link);
  }

  const HydraulicModel& old_;
  std::span<const PipeLeak> leaks_;
  double gravity_m_s2_;
  std::vector<std::vector<std::size_t>> order_;
  LeakyModel result_;
};

}  // namespace

LeakCoefficients CalcLeakCoefficients(const PipeLeak& leak, double gravity_m_s2) {
  const double speed = leak.discharge_coefficient * std::sqrt(2 * gravity_m_s2);
  return {speed * leak.area_m2, speed * leak.head_area_slope_m};
}

LeakyModel InsertLeaks(const HydraulicModel& model, std::span<const PipeLeak> leaks, double gravity_m_s2) {
  for (std::size_t i = 0; i < leaks.size(); ++i) RequireLeak(model, leaks[i], i);
  return Cutter(model, leaks, gravity_m_s2).Cut();
}

}  // namespace piperun::sim
