#include "common/scene/mitsuba/integrator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/config/parse_text.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::array<std::string_view, 4> kIntegrators = {"path", "volpath", "direct", "guided_path"};

class IntegratorReader {
  public:
    IntegratorReader(Properties& properties, std::vector<Setting>& settings, Diagnostics& diagnostics)
        : properties_(properties), settings_(settings), diagnostics_(diagnostics) {}

    void read_path() {
        set("guiding.type", "none", properties_.where());
        set("integrator.next_event", "always", properties_.where());
        read_common();
    }

    /// Light that comes straight from an emitter: paths of two edges, whatever the numbers of samples are.
    void read_direct() {
        set("guiding.type", "none", properties_.where());
        set("integrator.next_event", "always", properties_.where());
        set("integrator.max_depth", "2", properties_.where());
        properties_.ignore({"shading_samples", "emitter_samples", "bsdf_samples"});
        read_flags();
    }

    /// What estimates the same image in another way: how long paths are belongs to the image, the rest does not.
    void read_other(const std::string& type) {
        diagnostics_.warn(properties_.where(), "the integrator " + in_quotes(type) +
                                                   " is replaced by path tracing as the job sets it: the same image, "
                                                   "but for what that integrator leaves out or blurs");
        if (!properties_.has("max_depth") && type == "vpl") set("integrator.max_depth", "5", properties_.where());
        if (!properties_.has("max_depth") && type.starts_with("prb"))
            set("integrator.max_depth", "6", properties_.where());
        read_common();
        properties_.ignore_values();
    }

    void read_guided_path() {
        set("guiding.preset", "paper", properties_.where());
        read_common();
        read_words("nee", "integrator.next_event",
                   {{"never", "never"}, {"kickstart", "kickstart"}, {"always", "always"}}, {});
        read_words("sample_combination", "guiding.combination",
                   {{"discard", "last"}, {"automatic", "last"}, {"inversevar", "inverse_variance"}}, {});
        read_words("spatial_filter", "guiding.spatial_filter", {{"nearest", "nearest"}}, {"stochastic", "box"});
        read_words("directional_filter", "guiding.directional_filter", {{"nearest", "nearest"}}, {"box"});
        read_words("bsdf_sampling_fraction_loss", "", {{"none", ""}}, {"kl", "var"});
        read_integer("s_tree_threshold", "guiding.spatial_threshold");
        read_integer("spp_per_pass", "guiding.spp_unit");
        read_number("d_tree_threshold", "guiding.directional_threshold");
        read_number("bsdf_sampling_fraction", "guiding.bsdf_fraction");
        if (properties_.integer("sd_tree_max_memory", -1) != -1)
            diagnostics_.unsupported(properties_.where("sd_tree_max_memory"),
                                     "a limit on the tree's memory is not available in this version", "give -1",
                                     "there is no limit");
        read_budget();
        properties_.ignore({"dump_sdtree"});
    }

  private:
    void set(const std::string& key, const std::string& value, const Location& where) {
        settings_.push_back({key, value, where});
    }

    void read_common() {
        read_integer("max_depth", "integrator.max_depth");
        read_integer("rr_depth", "integrator.rr_depth");
        read_flags();
    }

    void read_flags() {
        properties_.ignore({"block_size", "samples_per_pass", "timeout"});
        for (const auto& [name, key] : {std::pair("strict_normals", "integrator.strict_normals"),
                                        std::pair("hide_emitters", "integrator.hide_emitters")})
            if (properties_.has(name))
                set(key, properties_.boolean(name, false) ? "true" : "false", properties_.where(name));
    }

    void read_integer(const char* name, const char* key) {
        if (properties_.has(name)) set(key, std::to_string(properties_.integer(name, 0)), properties_.where(name));
    }

    void read_number(const char* name, const char* key) {
        if (properties_.has(name)) set(key, number_text(properties_.number(name, 0.0)), properties_.where(name));
    }

    /// Words that translate, and words that are known but not available. An empty key stores nothing.
    void read_words(const char* name, const char* key, const std::vector<std::pair<std::string, std::string>>& words,
                    const std::vector<std::string>& unavailable) {
        if (!properties_.has(name)) return;
        const std::string value = properties_.text(name, "");
        const Location& where = properties_.where(name);
        std::string allowed;
        for (const auto& [word, translated] : words) {
            if (word == value) {
                if (*key != '\0') set(key, translated, where);
                return;
            }
            allowed += (allowed.empty() ? "" : " or ") + word;
        }
        for (const std::string& word : unavailable)
            if (word == value) {
                diagnostics_.unsupported(
                    where, std::string(name) + " = " + in_quotes(value) + " is not available in this version",
                    "use " + allowed, words.front().first + " is used");
                return;
            }
        throw InputError(where, "unknown value " + in_quotes(value) + " of " + name, "use " + allowed);
    }

    /// The plugin's budget is in seconds unless it says otherwise.
    void read_budget() {
        const std::string type = properties_.text("budget_type", "seconds");
        const double budget = properties_.number("budget", 300.0);
        if (type == "seconds") {
            diagnostics_.unsupported(
                properties_.where("budget_type"), "a budget in seconds is not available in this version",
                "add <string name=\"budgetType\" value=\"spp\"/> with the samples per pixel as budget",
                "it is ignored");
            return;
        }
        if (type != "spp")
            throw InputError(properties_.where("budget_type"), "unknown kind of budget " + in_quotes(type), "use spp");
        if (!(budget >= 1.0 && budget <= 1e9) || budget != std::floor(budget))
            throw InputError(properties_.where("budget"), "a budget of " + number_text(budget) + " samples per pixel",
                             "give a whole number of 1 or more");
        set("budget.spp", std::to_string(static_cast<std::int64_t>(budget)), properties_.where("budget"));
    }

    Properties& properties_;
    std::vector<Setting>& settings_;
    Diagnostics& diagnostics_;
};

/// Integrators of Mitsuba that converge to the image of a path tracer.
bool is_other_estimator(const std::string& type) {
    constexpr std::array<std::string_view, 12> kTypes = {"bdpt", "mlt",  "pssmlt", "erpt", "ptracer",   "photonmapper",
                                                         "ppm",  "sppm", "vpl",    "prb",  "prb_basic", "prbvolpath"};
    return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

/// Integrators around another one, which makes the image.
bool is_wrapper(const std::string& type) {
    return type == "aov" || type == "moment" || type == "adaptive" || type == "irrcache";
}

}  // namespace

void read_integrator(const XmlElement& integrator, std::vector<Setting>& settings, const SceneDocument& document,
                     Diagnostics& diagnostics) {
    Properties properties(integrator, document, diagnostics);
    const std::string type = properties.type();
    IntegratorReader reader(properties, settings, diagnostics);
    if (type == "path" || type == "volpath" || type == "volpath_simple" || type == "volpathmis") {
        // Without media, which are refused, the volumetric ones are path tracers.
        reader.read_path();
    } else if (type == "direct") {
        reader.read_direct();
    } else if (type == "guided_path") {
        reader.read_guided_path();
    } else if (is_other_estimator(type)) {
        reader.read_other(type);
    } else if (const XmlElement* inner = is_wrapper(type) ? properties.only_child("integrator") : nullptr) {
        diagnostics.warn(integrator.where,
                         "of the integrator " + in_quotes(type) + " only the one inside is used: it makes the image");
        read_integrator(*inner, settings, document, diagnostics);
        properties.ignore_values();
    } else {
        diagnostics.unsupported(integrator.where,
                                "the integrator " + in_quotes(type) + " is not available in this version",
                                did_you_mean(type, kIntegrators, "use path, volpath, direct or guided_path"),
                                "the job's settings are used");
        return;
    }
    properties.finish();
}

}  // namespace treefarm::mitsuba
