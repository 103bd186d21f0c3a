#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/params.h"
#include "base/random.h"
#include "base/time.h"

namespace piperun::acoustics {

/// From this time of the record on, the amplifier has this gain over the one that sensor.yaml tells.
struct GainStep {
  double t_s = 0;
  double gain_dB = 0;
  void Visit(ParamVisitor& v);
};

/// No sample is recorded from begin to end; zeros stand there.
struct DropOut {
  double begin_s = 0;
  double end_s = 0;
  void Visit(ParamVisitor& v);
};

/// What goes wrong between a hydrophone's amplifier and its record. Nothing by default. Only the scenario
/// tells of gain steps, as the truth: sensor.yaml keeps the nominal scale, and who reads the record has to
/// notice, as with an amplifier that steps by itself. Dropped samples are counted in sensor.yaml.
struct RecordFaultParams {
  std::vector<GainStep> gain_steps;
  std::vector<DropOut> drop_outs;
  double drop_outs_1_h = 0;  ///< at times drawn by seed and run
  double drop_out_s = 0.05;  ///< length of those

  void Visit(ParamVisitor& v);
  /// Throws InputError unless times increase and spans end after they begin.
  void Check() const;
};

/// Applies them, block by block. Random drop-outs: each second of the record begins one with probability
/// rate / 3600, at a uniform time within it. They are keyed by the second: of the stream, slot kSlot.
class RecordFaults {
 public:
  static constexpr std::uint64_t kSlot = std::uint64_t{1} << 40;

  /// Throws as RecordFaultParams::Check does.
  RecordFaults(const RecordFaultParams& params, Rate rate, const RandomStream& random);

  /// Before the converter: multiplies the next samples by the gain of their time.
  void Amplify(std::span<float> pressure_Pa) const;
  /// Behind it: zeroes what is lost of the same samples and goes on to the next ones.
  void Drop(std::span<std::int32_t> counts);
  std::int64_t dropped_samples() const { return dropped_samples_; }

 private:
  struct Span {
    std::int64_t begin = 0;  // samples
    std::int64_t end = 0;
  };
  struct Gain {
    std::int64_t begin = 0;
    float factor = 1;
  };

  std::int64_t SampleAt(double t_s) const;
  Span DrawDropOut(std::int64_t second) const;
  bool IsDropped(std::int64_t sample);

  std::int64_t rate_Hz_;  // whole hertz, as HydrophoneParams::Check has it
  RandomStream random_;
  std::vector<Gain> gains_;
  std::vector<Span> drops_;
  double drop_outs_per_s_;
  double drop_out_s_;
  Span drawn_, drawn_before_;  // those that begin in this second and in the one before
  std::int64_t next_sample_ = 0;
  std::int64_t dropped_samples_ = 0;
};

}  // namespace piperun::acoustics
