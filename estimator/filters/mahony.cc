#include "estimator/mahony.h"

#include "estimator/complementary_kind.h"

namespace piperun::estimator::filters::mahony {

FilterKind Kind() {
  return MakeComplementaryKind<Mahony, MahonyParams>(
      "mahony", "Explicit complementary filter (Mahony), fixed gains; position by rolling or between rests.");
}

}  // namespace piperun::estimator::filters::mahony
