// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "common/guiding/statistics/record_log.h"
#include "common/guiding/statistics/settings.h"

namespace treefarm {

/// Settings of the quantity that records hold.
struct RecordRules {
    GuidingTarget target = GuidingTarget::radiance;
    ViewRecords view_records = ViewRecords::product;
    /// beta in [0, 1]: fraction of a record that is the learned value of the next vertex's region
    float bootstrap = 0.0f;

    /// Recorded quantity: L / p, or L^2 / p for the second moment.
    float target_value(float radiance, float pdf) const {
        return finite(target == GuidingTarget::variance ? radiance * (radiance / pdf) : radiance / pdf);
    }
    /// Value clamped to the largest float: the sums cap it, and count that.
    static float finite(float value) { return std::min(value, std::numeric_limits<float>::max()); }
};

/// Writes a record at `end`, and returns the new end; a record of 0 does not advance it. Without a branch, since it
/// would be unpredictable.
template <class R>
R* append_record(R record, R* end) {
    record.value = record.value > 0.0f ? record.value : 0.0f;  // also NaN
    record.reflected = record.reflected > 0.0f ? record.reflected : 0.0f;
    *end = record;
    return end + (std::max(record.value, record.reflected) > 0.0f);
}

}  // namespace treefarm
