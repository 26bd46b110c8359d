// SPDX-License-Identifier: Apache-2.0
// The text for Prometheus, read by a strict reader of its format (prometheus.io, "Exposition formats", 0.0.4).
#include <gtest/gtest.h>

#include <charconv>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "serve/metrics_text.h"
#include "tests/support/command.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

struct Parsed {
    std::map<std::string, std::string> types;
    std::map<std::string, double> samples;     ///< by name and labels as they were escaped
    std::map<std::string, std::string> hosts;  ///< of samples with that label: what it says
    std::string wrong;
};

bool is_name(const std::string& name) {
    return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_:") ==
               std::string::npos;
}

/// Reads the labels of a sample from its "{" on; returns where they end, or npos.
std::size_t read_labels(const std::string& line, std::size_t at, std::map<std::string, std::string>& labels) {
    ++at;
    while (at < line.size() && line[at] != '}') {
        const std::size_t equals = line.find("=\"", at);
        if (equals == std::string::npos || !is_name(line.substr(at, equals - at))) return std::string::npos;
        const std::string name = line.substr(at, equals - at);
        std::string value;
        for (at = equals + 2; at < line.size() && line[at] != '"'; ++at) {
            if (line[at] == '\\') {
                ++at;
                if (at == line.size() || std::string("\\\"n").find(line[at]) == std::string::npos)
                    return std::string::npos;
                value += line[at] == 'n' ? '\n' : line[at];
            } else {
                value += line[at];
            }
        }
        if (at >= line.size() || !labels.emplace(name, value).second) return std::string::npos;
        ++at;
        if (at < line.size() && line[at] == ',')
            ++at;
        else if (at >= line.size() || line[at] != '}')
            return std::string::npos;
    }
    return at < line.size() ? at + 1 : std::string::npos;
}

std::string read_line(const std::string& line, std::string& family, Parsed& parsed) {
    if (line.starts_with("# HELP ")) {
        family = line.substr(7, line.find(' ', 7) - 7);
        return is_name(family) && line.size() > 8 + family.size() ? "" : "a name and a help";
    }
    if (line.starts_with("# TYPE ")) {
        const std::string name = line.substr(7, line.find(' ', 7) - 7), type = line.substr(8 + name.size());
        if (name != family || !parsed.types.emplace(name, type).second) return "one type, behind its help";
        return type == "gauge" || type == "counter" ? "" : "a type";
    }
    const std::size_t brace = line.find('{');
    std::map<std::string, std::string> labels;
    if (brace == std::string::npos || line.substr(0, brace) != family) return "a sample of the family above";
    const std::size_t end = read_labels(line, brace, labels);
    if (end == std::string::npos || end >= line.size() || line[end] != ' ') return "labels";
    double value = 0;
    const char* const last = line.data() + line.size();
    const auto [stop, error] = std::from_chars(line.data() + end + 1, last, value);
    if (error != std::errc() || stop != last) return "a number";
    if (labels.contains("host")) parsed.hosts[line.substr(0, end)] = labels["host"];
    return parsed.samples.emplace(line.substr(0, end), value).second ? "" : "a sample once";
}

Parsed parse(const std::string& text) {
    Parsed parsed;
    std::istringstream lines(text);
    std::string line, family;
    while (std::getline(lines, line))
        if (const std::string wanted = read_line(line, family, parsed); !wanted.empty())
            parsed.wrong += line + ": no " + wanted + "\n";
    if (!text.empty() && !text.ends_with('\n')) parsed.wrong += "no line end at the end";
    return parsed;
}

std::vector<FileJson> two_runs() {
    const FileJson first = FileJson::parse(R"({"run": "box", "state": "running", "fraction": 0.25, "rays": 123456789012,
        "error": 0.05, "elapsed_seconds": 1e-7, "farm": {"reissued_units": 3, "workers": [
          {"worker": 1, "host": "node1", "state": "present", "threads": 8, "paths_per_second": 5000.5, "losses": 0},
          {"worker": 2, "host": "a\"b\\c\nd", "state": "lost", "threads": 4, "losses": 1}]}})");
    const FileJson second = FileJson::parse(R"({"run": "", "title": "done one", "state": "done", "fraction": 1.0})");
    return {first, second};
}

TEST(ServeMetrics, AStrictReaderTakesThem) {
    const Parsed parsed = parse(metrics_text(two_runs()));
    EXPECT_EQ(parsed.wrong, "");
    EXPECT_EQ(parsed.samples.at("treefarm_run_state{run=\"box\",state=\"running\"}"), 1);
    EXPECT_EQ(parsed.samples.at("treefarm_run_state{run=\"box\",state=\"done\"}"), 0);
    EXPECT_EQ(parsed.samples.at("treefarm_run_progress_ratio{run=\"done one\"}"), 1);
    EXPECT_EQ(parsed.samples.at("treefarm_run_rays_total{run=\"box\"}"), 123456789012.0);
    EXPECT_EQ(parsed.samples.at("treefarm_run_elapsed_seconds{run=\"box\"}"), 1e-7);
    EXPECT_EQ(parsed.samples.at("treefarm_worker_up{run=\"box\",worker=\"1\",host=\"node1\"}"), 1);
    EXPECT_EQ(parsed.samples.count("treefarm_run_relative_error_ratio{run=\"done one\"}"), 0u) << "not known";
    for (const auto& [name, type] : parsed.types) {
        EXPECT_EQ(type == "counter", name.ends_with("_total")) << name;
        EXPECT_TRUE(name.starts_with("treefarm_")) << name;
    }
    std::set<std::string> hosts;
    for (const auto& [sample, host] : parsed.hosts)
        hosts.insert(host);
    EXPECT_EQ(hosts, (std::set<std::string>{"node1", "a\"b\\c?d"})) << "a line end in a name is no line end here";
}

TEST(ServeMetrics, NoRunsAreNoSamples) {
    EXPECT_EQ(metrics_text({}), "");
}

TEST(ServeMetrics, TheStrictReaderRefusesWhatIsWrong) {
    const std::string head = "# HELP a b\n# TYPE a gauge\n";
    EXPECT_EQ(parse(head + "a{x=\"1\"} 2\n").wrong, "");
    for (const char* wrong : {"b{} 1\n", "a{x=\"1} 1\n", "a{x=\"\\q\"} 1\n", "a{} \n", "a{} 1x\n", "a{1=\"\"} 1\n",
                              "a{} 1\na{} 1\n", "a{} 1"})
        EXPECT_NE(parse(head + wrong).wrong, "") << wrong;
}

/// Prometheus' own client library, of Debian's Python: another may stand before it in PATH.
TEST(ServeMetrics, PrometheusClientTakesThem) {
    const std::string python = "/usr/bin/python3 -c '";
    if (test::run_command(python + "import prometheus_client.parser'").code != 0)
        GTEST_SKIP() << "there is no python3-prometheus-client (deploy/packages.txt)";
    const std::string file = (test::test_folder() / "metrics.txt").string(), text = metrics_text(two_runs());
    std::ofstream(file) << text;
    const test::Ended ended =
        test::run_command(python +
                          "import sys; from prometheus_client.parser import *; "
                          "print(sum(len(f.samples) for f in text_fd_to_metric_families(sys.stdin)))' < '" +
                          file + "'");
    EXPECT_EQ(ended.code, 0) << ended.output;
    EXPECT_EQ(ended.output, std::to_string(parse(text).samples.size()) + "\n");
}

TEST(ServeMetrics, PromtoolTakesThem) {
    if (test::run_command("command -v promtool").code != 0)
        GTEST_SKIP() << "promtool is not installed (Debian: prometheus)";
    const std::string file = (test::test_folder() / "metrics.txt").string();
    std::ofstream(file) << metrics_text(two_runs());
    const test::Ended ended = test::run_command("promtool check metrics < '" + file + "'");
    EXPECT_EQ(ended.code, 0) << ended.output;
}

}  // namespace
}  // namespace treefarm
