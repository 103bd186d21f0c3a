#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/check.h"
#include "base/params.h"

namespace piperun::scenarios {

/// A kind as the scenario file sees it: its name and what parameters it takes.
struct KindOption {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  /// Of sensors: "imu", "magnetometer", "pressure", "temperature", "marker" or "audio".
  std::string_view records = {};
};

const std::vector<KindOption>& SensorOptions();  ///< the sensors of sim/, and the hydrophone
const std::vector<KindOption>& MotionOptions();
const std::vector<KindOption>& LeakSoundOptions();
const std::vector<KindOption>& SoundOptions();
const std::vector<KindOption>& WallFeatureOptions();
const std::vector<KindOption>& FilterOptions();

/// The kind that an entry names, in the generated table of its floor.
template <class Kind>
const Kind& FindKind(const std::vector<Kind>& kinds, std::string_view name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name; });
  Demand(found != kinds.end(), "a kind's name was checked when the scenario was read");
  return *found;
}

/// "kind: NAME" and, beside it, the parameters of that kind. A value type.
class KindEntry {
 public:
  using Options = const std::vector<KindOption>& (*)();
  KindEntry(Options options, std::string_view kind);
  KindEntry(const KindEntry& other);
  KindEntry& operator=(const KindEntry& other);
  KindEntry(KindEntry&&) noexcept = default;
  KindEntry& operator=(KindEntry&&) noexcept = default;

  const std::string& kind() const { return kind_; }
  const Params& params() const { return *params_; }
  /// What a sensor of this kind records; empty for other kinds.
  std::string_view records() const;
  Options options() const { return options_; }
  /// Kind first, then the parameters of the kind just read.
  void Visit(ParamVisitor& v);
  /// The two halves of Visit(), for whoever has something to say in between.
  void VisitKind(ParamVisitor& v);
  void VisitParams(ParamVisitor& v) { params_->Visit(v); }

 private:
  Options options_;
  std::string kind_;
  std::unique_ptr<Params> params_;
};

}  // namespace piperun::scenarios
