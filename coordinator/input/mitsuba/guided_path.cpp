// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/integrator_settings.h"

namespace treefarm::mitsuba {
namespace {

void read_filters(IntegratorSettings& settings) {
    Properties& properties = settings.properties();
    // Versions of 2018 have one switch for both filters.
    if (properties.has("do_filtered_splatting")) {
        const bool filtered = properties.boolean("do_filtered_splatting", true);
        settings.set_by("do_filtered_splatting", "guiding.spatial_filter", filtered ? "stochastic" : "nearest");
        settings.set_by("do_filtered_splatting", "guiding.directional_filter", filtered ? "box" : "nearest");
    }
    if (properties.text("spatial_filter", "") == "box")
        settings.diagnostics().warn(properties.where("spatial_filter"),
                                    R"(the spatial filter "box" becomes "stochastic", whose expectation is the same)");
    settings.read_words("spatial_filter", "guiding.spatial_filter",
                        {{"nearest", "nearest"}, {"stochastic", "stochastic"}, {"box", "stochastic"}});
    settings.read_words("directional_filter", "guiding.directional_filter", {{"nearest", "nearest"}, {"box", "box"}});
}

/// Reads the BSDF fraction. Learning overrides a given value, with which the plugin only starts.
void read_bsdf_fraction(IntegratorSettings& settings) {
    Properties& properties = settings.properties();
    settings.read_number("bsdf_sampling_fraction", "guiding.bsdf_fraction");
    const std::string loss = properties.text("bsdf_sampling_fraction_loss", "none");
    if (loss == "var")
        settings.diagnostics().warn(properties.where("bsdf_sampling_fraction_loss"),
                                    "the BSDF's sampling fraction is learned by the loss \"kl\": there is no other");
    if (loss == "kl" || loss == "var")
        settings.set_by("bsdf_sampling_fraction_loss", "guiding.bsdf_fraction", "learned");
    else if (loss != "none")
        throw InputError(properties.where("bsdf_sampling_fraction_loss"),
                         "unknown value " + in_quotes(loss) + " of bsdf_sampling_fraction_loss",
                         "use none or kl or var");
    if (properties.boolean("learn_bsdf_sampling_fraction", false))
        settings.set_by("learn_bsdf_sampling_fraction", "guiding.bsdf_fraction", "learned");
}

/// Reads the budget, in seconds unless the element says otherwise, as in the plugin. Without one the job's budget
/// holds.
void read_budget(IntegratorSettings& settings) {
    Properties& properties = settings.properties();
    const bool given = properties.has("budget") || properties.has("budget_type");
    const std::string type = properties.text("budget_type", "seconds");
    const double budget = properties.number("budget", 300.0);
    const Location& where = properties.where(properties.has("budget") ? "budget" : "budget_type");
    if (!given) return;
    if (type == "seconds") {
        if (!(budget > 0.0))
            throw InputError(where, "a budget of " + number_text(budget) + " seconds", "give more than 0");
        settings.set("budget.seconds", number_text(budget), where);
    } else if (type == "spp") {
        if (!(budget >= 1.0 && budget <= 1e9) || budget != std::floor(budget))
            throw InputError(where, "a budget of " + number_text(budget) + " samples per pixel",
                             "give a whole number of 1 or more");
        settings.set("budget.spp", std::to_string(static_cast<std::int64_t>(budget)), where);
    } else {
        throw InputError(properties.where("budget_type"), "unknown kind of budget " + in_quotes(type),
                         "use spp or seconds");
    }
}

}  // namespace

void read_guided_path(IntegratorSettings& settings) {
    Properties& properties = settings.properties();
    settings.set("guiding.preset", "paper", properties.where());
    settings.read_common();
    settings.read_words("nee", "integrator.next_event",
                        {{"never", "never"}, {"kickstart", "kickstart"}, {"always", "always"}});
    settings.read_words("sample_combination", "guiding.combination",
                        {{"discard", "last"}, {"automatic", "last"}, {"inversevar", "inverse_variance"}});
    read_filters(settings);
    read_bsdf_fraction(settings);
    settings.read_integer("s_tree_threshold", "guiding.spatial_threshold");
    settings.read_number("d_tree_threshold", "guiding.directional_threshold");
    settings.read_integer("spp_per_pass", "guiding.spp_unit");
    // The tree's size does not change the expectation of the image.
    if (properties.integer("sd_tree_max_memory", -1) >= 0)
        settings.diagnostics().warn(properties.where("sd_tree_max_memory"),
                                    "sdTreeMaxMemory is ignored: the tree's memory has no limit");
    read_budget(settings);
    properties.ignore({"dump_sdtree", "automatic_budget"});
}

}  // namespace treefarm::mitsuba
