#pragma once

#include <filesystem>
#include <memory>

#include "base/measurement.h"
#include "scenarios/estimator_input.h"

namespace piperun::scenarios {

/// The measurements of a run folder, in the order in which they were delivered: by stamp, then channel name,
/// then row; what was read out after the run behind everything else. Streams; throws InputError with file and
/// row for a broken record.
class MeasurementLog {
 public:
  MeasurementLog(const std::filesystem::path& run_folder, const EstimatorInput& input);
  ~MeasurementLog();
  /// Next measurement, valid until the next call; null at the end.
  const Measurement* Next();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace piperun::scenarios
