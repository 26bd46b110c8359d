// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/integrator.h"

#include <algorithm>
#include <array>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/integrator_settings.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::array<std::string_view, 7> kIntegrators = {"path",    "volpath", "direct",     "ao",
                                                          "ptracer", "bdpt",    "guided_path"};

/// Reads a path tracer. Guiding is left to the job.
void read_path(IntegratorSettings& settings) {
    settings.set("integrator.next_event", "auto", settings.properties().where());
    settings.read_common();
}

/// Reads direct illumination; shading_samples stands for both numbers of samples if they are not given.
void read_direct(IntegratorSettings& settings) {
    settings.set("integrator.type", "direct", settings.properties().where());
    for (const char* key : {"integrator.emitter_samples", "integrator.bsdf_samples"})
        settings.read_integer("shading_samples", key);
    settings.read_integer("emitter_samples", "integrator.emitter_samples");
    settings.read_integer("bsdf_samples", "integrator.bsdf_samples");
    settings.read_flags();
}

/// Reads ambient occlusion. The number of directions per sample does not change the image.
void read_ambient_occlusion(IntegratorSettings& settings) {
    Properties& properties = settings.properties();
    settings.set("integrator.type", "ao", properties.where());
    properties.ignore({"shading_samples"});
    const double length = properties.number("ray_length", -1.0);
    if (length == 0.0)
        throw InputError(properties.where("ray_length"), "rays of length 0 meet nothing",
                         "write a length, or -1 for one by the size of the scene");
    if (length > 0.0) settings.set_by("ray_length", "integrator.ao_distance", number_text(length));
    settings.read_flags();
}

/// Reads light tracing, as the estimator. The division of its work, and paths that hit the sensor by chance, do not
/// change the image.
void read_light_tracing(IntegratorSettings& settings) {
    settings.set("integrator.type", "light", settings.properties().where());
    settings.read_common();
    settings.properties().ignore({"granularity", "brute_force"});
}

/// Reads bidirectional path tracing. Its techniques do not change the image, only its noise.
void read_bidirectional(IntegratorSettings& settings) {
    settings.set("integrator.type", "bidirectional", settings.properties().where());
    settings.read_boolean("light_image", "bidirectional.light_image");
    if (settings.properties().has("sample_direct")) {
        const bool samples = settings.properties().boolean("sample_direct", true);
        settings.set_by("sample_direct", "integrator.next_event", samples ? "always" : "never");
    }
    settings.read_common();
}

/// Reads another estimator of the same image: the length of paths belongs to the image, the rest does not.
void read_other(IntegratorSettings& settings, const std::string& type) {
    Properties& properties = settings.properties();
    settings.diagnostics().warn(properties.where(),
                                "the integrator " + in_quotes(type) +
                                    " is replaced by path tracing as the job sets it: the same image, "
                                    "but for what that integrator leaves out or blurs");
    if (!properties.has("max_depth") && type == "vpl") settings.set("integrator.max_depth", "5", properties.where());
    if (!properties.has("max_depth") && type.starts_with("prb"))
        settings.set("integrator.max_depth", "6", properties.where());
    settings.read_common();
    properties.ignore_values();
}

/// Whether an integrator of Mitsuba converges to the image of a path tracer.
bool is_other_estimator(const std::string& type) {
    constexpr std::array<std::string_view, 10> kTypes = {"mlt",  "pssmlt", "erpt", "photonmapper", "ppm",
                                                         "sppm", "vpl",    "prb",  "prb_basic",    "prbvolpath"};
    return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

/// Whether an integrator wraps another one, which makes the image.
bool is_wrapper(const std::string& type) {
    return type == "moment" || type == "adaptive" || type == "irrcache";
}

/// AOV for a variable of Mitsuba's plugin `aov`, or "".
std::string aov_named(const std::string& variable) {
    constexpr std::pair<std::string_view, const char*> kVariables[] = {
        {"albedo", "albedo"},     {"depth", "distance"},
        {"position", "position"}, {"uv", "uv"},
        {"sh_normal", "normal"},  {"geo_normal", "geometric_normal"},
        {"shape_index", "shape"}};
    for (const auto& [name, aov] : kVariables)
        if (name == variable) return aov;
    return "";
}

/// Reads the list NAME:VARIABLE, ... of the plugin `aov`; NAME becomes the name of the layer.
void read_aovs(IntegratorSettings& settings) {
    Properties& properties = settings.properties();
    const std::string list = properties.text("aovs", "");
    const Location& where = properties.where("aovs");
    std::string wanted;
    for (std::size_t begin = 0; begin < list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const std::string entry(trim(std::string_view(list).substr(begin, end - begin)));
        begin = end + 1;
        const std::size_t colon = entry.find(':');
        if (colon == std::string::npos || colon == 0)
            throw InputError(where, in_quotes(entry) + " is no layer with its name",
                             "write NAME:VARIABLE, for instance n:sh_normal");
        const std::string variable(trim(std::string_view(entry).substr(colon + 1)));
        const std::string aov = aov_named(variable);
        if (aov.empty())
            settings.diagnostics().unsupported(
                where, "the AOV " + in_quotes(variable) + " is not available",
                "name one of albedo, depth, position, uv, sh_normal, geo_normal, shape_index", "it is left out");
        else
            wanted += (wanted.empty() ? "" : ",") + std::string(trim(entry.substr(0, colon))) + ":" + aov;
    }
    settings.add_aovs(wanted, where);
}

/// Whether an integrator is a path tracer. Without media, which are refused, the volumetric ones are.
bool is_path_tracer(const std::string& type) {
    return type == "path" || type == "volpath" || type == "volpath_simple" || type == "volpathmis";
}

}  // namespace

void read_integrator(const XmlElement& integrator, std::vector<Setting>& settings, const SceneDocument& document,
                     Diagnostics& diagnostics) {
    Properties properties(integrator, document, diagnostics);
    const std::string type = properties.type();
    IntegratorSettings reader(properties, settings, diagnostics);
    if (type == "direct") {
        read_direct(reader);
    } else if (type == "ao") {
        read_ambient_occlusion(reader);
    } else if (type == "ptracer") {
        read_light_tracing(reader);
    } else if (type == "bdpt") {
        read_bidirectional(reader);
    } else if (is_path_tracer(type)) {
        diagnostics.note(integrator.where, "the integrator " + in_quotes(type) +
                                               " says how light is transported; whether paths are guided says the job: "
                                               "guiding.type, which is \"auto\" unless set, and \"none\" for plain "
                                               "path tracing");
        read_path(reader);
    } else if (type == "guided_path") {
        read_guided_path(reader);
    } else if (type == "aov") {
        read_aovs(reader);
        if (const XmlElement* inner = properties.only_child("integrator"))
            read_integrator(*inner, settings, document, diagnostics);
    } else if (is_other_estimator(type)) {
        read_other(reader, type);
    } else if (const XmlElement* inner = is_wrapper(type) ? properties.only_child("integrator") : nullptr) {
        diagnostics.warn(integrator.where,
                         "of the integrator " + in_quotes(type) + " only the one inside is used: it makes the image");
        read_integrator(*inner, settings, document, diagnostics);
        properties.ignore_values();
    } else {
        diagnostics.unsupported(integrator.where,
                                "the integrator " + in_quotes(type) + " is not available in this version",
                                did_you_mean(type, kIntegrators, "use " + listed(kIntegrators)),
                                "paths are traced as the job says; of its parameters count maxDepth, rrDepth, "
                                "strictNormals and hideEmitters");
        // Probably a custom integrator: the common properties belong to the image.
        reader.read_common();
        return;
    }
    properties.finish();
}

}  // namespace treefarm::mitsuba
