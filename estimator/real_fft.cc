#include "estimator/real_fft.h"

#include <kiss_fftr.h>

#include <type_traits>

#include "base/check.h"

namespace piperun::estimator {

static_assert(std::is_same_v<kiss_fft_scalar, float>, "link the single-precision kissfft");
static_assert(sizeof(kiss_fft_cpx) == sizeof(std::complex<float>));

struct RealFft::Plan {
  explicit Plan(std::size_t size)
      : forward(kiss_fftr_alloc(static_cast<int>(size), 0, nullptr, nullptr)),
        inverse(kiss_fftr_alloc(static_cast<int>(size), 1, nullptr, nullptr)) {
    Demand(forward != nullptr && inverse != nullptr, "kissfft has a plan for every even size");
  }
  ~Plan() {
    kiss_fftr_free(forward);
    kiss_fftr_free(inverse);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  kiss_fftr_cfg forward, inverse;
};

RealFft::RealFft(std::size_t size) : size_(size), plan_(std::make_unique<Plan>(size)) {
  Demand(size >= 2 && size % 2 == 0, "a real transform has an even size");
}
RealFft::~RealFft() = default;
RealFft::RealFft(RealFft&&) noexcept = default;

void RealFft::Forward(std::span<const float> signal, std::span<std::complex<float>> spectrum) {
  Demand(spectrum.size() == bins() && signal.size() == size_, "sizes match the transform");
  kiss_fftr(plan_->forward, signal.data(), reinterpret_cast<kiss_fft_cpx*>(spectrum.data()));
}

void RealFft::Inverse(std::span<const std::complex<float>> spectrum, std::span<float> signal) {
  Demand(spectrum.size() == bins() && signal.size() == size_, "sizes match the transform");
  kiss_fftri(plan_->inverse, reinterpret_cast<const kiss_fft_cpx*>(spectrum.data()), signal.data());
}

}  // namespace piperun::estimator
