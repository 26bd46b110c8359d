// SPDX-License-Identifier: Apache-2.0
// What treefarm serve makes of files, and whom it lets in: without a network.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "common/base/error.h"
#include "coordinator/run/folder_lock.h"
#include "serve/file_json.h"
#include "serve/pass_table.h"
#include "serve/run_search.h"
#include "serve/site.h"
#include "serve/token.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kNow = 1000000;

Here here_at(std::int64_t now, bool has_process = true) {
    return {now, "node1", [=](int) { return has_process; }};
}

std::string running_status(std::int64_t time) {
    return R"({"state": "running", "pass": 2, "passes": 4, "spp_done": 12, "spp": 64, "fraction": 0.25,
        "elapsed_seconds": 10.5, "seconds_left": 31.5, "image_error": {"relative": 0.2, "low": 0.1, "high": 0.3},
        "workers": 1, "rays": 1000, "halving": {"relative_error": 0.1, "spp": 40, "seconds": 30, "trust": "noisy"},
        "farm": {"workers": [
          {"worker": 1, "host": "node1", "threads": 8, "state": "present", "losses": 0, "paths_per_second": 5000.0,
           "rays": 900, "idle_share": 0.25, "processor_share": 0.06,
           "bad_messages": 0},
          {"worker": 2, "host": "a \"b\"\\c", "threads": 4, "state": "lost", "losses": 1, "paths_per_second": null}],
          "reissued_units": 7, "copied_units": 1, "dropped_results": 2, "bad_messages": 0},
        "pid": 77, "host": "node1", "time": )" +
           std::to_string(time) + "}";
}

class ServeSite : public testing::Test {
  protected:
    void SetUp() override {
        test::write_file(folder / "runs/box/status.json", running_status(kNow - 1));
        test::write_file(folder / "runs/box/log.txt",
                         "first line\n2026-11-29 01:02:03.123 treefarm debug: pass 1/7: stuv 0.3, ttuv 0.1 core-s\n"
                         "second \x1b[31mline, debug: no level\n");
        test::write_file(folder / "runs/box/passes.csv", "pass,spp,error,run_seconds\n0,4,0.5,1\n1,8,,2.5\n2,16,0.1");
        test::write_file(folder / "runs/box/preview.png", "picture");
        test::write_file(folder / "secret.txt", "secret");
    }

    Site site(const std::string& token = "") const {
        return Site(ConfinedFolder(folder / "runs"), {token, "treefarm-1"}, [] { return here_at(kNow); });
    }
    static SiteRequest request(const std::string& path, const std::string& run = "") {
        SiteRequest asked;
        asked.path = path;
        asked.host = "localhost:7878";
        if (!run.empty()) asked.parameters["run"] = run;
        return asked;
    }

    const fs::path folder = test::fresh_test_folder();
};

TEST_F(ServeSite, NoPathLeadsOut) {
    fs::create_symlink(folder / "secret.txt", folder / "runs/link.txt");
    fs::create_symlink(folder, folder / "runs/up");
    ASSERT_EQ(mkfifo((folder / "runs/pipe").c_str(), 0600), 0);
    const ConfinedFolder runs(folder / "runs");
    EXPECT_EQ(runs.read("box/preview.png", 100), "picture");
    for (const std::string& path :
         {std::string("../secret.txt"), std::string("box/../../secret.txt"), (folder / "secret.txt").string(),
          std::string("link.txt"), std::string("up/secret.txt"), std::string("pipe"), std::string("box"),
          std::string(""), std::string("./box/preview.png"), std::string("box//preview.png"),
          std::string("box/preview.png\0x", 17), std::string("box/preview.png/")})
        EXPECT_FALSE(runs.read(path, 100)) << path;
    EXPECT_FALSE(runs.read("box/preview.png", 6)) << "more than was asked for";
    EXPECT_EQ(runs.read_end("box/preview.png", 4), "ture");
    EXPECT_EQ(runs.folders("", 100), std::vector<std::string>{"box"}) << "links are no folders";
}

TEST_F(ServeSite, ARunIsFoundAndEarlierOnesInsideAreNot) {
    test::write_file(folder / "runs/box/previous/status.json", "{}");
    test::write_file(folder / "runs/shot/frame.0001/status.json", "{}");
    test::write_file(folder / "runs/.hidden/status.json", "{}");
    const FoundRuns found = find_runs(ConfinedFolder(folder / "runs"));
    EXPECT_EQ(std::set<std::string>(found.paths.begin(), found.paths.end()),
              (std::set<std::string>{"box", "shot/frame.0001"}));
    SearchLimits one;
    one.runs = 1;
    EXPECT_EQ(find_runs(ConfinedFolder(folder / "runs"), one).left_out, 1u);
}

TEST_F(ServeSite, StateTellsALivingRenderFromADeadOne) {
    const ConfinedFolder runs(folder / "runs");
    const auto state = [&](std::int64_t now, bool has_process) {
        return run_entry(runs, "box", here_at(now, has_process))["state"];
    };
    EXPECT_EQ(state(kNow, true), "running");
    EXPECT_EQ(state(kNow, false), "running") << "it has written a second ago";
    EXPECT_EQ(state(kNow + 10, false), "killed");
    {  // its number is that of another container
        const FolderLock lock(folder / "runs/box", 0.0, nullptr);
        EXPECT_EQ(state(kNow + 10, false), "running");
        EXPECT_EQ(state(kNow + 100, false), "silent");
    }
    EXPECT_EQ(state(kNow + 10, true), "running");
    EXPECT_EQ(state(kNow + 100, true), "silent");
    test::write_file(folder / "runs/box/status.json", R"({"state": "done", "time": 5})");
    EXPECT_EQ(state(kNow, false), "done");
    for (const char* broken : {"", "{", "[]", "{\"state\": 7}", "null", "{\"state\": \"running\""}) {
        test::write_file(folder / "runs/box/status.json", broken);
        EXPECT_EQ(state(kNow, true), "unknown") << broken;
    }
    fs::remove(folder / "runs/box/status.json");
    EXPECT_EQ(state(kNow, true), "unknown");
}

TEST_F(ServeSite, AViewHoldsWhatTheFilesSay) {
    const FileJson view = run_view(ConfinedFolder(folder / "runs"), "box", here_at(kNow));
    EXPECT_EQ(view["title"], "box");
    EXPECT_EQ(view["error"], 0.2);
    EXPECT_EQ(view["farm"]["workers"][1]["state"], "lost");
    EXPECT_TRUE(view["farm"]["workers"][1]["idle_share"].is_null());
    EXPECT_EQ(view["farm"]["workers"][0]["processor_share"], 0.06);
    EXPECT_EQ(view["halving"]["seconds"], 30);
    ASSERT_EQ(view["table"].size(), 2u) << "the third line is not whole yet";
    EXPECT_EQ(view["table"][0]["error"], 0.5);
    EXPECT_TRUE(view["table"][1]["error"].is_null());
    EXPECT_EQ(view["log"], (FileJson{"first line", "second ?[31mline, debug: no level"}));
    EXPECT_TRUE(view["image_hash"].is_null());
    test::write_file(folder / "runs/box/summary.json", R"({"state": "interrupted", "image_hash": "old"})");
    EXPECT_TRUE(run_view(ConfinedFolder(folder / "runs"), "box", here_at(kNow))["image_hash"].is_null())
        << "of an earlier life";
}

TEST_F(ServeSite, AnswersAreJsonForARunAndForAFolder) {
    Site all = site();
    const FileJson list = FileJson::parse(all.respond(request("/status.json")).body);
    EXPECT_EQ(list["kind"], "runs");
    ASSERT_EQ(list["runs"].size(), 1u);
    EXPECT_EQ(list["runs"][0]["run"], "box");
    const SiteResponse one = all.respond(request("/status.json", "box"));
    EXPECT_EQ(one.type, "application/json");
    EXPECT_EQ(FileJson::parse(one.body)["kind"], "run");
    for (const char* wrong : {"no", "..", "../runs/box", "box/..", "/"})
        EXPECT_EQ(all.respond(request("/status.json", wrong)).status, 404) << wrong;
    Site itself(ConfinedFolder(folder / "runs/box"), {"", ""}, [] { return here_at(kNow); });
    EXPECT_EQ(FileJson::parse(itself.respond(request("/status.json")).body)["title"], "box");
}

TEST_F(ServeSite, AnEntryOfTheListIsMadeAnewOnceAFileHasChanged) {
    const fs::path status = folder / "runs/box/status.json";
    const std::string done = R"({"state": "done", "spp": 64, "time": 999990})";
    test::write_file(status, done);
    const auto written = fs::last_write_time(status);
    const ConfinedFolder runs(folder / "runs");
    RunEntries entries;
    const auto entry = [&](std::int64_t now) { return entries.of(runs, {"box"}, here_at(now))[0]; };
    EXPECT_EQ(entry(kNow)["spp"], 64);
    EXPECT_EQ(entry(kNow + 5)["age_seconds"], 15.0);
    EXPECT_EQ(entry(kNow + 7)["age_seconds"], 17.0);
    std::ofstream(status) << R"({"state": "done", "spp": 65, "time": 999990})";
    fs::last_write_time(status, written);
    EXPECT_EQ(entry(kNow)["spp"], 64) << "a file of the same size and time is not read again";
    fs::last_write_time(status, written + std::chrono::seconds(1));
    EXPECT_EQ(entry(kNow)["spp"], 65);
    test::write_file(status, running_status(kNow));
    EXPECT_EQ(entry(kNow)["state"], "running");
    EXPECT_EQ(entry(kNow + 100)["state"], "silent") << "of a file that has not changed";
    EXPECT_TRUE(entries.of(runs, {}, here_at(kNow)).empty());
}

TEST_F(ServeSite, APictureIsSentOnce) {
    Site all = site();
    SiteRequest asked = request("/preview.png", "box");
    const SiteResponse first = all.respond(asked);
    EXPECT_EQ(first.type, "image/png");
    EXPECT_EQ(first.body, "picture");
    asked.if_none_match = first.headers.at("ETag");
    EXPECT_EQ(all.respond(asked).status, 304);
    test::write_file(folder / "runs/box/preview.png", "another picture");
    EXPECT_EQ(all.respond(asked).body, "another picture");
    fs::remove(folder / "runs/box/preview.png");
    EXPECT_EQ(all.respond(asked).status, 404);
}

TEST_F(ServeSite, NothingCanBeChangedAndForeignNamesAreRefused) {
    Site all = site();
    for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "get"}) {
        SiteRequest asked = request("/");
        asked.method = method;
        EXPECT_EQ(all.respond(asked).status, 405) << method;
    }
    for (const char* host : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example:7878", "", "10.0.0.1"}) {
        SiteRequest asked = request("/");
        asked.host = host;
        EXPECT_EQ(all.respond(asked).status, 403) << host;
    }
    for (const char* host : {"localhost", "127.0.0.1:7878", "[::1]:7878", "[::1]"}) {
        SiteRequest asked = request("/");
        asked.host = host;
        EXPECT_EQ(all.respond(asked).status, 200) << host;
    }
    EXPECT_EQ(all.respond(request("/../secret.txt")).status, 404);
}

TEST_F(ServeSite, WithoutTheTokenNothingIsTold) {
    const std::string token = make_token();
    ASSERT_EQ(token.size(), 32u);
    EXPECT_NE(token, make_token());
    Site closed = site(token);
    const auto status = [&](const std::string& parameter, const std::string& header, const std::string& cookie) {
        SiteRequest asked = request("/status.json", "box");
        asked.host = "node1:7878";
        if (!parameter.empty()) asked.parameters["token"] = parameter;
        asked.authorization = header;
        asked.cookie = cookie;
        return closed.respond(asked).status;
    };
    EXPECT_EQ(status(token, "", ""), 200);
    EXPECT_EQ(status("", "Bearer " + token, ""), 200);
    EXPECT_EQ(status("", "", "other=1; treefarm-1=" + token), 200);
    for (const std::string& wrong : {std::string(), token.substr(1), token + "0", token + token, std::string("x")}) {
        EXPECT_EQ(status(wrong, "", ""), 401) << wrong;
        EXPECT_EQ(status("", "Bearer " + wrong, ""), 401) << wrong;
        EXPECT_EQ(status("", "", "treefarm-1=" + wrong), 401) << wrong;
    }
    EXPECT_EQ(status("", token, "treefarm-2=" + token), 401);
    SiteRequest first = request("/");
    first.parameters["token"] = token;
    EXPECT_EQ(closed.respond(first).headers.at("Set-Cookie").find("treefarm-1=" + token + "; HttpOnly"), 0u);
}

TEST_F(ServeSite, ATokenFileHoldsOneToken) {
    const fs::path file = folder / "token";
    test::write_file(file, "0123456789abcdef\n");
    EXPECT_EQ(read_token(file), "0123456789abcdef");
    for (const char* wrong : {"", "short", "0123456789abcde/", "0123456789abcdef\nagain\n"}) {
        test::write_file(file, wrong);
        EXPECT_THROW(read_token(file), InputError) << wrong;
    }
    EXPECT_THROW(read_token(folder / "none"), InputError);
    EXPECT_TRUE(is_loopback("127.0.0.1"));
    EXPECT_FALSE(is_loopback("0.0.0.0"));
    EXPECT_FALSE(is_loopback("127.evil"));
}

TEST_F(ServeSite, ThePageLoadsNothingFromElsewhere) {
    const SiteResponse page = site().respond(request("/"));
    EXPECT_EQ(page.type, "text/html; charset=utf-8");
    EXPECT_EQ(page.body.find("@NONCE@"), std::string::npos);
    EXPECT_EQ(page.body.find("{{"), std::string::npos);
    EXPECT_EQ(page.body.find(" src="), std::string::npos);
    EXPECT_NE(page.body.find("</html>"), std::string::npos);
    EXPECT_EQ(page.headers.at("Content-Security-Policy").find("default-src 'none'"), 0u);
    EXPECT_NE(page.body, site().respond(request("/")).body) << "a nonce is for one response";
}

}  // namespace
}  // namespace treefarm
