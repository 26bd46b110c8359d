// SPDX-License-Identifier: Apache-2.0
// Linked into every test program of the preset `trap`.
#include <gtest/gtest.h>

#include <memory>

#include "common/base/float_traps.h"

namespace treefarm::test {
namespace {

/// Sets floating-point traps for all tests; with TREEFARM_FLUSH_DENORMALS set, denormals are flushed as well.
class TrapEnvironment : public testing::Environment {
  public:
    void SetUp() override {
        flush_denormals_if_asked();
        traps_ = std::make_unique<TrapFloats>();
    }
    void TearDown() override { traps_.reset(); }

  private:
    std::unique_ptr<TrapFloats> traps_;
};

[[maybe_unused]] const testing::Environment* const kEnvironment =
    testing::AddGlobalTestEnvironment(new TrapEnvironment);

}  // namespace
}  // namespace treefarm::test
