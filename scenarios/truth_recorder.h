#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "scenarios/assemble.h"
#include "scenarios/contact_log.h"
#include "scenarios/output_file.h"
#include "scenarios/passage_log.h"
#include "scenarios/score.h"
#include "scenarios/stem_snr.h"
#include "sim/truth.h"

namespace piperun::scenarios {

/// Writes truth/ball.csv, truth/contacts.csv and EuRoC's state_groundtruth_estimate0, and what the ball
/// passed.
class TruthRecorder {
 public:
  TruthRecorder(const Assembly& assembly, Rate truth_rate, const std::filesystem::path& truth_folder,
                const std::filesystem::path& groundtruth_folder);

  /// Call after every push into the window.
  void Watch(const sim::TruthWindow& window);
  /// Writes the rows up to `horizon`. Call when the inertial sensor has been sampled up to there: the biases
  /// in a row are those of its last sample.
  void WriteUntil(TrueTime horizon, const sim::TruthWindow& window);
  void Record(const sim::ContactEvent& event) { contacts_->Add(event); }
  /// Of the rows written so far; nothing: no pipes.
  std::optional<ContactSummary> contacts() const;
  /// Completes the files, writes leaks.csv, labels.csv (and features.csv, where there are any) and returns
  /// what leaks.csv says. `stems`: those that are kept, measured for labels.csv; null: none are.
  std::vector<TrueLeak> Close(const StemSnr* stems);

 private:
  void WriteRow(const sim::TruthState& state);

  struct Place {
    std::optional<double> chainage_m;
    Vector3d p_W;
  };
  Place FindPlace(int pipe, double s_m) const;
  void WriteFeatures() const;

  const Assembly& assembly_;
  Rate truth_rate_;
  std::filesystem::path truth_folder_;
  OutputFile ball_;
  OutputFile groundtruth_;
  std::optional<ContactLog> contacts_;  ///< when there are pipes
  std::int64_t next_row_ = 0;
  PassageLog passages_;
};

}  // namespace piperun::scenarios
