#include "sim/route_spot.h"

namespace piperun::sim {

RouteSpot FindRouteSpot(const Route& route, const Vector3d& p_W, std::size_t hint) {
  const std::vector<RoutePiece>& pieces = route.pieces();
  std::size_t i = hint;
  double s = FindNearest(pieces[i].line, p_W);
  // one way only: at a joint, rounding may let each of two neighbours point at the other
  if (s >= pieces[i].line.s_end_m()) {
    while (i + 1 < pieces.size() && s >= pieces[i].line.s_end_m()) s = FindNearest(pieces[++i].line, p_W);
  } else {
    while (i > 0 && s < pieces[i].line.s_begin_m) s = FindNearest(pieces[--i].line, p_W);
  }
  return {i, s, EvalCentreline(pieces[i].line, s)};
}

}  // namespace piperun::sim
