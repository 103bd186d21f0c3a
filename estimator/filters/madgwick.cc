#include "estimator/madgwick.h"

#include "estimator/complementary_kind.h"

namespace piperun::estimator::filters::madgwick {

FilterKind Kind() {
  return MakeComplementaryKind<Madgwick, MadgwickParams>(
      "madgwick", "Gradient descent (Madgwick), fixed gain; position by rolling or between rests.");
}

}  // namespace piperun::estimator::filters::madgwick
