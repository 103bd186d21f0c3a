#include "scenarios/kind_entry.h"

#include <algorithm>

#include "acoustics/hydrophone.h"
#include "acoustics/sound.h"
#include "acoustics/source.h"
#include "base/check.h"
#include "estimator/filter_kind.h"
#include "sim/motion.h"
#include "sim/sensor.h"
#include "sim/wall_feature.h"

namespace piperun::scenarios {
namespace {

template <class Kind>
std::vector<KindOption> MakeOptions(const std::vector<Kind>& kinds) {
  std::vector<KindOption> options;
  for (const Kind& kind : kinds) options.push_back({kind.name, kind.doc, kind.make_params});
  return options;
}

std::vector<KindOption> MakeSensorOptions() {
  std::vector<KindOption> options;
  for (const sim::SensorKind& kind : sim::SensorKinds()) {
    options.push_back({kind.name, kind.doc, kind.make_params, kind.records});
  }
  options.push_back({"hydrophone", "Hydrophone with its converter: everything the ball hears.",
                     MakeParams<acoustics::HydrophoneParams>, "audio"});
  return options;
}

const KindOption& FindOption(KindEntry::Options options, std::string_view kind) {
  const auto& all = options();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const KindOption& o) { return o.name == kind; });
  Demand(found != all.end(), "a kind's name comes from its table");
  return *found;
}

}  // namespace

const std::vector<KindOption>& SensorOptions() {
  static const std::vector<KindOption> options = MakeSensorOptions();
  return options;
}
const std::vector<KindOption>& MotionOptions() {
  static const std::vector<KindOption> options = MakeOptions(sim::MotionKinds());
  return options;
}
const std::vector<KindOption>& LeakSoundOptions() {
  static const std::vector<KindOption> options = MakeOptions(acoustics::LeakSoundKinds());
  return options;
}
const std::vector<KindOption>& SoundOptions() {
  static const std::vector<KindOption> options = MakeOptions(acoustics::SoundKinds());
  return options;
}
const std::vector<KindOption>& WallFeatureOptions() {
  static const std::vector<KindOption> options = MakeOptions(sim::WallFeatureKinds());
  return options;
}
const std::vector<KindOption>& FilterOptions() {
  static const std::vector<KindOption> options = MakeOptions(estimator::FilterKinds());
  return options;
}

KindEntry::KindEntry(Options options, std::string_view kind)
    : options_(options), kind_(kind), params_(FindOption(options, kind).make_params()) {}

KindEntry::KindEntry(const KindEntry& other)
    : options_(other.options_), kind_(other.kind_), params_(other.params_->Clone()) {}

KindEntry& KindEntry::operator=(const KindEntry& other) {
  *this = KindEntry(other);
  return *this;
}

std::string_view KindEntry::records() const { return FindOption(options_, kind_).records; }

void KindEntry::Visit(ParamVisitor& v) {
  VisitKind(v);
  VisitParams(v);
}

void KindEntry::VisitKind(ParamVisitor& v) {
  std::vector<std::string_view> names;
  for (const KindOption& option : options_()) names.push_back(option.name);
  const std::string before = kind_;
  v.Choice({.name = "kind", .doc = "Which kind this is; the other keys depend on it.", .required = true},
           names, kind_);
  if (kind_ != before) params_ = FindOption(options_, kind_).make_params();
}

}  // namespace piperun::scenarios
