// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/study_list.h"

#include <spdlog/fmt/fmt.h>

#include <map>
#include <utility>

#include "common/base/text/duration_text.h"
#include "coordinator/study/reference.h"

namespace treefarm {

namespace {

void add(Expected& total, const std::optional<Expected>& one, std::size_t& unknown) {
    if (!one) {
        ++unknown;
        return;
    }
    total.value += one->value;
    total.low += one->low;
    total.high += one->high;
}

std::string time_text(const Expected& seconds) {
    if (seconds.low == seconds.high) return rough_duration_text(seconds.value);
    return fmt::format("{} [{}, {}]", rough_duration_text(seconds.value), rough_duration_text(seconds.low),
                       rough_duration_text(seconds.high));
}

/// Adds the missing cells of a scene, and the warm-ups before them.
void add_cells(const Study& study, std::vector<std::pair<StudyCell, ReadyCell>>& missing, const CostOfRender& cost,
               StudyCost& all) {
    std::map<std::pair<std::size_t, std::size_t>, std::optional<Expected>> known;  // by method and budget
    const auto cost_of = [&](std::pair<StudyCell, ReadyCell>& one) {
        const auto [at, is_new] = known.try_emplace({one.first.method, one.first.budget});
        if (is_new)
            at->second = cost(one.second.request,
                              study.scenes[one.first.scene].name + "." + study.methods[one.first.method].name);
        return at->second;
    };
    for (auto& one : missing)
        add(all.cells, cost_of(one), all.unknown);
    for (int k = 0; !missing.empty() && k < study.warmup; ++k)
        add(all.cells, cost_of(missing[static_cast<std::size_t>(k) % missing.size()]), all.unknown);
}

}  // namespace

StudyCost list_cells(const Study& study, const RenderOrigin& origin, const CostOfRender& cost, std::ostream& out) {
    StudyCost all;
    std::size_t done = 0, number = 0;
    const std::vector<StudyCell> cells = study_cells(study);
    for (std::size_t scene = 0; scene < study.scenes.size(); ++scene) {
        const StudyScene& of = study.scenes[scene];
        const LoadedScene loaded = load_study_scene(study, of);
        Reference reference;
        RenderRequest request;
        const std::string key = reference_key(study, of, loaded, reference, request, origin);
        const bool is_there = !of.reference.empty() || std::filesystem::exists(reference.mark());
        out << "reference of " << of.name << ": " << reference.file
            << (is_there ? " (there)\n" : " (to be rendered)\n");
        std::vector<std::pair<StudyCell, ReadyCell>> missing;
        for (const StudyCell& cell : cells) {
            if (cell.scene != scene) continue;
            ReadyCell ready = ready_cell(study, cell, loaded, key, origin);
            out << "cell " << ++number << " of " << cells.size() << ": " << cell_words(study, cell)
                << (ready.done() ? " (done)\n" : "\n");
            done += ready.done();
            if (!ready.done()) missing.emplace_back(cell, std::move(ready));
        }
        if (!is_there) add(all.references, cost(request, "reference of " + of.name), all.unknown);
        add_cells(study, missing, cost, all);
    }
    out << done << " of " << cells.size() << " cells are done\n";
    return all;
}

std::string cost_text(const StudyCost& cost) {
    std::string text;
    if (cost.cells.value > 0) text = time_text(cost.cells) + " of a core for the cells";
    if (cost.references.value > 0)
        text += (text.empty() ? "" : ", ") + time_text(cost.references) +
                (text.empty() ? " of a core for the references" : " for the references");
    text = text.empty() ? "" : "about " + text;
    if (cost.unknown > 0)
        text += fmt::format("{}{} render{} not counted: their time is not known", text.empty() ? "" : "; ",
                            cost.unknown, cost.unknown == 1 ? "" : "s");
    return text;
}

}  // namespace treefarm
