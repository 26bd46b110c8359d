// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/sd_tree/tree_learner.h"
