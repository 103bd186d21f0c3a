#include "sim/bullet/tube_collision.h"

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <new>

#include "sim/bullet/convert.h"

namespace piperun::sim::bullet {
namespace {

constexpr btScalar kEverywhere_m = 1e6;

/// One contact point, made anew every step from the predicted gap.
class SphereTubeAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  SphereTubeAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                      const btCollisionObjectWrapper* sphere, const btCollisionObjectWrapper* tube)
      : btActivatingCollisionAlgorithm(info, sphere, tube),
        sphere_(*btRigidBody::upcast(sphere->getCollisionObject())),
        tube_(*tube->getCollisionObject()),
        manifold_(m_dispatcher->getNewManifold(&sphere_, &tube_)) {}
  ~SphereTubeAlgorithm() override { m_dispatcher->releaseManifold(manifold_); }
  SphereTubeAlgorithm(const SphereTubeAlgorithm&) = delete;
  SphereTubeAlgorithm& operator=(const SphereTubeAlgorithm&) = delete;

  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                        const btDispatcherInfo& info, btManifoldResult*) override {
    manifold_->clearManifold();
    const auto& shape = static_cast<const TubeShape&>(*tube_.getCollisionShape());
    const btScalar radius = static_cast<const btSphereShape&>(*sphere_.getCollisionShape()).getRadius();
    const btVector3& p = sphere_.getWorldTransform().getOrigin();
    const WallContact contact = shape.wall().Probe(
        shape.spot(), FromBullet(p), FromBullet(sphere_.getLinearVelocity()), radius, info.m_timeStep);
    if (contact.near) AddPoint(p, ToBullet(contact.normal_F), radius, contact.gap_m);
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override { manifolds.push_back(manifold_); }

 private:
  void AddPoint(const btVector3& p, const btVector3& normal, btScalar radius, btScalar gap) {
    const btVector3 on_sphere = p - normal * radius;
    const btVector3 on_wall = on_sphere - normal * gap;
    btManifoldPoint point(sphere_.getWorldTransform().invXform(on_sphere), on_wall, normal, gap);
    point.m_positionWorldOnA = on_sphere;
    point.m_positionWorldOnB = on_wall;
    point.m_combinedFriction = sphere_.getFriction();
    point.m_combinedRestitution = 0;  // in water, impacts at these speeds are inelastic
    manifold_->addManifoldPoint(point);
  }

  const btRigidBody& sphere_;
  const btCollisionObject& tube_;
  btPersistentManifold* manifold_;
};

}  // namespace

void TubeShape::getAabb(const btTransform&, btVector3& min, btVector3& max) const {
  max.setValue(kEverywhere_m, kEverywhere_m, kEverywhere_m);
  min = -max;
}

btCollisionAlgorithm* TubeCollision::Factory::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  void* place = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(SphereTubeAlgorithm));
  return m_swapped ? new (place) SphereTubeAlgorithm(info, b, a)
                   : new (place) SphereTubeAlgorithm(info, a, b);
}

TubeCollision::TubeCollision(btCollisionDispatcher& dispatcher) {
  dispatcher.registerCollisionCreateFunc(SPHERE_SHAPE_PROXYTYPE, CUSTOM_CONCAVE_SHAPE_TYPE, &sphere_tube_);
  dispatcher.registerCollisionCreateFunc(CUSTOM_CONCAVE_SHAPE_TYPE, SPHERE_SHAPE_PROXYTYPE, &tube_sphere_);
}

}  // namespace piperun::sim::bullet
