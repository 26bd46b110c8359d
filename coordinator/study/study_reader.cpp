// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "common/base/text/parse_text.h"
#include "common/config/job_reader.h"
#include "common/config/toml_kind.h"
#include "common/config/toml_settings.h"
#include "coordinator/study/study.h"
#include "coordinator/study/study_rules.h"

namespace treefarm {
namespace {

constexpr std::string_view kKeys[] = {"scene",  "method", "vary",     "job",       "seeds",
                                      "budget", "warmup", "baseline", "directory", "reference"};
constexpr std::int64_t kMostSeeds = 10'000;
constexpr std::size_t kMostMethods = 1'000;

class StudyReader {
  public:
    explicit StudyReader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

    Study read(const toml::table& table) {
        require_kind(table, file_, TomlKind::study);
        for (const auto& [key, node] : table)
            if (std::find(std::begin(kKeys), std::end(kKeys), key.str()) == std::end(kKeys))
                throw InputError(location(key.source()), "unknown key " + in_quotes(key.str()),
                                 did_you_mean(key.str(), kKeys, "see docs/use/studies.md for the keys"));
        study_.file = file_;
        read_directory(table);
        if (const toml::table* job = section(table, "job")) study_.job = settings_of(*job, StudyPart::job);
        read_scenes(table);
        read_methods(table);
        read_variations(table);
        read_seeds(table);
        read_budget(table);
        read_reference(table);
        read_warmup(table);
        read_baseline(table);
        return std::move(study_);
    }

    Location location(const toml::source_region& region) const { return toml_location(region, file_); }

  private:
    const toml::table* section(const toml::table& table, std::string_view key) const {
        const toml::node* node = table.get(key);
        if (node == nullptr) return nullptr;
        if (!node->is_table())
            throw InputError(location(node->source()),
                             std::string(key) + " is " + toml_type_name(*node) + ", not a table",
                             "write [" + std::string(key) + "]");
        return node->as_table();
    }

    /// Job keys in one part of the study; values are tried out on a job.
    std::vector<Setting> settings_of(const toml::table& table, StudyPart part) const {
        std::vector<Setting> settings;
        for_each_job_key(table, file_, [&](const std::string& key, const Location& where, const toml::node& value) {
            if (part == StudyPart::scene && (key == "file" || key == "reference")) return;  // not job keys
            settings.push_back(read_setting(key, where, value, file_));
            check_study_key(settings.back(), part);
        });
        Job job;
        apply_layer(job, settings);
        return settings;
    }

    std::string text_of(const toml::node& node, const std::string& key) const {
        const auto text = node.value_exact<std::string>();
        if (!text || text->empty())
            throw InputError(location(node.source()), key + " is not text", "write it in quotes");
        return *text;
    }

    void read_directory(const toml::table& table) {
        const toml::node* node = table.get("directory");
        study_.directory = node ? text_of(*node, "directory") : "runs/" + path_.stem().string();
    }

    std::string existing_file(const toml::node& node, const std::string& key) const {
        const std::filesystem::path file = path_.parent_path() / text_of(node, key);
        std::error_code error;
        if (!std::filesystem::is_regular_file(file, error))
            throw InputError(location(node.source()), "there is no file " + path_in_quotes(file.string()),
                             "paths are relative to the study file's folder");
        return std::filesystem::absolute(file).lexically_normal().string();
    }

    void read_scenes(const toml::table& table) {
        const toml::table* scenes = section(table, "scene");
        if (scenes == nullptr || scenes->empty())
            throw InputError(Location{file_, 1, 1}, "a study without scenes", "write [scene.NAME] with file = \"...\"");
        for (const auto& [name, node] : in_order(*scenes))
            study_.scenes.push_back(read_scene(name, *node));
    }

    StudyScene read_scene(const std::string& name, const toml::node& node) const {
        check_study_name(name, location(node.source()));
        const toml::table& keys = *require_table(node, "scene", name);
        StudyScene scene;
        scene.name = name;
        const toml::node* file = keys.get("file");
        if (file == nullptr)
            throw InputError(location(node.source()), "scene." + name + " names no file", "add file = \"scene.xml\"");
        scene.file = existing_file(*file, "file");
        scene.where = location(file->source());
        if (const toml::node* reference = keys.get("reference")) {
            scene.reference = existing_file(*reference, "reference");
            scene.reference_where = location(reference->source());
        }
        scene.settings = settings_of(keys, StudyPart::scene);
        return scene;
    }

    void read_methods(const toml::table& table) {
        if (const toml::table* methods = section(table, "method"))
            for (const auto& [name, node] : in_order(*methods)) {
                check_study_name(name, location(node->source()));
                study_.methods.push_back({name, settings_of(*require_table(*node, "method", name), StudyPart::method)});
            }
        if (study_.methods.empty()) study_.methods.push_back({"default", {}});
    }

    /// Combines every value of a varied key with every method so far.
    void read_variations(const toml::table& table) {
        const toml::table* vary = section(table, "vary");
        if (vary == nullptr) return;
        for_each_job_key(*vary, file_, [&](const std::string& key, const Location& where, const toml::node& node) {
            const toml::array* values = node.as_array();
            if (values == nullptr || values->empty())
                throw InputError(location(node.source()), key + " is not a list of values",
                                 "write " + key + " = [first, second]; a single value belongs into [job]");
            std::vector<StudyMethod> varied;
            for (const StudyMethod& method : study_.methods)
                for (const toml::node& value : *values)
                    varied.push_back(varied_method(method, read_setting(key, where, value, file_)));
            if (varied.size() > kMostMethods)
                throw InputError(where, "more than 1000 combinations", "vary fewer keys at a time");
            study_.methods = std::move(varied);
        });
    }

    static StudyMethod varied_method(StudyMethod method, const Setting& setting) {
        check_study_key(setting, StudyPart::method);
        Job job;
        apply_setting(job, setting.key, setting.value, setting.where);
        const std::string what = setting.key.substr(setting.key.find('.') + 1) + "=" + setting.value;
        method.name = method.name == "default" ? what : method.name + " " + what;
        method.settings.push_back(setting);
        return method;
    }

    void read_seeds(const toml::table& table) {
        const toml::node* node = table.get("seeds");
        if (node == nullptr) {
            study_.seeds = {1, 2, 3, 4};
        } else if (const toml::array* list = node->as_array()) {
            for (const toml::node& seed : *list)
                study_.seeds.push_back(static_cast<std::uint64_t>(integer(seed, "a seed", 0, INT64_MAX)));
        } else {
            const std::int64_t count = integer(*node, "seeds", 1, kMostSeeds);
            for (std::int64_t seed = 1; seed <= count; ++seed)
                study_.seeds.push_back(static_cast<std::uint64_t>(seed));
        }
        std::vector<std::uint64_t> sorted = study_.seeds;
        std::sort(sorted.begin(), sorted.end());
        if (sorted.empty() || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            throw InputError(location(node->source()), "seeds are a number of them, or a list without repetition",
                             "write seeds = 8 or seeds = [1, 2, 3]");
    }

    static std::string value_or_type(const toml::node& node) {
        if (const auto value = node.value_exact<std::int64_t>()) return std::to_string(*value);
        if (const auto value = node.value_exact<double>()) return number_text(*value);
        return toml_type_name(node);
    }

    std::int64_t integer(const toml::node& node, const std::string& what, std::int64_t least,
                         std::int64_t greatest) const {
        const auto value = node.value_exact<std::int64_t>();
        if (!value || *value < least || *value > greatest)
            throw InputError(location(node.source()), what + " is " + value_or_type(node) + ", which is not allowed",
                             "give an integer from " + std::to_string(least) + " to " + std::to_string(greatest));
        return *value;
    }

    void read_budget(const toml::table& table) {
        const toml::table* budget = section(table, "budget");
        const char* cure =
            "write one of seconds (equal time), spp (equal samples), error (equal error); a list for several: [1, 2, "
            "4]";
        if (budget == nullptr || budget->size() != 1)
            throw InputError(budget ? location(budget->source()) : Location{file_, 1, 1},
                             "a study has one kind of budget for all cells", cure);
        const auto first = budget->cbegin();
        const toml::key& key = first->first;
        const toml::node& node = first->second;
        if (key.str() != "seconds" && key.str() != "spp" && key.str() != "error")
            throw InputError(location(key.source()), "unknown budget " + in_quotes(key.str()), cure);
        const toml::array* list = node.as_array();
        if (list != nullptr && list->empty()) throw InputError(location(node.source()), "a list without budgets", cure);
        if (list == nullptr) add_budget(std::string(key.str()), location(key.source()), node, cure);
        for (std::size_t k = 0; list != nullptr && k < list->size(); ++k)
            add_budget(std::string(key.str()), location(list->get(k)->source()), *list->get(k), cure);
    }

    void add_budget(const std::string& key, const Location& where, const toml::node& node, const char* cure) {
        const Setting setting = read_setting("budget." + key, where, node, file_);
        Job job;
        apply_layer(job, std::vector<Setting>{setting});
        if (key != "spp" && job.budget.seconds <= 0 && job.budget.error <= 0)
            throw InputError(location(node.source()), "a budget of 0 renders nothing", cure);
        for (const Setting& other : study_.budgets)
            if (other.value == setting.value)
                throw InputError(location(node.source()), "the budget " + setting.value + " is listed twice",
                                 "name each once");
        study_.budgets.push_back(setting);
    }

    void read_reference(const toml::table& table) {
        const toml::table* reference = section(table, "reference");
        const auto needs_one = std::find_if(study_.scenes.begin(), study_.scenes.end(),
                                            [](const StudyScene& scene) { return scene.reference.empty(); });
        if (reference == nullptr && needs_one != study_.scenes.end())
            throw InputError(needs_one->where, "scene." + needs_one->name + " has no reference",
                             "add reference = \"image.exr\" to it, or [reference] with the job keys to render one by");
        if (reference == nullptr) return;
        study_.reference.settings = settings_of(*reference, StudyPart::reference);
        Job job;
        apply_layer(job, study_.reference.settings);
        if (std::find(study_.seeds.begin(), study_.seeds.end(), job.sampler.seed) != study_.seeds.end())
            throw InputError(location(reference->source()),
                             "the reference would share a seed with the cells, and their noise",
                             "set sampler.seed in [reference] to one that is not in seeds, for instance 1000000");
    }

    void read_warmup(const toml::table& table) {
        if (const toml::node* node = table.get("warmup"))
            study_.warmup = static_cast<int>(integer(*node, "warmup", 0, 100));
    }

    void read_baseline(const toml::table& table) {
        study_.baseline = study_.methods.front().name;
        const toml::node* node = table.get("baseline");
        if (node == nullptr) return;
        study_.baseline = text_of(*node, "baseline");
        std::vector<std::string> names;
        for (const StudyMethod& method : study_.methods)
            names.push_back(method.name);
        if (std::find(names.begin(), names.end(), study_.baseline) != names.end()) return;
        // [vary] appends its values to the names of methods: a name alone means the first of these.
        const auto variant = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
            return name.starts_with(study_.baseline + " ");
        });
        if (variant != names.end()) {
            study_.baseline = *variant;
            return;
        }
        const std::string nearest = nearest_word(study_.baseline, names);
        throw InputError(location(node->source()), "no method is called " + in_quotes(study_.baseline),
                         "did you mean " + in_quotes(nearest.empty() ? names.front() : nearest) + "?");
    }

    const toml::table* require_table(const toml::node& node, const char* kind, const std::string& name) const {
        if (!node.is_table())
            throw InputError(location(node.source()), std::string(kind) + "." + name + " is " + toml_type_name(node),
                             std::string("write [") + kind + "." + name + "] and keys below it");
        return node.as_table();
    }

    /// Entries of a table in the order of the file, since toml++ sorts tables.
    static std::vector<std::pair<std::string, const toml::node*>> in_order(const toml::table& table) {
        std::vector<std::pair<std::string, const toml::node*>> entries;
        for (const auto& [key, node] : table)
            entries.emplace_back(key.str(), &node);
        std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
            const auto at = [](const auto& e) {
                return std::pair(e.second->source().begin.line, e.second->source().begin.column);
            };
            return at(a) < at(b);
        });
        return entries;
    }

    const std::filesystem::path path_;
    const std::string file_;
    Study study_;
};

}  // namespace

Study parse_study(const std::string& toml, const std::filesystem::path& path) {
    StudyReader reader(path);
    try {
        return reader.read(parse_toml(toml, path.string()));
    } catch (const toml::parse_error& error) {
        throw InputError(reader.location(error.source()), "this is not TOML: " + one_line(error.description()),
                         "write key = value, text in quotes");
    }
}

Study read_study(const std::filesystem::path& path) {
    return parse_study(read_settings_text(path, "study"), path);
}

}  // namespace treefarm
