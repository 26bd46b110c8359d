// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/study.h"

namespace treefarm {

std::vector<StudyCell> study_cells(const Study& study) {
    std::vector<StudyCell> cells;
    const std::size_t methods = study.methods.size();
    for (std::size_t scene = 0; scene < study.scenes.size(); ++scene)
        for (std::size_t repetition = 0; repetition < study.seeds.size(); ++repetition)
            for (std::size_t budget = 0; budget < study.budgets.size(); ++budget)
                for (std::size_t k = 0; k < methods; ++k)
                    cells.push_back({scene, (repetition + k) % methods, study.seeds[repetition], repetition, budget});
    return cells;
}

}  // namespace treefarm
