#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "acoustics/hydrophone.h"

namespace piperun::scenarios::sound {

/// Mains of the parameter table in docs/acoustics.md, in water of 10 C.
acoustics::PipeWave MakePvcMain();   ///< PVC-U DN150
acoustics::PipeWave MakeIronMain();  ///< ductile iron DN150 K9

/// A sound with one spectral level of its volume velocity between two frequencies, and none outside.
std::shared_ptr<const acoustics::LeakSound> MakeBandSound(double psd_m6_s2_Hz, double f_low_Hz,
                                                          double f_high_Hz);
/// The turbulent jet with its default parameters.
std::shared_ptr<const acoustics::LeakSound> MakeJet(double flow_m3_s, double hole_diameter_m, double drop_Pa);

/// 400 m that go on at both ends, with no background.
acoustics::AcousticScene MakeQuietMain(const acoustics::PipeWave& wave);
void AddLeak(acoustics::AcousticScene& scene, const acoustics::PipePlace& place,
             std::shared_ptr<const acoustics::LeakSound> sound);

/// No self noise, no high pass.
acoustics::HydrophoneParams MakeIdealHydrophone();
/// At rest at a place of pipe 0, in water of 0.5 m/s that slips by at 0.05 m/s.
acoustics::Hydrophone::ListenerAt StandAt(double s_m);

/// `seconds` of pressure in pascals.
std::vector<float> Record(const acoustics::AcousticScene& scene, const acoustics::HydrophoneParams& params,
                          std::uint64_t seed, const acoustics::Hydrophone::ListenerAt& listener,
                          double seconds);

double CalcMeanSquare(std::span<const float> x);

}  // namespace piperun::scenarios::sound
