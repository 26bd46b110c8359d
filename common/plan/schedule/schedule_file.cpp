// SPDX-License-Identifier: Apache-2.0
#include "common/plan/schedule/schedule_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text/parse_text.h"
#include "common/config/toml_settings.h"
#include "common/decide/light_subpaths/light_subpath_decision.h"

namespace treefarm {
namespace {

constexpr std::int64_t kMostSpp = std::int64_t{1} << 30;
constexpr std::size_t kMostPasses = 10000;

/// Keys of a [[pass]].
constexpr std::string_view kKeys[] = {"spp", "next_event", "record", "guided", "split", "light_subpaths", "last_tree"};
constexpr const char* kKeyAdvice =
    "a pass has spp, next_event and record, and may have guided, split, light_subpaths and last_tree";

class ScheduleReader {
  public:
    ScheduleReader(const std::string& file, const Resolved& job) : file_(file), job_(job) {}

    std::vector<PassPlan> read(const toml::table& table) {
        for (const auto& [key, node] : table)
            if (key.str() != "pass")
                throw InputError(location(key.source()), "unknown key " + in_quotes(key.str()),
                                 "a schedule holds [[pass]] tables only");
        const toml::array* passes = table["pass"].as_array();
        if (passes == nullptr || passes->empty())
            throw InputError(table["pass"] ? location(table["pass"].node()->source()) : Location{file_, 1, 1},
                             "a schedule without passes", "write a [[pass]] table for each pass");
        if (passes->size() > kMostPasses)
            throw InputError(location((*passes)[kMostPasses].source()),
                             "more than " + std::to_string(kMostPasses) + " passes", "give passes more samples");
        for (const toml::node& node : *passes)
            read_pass(node);
        return std::move(passes_);
    }

    Location location(const toml::source_region& region) const {
        return {file_, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
    }

  private:
    void read_pass(const toml::node& node) {
        const toml::table* pass = node.as_table();
        if (pass == nullptr)
            throw InputError(location(node.source()), "a pass that is no table",
                             "write a [[pass]] table for each pass");
        for (const auto& [key, value] : *pass)
            if (std::find(std::begin(kKeys), std::end(kKeys), key.str()) == std::end(kKeys))
                throw InputError(location(key.source()), "unknown key " + in_quotes(key.str()), kKeyAdvice);
        const auto spp = required(*pass, "spp");
        const auto samples = spp.value_exact<std::int64_t>();
        if (!samples || *samples < 1 || *samples > kMostSpp - done_)
            throw InputError(location(spp.node()->source()), "spp is not an integer of at least 1, up to 2^30 in all",
                             "write the samples per pixel of this pass");
        PassPlan plan = make_pass(job_, static_cast<std::uint32_t>(passes_.size()), static_cast<std::uint32_t>(done_),
                                  static_cast<std::uint32_t>(*samples), true);
        set_next_event(plan, job_, flag(*pass, "next_event"));
        const bool record = flag(*pass, "record");
        if (record && !job_.guides)
            throw InputError(location((*pass)["record"].node()->source()), "record = true, but guiding.type = \"none\"",
                             "render with the job that the schedule was made by");
        set_record(plan, job_, record);
        plan.guided = job_.guides && (!pass->contains("guided") || flag(*pass, "guided"));
        plan.split = !pass->contains("split") || flag(*pass, "split");
        const bool light_subpaths = !pass->contains("light_subpaths") || flag(*pass, "light_subpaths");
        if (!light_subpaths && job_.bidirectional.light_subpaths != Rule::while_it_pays)
            throw InputError(location((*pass)["light_subpaths"].node()->source()),
                             "light_subpaths = false, but bidirectional.light_subpaths is not \"while_it_pays\"",
                             "render with the job that the schedule was made by");
        if (!light_subpaths) drop_light_subpaths(plan);
        if (pass->contains("last_tree")) plan.last_tree = flag(*pass, "last_tree");
        done_ += *samples;
        passes_.push_back(plan);
    }

    toml::node_view<const toml::node> required(const toml::table& pass, std::string_view key) const {
        if (!pass.contains(key))
            throw InputError(location(pass.source()), "a pass without " + std::string(key), kKeyAdvice);
        return pass[key];
    }

    bool flag(const toml::table& pass, std::string_view key) const {
        const auto value = required(pass, key);
        const auto truth = value.value_exact<bool>();
        if (!truth)
            throw InputError(location(value.node()->source()), std::string(key) + " is not true or false",
                             "write true or false, without quotes");
        return *truth;
    }

    const std::string& file_;
    const Resolved& job_;
    std::vector<PassPlan> passes_;
    std::int64_t done_ = 0;
};

const char* word(bool value) {
    return value ? "true" : "false";
}

}  // namespace

std::string write_schedule(std::span<const PassPlan> passes) {
    std::string text =
        "# The passes of a render: treefarm render job.toml --schedule schedule.toml repeats its bits.\n";
    for (const PassPlan& pass : passes)
        text += "\n[[pass]]\nspp = " + std::to_string(pass.spp) + "\nnext_event = " + word(pass.next_event) +
                "\nrecord = " + word(pass.record) + (pass.guided ? "" : "\nguided = false") +
                (pass.split ? "" : "\nsplit = false") + (pass.light_subpaths ? "" : "\nlight_subpaths = false") +
                (pass.last_tree != pass.record ? "" : std::string("\nlast_tree = ") + word(pass.last_tree)) + "\n";
    return text;
}

std::vector<PassPlan> parse_schedule(const std::string& toml, const std::string& name, const Resolved& job) {
    ScheduleReader reader(name, job);
    try {
        return reader.read(parse_toml(toml, name));
    } catch (const toml::parse_error& error) {
        throw InputError(reader.location(error.source()), "this is not TOML: " + one_line(error.description()),
                         "write [[pass]] tables with key = value lines");
    }
}

}  // namespace treefarm
