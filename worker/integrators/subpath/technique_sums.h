// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/job.h"

namespace treefarm {

/// MIS heuristic for the techniques that could have drawn the same path: m(p) over the sum of all m, with m(p) = p
/// (balance) or p^2 (power; Veach 1997). In double and bounded, so that sums and products over rare paths stay finite.
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

/// An edge of a subpath as it was drawn, from the previous vertex to this one.
struct DrawnEdge {
    double pdf = 0;   ///< density of this vertex, per area; per steradian if it is at infinity
    double back = 0;  ///< factor from a density per steradian at this vertex to one per area at the previous vertex
    /// density of the other walk, arriving at the previous vertex from here, for the one before it
    double reverse = 0;
    bool delta = false;  ///< the vertex before scattered by a delta lobe: pdf and reverse leave out its probability,
                         ///< which is the same from both sides
};

/// Sums at the last vertex of a subpath over the techniques that draw the same path with a shorter subpath at this end:
/// m(density of the technique over the subpath's own), without the factors of the other end (after Georgiev 2012,
/// "Implementing Vertex Connection and Merging": dVCM and dVC; docs/design/transport.md). A technique that does not
/// exist, as beside a delta lobe, adds 0.
struct TechniqueSums {
    double join = 0;    ///< term of the technique that connects this vertex to the previous one
    double beyond = 0;  ///< sum over the techniques that also draw the previous vertex from here

    /// Sums at the end of an edge, from those at its beginning.
    TechniqueSums after(const DrawnEdge& edge, const Heuristic& m) const {
        if (edge.delta) return {0.0, Heuristic::bounded(m(edge.back * edge.reverse / edge.pdf) * beyond)};
        const double before = Heuristic::bounded(join + Heuristic::bounded(m(edge.reverse) * beyond));
        return {m(1.0 / edge.pdf), Heuristic::bounded(m(edge.back / edge.pdf) * before)};
    }

    /// Sum of m over these techniques. `reach`: density of the other walk for this vertex; `both`: `reach` times its
    /// density for the previous vertex, per steradian.
    double sum(double reach, double both, const Heuristic& m) const {
        return Heuristic::bounded(m(reach) * join) + Heuristic::bounded(m(both) * beyond);
    }
};

/// MIS weight of a technique; `others`: sum of the other techniques' m over its own.
inline double technique_weight(double others) {
    return 1.0 / (1.0 + others);
}

}  // namespace treefarm
