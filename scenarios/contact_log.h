#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/network.h"
#include "scenarios/output_file.h"
#include "sim/motion.h"

namespace piperun::scenarios {

/// What run.json says of the collisions of a run.
struct ContactSummary {
  std::int64_t count = 0;
  double largest_impulse_N_s = 0;
};

/// Writes truth/contacts.csv: one row per collision, by their beginnings; those that begin at the same time
/// in the order in which they ended. Events are told when they end; rows wait for kContactEventDelay.
class ContactLog {
 public:
  /// Keeps a reference to the network. `feature_ids` are those of the wall features, by index.
  ContactLog(const std::filesystem::path& file, const Network& network, std::vector<std::string> feature_ids);

  void Add(const sim::ContactEvent& event);
  /// Writes what no later event can precede: all that began more than kContactEventDelay before `now`.
  void WriteUntil(TrueTime now);
  void Close();
  const ContactSummary& summary() const { return summary_; }

 private:
  std::string FeatureName(int feature) const;
  void Write(const sim::ContactEvent& event);

  OutputFile file_;
  const Network& network_;
  std::vector<std::string> feature_ids_;
  std::vector<sim::ContactEvent> waiting_;  // by their beginnings
  ContactSummary summary_;
};

}  // namespace piperun::scenarios
