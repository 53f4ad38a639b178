#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

struct btContactSolverInfo;

AMBIENT_BEGIN

/// Contact rows of one group in their pools.
struct ContactRows {
  btConstraintArray& contacts;
  const MultiBodyRows* multibodies;  ///< null: the solver knows none
  RowBodies& bodies;
  const btAlignedObjectArray<btSolverBody>& solver_bodies;
};

/// Contacts of a group whose bodies bounce in this step. Bullet asks for the speed of the bounce at
/// the end of the step; bodies in a fluid then have also moved all of the step by it, and would
/// gain the work of their weight on this way. So the speed is lessened by what the forces change in
/// the step, docs/theory.md eq. (28e). That takes an iteration without the bounces: find(), hold(),
/// iterations, release(). Without restitution each call costs a test per contact. Reuses its
/// memory.
class Bounces {
 public:
  /// Adds the bounces that touch an ambient body or a tree. Call before the rows are rewritten.
  void find(const ContactRows& rows, const btContactSolverInfo& info) noexcept;
  bool empty() const { return bounces_.empty(); }
  void clear() { bounces_.clear(); }
  /// Keeps these contacts from pushing. @pre the rows are rewritten
  void suspend(const ContactRows& rows) noexcept;
  /// Lets them push, and sets the velocities that they ask for by what the rows have changed since.
  void resume(const ContactRows& rows) noexcept;

 private:
  struct Bounce {
    bool is_of_links;     // in the pool of multibodies
    int row;              // index in its pool
    btScalar speed;       // restitution times that of the approach [m/s]
    btScalar asked;       // velocity that Bullet asks for [m/s]
    btScalar correction;  // part of it by penetration; < 0: by a gap [m/s]
    btScalar push, load;  // change by all forces outside the rows; by surface loads [m/s]
    btScalar right_side;  // of the row, while it is held
  };
  template <class Row>
  void findIn(const btAlignedObjectArray<Row>& pool, const ContactRows& rows,
              const btContactSolverInfo& info) noexcept;
  template <class Visit>
  void visit(const ContactRows& rows, const Visit& visit) noexcept;

  std::vector<Bounce> bounces_;
};

AMBIENT_END
