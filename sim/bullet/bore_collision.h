#pragma once

#include <btBulletDynamicsCommon.h>

#include <optional>

#include "sim/ball_world.h"
#include "sim/bore_wall.h"

namespace piperun::sim::bullet {

/// A network's wall as a Bullet shape: the contacts of the coming step, worked out beforehand in Bullet's
/// frame.
class BoreShape : public btConcaveShape {
 public:
  /// Rigid without `compliance`.
  explicit BoreShape(const std::optional<ContactCompliance>& compliance) : compliance_(compliance) {
    m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE;
  }

  const std::optional<ContactCompliance>& compliance() const { return compliance_; }
  const WallContacts& contacts() const { return contacts_; }
  void set_contacts(const WallContacts& contacts) { contacts_ = contacts; }

  void getAabb(const btTransform& t, btVector3& min, btVector3& max) const override;
  void processAllTriangles(btTriangleCallback*, const btVector3&, const btVector3&) const override {}
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return scaling_; }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "bore"; }

 private:
  std::optional<ContactCompliance> compliance_;
  WallContacts contacts_;
  btVector3 scaling_{1, 1, 1};
};

/// Lets `dispatcher` find contacts between spheres and BoreShapes, whichever comes first in a pair.
class BoreCollision {
 public:
  explicit BoreCollision(btCollisionDispatcher& dispatcher);

 private:
  struct Factory : btCollisionAlgorithmCreateFunc {
    explicit Factory(bool swapped) { m_swapped = swapped; }
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  Factory sphere_bore_{false};
  Factory bore_sphere_{true};
};

}  // namespace piperun::sim::bullet
