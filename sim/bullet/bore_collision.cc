#include "sim/bullet/bore_collision.h"

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <new>

#include "sim/bullet/convert.h"

namespace piperun::sim::bullet {
namespace {

constexpr btScalar kEverywhere_m = 1e6;
constexpr btScalar kMaxPush_m_s = 1;

/// The contact points, made anew every step from the predicted gaps.
class SphereBoreAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  SphereBoreAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                      const btCollisionObjectWrapper* sphere, const btCollisionObjectWrapper* bore)
      : btActivatingCollisionAlgorithm(info, sphere, bore),
        sphere_(*btRigidBody::upcast(sphere->getCollisionObject())),
        bore_(*bore->getCollisionObject()),
        manifold_(m_dispatcher->getNewManifold(&sphere_, &bore_)) {}
  ~SphereBoreAlgorithm() override { m_dispatcher->releaseManifold(manifold_); }
  SphereBoreAlgorithm(const SphereBoreAlgorithm&) = delete;
  SphereBoreAlgorithm& operator=(const SphereBoreAlgorithm&) = delete;

  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                        const btDispatcherInfo& info, btManifoldResult*) override {
    manifold_->clearManifold();
    const auto& shape = static_cast<const BoreShape&>(*bore_.getCollisionShape());
    for (const WallContact& contact : shape.contacts())
      AddPoint(contact, shape.compliance(), info.m_timeStep);
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override { manifolds.push_back(manifold_); }

 private:
  /// A rigid overlap is undone at no more than kMaxPush_m_s; along a wall there is none.
  void AddPoint(const WallContact& contact, const std::optional<ContactCompliance>& compliance, btScalar dt) {
    const btScalar distance = compliance ? contact.gap_m : btMax(contact.gap_m, -kMaxPush_m_s * dt);
    const btScalar radius = static_cast<const btSphereShape&>(*sphere_.getCollisionShape()).getRadius();
    const btVector3 normal = ToBullet(contact.normal_F);
    const btVector3 on_sphere = sphere_.getWorldTransform().getOrigin() - normal * radius;
    const btVector3 on_wall = on_sphere - normal * distance;
    btManifoldPoint point(sphere_.getWorldTransform().invXform(on_sphere), on_wall, normal, distance);
    point.m_positionWorldOnA = on_sphere;
    point.m_positionWorldOnB = on_wall;
    point.m_combinedFriction = sphere_.getFriction();
    point.m_combinedRestitution = 0;  // in water, impacts at these speeds are inelastic
    if (compliance) {
      point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
      point.m_combinedContactStiffness1 = compliance->stiffness_N_m;
      point.m_combinedContactDamping1 = compliance->damping_N_s_m;
    }
    manifold_->addManifoldPoint(point);
  }

  const btRigidBody& sphere_;
  const btCollisionObject& bore_;
  btPersistentManifold* manifold_;
};

}  // namespace

void BoreShape::getAabb(const btTransform&, btVector3& min, btVector3& max) const {
  max.setValue(kEverywhere_m, kEverywhere_m, kEverywhere_m);
  min = -max;
}

btCollisionAlgorithm* BoreCollision::Factory::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  void* place = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(SphereBoreAlgorithm));
  return m_swapped ? new (place) SphereBoreAlgorithm(info, b, a)
                   : new (place) SphereBoreAlgorithm(info, a, b);
}

BoreCollision::BoreCollision(btCollisionDispatcher& dispatcher) {
  dispatcher.registerCollisionCreateFunc(SPHERE_SHAPE_PROXYTYPE, CUSTOM_CONCAVE_SHAPE_TYPE, &sphere_bore_);
  dispatcher.registerCollisionCreateFunc(CUSTOM_CONCAVE_SHAPE_TYPE, SPHERE_SHAPE_PROXYTYPE, &bore_sphere_);
}

}  // namespace piperun::sim::bullet
