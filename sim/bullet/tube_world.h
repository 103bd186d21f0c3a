#pragma once

#include <btBulletDynamicsCommon.h>

#include "sim/bullet/contact_solver.h"

namespace piperun::sim::bullet {

/// Something that does not move and has no shape that Bullet would know.
class StaticWall : public btCollisionObject {
 public:
  StaticWall() {
    setCollisionShape(&shape_);
    setCollisionFlags(CF_STATIC_OBJECT);
  }

 private:
  btEmptyShape shape_;
};

/// A btDiscreteDynamicsWorld of one body and one wall.
///
/// The contacts of a step come from outside, and nothing else ever touches; so a step is Bullet's without its
/// search for pairs, islands and bounding boxes: contacts, solver, p += v dt. The body's attitude stays what
/// it was set to. Same bits as the general step at a fraction of its cost.
class TubeWorld : public btDiscreteDynamicsWorld {
 public:
  /// A contact of the body with the wall for the coming step.
  struct Contact {
    btVector3 normal{0, 0, 0};   ///< unit, from the wall to the body
    btVector3 lever{0, 0, 0};    ///< from the body's centre of mass to the contact
    btScalar distance = 0;       ///< what the contact closes over the step
    btScalar firmness = kRigid;  ///< force over the speed by which it falls short of that
  };
  static constexpr btScalar kRigid = SIMD_INFINITY;
  static constexpr int kMaxContacts = MANIFOLD_CACHE_SIZE;

  /// Keeps references.
  TubeWorld(btDispatcher& dispatcher, btBroadphaseInterface& broadphase, ContactSolver& solver,
            btCollisionConfiguration& configuration, btRigidBody& body, btCollisionObject& wall);
  ~TubeWorld() override;
  TubeWorld(const TubeWorld&) = delete;
  TubeWorld& operator=(const TubeWorld&) = delete;

  /// Holds for all contacts to come.
  void SetFriction(btScalar friction);

  void ClearContacts() { manifold_.setNumContacts(0); }
  /// At most kMaxContacts.
  void AddContact(const Contact& contact);
  int contact_count() const { return manifold_.getNumContacts(); }
  btScalar NormalImpulse(int contact) const { return manifold_.getContactPoint(contact).m_appliedImpulse; }
  /// Of the wall on the body in the last step, friction included.
  btVector3 Impulse(int contact) const;

  /// One step of symplectic Euler over `dt`, without substeps.
  int stepSimulation(btScalar dt, int = 0, btScalar = 0) override;

 protected:
  void internalSingleStepSimulation(btScalar dt) override;

 private:
  btRigidBody& body_;
  btCollisionObject& wall_;
  btPersistentManifold manifold_;
};

}  // namespace piperun::sim::bullet
