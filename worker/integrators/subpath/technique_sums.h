// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"

namespace treefarm {

/// How techniques that could have drawn the same path are weighed by their densities: m(p) over the sum of all m, with
/// m(p) = p (balance) or p^2 (power; Veach 1997). In double, and bounded, so that sums and products of what few paths
/// bring are numbers.
class Heuristic {
  public:
    explicit Heuristic(MisHeuristic mis) : squares_(mis == MisHeuristic::power) {}

    /// m of a density, or of a quotient of densities; at most kMost.
    double operator()(double pdf) const {
        if (!squares_) return bounded(pdf);
        const double root = pdf < kRoot ? pdf : kRoot;
        return root * root;
    }

    static constexpr double kMost = 1e150, kRoot = 1e75;
    static double bounded(double m) { return m < kMost ? m : kMost; }

  private:
    bool squares_;
};

/// An edge of a subpath as it was drawn, from the vertex before to this one.
struct DrawnEdge {
    double pdf = 0;      ///< density of this vertex, per area; per steradian where it is at infinity
    double back = 0;     ///< turns a density per steradian at this vertex into one per area at the vertex before
    double reverse = 0;  ///< with which the other walk at the vertex before, come from here, draws the one before that
    bool delta = false;  ///< the vertex before scattered by a delta lobe: pdf and reverse leave out its probability,
                         ///< which is the same from both sides
};

/// What the last vertex of a subpath has to know of all techniques that draw the same path with a shorter subpath at
/// this end and a longer one at the other: sums of m(their density over the subpath's own), without what the other end
/// brings (after Georgiev 2012, "Implementing Vertex Connection and Merging", where they are dVCM and dVC;
/// docs/design/transport.md). Where a technique does not exist, as beside a delta lobe, its part is 0.
struct TechniqueSums {
    double join = 0;    ///< the technique that connects this vertex to the one before
    double beyond = 0;  ///< all that draw the vertex before from here, too

    /// The sums at the end of an edge, from those at its beginning.
    TechniqueSums after(const DrawnEdge& edge, const Heuristic& m) const {
        if (edge.delta) return {0.0, Heuristic::bounded(m(edge.back * edge.reverse / edge.pdf) * beyond)};
        const double before = Heuristic::bounded(join + Heuristic::bounded(m(edge.reverse) * beyond));
        return {m(1.0 / edge.pdf), Heuristic::bounded(m(edge.back / edge.pdf) * before)};
    }

    /// The sum of m over all of them. `reach`: density with which the other walk draws this vertex; `both`: that, times
    /// the one with which it then draws the vertex before, per steradian.
    double sum(double reach, double both, const Heuristic& m) const {
        return Heuristic::bounded(m(reach) * join) + Heuristic::bounded(m(both) * beyond);
    }
};

/// Weight of a technique: 1 over its own and all others' m, which `others` holds over its own.
inline double technique_weight(double others) {
    return 1.0 / (1.0 + others);
}

}  // namespace treefarm
