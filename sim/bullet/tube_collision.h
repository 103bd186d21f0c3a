#pragma once

#include <btBulletDynamicsCommon.h>

#include "sim/tube_wall.h"

namespace piperun::sim::bullet {

/// The bore's wall as a Bullet shape. Bullet's world is the frame F of the piece named by `spot`.
class TubeShape : public btConcaveShape {
 public:
  explicit TubeShape(const TubeWall& wall) : wall_(wall) { m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE; }

  const TubeWall& wall() const { return wall_; }
  const RouteSpot& spot() const { return spot_; }
  void set_spot(const RouteSpot& spot) { spot_ = spot; }

  void getAabb(const btTransform& t, btVector3& min, btVector3& max) const override;
  void processAllTriangles(btTriangleCallback*, const btVector3&, const btVector3&) const override {}
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return scaling_; }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "tube"; }

 private:
  const TubeWall& wall_;
  RouteSpot spot_;
  btVector3 scaling_{1, 1, 1};
};

/// Lets `dispatcher` find contacts between spheres and TubeShapes, whichever comes first in a pair.
class TubeCollision {
 public:
  explicit TubeCollision(btCollisionDispatcher& dispatcher);

 private:
  struct Factory : btCollisionAlgorithmCreateFunc {
    explicit Factory(bool swapped) { m_swapped = swapped; }
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  Factory sphere_tube_{false};
  Factory tube_sphere_{true};
};

}  // namespace piperun::sim::bullet
