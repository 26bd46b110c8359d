// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/pass_film.h"
#include "common/film/splat_film.h"
#include "common/guiding/any_guide.h"
#include "common/guiding/statistics/cell_sums.h"
#include "common/protocol/messages.h"
#include "coordinator/ledger.h"
#include "coordinator/partial_pass.h"

namespace treefarm {

/// One worker's contribution to a pass.
struct WorkerContribution {
    TraceStats stats;
    std::uint64_t work = 0;  ///< sum of the weights of the units accepted
};

/// Gathers the results of one pass: the layers of its film, tree sums and figures, each unit exactly once.
class Collector {
  public:
    /// `signed_pixels`: of a filter with negative lobes, so that means may be negative.
    Collector(const PassPlan& plan, const AnyModel& model, int width, int height, bool signed_pixels,
              const AovLayout& aovs = {});

    /// Merges a worker's result if the ledger accepts it; otherwise nothing changes here, and what it has of a late one
    /// the ledger drops. Throws FormatError if the content does not fit the pass (nothing was accepted then).
    Verdict take(int worker, Result result, Ledger& ledger);

    /// Sets what has come in so far, in a copy of its own: the pass, what is done, layers, sums and figures.
    void fill(PartialPass& partial) const;
    /// Takes what fill() gave, before anything else. Throws FormatError where it is of another pass or image, and is
    /// then of no use any more.
    void restore(const PartialPass& partial);

    /// Pixels for a look at the pass while it goes on; none where they are but a layer of it.
    std::span<const PixelEstimate> pixels_so_far() const;
    std::vector<PixelEstimate> take_pixels();  ///< once, of a complete pass: all layers together
    const SplatSums& splats() const { return splats_; }
    AovPixels take_aovs() { return aovs_.take(); }  ///< as take_pixels()
    const CellSums& sums() const { return sums_; }
    TraceStats totals() const;
    const std::map<int, WorkerContribution>& contributions() const { return contributions_; }
    std::uint64_t update_bytes() const { return update_bytes_; }
    std::uint64_t splat_bytes() const { return splat_bytes_; }
    std::uint64_t touched_cells() const { return touched_cells_; }
    double merge_seconds() const { return merge_seconds_; }  ///< adding tree updates
    double film_seconds() const { return film_seconds_; }    ///< adding pixels

  private:
    // Throw FormatError where a result cannot be: what is merged cannot be taken out again.
    void check_pixels(const UnitResult& result) const;
    void check_stats(const Result& result) const;
    void check_tails(const TailSamples& tails) const;
    void check_splats(const Result& result) const;
    std::uint32_t unit_samples(const WorkUnit& unit) const;  ///< of a pixel in a tile

    PassPlan plan_;
    int width_, height_;
    bool signed_pixels_;
    DoneWork done_;
    TraceStats earlier_;  ///< of earlier lives of the render
    PassFilm film_;
    AovFilm aovs_;
    SplatSums splats_;
    CellSums sums_;
    std::map<int, WorkerContribution> contributions_;
    std::uint64_t update_bytes_ = 0;   ///< of all encoded tree updates
    std::uint64_t splat_bytes_ = 0;    ///< of all encoded splats
    std::uint64_t touched_cells_ = 0;  ///< of all of them, a cell once per update that touches it
    double merge_seconds_ = 0, film_seconds_ = 0;
};

}  // namespace treefarm
