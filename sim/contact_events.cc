#include "sim/contact_events.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kSameNormal = 0.7071067811865476;  // cos 45 degrees
constexpr Duration kChatter = std::chrono::milliseconds(5);
constexpr double kRestingFactor = 2;  // on what carries the ball, which is known as a bound only
constexpr double kLeastPathRadius_m = 1e-3;

}  // namespace

double CalcCarriedForce_N(double load_N, double mass_kg, const CentrelinePoint& axis, const Vector3d& p_LB,
                          const Vector3d& v_WB_W) {
  const double along_m_s = v_WB_W.dot(axis.tangent_W);
  const Vector3d across = v_WB_W - along_m_s * axis.tangent_W;
  const Vector3d offset = p_LB - axis.p_W;
  const double offset_m = std::max(offset.norm(), kLeastPathRadius_m);
  const double outward_m_s = across.dot(offset) / offset_m;
  const double around_m2_s2 = std::max(0.0, across.squaredNorm() - outward_m_s * outward_m_s);
  return load_N + mass_kg * (along_m_s * along_m_s * axis.curvature_W.norm() + around_m2_s2 / offset_m);
}

double ContactEventDetector::CalcStrikeSpeed_m_s(double carried_force_N, double dt_s) const {
  return least_speed_m_s_ + kRestingFactor * carried_force_N * dt_s / mass_kg_;
}

bool ContactEventDetector::Strikes(const StepContact& contact, const ContactStep& step) const {
  return contact.closing_speed_m_s > CalcStrikeSpeed_m_s(step.carried_force_N, step.dt_s);
}

bool ContactEventDetector::Presses(const StepContact& contact, const ContactStep& step) const {
  const double least_N = mass_kg_ * least_speed_m_s_ / Seconds(kContactEventDelay);
  const double force_N = contact.impulse_W_N_s.dot(contact.normal_W) / step.dt_s;
  return force_N > kRestingFactor * step.carried_force_N + least_N;
}

std::span<const ContactEvent> ContactEventDetector::Step(const ContactStep& step,
                                                         const StepContacts& contacts) {
  ended_size_ = 0;
  for (const StepContact& contact : contacts) Take(contact, step);
  EndOverdue(step);
  return ended();
}

ContactEventDetector::OpenEvent* ContactEventDetector::Find(const StepContact& contact) {
  OpenEvent* best = nullptr;
  double best_cosine = kSameNormal;
  for (std::size_t i = 0; i < open_size_; ++i) {
    if (open_[i].event.feature != contact.feature) continue;
    const double cosine = open_[i].normal_W.dot(contact.normal_W);
    if (cosine < best_cosine) continue;
    best = &open_[i];
    best_cosine = cosine;
  }
  return best;
}

void ContactEventDetector::Take(const StepContact& contact, const ContactStep& step) {
  OpenEvent* open = Find(contact);
  if (open) open->most_carried_N = std::max(open->most_carried_N, step.carried_force_N);
  const bool strikes = Strikes(contact, step);
  if (open && (strikes || Presses(contact, step))) {
    Add(contact, step, *open);
  } else if (strikes) {
    Open(contact, step);
  }
}

void ContactEventDetector::Open(const StepContact& contact, const ContactStep& step) {
  if (open_size_ == kOpen) {
    const auto quietest = std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
      return a.last_strike < b.last_strike;
    });
    End(static_cast<std::size_t>(quietest - open_.begin()), step.dt_s);
  }
  OpenEvent& open = open_[open_size_++];
  open = {};
  open.event.begin = step.time;
  open.event.pipe = step.place.pipe;
  open.event.s_m = step.place.s_m;
  open.event.chainage_m = step.place.chainage_m;
  open.event.p_W = step.place.p_WB - radius_m_ * contact.normal_W;
  open.event.feature = contact.feature;
  open.most_carried_N = step.carried_force_N;
  Add(contact, step, open);
}

void ContactEventDetector::Add(const StepContact& contact, const ContactStep& step, OpenEvent& open) {
  ContactEvent& event = open.event;
  event.impulse_W_N_s += contact.impulse_W_N_s;
  event.closing_speed_m_s = std::max(event.closing_speed_m_s, contact.closing_speed_m_s);
  if (open.last_strike != step.time) open.step_impulse_W_N_s.setZero();
  open.step_impulse_W_N_s += contact.impulse_W_N_s;
  event.peak_force_N = std::max(event.peak_force_N, open.step_impulse_W_N_s.norm() / step.dt_s);
  event.duration_s = Seconds(step.time - event.begin + FromSeconds(step.dt_s));
  open.normal_W = contact.normal_W;
  open.last_strike = step.time;
}

void ContactEventDetector::EndOverdue(const ContactStep& step) {
  const Duration dt = FromSeconds(step.dt_s);
  const TrueTime next = step.time + dt;
  for (std::size_t i = 0; i < open_size_;) {
    const OpenEvent& open = open_[i];
    if (next - open.last_strike > std::max(kChatter, dt) || next - open.event.begin >= kContactEventDelay) {
      End(i, step.dt_s);
    } else {
      ++i;
    }
  }
}

/// What carries the ball may grow with the step that an event opened in, where a bend begins between two
/// steps: such an event was none.
void ContactEventDetector::End(std::size_t i, double dt_s) {
  const OpenEvent& open = open_[i];
  if (open.event.closing_speed_m_s > CalcStrikeSpeed_m_s(open.most_carried_N, dt_s)) {
    ended_[ended_size_++] = open.event;
  }
  std::move(open_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
            open_.begin() + static_cast<std::ptrdiff_t>(open_size_--),
            open_.begin() + static_cast<std::ptrdiff_t>(i));
}

}  // namespace piperun::sim
