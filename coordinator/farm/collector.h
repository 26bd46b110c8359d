// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/pass_film.h"
#include "common/film/splat_film.h"
#include "common/guiding/any_guide.h"
#include "common/plan/schedule/learning.h"
#include "common/protocol/messages.h"
#include "coordinator/farm/ledger.h"
#include "coordinator/farm/partial_pass.h"

namespace treefarm {

/// One worker's contribution to a pass.
struct WorkerContribution {
    TraceStats stats;
    std::uint64_t work = 0;  ///< sum of the accepted units' weights
};

/// Collector of the results of one pass: the layers of its film, its evidence and figures, each unit exactly once.
class Collector {
  public:
    /// `signed_pixels`: the filter has negative lobes, so that means may be negative.
    Collector(const PassPlan& plan, const AnyModel& model, int width, int height, bool signed_pixels,
              const AovLayout& aovs = {});

    /// Merges a worker's result if the ledger accepts it. A late result changes nothing here, and the ledger drops its
    /// units. Throws FormatError if the content does not fit the pass, before anything is accepted.
    Verdict take(int worker, Result result, Ledger& ledger);

    /// Copies the results received so far: the pass, finished units, layers, sums and figures.
    void fill(PartialPass& partial) const;
    /// Restores the results that fill() copied, before anything else. Throws FormatError if they are of another pass or
    /// image; the collector is then unusable.
    void restore(const PartialPass& partial);

    /// Pixels of the incomplete pass, for a preview; empty if they are only one layer of it.
    std::span<const PixelEstimate> pixels_so_far() const;
    std::vector<PixelEstimate> take_pixels();  ///< once, of a complete pass: sum of all layers
    const SplatSums& splats() const { return splats_; }
    AovPixels take_aovs() { return aovs_.take(); }  ///< as take_pixels()
    const Evidence& evidence() const { return evidence_; }
    Blocks take_evidence(EvidenceOwner owner) { return evidence_.take(owner); }  ///< once, of a complete pass
    TraceStats totals() const;
    const std::map<int, WorkerContribution>& contributions() const { return contributions_; }
    std::uint64_t update_bytes() const { return update_bytes_; }
    std::uint64_t splat_bytes() const { return splat_bytes_; }
    std::uint64_t touched_cells() const { return touched_cells_; }
    double merge_seconds() const { return merge_seconds_; }  ///< seconds spent adding evidence
    double film_seconds() const { return film_seconds_; }    ///< seconds spent adding pixels

  private:
    // Throw FormatError for an impossible result, before the merge, which cannot be undone.
    void check_pixels(const UnitResult& result) const;
    void check_stats(const Result& result) const;
    void check_tails(const TailSamples& tails) const;
    void check_splats(const Result& result) const;
    std::uint32_t unit_samples(const WorkUnit& unit) const;  ///< samples of a pixel in a tile

    PassPlan plan_;
    int width_, height_;
    bool signed_pixels_;
    DoneWork done_;
    TraceStats earlier_;  ///< from before a resume
    PassFilm film_;
    AovFilm aovs_;
    SplatSums splats_;
    Evidence evidence_;
    std::map<int, WorkerContribution> contributions_;
    std::uint64_t update_bytes_ = 0;   ///< total of the encoded evidence
    std::uint64_t splat_bytes_ = 0;    ///< total of the encoded splats
    std::uint64_t touched_cells_ = 0;  ///< sum over the results of the entries in the guide's first block
    double merge_seconds_ = 0, film_seconds_ = 0;
};

}  // namespace treefarm
