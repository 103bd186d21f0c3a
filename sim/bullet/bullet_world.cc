#include "sim/bullet/bullet_world.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sim/bullet/convert.h"
#include "sim/impact.h"

namespace piperun::sim::bullet {
namespace {

constexpr double kMaxPush_m_s = 1;  // at which a rigid overlap is undone; along a wall there is none

/// Bullet's headers follow BT_USE_DOUBLE_PRECISION, its libraries do not: the float ones link and start
/// without an error. A function that lives in the library tells them apart.
void RequireDoublePrecision() {
  const btSphereShape sphere(0.03);
  btVector3 inertia(0, 0, 0);
  sphere.calculateLocalInertia(2.0, inertia);
  Demand(sizeof(btScalar) == 8 && std::abs(inertia.z() - 0.4 * 2.0 * 0.03 * 0.03) < 1e-15,
         "piperun is linked with Bullet in single precision; link bullet-float64");
}

/// The first thing that is asked of Bullet.
btDefaultCollisionConstructionInfo MakeConfiguration() {
  RequireDoublePrecision();
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 4;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 4;
  return info;
}

btRigidBody::btRigidBodyConstructionInfo BodyInfo(const TubeBall& ball, btSphereShape& shape) {
  return {ball.mass_kg, nullptr, &shape, ToBullet(ball.inertia_B_kg_m2.moments_kg_m2())};
}

/// Of a ball whose attitude acts on its motion.
std::optional<Tumbling> MakeTumbling(const TubeBall& ball, const BallStart& start) {
  if (ball.inertia_B_kg_m2.isotropic() && ball.p_BM_B.isZero(0)) return std::nullopt;
  return Tumbling(ball.inertia_B_kg_m2, start.X_LB.q, start.w_WB_W);
}

bool IsImpact(const StepContact& contact) { return contact.closing_speed_m_s > 0; }

}  // namespace

BulletWorld::BulletWorld(const Bore& bore, const TubeBall& ball, const BallStart& start)
    : wall_(bore),
      spot_(start.spot),
      data_(ball),
      impact_rad_s_(ball.compliance ? std::sqrt(ball.compliance->stiffness_N_m / ball.mass_kg) : 0),
      tumbling_(MakeTumbling(ball, start)),
      p_F_(wall_.X_FL(spot_) * start.X_LB.p),
      v_step_F_(wall_.X_FL(spot_).q * start.v_WB_W),
      q_LB_(start.X_LB.q),
      configuration_(MakeConfiguration()),
      dispatcher_(&configuration_),
      broadphase_(4),
      sphere_shape_(ball.radius_m),
      body_(BodyInfo(ball, sphere_shape_)),
      solver_(ball.radius_m, ball.rolling_length_m, ball.spinning_length_m),
      world_(dispatcher_, broadphase_, solver_, configuration_, body_, bore_) {
  world_.SetFriction(ball.friction);
  body_.setFlags(0);  // gyroscopic torque is ours
  const Quaterniond& q_FL = wall_.X_FL(spot_).q;
  const Vector3d v_WM_W = start.v_WB_W + start.w_WB_W.cross(q_LB_ * ball.p_BM_B);
  body_.setWorldTransform(btTransform(btQuaternion::getIdentity(), ToBullet(p_F_)));
  body_.setLinearVelocity(ToBullet(q_FL * v_WM_W));
  body_.setAngularVelocity(ToBullet(q_FL * start.w_WB_W));
}

void BulletWorld::MoveTo(const SpotMove& move) {
  const Pose &X_LF = wall_.X_LF(spot_), &X_GL = wall_.X_FL(move.spot);
  const bool same_frame = move.spot.pipe == spot_.pipe && move.spot.piece == spot_.piece;
  spot_ = move.spot;
  if (same_frame) return;
  const Vector3d shift_L = move.crossing ? move.crossing->shift_L : Vector3d::Zero();
  const auto turn = [&](const Vector3d& x_F) { return Vector3d(X_GL.q * (X_LF.q * x_F)); };
  p_F_ = X_GL * (X_LF * p_F_ + shift_L);
  v_step_F_ = turn(v_step_F_);
  body_.getWorldTransform().setOrigin(ToBullet(p_F_));
  body_.setLinearVelocity(ToBullet(turn(FromBullet(body_.getLinearVelocity()))));
  body_.setAngularVelocity(ToBullet(turn(FromBullet(body_.getAngularVelocity()))));
}

void BulletWorld::Step(const BallLoad& load, double kick_s, double dt_s) {
  const StepPlan plan = Kick(load, kick_s, dt_s);
  const WallContacts contacts = wall_.Probe(spot_, p_F_, plan.v_step_F, data_.radius_m, dt_s);
  rescues_ += contacts.rescue ? 1 : 0;
  AddContacts(contacts, plan);
  world_.stepSimulation(dt_s);
  ReadContacts();
  Drift(plan);
}

/// Velocities are kicked here and not through forces: Bullet's friction does not see torques before the step
/// is over.
BulletWorld::StepPlan BulletWorld::Kick(const BallLoad& load, double kick_s, double dt_s) {
  const Quaterniond& q_FL = wall_.X_FL(spot_).q;
  const Vector3d dv_L = kick_s / data_.mass_kg * load.force_W_N;
  body_.setLinearVelocity(body_.getLinearVelocity() + ToBullet(q_FL * dv_L));
  StepPlan plan;
  plan.dt_s = dt_s;
  plan.v_step_F = FromBullet(body_.getLinearVelocity());
  if (tumbling_) {
    KickTumbling(load, kick_s, plan);
  } else {
    const Vector3d dw_L = kick_s / data_.inertia_B_kg_m2.moments_kg_m2().x() * load.torque_W_N_m;
    body_.setAngularVelocity(body_.getAngularVelocity() + ToBullet(q_FL * dw_L));
  }
  plan.acceleration_F = (plan.v_step_F - v_step_F_) / kick_s;
  return plan;
}

void BulletWorld::KickTumbling(const BallLoad& load, double kick_s, StepPlan& plan) {
  const Quaterniond& q_FL = wall_.X_FL(spot_).q;
  const Vector3d lever_L = q_LB_ * data_.p_BM_B;
  const Vector3d torque_L = load.torque_W_N_m - lever_L.cross(load.force_W_N);  // about M
  tumbling_->Kick(kick_s * torque_L, q_LB_, plan.dt_s);
  plan.w_kicked_F = q_FL * tumbling_->w_kicked_W();
  const Vector3d foreseen_F = q_FL * tumbling_->w_foreseen_W();
  plan.lever_F = q_FL * lever_L;
  plan.turning_F =
      foreseen_F.cross(plan.lever_F) - CalcTurnedBy(plan.dt_s * foreseen_F, plan.lever_F) / plan.dt_s;
  plan.v_step_F += plan.turning_F - plan.w_kicked_F.cross(plan.lever_F);
  const Matrix3d R_FI = q_FL.toRotationMatrix() * tumbling_->R_mid() * data_.inertia_B_kg_m2.R_BI();
  body_.getWorldTransform() = btTransform(MatrixToBullet(R_FI), ToBullet(p_F_ + plan.lever_F));
  body_.updateInertiaTensor();
  body_.setAngularVelocity(ToBullet(plan.w_kicked_F));
}

void BulletWorld::AddContacts(const WallContacts& contacts, const StepPlan& plan) {
  world_.ClearContacts();
  solver_.set_slip(ToBullet(Vector3d(-plan.turning_F)));
  for (const WallContact& contact : contacts) {
    const Vector3d& n = contact.normal_F;
    const WallApproach approach = MakeApproach(contact, plan);
    TubeWorld::Contact aim =
        data_.compliance ? AimSoftly(contact, plan.dt_s) : AimRigidly(contact, approach, plan.dt_s);
    if (aim.firmness == 0) continue;
    aim.normal = ToBullet(n);
    aim.lever = ToBullet(Vector3d(n * -data_.radius_m - plan.lever_F));
    aim.distance += n.dot(plan.turning_F) * plan.dt_s;
    const bool pressed = data_.compliance && CalcGapBefore_m(contact, plan.dt_s) <= 0;
    aimed_[static_cast<std::size_t>(world_.contact_count())] = {
        n, pressed ? 0 : CalcClosingSpeed_m_s(approach, plan.dt_s), contact.feature};
    world_.AddContact(aim);
  }
}

WallApproach BulletWorld::MakeApproach(const WallContact& contact, const StepPlan& plan) {
  const double dt = plan.dt_s, a_n = contact.normal_F.dot(plan.acceleration_F);
  return {contact.present_gap_m, contact.normal_F.dot(plan.v_step_F) - 0.5 * dt * a_n,
          a_n + 2 * (contact.gap_m - contact.present_gap_m) / (dt * dt)};
}

/// The gap, and more where the ball rebounds.
TubeWorld::Contact BulletWorld::AimRigidly(const WallContact& contact, const WallApproach& approach,
                                           double dt_s) const {
  const double rebound_m = CalcReboundGap_m(approach, data_.restitution, dt_s);
  return {.distance =
              rebound_m > 0 ? contact.gap_m - rebound_m : std::max(contact.gap_m, -kMaxPush_m_s * dt_s)};
}

/// Speed of the gap over the step before: a wall that curves towards the path closes it by as much more than
/// the normal velocity does as it will in the coming step.
double BulletWorld::CalcGapSpeedBefore_m_s(const WallContact& contact, double dt_s) const {
  return contact.normal_F.dot(v_step_F_) - (contact.gap_m - contact.present_gap_m) / dt_s;
}

double BulletWorld::CalcGapBefore_m(const WallContact& contact, double dt_s) const {
  return contact.present_gap_m - dt_s * CalcGapSpeedBefore_m_s(contact, dt_s);
}

TubeWorld::Contact BulletWorld::AimSoftly(const WallContact& contact, double dt_s) const {
  const SoftForce force = CalcSoftForce(
      *data_.compliance, {contact.present_gap_m, CalcGapSpeedBefore_m_s(contact, dt_s), impact_rad_s_}, dt_s);
  return {.distance = contact.gap_m - contact.present_gap_m - force.speed_m_s * dt_s,
          .firmness = force.firmness_N_s_m};
}

void BulletWorld::ReadContacts() {
  const Quaterniond& q_LF = wall_.X_LF(spot_).q;
  normal_impulse_N_s_ = 0;
  contacts_ = {};
  for (int i = 0; i < world_.contact_count(); ++i) {
    const double impulse_N_s = world_.NormalImpulse(i);
    normal_impulse_N_s_ += impulse_N_s;
    if (!(impulse_N_s > 0)) continue;
    const AimedContact& aimed = aimed_[static_cast<std::size_t>(i)];
    contacts_.Add({q_LF * aimed.normal_F, q_LF * FromBullet(world_.Impulse(i)), aimed.closing_speed_m_s,
                   aimed.feature});
  }
}

void BulletWorld::Drift(const StepPlan& plan) {
  const Pose& X_LF = wall_.X_LF(spot_);
  const Vector3d w_F = FromBullet(body_.getAngularVelocity());
  w_L_ = X_LF.q * w_F;
  dtheta_B_rad_ = q_LB_.conjugate() * w_L_ * plan.dt_s;
  v_step_F_ = FromBullet(body_.getLinearVelocity());
  if (tumbling_) {
    v_step_F_ -= CalcTurnedBy(plan.dt_s * w_F, plan.lever_F) / plan.dt_s;
    p_F_ += plan.dt_s * v_step_F_;
    tumbling_->Finish(X_LF.q * (w_F - plan.w_kicked_F),
                      std::none_of(contacts_.begin(), contacts_.end(), IsImpact));
  } else {
    p_F_ = FromBullet(body_.getWorldTransform().getOrigin());
  }
  q_LB_ = (q_LB_ * ExpSO3(dtheta_B_rad_)).normalized();
  p_L_ = X_LF * p_F_;
  v_step_L_ = X_LF.q * v_step_F_;
}

}  // namespace piperun::sim::bullet
