#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "estimator/allan_fit.h"
#include "scenarios/rest_check.h"
#include "scenarios/static_record.h"

namespace piperun::scenarios {

struct AllanOptions {
  estimator::AllanFitOptions fit;
  estimator::AllanGrid grid;
  int jobs = 0;  ///< threads for the fits; 0: all cores
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double fraction)> progress;  ///< of the reading
};

struct AllanChannel {
  std::string group, axis;
  std::string unit;  ///< SI
  std::vector<estimator::AllanPoint> points;
  std::vector<estimator::SegmentGroup> segments;
  estimator::AllanFit fit;
  double mean = 0;
  std::vector<std::string> unrest;  ///< what speaks against a sensor at rest
};

struct AllanAnalysis {
  std::string file;
  RecordTiming timing;
  std::vector<AllanChannel> channels;
  double confidence = 0.95;
  std::vector<std::string>
      notes;  ///< gaps, rows left out, misfits: whatever a reader of the figures must know

  bool at_rest() const;
};

/// Reads the record to its end and analyses every channel. Memory is bounded (estimator/allan.h: 10.5 MB per
/// channel). Throws InputError for fewer than 100 samples and whatever the reader and the fit throw;
/// Interrupted when `stop` is set.
AllanAnalysis AnalyseStaticRecord(StaticRecord& record, const std::string& file, const AllanOptions& options);

/// A term's unit in SI, of a channel measured in `unit`: Q in `unit` times s, N per sqrt(Hz) ...
std::string NoiseTermUnit(estimator::NoiseTerm term, const std::string& unit);
/// "Q quantisation", "N angle random walk" ...
std::string NoiseTermName(estimator::NoiseTerm term, const std::string& group);

/// Root mean square over a group's axes of those whose term is identifiable; nothing when none is.
std::optional<double> CombineAxes(const AllanAnalysis& analysis, const std::string& group,
                                  estimator::NoiseTerm term);
/// The largest upper end of the axes' intervals.
double BoundAxes(const AllanAnalysis& analysis, const std::string& group, estimator::NoiseTerm term);

}  // namespace piperun::scenarios
