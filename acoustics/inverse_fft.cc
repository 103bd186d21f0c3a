#include "acoustics/inverse_fft.h"

#include <kiss_fftr.h>

#include <type_traits>

#include "base/check.h"

namespace piperun::acoustics {

static_assert(std::is_same_v<kiss_fft_scalar, float>, "link the single-precision kissfft");
static_assert(sizeof(kiss_fft_cpx) == sizeof(std::complex<float>));

struct InverseRealFft::Plan {
  explicit Plan(std::size_t size) : config(kiss_fftr_alloc(static_cast<int>(size), 1, nullptr, nullptr)) {
    Demand(config != nullptr, "kissfft has a plan for every even size");
  }
  ~Plan() { kiss_fftr_free(config); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  kiss_fftr_cfg config;
};

InverseRealFft::InverseRealFft(std::size_t size) : size_(size), plan_(std::make_unique<Plan>(size)) {
  Demand(size >= 2 && size % 2 == 0, "a real transform has an even size");
}
InverseRealFft::~InverseRealFft() = default;
InverseRealFft::InverseRealFft(InverseRealFft&&) noexcept = default;

void InverseRealFft::Transform(std::span<const std::complex<float>> spectrum, std::span<float> signal) {
  Demand(spectrum.size() == size_ / 2 + 1 && signal.size() == size_, "sizes match the transform");
  kiss_fftri(plan_->config, reinterpret_cast<const kiss_fft_cpx*>(spectrum.data()), signal.data());
}

}  // namespace piperun::acoustics
